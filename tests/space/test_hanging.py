"""Ropes that hang between their ends: on a catenary where a parabola is not true to 1e-3."""

import math

import hung_rods
import numpy as np
import pytest
import scipy.optimize
from catenary_elements import aside
from random_scene import log_uniform

import ropedyn as rd

NUMBER = 6
ROPE = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
DEEP = rd.Scene(ROPE, tension=1500.0, gravity=rd.Gravity())
INCLINED = rd.Scene(
    ROPE, tension=rd.Tension(3000.0, at="start"), gravity=rd.Gravity(inclination=0.6)
)


def hanging(rng, *, bends):
    """Return a rope of a sag from 0.001 to 0.3 of its chord, level or up to 1.2 rad."""
    length, density = log_uniform(rng, 1.0, 1000.0), log_uniform(rng, 0.1, 100.0)
    turned = float(rng.choice([0.0, rng.uniform(-1.2, 1.2)]))
    sag, at = log_uniform(rng, 1e-3, 0.3), str(rng.choice(["start", "middle", "end"]))
    # level, of (cosh d - 1)/2d of the span
    d = scipy.optimize.brentq(lambda d: (math.cosh(d) - 1) / (2 * d) - sag, 1e-4, 2.0)
    tension = along(length, turned, d, at) * density * 9.81
    if tension < 0.3 * along(length, turned, d, "middle") * density * 9.81:
        at, tension = "middle", along(length, turned, d, "middle") * density * 9.81
    own = {"axial_stiffness": tension * log_uniform(rng, 5e2, 1e5)}
    if bends:
        # a pair is bent as it hangs, so that nothing but the tension is there at rest
        stiff = tension * length**2 / log_uniform(rng, 1e4, 1e6)
        own["bending_stiffness"] = (stiff, stiff * rng.uniform(0.5, 2.0))
    return rd.Scene(
        rd.Rope(length, density, **own),
        tension=rd.Tension(tension, at=at),
        gravity=rd.Gravity(inclination=turned),
        planes="both",
    )


def along(length, turned, d, at):
    """The tension along the chord over weight per length, of half a span of d parameters."""
    c = length * math.cos(turned) / (2 * d)
    middle = math.asinh(math.tan(turned) * d / math.sinh(d))
    first, last = (c * math.sinh(middle + side * d) for side in (-1, 1))
    place = first + hung_rods.SHARE[at] * (last - first)
    return c * math.cos(turned) + place * math.sin(turned)


def worst(scene, number=NUMBER):
    """The largest error of both planes, as a share of what is accepted, and of the frequency."""
    modes, bends = scene.compile().modes(2 * number), scene.rope.bending_stiffness is not None
    assert modes.certified
    found = []
    for plane, own, solve in (
        ("z", hung_rods.INSIDE, None),
        ("y", hung_rods.ACROSS, aside),
    ):
        mine = np.flatnonzero(modes.plane == plane)[:number]
        how = {"number": len(mine)}
        if bends:
            exact = hung_rods.rod(scene, own, **how)
        else:
            exact = hung_rods.string(scene, **how, **({"solve": solve} if solve else {}))
        off = np.abs(modes.frequency[mine] - exact)
        # an error that is exact may be passed by what elements leave, measured 1e-8
        accepted = np.maximum(modes.model_error[mine] + 1e-7 * exact, 1e-6 * exact)
        assert (off <= 1e-3 * exact).all()
        found.append((off / accepted).max())
    return max(found)


@pytest.mark.parametrize("bends", [False, True])
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.claim(
    "Six frequencies in each plane of ropes that hang, sag 0.001 to 0.3 of the chord, chords to "
    "1.2 rad: largest error over 1e-6 or the stated model error",
    reference="elements and collocation in fixed axes on the catenary: tests/support/hung_rods.py",
    accepted=1.0,
)
def test_hanging_ropes_have_the_frequencies_of_their_catenary(seed, bends, claim):
    claim(worst(hanging(np.random.default_rng((2041, seed)), bends=bends)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(300))
@pytest.mark.claim(
    "The same of 300 ropes, half of them with bending",
    reference="elements and collocation in fixed axes on the catenary: tests/support/hung_rods.py",
    accepted=1.0,
)
def test_many_hanging_ropes_have_the_frequencies_of_their_catenary(seed, claim):
    claim(worst(hanging(np.random.default_rng((2042, seed)), bends=bool(seed % 2))))


# what is solved ------------------------------------------------------------------------------


def test_tension_is_known_along_the_chord():
    on = INCLINED.on_catenary()
    axis, weight = on.rope.axis, on.rope.linear_density * on.gravity.g
    s = np.array([0.0, 0.3, 1.0]) * axis.length
    chord = np.array([math.cos(0.6), 0.0, math.sin(0.6)])
    along = on.tension_at(s) * (axis.frame(s)[:, :, 0] @ chord)
    # exact for a catenary: the weight alone changes the force
    np.testing.assert_allclose(along, 3000.0 + weight * math.sin(0.6) * s, rtol=1e-13)
    ends = axis.position(axis.length) - axis.position(0.0)
    np.testing.assert_allclose(ends, 100.0 * chord, atol=1e-10)


def test_steep_ropes_tend_to_upright_ones():
    upright = INCLINED.replace(gravity=rd.Gravity(inclination=math.pi / 2))
    leaning = INCLINED.replace(gravity=rd.Gravity(inclination=1.5707))
    found = [scene.compile().modes(4).frequency for scene in (upright, leaning)]
    # 1e-4 rad away, which acts by its square and on lambda^2 of 1e-6
    np.testing.assert_allclose(found[1], found[0], rtol=1e-6)


@pytest.mark.parametrize("sag", [0.008, 0.012])
def test_catenaries_tend_to_parabolas_with_the_square_of_sag(sag):
    scene = DEEP.replace(tension=2.0 * 9.81 * 100.0 / (8 * sag))
    parabola = scene.compile().modes(4)
    curve = scene.on_catenary().compile().modes(4)
    assert parabola.cost.method == "sweep"
    off = np.abs(parabola.frequency / curve.frequency - 1)
    assert (off <= 5.6 * sag**2).all()
    assert off.max() > 4.0 * sag**2
    # what Ritz's shapes leave
    np.testing.assert_allclose(parabola.catenary, curve.frequency, rtol=2e-5)


def test_answers_are_those_of_the_rope_on_its_axis():
    model, on = DEEP.compile(), DEEP.on_catenary()
    longer, space = on.rope.length / 100.0, on.compile()
    modes, own = model.modes(4), space.modes(4)
    assert (modes.frequency == own.frequency).all()
    np.testing.assert_allclose(modes.x * longer, own.x, rtol=1e-14)
    assert (modes.shape == own.shape).all()
    assert modes.cost.method == "sweep on the catenary"
    assert model.count(below=0.5) == space.count(below=0.5) == model.modes(below=0.5).frequency.size
    points = {"drive": ("z", 30.0), "response": [("x", 60.0), ("z", 30.0)]}
    there = {"drive": ("z", 30 * longer), "response": [("x", 60 * longer), ("z", 30 * longer)]}
    frf, far = model.frf([0.1, 0.4], **points), space.frf([0.1, 0.4], **there)
    assert (frf.value == far.value).all()
    assert frf.drive == (("z", 30.0),)
    bent, down = model.static({("z", 30.0): 5.0}), space.static({("z", 30.0 * longer): 5.0})
    assert (bent.displacement == down.displacement).all()
    np.testing.assert_allclose(bent.x * longer, down.x, rtol=1e-14)
    assert bent.load == ((("z", 30.0), 5.0),)


def test_forces_moved_ends_and_motion_are_those_of_the_rope_on_its_axis():
    damped = DEEP.replace(damping=rd.ViscousDamping(0.5))
    model, on = damped.compile(), damped.on_catenary()
    space, longer = on.compile(), on.rope.length / 100.0
    for drive, there in ((("z", 30.0), ("z", 30.0 * longer)), (("end", 0, "z"),) * 2):
        found = model.frf([0.1, 0.4], drive=drive, response=[("F_x", 0.0), ("z", 60.0)])
        right = space.frf([0.1, 0.4], drive=there, response=[("F_x", 0.0), ("z", 60.0 * longer)])
        np.testing.assert_array_equal(found.value, right.value)
    time, push = np.linspace(0.0, 8.0, 33), rd.Sine(1.0, 0.1)
    moves = model.transient(time, drive=("z", 30.0), force=push, response=("z", 60.0))
    own = space.transient(
        time, drive=("z", 30.0 * longer), force=push, response=("z", 60.0 * longer)
    )
    assert moves.cost.method == own.cost.method
    np.testing.assert_array_equal(moves.value, own.value)
    # a corner of the shape runs along the rope: the line knows it to 1.5e-3
    slack = {"tolerance": 1e-2}
    released = model.transient(time, start={("z", 30.0): 5.0}, response=("z", 30.0), **slack)
    start = {("z", 30.0 * longer): 5.0}
    falls = space.transient(time, start=start, response=("z", 30.0 * longer), **slack)
    np.testing.assert_array_equal(released.value, falls.value)


def test_parts_and_dampings_go_with_the_rope():
    parts = [rd.Spring(40.0, 300.0, coordinate="z"), rd.Dashpot(40.0, 20.0), rd.Support(70.0)]
    scene = DEEP.replace(parts=parts, damping=rd.ViscousDamping(0.5))
    on = scene.on_catenary()
    share = [part.x / on.rope.length for part in on.parts]
    np.testing.assert_allclose(share, [0.4, 0.4, 0.7], rtol=1e-15)
    value = scene.compile().frf([0.3], drive=("z", 20.0)).value
    there = on.compile().frf([0.3], drive=("z", 0.2 * on.rope.length)).value
    # the shares round
    np.testing.assert_allclose(value, there, rtol=1e-11)
    assert value.imag.all()


def test_more_than_the_first_frequency_along_the_rope_is_of_the_catenary():
    scene = DEEP.replace(tension=4e4)
    model, along = scene.compile(), math.sqrt(2e7 / 2.0) / 200.0
    few, many = model.modes(8), model.modes(24)
    assert few.cost.method == "sweep"
    assert few.frequency[-1] < 0.8 * along < many.frequency[-1]
    assert many.cost.method == "sweep on the catenary"
    assert "axial" in many.family
    assert model.count(below=1.3 * along) == model.modes(below=1.3 * along).frequency.size
    lines = [0.9 * along]
    assert model.frf(lines, drive=("z", 30.0)).cost.method == "sweep on the catenary"


def test_what_is_left_out_is_straight():
    assert INCLINED.effects[-3:] == ("stretch", "sag", "own weight")
    straight = INCLINED.without("sag")
    assert straight.gravity == rd.Gravity(inclination=0.6, sag=False)
    hoist = rd.Scene(ROPE.replace(axial_stiffness=None), tension=INCLINED.tension)
    hoist = hoist.replace(gravity=INCLINED.gravity)
    found = straight.compile().modes(4)
    across = found.frequency[found.family == "transverse"]
    np.testing.assert_allclose(
        across, hoist.compile().modes(4).frequency[: len(across)], rtol=1e-13
    )
    assert INCLINED.without("own weight").gravity.own_weight is False


# what is told ----------------------------------------------------------------------------------

RESONATOR = DEEP.replace(parts=[rd.Resonator(50.0, 1.0, 0.3)])


@pytest.mark.parametrize(
    ("scene", "how", "ask", "told"),
    [
        (DEEP, {"elements": 8}, lambda m: m.modes(1), "is of elements"),
        (RESONATOR, {}, lambda m: m.modes(1), "got resonator"),
        (RESONATOR, {}, lambda m: m.count(below=1.0), "got resonator"),
        (RESONATOR, {}, lambda m: m.static({("z", 50.0): 1.0}), "got resonator"),
        (DEEP, {}, lambda m: m.modes(1, damped=True), "damped motion is not carried"),
        (
            DEEP.replace(damping=rd.RayleighDamping(0.1, 0.0)),
            {},
            lambda m: m.transient(
                [0.0, 1.0], drive=("z", 30.0), force=rd.Sine(1.0, 0.1), method="modal"
            ),
            "motion over time by modes or events is not carried",
        ),
        (
            DEEP.replace(damping=rd.ViscousDamping(0.5)),
            {},
            lambda m: m.stepped_sine([0.1], drive=("z", 30.0), amplitude=1.0),
            "steady motion is not carried",
        ),
    ],
)
def test_what_stays_a_parabola_says_how_far_it_is_off(scene, how, ask, told):
    model = scene.compile(**how)
    off = rf"that of a parabola, off by up to 0\.\d+ of a frequency: .*{told}"
    with pytest.warns(rd.ModelWarning, match=off):
        assert ask(model) is not None


def test_masses_make_a_parabola_less_true():
    light = DEEP.replace(tension=2e4)
    assert light.compile().modes(1).cost.method == "sweep"
    heavy = light.replace(parts=[rd.PointMass(50.0, 10.0)])
    assert heavy.compile().modes(4).cost.method == "sweep on the catenary"


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (
            {"parts": [rd.Resonator(50.0, 1.0, 0.3)]},
            r"parts\[0\] must be one of point mass, spring",
        ),
        ({"rope": ROPE.replace(torsional_stiffness=5.0)}, "torsional_stiffness needs"),
        ({"tension": rd.Tension(3e3, stretching=True)}, "tension must"),
        ({"tension": rd.Tension(100.0, at="end")}, "tension must be"),
        ({"gravity": rd.Gravity(-9.81, inclination=0.6)}, "g must be > 0"),
        ({"damping": rd.ModalDamping(0.01)}, "damping must be left out"),
    ],
)
def test_what_is_not_carried_on_an_inclined_catenary_is_refused(changes, told):
    with pytest.raises(rd.SceneError, match=told):
        INCLINED.replace(**changes)


def test_elements_and_families_are_of_straight_ropes():
    with pytest.raises(rd.SceneError, match="elements must be left out for a rope on its catenary"):
        INCLINED.compile(elements=8)
    with pytest.raises(rd.SceneError, match="sag or own_weight must be False for a family"):
        INCLINED.family(["tension"])


def test_only_what_sags_has_a_catenary():
    with pytest.raises(rd.SceneError, match="gravity must curve the rope"):
        INCLINED.without("sag").on_catenary()
    with pytest.raises(rd.SceneError, match="own_weight must be True"):
        INCLINED.without("own weight").on_catenary()


def test_files_keep_what_answers_are_of(tmp_path):
    modes = INCLINED.compile().modes(3)
    modes.save(tmp_path / "modes.nc")
    again = rd.load(tmp_path / "modes.nc")
    assert again.cost.method == "sweep on the catenary"
    assert (again.frequency == modes.frequency).all()
    INCLINED.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == INCLINED


def test_film_lies_on_the_curve():
    film = INCLINED.compile().modes(1).animate(0, frames=4)
    chord = np.hypot(*(film.rest[-1] - film.rest[0])[[0, 2]])
    assert chord == pytest.approx(100.0, rel=1e-9)
