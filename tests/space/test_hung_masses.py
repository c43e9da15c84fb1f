"""Masses on ropes that hang: a catenary with a kink at each."""

import math

import hung_masses
import numpy as np
import pytest
from catenary_elements import aside, elements
from conftest import slow
from random_scene import log_uniform

import ropedyn as rd

ROPE = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
MASSES = [rd.PointMass(30.0, 40.0), rd.PointMass(70.0, 10.0)]
STAY = rd.Scene(
    ROPE,
    tension=rd.Tension(3000.0, at="start"),
    gravity=rd.Gravity(inclination=0.4),
    planes="both",
    parts=MASSES,
)


def loaded(rng):
    """A string with one to three masses, as heavy as a thousandth to a half of it each."""
    length, density = log_uniform(rng, 1.0, 1000.0), log_uniform(rng, 0.1, 100.0)
    turned = float(rng.choice([0.0, rng.uniform(-0.9, 0.9)]))
    tension = density * 9.81 * length * log_uniform(rng, 0.6, 20.0)
    places = np.sort(rng.uniform(0.05, 0.95, int(rng.integers(1, 4)))) * length
    return rd.Scene(
        rd.Rope(length, density, axial_stiffness=tension * log_uniform(rng, 5e2, 1e4)),
        tension=tension,
        gravity=rd.Gravity(inclination=turned),
        planes="both",
        parts=[
            rd.PointMass(float(x), density * length * log_uniform(rng, 1e-3, 0.5)) for x in places
        ],
    )


@pytest.mark.parametrize("seed", [*range(6), *slow(*range(6, 106))])
@pytest.mark.claim(
    "Six frequencies in each plane of ropes with masses that hang between their ends, relative",
    reference="strings shot between their ends, elements in fixed axes: support/hung_masses.py",
    accepted=1e-11,
)
def test_frequencies_are_those_of_the_curve_that_the_masses_hang_in(seed, claim):
    scene = loaded(np.random.default_rng((2061, seed)))
    modes = scene.compile().modes(12)
    assert modes.certified
    assert modes.cost.method == "sweep on the catenary"
    off = []
    for plane, solve in (("z", elements), ("y", aside)):
        mine = np.flatnonzero(modes.plane == plane)[:6]
        exact = hung_masses.frequencies(scene, solve, number=len(mine))
        off.append(np.abs(modes.frequency[mine] / exact - 1).max())
    claim(max(off))


def test_the_curve_is_at_rest():
    on = STAY.on_catenary()
    axis = on.rope.axis
    ends = axis.position(axis.length) - axis.position(0.0)
    np.testing.assert_allclose(ends, [100 * math.cos(0.4), 0.0, 100 * math.sin(0.4)], atol=1e-11)
    # forces on both sides of a mass and its weight
    for kink, mass in zip(axis.kinks, MASSES, strict=True):
        above, below = (on.tension_at(kink.s + side * 1e-9 * axis.length) for side in (1, -1))
        after = above * axis.frame(kink.s)[:, 0]
        before = below * (axis.frame(kink.s) @ kink.turn)[:, 0]
        # the weight of the rope between the places asked, 4e-6 N, and rounding
        np.testing.assert_allclose(after - before, [0, 0, mass.mass * 9.81], atol=1e-5)
    level, up, long = hung_masses.at_rest(STAY)
    # fsolve stops at 1e-13
    assert axis.length == pytest.approx(long, rel=1e-12)
    np.testing.assert_allclose(on.tension_at(0.0), math.hypot(level, up), rtol=1e-12)
    assert STAY.tension.mean == pytest.approx(level * math.cos(0.4) + up * math.sin(0.4), rel=1e-12)


def test_a_mass_cut_in_two_hangs_as_one():
    one = STAY.replace(parts=[rd.PointMass(30.0, 40.0)]).compile().modes(6).frequency
    parts = [rd.PointMass(30.0, 25.0), rd.PointMass(30.0, 15.0)]
    two = STAY.replace(parts=parts).compile().modes(6).frequency
    np.testing.assert_allclose(two, one, rtol=1e-13)


def test_the_other_end_sees_the_same_rope():
    back = STAY.replace(
        tension=rd.Tension(3000.0, at="end"),
        gravity=rd.Gravity(inclination=-0.4),
        parts=[rd.PointMass(100.0 - p.x, p.mass) for p in reversed(MASSES)],
    )
    found, other = (scene.compile().modes(8).frequency for scene in (STAY, back))
    np.testing.assert_allclose(other, found, rtol=1e-12)
    axis = STAY.on_catenary().rope.axis
    turned = STAY.on_catenary().replace(
        rope=STAY.on_catenary().rope.replace(length=axis.reversed()),
        parts=[rd.PointMass(axis.length - p.x, p.mass) for p in STAY.on_catenary().parts],
    )
    np.testing.assert_allclose(turned.compile().modes(8).frequency, found, rtol=1e-12)


def test_axes_with_loads_are_kept_in_files(tmp_path):
    on = STAY.on_catenary()
    on.save(tmp_path / "stay.toml")
    assert rd.Scene.load(tmp_path / "stay.toml") == on


@pytest.mark.parametrize(
    ("loads", "told"),
    [
        ([(0.0, 1.0)], r"loads\[0\] must be a place between 0 and 1"),
        ([(0.5, -1.0)], r"loads\[0\] must be"),
        ([(0.2, 1.0), (0.5, math.nan)], r"loads\[1\]"),
        ([(0.5,)], r"loads\[0\] must be"),
    ],
)
def test_loads_that_are_none_are_refused(loads, told):
    with pytest.raises(rd.SceneError, match=told):
        rd.Axis.catenary(100.0, parameter=150.0, loads=loads)
    with pytest.raises(TypeError, match="loads must be pairs"):
        rd.Axis.catenary(100.0, parameter=150.0, loads=3.0)


def test_a_load_that_weighs_nothing_is_none():
    plain = rd.Axis.catenary(100.0, 20.0, parameter=150.0)
    assert rd.Axis.catenary(100.0, 20.0, parameter=150.0, loads=[(0.5, 0.0)]) == plain


def test_weights_and_loads_must_agree():
    on = STAY.on_catenary()
    with pytest.raises(rd.SceneError, match=r"parts must weigh 40\..* kg at"):
        on.replace(parts=on.parts[1:])
    with pytest.raises(rd.SceneError, match=r"parts\[2\] must hang where the axis has its load"):
        on.replace(parts=[*on.parts, rd.PointMass(50.0, 1.0)])


def test_bending_is_carried_where_kinks_hardly_bend_it():
    rope = ROPE.replace(bending_stiffness=2.0)
    found = STAY.replace(rope=rope).compile().modes(6).frequency
    string = STAY.compile().modes(6).frequency
    # clamps stiffen by 2 sqrt(B/T)/L = 5e-4, and masses clamp a little too
    np.testing.assert_allclose(found, string, rtol=2e-3)
    assert (found > string).all()
    with pytest.raises(rd.SceneError, match="rounds off"):
        STAY.replace(rope=ROPE.replace(bending_stiffness=1e6))
