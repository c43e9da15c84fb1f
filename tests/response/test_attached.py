"""Resonators and broken wires: structures that the rope carries, condensed to their foot."""

import dataclasses
import math

import mpmath
import numpy as np
import pytest
import random_scene
import scipy.linalg
from conftest import EPS
from mpmath import mpf

import ropedyn as rd
from ropedyn.chain.chain import CARRIED

TENSION, DENSITY, LENGTH = 100.0, 0.1, 1.0
STRING = rd.Rope(LENGTH, DENSITY)
SECOND = 31.622776601683793  # of the string alone [Hz]: sqrt(T/mu)/L
BEAM = rd.Rope(
    LENGTH,
    DENSITY,
    bending_stiffness=2.0,
    torsional_stiffness=1.0,
    rotary_inertia=1e-5,
    polar_inertia=1e-5,
)
WIRE = rd.BrokenWire(0.4, 0.05, 3e-4, radius=2e-3)  # alone 86 Hz, 539 Hz, ..
KINDS = [{}, {"elements": 40}, {"elements": 15, "element": "rigid"}]
KIND_IDS = ["continuous", "tensed", "rigid"]


def taut(*parts, rope=STRING, **changes):
    return rd.Scene(rope, tension=TENSION, parts=parts, **changes)


def omega(f, m=mpmath.mp):
    return 2 * m.pi * m.mpf(f)


# --- paper ------------------------------------------------------------------------------------


def wire_stiffness(wire, square, m=mpmath.mp):
    """Numerators of (D_zz, D_z,beta, D_beta,beta) of a cantilever's root and of its tip's motion.

    And their denominator; m is mpmath.mp or mpmath.fp.

    R. E. D. Bishop, D. C. Johnson, The Mechanics of Vibration (1960), table 7.1.
    """
    d = m.mpf(wire.diameter)
    area, inertia = m.pi * d**2 / 4, m.pi * d**4 / 64
    EI, length = wire.youngs_modulus * inertia, m.mpf(wire.length)
    EI = EI * (1 + 2j * m.mpf(wire.damping_ratio)) if wire.damping_ratio else EI
    k = m.sqrt(m.sqrt(square * wire.density * area / EI))
    x = k * length
    c, s, C, S = m.cos(x), m.sin(x), m.cosh(x), m.sinh(x)
    stiffness = (
        -EI * k**3 * (c * S + s * C),
        -EI * k**2 * s * S,
        -EI * k * (s * C - c * S),
    )
    return stiffness, (c + C, (s + S) / k), 1 + c * C


def string_frequencies(part, below):
    """Frequencies of the clamped string with D = above/gap at x.

    Zeros of gap T k sin kL + above sin kx sin k(L - x), which has no poles.
    """

    def determinant(f, *, m=mpmath.mp):
        square = omega(f, m) ** 2
        k = m.sqrt(square * m.mpf(DENSITY) / m.mpf(TENSION))
        above, gap = poles(part, square, m)
        beside = m.sin(k * m.mpf(part.x)) * m.sin(k * (LENGTH - m.mpf(part.x)))
        return gap * m.mpf(TENSION) * k * m.sin(k * LENGTH) + above * beside

    # doubles see the signs, 50 digits the zeros
    steps = np.linspace(0.1, below, 2000).tolist()
    signs = [determinant(f, m=mpmath.fp) > 0 for f in steps]
    between = [i for i in range(len(steps) - 1) if signs[i] != signs[i + 1]]
    with mpmath.workdps(50):
        return [
            mpmath.findroot(determinant, tuple(steps[i : i + 2]), solver="anderson", tol=1e-70)
            for i in between
        ]


def poles(part, square, m):
    if isinstance(part, rd.BrokenWire):
        (zz, _, _), _, gap = wire_stiffness(part, square, m)
        return zz, gap
    spring = m.mpf(part.mass) * omega(part.frequency, m) ** 2
    return -square * m.mpf(part.mass) * spring, spring - square * m.mpf(part.mass)


STRINGS = {
    "a resonator": rd.Resonator(0.3, 0.01, 20.0),
    "a heavy one": rd.Resonator(0.3, 10.0, 20.0),
    "a light one": rd.Resonator(0.3, 1e-5, 40.0),
    "a fast one": rd.Resonator(0.3, 0.01, 4000.0),
    "one tuned to the rope": rd.Resonator(0.3, 0.01, SECOND / 2),
    "a wire": rd.BrokenWire(0.3, 0.2, 2e-3, radius=0.0),
    "a long wire": rd.BrokenWire(0.3, 0.5, 1e-3, radius=0.0),
}


@pytest.mark.parametrize("what", STRINGS)
def test_frequencies_of_a_string_that_carries_are_those_on_paper(what):
    part = STRINGS[what]
    model = taut(part).compile()
    modes = model.modes(below=100.0)
    exact = string_frequencies(part, 100.0)
    assert model.count(below=100.0) == len(exact) == len(modes.frequency)
    assert modes.certified
    error = [abs(float(f - e)) for f, e in zip(modes.frequency, exact)]
    # as without a structure: a few roundings of an eigenvalue, and within what is said
    assert (error <= 16 * EPS * modes.frequency).all()
    assert (error <= modes.rounding_error + EPS * modes.frequency).all()


# seeds of frequencies, each with a resonator and a wire
@pytest.mark.parametrize("seed", range(30))
def test_rounding_error_bounds_the_true_error_at_the_foot_and_at_the_tip(seed):
    random = np.random.default_rng(seed)
    x, zeta = float(random.uniform(0.1, 0.9)), float(random.choice([0.0, 0.01]))
    wire = rd.BrokenWire(x, 0.1, 5e-4, radius=0.0, damping_ratio=zeta)
    own = rd.Resonator(x, 0.02, 20.0).frequency if random.random() < 0.5 else wire.frequency
    f = own * float(1 + random.choice([-1, 1]) * random_scene.log_uniform(random, 1e-9, 1.0))
    parts = (wire, rd.Resonator(x, 0.02, 20.0))
    frf = taut(*parts).compile().frf(f, drive=("z", x), response=[("z", x), ("wire", 0)])
    with mpmath.workdps(50):
        square = omega(f) ** 2
        k = mpmath.sqrt(square * mpf(DENSITY) / mpf(TENSION))
        across = mpmath.sin(k * mpf(x)) * mpmath.sin(k * (LENGTH - mpf(x)))
        stiffness = mpf(TENSION) * k * mpmath.sin(k * LENGTH) / across
        (zz, _, _), tip, gap = wire_stiffness(wire, square)
        above, below = poles(parts[1], square, mpmath.mp)
        foot = 1 / (stiffness + zz / gap + above / below)
        exact = np.array([foot, tip[0] / gap * foot], dtype=np.complex128)
    error = np.abs(frf.value[:, 0] - exact)
    assert (error <= (frf.rounding_error[:, 0] + EPS) * np.abs(frf.value[:, 0])).all()
    # and is no useless bound: of the condition beside the tuning, and what there is without
    assert (frf.rounding_error[:, 0] <= 1e4 * EPS * (1 + 1 / abs(f / own - 1))).all()


# --- limits -----------------------------------------------------------------------------------


@pytest.mark.parametrize("rope", [STRING, BEAM], ids=["string", "beam"])
@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_an_infinitely_stiff_resonator_is_a_point_mass(kind, rope):
    stiff = taut(rd.Resonator(0.3, 0.01, 1e9), rope=rope).compile(**kind)
    lump = taut(rd.PointMass(0.3, 0.01), rope=rope).compile(**kind)
    # (f/1e9)^2 is nothing beside 1
    exact = lump.modes(6)
    np.testing.assert_allclose(stiff.modes(6).frequency, exact.frequency, rtol=1e3 * EPS)
    f, point = [3.0, 33.0], ("z", 0.3)
    np.testing.assert_allclose(
        stiff.frf(f, drive=point).value, lump.frf(f, drive=point).value, rtol=1e4 * EPS
    )


@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_an_infinitely_soft_resonator_is_one_mode_at_its_own_frequency(kind):
    soft = taut(rd.Resonator(0.3, 0.01, 1e-9)).compile(**kind).modes(6)
    without = taut(rd.PointMass(0.3, 0.0)).compile(**kind).modes(5)
    # its spring is 4e-19 N/m
    assert soft.certified
    assert soft.frequency[0] == pytest.approx(1e-9, rel=1e-12)
    np.testing.assert_allclose(soft.frequency[1:], without.frequency, rtol=1e3 * EPS)


def test_a_resonator_of_vanishing_mass_is_one_mode_more_and_no_effect():
    light = taut(rd.Resonator(0.3, 1e-40, 20.0)).compile()
    modes, without = light.modes(5), taut().compile().modes(4)
    assert modes.certified
    # nothing is left of it beside a rounding
    both = np.sort(np.append(without.frequency, 20.0))
    np.testing.assert_allclose(modes.frequency, both, rtol=1e3 * EPS)


def test_rigid_bodies_carry_their_structures_along():
    ends = ("free", "free")
    parts = (rd.Resonator(0.3, 0.02, 20.0), rd.BrokenWire(0.6, 0.1, 1e-3, radius=0.0))
    modes = taut(*parts, ends=ends).compile().modes(3)
    wire = parts[1].density * math.pi / 4 * 1e-3**2 * 0.1
    assert modes.frequency[0] == 0.0
    assert modes.certified
    # all of the mass at one speed; a sum of a few terms
    assert modes.modal_mass[0] == pytest.approx(DENSITY * LENGTH + 0.02 + wire, rel=16 * EPS)
    assert (modes.shape[0, :, 0] == 1.0).all()


@pytest.mark.parametrize(("elements", "x"), [(2, 0.5), (4, 0.25), (4, 0.75), (8, 0.5)])
def test_all_modes_of_a_regular_chain_with_a_resonator_at_a_node_are_counted(elements, x):
    model = taut(rd.Resonator(x, 0.003, 10.0)).compile(elements=elements, element="rigid")
    assert model.count(below=1e5) == elements  # one fewer inner nodes, and it
    modes = model.modes(elements)
    assert modes.certified
    assert (modes.frequency > 0).all()


# --- two degrees of freedom -------------------------------------------------------------------


def absorbed(damping_ratio, tuning, ratio):
    """A mass on a spring with an absorber, made of a string of two elements."""
    mass, spring = DENSITY * LENGTH / 2, 4 * TENSION / LENGTH
    own = math.sqrt(spring / mass) / (2 * math.pi)
    absorber = rd.Resonator(0.5, ratio * mass, tuning * own, damping_ratio=damping_ratio)
    return taut(absorber).compile(elements=2, element="rigid"), own, spring


def test_den_hartogs_fixed_points_do_not_know_the_damping():
    # J. P. Den Hartog, Mechanical Vibrations, 4th ed. (1956), section 3.3: with f = 1/(1 + mu) both
    # fixed points are sqrt(1 + 2/mu) high, at g^2 = 1/(1 + mu) (1 -+ sqrt(mu/(2 + mu)))
    ratio = 0.05
    heights = []
    for damping_ratio in (0.05, 0.127, 0.7):
        model, own, spring = absorbed(damping_ratio, 1 / (1 + ratio), ratio)
        square = (1 + np.array([-1, 1]) * math.sqrt(ratio / (2 + ratio))) / (1 + ratio)
        frf = model.frf(own * np.sqrt(square), drive=("z", 0.5))
        heights.append(np.abs(frf.value[0]) * spring)
    # a frequency is known to EPS, the slope of a peak 20 high is some 100
    np.testing.assert_allclose(heights, math.sqrt(1 + 2 / ratio), rtol=1e3 * EPS)


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
def test_two_masses_respond_as_in_the_textbook(solver):
    ratio, tuning, zeta = 0.2, 0.9, 0.1
    model, own, spring = absorbed(zeta, tuning, ratio)
    f = own * np.array([0.0, 0.5, 0.8, 1.0, 1.3, 5.0])
    g = f / own
    beside = tuning**2 - g**2 + 2j * zeta * g * tuning
    pull = tuning**2 + 2j * zeta * g * tuning
    exact = beside / (beside * (1 - g**2) - ratio * g**2 * pull) / spring
    value = model.frf(f, drive=("z", 0.5), solver=solver).value[0]
    # two unknowns, condition below 100
    np.testing.assert_allclose(value, exact, rtol=200 * EPS)


@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_an_absorber_keeps_its_foot_still_at_the_frequency_it_is_tuned_to(kind):
    model = taut(rd.Resonator(0.3, 0.01, 20.0)).compile(**kind)
    f = [np.nextafter(20.0, 0.0), 20.0, np.nextafter(20.0, 21.0)]
    frf = model.frf(f, drive=("z", 0.75), response=[("z", 0.3), ("z", 0.6)])
    still, moving = np.abs(frf.value)
    # beside the tuning |1 - (f/20)^2| is two roundings; at it nothing but the stand-in for 0
    assert (still <= 8 * EPS * moving).all()
    assert still[1] <= 1e-3 * EPS * moving[1]
    # the span beside it is one held there, whatever the absorber
    held = taut(rd.Support(0.3)).compile(**kind).frf(f, drive=("z", 0.75), response=("z", 0.6))
    np.testing.assert_allclose(frf.value[1], held.value[0], rtol=1e3 * EPS)


@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_structures_at_free_ends_and_beside_hinges_resonate_where_the_modes_are(kind):
    parts = [
        rd.Resonator(0.0, 0.01, 20.0),
        rd.BrokenWire(1.0, 0.1, 1e-3, radius=1e-3),
        rd.Hinge(0.4, stiffness=1.0),
        rd.BrokenWire(0.4, 0.12, 1e-3, radius=1e-3),
    ]
    model = taut(*parts, rope=BEAM.replace(lay_slope=0.3), ends=("free", "free")).compile(**kind)
    modes = model.modes(7)
    assert modes.certified
    assert modes.frequency[1] == 0.0 < modes.frequency[2]
    for f in modes.frequency[2:]:
        far, near = np.abs(model.frf(f * np.array([1.01, 1 + 1e-7]), drive=("z", 0.0)).value[0])
        # ten thousand times and more for a hundred thousandth of the distance
        assert near > 1e4 * far


# --- modes in which a foot stands still -------------------------------------------------------


@pytest.mark.parametrize("rope", [STRING, BEAM], ids=["string", "beam"])
@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_equal_resonators_at_one_place_move_against_each_other(kind, rope):
    resonator = rd.Resonator(0.3, 0.01, 20.0, damping_ratio=0.03)
    modes = taut(resonator, resonator, resonator, rope=rope).compile(**kind).modes(4)
    both = rd.Resonator(0.3, 0.03, 20.0)
    one = taut(both, rope=rope).compile(**kind).modes(2).frequency
    assert modes.certified
    exact = [one[0], 20.0, 20.0, one[1]]
    np.testing.assert_allclose(modes.frequency, exact, rtol=100 * EPS)
    # there the rope stands still and the absorbers have all of the energy and their own damping
    assert (np.abs(modes.shape[1:3]) < 1e-6).all()
    for group in ("resonator", "resonator mass"):
        np.testing.assert_allclose(modes.energy[group][1:3], 1.0, atol=1e-9)
    np.testing.assert_allclose(modes.damping_ratio[1:3], 0.03, rtol=1e-9)


@pytest.mark.parametrize("kind", KINDS[:2], ids=KIND_IDS[:2])
def test_a_resonator_at_a_node_of_the_mode_it_is_tuned_to_leaves_that_mode_alone(kind):
    """And adds another of the same frequency: both halves of the string against the mass."""
    tuned = float(taut().compile(**kind).modes(2).frequency[1])
    modes = taut(rd.Resonator(0.5, 0.01, tuned)).compile(**kind).modes(4)
    assert modes.certified
    np.testing.assert_allclose(modes.frequency[1:3], tuned, rtol=100 * EPS)
    assert modes.frequency[0] < 0.9 * tuned < 1.2 * tuned < modes.frequency[3]


def test_a_feather_tuned_to_the_rope_splits_its_mode_by_the_square_root_of_its_mass():
    # with mode shape sin(pi x/L) and modal mass mu L/2: f (1 -+ sqrt(m/(mu L/2))/2 sin(pi x/L))
    mass = 1e-12
    modes = taut(rd.Resonator(0.3, mass, SECOND / 2)).compile().modes(3)
    split = SECOND / 2 * math.sqrt(mass / (DENSITY * LENGTH / 2)) * math.sin(0.3 * math.pi)
    assert modes.certified
    # the next term is of the order of the mass ratio, 2e-11 of f
    assert modes.frequency[1] - modes.frequency[0] == pytest.approx(split, rel=1e-4)


def test_equal_wires_at_one_place_have_modes_of_their_own():
    wire = rd.BrokenWire(0.4, 0.1, 3e-4, radius=2e-3, damping_ratio=0.004)
    modes = taut(wire, wire, rope=BEAM).compile().modes(below=200.0)
    assert modes.certified
    own = int(modes.energy["broken wire"].argmax())
    assert modes.frequency[own] == pytest.approx(wire.frequency, rel=100 * EPS)
    assert modes.energy["broken wire mass"][own] == pytest.approx(1.0, abs=1e-9)
    assert modes.damping_ratio[own] == pytest.approx(0.004, rel=1e-9)


# --- random scenes ----------------------------------------------------------------------------


def structure(random, damped):
    x = float(random.choice([0.25, 0.5, *random.uniform(0.02, 0.98, 3)]))
    if random.random() < 0.5:
        return rd.Resonator(
            x,
            random_scene.log_uniform(random, 1e-6, 10.0),
            random_scene.log_uniform(random, 1e-2, 1e4),
            damping_ratio=float(random.choice([0.0, 0.01, 0.3])) * damped,
        )
    return rd.BrokenWire(
        x,
        random_scene.log_uniform(random, 1e-3, 0.5),
        random_scene.log_uniform(random, 1e-4, 3e-3),
        radius=float(random.uniform(-5e-3, 5e-3)),
        damping_ratio=float(random.choice([0.0, 1e-3])) * damped,
    )


def carrying(seed, *, damped=True):
    """A random scene with one to three structures."""
    random = np.random.default_rng(seed)
    scene = random_scene.random_scene(random, int(random.integers(1, 5)))
    parts = [structure(random, damped) for _ in range(int(random.integers(1, 4)))]
    stay = [p for p in scene.parts if not isinstance(p, rd.Support)]
    return random, scene.replace(parts=[*parts, *stay]), parts


@pytest.mark.parametrize("seed", range(40))
def test_sweep_and_band_agree_within_their_estimates_where_structures_are(seed):
    random, scene, parts = carrying(seed)
    f = random_scene.frequency(random, scene) or 1e-3
    drive = ("z", parts[0].x)
    wires = [("wire", i) for i in range(sum(isinstance(p, rd.BrokenWire) for p in parts))]
    model = scene.compile(elements=20, element=str(random.choice(["rigid", "tensed"])))
    sweep, band = (
        model.frf(f, drive=drive, response=[drive, *wires], solver=solver)
        for solver in ("sweep", "band")
    )
    apart = np.abs(sweep.value - band.value)
    wrong = np.abs(band.value) * (sweep.rounding_error + band.rounding_error)
    assert (apart <= wrong).all()


@pytest.mark.parametrize("seed", range(40))
def test_counts_and_modes_with_resonators_are_those_of_one_unknown_more_for_each(seed):
    random, scene, _ = carrying(seed, damped=False)
    rope = scene.rope
    masses = [
        rd.Resonator(
            float(random.choice([0.25, 0.5, random.uniform(0.02, 0.98)])),
            random_scene.log_uniform(random, 1e-4, 1.0),
            random_scene.log_uniform(random, 1e-1, 1e3),
        )
        for _ in range(int(random.integers(1, 5)))
    ]
    pull = min(abs(scene.tension), 1e3)
    scene = rd.Scene(rope, tension=pull, ends=("pinned", "clamped"), parts=masses)
    model = scene.compile(elements=12, element="rigid")
    exact = expanded(model)
    modes = model.modes(8)
    assert modes.certified
    # dense eigenvalues are right to rounding of the largest one
    lost = 1e-13 * exact[-1]
    np.testing.assert_allclose(modes.eigenvalue, exact[:8], rtol=1e-10, atol=lost)
    for limit in np.sqrt(exact[7]) / (2 * math.pi) * random.uniform(0, 1, 4):
        square = (2 * math.pi * limit) ** 2
        if np.abs(exact - square).min() > 10 * lost:
            assert model.count(below=float(limit)) == (exact < square).sum()


def expanded(model):
    """Eigenvalues of the assembled matrices with the motion of each mass as an unknown more."""
    chain = model.chain
    bare = dataclasses.replace(model, chain=chain._replace(**dict.fromkeys(chain._fields[-4:])))
    stiffness, mass = bare.stiffness_matrix().toarray(), bare.mass_matrix().toarray()
    free = chain.held[chain.term_of] == 0
    number = np.where(free, np.cumsum(free).reshape(free.shape) - 1, -1)
    n, more = len(stiffness), len(chain.attached_value)
    K, M = np.zeros((2, n + more, n + more))
    K[:n, :n], M[:n, :n] = stiffness, mass
    for k, (m, spring, _, _) in enumerate(chain.attached_value, start=n):
        node = np.flatnonzero(chain.term_of == chain.attached_term[k - n])[0]
        foot = number[node, model.coordinates.index("z")]
        K[foot, foot] += spring
        K[foot, k] = K[k, foot] = -spring
        K[k, k], M[k, k] = spring, m
    moving = M.diagonal() > 0
    still = ~moving
    across = K[np.ix_(still, moving)]
    K = K[np.ix_(moving, moving)] - across.T @ np.linalg.solve(K[np.ix_(still, still)], across)
    scale = 1 / np.sqrt(M.diagonal()[moving])
    return scipy.linalg.eigvalsh(K * scale * scale[:, None])


@pytest.mark.parametrize("seed", range(15))
def test_modes_of_ropes_with_structures_are_certified_and_their_energies_add_up(seed):
    _, scene, _ = carrying(seed)
    scene = scene.replace(tension=min(abs(scene.tension), 1e4))
    modes = scene.compile().modes(6)
    assert modes.certified
    moving = {*modes.coordinates, *CARRIED.values()} & set(modes.energy)
    kinetic = sum(modes.energy[k] for k in moving)
    strain = sum(modes.energy[k] for k in modes.energy if k not in moving)
    np.testing.assert_allclose(kinetic, 1.0, rtol=1e-12)
    assert (np.abs(strain - (modes.eigenvalue != 0)) <= 1e-6).all()


# --- wires ------------------------------------------------------------------------------------


@pytest.mark.parametrize("f", [0.0, 1e-3, 10.0, 86.0, 200.0, 540.0, 3e3, 1e5])
@pytest.mark.parametrize("zeta", [0.0, 0.01])
def test_a_rope_with_a_wire_responds_as_the_two_put_together_on_paper(f, zeta):
    wire = rd.BrokenWire(0.4, 0.05, 3e-4, radius=2e-3, damping_ratio=zeta)
    points = [("z", 0.4), ("alpha", 0.4), ("beta", 0.4)]
    frf = taut(wire, rope=BEAM).compile().frf(f, drive=points, response=[*points, ("wire", 0)])
    bare = taut(rd.PointMass(0.4, 0.0), rope=BEAM).compile().frf(f, drive=points, response=points)
    with mpmath.workdps(40):
        square = omega(np.float64(f)) ** 2 if f > 0 else mpf(10) ** -30
        (zz, zb, bb), tip, gap = wire_stiffness(wire, square)
        lever = mpmath.matrix([[1, wire.radius, 0], [0, 0, 1]])
        D = lever.T * mpmath.matrix([[zz, zb], [zb, bb]]) / gap * lever
        R = mpmath.matrix(bare.value[:, :, 0].T.tolist())
        moved = mpmath.inverse(mpmath.inverse(R) + D)
        tips = mpmath.matrix([tip]) / gap * lever * moved
        exact = np.array([*moved.tolist(), *tips.tolist()], dtype=np.complex128)
    value = frf.value[:, :, 0].T
    # the receptances without a wire are known to 1e-13, and near 86 and 540 Hz the gap to the
    # wire's own frequency is 1e-3 of it
    np.testing.assert_allclose(value, exact, rtol=1e-9, atol=1e-12 * np.abs(exact).max())


def test_the_tip_of_a_wire_follows_a_slow_rope_as_a_rigid_body():
    points = [("z", 0.4), ("alpha", 0.4), ("beta", 0.4)]
    frf = (
        taut(WIRE, rope=BEAM).compile().frf(0.0, drive=("z", 0.3), response=[*points, ("wire", 0)])
    )
    z, alpha, beta, tip = frf.value[:, 0].real
    # three products
    assert tip == pytest.approx(z + WIRE.radius * alpha + WIRE.length * beta, rel=4 * EPS)


def test_a_wire_is_driven_by_twist_through_its_radius_alone():
    drive = {"drive": ("alpha", 0.25), "response": ("wire", 0)}
    on_axis = rd.BrokenWire(0.4, 0.05, 3e-4, radius=0.0)
    assert taut(on_axis, rope=BEAM).compile().frf(50.0, **drive).value[0, 0] == 0.0
    assert taut(on_axis, rope=BEAM).compile().components == (("z", "beta"), ("alpha",))
    assert taut(WIRE, rope=BEAM).compile().components == (("z", "alpha", "beta"),)
    near = taut(WIRE, rope=BEAM).compile().frf(50.0, **drive).value[0, 0]
    assert abs(near) > 0.0


def test_a_wire_sounds_at_its_own_frequency():
    # the amplitude of a feather at resonance: participation over 2 zeta, 1.566 for the first mode
    zeta = 1e-3
    wire = rd.BrokenWire(0.4, 0.05, 1e-5, radius=0.0, damping_ratio=zeta)
    frf = (
        taut(wire)
        .compile()
        .frf(wire.frequency, drive=("z", 0.3), response=[("z", 0.4), ("wire", 0)])
    )
    foot, tip = frf.value[:, 0]
    # the other modes and (1 + 2 i zeta) add of the order of 2 zeta
    assert abs(tip / foot) == pytest.approx(1.5660 / (2 * zeta), rel=3 * zeta)


def test_wires_are_numbered_as_the_scene_has_them():
    far, near = (
        rd.BrokenWire(x, length, 3e-4, radius=0.0) for x, length in ((0.7, 0.05), (0.2, 0.1))
    )
    resonator = rd.Resonator(0.2, 1e-3, 10.0)
    first = taut(far, resonator, near).compile()
    second = taut(near, far, resonator).compile()
    a = first.frf(30.0, drive=("z", 0.5), response=[("wire", 0), ("z", 0.7), ("wire", 1)])
    b = second.frf(30.0, drive=("z", 0.5), response=[("wire", 1), ("z", 0.7), ("wire", 0)])
    # at 0.2 m two structures are taken in another order
    np.testing.assert_allclose(a.value, b.value, rtol=1e3 * EPS)
    assert a.labels == ("tip of wire 0 [m/N]", "z at 0.700 m [m/N]", "tip of wire 1 [m/N]")
    tips = a.value[[0, 2], 0]
    assert tips[0] != tips[1]


def test_reciprocity_holds_across_structures():
    points = [("z", 0.2), ("beta", 0.4), ("alpha", 0.7)]
    parts = (WIRE, rd.Resonator(0.6, 0.01, 20.0, damping_ratio=0.05))
    rope = BEAM.replace(lay_slope=0.2)
    value = taut(*parts, rope=rope).compile().frf([7.0, 85.0], drive=points, response=points).value
    # both directions round on their own: condition below 100
    np.testing.assert_allclose(value, value.transpose(1, 0, 2), rtol=1e4 * EPS)


# --- scenes -----------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS, ids=KIND_IDS)
def test_a_scene_without_structures_is_one_that_never_had_any(kind):
    bare = taut(rd.PointMass(0.3, 0.01), rope=BEAM)
    scene = bare.replace(parts=[*bare.parts, WIRE, rd.Resonator(0.3, 0.01, 20.0)])
    assert scene.effects[-3:] == ("point mass", "resonator", "broken wire")
    less = scene.without("resonator", "broken wire")
    assert less == bare
    model, never = less.compile(**kind), bare.compile(**kind)
    assert model.chain.attached_row is None
    f = {"frequency": [3.0, 30.0], "drive": ("z", 0.3)}
    assert model.frf(**f).value.tobytes() == never.frf(**f).value.tobytes()
    assert model.modes(4).shape.tobytes() == never.modes(4).shape.tobytes()
    assert not {*CARRIED, *CARRIED.values()} & set(model.modes(1).energy)


REFUSED = {
    "mass of zero": (lambda: rd.Resonator(0.3, 0.0, 20.0), "mass must be a finite number > 0"),
    "no frequency": (lambda: rd.Resonator(0.3, 1.0, 0.0), "frequency must be a finite number > 0"),
    "frequency of nan": (lambda: rd.Resonator(0.3, 1.0, math.nan), "frequency must be"),
    "frequency beyond numbers": (lambda: rd.Resonator(0.3, 1.0, 1e200), "stiffness"),
    "frequency below numbers": (lambda: rd.Resonator(0.3, 1.0, 1e-200), "stiffness"),
    "negative damping": (
        lambda: rd.Resonator(0.3, 1.0, 1.0, damping_ratio=-0.1),
        "damping_ratio must be a finite number >= 0",
    ),
    "resonator off the rope": (lambda: taut(rd.Resonator(2.0, 1.0, 1.0)), "parts[0].x must lie"),
    "resonator on a rod": (
        lambda: rd.Scene(rd.Rope(1.0, 0.1, axial_stiffness=1.0), parts=[WIRE]),
        "coordinate of a broken wire must be one the scene has (x), got 'z'",
    ),
    "resonator at a clamp": (
        lambda: taut(rd.Resonator(0.0, 1.0, 1.0)).compile(),
        "a resonator must stand where its foot can move, got one at 0.0 m",
    ),
    "resonator on a support": (
        lambda: taut(rd.Support(0.3), rd.Resonator(0.3, 1.0, 1.0)).compile(),
        "a resonator must stand where its foot can move",
    ),
    "wire of no length": (
        lambda: rd.BrokenWire(0.3, 0.0, 1e-3, radius=0.0),
        "length must be a finite number > 0 [m], got 0.0",
    ),
    "wire thinner than numbers": (
        lambda: rd.BrokenWire(0.3, 0.1, 1e-200, radius=0.0),
        "length and diameter must leave mass and stiffness",
    ),
    "radius of infinity": (
        lambda: rd.BrokenWire(0.3, 0.1, 1e-3, radius=math.inf),
        "radius must be a finite number [m]",
    ),
    "a wire there is not": (
        lambda: taut(WIRE).compile().frf(1.0, drive=("z", 0.3), response=("wire", 1)),
        "response[1] must be a whole number from 0 to 0, got 1",
    ),
    "no wire": (
        lambda: taut().compile().frf(1.0, drive=("z", 0.3), response=("wire", 0)),
        "response must not ask for a wire: the scene has no BrokenWire",
    ),
    "a wire as drive": (
        lambda: taut(WIRE).compile().frf(1.0, drive=("wire", 0)),
        'drive[0] must be one of "x", "y", "z", "alpha", "beta", "gamma", got \'wire\'',
    ),
    "assembled modes": (
        lambda: taut(WIRE).compile(elements=8).modes(2, solver="lapack"),
        'solver must be "sweep" where parts have a broken wire, got "lapack"',
    ),
    "matrices": (
        lambda: taut(WIRE, rd.Resonator(0.3, 1.0, 1.0)).compile(elements=8).mass_matrix(),
        "parts must not have a resonator or broken wire for matrices",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_structures_without_meaning_are_refused_by_name(what):
    make, message = REFUSED[what]
    with pytest.raises(rd.SceneError) as caught:
        make()
    assert message in str(caught.value)


@pytest.mark.parametrize("part", [rd.Resonator, rd.BrokenWire])
def test_structures_of_text_are_type_errors(part):
    with pytest.raises(TypeError, match="x must be a finite number"):
        part("middle", 1.0, 1.0, **({"radius": 0.0} if part is rd.BrokenWire else {}))
    with pytest.raises(TypeError, match=r"response\[1\] must be a whole number"):
        taut(WIRE).compile().frf(1.0, drive=("z", 0.3), response=("wire", 0.5))


@pytest.mark.parametrize("f", [0.0, 1e-300, 1e-5, 1e5, 1e9])
def test_no_frequency_makes_anything_but_numbers_of_structures(f):
    parts = (WIRE, rd.Resonator(0.6, 0.01, 20.0, damping_ratio=0.1))
    model = taut(*parts, rope=BEAM).compile(elements=20)
    value = model.frf(f, drive=("z", 0.4), response=[("z", 0.4), ("wire", 0)]).value
    assert np.isfinite(value).all()


@pytest.mark.parametrize("frequency", [1e-3, 0.1, 16.0, 37.3])
@pytest.mark.parametrize("elements", [None, 10])
def test_foot_of_an_undamped_resonator_stands_still_at_its_own_frequency(elements, frequency):
    # a light and slow one too: its spring is infinite there, whatever its force is besides
    part = rd.Resonator(0.4, 1e-3, frequency)
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[part]).compile(elements=elements)
    value = model.frf([frequency], drive=("z", 0.4)).value[0, 0]
    still = model.static({("z", 0.4): 1.0}).displacement.max()
    # e = 1e-20 stands for 0: an eps of the string's own motion in k/(m omega^2) of 1e10
    assert abs(value) < 1e-9 * still


@pytest.mark.parametrize("beside", [0.0, 1e-15, 1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize(("mass", "own"), [(1e-3, 1e-3), (1e-6, 1e-3), (0.01, 16.0), (1e-9, 1e-2)])
def test_a_light_and_slow_resonator_is_bounded_at_its_own_frequency(mass, own, beside):
    # its stiffness -m k lambda/(k - m lambda), infinite there, on that of both halves of a string
    f = own * (1 + beside)
    model = taut(rd.Resonator(0.5, mass, own)).compile()
    frf = model.frf(f, drive=("z", 0.5), response=[("z", 0.5), ("z", 0.25)])
    with mpmath.workdps(60):
        lam, wave = omega(f) ** 2, omega(f) * mpmath.sqrt(mpf(DENSITY) / TENSION)
        halves = 2 * TENSION * wave * mpmath.cot(wave / 2)
        k = mpf(mass) * omega(own) ** 2
        soft = k - mpf(mass) * lam
        foot = soft / (soft * halves - mpf(mass) * lam * k)
        exact = [foot, foot * mpmath.sin(wave / 4) / mpmath.sin(wave / 2)]
        value = [mpmath.mpmathify(complex(v)) for v in frf.value[:, 0]]
        error = np.array([abs(v - h) for v, h in zip(value, exact)], float)
        size = np.array([abs(v) for v in value], float)
    assert (error <= frf.rounding_limit[:, 0]).all()
    assert (error <= frf.rounding_error[:, 0] * size).all()
    if beside == 0:  # 0 in truth, so that no relative bound is one
        assert (frf.rounding_error[:, 0] > 1).all()
