"""The assembled tensed element: any compression, and damping of sections without tension."""

import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd

L, B, MU = 1.5, 2.0, 0.1
ROPE = rd.Rope(L, MU, bending_stiffness=B)


def pinned(tension, elements):
    scene = rd.Scene(ROPE, tension=tension, ends=("pinned", "pinned"))
    return scene.compile(elements=elements, element="tensed")


# one element is critical as a cantilever at pi/2
ANGLES = [0.5, 1.5, math.pi / 2, 1.6, 2.0, 3.0, 4.0, 6.0]


@pytest.mark.parametrize("angle", ANGLES)
def test_end_of_a_pinned_column_turns_as_in_the_textbook(angle):
    # beta per moment at the same end (1 - a cot a)/(|T| L), a = L sqrt(|T|/B): one element
    T = -((angle / L) ** 2) * B
    static = pinned(T, 1).static({("beta", 0.0): 1.0}, solver="lapack", unstable=True)
    exact = (1 - angle / math.tan(angle)) / (-T * L)
    # the sum of two springs, each good to a few eps; at pi: cot a, 1/|sin a| of its angle
    bound = 64 * EPS * (1 + angle**2 / math.sin(angle) ** 2 / abs(exact * T * L))
    assert static.displacement[0, 1] == pytest.approx(exact, rel=bound)


@pytest.mark.parametrize("angle", ANGLES)
@pytest.mark.parametrize("ends", ["pinned", "clamped"])
def test_middle_of_a_column_of_two_elements_yields_as_in_the_textbook(ends, angle):
    # each element a = (L/2) sqrt(|T|/B); pinned (tan a - a)/(2 |T| k), k = a/(L/2);
    # clamped: a quarter of the rope is what a half is to the pinned one, (2 tan(a/2) - a)/(2 |T| k)
    k = angle / (L / 2)
    T = -(k**2) * B
    scene = rd.Scene(ROPE, tension=T, ends=(ends, ends))
    model = scene.compile(elements=2, element="tensed")
    part = angle if ends == "pinned" else angle / 2
    if part == math.pi / 2:
        # the critical load of the whole, to the last digit: nothing to compare
        return
    exact = (angle / part) * (math.tan(part) - part) / (2 * -T * k)
    # relative change of tan a - a with a
    slope = abs(part * math.tan(part) ** 2 / (math.tan(part) - part))
    value = model.static({("z", L / 2): 1.0}, solver="lapack", unstable=True).displacement[1, 0]
    assert value == pytest.approx(exact, rel=64 * EPS * (1 + slope))


@pytest.mark.parametrize("elements", [1, 2, 3, 8])
@pytest.mark.parametrize("beyond", [-0.5, -1e-3, -1e-9, 1e-9, 1e-3, 0.5])
def test_pinned_column_of_any_elements_buckles_at_euler_s_load(elements, beyond):
    # the static element is exact: lambda_1 changes sign at T = -pi^2 B/L^2 whatever n
    euler = -(math.pi**2) * B / L**2
    model = pinned(euler * (1 + beyond), elements)
    if elements == 1:
        # rotations without inertia: the lowest value of their stiffness changes sign
        lowest = np.linalg.eigvalsh(model.stiffness_matrix().toarray())[0]
    else:
        lowest = model.modes(1, solver="lapack").eigenvalue[0]
    assert math.copysign(1, lowest) == -math.copysign(1, beyond)


@pytest.mark.parametrize("elements", [2, 3, 8])
@pytest.mark.parametrize("share", [0.9, 0.999, 1.001, 1.7, 3.3])
def test_beyond_its_critical_load_a_column_responds_as_by_the_band(elements, share):
    model = pinned(-share * math.pi**2 * B / L**2, elements)
    drive = ("beta", 0.0)
    f = [0.0, 3.0, 40.0]
    lapack, band = (model.frf(f, drive=drive, solver=s) for s in ("lapack", "band"))
    allowed = (lapack.rounding_error + band.rounding_error) * np.abs(band.value)
    assert (np.abs(lapack.value - band.value) <= 4 * allowed).all()
    # condition n^4/10 = 400, a thousand times that next to the critical load: 1e-10; and the
    # estimate is within a hundred of that
    assert (allowed < 1e-8 * np.abs(band.value)).all()


@pytest.mark.parametrize("tension", [-3.0, 40.0, 3000.0])
@pytest.mark.parametrize("lay", [None, 0.3])
@pytest.mark.parametrize("elements", [1, 2, 24])
def test_sections_are_damped_and_tension_is_not(elements, lay, tension):
    rope = ROPE.replace(torsional_stiffness=0.7, polar_inertia=1e-4, lay_slope=lay)
    scene = rd.Scene(
        rope,
        tension=tension,
        ends=("clamped", "free"),
        damping=(rd.StiffnessDamping(1e-3), rd.RayleighDamping(0.3, 1e-4)),
        parts=[rd.Spring(L, 30.0)],
    )
    model = scene.compile(elements=elements, element="tensed")
    points = [("z", L), ("beta", L), ("alpha", L)]
    f = [0.0, 2.0, 31.0, 170.0, 900.0]
    lapack, sweep = (
        model.frf(f, drive=points, response=points, solver=s) for s in ("lapack", "sweep")
    )
    allowed = (lapack.rounding_error + sweep.rounding_error) * np.abs(sweep.value)
    known = np.isfinite(allowed)
    # |D| sums the magnitudes of one rounding each; an entry of D has a few
    assert (np.abs(lapack.value - sweep.value)[known] <= 8 * allowed[known]).all()
    with pytest.raises(rd.SceneError, match="damping must scale sections and tension alike"):
        model.damping_matrix()


def test_stiffness_damping_of_one_tensed_element_is_that_of_its_complex_stiffness():
    # tip of a tensed cantilever under a static-like load, g = 1 + i omega gamma on B alone:
    # h = (l - tanh(k l)/k)/T less the inertia of the tip, k = sqrt(T/(B g))
    T, gamma, f = 80.0, 1e-3, 7.0
    scene = rd.Scene(
        rd.Rope(L, 1e-15, bending_stiffness=B),
        tension=T,
        ends=("clamped", "free"),
        damping=rd.StiffnessDamping(gamma),
    )
    model = scene.compile(elements=1, element="tensed")
    value = model.frf(f, drive=("z", L), solver="lapack").value[0, 0]
    k = np.sqrt(T / (B * (1 + 2j * math.pi * f * gamma)))
    exact = (L - np.tanh(k * L) / k) / T
    # a mass of 1e-15 kg/m changes 1e-12; some ten roundings
    assert abs(value / exact - 1) < 1e-11
