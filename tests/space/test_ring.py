"""Closed axes: a ring against its closed form, its halves and itself cut elsewhere."""

import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space.spectrum import count_below

E, G = 2e11, 2e11 / 2.6
AREA, J = math.pi * 0.1**2 / 4, math.pi * 0.1**4 / 64
ROD = rd.Rope(
    rd.Axis.ring(1.0), 8000 * AREA, bending_stiffness=E * J, torsional_stiffness=2 * G * J
)
LENGTH = ROD.length


def ring(**more):
    return rd.Scene(ROD, planes="both", **more).compile()


IN_PLANE = ["53.3821907562882793857572", "150.9876363134611051086826", "289.5055770031113002103898"]
ACROSS = ["51.84936718324143801010891", "148.7725387004754471054768", "286.9844354372875486791299"]


def test_a_free_ring_has_six_rigid_motions_and_every_other_mode_twice():
    modes = ring().modes(below=300.0)
    assert modes.certified
    for plane, wanted in (("z", IN_PLANE), ("y", ACROSS)):
        found = modes.frequency[modes.plane == plane]
        assert (found[:3] == 0).all()
        twice = np.repeat(np.array(wanted, dtype=float), 2)
        assert found[3:] == pytest.approx(twice, rel=1e-13)  # 3e-15, references of 22 digits
    assert (modes.rounding_error[6:] < 1e-12 * modes.frequency[6:]).all()
    # its end is its beginning
    assert modes.shape[:, -1] == pytest.approx(modes.shape[:, 0], abs=1e-12)


def test_counts_of_a_ring_find_both_of_a_pair():
    model = ring()
    every = np.sort(np.array([*IN_PLANE, *ACROSS], dtype=float))
    for k, f in enumerate(every):
        for side, more in ((-1e-9, 0), (1e-9, 2)):
            assert model.count(below=f * (1 + side)) == 6 + 2 * k + more


@pytest.mark.parametrize("place", [0.5, 6.5, 6.75, 7.0, 7.5, 11.0])
def test_counts_of_a_ring_that_is_cut_anywhere_know_its_pairs(place):
    # a quarter is 7.02 m: joints that lose two digits each, one by one, counted 1e-9 off there
    R, C = 4.47, 0.8
    rope = rd.Rope(rd.Axis.ring(R), 1.0, bending_stiffness=1.0, torsional_stiffness=C)
    spring = rd.Spring(place, 13.6, coordinate="x")
    model = rd.Scene(rope, planes="both", parts=[spring]).compile()
    # the spring does not move where the ring bends across its plane: Love (1927), article 293
    exact = math.sqrt(4 * 9 / (R**4 * (4 + 1 / C))) / (2 * math.pi)
    others = model.count(below=exact * (1 - 1e-11))
    assert model.count(below=exact * (1 + 1e-11)) == others + 2
    found = model.modes(others + 2)
    assert found.certified
    assert (np.abs(found.frequency[-2:] - exact) <= found.rounding_error[-2:]).all()


def parts(shift):
    """A ring that three springs hold and a mass loads, all so far along it."""

    def at(share):
        return (share * LENGTH + shift) % LENGTH

    return [
        rd.PointMass(at(0.2), 5.0),
        rd.Spring(at(0.0), 1e6, coordinate="z"),
        rd.Spring(at(0.4), 2e6, coordinate="y"),
        rd.Spring(at(0.7), 3e6, coordinate="x"),
        *(rd.Support(at(0.05), coordinate=c) for c in ("y", "z", "alpha")),
    ], at


@pytest.mark.parametrize("share", [0.05, 0.123, 0.3, 0.8, 0.95])
def test_where_a_ring_is_cut_changes_nothing(share):
    answers = []
    for shift in (0.0, share * LENGTH):
        standing, at = parts(shift)
        model = ring(parts=standing, damping=rd.RayleighDamping(1.0, 1e-6))
        drive, response = [("z", at(0.3)), ("y", at(0.55))], [("gamma", at(0.9)), ("z", at(0.31))]
        frf = model.frf([10.0, 33.0, 120.0], drive=drive, response=response)
        static = model.static({("z", at(0.3)): 100.0, ("y", at(0.55)): 30.0}, points=1)
        node = [int(np.abs(static.x - at(s)).argmin()) for s in (0.05, 0.3, 0.7)]
        bounds = static.rounding_error[node], static.force_rounding_error[node]
        answers += [(model.modes(10), frf, static.displacement[node], static.force[node], bounds)]
    one, other = answers
    modes = one[0].rounding_error + other[0].rounding_error
    assert (np.abs(one[0].frequency - other[0].frequency) <= modes).all()
    limit = one[1].rounding_limit + other[1].rounding_limit
    assert (np.abs(one[1].value - other[1].value) <= limit).all()
    assert (limit <= 1e-11 * np.abs(one[1].value)).all()
    for k in (2, 3):
        assert (np.abs(one[k] - other[k]) <= one[4][k - 2] + other[4][k - 2]).all()
        assert np.abs(one[k]).max() > 1e6 * one[4][k - 2].max()


@pytest.mark.parametrize("share", [0.1, 0.7, 0.95])
def test_forces_inside_a_ring_are_those_on_the_left_wherever_it_is_cut(share):
    answers = []
    for shift in (0.0, share * LENGTH):
        standing, at = parts(shift)
        model = ring(parts=standing, damping=rd.RayleighDamping(1.0, 1e-6))
        seen = [(c, at(s)) for c in ("F_y", "F_z", "M_beta") for s in (0.0, 0.2, 0.3, 0.55)]
        drive = [("z", at(0.3)), ("y", at(0.55)), ("x", at(0.0))]
        answers.append(model.frf([10.0, 33.0, 120.0], drive=drive, response=seen))
    one, other = answers
    limit = one.rounding_limit + other.rounding_limit
    assert (np.abs(one.value - other.value) <= limit).all()
    assert limit.max() <= 1e-10 * np.abs(one.value).max()


def test_a_ring_has_no_end_to_move():
    with pytest.raises(rd.SceneError, match="drive must not be an end of an axis that is closed"):
        ring().frf([10.0], drive=("end", 0, "y"), response=("y", 1.0))


def test_a_ring_that_is_held_at_one_place_is_an_arc_with_both_ends_there():
    held = [rd.Support(0.0, coordinate=c) for c in ring().coordinates]
    arc = rd.Rope(
        rd.Axis.arc(1.0, 2 * math.pi),
        8000 * AREA,
        bending_stiffness=E * J,
        torsional_stiffness=2 * G * J,
    )
    wanted = rd.Scene(arc, planes="both").compile()
    model = ring(parts=held)
    assert model.modes(12).frequency == pytest.approx(wanted.modes(12).frequency, rel=1e-12)
    for value in np.geomspace(1e3, 1e9, 40):
        assert count_below(model.rope, value) == count_below(wanted.rope, value)


def test_a_ring_is_no_arc_and_comes_back_from_a_file(tmp_path):
    assert rd.Axis.ring(1.0) != rd.Axis.arc(1.0, 2 * math.pi)
    axis = rd.Axis.ring(0.7).reversed()
    scene = rd.Scene(ROD.replace(axis=axis, length=axis.length), planes="both")
    scene.save(tmp_path / "ring.toml")
    again = rd.Scene.load(tmp_path / "ring.toml")
    assert again == scene
    assert again.rope.axis.closed
    assert "ends     none" in repr(scene)
    # no straight rope has no ends
    assert "axis" not in scene.effects


def test_frames_that_do_not_meet_are_a_kink_where_a_ring_closes():
    half = rd.Axis.ring(1.0)
    (piece,), (begin,) = half.pieces, half.begins
    turned = np.array(begin[1]) @ [[1, 0, 0], [0, 0, -1], [0, 1, 0]]
    twice = rd.Axis(
        (piece._replace(length=math.pi), piece._replace(length=math.pi)),
        (begin, ((0.0, 0.0, 2.0), tuple(map(tuple, turned @ np.diag([-1.0, -1.0, 1.0]))))),
        closed=True,
    )
    assert [kink.s for kink in twice.kinks] == [0.0, math.pi]
    assert half.kinks == ()


REFUSED = {
    "ends must be left out on an axis that is closed": {"ends": ("free", "free")},
    "friction of the tension must be left out": {"tension": rd.Tension(10.0, friction=0.1)},
}


@pytest.mark.parametrize("message", REFUSED)
def test_a_ring_has_no_ends_and_nothing_that_grows_along_it(message):
    with pytest.raises(rd.SceneError, match=message):
        rd.Scene(ROD, planes="both", **REFUSED[message])


def test_the_section_of_a_ring_does_not_turn():
    turned = ROD.replace(principal_angle=((0.0, LENGTH), (0.0, 1.0)), bending_stiffness=(1.0, 2.0))
    with pytest.raises(rd.SceneError, match="principal_angle along the rope must be left out"):
        rd.Scene(turned, planes="both")


FREE = rd.Rope(rd.Axis.ring(1.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
PUSHED = [("x", 2.0), ("y", 3.0), ("z", 1.0)]
"""How far a force on a free ring moves its own place, over 1/(mass omega^2), as a rigid one does:
along it turns it by 1/R^2, across its plane by 2/R^2 about the diameter."""


@pytest.mark.parametrize(("coordinate", "share"), PUSHED)
def test_a_free_ring_is_pushed_as_a_rigid_body_or_refused(coordinate, share):
    model, answered = rd.Scene(FREE, planes="both").compile(), 0
    for f in 10.0 ** -np.arange(6.0, 24.0):
        try:
            frf = model.frf([f], drive=(coordinate, 0.4))
        except rd.SolveError as refusal:
            assert "has no correct digit" in str(refusal)
            assert f < 1e-13
            continue
        answered += 1
        exact = -share / (FREE.linear_density * FREE.length * (2 * math.pi * f) ** 2)
        # what bends is 1e-13 of it at 1e-6 Hz
        assert abs(frf.value[0, 0] / exact - 1) < frf.rounding_error[0, 0] + 1e-12
    assert answered >= 8


@pytest.mark.parametrize("coordinate", ["x", "y", "z", "alpha", "beta", "gamma"])
@pytest.mark.parametrize("axial_stiffness", [None, 1e5])
def test_a_free_ring_has_no_response_at_rest(coordinate, axial_stiffness):
    rope = FREE.replace(axial_stiffness=axial_stiffness)
    model = rd.Scene(rope, planes="both").compile()
    for f in ([0.0], [3.0, 0.0, 10.0], [0.0, *np.linspace(1.0, 9.0, 40)]):
        with pytest.raises(rd.SolveError, match=r"frequency 0\.0 Hz has no correct digit in \("):
            model.frf(f, drive=(coordinate, 0.4))


@pytest.mark.parametrize("unstable", [False, True])
@pytest.mark.parametrize(
    "axis",
    [rd.Axis.ring(1.0), rd.Axis.arc(1.0, 2.0), rd.Axis.helix(0.1, 0.2, 30)],
    ids=["ring", "arc", "helix"],
)
def test_loads_in_balance_do_not_hold_a_free_rope(axis, unstable):
    ends = {} if axis.closed else {"ends": ("free", "free")}
    model = rd.Scene(FREE.replace(length=axis), planes="both", **ends).compile()
    for load in (
        {("z", 0.0): 1.0, ("z", axis.length / 2): 1.0},
        {("y", 0.3): 1.0, ("y", 0.6): -1.0},
        {("alpha", 0.3): 1.0},
    ):
        with pytest.raises(rd.SolveError, match="a rigid motion is free"):
            model.static(load, unstable=unstable)
        with pytest.raises(rd.SceneError, match="the rope has no rest under a load"):
            coordinate = next(iter(load))[0]
            model.transient(np.linspace(0.0, 0.1, 6), start=load, response=(coordinate, 0.5))


def test_a_free_helix_has_a_steady_state_and_no_critical_load():
    """Counts below 0 have some of its rigid motions."""
    rope = FREE.replace(length=rd.Axis.helix(0.1, 0.2, 30))
    model = rd.Scene(rope, planes="both", ends=("free", "free")).compile()
    stepped = model.stepped_sine([3.0], drive=("z", 0.5), amplitude=1.0)
    assert stepped.value == pytest.approx(model.frf([3.0], drive=("z", 0.5)).value, rel=1e-12)


def test_peaks_of_pairs_give_back_bending_and_torsion():
    """Orders are those of modes that vibrate; a double mode is two."""
    scene = rd.Scene(FREE, planes="both")
    peaks = scene.compile().modes(14).frequency[6:]
    guess = FREE.replace(bending_stiffness=45.0, torsional_stiffness=25.0)
    fit = rd.identify(
        scene.replace(rope=guess),
        rd.Peaks(peaks, std=1e-4 * peaks),
        ["bending_stiffness", "torsional_stiffness"],
        orders=range(1, 9),
    )
    assert fit.status == "trusted"
    assert [
        fit.value[path] for path in ("bending_stiffness", "torsional_stiffness")
    ] == pytest.approx([50.0, 30.0], rel=1e-12)
    # and it says nothing of ends that a ring has not
    assert not fit.said_of_ends
