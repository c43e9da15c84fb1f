"""Complex modes of ropes that carry resonators and broken wires: tuned mass dampers."""

import math

import mpmath
import numpy as np
import pytest
import scipy.linalg
from conftest import EPS

import ropedyn as rd

L, T, MU = 1.3, 200.0, 0.1
OMEGA = math.pi / L * math.sqrt(T / MU)
"""First angular frequency of the string [rad/s]."""
BEAM = rd.Rope(
    L,
    MU,
    bending_stiffness=2.0,
    torsional_stiffness=1.0,
    rotary_inertia=1e-5,
    polar_inertia=1e-5,
)


def taut(*parts, rope=None, **more):
    return rd.Scene(rope or rd.Rope(L, MU), tension=T, parts=parts, **more)


def numbers(resonator):
    """Mass, spring and dashpot."""
    omega = 2 * math.pi * resonator.frequency
    return (
        resonator.mass,
        resonator.mass * omega**2,
        2 * resonator.damping_ratio * resonator.mass * omega,
    )


def newton(function, s):
    """Newton's step |f/f'| of a function in 50 digits."""
    with mpmath.workdps(50):
        s = mpmath.mpc(s)
        h = abs(s) * mpmath.mpf(10) ** -20
        f, later, before = function(s), function(s + h), function(s - h)
        return float(abs(f / (later - before) * 2 * h))


# --- two degrees of freedom -----------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.127, 0.7, 3.0])
@pytest.mark.parametrize("mass_ratio", [0.01, 0.05, 1.0])
def test_den_hartogs_absorber_has_the_roots_of_its_quartic(mass_ratio, ratio):
    # J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.3
    M, K = MU * L / 2, 4 * T / L
    absorber = rd.Resonator(
        L / 2,
        mass_ratio * M,
        math.sqrt(K / M) / (2 * math.pi * (1 + mass_ratio)),
        damping_ratio=ratio,
    )
    m, k, c = numbers(absorber)
    quartic = [M * m, (M + m) * c, M * k + m * (K + k), c * K, k * K]
    exact = np.roots(quartic)
    with mpmath.workdps(40):

        def f(s):
            return sum(mpmath.mpf(q) * s ** (4 - i) for i, q in enumerate(quartic))

        exact = np.array([complex(mpmath.findroot(f, complex(s))) for s in exact])
    exact = exact[exact.imag >= 0]
    exact = exact[np.argsort(np.abs(exact))]
    model = taut(absorber).compile(elements=2, element="rigid")
    modes = model.modes(len(exact), damped=True)
    assert modes.certified
    # roots of one modulus come in any order; coefficients of a few EPS, near a double root 1e2
    apart = np.abs(modes.eigenvalue[:, None] - exact).min(axis=1)
    assert (apart < 1e-13 * np.abs(exact)).all()
    assert len(set(np.abs(modes.eigenvalue[:, None] - exact).argmin(axis=1))) == len(exact)
    with pytest.raises(rd.SolveError, match=f"number must be at most {len(exact)}"):
        model.modes(len(exact) + 1, damped=True)


def test_optimum_damping_gives_a_pair_of_modes_equal_damping_at_an_exceptional_point():
    # tuned to f = 1/(1 + mu) with z^2 = mu/(1 + mu), in units of own: quartic (s^2 + z s + f)^2
    mu = 0.04
    M, K = MU * L / 2, 4 * T / L
    own = math.sqrt(K / M)
    ratio = math.sqrt(mu / (1 + mu))
    absorber = rd.Resonator(L / 2, mu * M, own / (2 * math.pi * (1 + mu)), damping_ratio=ratio)
    modes = taut(absorber).compile(elements=2, element="rigid").modes(2, damped=True)
    assert modes.certified
    double = own * (-ratio / 2 + 1j * math.sqrt(1 / (1 + mu) - ratio**2 / 4))
    # a double root: a relative EPS moves it by sqrt(EPS); the error says so
    error = 2 * np.pi * modes.rounding_error
    assert (np.abs(modes.eigenvalue - double) < error + 1e-7 * own).all()
    assert np.ptp(modes.damping_ratio) < 1e-6


# --- a string -------------------------------------------------------------------------------------


def exact_resonator(part):
    """Determinant of the string times k + c s + m s^2, which has no poles."""

    def f(s):
        m = mpmath.mpf(part.mass)
        omega = 2 * mpmath.pi * mpmath.mpf(part.frequency)
        k, c = m * omega**2, 2 * mpmath.mpf(part.damping_ratio) * m * omega
        gap = k + c * s + m * s * s
        return on_string(s, part.x, m * s * s * (k + c * s), gap)

    return f


def exact_wire(part):
    """The same with a cantilever of length l and modulus E (1 + 2 i z), its root not turning."""

    def f(s):
        d, length = mpmath.mpf(part.diameter), mpmath.mpf(part.length)
        area, inertia = mpmath.pi * d**2 / 4, mpmath.pi * d**4 / 64
        EI = part.youngs_modulus * inertia * (1 + 2j * mpmath.mpf(part.damping_ratio))
        k = mpmath.sqrt(mpmath.sqrt(-s * s * part.density * area / EI))
        c, sine, C, S = (g(k * length) for g in (mpmath.cos, mpmath.sin, mpmath.cosh, mpmath.sinh))
        return on_string(s, part.x, -EI * k**3 * (c * S + sine * C), 1 + c * C)

    return f


def on_string(s, x, above, gap):
    v = mpmath.sqrt(mpmath.mpf(T) / MU)
    beside = mpmath.sinh(s * mpmath.mpf(x) / v) * mpmath.sinh(s * (mpmath.mpf(L) - x) / v)
    return gap * mpmath.sqrt(mpmath.mpf(T) * MU) * s * mpmath.sinh(s * L / v) + above * beside


@pytest.mark.claim(
    "Complex modes of a string with a damped resonator: distance / (estimate + 4 eps)",
    reference="Newton's step of the characteristic equation in 50 digits",
    accepted=1.0,
)
@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.5, 0.99, 1.0, 1.2, 2.0, 5.0])
@pytest.mark.parametrize(
    ("mass", "frequency"), [(0.01, OMEGA / (2 * math.pi)), (1e-5, 30.0), (3.0, 5.0), (1e6, 100.0)]
)
def test_string_with_a_damped_resonator_has_the_roots_of_50_digits(mass, frequency, ratio, claim):
    part = rd.Resonator(0.3, mass, frequency, damping_ratio=ratio)
    modes = taut(part).compile().modes(8, damped=True)
    assert modes.certified
    # 4 EPS of the resonator's own numbers, of which a root is never more sensitive than a critical
    # pair, which has its estimate
    error = 2 * np.pi * modes.rounding_error + 4 * EPS * np.abs(modes.eigenvalue)
    for s, one in zip(modes.eigenvalue, error):
        claim(newton(exact_resonator(part), s) / one)


@pytest.mark.parametrize("ratio", [0.0, 1e-3, 0.05, 0.4])
def test_string_with_a_hysteretic_wire_has_the_roots_of_50_digits(ratio):
    part = rd.BrokenWire(0.3, 0.3, 2e-3, radius=0.0, damping_ratio=ratio)
    modes = taut(part).compile().modes(10, damped=True)
    assert modes.certified
    error = 2 * np.pi * modes.rounding_error + 8 * EPS * np.abs(modes.eigenvalue)
    for s, one in zip(modes.eigenvalue, error):
        assert newton(exact_wire(part), s) < one


# --- against matrices -----------------------------------------------------------------------------


def quadratic(scene, resonators, **kind):
    """Roots with Im s >= 0 of the matrices with resonators as more unknowns, lowest first."""
    model = scene.replace(parts=(*scene.parts, *(rd.PointMass(r.x, 0.0) for r in resonators)))
    model = model.compile(**kind)
    K, C, M = (
        part().toarray()
        for part in (model.stiffness_matrix, model.damping_matrix, model.mass_matrix)
    )
    # unknowns node by node: inner nodes of clamped ropes
    n, width = len(K), len(model.coordinates)
    K, C, M = (np.pad(part, (0, len(resonators))) for part in (K, C, M))
    for i, one in enumerate(resonators):
        foot = (int(np.abs(model.x - one.x).argmin()) - 1) * width + model.coordinates.index("z")
        m, k, c = numbers(one)
        M[n + i, n + i] = m
        ends = np.ix_([foot, n + i], [foot, n + i])
        K[ends] += k * np.array([[1, -1], [-1, 1]])
        C[ends] += c * np.array([[1, -1], [-1, 1]])
    zero, one = np.zeros_like(K), np.eye(len(K))
    scale = 1 / np.sqrt(K.diagonal())
    K, C, M = (scale[:, None] * part * scale for part in (K, C, M))
    unit = 1 / math.sqrt(np.abs(M).max())
    left = np.block([[zero, one], [-K, -unit * C]])
    s = scipy.linalg.eigvals(left, np.block([[one, zero], [zero, unit**2 * M]]))
    s = unit * s[np.isfinite(s)]
    s = s[np.abs(s) < 1e12]
    s = s[s.imag >= -1e-9 * np.abs(s)]
    return s[np.argsort(np.abs(s))]


@pytest.mark.parametrize("seed", range(12))
def test_chains_with_resonators_have_the_roots_of_the_quadratic_eigenproblem(seed):
    random = np.random.default_rng(seed)
    more = {} if seed % 2 else {"bending_stiffness": 10 ** random.uniform(-2, 1)}
    parts = [rd.PointMass(0.41, 0.3), rd.Spring(0.77, 1e3)]
    parts += [rd.Dashpot(0.93, 10 ** random.uniform(-1, 1))] if seed % 3 else []
    resonators = [
        rd.Resonator(
            random.uniform(0.1, L - 0.1),
            10 ** random.uniform(-3, 0),
            10 ** random.uniform(0.5, 2),
            damping_ratio=10 ** random.uniform(-2, 0.5),
        )
        for _ in range(1 + seed % 3)
    ]
    scene = taut(*parts, rope=rd.Rope(L, MU, **more))
    kind = {"elements": int(random.integers(12, 20)), "element": "rigid"}
    exact = quadratic(scene, resonators, **kind)
    modes = scene.replace(parts=(*parts, *resonators)).compile(**kind).modes(9, damped=True)
    assert modes.certified
    # LAPACK's backward error: EPS of the pencil's norm, 1e9 of these rates at most
    assert np.allclose(modes.eigenvalue, exact[:9], rtol=1e-6, atol=0)


def test_all_modes_of_a_chain_with_a_resonator_are_as_many_as_its_unknowns_say():
    # a massless foot: rope's masses and the resonator's twice each, and one dashpot's rate
    scene = taut(rd.Resonator(0.35, 0.02, 20.0, damping_ratio=0.3), rd.Dashpot(0.9, 0.2))
    model = scene.compile(elements=5, element="rigid")
    total = len(
        quadratic(taut(rd.Dashpot(0.9, 0.2)), [scene.parts[0]], elements=5, element="rigid")
    )
    assert len(model.modes(total, damped=True).eigenvalue) == total
    with pytest.raises(rd.SolveError, match=f"at most {total}, the damped modes there are"):
        model.modes(total + 1, damped=True)


# --- shapes, masses, energies ---------------------------------------------------------------------


STRUCTURES = (rd.Resonator(0.3, 0.02, 20.0), rd.BrokenWire(0.8, 0.2, 2e-3, radius=2e-3))


@pytest.mark.parametrize("kind", [{}, {"elements": 20}])
@pytest.mark.parametrize("ends", ["clamped", "free"])
def test_undamped_structures_have_the_modes_they_have(kind, ends):
    model = taut(*STRUCTURES, rope=BEAM, ends=(ends, ends)).compile(**kind)
    modes, damped = model.modes(8), model.modes(8, damped=True)
    assert damped.certified
    # two searches, each to its estimate
    apart = np.abs(damped.frequency - modes.frequency)
    assert (apart <= modes.rounding_error + damped.rounding_error).all()
    assert np.allclose(damped.modal_mass, modes.modal_mass, rtol=16 * EPS, atol=0)
    assert np.allclose(damped.shape, modes.shape, rtol=0, atol=16 * EPS)
    for name, share in modes.energy.items():
        assert np.allclose(damped.energy[name], share, rtol=0, atol=32 * EPS)


def test_little_damping_changes_modes_little():
    # searched, not in closed form: shapes by residues, wires by Galerkin's method
    small = 1e-9
    model = taut(*STRUCTURES, rd.Dashpot(0.3, small), rope=BEAM).compile()
    modes, damped = taut(*STRUCTURES, rope=BEAM).compile().modes(8), model.modes(8, damped=True)
    assert damped.certified
    assert np.allclose(damped.frequency, modes.frequency, rtol=1e-9, atol=0)
    assert (damped.damping_ratio < 1e-9).all()
    # of small/(m omega), 1e-9; residues are as good as 1e-12
    assert np.allclose(damped.modal_mass, modes.modal_mass, rtol=1e-8, atol=0)
    for name, share in modes.energy.items():
        assert np.allclose(damped.energy[name], share, rtol=0, atol=1e-8)


def test_rayleigh_damping_by_mass_takes_structures_along():
    # s^2 + a s = -omega^2
    a = 30.0
    modes = taut(*STRUCTURES, rope=BEAM).compile().modes(6)
    damped = taut(*STRUCTURES, rope=BEAM, damping=rd.RayleighDamping(a, 0.0)).compile()
    damped = damped.modes(6, damped=True)
    omega = 2 * np.pi * modes.frequency
    assert np.allclose(damped.eigenvalue, -a / 2 + 1j * np.sqrt(omega**2 - a**2 / 4), rtol=1e-14)


@pytest.mark.parametrize("part", [rd.Resonator(0.3, 0.02, 20.0, damping_ratio=0.2), STRUCTURES[0]])
def test_modes_of_a_chain_with_a_resonator_are_the_response(part):
    # H = sum of shape shape^T/(2 s m)/(i omega - s) over s and its conjugate
    scene = taut(part, rd.Dashpot(0.9, 0.3))
    model = scene.compile(elements=5, element="rigid")
    total = len(quadratic(taut(scene.parts[1]), [part], elements=5, element="rigid"))
    modes = model.modes(total, damped=True)
    x, f = model.x, np.array([3.0, 40.0, 300.0])
    frf = model.frf(f, drive=("z", x[2]), response=("z", x[3]))
    value = np.zeros(3, dtype=complex)
    for s, m, shape in zip(modes.eigenvalue, modes.modal_mass, modes.shape[:, :, 0]):
        residue = shape[2] * shape[3] / (2 * s * m)
        value += residue / (2j * np.pi * f - s)
        if s.imag > 0:
            value += np.conj(residue) / (2j * np.pi * f - np.conj(s))
    # a few modes of 1e-13 each, which cancel by some 1e3
    assert np.allclose(value, frf.value[0], rtol=1e-9, atol=0)


def test_energies_of_an_overdamped_absorber_are_those_of_its_mass_and_spring():
    # one mass between two strings; |Y|^2 m beside |u|^2 M and |Y - u|^2 k beside |u|^2 K
    absorber = rd.Resonator(L / 2, 0.02, 20.0, damping_ratio=1.5)
    modes = taut(absorber).compile(elements=2, element="rigid").modes(3, damped=True)
    M, K = MU * L / 2, 4 * T / L
    m, k, c = numbers(absorber)
    s = modes.eigenvalue
    Y = (k + c * s) / (k + c * s + m * s**2)
    mass, spring = m * np.abs(Y) ** 2, k * np.abs(Y - 1) ** 2
    assert np.allclose(modes.energy["resonator mass"], mass / (mass + M), rtol=1e-12, atol=0)
    assert np.allclose(modes.energy["resonator"], spring / (spring + K), rtol=1e-12, atol=0)


def test_modal_damping_is_refused_beside_a_damped_resonator():
    part = rd.Resonator(0.3, 0.02, 20.0, damping_ratio=0.2)
    with pytest.raises(rd.SceneError, match=r"modal damping beside another.*got resonator"):
        taut(part, damping=rd.ModalDamping(0.01)).compile().modes(3, damped=True)


def test_table_of_damped_modes_has_shares_that_sum_to_one():
    absorber = rd.Resonator(0.3, 0.1, 5.0, damping_ratio=0.1)
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[absorber])
    for row in scene.compile().modes(2, damped=True).table().to_records():
        for kind in ("kinetic", "strain"):
            shares = [value for name, value in row.items() if name.startswith(kind)]
            assert sum(shares) == pytest.approx(100.0, rel=1e-9)
