"""Transfer functions as sums over modes, against the frequency response and closed forms."""

import pickle

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.chain.compiled import KEPT, NUMBERS
from ropedyn.motion.modal.expansion import expand
from ropedyn.signal import contour

STRING = rd.Rope(1.3, 0.1)
ROPE = rd.Rope(1.3, 0.1, bending_stiffness=0.8)
FREQUENCY = np.array([3.3, 17.0, 60.0, 200.0])


def at(expansion, s):
    """Evaluate the sum at rates s, (drives, responses, s)."""
    e = expansion
    top = e.a[..., None] + e.b[..., None] * s
    pairs = top / (s * s + 2 * e.sigma[:, None] * s + e.square[:, None])
    return e.rest[..., None] + pairs.sum(axis=-2) + e.late[..., None] / (1 + e.lag * s)


def summed(model, drive, response, **how):
    total = np.zeros((len(drive), len(response), len(FREQUENCY)), dtype=complex)
    for share in expand(model, drive, response, **how):
        total[np.ix_(share.drive, share.response)] = at(share.expansion, 2j * np.pi * FREQUENCY)
    return total


# parts stand where all elements are equal: elsewhere masses of tensed elements are indefinite
SCENES = {
    "string": rd.Scene(STRING, tension=100.0),
    "beam": rd.Scene(ROPE, tension=100.0),
    "rayleigh": rd.Scene(ROPE, tension=100.0, damping=rd.RayleighDamping(2.0, 1e-4)),
    "stiffness damping": rd.Scene(ROPE, damping=rd.StiffnessDamping(1e-4)),
    "drag": rd.Scene(ROPE, tension=100.0, damping=rd.ViscousDamping(0.5)),
    "on a pin": rd.Scene(ROPE, ends=("pinned", "free")),
    "supported": rd.Scene(ROPE, tension=100.0, parts=[rd.Support(0.65)]),
    "laid": rd.Scene(
        rd.Rope(
            1.3,
            0.1,
            axial_stiffness=1e5,
            torsional_stiffness=2.0,
            lay_coupling=90.0,
            polar_inertia=1e-5,
        ),
        damping=rd.RayleighDamping(2.0, 1e-5),
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_all_modes_of_a_chain_and_the_rest_are_its_frequency_response(name):
    """At frequencies up to the 20th resonance, to rounding near those."""
    element = "rigid" if name == "on a pin" else "tensed"
    model = SCENES[name].compile(elements=24, element=element)
    c = model.coordinates[0]
    force = {"z": "F_z", "x": "F_x"}[c]
    drive = [(c, 0.31), ("end", 0, c)]
    response = [(c, 0.4), (c, 0.31), (force, 0.65)]
    if "damping" in name or "rayleigh" in name:  # no force per motion of an end
        response = response[:2]
    if name == "laid":
        response = [*response[:2], ("alpha", 0.9)]
    exact = model.frf(FREQUENCY, drive=drive, response=response).value
    size = np.abs(exact).max(axis=2, keepdims=True)
    assert (np.abs(summed(model, drive, response) - exact) < 1e-10 * size).all()
    for share in expand(model, drive, response):
        assert (share.expansion.bound == 0).all()
        assert share.expansion.beyond == np.inf


def test_internal_force_of_damped_stiffness_is_that_of_the_response():
    model = SCENES["rayleigh"].compile(elements=24)
    drive, response = [("z", 0.31)], [("M_beta", 0.0), ("F_z", 0.65)]
    exact = model.frf(FREQUENCY, drive=drive, response=response).value
    np.testing.assert_allclose(summed(model, drive, response), exact, rtol=1e-10)
    with pytest.raises(rd.SceneError, match="an internal force where an end is moved"):
        expand(model, [("end", 0, "z")], response)


def test_free_rope_drifts_as_a_rigid_body():
    model = rd.Scene(ROPE, ends=("free", "free")).compile(elements=12)
    share = expand(model, [("z", 0.65)], [("z", 0.65)])[0].expansion
    exact = model.frf(FREQUENCY, drive=[("z", 0.65)], response=("z", 0.65)).value
    # masses of tensed elements at free ends are indefinite: what that adds at 200 Hz
    np.testing.assert_allclose(at(share, 2j * np.pi * FREQUENCY), exact, rtol=1e-5)
    rigid = share.square == 0
    assert share.a[0, 0, rigid].sum() == pytest.approx(1 / 0.13, rel=1e-9)  # 1/mass
    assert (share.sigma == 0).all()
    assert min(share.square) >= 0


def test_residues_of_a_string_are_those_of_its_sines():
    model = rd.Scene(STRING, tension=100.0).compile()
    share = expand(model, [("z", 0.31)], [("z", 0.9)], modes=20)[0].expansion
    k = np.arange(1, 21) * np.pi / 1.3
    np.testing.assert_allclose(share.square, 1000 * k**2, rtol=1e-12)
    exact = 2 / 0.13 * np.sin(k * 0.31) * np.sin(k * 0.9)
    np.testing.assert_allclose(share.a[0, 0], exact, rtol=0, atol=1e-10 * 2 / 0.13)
    exact = 0.31 * 0.4 / 1.3 / 100 - (exact / share.square).sum()
    assert share.rest[0, 0] == pytest.approx(exact, rel=1e-10)
    own = [x * (1.3 - x) / 1.3 / 100 for x in (0.31, 0.9)]
    sines = [(2 / 0.13 * np.sin(k * x) ** 2 / share.square).sum() for x in (0.31, 0.9)]
    bound = np.sqrt(np.prod(np.subtract(own, sines)))
    assert share.bound[0, 0] == pytest.approx(bound, rel=1e-9)
    assert abs(share.rest[0, 0]) < bound
    assert share.beyond == pytest.approx(21 * np.pi / 1.3 * 1000**0.5, rel=1e-12)


def test_bar_moved_at_its_end_is_the_string_that_it_is():
    """T = sin(k(L - x))/sin(kL) has the residues 2 w^2 sin(k_n x)/(n pi)."""
    model = rd.Scene(STRING, tension=100.0).compile()
    share = expand(model, [("end", 0, "z")], [("z", 0.4)], modes=10)[0].expansion
    k = np.arange(1, 11) * np.pi / 1.3
    exact = 2 * 1000 * k / 1.3 * np.sin(k * 0.4)
    np.testing.assert_allclose(share.a[0, 0], exact, rtol=1e-9, atol=1e-9 * exact.max())
    assert share.bound[0, 0] == np.inf


def test_double_modes_are_seen_together():
    """Two equal spans on both sides of a support, joined by nothing but beta's stiffness."""
    stiff = rd.Rope(1.3, 0.1, bending_stiffness=1e-9)
    model = rd.Scene(stiff, tension=100.0, parts=[rd.Support(0.65)]).compile(elements=32)
    drive, response = [("z", 0.3)], [("z", 0.2), ("z", 1.1)]
    exact = model.frf(FREQUENCY, drive=drive, response=response).value
    value = summed(model, drive, response)
    # all but the motion behind the support, which is nearly none
    np.testing.assert_allclose(value, exact, rtol=0, atol=1e-11 * np.abs(exact).max())


def test_circle_around_close_poles_keeps_what_they_are_together():
    pole = np.array([1.0, 1.0 + 1e-9, 1.0 + 2e-9, 2.0])
    own = np.array([3.0, -2.0, 4.0, 1.0])

    def function(z):
        return (own[:, None] / (z - pole[:, None])).sum(axis=0)

    circles = contour.on_a_line(pole, np.zeros(4), np.inf)
    assert circles.outer.size.tolist() == [3, 1]
    r = contour.residues(function, pole, circles)
    far = np.array([0.3, 1.3, 5.0])
    both = (r[:, None] / (far - pole[:, None])).sum(axis=0)
    np.testing.assert_allclose(both, function(far), rtol=1e-13)


@pytest.mark.parametrize(
    ("pole", "beyond", "sizes"),
    [
        ([1.0, 1.0001, 1.0002, 1.01], 2.0, [3, 1]),
        ([1.0, 1.0001, 1.0003, 1.0006], 1.001, [1, 1, 1, 1]),  # as at the end of a band
        ([1.0, 1.0 + 1e-7, 1.0001, 1.0003], 1.0005, [2, 1, 1]),
    ],
)
def test_close_poles_are_in_one_circle_if_others_are_far_from_it(pole, beyond, sizes):
    circles = contour.on_a_line(np.array(pole), np.zeros(len(pole)), beyond)
    assert circles.outer.size.tolist() == sizes
    own = np.arange(1.0, 1.0 + len(pole))

    def function(z):
        return (own[:, None] / (z - np.array(pole)[:, None])).sum(axis=0)

    r = contour.residues(function, np.array(pole), circles)
    gap = np.diff(pole, prepend=-np.inf, append=beyond)
    known = np.minimum(gap[:-1], gap[1:])  # 64 eps of the pole are said
    assert (np.abs(r - own) < 4 * np.finfo(float).eps / known * own).all()
    assert abs(r.sum() - own.sum()) < 1e-14 / known[np.argmax(known)] * own.sum()


def test_residues_beside_much_larger_ones_keep_their_digits():
    """A circle of 8 points sees 50^-8 of the next residue, which was taken for its own: 2e-5."""
    pole, own = np.array([1.0, 2.0, 4.0]), np.array([1e9, 1.0, 1.0])

    def function(z):
        return (own[:, None] / (z - pole[:, None])).sum(axis=0)

    r = contour.residues(function, pole, contour.on_a_line(pole, np.zeros(3), np.inf))
    # rounding of the function: eps 1e9 of its values, times a radius of 1/50
    assert (np.abs(r - own)[1:] < np.finfo(float).eps * 1e9 / 50).all()


@pytest.mark.parametrize(("apart", "spread"), [(1e-9, 0.0), (4e-3, 2e-3)])
def test_circles_are_as_wide_as_their_poles_and_their_room_ask_for(apart, spread):
    """1/50 of the way to the next pole around one, 1/4 or more around those that are close."""
    pole = np.array([10.0, 10.0 + apart, 14.0])
    circles = contour.on_a_line(pole, np.full(3, 1e-3), 20.0)
    assert circles.size.tolist() == [2, 1]  # the first two are not told apart
    np.testing.assert_allclose(circles.center, [10.0 + apart / 2, 14.0], rtol=1e-15)
    room = 4.0 - apart
    own = max(contour.WIDE * room, np.sqrt(spread * room))
    np.testing.assert_allclose(circles.radius, [own, contour.RADIUS * room], rtol=1e-12)


def test_modes_that_are_one_are_left_out_together():
    """Spans of one length: the circle around a mode whose twin is left out had no room."""
    model = rd.Scene(STRING, tension=100.0, parts=[rd.Support(0.65)]).compile()
    share = expand(model, [("z", 0.3)], [("z", 0.3)], modes=5)[0].expansion
    assert share.modes == 4
    exact = np.repeat((np.arange(1, 4) * np.pi / 0.65) ** 2 * 1000, 2)
    np.testing.assert_allclose(share.square, exact[:4], rtol=1e-12)
    assert share.beyond == pytest.approx(exact[4] ** 0.5, rel=1e-12)


def test_modal_damping_is_that_of_the_frequency_response():
    scene = rd.Scene(ROPE, tension=100.0, damping=rd.ModalDamping(0.02))
    drive, response = [("z", 0.31)], [("z", 0.4)]
    for elements in (16, None):
        model = scene.compile(elements=elements)
        exact = model.frf(FREQUENCY, drive=drive, response=response).value
        value = summed(model, drive, response, resolved=2 * np.pi * 200.0)
        np.testing.assert_allclose(value, exact, rtol=1e-10)
    few = scene.replace(damping=rd.ModalDamping([0.01, 0.02, 0.03])).compile(elements=16)
    share = expand(few, drive, response)[0].expansion
    np.testing.assert_allclose(share.sigma / np.sqrt(share.square), [0.01, 0.02, 0.03])
    assert share.bound[0, 0] > 0
    assert share.beyond == pytest.approx(2 * np.pi * few.modes(4).frequency[3], rel=1e-9)


def test_tip_of_a_wire_is_expanded():
    parts = [rd.BrokenWire(0.6, 0.05, 3e-4, radius=2e-3)]
    model = rd.Scene(ROPE, tension=100.0, parts=parts).compile()
    drive, response = [("z", 0.31)], [("wire", 0)]
    exact = model.frf(FREQUENCY[:3], drive=drive, response=response).value
    value = summed(model, drive, response)[..., :3]
    # 64 modes, the lowest of those left out at 9 kHz: (60/9000)^2 of the rest
    np.testing.assert_allclose(value, exact, rtol=1e-6)


def test_complex_moduli_have_no_meaning_in_time():
    lossy = rd.Scene(ROPE, tension=100.0, damping=rd.LossFactor(0.01)).compile(elements=8)
    wire = rd.BrokenWire(0.6, 0.05, 3e-4, radius=2e-3, damping_ratio=0.01)
    carrying = rd.Scene(ROPE, tension=100.0, parts=[wire]).compile(elements=8)
    for model, name in ((lossy, "loss factor"), (carrying, "damping ratio of a broken wire")):
        with pytest.raises(rd.SceneError, match=f"a meaning in time, got {name}"):
            expand(model, [("z", 0.5)], [("z", 0.5)])


def test_damping_that_couples_modes_is_refused():
    scene = rd.Scene(STRING, tension=100.0, parts=[rd.Dashpot(0.4, 3.0)])
    with pytest.raises(rd.SceneError, match="damping must not couple modes"):
        expand(scene.compile(elements=8), [("z", 0.5)], [("z", 0.5)])


def test_motion_asked_for_again_is_the_same_and_costs_no_modes():
    model = rd.Scene(rd.Rope(1.0, 0.4), tension=100.0).compile(elements=12)
    time, asked = np.linspace(0.0, 0.1, 50), {"drive": ("z", 0.25), "force": rd.Step(1.0)}
    first, again = (model.transient(time, **asked) for _ in range(2))
    assert (first.value == again.value).all()
    other = pickle.loads(pickle.dumps(model)).transient(time, **asked)
    assert (first.value == other.value).all()
    for k in range(2 * KEPT):
        model.transient(time, drive=("z", (1 + k) / 20), force=rd.Step(1.0))
    assert len(model._told) == KEPT
    known = expand(model, [("z", 0.25)], [("z", 0.5)])[0].expansion
    assert expand(model, [("z", 0.25)], [("z", 0.5)])[0].expansion is known
    many = [("z", x) for x in np.linspace(0.1, 0.9, 20_000).tolist()]
    assert expand(model, [("z", 0.25)], many)[0].expansion.a.size > NUMBERS
    assert len(model._told) == KEPT  # what is large is not kept
