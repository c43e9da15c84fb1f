"""Motion of a rope over two seconds under a sine: both methods beside SciPy and two programs.

python benchmarks/transient.py

exudyn and openseespy are timed where they are installed. All solve the same equations, those of
64 rigid elements, and are compared with their exact solution.
"""

# isort: off
import timing  # before numpy

# isort: on
import importlib.util
from collections.abc import Callable
from typing import Any

import numpy as np
import report
import scene
from scipy.linalg import expm
from scipy.signal import lsim

import ropedyn as rd

ELEMENTS, RATE, SECONDS = 64, 10_000, 2.0
FREQUENCY = 70.0
AT = 24
"""Node that is pushed and watched."""
TIME = np.arange(round(SECONDS * RATE) + 1) / RATE
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


def line() -> np.ndarray:
    force = rd.Sine(1.0, FREQUENCY)
    return MODEL.transient(TIME, drive=WHERE, force=force, method="line").value[0]


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


def calls() -> dict[str, Callable[[], np.ndarray]]:
    own = {
        "ropedyn, modal, Sine": modal,
        "ropedyn, modal, samples": sampled,
        "ropedyn, line, Sine": line,
        "scipy.signal.lsim": scipy_lsim,
    }
    peers = {"exudyn": ("exudyn", exudyn), "openseespy": ("OpenSees", opensees)}
    return own | {
        name: call for module, (name, call) in peers.items() if importlib.util.find_spec(module)
    }


def error(value: np.ndarray, true: np.ndarray) -> float:
    """Return the largest error at all times, or at every other one."""
    return float(np.abs(value - true[:: (len(true) - 1) // (len(value) - 1)]).max())


def main() -> None:
    true, solvers = exact(), calls()
    size = np.abs(true).max()
    wrong = {name: error(call(), true) / size for name, call in solvers.items()}
    time = timing.medians(solvers, budget=3.0, least=0.1)
    rows = [
        [name, f"{1e3 * time[name]:.3g}", f"{wrong[name]:.1e}"]
        + [f"{time[peer] / time[name]:.3g}" if peer in time else "-" for peer in PEERS]
        for name in solvers
    ]
    head = ["", "time [ms]", "error", *(f"{peer} / this" for peer in PEERS)]
    text = (
        f"{report.machine()}.\n\n{ELEMENTS} rigid elements (z and beta, {MODEL.size} unknowns), "
        f"{len(TIME) - 1} times in {SECONDS:g} s, a sine of {FREQUENCY:g} Hz: processor time and "
        "largest error in time over the largest value.\n\n" + report.table(head, rows)
    )
    report.write("transient.md", text)


PEERS = ("scipy.signal.lsim", "exudyn", "OpenSees")

if __name__ == "__main__":
    main()
