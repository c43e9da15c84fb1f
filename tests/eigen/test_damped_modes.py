"""Complex modes against closed forms, many digits and the dense quadratic eigenproblem."""

import math
import pickle

import mpmath
import numpy as np
import pytest
import scipy.linalg
from conftest import EPS, reference

import ropedyn as rd

L, T, MU = 1.3, 200.0, 0.1
Z = math.sqrt(T * MU)
"""Impedance of the string [N s/m]."""
OMEGA = math.pi / L * math.sqrt(T / MU)
"""Its first angular frequency [rad/s]."""
REFERENCE = reference("string_point_damper")


def string(*parts, ends=("clamped", "clamped"), **more):
    return rd.Scene(rd.Rope(L, MU), tension=T, parts=parts, ends=ends, **more)


def beam(*parts, **more):
    rope = rd.Rope(L, MU, bending_stiffness=2.0)
    return rd.Scene(rope, tension=T, parts=parts, **more)


def quadratic(model):
    """All roots with Im s >= 0 of det(s^2 M + s C + K), by the companion pencil, lowest first."""
    K, C, M = (
        part().toarray()
        for part in (model.stiffness_matrix, model.damping_matrix, model.mass_matrix)
    )
    unit = 1 / np.sqrt(K.diagonal())
    K, C, M = (unit[:, None] * part * unit for part in (K, C, M))
    omega = 1 / math.sqrt(np.abs(M).max())
    one, none = np.eye(len(K)), np.zeros(K.shape)
    left = np.block([[none, one], [-K, -omega * C]])
    s = scipy.linalg.eigvals(left, np.block([[one, none], [none, omega**2 * M]]))
    s = omega * s[np.isfinite(s)]
    s = s[(s.imag >= -1e-9 * np.abs(s)) & (np.abs(s) < 1e12)]
    return s[np.argsort(np.abs(s))]


# --- a string and one dashpot ---------------------------------------------------------------------


@pytest.mark.parametrize("case", REFERENCE["eigenvalues"])
def test_string_with_a_dashpot_has_the_roots_of_60_digits(case):
    x1, c = (float(part.partition("=")[2]) for part in case.split("|"))
    modes = string(rd.Dashpot(x1 * L, c * Z)).compile().modes(6, damped=True)
    assert modes.certified
    exact = [complex(float(row["re"]), float(row["im"])) for row in REFERENCE["eigenvalues"][case]]
    oscillates = modes.frequency > 0  # a stiff dashpot makes one overdamped mode more
    # to the estimated error, and 4 eps of the float units Z, OMEGA and x1 L
    error = (2 * np.pi * modes.rounding_error + 4 * EPS * np.abs(modes.eigenvalue))[oscillates][:5]
    assert (np.abs(modes.eigenvalue[oscillates][:5] - np.array(exact) * OMEGA) < error).all()


@pytest.mark.parametrize("case", REFERENCE["optimum"])
def test_optimum_damping_of_a_string_is_that_of_the_universal_curve(case):
    x1, mode = (float(part.partition("=")[2]) for part in case.split("|"))
    row = {key: float(value) for key, value in REFERENCE["optimum"][case].items()}
    ratio = []
    for c in np.array([0.99, 1.0, 1.01]) * row["c_hat_opt"]:
        modes = string(rd.Dashpot(x1 * L, c * Z)).compile().modes(int(mode) + 1, damped=True)
        near = np.abs(modes.eigenvalue / OMEGA - complex(row["re"], row["im"])).argmin()
        ratio.append(modes.damping_ratio[near])
    assert ratio[1] > max(ratio[0], ratio[2])
    # a maximum: an error of c does not show; of s relative 1e-14, 1e2 times that of Re s
    assert ratio[1] == pytest.approx(row["zeta_max"], rel=1e-11)
    # Pacheco, Fujino and Sulekh: 0.52 x1/L; 0.5 in the limit of a dashpot near the end
    assert 0.5 < ratio[1] / x1 < 0.54


def newton(function, s):
    """Newton's step |f/f'| of a function in 40 digits."""
    with mpmath.workdps(40):
        s = mpmath.mpc(s)
        h = abs(s) * mpmath.mpf(10) ** -15
        f, later, before = function(s), function(s + h), function(s - h)
        return float(abs(f / (later - before) * 2 * h))


def exact_string(x1, c):
    """The determinant sinh(s L/v) + (c/Z) sinh(s x1/v) sinh(s (L - x1)/v), v the speed of waves, of
    the floats that the scene has."""

    def f(s):
        v, z = mpmath.sqrt(mpmath.mpf(T) / MU), mpmath.sqrt(mpmath.mpf(T) * MU)
        ends = mpmath.sinh(s * x1 / v) * mpmath.sinh(s * (mpmath.mpf(L) - x1) / v)
        return mpmath.sinh(s * mpmath.mpf(L) / v) + c / z * ends

    return f


def count_exactly(x1, c, radius):
    """Roots of the same in a circle, without that at 0, by 20000 points around it."""
    lam = radius * np.exp(2j * np.pi * np.arange(20001) / 20000)
    f = np.sinh(np.pi * lam) + c * np.sinh(np.pi * lam * x1) * np.sinh(np.pi * lam * (1 - x1))
    return round(np.angle(f[1:] / f[:-1]).sum() / (2 * np.pi)) - 1


@pytest.mark.parametrize("x1", [0.02, 0.31, 0.5])
@pytest.mark.parametrize("c", [0.01, 0.3, 1.0, 1.99, 2.0, 2.01, 5.0, 100.0])
@pytest.mark.claim(
    "Complex modes of a string with a dashpot of c/Z from 0.01 to 100: distance / estimate",
    reference="Newton's step of the closed form in 40 digits; none missed or doubled",
    accepted=1.0,
)
def test_no_root_of_a_damped_string_is_missed_or_doubled(x1, c, claim):
    radius = 8.53
    model = string(rd.Dashpot(x1 * L, c * Z)).compile()
    modes = model.modes(below=radius * OMEGA / (2 * np.pi), damped=True)
    pairs = (modes.eigenvalue.imag > 0).sum()
    assert modes.certified
    assert 2 * pairs + (len(modes.eigenvalue) - pairs) == count_exactly(x1, c, radius)
    assert len(set(modes.eigenvalue)) == len(modes.eigenvalue)
    for s, error in zip(modes.eigenvalue, 2 * np.pi * modes.rounding_error):
        claim(newton(exact_string(x1 * L, c * Z), s) / error)


def test_matched_end_lets_no_motion_stay():
    scene = string(ends=("clamped", rd.End(z="free", dashpot={"z": Z})))
    modes = scene.compile().modes(below=3.9 * OMEGA / (2 * np.pi), damped=True)
    assert modes.certified
    assert len(modes.eigenvalue) == 0
    assert modes.shape.shape == (0, len(modes.x), 1)
    # higher up rounding of c/Z = 1 puts roots anywhere beyond the decay rate -log(eps) c/2 L
    with pytest.raises(rd.SolveError, match="matches the rope's impedance"):
        scene.compile().modes(10, damped=True)


@pytest.mark.parametrize("number", [12, 14, 24])
@pytest.mark.claim(
    "Complex modes of a string with a dashpot of twice its impedance: distance / estimate",
    reference="Newton's step of exp(t) - cosh(0.4 t) in 40 digits; none missed or doubled",
    accepted=1.0,
)
def test_twice_the_impedance_has_the_modes_of_its_closed_form(number, claim):
    # sinh t + 2 sinh(a t) sinh(b t) with a + b = 1, t = s L/v
    time = L * math.sqrt(MU / T)
    modes = string(rd.Dashpot(0.3 * L, 2 * Z)).compile().modes(number, damped=True)
    # rounding of c puts rates at log(eps)/0.6: beyond them no circle around 0 tells all
    assert not modes.certified
    assert 20 < 2 * math.pi * modes.searched * time < 61
    assert (modes.decay_rate < 2 * math.pi * modes.searched).all()
    radius = (1 + 1e-6) * np.abs(modes.eigenvalue[-1]) * time
    around = radius * np.exp(2j * np.pi * np.arange(20001) / 20000)
    f = np.exp(around) - np.cosh(0.4 * around)
    count = round(np.angle(f[1:] / f[:-1]).sum() / (2 * np.pi))
    assert count == 2 * number + 1  # and 0, no motion at all
    assert len(set(modes.eigenvalue)) == number
    for s, error in zip(modes.eigenvalue, 2 * np.pi * modes.rounding_error):
        t = mpmath.mpc(s) * L * mpmath.sqrt(mpmath.mpf(MU) / T)
        step = newton(lambda t: mpmath.exp(t) - mpmath.cosh(mpmath.mpf(4) / 10 * t), t)
        # with 4 eps of the float units
        claim(step / time / (error + 4 * EPS * abs(s)))
    assert "may be missing" in str(modes.table())


@pytest.mark.parametrize("asked", [{"number": 40}, {"below": 420.0}])
def test_twice_the_impedance_does_not_tell_all_modes(asked):
    model = string(rd.Dashpot(0.3 * L, 2 * Z)).compile()
    with pytest.raises(rd.SolveError, match="matches the rope's impedance"):
        model.modes(**asked, damped=True)


def test_nearly_matched_end_lets_motion_stay_for_log_of_the_mismatch():
    # cosh + (c/Z) sinh = 0 for c > Z: exp(2 pi lam) = (c - 1)/(c + 1), lam = log(..)/2 pi + i k
    modes = string(ends=("clamped", rd.End(z="free", dashpot={"z": 1.01 * Z}))).compile()
    modes = modes.modes(6, damped=True)
    lam = math.log(0.01 / 2.01) / (2 * math.pi) + 1j * np.arange(6)
    # 1.01 - 1 carries 1e2 eps
    assert np.allclose(modes.eigenvalue / OMEGA, lam, rtol=0, atol=200 * EPS)


@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("clamped", "free")])
def test_dashpot_at_a_node_leaves_the_mode_undamped(ends):
    place = {"clamped": L / 2, "free": 2 * L / 3}[ends[1]]
    modes = string(rd.Dashpot(place, 0.7 * Z), ends=ends).compile().modes(6, damped=True)
    still = modes.damping_ratio == 0
    wave = {"clamped": [2.0, 4.0, 6.0], "free": [1.5, 4.5]}[ends[1]]
    seen = modes.eigenvalue[still].imag / OMEGA
    assert modes.certified
    # 2 L/3 is not quite a node as a float: the damping that leaves is within the rounding error
    assert np.allclose(seen, wave[: len(seen)], rtol=8 * EPS, atol=0)
    assert len(seen) >= 2


# --- with bending ---------------------------------------------------------------------------------


def test_stiffness_damping_of_a_pinned_beam_under_tension_is_not_proportional():
    # half waves k = n pi/L stay modes: mu s^2 + T k^2 + (1 + gamma s) B k^4 = 0
    gamma = 2e-4
    scene = beam(damping=rd.StiffnessDamping(gamma), ends=("pinned", "pinned"))
    modes = scene.compile().modes(8, damped=True)
    k = np.arange(1, 9) * np.pi / L
    p = gamma * 2.0 * k**4 / (2 * MU)
    exact = -p + 1j * np.sqrt((T * k**2 + 2.0 * k**4) / MU - p**2)
    assert modes.certified
    # with 2 eps of L, T, MU each
    error = 2 * np.pi * modes.rounding_error + 8 * EPS * np.abs(exact)
    assert (np.abs(modes.eigenvalue - exact) < error).all()


def exact_beam(x1, c):
    """The determinant of a clamped beam under tension with a dashpot at x1."""

    def f(s):
        B, tension = mpmath.mpf(2), mpmath.mpf(T)
        # of z, beta, M, F: z' = beta, beta' = M/B, M' = T beta - F, F' = mu s^2 z, + c s z at once
        rate = mpmath.matrix([[0, 1, 0, 0], [0, 0, 1 / B, 0], [0, tension, 0, -1], [0] * 4])
        rate[3, 0] = mpmath.mpf(MU) * s * s
        jump = mpmath.eye(4)
        jump[3, 0] = c * s
        right = mpmath.expm(rate * (mpmath.mpf(L) - x1))
        whole = right * jump * mpmath.expm(rate * x1)
        return whole[0, 2] * whole[1, 3] - whole[0, 3] * whole[1, 2]

    return f


@pytest.mark.claim(
    "Complex modes of a tensed beam with a dashpot: distance / estimate",
    reference="Newton's step of the determinant of two spans in 40 digits",
    accepted=1.0,
)
def test_tensed_beam_with_a_dashpot_against_many_digits(claim):
    x1, c = 0.4, 60.0
    modes = beam(rd.Dashpot(x1, c)).compile().modes(6, damped=True)
    assert modes.certified
    assert (modes.frequency == 0).any()  # one is overdamped
    for s, error in zip(modes.eigenvalue, 2 * np.pi * modes.rounding_error):
        claim(newton(exact_beam(x1, c), s) / error)


@pytest.mark.parametrize("element", ["difference", "rigid"])
@pytest.mark.parametrize("seed", range(12))
def test_chains_have_the_roots_of_the_quadratic_eigenproblem(seed, element):
    random = np.random.default_rng([seed, len(element)])
    more = {} if seed % 3 == 0 else {"bending_stiffness": 10 ** random.uniform(-2, 1)}
    if seed % 3 == 2:
        more |= {"torsional_stiffness": 3.0, "polar_inertia": 1e-4, "lay_slope": 0.3}
    if element == "difference":
        more = {"bending_stiffness": 2.0, "rotary_inertia": 1e-3}
    parts = [rd.Dashpot(x, 10 ** random.uniform(-2, 2) * Z) for x in random.uniform(0, L, seed % 4)]
    parts += [rd.PointMass(random.uniform(0, L), 0.3), rd.Spring(random.uniform(0, L), 1e3)]
    damping = rd.StiffnessDamping(1e-6) if seed % 2 and "lay_slope" not in more else None
    tension = 0.0 if element == "difference" else T
    scene = rd.Scene(rd.Rope(L, MU, **more), tension=tension, parts=parts, damping=damping)
    model = scene.compile(elements=int(random.integers(5, 25)), element=element)
    exact = quadratic(model)
    modes = model.modes(8, damped=True)
    assert modes.certified
    # LAPACK's backward error: eps of the pencil's norm, 1e9 of these rates at most
    assert np.allclose(modes.eigenvalue, exact[:8], rtol=1e-6, atol=0)


@pytest.mark.parametrize("tension", [-20.0, -60.0])
def test_compressed_beam_with_dashpot_and_hinge_moves_or_grows_as_its_matrices_say(tension):
    parts = [rd.Dashpot(0.3 * L, 1.0), rd.Hinge(0.5, stiffness=40.0)]
    rope = rd.Rope(L, MU, bending_stiffness=2.0, rotary_inertia=1e-5)
    model = rd.Scene(rope, tension=tension, parts=parts).compile(elements=12, element="rigid")
    modes, exact = model.modes(6, damped=True), quadratic(model)[:6]
    assert np.allclose(modes.eigenvalue, exact, rtol=1e-9, atol=0)  # n^4 eps of the stiffness
    assert modes.certified
    assert (modes.damping_ratio == -1).any() == (tension == -60.0)


def test_a_hundred_modes_between_two_dashpots_are_certified():
    modes = string(rd.Dashpot(0.3 * L, 3 * Z), rd.Dashpot(0.71 * L, 0.4 * Z)).compile()
    modes = modes.modes(100, damped=True)
    assert modes.certified
    assert (np.diff(np.abs(modes.eigenvalue)) > 0).all()


def test_two_dashpots_at_mirrored_places_keep_symmetric_and_antisymmetric_modes_apart():
    # stiff dashpots cut the string in three, the outer two alike: pairs of nearly equal rates
    dashpots = [rd.Dashpot(x * L, 300 * Z) for x in (0.3, 0.7)]
    model = string(*dashpots).compile(elements=20)
    modes, exact = model.modes(10, damped=True), quadratic(model)
    assert modes.certified
    assert np.allclose(modes.eigenvalue, exact[:10], rtol=1e-10, atol=0)  # n^2 eps of LAPACK
    shape = modes.shape[:, :, 0]
    mirrored = np.abs(np.abs(shape) - np.abs(shape[:, ::-1])).max(axis=1)
    # residues on a circle as wide as the pair is apart, some 1e-2 of the rates
    assert mirrored.max() < 1e-9


@pytest.mark.parametrize("number", [1, 2, 3])
@pytest.mark.parametrize("c", [3.0, 4.5, 6.0, 10.0, 30.0])
def test_an_overdamped_rate_beside_a_pair_is_found_from_a_pair_too_few(c, number):
    # an odd number of rates, and guesses in pairs: images that meet a root are roots of their own
    dashpots = [rd.Dashpot(0.45 * L, c * Z), rd.Dashpot(0.8 * L, 0.5 * c * Z)]
    model = beam(*dashpots, damping=rd.ViscousDamping(20.0)).compile(elements=16, element="rigid")
    modes, exact = model.modes(number, damped=True), quadratic(model)
    assert modes.certified
    assert np.allclose(modes.eigenvalue, exact[:number], rtol=1e-9, atol=0)  # n^4 eps of LAPACK


def test_image_that_meets_a_root_is_a_root_of_its_own():
    # three rates within the circle: a pair that the last guess alone finds, so that of the pair of
    # guesses before it one goes where its image is, and the other has to find the overdamped one
    rope = rd.Rope(12.378695825359959, 0.01705792170243113, bending_stiffness=28.41256263985497)
    parts = [
        rd.Dashpot(11.288729965739542, 22.609733249571693),
        rd.Dashpot(5.15630733138573, 0.7584321680680105),
        rd.Resonator(
            6.2216392902850455, 0.1402241195309332, 57.6331968448355, damping_ratio=0.04186
        ),
        rd.Resonator(10.065880610757866, 0.0017541776988213612, 32.297610780552525),
    ]
    scene = rd.Scene(rope, tension=9207.218693066528, parts=parts, ends=("clamped", "free"))
    modes = scene.compile().modes(1, damped=True)
    assert modes.certified
    assert modes.frequency == 0
    assert modes.decay_rate > 0


def critical(c):
    """One mass between two strings with a dashpot: m s^2 + c s + k = 0."""
    model = rd.Scene(rd.Rope(1.0, 2.0), tension=1.0, parts=[rd.Dashpot(0.5, c)])
    return model.compile(elements=2)  # m = 1, k = 4


@pytest.mark.parametrize("c", [3.9, 4.0, 4.0 + 1e-9, 4.1, 400.0])
def test_one_mass_is_overdamped_beyond_twice_the_root_of_k_m(c):
    modes = critical(c).modes(1 if c < 4 else 2, damped=True)
    root = np.sqrt(complex(c * c / 4 - 4))
    fast = -c / 2 - root
    exact = np.array([fast.conjugate()] if c < 4 else [4 / fast, fast])
    assert modes.certified
    assert (np.abs(modes.eigenvalue - exact) <= 2 * np.pi * modes.rounding_error).all()
    if c == 4:
        # a double root: a relative 1e-15 of the polynomial moves it by 3e-8
        assert (2 * np.pi * modes.rounding_error < 1e-6).all()
    with pytest.raises(rd.SolveError, match="number must be at most"):
        critical(c).modes(3, damped=True)


# --- resonators -----------------------------------------------------------------------------------


def exact_absorber(x1, m, k, c):
    """The determinant of a string with a mass m on a spring k and a dashpot c at x1."""

    def f(s):
        v, z = mpmath.sqrt(mpmath.mpf(T) / MU), mpmath.sqrt(mpmath.mpf(T) * MU)
        spring = k + s * c
        felt = s * m * spring / (spring + s * s * m) / z
        ends = mpmath.sinh(s * x1 / v) * mpmath.sinh(s * (mpmath.mpf(L) - x1) / v)
        return mpmath.sinh(s * mpmath.mpf(L) / v) + felt * ends

    return f


@pytest.mark.parametrize("ratio", [0.0, 0.1, 1.5, 20.0])
def test_tuned_absorber_splits_a_mode_as_its_determinant_says(ratio):
    x1, m, f = 0.4 * L, 0.02, 12.0
    omega = 2 * math.pi * f
    k, c = m * omega**2, 2 * ratio * m * omega
    modes = string(rd.Resonator(x1, m, f, damping_ratio=ratio)).compile().modes(7, damped=True)
    assert modes.certified
    # what the resonator's own numbers round to moves it by 4 eps of |s|
    for s, error in zip(modes.eigenvalue, 2 * np.pi * modes.rounding_error):
        assert newton(exact_absorber(x1, m, k, c), s) < error + 4 * EPS * abs(s)
    if ratio == 0:
        undamped = string(rd.Resonator(x1, m, f)).compile().modes(7)
        assert np.allclose(modes.frequency, undamped.frequency, rtol=1e-14, atol=0)
        assert np.allclose(modes.modal_mass, undamped.modal_mass, rtol=1e-11, atol=0)
        for name, share in undamped.energy.items():
            assert np.allclose(modes.energy[name], share, rtol=0, atol=1e-10)


def test_rates_do_not_depend_on_poles_of_the_resonator():
    # far overdamped its spring is a rod but for slow motion, s near -k/c: that of a point mass
    rod = string(rd.Resonator(0.4, 0.02, 12.0, damping_ratio=1e6)).compile().modes(6, damped=True)
    mass = string(rd.PointMass(0.4, 0.02)).compile().modes(5)
    assert rod.certified
    assert (rod.frequency == 0).sum() == 1
    # m omega/c, 4e-4 of the share that the mass has in a mode, and its square undamped
    assert np.allclose(rod.frequency[1:], mass.frequency, rtol=1e-4, atol=0)


# --- proportional damping -------------------------------------------------------------------------


@pytest.mark.parametrize("elements", [None, 12])
def test_undamped_complex_modes_are_the_modes(elements):
    model = beam().compile(elements=elements)
    modes, damped = model.modes(6), model.modes(6, damped=True)
    assert np.allclose(damped.frequency, modes.frequency, rtol=2 * EPS, atol=0)
    assert damped.certified
    assert not damped.damping_ratio.any()
    assert np.allclose(damped.modal_mass, modes.modal_mass, rtol=8 * EPS, atol=0)
    assert np.allclose(damped.shape, modes.shape, rtol=0, atol=8 * EPS)
    assert (damped.family == modes.family).all()
    for name, share in modes.energy.items():
        assert np.allclose(damped.energy[name], share, rtol=0, atol=16 * EPS)


def test_rayleigh_damping_is_closed_and_overdamps_the_first_mode():
    a, b = 300.0, 1e-5
    modes = beam(damping=rd.RayleighDamping(a, b)).compile().modes(6, damped=True)
    omega = 2 * np.pi * beam().compile().modes(6).frequency
    p = (a + b * omega**2) / 2
    exact = np.concatenate(
        [-p + np.sqrt(p * p - omega**2 + 0j), -p - np.sqrt(p * p - omega**2 + 0j)]
    )
    exact = exact[exact.imag >= 0]
    exact = exact[np.argsort(np.abs(exact))][:6]
    # of frequencies 1e-15, times 2 where p^2 - omega^2 cancels
    assert np.allclose(modes.eigenvalue, exact, rtol=1e-14, atol=0)
    assert (modes.damping_ratio[:2] == 1).all()
    assert (modes.frequency[:2] == 0).all()


def test_closed_form_and_search_agree():
    from ropedyn.eigen.damped.damped_roots import Undamped, _searched
    from ropedyn.eigen.damped.rates import Rates

    scene = beam(damping=rd.RayleighDamping(300.0, 1e-5))
    model = scene.compile()
    closed = model.modes(6, damped=True)
    radius = np.abs(closed.eigenvalue[-1]) * 1.01
    searched = _searched(Undamped(model.chain), Rates.of(scene.dampings), radius, 9e4)
    error = searched.error[:6] + 2 * np.pi * closed.rounding_error
    assert searched.certified
    assert (np.abs(searched.value[:6] - closed.eigenvalue) <= error).all()


def test_overdamped_modes_accumulate_where_damping_cancels_stiffness():
    # B alone: s^2 + gamma lambda s + lambda = 0, whose slow rate tends to -1/gamma
    rope = rd.Rope(L, MU, bending_stiffness=2.0)
    scene = rd.Scene(rope, damping=rd.StiffnessDamping(1e-3))
    with pytest.raises(rd.SolveError, match="infinitely many overdamped modes accumulate"):
        scene.compile().modes(30, damped=True)
    # a chain has finitely many: two rates of each undamped mode, a pair of the slower ones
    model = scene.compile(elements=12)
    pairs = (2 * np.pi * model.modes(11).frequency < 2e3).sum()
    modes = model.modes(22 - pairs, damped=True)
    assert 0 < pairs == (modes.frequency > 0).sum() < 11
    with pytest.raises(rd.SolveError, match=f"number must be at most {22 - pairs}, .* there are"):
        model.modes(22, damped=True)


@pytest.mark.parametrize("ratio", [0.02, [0.01, 0.3, 0.0], 1.0, 1.5])
def test_modal_damping_is_a_ratio_for_each_mode(ratio):
    scene = beam(damping=rd.ModalDamping(ratio))
    undamped = beam().compile().modes(3)
    modes = scene.compile().modes(3, damped=True)
    omega = 2 * np.pi * undamped.frequency
    zeta = np.broadcast_to(ratio, 3)
    root = np.sqrt(zeta**2 - 1 + 0j)
    exact = np.concatenate([omega * (-zeta + root), omega * (-zeta - root)])
    exact = exact[(exact.imag >= 0)]
    exact = exact[np.argsort(np.abs(exact), kind="stable")][:3]
    # of frequencies 1e-15; 1.5 - sqrt(1.25) here cancels by 4
    assert np.allclose(modes.eigenvalue, exact, rtol=1e-14, atol=0)
    assert modes.certified
    if np.max(ratio) < 1:
        assert np.array_equal(modes.shape, undamped.shape)
        share = 1 + zeta * omega / modes.eigenvalue
        assert np.allclose(modes.modal_mass, undamped.modal_mass * share, rtol=8 * EPS, atol=0)
    chain = scene.compile(elements=16).modes(3, damped=True)
    apart = np.abs(chain.eigenvalue - modes.eigenvalue) / (2 * np.pi)
    assert np.allclose(chain.mesh_error, apart, rtol=1e-6, atol=1e-12)


def test_modal_damping_stands_alone_and_knows_every_mode():
    with pytest.raises(rd.SceneError, match=r"damping must not be modal damping beside .* dashpot"):
        beam(rd.Dashpot(0.3, 1.0), damping=rd.ModalDamping(0.1)).compile().modes(2, damped=True)
    model = beam(damping=rd.ModalDamping([0.1, 0.2])).compile(elements=4)
    with pytest.raises(rd.SceneError, match="one for each mode, got 2 for 3 modes"):
        model.modes(3, damped=True)
    with pytest.raises(rd.SolveError, match="number must be at most 3"):
        beam(damping=rd.ModalDamping(0.1)).compile(elements=4).modes(5, damped=True)


def test_loss_factor_with_tension_turns_each_rate():
    # half waves k = n pi/L stay modes: mu s^2 + T k^2 + (1 + i eta) B k^4 = 0 above the real axis
    scene = beam(damping=rd.LossFactor(0.1), ends=("pinned", "pinned"))
    modes = scene.compile().modes(6, damped=True)
    k = np.arange(1, 7) * np.pi / L
    exact = 1j * np.sqrt((T * k**2 + (1 + 0.1j) * 2.0 * k**4) / MU)
    assert modes.certified
    # with 2 eps of L, T, MU each
    error = 2 * np.pi * modes.rounding_error + 8 * EPS * np.abs(exact)
    assert (np.abs(modes.eigenvalue - exact) < error).all()


@pytest.mark.parametrize("coefficient", [3.0, 300.0])
def test_viscous_damping_beside_a_mass_that_it_does_not_act_on(coefficient):
    # proportional but for the mass: in a chain and, within its mesh error, in continuous spans
    scene = string(rd.PointMass(0.4, 1.0), damping=rd.ViscousDamping(coefficient))
    model = scene.compile(elements=24)
    modes, exact = model.modes(7, damped=True), quadratic(model)[:7]
    assert np.allclose(modes.eigenvalue, exact, rtol=1e-10, atol=0)  # n^2 eps, 1e2 of overdamped
    assert modes.certified
    # (omega l/v)^2/24, at most 0.01, and more where a rate is the difference of two
    assert (modes.mesh_error < 0.1 * modes.natural_frequency).all()


# --- shapes ---------------------------------------------------------------------------------------


def test_all_modes_together_are_the_response():
    # H = sum of shape shape^T/(2 s m) 1/(i omega - s) over s and its conjugate
    scene = beam(rd.Dashpot(0.3, 3 * Z), ends=("clamped", "free"))
    rope = scene.rope.replace(rotary_inertia=1e-4)
    model = scene.replace(rope=rope).compile(elements=5, element="rigid")
    modes = model.modes(len(quadratic(model)), damped=True)
    x, f = model.x, np.array([3.0, 40.0, 300.0])
    frf = model.frf(f, drive=("z", x[2]), response=[("z", x[4]), ("beta", x[5])])
    rows = modes.shape[:, [2, 4, 5], [0, 0, 1]]
    total = np.zeros((2, 3), dtype=complex)
    for s, m, (drive, *watched) in zip(modes.eigenvalue, modes.modal_mass, rows):
        residue = np.array(watched) * drive / (2 * s * m)
        total += residue[:, None] / (2j * np.pi * f - s)
        if s.imag > 0:
            total += residue.conj()[:, None] / (2j * np.pi * f - s.conj())
    # ten modes of 1e-13 each, which cancel by some 1e2
    assert np.allclose(total, frf.value, rtol=1e-10, atol=0)


def test_shape_of_a_damped_string_is_two_waves_that_meet_at_the_dashpot():
    x1 = 0.3 * L
    modes = string(rd.Dashpot(x1, 1.2 * Z)).compile().modes(4, damped=True, points=40)
    assert modes.shape.shape == (4, 81, 1)
    for s, shape in zip(modes.eigenvalue, modes.shape[:, :, 0]):
        k = s / math.sqrt(T / MU)
        left = np.sinh(k * modes.x) / np.sinh(k * x1)
        right = np.sinh(k * (L - modes.x)) / np.sinh(k * (L - x1))
        exact = np.where(modes.x < x1, left, right)
        exact /= exact[np.abs(shape).argmax()]
        # a circle of 0.1 of the distance to the next rate: 10 times 1e-14 of the response
        assert np.allclose(shape, exact, rtol=0, atol=1e-12)
        assert np.abs(shape).max() == pytest.approx(1, abs=4 * EPS)


@pytest.mark.parametrize("c", [1.0, 100.0])
def test_free_rope_moves_as_a_body_that_a_dashpot_stops(c):
    rope = rd.Rope(L, MU, bending_stiffness=2.0)
    scene = rd.Scene(rope, ends=("free", "free"), parts=[rd.Dashpot(0.2 * L, c * Z)])
    modes = scene.compile().modes(6, damped=True)
    assert modes.certified
    # it may stand anywhere and at any angle: two modes, s = 0
    assert (modes.eigenvalue == 0).sum() == 2
    assert (modes.eigenvalue[2:].real < 0).all()
    for shape in modes.shape[:2]:
        line = shape[0, 0] + modes.x / L * (shape[-1, 0] - shape[0, 0])
        assert np.allclose(shape[:, 0], line, rtol=0, atol=1e-12)  # measured 1e-14
    assert np.allclose(modes.energy["bending"][:2], 0)


def test_mesh_error_of_damped_chains_is_their_distance_to_the_continuous_spans():
    scene = beam(rd.Dashpot(0.4, 3 * Z))
    exact = scene.compile().modes(5, damped=True)
    assert not exact.mesh_error.any()
    errors = []
    for elements in (16, 32):
        modes = scene.compile(elements=elements).modes(5, damped=True)
        apart = np.abs(modes.eigenvalue - exact.eigenvalue) / (2 * np.pi)
        # the matched modes of a search around more modes: as good as rounding
        assert np.allclose(modes.mesh_error, apart, rtol=1e-6, atol=1e-10)
        errors.append(modes.mesh_error)
    # tensed elements are of fourth order, and of second where the dashpot stands
    assert (errors[1] < 0.3 * errors[0]).all()


def test_components_and_spans_are_searched_for_themselves():
    rope = rd.Rope(L, MU, bending_stiffness=2.0, torsional_stiffness=3.0, polar_inertia=1e-4)
    parts = [rd.Support(0.6 * L), rd.Dashpot(0.2, 5.0), rd.Dashpot(0.9, 0.01, coordinate="alpha")]
    model = rd.Scene(rope, tension=T, parts=parts).compile(elements=10, element="rigid")
    modes, exact = model.modes(9, damped=True), quadratic(model)
    assert modes.certified
    assert {"transverse", "torsional"} <= set(modes.family)
    assert np.allclose(modes.eigenvalue, exact[:9], rtol=1e-8, atol=0)  # n^2 eps, ratios of units


# --- the answer -----------------------------------------------------------------------------------


def test_answer_is_read_saved_and_drawn(tmp_path):
    modes = string(rd.Dashpot(0.4, 0.5 * Z)).compile().modes(3, damped=True)
    assert np.array_equal(modes.decay_rate, -modes.eigenvalue.real)
    assert np.allclose(modes.damping_ratio, -modes.eigenvalue.real / np.abs(modes.eigenvalue))
    assert modes.searched == pytest.approx(modes.natural_frequency[-1])
    assert string().compile().modes(below=40.0, damped=True).searched == 40.0
    assert modes.cost.sweeps > 0
    assert "damping ratio" in str(modes)
    modes.save(tmp_path / "modes.nc")
    again = rd.load(tmp_path / "modes.nc")
    for copy in (again, pickle.loads(pickle.dumps(modes))):
        assert np.array_equal(copy.eigenvalue, modes.eigenvalue)
        assert np.array_equal(copy.shape, modes.shape)
    ax = modes.plot()
    assert len(ax.lines) == 4


@pytest.mark.parametrize(
    ("error", "text", "arguments"),
    [
        (TypeError, "damped must be True or False, got 1", {"number": 3, "damped": 1}),
        (TypeError, "damped must be True or False, got None", {"number": 3, "damped": None}),
        (rd.SceneError, "give either number or below", {"damped": True}),
        (rd.SceneError, "below must be a finite number", {"below": math.nan, "damped": True}),
        (rd.SceneError, "number must be a whole number", {"number": 0, "damped": True}),
        (
            rd.SceneError,
            'solver must be "sweep"',
            {"number": 1, "solver": "lapack", "damped": True},
        ),
    ],
)
def test_bad_questions_are_refused(error, text, arguments):
    with pytest.raises(error, match=text):
        string().compile().modes(**arguments)


# --- rounding -------------------------------------------------------------------------------------


def string_rates(tension):
    """Eight omega of a string of 2 m and 0.1 kg/m."""
    first = mpmath.pi / 2 * mpmath.sqrt(tension / mpmath.mpf(0.1))
    return [n * first for n in range(1, 9)]


def hertz_beside(modes, rates):
    """Errors of frequencies and decay rates/2 pi over `rounding_error`, against exact rates."""
    for s, mine, decay, error in zip(
        rates, modes.frequency, modes.decay_rate, modes.rounding_error, strict=True
    ):
        off = [mpmath.mpf(mine) - s.imag / (2 * mpmath.pi)]
        off.append((mpmath.mpf(decay) + s.real) / (2 * mpmath.pi))
        yield float(max(map(abs, off)) / error)


def test_frequencies_in_hertz_are_right_to_their_rounding_error():
    # the division by 2 pi rounds too, which is much of the error of such a string
    random = np.random.default_rng(900_000)
    with mpmath.workdps(40):
        for _ in range(20):
            tension, drag = random.uniform(100.0, 1000.0), random.uniform(0.1, 3.0)
            scene = rd.Scene(rd.Rope(2.0, 0.1), tension=tension, damping=rd.ViscousDamping(drag))
            modes = scene.compile().modes(8, damped=True)
            half = mpmath.mpf(drag) / (2 * mpmath.mpf(0.1))
            omega = [
                n * mpmath.pi / 2 * mpmath.sqrt(tension / mpmath.mpf(0.1)) for n in range(1, 9)
            ]
            rates = [mpmath.mpc(-half, mpmath.sqrt(w * w - half * half)) for w in omega]
            assert max(hertz_beside(modes, rates)) <= 1


@pytest.mark.parametrize("short", [1e-3, 1e-8, 1e-13])
def test_modal_damping_just_short_of_critical_keeps_its_digits(short):
    # 1 - ratio^2 is known to all digits, however little is left of it
    ratio = 1 - short
    scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, damping=rd.ModalDamping(ratio))
    modes = scene.compile().modes(8, damped=True)
    with mpmath.workdps(40):
        root = mpmath.sqrt(1 - mpmath.mpf(ratio) ** 2)
        rates = [w * mpmath.mpc(-ratio, root) for w in string_rates(1000.0)]
        assert max(hertz_beside(modes, rates)) <= 1
        # 2.8e-10 where ratio^2 was rounded, at 1e-8
        for s, mine in zip(rates, modes.frequency):
            assert float(abs(mine * 2 * mpmath.pi / s.imag - 1)) < 4 * EPS
