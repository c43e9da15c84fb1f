"""A pulsating tension turns a laid rope, at ends that are free to turn and nowhere else."""

import math
import pickle

import numpy as np
import pytest
from scipy.linalg import expm

import ropedyn as rd

EA, C, D, P, LENGTH, PULL = 6e5, 0.1485, 120.0, 1.394e-7, 1.35, 40.0
C_GIVEN_TENSION = C - D**2 / EA
ROPE = rd.Rope(
    LENGTH,
    0.1162,
    torsional_stiffness=C,
    axial_stiffness=EA,
    lay_coupling=D,
    polar_inertia=P,
)
SWIVEL = "clamped", rd.End(alpha="free")
BOTH = rd.End(alpha="free"), rd.End(alpha="free")
TIME = np.linspace(0.0, 0.05, 201)
GAMMA = 2e-5
ELEMENTS = 12


def scene(ends=SWIVEL, frequency=83.0, rope=ROPE, parts=(), gamma=GAMMA, **tension):
    pull = rd.Tension(2830.0, amplitude=PULL, frequency=frequency, phase=0.3, **tension)
    damping = rd.StiffnessDamping(gamma)
    return rd.Scene(rope, tension=pull, ends=ends, parts=parts, damping=damping)


def twisted(ends, frequency=83.0):
    """Return twist of all nodes and torque in the first element, by matrices of lumps and expm."""
    n, size = ELEMENTS, LENGTH / ELEMENTS
    K, M = np.zeros((n + 1, n + 1)), np.full(n + 1, P * size)
    M[[0, -1]] /= 2
    for e in range(n):
        K[e : e + 2, e : e + 2] += C_GIVEN_TENSION / size * np.array([[1, -1], [-1, 1]])
    load = np.zeros(n + 1)
    load[[0, -1]] = D / EA * PULL, -D / EA * PULL
    free = [k for k in range(n + 1) if k > 0 or ends is BOTH]
    K, M, load = K[np.ix_(free, free)], M[free], load[free]
    m, omega = len(free), 2 * math.pi * frequency
    # twist, its rate, cos and sin of the pulsation
    A = np.zeros((2 * m + 2, 2 * m + 2))
    A[:m, m : 2 * m] = np.eye(m)
    A[m : 2 * m, :m] = -K / M[:, None]
    A[m : 2 * m, m : 2 * m] = -GAMMA * K / M[:, None]
    A[m : 2 * m, 2 * m] = load / M
    A[2 * m, 2 * m + 1], A[2 * m + 1, 2 * m] = -omega, omega
    state = np.concatenate([np.zeros(2 * m), [math.cos(0.3), math.sin(0.3)]])
    step, alpha = expm(A * TIME[1]), np.zeros((len(TIME), n + 1))
    rate, pulse = np.zeros_like(alpha), np.zeros(len(TIME))
    for k in range(len(TIME)):
        alpha[k, free], rate[k, free], pulse[k] = state[:m], state[m : 2 * m], state[2 * m]
        state = step @ state
    turn = (alpha + GAMMA * rate)[:, 1] - (alpha + GAMMA * rate)[:, 0]
    return alpha, C_GIVEN_TENSION * turn / size + D / EA * PULL * pulse


@pytest.mark.parametrize("ends", [SWIVEL, BOTH], ids=["one end", "both ends"])
def test_twist_under_a_pulsating_tension_is_that_of_matrices(ends):
    of = scene(ends)
    x = LENGTH / ELEMENTS
    responses = [("alpha", LENGTH), ("alpha", 5 * x), ("M_alpha", x), ("F_x", 0.5 * LENGTH)]
    history = of.compile(elements=ELEMENTS).transient(
        TIME, response=responses, snapshots=TIME[[40, 200]]
    )
    alpha, torque = twisted(ends)
    # both are exact for the same lumps
    for k, node in enumerate((ELEMENTS, 5)):
        np.testing.assert_allclose(history.value[k], alpha[:, node], atol=1e-10 * abs(alpha).max())
    np.testing.assert_allclose(history.value[2], torque, atol=1e-10 * abs(torque).max())
    pull = PULL * np.cos(2 * math.pi * 83.0 * TIME + 0.3)
    np.testing.assert_allclose(history.value[3], pull, atol=1e-12 * PULL)
    at = of.coordinates.index("alpha")
    np.testing.assert_allclose(
        history.snapshot[:, :, at], alpha[[40, 200]], atol=1e-10 * abs(alpha).max()
    )


def test_a_slow_pulsation_turns_the_end_as_a_force_along_the_rope_does():
    slow = scene(frequency=0.5, gamma=0.02)
    time = np.linspace(0.0, 3.0, 301)
    history = slow.compile(elements=8).transient(time, response=("alpha", LENGTH))
    loose = rd.Scene(ROPE, ends=("clamped", rd.End(x="free", alpha="free"))).compile()
    static = loose.static({("x", LENGTH): 1.0}).displacement[-1, -1]
    assert static == pytest.approx(-D * LENGTH / (EA * C - D**2), rel=1e-9)
    late = time > 1.0
    pull = PULL * np.cos(2 * math.pi * 0.5 * time + 0.3)
    # damping lags by gamma omega, a sixteenth
    phase = np.exp(0.3j) / (1 + 0.02j * 2 * math.pi * 0.5)
    right = static * PULL * (phase * np.exp(1j * math.pi * time)).real
    # inertia adds (f/f_1)^2 = 7e-6
    np.testing.assert_allclose(history.value[0, late], right[late], atol=2e-5 * PULL * abs(static))
    assert abs(pull).max() == pytest.approx(PULL, rel=1e-3)


def test_rates_of_twist_are_those_of_the_motion():
    model = scene().compile(elements=ELEMENTS)
    fine = np.linspace(0.0, 0.02, 2001)
    at = {"response": ("alpha", LENGTH)}
    twist = model.transient(fine, **at).value[0]
    speed = model.transient(fine, quantity="velocity", **at).value[0]
    slope = np.gradient(twist, fine, edge_order=2)
    # differences of second order, 1e-3 off where motion begins
    np.testing.assert_allclose(speed[5:-5], slope[5:-5], atol=3e-3 * abs(speed).max())


def test_a_rope_held_at_both_ends_takes_a_torque_and_turns_nowhere():
    of = scene(ends=("clamped", "clamped"))
    history = of.compile(elements=8).transient(TIME, response=[("alpha", 0.5), ("M_alpha", 0.0)])
    pull = PULL * np.cos(2 * math.pi * 83.0 * TIME + 0.3)
    assert not history.value[0].any()
    np.testing.assert_allclose(history.value[1], D / EA * pull, rtol=1e-12)


def test_a_worn_stretch_turns_more():
    worn = rd.LocalChange(0.4, 0.9, torsion=0.5)
    slow = scene(frequency=0.5, gamma=0.02, parts=[worn])
    time = np.linspace(0.0, 3.0, 301)
    history = slow.compile(elements=27).transient(time, response=("alpha", LENGTH))
    given = C_GIVEN_TENSION, 0.5 * C - D**2 / EA
    share = -D / EA * PULL * (0.85 / given[0] + 0.5 / given[1])
    assert abs(history.value[0, 100:]).max() == pytest.approx(abs(share), rel=5e-3)


def test_without_lay_nothing_turns():
    history = (
        scene(rope=ROPE.replace(lay_coupling=None))
        .compile(elements=8)
        .transient(TIME, response=("alpha", LENGTH))
    )
    assert not history.value.any()


def test_forces_and_the_tension_add():
    # a moment on the same twist, x held: what each does alone
    push = {"drive": ("alpha", 0.9), "force": rd.Sine(0.01, 60.0)}
    response = {"response": ("alpha", LENGTH)}
    model = scene().compile(elements=ELEMENTS)
    still = scene().without("pulsating tension").compile(elements=ELEMENTS)
    both = model.transient(TIME, **push, **response, tolerance=1e-7).value
    alone = model.transient(TIME, **response).value
    pushed = still.transient(TIME, **push, **response).value
    np.testing.assert_allclose(both, alone + pushed, atol=1e-6 * abs(both).max())


@pytest.mark.parametrize("begun", [{("alpha", 0.9): 1e-6}, {"alpha": lambda x: 0.1 * x}])
def test_a_kick_turns_once_beside_the_tension(begun):
    """The motion of the tension had it again: 4 % of the twist and 14 % of the torque."""
    asked = {"response": [("alpha", LENGTH), ("M_alpha", 0.5)], "tolerance": 1e-7}
    model = scene().compile(elements=ELEMENTS)
    still = scene().without("pulsating tension").compile(elements=ELEMENTS)
    both = model.transient(TIME, velocity=begun, **asked).value
    alone = (
        model.transient(TIME, **asked).value + still.transient(TIME, velocity=begun, **asked).value
    )
    size = np.abs(both).max(axis=1, keepdims=True)
    np.testing.assert_allclose(both / size, alone / size, rtol=0, atol=1e-14)


def test_mesh_error_is_also_that_of_the_twist():
    """It was 0 where two elements are 27 % off the twist and 55 % off the torque."""
    response = [("alpha", LENGTH), ("M_alpha", 0.5), ("F_x", 0.5)]
    coarse, spans = (
        scene(gamma=1e-5).compile(elements=n).transient(TIME[:50], response=response)
        for n in (8, None)
    )
    assert not spans.mesh_error.any()
    off = np.abs(coarse.value - spans.value)
    again = pickle.loads(pickle.dumps(coarse))
    for history in coarse, again:
        assert (off <= history.mesh_error + spans.error).all()
        assert (history.mesh_error <= off + 2 * spans.error).all()
    assert (off.max(axis=1)[:2] > 0.01 * np.abs(spans.value).max(axis=1)[:2]).all()


REFUSED = {
    "stretching": (lambda: scene(stretching=True), {}, "tension must not be stretching where lay"),
    "lay slope": (
        lambda: scene(rope=ROPE.replace(lay_slope=0.05, bending_stiffness=1.5)),
        {},
        "lay_slope must be None where lay_coupling turns",
    ),
    "x": (scene, {"response": ("x", 0.5)}, "response must not be x where lay_coupling turns"),
    "stop": (
        lambda: scene(parts=[rd.Stop(0.5, 1.0, gap=0.1, coordinate="alpha")]),
        {},
        r"parts\[0\] must be linear on alpha where lay_coupling turns",
    ),
    "ratios of modes": (
        lambda: scene().replace(damping=rd.ModalDamping([0.002] * 40)),
        {},
        "damping ratio must be one number where lay_coupling turns",
    ),
    "ratios of modes in snapshots": (
        lambda: scene().replace(damping=rd.ModalDamping([0.002] * 40)),
        {"response": ("z", 0.5), "snapshots": [0.01]},
        "damping ratio must be one number where lay_coupling turns",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_twist_cannot_be_told_apart_from_is_refused_by_name(name):
    of, asked, words = REFUSED[name]
    with pytest.raises(rd.SceneError, match=words):
        of().compile(elements=8).transient(TIME, **{"response": ("alpha", LENGTH)} | asked)


def test_stretching_is_taken_where_no_end_turns():
    of = scene(ends=("clamped", "clamped"), stretching=True)
    push = {"drive": ("z", 0.3), "force": rd.Sine(1.0, 60.0)}
    history = of.compile(elements=8).transient(TIME[:20], **push, response=("alpha", 0.5))
    assert not history.value.any()


def test_a_steady_state_at_the_frequency_of_the_tension_is_refused():
    model = scene(gamma=1e-3).compile(elements=8)
    asked = {"drive": ("z", 0.3), "amplitude": 1.0, "response": ("alpha", LENGTH)}
    with pytest.raises(rd.SceneError, match="frequency must not be that of the pulsating tension"):
        model.stepped_sine([60.0, 83.0], **asked)


def test_a_sag_that_would_pulsate_with_the_tension_is_refused_by_name():
    rope = rd.Rope(20.0, 1.0, axial_stiffness=6e6)
    tension = rd.Tension(3000.0, amplitude=300.0, frequency=0.05)
    of = rd.Scene(rope, tension=tension, damping=rd.ViscousDamping(1.0), gravity=rd.Gravity())
    model, asked = of.compile(elements=16), {"drive": ("z", 10.0), "response": ("z", 10.0)}
    with pytest.raises(rd.SceneError, match="gravity must be None or without sag"):
        model.transient(TIME, force=rd.Step(1.0), **asked)
    with pytest.raises(rd.SceneError, match="gravity must be None or without sag"):
        model.stepped_sine([0.3], amplitude=1.0, **asked)
    flat = of.without("sag").compile(elements=16)
    assert np.isfinite(flat.transient(TIME, force=rd.Step(1.0), **asked).value).all()


def test_mesh_error_of_torque_without_damping_is_that_of_fronts():
    """Spans ring in steps of the torque for ever: known to 0.1, not to 1e-3, which is enough."""
    model = scene(gamma=0.0).compile(elements=3)
    time = np.linspace(0.0, 0.05, 61)
    asked = {"response": [("alpha", LENGTH), ("M_alpha", LENGTH / 3)]}
    missed = model.transient(time, **asked).mesh_error.max(axis=1)
    alone = model.transient(time, response=("alpha", LENGTH)).mesh_error.max()
    assert np.isfinite(missed).all()
    assert missed[0] == pytest.approx(alone, rel=0.1)


def test_energy_is_refused_where_the_tension_turns_an_end():
    """It said that of the drives alone, while the twist by the tension had more."""
    middle = ("z", LENGTH / 2)
    asked = {"drive": middle, "force": rd.Sine(1.0, 40.0), "response": middle}
    model = scene().compile(elements=4)
    with pytest.raises(rd.SceneError, match="energy is not told where lay_coupling turns the rope"):
        model.transient(TIME[:5], **asked).energy["kinetic"]
    held = scene(ends=("clamped", "clamped")).compile(elements=4)
    assert held.transient(TIME[:5], **asked).energy["kinetic"].any()
