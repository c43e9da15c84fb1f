"""Drives and responses between the nodes: static shape, local flexibility, several at once."""

import numpy as np
import pytest
from conftest import EPS, LAID, LENGTH, beam

import ropedyn as rd

SCENES = {
    "string": rd.Scene(rd.Rope(1.0, 0.1), tension=70.0),
    "beam": rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=5.0), ends=("clamped", "pinned")),
    "cantilever": rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=5.0), ends=("clamped", "free")),
    "laid": rd.Scene(LAID),
    "laid, sprung": rd.Scene(LAID, parts=[rd.Spring(0.5, 40.0), rd.Support(0.75)]),
}
PLACES = [(0.31, 0.31), (0.31, 0.36), (0.36, 0.31), (0.31, 0.7), (0.31, 0.375), (0.25, 0.36)]


def with_nodes_at(scene, *positions):
    """The same scene with a node, of no mass, at each of these positions."""
    return scene.replace(parts=scene.parts + tuple(rd.PointMass(x, 0) for x in positions))


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize(("drive", "response"), PLACES)
def test_static_response_between_nodes_is_that_of_a_chain_with_nodes_there(name, drive, response):
    # without tension on a beam the elements are exact in statics, and so is what is inside them
    scene = SCENES[name]
    coarse = scene.compile(elements=8, element="rigid")
    fine = with_nodes_at(scene, drive, response).compile(elements=20, element="rigid")
    c = scene.coordinates
    drives, responses = [(k, drive) for k in c], [(k, response) for k in c]
    value = coarse.frf(0.0, drive=drives, response=responses).value[..., 0]
    exact = fine.frf(0.0, drive=drives, response=responses).value[..., 0]
    own = fine.frf(0.0, drive=drives).value[..., 0].real.diagonal()
    there = fine.frf(0.0, drive=responses).value[..., 0].real.diagonal()
    # relative to sqrt(h_dd h_rr), the bound of any response; the finer chain is the worse:
    # 50 (n/pi)^4 eps with the shortest element 0.01 as if n = 100 for its z, 5e-9 at most;
    # its static values keep far more (a few hundred eps, seen as components of the unit load)
    scale = np.sqrt(np.outer(own, there))
    np.testing.assert_allclose(value / scale, exact / scale, rtol=0, atol=1e-10)


@pytest.mark.parametrize("drive", [0.1, 0.31, 0.5, 0.93])
@pytest.mark.parametrize("response", [0.02, 0.31, 0.36, 0.97])
def test_static_response_of_a_clamped_beam_is_its_influence_function(drive, response):
    # w(x) for F at a: F (L-a)^2 x^2 (3 a L - (L + 2 a) x)/(6 B L^3), x <= a
    model = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=5.0)).compile(elements=4, element="rigid")
    x, a = sorted((drive, response))
    exact = (1 - a) ** 2 * x**2 * (3 * a - (1 + 2 * a) * x) / (6 * 5.0)
    value = model.frf(0.0, drive=("z", drive), response=("z", response)).value[0, 0]
    # the condition of four elements, 50 (4/pi)^4 = 130, times a few eps of the largest: L^3/192 B
    assert abs(value - exact) <= 500 * EPS / (192 * 5.0)


@pytest.mark.parametrize(("drive", "response"), PLACES)
def test_static_response_of_a_string_is_its_triangle(drive, response):
    value = (
        SCENES["string"]
        .compile(elements=4, element="rigid")
        .frf(0.0, drive=("z", drive), response=("z", response))
    )
    left, right = sorted((drive, response))
    exact = left * (1 - right) / 70.0
    # condition of four elements is below 10
    assert value.value[0, 0] == pytest.approx(exact, rel=40 * EPS)


@pytest.mark.parametrize("s", [0.003, 0.05, 0.11, 0.16])
@pytest.mark.parametrize("coordinate", ["z", "beta"])
def test_motion_between_nodes_is_the_cubic_through_them(s, coordinate):
    a = LENGTH / 8
    model = beam(8, tension=300.0, damping=rd.StiffnessDamping(1e-4)).compile(
        elements=8, element="rigid"
    )
    frequency = np.array([0.0, 50.0, 260.0, 900.0])
    nodes = [("z", 4 * a), ("beta", 4 * a), ("z", 5 * a), ("beta", 5 * a)]
    u = model.frf(frequency, drive=("z", 2 * a), response=nodes, solver="lapack").value
    t = s / a
    shape = {
        "z": [
            1 - 3 * t**2 + 2 * t**3,
            a * (t - 2 * t**2 + t**3),
            3 * t**2 - 2 * t**3,
            a * (t**3 - t**2),
        ],
        "beta": [
            6 * (t**2 - t) / a,
            1 - 4 * t + 3 * t**2,
            6 * (t - t**2) / a,
            3 * t**2 - 2 * t,
        ],
    }[coordinate]
    at = (coordinate, 4 * a + s)
    between = model.frf(frequency, drive=("z", 2 * a), response=at, solver="lapack").value[0]
    # sums of eight products that cancel in part: a few eps of their sizes
    size = np.abs(u).T @ np.abs(shape)
    assert (np.abs(between - np.array(shape) @ u) <= 40 * EPS * size).all()


@pytest.mark.parametrize("frequency", [0.0, 40.0, 333.0])
@pytest.mark.parametrize("coordinates", [("z", "z"), ("z", "beta"), ("alpha", "beta"), ("x", "z")])
@pytest.mark.parametrize("places", [(0.31, 0.36), (0.31, 0.77), (0.05, 0.5)])
def test_force_and_response_between_nodes_can_change_places(frequency, coordinates, places):
    scene = SCENES["laid"].replace(tension=60.0, damping=rd.StiffnessDamping(1e-4))
    model = scene.compile(elements=8, element="rigid")
    here, there = zip(coordinates, places)
    forth = model.frf(frequency, drive=here, response=there)
    back = model.frf(frequency, drive=there, response=here)
    own = [abs(model.frf(frequency, drive=point).value[0, 0]) for point in (here, there)]
    # a few hundred eps of the bound sqrt(h_dd h_rr) of what statics can give: the condition of
    # eight elements, 50 (8/pi)^4 = 2e3
    assert abs(forth.value[0, 0] - back.value[0, 0]) <= 2e3 * EPS * np.sqrt(own[0] * own[1])


@pytest.mark.parametrize("damping", [rd.StiffnessDamping(1e-3), rd.RayleighDamping(0, 1e-3)])
@pytest.mark.parametrize("name", ["string", "beam"])
def test_local_flexibility_is_damped_as_the_element_is(name, damping):
    # at high frequency the nodes stand still and only the inside of the element moves
    scene, f = SCENES[name].replace(damping=damping), 1e6
    scene = scene.replace(rope=scene.rope.replace(rotary_inertia=1e-3))
    factor = 1 + 2j * np.pi * f * 1e-3
    if name == "string":
        # a/4 T half way along an element of length a; stiffness damping leaves tension alone
        local = 0.125 / 4 / 70.0
        factor = factor if isinstance(damping, rd.RayleighDamping) else 1.0
    else:
        local = 0.125**3 / (192 * 5.0)
    value = scene.compile(elements=8, element="rigid").frf(f, drive=("z", 0.3125)).value[0, 0]
    # what moves at a node is its mass, by 1/(omega^2 m); half the force goes to each of two
    nodes = 1 / ((2 * np.pi * f) ** 2 * 0.1 * 0.125)
    assert nodes < 0.01 * abs(local / factor)
    assert abs(value - local / factor) <= nodes


@pytest.mark.parametrize("side", [-1e-7, 1e-7])
def test_local_flexibility_vanishes_towards_the_nodes(side):
    model = SCENES["beam"].compile(elements=8, element="rigid")
    at_node = model.frf(20.0, drive=("z", 0.375)).value[0, 0]
    near = model.frf(20.0, drive=("z", 0.375 + side)).value[0, 0]
    # the receptance's slope is of its own order over the length
    assert near == pytest.approx(at_node, rel=1e-5)


@pytest.mark.parametrize("away", [0.5e-9, -0.5e-9])
def test_position_within_a_billionth_of_a_node_is_that_node(away):
    model = beam(8).compile(elements=8, element="rigid")
    node, place = ("z", LENGTH / 2), ("z", LENGTH / 2 + away * LENGTH)
    one, other = (model.frf([0.0, 60.0], drive=point).value for point in (node, place))
    np.testing.assert_array_equal(one, other)


def test_force_between_nodes_moves_no_mass():
    # at the same node spacing the response to a force next to a node tends to that at the node at
    # every frequency: a force brings no inertia
    model = SCENES["string"].compile(elements=8, element="rigid")
    frequency = np.linspace(1, 400, 17)
    node = model.frf(frequency, drive=("z", 0.5), response=("z", 0.25)).value
    near = model.frf(frequency, drive=("z", 0.5 + 1e-8), response=("z", 0.25)).value
    # 1e-8 of an eighth of the length, times slopes that are of the order of the response
    assert np.abs(near / node - 1).max() < 1e-5


def test_several_drives_are_each_one_alone():
    model = beam(8, tension=300.0, damping=rd.StiffnessDamping(1e-4)).compile(
        elements=8, element="rigid"
    )
    frequency = np.linspace(0, 300, 7)
    drives = [("z", 0.3), ("beta", LENGTH / 2), ("z", 1.1)]
    responses = [("beta", 0.2), ("z", 0.31)]
    together = model.frf(frequency, drive=drives, response=responses, solver="lapack")
    assert together.value.shape == together.rounding_error.shape == (3, 2, 7)
    for d, drive in enumerate(drives):
        for r, response in enumerate(responses):
            alone = model.frf(frequency, drive=drive, response=response, solver="lapack")
            np.testing.assert_array_equal(together.value[d, r], alone.value[0])
            assert (together.curve(r, d) == alone.curve()).all()


def test_default_responses_are_the_drives():
    model = beam(8).compile(elements=8, element="rigid")
    drives = [("z", 0.3), ("beta", 0.7)]
    frf = model.frf([10.0], drive=drives)
    assert frf.response == frf.drive == tuple(drives)
    # one drive in a list is a list
    assert model.frf([10.0], drive=drives[:1]).value.shape == (1, 1, 1)
    assert model.frf([10.0], drive=drives[0]).value.shape == (1, 1)


@pytest.mark.parametrize("place", [0.5, 0.52])
def test_response_in_another_component_is_exactly_nothing(place):
    rope = rd.Rope(
        1.0,
        0.1,
        bending_stiffness=5.0,
        torsional_stiffness=1.0,
        axial_stiffness=900.0,
        polar_inertia=1e-6,
    )
    model = rd.Scene(rope, tension=20.0).compile(elements=8, element="rigid")
    assert model.components == (("x",), ("z", "beta"), ("alpha",))
    points = [(c, place) for c in ("x", "z", "alpha", "beta")]
    frf = model.frf([0.0, 30.0], drive=points)
    together = np.array([[a == b or {a, b} == {"z", "beta"} for a, _ in points] for b, _ in points])
    assert (frf.value[~together] == 0).all()
    assert (frf.rounding_error[~together] == 0).all()
    if place == 0.52:
        assert (frf.value[together] != 0).all()


def test_local_flexibility_couples_what_the_lay_couples():
    # a torque half way along an element bends it there: H l/4 x (1/C - 1/B) of the cantilever
    # minus what the nodes take back; against the chain with a node there
    scene = rd.Scene(
        rd.Rope(1.0, 0.1, bending_stiffness=5.0, torsional_stiffness=1.0, lay_slope=0.5)
    )
    drive, response = ("alpha", 0.55), ("beta", 0.53)
    value = (
        scene.compile(elements=2, element="rigid")
        .frf(0.0, drive=drive, response=response)
        .value[0, 0]
    )
    fine = with_nodes_at(scene, 0.55, 0.53).compile(elements=40, element="rigid")
    exact = fine.frf(0.0, drive=drive, response=response).value[0, 0]
    # 40 elements: a thousand eps and more of the larger own responses
    assert abs(exact) > 1e-3
    assert value == pytest.approx(exact, rel=1e-9)
