"""Growth under a pulsating tension: Mathieu's equation, exact identities, integration by brute."""

import numpy as np
import pytest
from conftest import EPS
from scipy.integrate import solve_ivp
from scipy.linalg import expm

import ropedyn as rd
from ropedyn.motion.modal_system import modal_system
from ropedyn.parametric.floquet import converged
from ropedyn.parametric.monodromy import exponential, finite, monodromy, rates, steps_for

MATHIEU = {
    (0.2, 0.0, 2.0): (-1.169874022626923772607909, -0.8547928927890237525543388),
    (0.2, 0.01, 2.0): (-1.133699226403365601505335, -0.8283514229815344141006852),
}
"""Multipliers by (eps = amplitude/mean, zeta, Omega/omega_1) of q'' + 2 zeta omega_1 q' + omega_1^2
(1 + eps cos Omega t) q = 0: mpmath with 40 digits, Taylor series of order 60, 40 steps."""

STRING = rd.Rope(2.0, 0.1)
BEAM = rd.Rope(1.0, 0.1, bending_stiffness=2.0, rotary_inertia=1e-4)
EVERYTHING = rd.Scene(
    BEAM,
    tension=1000.0,
    ends=("clamped", rd.End(beta="free", spring={"beta": 3.0})),
    parts=[
        rd.PointMass(0.3, 0.02, rotary_inertia=1e-6),
        rd.Spring(0.6, 300.0),
        rd.Dashpot(0.45, 0.5),
        rd.Resonator(0.7, 0.01, 60.0, damping_ratio=0.02),
        rd.Hinge(0.2, stiffness=5.0),
        rd.LocalChange(0.5, 0.7, bending=0.8),
    ],
    damping=(
        rd.ViscousDamping(0.3),
        rd.StiffnessDamping(1e-5),
        rd.RayleighDamping(1.0, 1e-5),
    ),
)
"""A rope with all that a chain's linear motion may have."""

WIRE = rd.BrokenWire(0.3, 0.05, 1e-3, radius=1e-3)
DAMPED_WIRE = rd.BrokenWire(0.3, 0.05, 1e-3, radius=1e-3, damping_ratio=0.1)

KINDS = {
    "continuous": {},
    "tensed": {"elements": 24},
    "rigid": {"elements": 24, "element": "rigid"},
}


def pulsating(scene, amplitude, frequency, **more):
    """Return the scene with a tension that pulsates by this part of its mean."""
    mean = scene.mean_tension
    tension = rd.Tension(mean, amplitude=amplitude * mean, frequency=frequency, **more)
    return scene.replace(tension=tension)


# --- modes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("bending", [2.0, 1e-4])
def test_diagonal_is_the_derivative_of_eigenvalues(kind, bending):
    """Of layers down to 3e-4 of the length too; both are sums of some hundred terms."""
    rope = BEAM.replace(bending_stiffness=bending)
    model = EVERYTHING.replace(rope=rope).compile(**KINDS[kind])
    expected = model.modes(5).derivative("tension", of="eigenvalue")
    assert np.diag(modal_system(model, 5).geometric) == pytest.approx(expected, rel=1e-12)


def test_all_modes_of_a_rigid_chain_know_it_at_any_tension():
    """Its stiffness is a straight line of the tension."""
    model = EVERYTHING.compile(elements=12, element="rigid")
    system = modal_system(model, None)
    other = EVERYTHING.replace(tension=1300.0).compile(elements=12, element="rigid")
    expected = other.modes(len(system.eigenvalue)).eigenvalue
    found = np.linalg.eigvalsh(np.diag(system.eigenvalue) + 300.0 * system.geometric)
    error = len(found) * EPS * expected[-1]
    assert found == pytest.approx(expected, abs=100 * error)


def test_all_modes_of_a_rigid_chain_know_its_damping():
    """Rates of the reduced equations are those of the chain itself."""
    model = EVERYTHING.compile(elements=12, element="rigid")
    system = modal_system(model, None)
    found = np.linalg.eigvals(rates(system))
    for rate in model.modes(12, damped=True).eigenvalue:
        assert np.abs(found - rate).min() < 1e-12 * abs(rate)


def test_coupling_of_continuous_spans_is_that_of_fine_chains():
    """Chains of n elements converge with n^-2, but for hinges, beside which a chain has a lump."""
    off = []
    scene = EVERYTHING.replace(parts=[p for p in EVERYTHING.parts if not isinstance(p, rd.Hinge)])
    limit = modal_system(scene.compile(), 4)
    for elements in (40, 80):
        system = modal_system(scene.compile(elements=elements), 4)
        for name in ("geometric", "damping"):
            a, b = np.abs(getattr(system, name)), np.abs(getattr(limit, name))
            off.append(np.abs(a - b).max() / b.max())
    assert off[2] < off[0] / 3.5
    assert off[3] < off[1] / 3.5
    assert max(off[2:]) < 1e-3


@pytest.mark.parametrize("options", [{}, {"elements": 8}, {"elements": 8, "element": "rigid"}])
def test_modes_of_a_string_uncouple(options):
    """The tension is all of its stiffness: Gamma = Lambda/T."""
    model = rd.Scene(STRING, tension=1000.0).compile(**options)
    system = modal_system(model, 5)
    assert system.geometric == pytest.approx(np.diag(system.eigenvalue) / 1000.0, rel=1e-13)
    assert len(system.blocks) == 5


def test_even_and_odd_modes_of_a_symmetric_rope_uncouple():
    system = modal_system(rd.Scene(BEAM, tension=1000.0).compile(), 4)
    assert [block.tolist() for block in system.blocks] == [[0, 2], [1, 3]]


@pytest.mark.parametrize("kind", KINDS)
def test_wires_without_damping_are_part_of_the_modes(kind):
    model = rd.Scene(BEAM, tension=1000.0, parts=[WIRE]).compile(**KINDS[kind])
    expected = model.modes(3).derivative("tension", of="eigenvalue")
    assert np.diag(modal_system(model, 3).geometric) == pytest.approx(expected, rel=1e-12)


def test_ratios_count_torsional_modes():
    """Ratios are in the order of all modes of the model, of which the second here is torsional."""
    rope = BEAM.replace(torsional_stiffness=1.0, polar_inertia=5e-5)
    ratio = (0.01, 0.02, 0.03)
    model = rd.Scene(rope, tension=1000.0, damping=rd.ModalDamping(ratio)).compile()
    assert list(model.modes(3).family) == ["transverse", "torsional", "transverse"]
    system = modal_system(model, 2)
    assert np.diag(system.damping) == pytest.approx(2 * system.omega * [0.01, 0.03], rel=EPS * 4)


# --- motion over a period ---------------------------------------------------------------------


def test_exponential_of_many_matrices():
    matrix = (
        np.random.default_rng(0).normal(size=(3, 6, 6)) * np.array([0.1, 1.0, 4.0])[:, None, None]
    )
    expected = np.array([expm(one) for one in matrix])
    assert exponential(matrix) == pytest.approx(expected, rel=1e-12, abs=1e-12 * expected.max())


def test_composition_is_of_order_ten():
    """Twice the steps leave 2^-10 of the error."""
    system = modal_system(rd.Scene(BEAM, tension=1000.0, ends=("pinned", "clamped")).compile(), 2)
    given = np.array([60.0]), np.array([[500.0]])
    exact = monodromy(system, *given, 64)
    error = [np.abs(monodromy(system, *given, steps) - exact).max() for steps in (8, 16)]
    assert 8.0 < np.log2(error[0] / error[1]) < 12.0


@pytest.mark.parametrize(("modes", "frequency"), [(3, 700.0), (3, 60.0), (1, 8.0)])
def test_steps_over_a_period_are_halved_until_rounding_is_left(modes, frequency):
    """And how much the last halving changed is the error, at least that of so many steps."""
    ends = ("pinned", "clamped")
    system = modal_system(rd.Scene(BEAM, tension=1000.0, ends=ends).compile(), modes)
    found, error, steps = converged(system, frequency, 500.0)
    given = np.array([frequency]), np.array([[500.0]])
    made = [finite(monodromy(system, *given, steps // k))[0, 0] for k in (1, 2, 4)]
    np.testing.assert_array_equal(found, made[0])
    size = np.abs(found).max()
    last, before = (float(np.abs(made[k] - made[k + 1]).max()) for k in (0, 1))
    assert error == pytest.approx(max(last, np.sqrt(steps) * EPS * size), rel=1e-12)
    assert before > 1e-13 * size
    assert last <= 1e-13 * size or last > before / 4
    assert steps <= 8 * steps_for(system, frequency, 500.0, 0.6)


@pytest.mark.claim(
    "Floquet multipliers of a string with pulsating tension",
    reference="Taylor series with 40 digits",
    accepted=1e-14,
)
@pytest.mark.parametrize("given", MATHIEU)
@pytest.mark.parametrize("options", [{}, {"elements": 8}])
def test_string_obeys_the_equation_of_mathieu(given, options, claim):
    """And so does every mode of a lumped string with its own frequency."""
    amplitude, ratio, share = given
    scene = rd.Scene(STRING, tension=1000.0, damping=rd.ModalDamping(ratio))
    first = scene.compile(**options).modes(1).frequency[0]
    floquet = pulsating(scene, amplitude, share * first).compile(**options).floquet(1)
    error = np.abs(floquet.multiplier - MATHIEU[given])
    claim(error.max())
    assert (error < 10 * floquet.rounding_error).all()
    assert not floquet.stable


@pytest.mark.parametrize("kind", KINDS)
def test_product_of_multipliers_is_what_damping_leaves(kind):
    """Liouville: exp(-trace(C) period), whatever pulsates."""
    model = pulsating(EVERYTHING, 0.4, 110.0).compile(**KINDS[kind])
    floquet = model.floquet(5)
    expected = np.exp(-np.trace(modal_system(model, 5).damping) * floquet.period)
    assert np.prod(floquet.multiplier) == pytest.approx(expected, rel=1e-12)


def test_multipliers_without_damping_come_in_pairs():
    """Symplectic: mu and 1/mu."""
    scene = EVERYTHING.replace(damping=None, parts=EVERYTHING.parts[:2])
    multiplier = pulsating(scene, 0.4, 120.0).compile().floquet().multiplier
    for one in multiplier:
        assert np.abs(multiplier - 1 / one).min() < 1e-12


def test_chain_moves_as_its_matrices_do():
    """The assembled chain, K(t) = K + a cos(2 pi f t) dK/dT, integrated to 1e-11."""
    parts = [part for part in EVERYTHING.parts if not isinstance(part, rd.Resonator)]
    scene = EVERYTHING.replace(parts=parts)
    options = {"elements": 7, "element": "rigid"}
    model = scene.compile(**options)
    stiffness, mass, damping = (
        matrix.toarray()
        for matrix in (model.stiffness_matrix(), model.mass_matrix(), model.damping_matrix())
    )
    more = scene.replace(tension=2000.0).compile(**options).stiffness_matrix().toarray() - stiffness
    # stiffness damping acts on sections, which tension is none of; Rayleigh's on the mean tension
    n, frequency, amplitude = len(mass), 90.0, 400.0
    inverse = np.linalg.inv(mass)

    def rate(t, state):
        u, v = state.reshape(2, n, 2 * n)
        force = (stiffness + amplitude * np.cos(2 * np.pi * frequency * t) * more / 1000.0) @ u
        return np.concatenate([v, -inverse @ (force + damping @ v)]).ravel()

    scale = np.repeat([1e-3, 1.0], n)  # displacements are small beside velocities
    start = np.diag(scale).ravel()
    run = solve_ivp(rate, (0, 1 / frequency), start, "DOP853", rtol=1e-11, atol=1e-14)
    end = run.y[:, -1].reshape(2 * n, 2 * n)
    expected = np.linalg.eigvals(end / scale)
    floquet = pulsating(scene, 0.4, frequency).compile(**options).floquet(None)
    assert len(floquet.multiplier) == len(expected)
    for one in floquet.multiplier[:8]:
        assert np.abs(expected - one).min() < 1e-8


def test_continuous_rope_grows_as_a_fine_chain():
    """The error of a tensed chain falls with the fourth power of the element's length."""
    rope = BEAM.replace(rotary_inertia=None)
    scene = rd.Scene(rope, tension=1000.0, ends=("pinned", "clamped"))
    scene = pulsating(scene, 0.3, 2 * float(scene.compile().modes(1).frequency[0]))
    exact = scene.compile().floquet().growth
    off = [
        np.abs(scene.compile(elements=n).floquet().growth - exact).max() / exact.max()
        for n in (20, 40)
    ]
    assert off[1] < off[0] / 12
    assert off[1] < 1e-3


def test_no_pulsation_is_the_limit_of_little():
    """Growth is that of the damped modes where nothing resonates, but for some amplitude^2."""
    model = EVERYTHING.compile(elements=12, element="rigid")
    expected = np.sort(model.modes(damped=True, number=12).eigenvalue.real)
    floquet = (
        pulsating(EVERYTHING, 1e-9, 3170.0).compile(elements=12, element="rigid").floquet(None)
    )
    for rate in expected:
        assert np.abs(floquet.growth - rate).min() < 1e-8 * abs(rate) + 1e-8


def test_multipliers_do_not_depend_on_the_phase():
    scene = rd.Scene(STRING, tension=1000.0)
    one, other = (
        pulsating(scene, 0.2, 45.0, phase=phase).compile().floquet() for phase in (0.0, 1.0)
    )
    assert other.multiplier == pytest.approx(one.multiplier, abs=1e-12)


def test_rigid_motion_neither_grows_nor_decays():
    """A free rope that only pulsates under tension drifts; two multipliers meet at 1."""
    scene = rd.Scene(
        BEAM, tension=rd.Tension(0.0, amplitude=1.0, frequency=40.0), ends=("free",) * 2
    )
    floquet = scene.compile().floquet(1)
    assert floquet.frequency == [0.0]
    assert floquet.multiplier == pytest.approx([1.0, 1.0], abs=1e-7)
    assert floquet.stable


def test_pulsation_can_hold_a_buckled_rope():
    """Kapitza: what is fast is stable where (a Gamma/2 pi f)^2/2 > |omega^2|."""
    scene = rd.Scene(BEAM, tension=-25.0, ends=("pinned", "pinned"))
    system = modal_system(scene.compile(), 1)
    assert system.eigenvalue[0] < 0
    frequency = 100.0
    needed = np.sqrt(-2 * system.eigenvalue[0]) * 2 * np.pi * frequency / system.geometric[0, 0]
    for share, stable in ((0.9, False), (1.1, True)):
        tension = rd.Tension(-25.0, amplitude=share * needed, frequency=frequency)
        assert scene.replace(tension=tension).compile().floquet(1).stable is stable


def test_both_modes_of_a_combination_take_part():
    scene = rd.Scene(BEAM, tension=1000.0, ends=("pinned", "clamped"))
    f = scene.compile().modes(3).frequency
    floquet = pulsating(scene, 0.1, float(f[0] + f[1])).compile().floquet(3)
    assert floquet.dominant == (1, 2)
    assert floquet.participation.sum(axis=1) == pytest.approx(np.ones(6))
    # adiabatic invariants grow alike: energies are as frequencies
    shares = floquet.participation[0, :2]
    assert shares[1] / shares[0] == pytest.approx(f[1] / f[0], rel=0.1)


def test_rates_are_those_of_the_whole_matrix_of_hill():
    """All eigenvalues of its 41 harmonics, of which those of any 2k in a strip are the motions."""
    scene = pulsating(EVERYTHING, 0.4, 110.0)
    model = scene.compile()
    floquet = model.floquet(3)
    system, omega, h = modal_system(model, 3), 2 * np.pi * 110.0, np.arange(-20, 21)
    turn = np.kron(np.diag(1j * omega * h), np.eye(3))
    side = np.kron(np.eye(41, k=1) + np.eye(41, k=-1), 200.0 * system.geometric)
    stiff = np.kron(np.eye(41), np.diag(system.eigenvalue)) + side
    resists = np.kron(np.eye(41), system.damping)
    known = np.linalg.eigvals(np.block([[-turn, np.eye(123)], [-stiff, -turn - resists]]))
    for rate in floquet.rate:
        assert np.abs(known - rate).min() < 1e-10 * omega
    assert floquet.rate.real.sum() == pytest.approx(-np.trace(system.damping), rel=1e-12)


def test_motion_that_decays_at_once_has_its_rate():
    """Its multiplier of 1e-20 is lost beside others; without pulsation rates are those of modes."""
    scene = rd.Scene(BEAM, tension=1000.0, damping=rd.StiffnessDamping(1e-2))
    floquet = pulsating(scene, 1e-6, 30.0).compile().floquet(3)
    system = modal_system(scene.compile(), 3)
    expected = np.sort(np.linalg.eigvals(rates(system)).real)
    assert np.abs(floquet.multiplier).min() < 1e-20
    assert np.sort(floquet.growth) == pytest.approx(expected, rel=1e-8)


def test_rope_that_twists_as_it_stretches_has_the_multipliers_of_one_that_does_not():
    """Lay couples motion along the rope and twist; a tension that is given is in neither."""
    laid = BEAM.replace(
        axial_stiffness=1e5, torsional_stiffness=0.5, polar_inertia=5e-5, lay_coupling=50.0
    )
    one, other = (
        pulsating(rd.Scene(rope, tension=1000.0), 0.3, 110.0).compile().floquet()
        for rope in (BEAM, laid)
    )
    assert other.multiplier == pytest.approx(one.multiplier, abs=1e-12)


# --- questions --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tension": 1000.0}, "tension must pulsate"),
        ({"tension": rd.Tension(1000.0)}, "tension must pulsate"),
        ({"gravity": rd.Gravity()}, "gravity must be None"),
        ({"damping": rd.LossFactor(0.01)}, "in proportion to velocity, got LossFactor"),
        ({"damping": rd.ModalDamping([0.01])}, "got none for mode 2"),
        ({"parts": [rd.Stop(0.5, 1e4, gap=1e-3)]}, r"parts\[0\]"),
        (
            {"parts": [rd.BrokenWire(0.3, 0.05, 1e-3, radius=1e-3, damping_ratio=0.1)]},
            "broken wire",
        ),
    ],
)
def test_what_has_no_multipliers_is_refused(change, message):
    rope = BEAM.replace(axial_stiffness=1e6)
    scene = pulsating(rd.Scene(rope, tension=1000.0), 0.1, 50.0).replace(**change)
    with pytest.raises(rd.SceneError, match=message):
        scene.compile().floquet()


def test_element_without_geometric_stiffness_is_refused():
    scene = rd.Scene(BEAM, tension=rd.Tension(0.0, amplitude=1.0, frequency=40.0))
    with pytest.raises(rd.SceneError, match="no geometric stiffness"):
        scene.compile(elements=4, element="difference").floquet()


def test_number_of_modes_is_checked():
    scene = pulsating(rd.Scene(STRING, tension=1000.0), 0.1, 50.0)
    assert scene.compile(elements=4).floquet(None).modes.tolist() == [1, 2, 3]
    with pytest.raises(rd.SolveError, match="modes must be at most 3"):
        scene.compile(elements=4).floquet(4)
    with pytest.raises(rd.SceneError, match="modes must be a number for continuous"):
        scene.compile().floquet(None)
    with pytest.raises(rd.SceneError, match="modes must be a number for models"):
        scene.compile(elements=300).floquet(None)
    with pytest.raises(TypeError):
        scene.compile().floquet(2.5)


def test_numbers_may_refuse():
    slow = pulsating(rd.Scene(STRING, tension=1000.0), 0.1, 1e-4)
    with pytest.raises(rd.SolveError, match="too low"):
        slow.compile().floquet()
    with pytest.raises(rd.SolveError, match="out of all numbers"):
        finite(np.array([[1.0, np.inf]]))


def test_answer_is_a_table_a_figure_and_a_file(tmp_path):
    floquet = pulsating(rd.Scene(STRING, tension=1000.0), 0.1, 50.0).compile().floquet(2)
    assert len(floquet.table().rows) == 4
    assert "unstable" in str(floquet)
    assert len(floquet.plot().lines) == 3
    pytest.importorskip("h5netcdf")
    floquet.save(tmp_path / "floquet.nc")
    again = rd.load(tmp_path / "floquet.nc")
    assert np.array_equal(again.multiplier, floquet.multiplier)
    assert again.stable == floquet.stable
    assert again.dominant == floquet.dominant
