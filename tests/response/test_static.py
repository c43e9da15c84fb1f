"""Static deflection: textbook values, equilibrium, critical and unheld ropes."""

import math

import mpmath
import numpy as np
import pytest
from conftest import EPS, dense, free

import ropedyn as rd
from ropedyn.study.hard.drawn import drawn_scene

L, B, C, EA = 2.0, 7.0, 3.0, 500.0
BEAM = rd.Rope(L, 0.1, bending_stiffness=B)
HINGED = rd.End(beta="free")


def digits(elements):
    """Relative error of a beam's deflection: its condition, 50 (n/pi)^4, times a few eps."""
    return 200 * EPS * (elements / math.pi) ** 4


@pytest.mark.parametrize("n", [2, 8, 32])
@pytest.mark.parametrize(
    ("ends", "load", "watched", "exact"),
    [
        (("clamped", "clamped"), ("z", L / 2), ("z", L / 2), L**3 / (192 * B)),
        (("pinned", "pinned"), ("z", L / 2), ("z", L / 2), L**3 / (48 * B)),
        (("pinned", "pinned"), ("z", L / 2), ("beta", 0.0), L**2 / (16 * B)),
        (("pinned", "pinned"), ("z", L / 2), ("beta", L), -(L**2) / (16 * B)),
        (("clamped", "pinned"), ("z", L / 2), ("z", L / 2), 7 * L**3 / (768 * B)),
        (("clamped", "free"), ("z", L), ("z", L), L**3 / (3 * B)),
        (("clamped", "free"), ("z", L), ("beta", L), L**2 / (2 * B)),
        (("clamped", "free"), ("beta", L), ("z", L), L**2 / (2 * B)),
        (("clamped", "free"), ("beta", L), ("beta", L), L / B),
        (("free", "clamped"), ("z", 0.0), ("beta", 0.0), -(L**2) / (2 * B)),
    ],
)
def test_beam_deflects_as_in_the_textbook(n, ends, load, watched, exact):
    static = rd.Scene(BEAM, ends=ends).compile(elements=n, element="rigid").static({load: 1.0})
    node = round(watched[1] / L * n)
    value = static.displacement[node, static.coordinates.index(watched[0])]
    assert value == pytest.approx(exact, rel=digits(n))


@pytest.mark.parametrize("n", [1, 5, 16])
@pytest.mark.parametrize("load", ["z", "alpha", "beta"])
def test_helical_cantilever_of_any_elements_has_the_flexibility_of_one(n, load):
    # the section is the same all along: G of design.md, section 2, with l = L
    H = 0.3
    rope = rd.Rope(L, 0.1, bending_stiffness=B, torsional_stiffness=C, lay_slope=H)
    static = (
        rd.Scene(rope, ends=("clamped", "free"))
        .compile(elements=n, element="rigid")
        .static({(load, L): 1.0})
    )
    c = 1 / (1 + H**2)
    P, Q, R = c * (H**2 / C + 1 / B), c * (1 / C + H**2 / B), c * H * (1 / C - 1 / B)
    G = np.array([[P * L**3 / 3, R * L**2 / 2, P * L**2 / 2], [0, Q * L, R * L], [0, 0, P * L]])
    G = np.triu(G) + np.triu(G, 1).T
    column = ("z", "alpha", "beta").index(load)
    np.testing.assert_allclose(static.displacement[-1], G[:, column], rtol=digits(max(n, 2)))


def test_pulled_laid_rope_untwists():
    # [[EA, D], [D, C]] (strain, twist rate) = (F, 0)
    D = -20.0
    rope = rd.Rope(L, 0.1, axial_stiffness=EA, torsional_stiffness=C, lay_coupling=D)
    scene = rd.Scene(rope, ends=("clamped", "free"))
    static = scene.compile(elements=6, element="rigid").static({("x", L): 9.0})
    strain, rate = np.linalg.solve([[EA, D], [D, C]], [9.0, 0.0])
    line = np.outer(static.x, [strain, rate])
    # chain condition (2 n/pi)^2 and the section's, a few eps each
    np.testing.assert_allclose(static.displacement, line, rtol=200 * EPS)


@pytest.mark.parametrize(("coordinate", "stiffness"), [("x", EA), ("alpha", C)])
def test_rod_between_walls_takes_a_load_as_two_springs(coordinate, stiffness):
    rope = rd.Rope(L, 0.1, axial_stiffness=EA, torsional_stiffness=C)
    static = rd.Scene(rope).compile(elements=4, element="rigid").static({(coordinate, L / 4): 5.0})
    k = static.coordinates.index(coordinate)
    exact = 5.0 / (stiffness / (L / 4) + stiffness / (3 * L / 4))
    np.testing.assert_allclose(
        static.displacement[:, k] / exact, [0, 1, 2 / 3, 1 / 3, 0], rtol=40 * EPS, atol=0
    )
    np.testing.assert_allclose(static.force[[0, 1, 4], k], [-3.75, 5, -1.25], rtol=40 * EPS)
    assert (static.displacement[:, 1 - k] == 0).all()


def test_string_under_point_loads_is_a_polygon():
    T = 40.0
    static = rd.Scene(rd.Rope(1.0, 0.1), tension=T).compile(elements=8, element="rigid")
    z = static.static({("z", 0.25): 3.0, ("z", 0.55): -1.0}).displacement[:, 0]
    x = np.linspace(0, 1, 9)

    def triangle(a):
        return np.minimum(x, a) * (1 - np.maximum(x, a)) / T

    # the chain loses (2 n/pi)^2 = 26 eps
    np.testing.assert_allclose(z, 3 * triangle(0.25) - triangle(0.55), atol=100 * EPS * 0.01)


@pytest.mark.parametrize("stiffness", [1e-3, 10.0, 1e9])
def test_rotation_spring_at_an_end_leads_from_pinned_to_clamped(stiffness):
    # fixed-end moment m = (F L/8)/(1 + 2 B/(k L)); z = F L^3/48 B - m L^2/8 B
    end = rd.End(beta="free", spring={"beta": stiffness})
    static = (
        rd.Scene(BEAM, ends=(end, end))
        .compile(elements=8, element="rigid")
        .static({("z", L / 2): 1.0})
    )
    m = L / 8 / (1 + 2 * B / (stiffness * L))
    assert static.displacement[4, 0] == pytest.approx(
        L**3 / (48 * B) - m * L**2 / (8 * B), rel=digits(8)
    )
    # the wall turns the left end against its rotation
    assert static.force[0, 1] == pytest.approx(-stiffness * static.displacement[0, 1], rel=1e-9)
    assert static.force[0, 1] == pytest.approx(-m, rel=1e-9)


def test_spring_half_way_shares_the_load():
    k = 60.0
    scene = rd.Scene(BEAM, parts=[rd.Spring(L / 2, k)])
    static = scene.compile(elements=4, element="rigid").static({("z", L / 2): 1.0})
    assert static.displacement[2, 0] == pytest.approx(1 / (192 * B / L**3 + k), rel=digits(4))


def test_support_half_way_makes_two_ropes():
    scene = rd.Scene(BEAM, parts=[rd.Support(L / 2), rd.Support(L / 2, coordinate="beta")])
    static = scene.compile(elements=8, element="rigid").static({("z", L / 4): 1.0})
    assert static.displacement[2, 0] == pytest.approx((L / 2) ** 3 / (192 * B), rel=digits(4))
    assert (static.displacement[4:] == 0).all()
    assert (static.force[5:] == 0).all()


def test_reactions_of_a_clamped_beam_are_half_the_load_and_an_eighth_of_its_moment():
    static = rd.Scene(BEAM).compile(elements=8, element="rigid").static({("z", L / 2): 16.0})
    # left wall: -F/2 and, turning the rope's end back to the horizontal, -F L/8
    np.testing.assert_allclose(static.force[0], [-8.0, -16.0 * L / 8], rtol=digits(8))
    np.testing.assert_allclose(static.force[-1], [-8.0, 16.0 * L / 8], rtol=digits(8))
    # what is left at the other nodes is rounding of forces that cancel, 24 B n^3/L^3 x z
    stray = np.delete(static.force, [0, 4, 8], axis=0)
    assert np.abs(stray).max() <= 16 * digits(8)


@pytest.mark.parametrize("tension", [-20.0, 0.0, 300.0])
@pytest.mark.parametrize(
    "load", [{("z", 0.3): 2.0}, {("beta", 1.1): 1.0, ("z", 1.77): -3.0}], ids=["one", "two"]
)
def test_loads_and_reactions_balance(tension, load):
    # moment about x = 0: sum of x F_z + M_beta = T (z_L - z_0), here 0 as the ends are held
    scene = rd.Scene(BEAM, tension=tension, ends=("clamped", HINGED), parts=[rd.Spring(0.7, 9.0)])
    static = scene.compile(elements=8, element="rigid").static(load)
    F, M = static.force.T
    # every force is a sum of products of up to 24 B (n/L)^3 z
    size = 24 * B * (8 / L) ** 3 * np.abs(static.displacement[:, 0]).max()
    assert abs(F.sum()) <= 100 * EPS * size
    assert abs((static.x * F + M).sum()) <= 100 * EPS * size * L
    spring = static.x == 0.7
    assert spring.sum() == 1


def test_loads_superpose_and_work_both_ways():
    model = rd.Scene(BEAM, tension=50.0).compile(elements=10, element="rigid")
    one, other = {("z", 0.33): 2.0}, {("beta", 1.21): 5.0}
    a, b, both = (model.static(load).displacement for load in (one, other, one | other))
    np.testing.assert_allclose(a + b, both, rtol=0, atol=digits(10) * np.abs(both).max())
    # Betti: the work of each load on the other's displacement, read by the frf at 0 Hz
    here = model.frf(0.0, drive=("z", 0.33), response=("beta", 1.21)).value[0, 0].real
    there = model.frf(0.0, drive=("beta", 1.21), response=("z", 0.33)).value[0, 0].real
    assert here == pytest.approx(there, rel=digits(10))


def test_deflection_solves_the_assembled_equations():
    rope = rd.Rope(L, 0.1, bending_stiffness=B, torsional_stiffness=C, lay_slope=0.2)
    model = rd.Scene(rope, tension=30.0, ends=("pinned", "clamped")).compile(
        elements=6, element="rigid"
    )
    static = model.static({("z", L / 2): 1.0, ("alpha", L / 3): 0.5})
    K, _, _ = dense(model)
    load = np.zeros(static.displacement.shape)
    load[3, 0], load[2, 1] = 1.0, 0.5
    u = np.linalg.solve(K, load[free(model)])
    np.testing.assert_allclose(
        static.displacement[free(model)], u, rtol=0, atol=digits(6) * np.abs(u).max()
    )


def test_loads_at_one_place_add():
    model = rd.Scene(BEAM).compile(elements=4, element="rigid")
    once = model.static({("z", 1.0): 3.0}).displacement
    # the same point written twice: an integer and a float
    assert (model.static({("z", 1): 3.0}).displacement == once).all()


@pytest.mark.parametrize(
    ("scene", "coordinate"),
    [
        (rd.Scene(BEAM, ends=("free", "free")), "z"),
        (rd.Scene(BEAM, ends=("pinned", "free")), "z"),
        (rd.Scene(rd.Rope(L, 0.1, torsional_stiffness=C), ends=("free", "free")), "alpha"),
        (rd.Scene(rd.Rope(L, 0.1), tension=5.0, ends=("free", "free")), "z"),
    ],
    ids=["free beam", "hinged at one end", "free shaft", "free string"],
)
@pytest.mark.parametrize("n", [1, 7, 8])
def test_rope_that_nothing_holds_is_refused(scene, coordinate, n):
    with pytest.raises(rd.SolveError, match="rigid motion"):
        scene.compile(elements=n, element="rigid").static({(coordinate, L): 1.0})


def test_free_component_does_not_keep_the_held_one_from_its_answer():
    ends = (rd.End(alpha="free"), rd.End(alpha="free"))
    model = rd.Scene(BEAM.replace(torsional_stiffness=C), ends=ends).compile(
        elements=4, element="rigid"
    )
    static = model.static({("z", L / 2): 1.0})
    assert static.displacement[2, 0] == pytest.approx(L**3 / (192 * B), rel=digits(4))
    with pytest.raises(rd.SolveError, match="alpha"):
        model.static({("alpha", L / 2): 1.0})


def test_spring_that_cancels_the_stiffness_is_refused():
    # one mass on two strings, 4 T/L, and a spring of -4 T/L
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=8.0, parts=[rd.Spring(0.5, -32.0)])
    with pytest.raises(rd.SolveError, match=r"critical|rigid"):
        scene.compile(elements=2, element="rigid").static({("z", 0.5): 1.0})


# critical loads -----------------------------------------------------------------------------------

EULER = math.pi**2 * B / L**2
"""Of the pinned beam [N]."""
HALF_WAY = {("z", L / 2): 1.0}


def pushed(times, elements=None, **more):
    scene = rd.Scene(BEAM, tension=-times * EULER, ends=("pinned", "pinned"), **more)
    return scene.compile(elements=elements)


def half_way(tension):
    """Compliance of the pinned beam in its middle, (tan(u)/u - 1) L/4P, u = L sqrt(P/B)/2."""
    with mpmath.workdps(40):
        P = -mpmath.mpf(tension)
        u = L * mpmath.sqrt(P / B) / 2
        return (mpmath.tan(u) / u - 1) * L / (4 * P)


@pytest.mark.parametrize(("elements", "solver"), [(None, "sweep"), (8, "band"), (8, "lapack")])
@pytest.mark.parametrize(("times", "exceeded"), [(1.5, 1), (4.1, 2), (9.5, 3)])
def test_deflection_beyond_critical_loads_is_refused_and_said(times, exceeded, elements, solver):
    model = pushed(times, elements)
    with pytest.raises(
        rd.SolveError, match=rf"{exceeded} critical loads? (is|are) met or exceeded"
    ):
        model.static(HALF_WAY, solver=solver)
    static = model.static(HALF_WAY, solver=solver, unstable=True)
    assert static.critical_loads == exceeded
    assert f"unstable: {exceeded} critical" in str(static)
    assert static.to_xarray().attrs["ropedyn_critical_loads"] == str(exceeded)
    middle = static.displacement[list(static.x).index(L / 2), 0]
    assert middle == pytest.approx(float(half_way(model.scene.tension)), rel=1e-9)
    # the response at 0 Hz says the same, asked or not
    assert model.frf(0.0, drive=("z", L / 2)).value[0, 0].real == pytest.approx(middle, rel=1e-9)


@pytest.mark.parametrize(("elements", "solver"), [(None, "sweep"), (8, "band"), (8, "lapack")])
@pytest.mark.parametrize("below", [1.0, 1e-3, 1e-6, 1e-9, 1e-12, *(1e-4, 1e-8, 1e-11)])
def test_rounding_error_covers_what_is_lost_next_to_the_critical_load(below, elements, solver):
    model = pushed(1 - below, elements) if below < 1 else pushed(0.3, elements)
    try:
        static = model.static(HALF_WAY, solver=solver)
    except rd.SolveError as refusal:
        assert below < (1e-12 if solver != "lapack" else 1e-5)
        assert "critical" in str(refusal)
        return
    node = list(static.x).index(L / 2)
    error = abs(static.displacement[node, 0] - half_way(model.scene.tension))
    bound = static.rounding_error[node, 0]
    assert error <= bound <= 1e3 * EPS * (elements or 1) ** 4 / below * static.displacement[node, 0]
    assert (static.rounding_error[[0, -1], 0] == 0).all()


def moment_at_clamps(tension, bending):
    """Of a clamped beam of 1 m under compression and 1 N at midspan (Timoshenko, Gere 1961)."""
    with mpmath.workdps(40):
        u = mpmath.sqrt(-mpmath.mpf(tension) / mpmath.mpf(bending)) / 2
        return (1 - mpmath.cos(u)) / (4 * u * mpmath.sin(u))


@pytest.mark.parametrize("below", [0.1, 1e-3, 1e-6, 1e-10])
@pytest.mark.parametrize(
    ("elements", "solver"), [(None, "sweep"), (4, "sweep"), (8, "band"), (8, "lapack")]
)
def test_rounding_error_of_forces_covers_what_a_moment_at_a_clamp_loses(below, elements, solver):
    bending = 2.5
    tension = -4 * np.pi**2 * bending * (1 - below)
    scene = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=bending), tension=tension)
    static = scene.compile(elements=elements).static({("z", 0.5): 1.0}, solver=solver)
    exact = moment_at_clamps(tension, bending)
    error = abs(float(abs(mpmath.mpf(float(static.force[0, 1]))) - exact))
    bound = static.force_rounding_error
    assert error <= bound[0, 1]
    # assembled, the forces beside a node are far larger than what they leave of each other
    assert bound[0, 1] < (1e-12 if solver != "lapack" else 1e-10) / below * abs(exact)
    assert (np.abs(np.abs(static.force[[0, -1], 0]) - 0.5) <= bound[[0, -1], 0]).all()
    assert bound.shape == static.force.shape


@pytest.mark.parametrize("number", range(20))
def test_motion_and_forces_of_hard_scenes_are_those_of_the_same_rope_cut_elsewhere(number):
    random = np.random.default_rng([11, number])
    scene = drawn_scene(random)
    load = {("z", float(random.uniform(0.01, 0.99))): 1.0}
    spans = len(scene.compile().x) - 1
    try:
        one = scene.compile().static(load, points=4)
        other = scene.compile(elements=spans + 2, element="continuous").static(load, points=4)
    except rd.SolveError:
        return
    at = np.array([np.abs(other.x - x).argmin() for x in one.x])
    there = np.abs(other.x[at] - one.x) < 1e-15
    for name, bound in (("displacement", "rounding_error"), ("force", "force_rounding_error")):
        apart = np.abs(getattr(one, name) - getattr(other, name)[at])
        limit = getattr(one, bound) + getattr(other, bound)[at]
        assert (apart <= limit)[there].all()


@pytest.mark.parametrize("away", [0.0, 1e-15, -1e-15])
def test_load_that_rounding_cannot_tell_from_critical_is_refused(away):
    # a moment in the middle leaves the half wave that buckles at rest
    model = pushed(1 + away)
    with pytest.raises(rd.SolveError, match="1 critical load is met or exceeded"):
        model.static({("beta", L / 2): 1.0})


def test_rope_buckles_between_the_nodes_of_a_chain():
    model = rd.Scene(BEAM, tension=-4.2 * EULER).compile(elements=1)
    with pytest.raises(rd.SolveError, match="1 critical load is met or exceeded"):
        model.static({("z", L / 4): 1.0})


def test_springs_that_push_exceed_critical_loads():
    model = pushed(0.0, parts=[rd.Spring(L / 2, -1.1 * 48 * B / L**3)])
    with pytest.raises(rd.SolveError, match="1 critical load is met or exceeded"):
        model.static(HALF_WAY)
    held = pushed(0.0, parts=[rd.Spring(L / 2, -0.9 * 48 * B / L**3)]).static(HALF_WAY)
    assert held.critical_loads == 0
    assert held.displacement[:, 0].max() == pytest.approx(10 * L**3 / (48 * B), rel=1e-12)


def test_only_what_a_load_moves_is_counted():
    rope = BEAM.replace(torsional_stiffness=C)
    model = rd.Scene(rope, tension=-2 * EULER, ends=("pinned", "pinned")).compile()
    assert model.static({("alpha", L / 2): 1.0}).critical_loads == 0


@pytest.mark.parametrize("tension", [0.0, rd.Tension(200.0, at="end")])
@pytest.mark.parametrize("elements", [None, 40])
def test_own_weight_that_pushes_a_part_of_the_rope_exceeds_critical_loads(tension, elements):
    # the mean of the span pulls: it was answered
    scene = rd.Scene(
        rd.Rope(20.0, 2.0, bending_stiffness=1000.0),
        tension=tension,
        ends=("pinned", "clamped"),
        gravity=rd.Gravity(inclination=np.pi / 2, sag=False),
    )
    assert (scene.compile().modes(3).eigenvalue < 0).sum() == 1
    with pytest.raises(rd.SolveError, match="does not stay at rest: 1 critical load is"):
        scene.compile(elements=elements).static({("z", 6.0): 1.0})


def test_loads_that_are_let_go_rest_where_the_rope_stays():
    model = pushed(1.5, 8)
    how = {"method": "line", "response": ("z", L / 2)}
    with pytest.raises(rd.SolveError, match="1 critical load is met or exceeded"):
        model.transient([0.0, 1e-3], start=HALF_WAY, **how)
    asked = model.static(HALF_WAY, unstable=True)
    moved = model.transient([0.0, 1e-3], start=asked, **how).value[0]
    # away from where the load would push it
    assert moved[1] < moved[0] < 0


@pytest.mark.parametrize("elements", [4, 64])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_mesh_error_is_the_distance_to_the_closed_form(element, elements):
    # clamped-clamped under P at midspan: w = P/2T (L/2 - tanh(kL/4) 2/k), k^2 = T/B
    L, B, T = 1.0, 2.5, 1000.0
    scene = rd.Scene(rd.Rope(L, 0.1, bending_stiffness=B), tension=T)
    static = scene.compile(elements=elements, element=element).static({("z", L / 2): 1.0})
    k = math.sqrt(T / B)
    exact = (L / 2 - 2 / k * math.tanh(k * L / 4)) / (2 * T)
    error = abs(static.displacement[elements // 2, 0] - exact)
    # a bound of the spans' own rounding comes on top: 1.4e-17 of 3e-4 m
    above = static.mesh_error[elements // 2, 0] - error
    assert -1e-18 <= above <= 1e-9 * error + 5e-17
    assert static.mesh_error.shape == static.displacement.shape
    assert (static.mesh_error[[0, -1]] <= 1e-18).all()


def test_continuous_spans_have_no_mesh_error():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    assert (scene.compile().static({("z", 0.3): 1.0}).mesh_error == 0).all()


SWIVEL = rd.Scene(
    rd.Rope(1.35, 0.17, axial_stiffness=6e5, torsional_stiffness=0.1485, lay_coupling=120.0),
    tension=2830.0,
    ends=("clamped", rd.End(alpha="free")),
)


@pytest.mark.parametrize("elements", [None, 5])
def test_mean_tension_turns_a_swivel(elements):
    EA, C, D = map(mpmath.mpf, (6e5, 0.1485, 120.0))
    turned = -D * mpmath.mpf(1.35) * 2830 / (EA * C - D**2)
    found = SWIVEL.compile(elements=elements).static({})
    assert found.load == ((("x", 1.35), 2830.0),)
    alpha = found.displacement[-1, found.coordinates.index("alpha")]
    assert abs(alpha / turned - 1) <= 64 * EPS


def test_mean_tension_turns_what_is_free_at_the_left_as_well():
    mirror = SWIVEL.replace(ends=(rd.End(x="free", alpha="free"), "clamped"))
    found, right = mirror.compile().static({}), SWIVEL.compile().static({})
    at = found.coordinates.index("alpha")
    np.testing.assert_allclose(-found.displacement[0, at], right.displacement[-1, at], rtol=1e-14)


@pytest.mark.parametrize(
    "scene",
    [
        rd.Scene(rd.Rope(1.0, 0.1), tension=100.0),
        rd.Scene(rd.Rope(1.0, 0.1, axial_stiffness=1e5), tension=100.0, gravity=rd.Gravity()),
    ],
)
def test_mean_tension_alone_needs_a_rope_that_it_stretches_evenly(scene):
    with pytest.raises(rd.SceneError, match=r"load must be a mapping.*axial_stiffness"):
        scene.compile().static({})
