"""Motion of a rope over two seconds under a sine: both methods beside SciPy and three programs.

python benchmarks/transient.py

exudyn, openseespy and ross-rotordynamics (with plotly < 6) are timed where they are installed. All
are compared with the exact solution of 64 rigid elements, whose equations SciPy and exudyn solve
too; OpenSees and ROSS have beam elements of their own.
"""

# isort: off
import timing  # before numpy

# isort: on
import datetime
import importlib.metadata
import importlib.util
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import report
import scene
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.signal import lsim
from scipy.sparse import csr_array

import ropedyn as rd

ELEMENTS, RATE, SECONDS = 64, 10_000, 2.0
FREQUENCY = 70.0
AT = 24
"""Node that is pushed and watched."""
TIME = np.arange(round(SECONDS * RATE) + 1) / RATE
SHORT = 40
"""Part of the two seconds that solve_ivp is timed over."""

MODEL = (
    scene.model("uniform", ELEMENTS, twist=False, rotary=True)
    .scene.replace(damping=rd.RayleighDamping(0.0, scene.GAMMA))
    .compile(elements=ELEMENTS, element="rigid")
)
WHERE = ("z", float(MODEL.x[AT]))
FORCE = np.sin(2 * np.pi * FREQUENCY * TIME)


def matrices() -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Return mass, damping, stiffness and the unknown that is pushed and watched."""
    parts = [
        m.toarray() for m in (MODEL.mass_matrix(), MODEL.damping_matrix(), MODEL.stiffness_matrix())
    ]
    return *parts, 2 * (AT - 1)


def first_order() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A, b, c of y' = A y + b f, u = c y."""
    M, C, K, at = matrices()
    n = len(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(M, K), -np.linalg.solve(M, C)]])
    force = np.zeros(n)
    force[at] = 1.0
    b = np.concatenate([np.zeros(n), np.linalg.solve(M, force)])
    c = np.zeros(2 * n)
    c[at] = 1.0
    return A, b, c


def exact() -> np.ndarray:
    """Return the solution, the sine as two more unknowns of the exponential."""
    A, b, c = first_order()
    n, omega = len(A), 2 * np.pi * FREQUENCY
    whole = np.zeros((n + 2, n + 2))
    whole[:n, :n], whole[:n, n] = A, b
    whole[n, n + 1], whole[n + 1, n] = omega, -omega
    step = expm(whole / RATE)
    y = np.zeros(n + 2)
    y[n + 1] = 1.0
    u = np.empty(len(TIME))
    for k, t in enumerate(TIME):
        u[k] = c @ y[:n]
        y = step @ y
        y[n], y[n + 1] = np.sin(omega * (t + 1 / RATE)), np.cos(omega * (t + 1 / RATE))
    return u


# --- who solves them ----------------------------------------------------------------------------


def modal() -> np.ndarray:
    force = rd.Sine(1.0, FREQUENCY)
    return MODEL.transient(TIME, drive=WHERE, force=force, method="modal").value[0]


def sampled() -> np.ndarray:
    return MODEL.transient(TIME, drive=WHERE, force=FORCE, method="modal").value[0]


def anew() -> np.ndarray:
    """Compile the model too, which finds its modes again."""
    model = MODEL.scene.compile(elements=ELEMENTS, element="rigid")
    force = rd.Sine(1.0, FREQUENCY)
    return model.transient(TIME, drive=WHERE, force=force).value[0]


def line() -> np.ndarray:
    force = rd.Sine(1.0, FREQUENCY)
    return MODEL.transient(TIME, drive=WHERE, force=force, method="line", tolerance=1e-6).value[0]


def scipy_solve_ivp() -> np.ndarray:
    """Integrate a part of the record, by the sparse matrices."""
    A, b, c = first_order()
    sparse = csr_array(A)
    time = TIME[: (len(TIME) - 1) // SHORT + 1]
    found = solve_ivp(
        lambda t, y: sparse @ y + b * np.sin(2 * np.pi * FREQUENCY * t),
        (0.0, time[-1]),
        np.zeros(len(b)),
        method="DOP853",
        rtol=1e-6,
        atol=1e-12,
        t_eval=time,
    )
    return c @ found.y


def scipy_lsim() -> np.ndarray:
    A, b, c = first_order()
    return lsim((A, b[:, None], c[None], [[0.0]]), FORCE, TIME)[1]


def exudyn() -> np.ndarray:
    """Solve the assembled equations by its implicit solver, sparse, step for step."""
    import exudyn as exu
    from exudyn.utilities import (
        LoadCoordinate,
        MarkerNodeCoordinate,
        NodeGenericODE2,
        ObjectGenericODE2,
        SensorNode,
    )
    from scipy.sparse import csr_matrix

    M, C, K, at = matrices()
    n = len(M)
    system = exu.SystemContainer().AddSystem()
    zero = [0.0] * n
    node = system.AddNode(
        NodeGenericODE2(
            referenceCoordinates=zero,
            initialCoordinates=zero,
            initialCoordinates_t=zero,
            numberOfODE2Coordinates=n,
        )
    )

    def sparse(matrix: np.ndarray) -> Any:
        one = exu.MatrixContainer()
        one.SetWithSparseMatrix(csr_matrix(matrix), n, n)
        return one

    system.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=sparse(M),
            stiffnessMatrix=sparse(K),
            dampingMatrix=sparse(C),
        )
    )
    marker = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=at))
    system.AddLoad(
        LoadCoordinate(
            markerNumber=marker,
            load=1.0,
            loadUserFunction=lambda _, t, load: float(np.sin(2 * np.pi * FREQUENCY * t)),
        )
    )
    sensor = system.AddSensor(
        SensorNode(
            nodeNumber=node,
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.Coordinates,
        )
    )
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = len(TIME) - 1
    settings.timeIntegration.endTime = SECONDS
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 1 / RATE
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.displayComputationTime = False
    system.SolveDynamic(settings)
    return np.asarray(system.GetSensorStoredData(sensor))[:, 1 + at]


def opensees() -> np.ndarray:
    """Beams whose geometric stiffness is P-Delta's, Newmark's average acceleration."""
    import openseespy.opensees as ops

    rope = MODEL.scene.rope
    length = rope.length / ELEMENTS
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    for k, x in enumerate(MODEL.x):
        ops.node(k + 1, float(x), 0.0)
        ops.fix(k + 1, int(k == 0), *((1, 1) if k in (0, ELEMENTS) else (0, 0)))
    ops.geomTransf("PDelta", 1)
    for k in range(1, ELEMENTS + 1):
        ops.element("elasticBeamColumn", k, k, k + 1, 1e6, rope.bending_stiffness, 1.0, 1)
    for k in range(2, ELEMENTS + 2):
        inertia = rope.linear_density * length, rope.rotary_inertia * length
        ops.mass(k, inertia[0], inertia[0], inertia[1])
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.timeSeries("Constant", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(ELEMENTS + 1, scene.TENSION, 0.0, 0.0)
    ops.algorithm("Newton")
    ops.test("NormDispIncr", 1e-12, 10)
    ops.integrator("LoadControl", 1.0)
    ops.analysis("Static")
    ops.analyze(1)
    ops.wipeAnalysis()
    ops.loadConst("-time", 0.0)
    ops.rayleigh(0.0, scene.GAMMA, 0.0, 0.0)
    ops.timeSeries("Trig", 2, 0.0, 2 * SECONDS, 1 / FREQUENCY)
    ops.pattern("Plain", 2, 2)
    ops.load(AT + 1, 0.0, 1.0, 0.0)
    ops.constraints("Plain")
    ops.numberer("RCM")
    ops.system("BandGeneral")
    ops.algorithm("Linear", "-factorOnce")
    ops.integrator("Newmark", 0.5, 0.25)
    ops.analysis("Transient")
    u = np.zeros(len(TIME))
    for k in range(1, len(TIME)):
        ops.analyze(1, 1 / RATE)
        u[k] = ops.nodeDisp(AT + 1, 2)
    return u


def ross() -> np.ndarray:
    """A rotor at rest of as many beams under tension, by the integration it takes by default."""
    import ross as rotors

    rope = MODEL.scene.rope
    wide = 4 * float(np.sqrt(rope.rotary_inertia / rope.linear_density))
    area, second = np.pi * wide**2 / 4, np.pi * wide**4 / 64
    stuff = rotors.Material(
        "rope",
        rho=rope.linear_density / area,
        E=rope.bending_stiffness / second,
        Poisson=0.3,
    )
    each: dict[str, Any] = {"L": rope.length / ELEMENTS, "idl": 0.0, "material": stuff}
    taut = {"axial_force": scene.TENSION, "alpha": 0.0, "beta": scene.GAMMA, "odl": wide}
    beam = partial(rotors.ShaftElement, **each, **taut, shear_effects=False, gyroscopic=False)
    # its bearings hold no angle: a thick beam between two of them clamps
    clamp = partial(rotors.ShaftElement, **each, odl=10 * wide)
    shaft = [clamp(), *(beam() for _ in range(ELEMENTS)), clamp()]
    held = [
        rotors.BearingElement(n=n, kxx=1e12, kyy=1e12, cxx=0.0, cyy=0.0)
        for n in (0, 1, ELEMENTS + 1, ELEMENTS + 2)
    ]
    rotor = rotors.Rotor(shaft, bearing_elements=held)
    at = rotor.number_dof * (AT + 1)
    force = np.zeros((len(TIME), rotor.ndof))
    force[:, at] = FORCE
    return np.asarray(rotor.run_time_response(0.0, force, TIME).yout)[:, at]


def calls() -> dict[str, Callable[[], np.ndarray]]:
    own = {
        "ropedyn, modal, Sine": modal,
        "ropedyn, modal, Sine, model anew": anew,
        "ropedyn, modal, samples": sampled,
        "ropedyn, line, Sine, tolerance 1e-6": line,
        "scipy.signal.lsim": scipy_lsim,
        "scipy.integrate.solve_ivp, DOP853": scipy_solve_ivp,
    }
    peers = {
        "exudyn": ("exudyn", exudyn),
        "openseespy": ("OpenSees", opensees),
        "ross": ("ROSS", ross),
    }
    return own | {
        name: call for module, (name, call) in peers.items() if importlib.util.find_spec(module)
    }


def error(value: np.ndarray, true: np.ndarray) -> float:
    """Return the largest error at the first times, as many as there are."""
    return float(np.abs(value - true[: len(value)]).max())


def main() -> None:
    true, solvers = exact(), calls()
    size = np.abs(true).max()
    wrong = {name: error(call(), true) / size for name, call in solvers.items()}
    time = timing.medians(solvers, budget=3.0, least=0.1)
    time["scipy.integrate.solve_ivp, DOP853"] *= SHORT
    rows = [
        [name, f"{1e3 * time[name]:.3g}", f"{wrong[name]:.1e}"]
        + [f"{time[peer] / time[name]:.3g}" if peer in time else "-" for peer in PEERS]
        for name in solvers
    ]
    head = ["", "time [ms]", "error", *(f"{peer.split('.')[-1]} / this" for peer in PEERS)]
    text = (
        f"{report.machine()}, {datetime.date.today()}. {versions()}.\n\n{ELEMENTS} rigid elements "
        f"(z and beta, {MODEL.size} unknowns), {len(TIME) - 1} times in {SECONDS:g} s, a sine of "
        f"{FREQUENCY:g} Hz: processor time and largest error in time over the largest value; "
        f"solve_ivp is timed over a {SHORT}th of the time.\n\n" + report.table(head, rows)
    )
    report.write("transient.md", text)


def versions() -> str:
    """Say what is compared."""
    names = ("scipy", "exudyn", "openseespy", "ross-rotordynamics")
    told = []
    for name in names:
        try:
            told.append(f"{name} {importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            told.append(f"{name} not installed")
    return ", ".join(told)


PEERS = ("scipy.signal.lsim", "scipy.integrate.solve_ivp, DOP853", "exudyn", "OpenSees", "ROSS")

if __name__ == "__main__":
    main()
