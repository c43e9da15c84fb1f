"""Breaks of forces and ends of runs that fall between the times of the answer."""

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import solve_ivp

import ropedyn as rd

MIDDLE = ("z", 0.5)
MASS, TENSION, PULSATION, FREQUENCY, CUBIC = 0.025, 1000.0, 300.0, 70.0, -2e7
ROPE = rd.Rope(1.0, 0.1)
PULSATING = rd.Tension(TENSION, amplitude=PULSATION, frequency=FREQUENCY)


def beads(tension=PULSATING, *parts):
    """Three equal masses on a string."""
    scene = rd.Scene(ROPE, tension=tension, parts=parts)
    return scene.compile(elements=4, element="rigid")


def hardening(t, u, v):
    return CUBIC * u**3


def pulsating_beads(time, broken):
    """Return the acceleration of the middle under a sine, and a step at a time; DOP853 to 1e-11."""
    K = 4 * (2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))

    def slope(t, y, step):
        force = -(TENSION + PULSATION * np.cos(2 * np.pi * FREQUENCY * t)) * (K @ y[:3])
        force[1] += 20 * np.sin(2 * np.pi * 30 * t) + step + hardening(t, y[1], 0)
        return np.concatenate([y[3:], force / MASS])

    y, found = np.zeros(6), np.zeros(len(time))
    for begin, end, step in ((0, broken, 0), (broken, time[-1], 20)):
        own = (time >= begin) & (time <= end)
        at = np.unique(np.append(time[own], end))
        asked = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "args": (step,)}
        passed = solve_ivp(slope, (begin, end), y, t_eval=at, **asked)
        states = passed.y[:, np.isin(at, time[own])].T
        found[own] = [slope(t, u, step)[4] for t, u in zip(time[own], states)]
        y = passed.y[:, -1]
    return found


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
def test_accelerations_at_the_end_of_what_breaks_leave_of_steps(tolerance):
    """The last step alone was of first order, in every run that was compared: 3 times its claim."""
    time = np.linspace(0.0, 0.05, 101)
    broken = float(time[-1] - 20.04 * time[1])
    exact = pulsating_beads(time, broken)
    history = beads(PULSATING, rd.NodeForce(0.5, hardening)).transient(
        time,
        drive=[MIDDLE, MIDDLE],
        force=[rd.Sine(20.0, 30.0), rd.Step(20.0, time=broken)],
        response=MIDDLE,
        quantity="acceleration",
        tolerance=tolerance,
    )
    assert history.cost.method == "steps"
    error = np.abs(history.value[0] - exact)
    assert (error <= history.error[0]).all()
    assert error.max() < tolerance / 4 * np.abs(exact).max()  # measured: 7e-5 and 3e-7


@pytest.mark.parametrize(
    "model",
    [
        beads(rd.Tension(TENSION, amplitude=100.0, frequency=FREQUENCY)),
        beads(TENSION, rd.Dashpot(0.5, 1.0, exponent=2.0)),
    ],
    ids=["pulsating", "quadratic"],
)
def test_energy_just_before_a_blow_has_nothing_of_it(model):
    """Straight lines between ends of steps had 60 times what moves, 2 us before."""
    time = np.linspace(0.0, 0.02, 201)
    before = time[50] + 2e-6 - 0.1 * time[1]
    forces = [rd.Step(5.0, time=float(before)), rd.Impulse(0.1, time=float(time[100] + 2e-6))]
    asked = {"drive": [MIDDLE, MIDDLE], "force": forces}
    history = model.transient(time, response=MIDDLE, **asked)
    all_masses = [("z", at) for at in (0.25, 0.5, 0.75)]
    speed = model.transient(time, response=all_masses, quantity="velocity", **asked).value
    kinetic = MASS * (speed**2).sum(axis=0) / 2
    off = np.abs(history.energy["kinetic"] - kinetic)
    assert off.max() < 1e-4 * kinetic.max()  # measured: 4e-6
    assert history.energy["input"][101] > 10 * history.energy["input"][100]


@pytest.mark.parametrize("tension", [PULSATING, TENSION], ids=["pulsating", "mean"])
@pytest.mark.parametrize("times", [65, 513])
def test_what_ctrl_c_leaves_ends_where_all_of_it_is_known(tension, times):
    """The last value and snapshot at the end of a block lacked what the laws add: a quarter."""
    model = beads(tension, *([] if tension is PULSATING else [rd.NodeForce(0.5, hardening)]))
    time = np.linspace(0.0, 0.05, times)
    asked = {"drive": MIDDLE, "force": rd.Sine(20.0, 30.0), "response": MIDDLE}

    def interrupt(part):
        raise KeyboardInterrupt

    whole = model.transient(time, snapshots=time[1:], **asked)
    part = model.transient(time, snapshots=time[1:], progress=interrupt, partial=True, **asked)
    known, seen = len(part.time), len(part.snapshot_time)
    assert part.stopped == "interrupted"
    assert known > 1
    for one, other in (
        (part.value, whole.value[:, :known]),
        (part.snapshot, whole.snapshot[:seen]),
    ):
        assert np.abs(one - other).max() < 1e-4 * np.abs(whole.value).max()


def test_a_law_that_fails_leaves_what_was_known_before():
    def failing(t, u, v):
        return np.where(t > 0.0251, np.nan, hardening(t, u, v))

    time = np.linspace(0.0, 0.05, 65)
    asked = {"drive": MIDDLE, "force": rd.Sine(20.0, 30.0), "response": MIDDLE}
    whole = beads(TENSION, rd.NodeForce(0.5, hardening)).transient(time, **asked)
    part = beads(TENSION, rd.NodeForce(0.5, failing)).transient(time, partial=True, **asked)
    known = len(part.time)
    assert 20 < known < 40
    off = np.abs(part.value - whole.value[:, :known]).max()
    assert off < 1e-5 * np.abs(whole.value).max()


@pytest.mark.parametrize("part", [rd.Stop(0.5, 1e4, gap=1e-3), rd.Dashpot(0.5, 0.1, exponent=0.0)])
def test_a_blow_at_the_first_time_is_put_in_by_every_method(part):
    time = np.linspace(0.0, 0.01, 101)
    asked = {"drive": MIDDLE, "force": rd.Impulse(0.02, time=0.0), "response": MIDDLE}
    for model in (beads(TENSION, part), beads(TENSION)):
        energy = model.transient(time, **asked).energy
        assert energy["input"] == pytest.approx(0.02**2 / (2 * MASS), rel=1e-12)
        assert energy["kinetic"][0] == pytest.approx(0.02**2 / (2 * MASS), rel=1e-12)


@pytest.mark.parametrize("quantity", ["displacement", "acceleration"])
@pytest.mark.parametrize(
    "parts", [(), (rd.Dashpot(0.25, 1.0, exponent=0.0),), (rd.NodeForce(0.5, hardening),)], ids=len
)
def test_a_break_that_is_nearly_at_a_time_leaves_no_time_unseen(parts, quantity):
    """A time between two blocks of steps, by rounding, had no part of laws or pulsation: half."""
    tension = TENSION if parts and isinstance(parts[0], rd.NodeForce) else PULSATING
    time = 0.3 + np.linspace(0.0, 0.1, 301)
    drives, sine = [MIDDLE, ("z", 0.25)], rd.Sine(20.0, 30.0)

    def moved(at):
        force = [sine, rd.Step(1e-9, time=at)]
        asked = {"response": MIDDLE, "quantity": quantity, "tolerance": 1e-2}
        return beads(tension, *parts).transient(time, drive=drives, force=force, **asked).value

    off = float(time[215] + 0.4 * (time[1] - time[0]))
    for at in (round(float(time[215]), 10), round(float(time[230]), 12)):
        apart = np.abs(moved(at) - moved(off)).max()
        assert apart < 2e-2 * np.abs(moved(off)).max()


def test_a_blow_at_the_last_time_is_refused_where_laws_follow_it():
    time = np.linspace(0.0, 0.03, 151)
    asked = {"drive": MIDDLE, "force": rd.Impulse(0.05, time=float(time[-1])), "response": MIDDLE}
    for model in (beads(), beads(TENSION, rd.Stop(0.25, 1e4, gap=1.0))):
        with pytest.raises(rd.SceneError, match=r"force\[0\] must not be a blow at the last time"):
            model.transient(time, **asked)
    asked = {"drive": [MIDDLE, MIDDLE], "force": [rd.Sine(1.0, 30.0), asked["force"]]}
    linear = beads(TENSION, rd.Dashpot(0.25, 1.0))
    masses = [("z", at) for at in (0.25, 0.5, 0.75)]
    speed = linear.transient(time, response=masses, quantity="velocity", **asked).value[:, -1]
    energy = linear.transient(time, response=MIDDLE, **asked).energy
    assert energy["kinetic"][-1] == pytest.approx(MASS * (speed**2).sum() / 2, rel=1e-3)  # 3e-5


def test_energy_of_a_blow_at_a_first_time_that_is_not_0():
    time = np.linspace(0.013, 0.043, 151)
    asked = {"drive": ("z", 0.75), "force": rd.Impulse(0.06, time=0.013), "response": MIDDLE}
    start = {("z", 0.25): -0.058}
    energy = beads(TENSION, rd.Stop(0.75, 2684.0)).transient(time, velocity=start, **asked).energy
    assert energy["input"][0] == pytest.approx((0.06**2 + 0.058**2) / (2 * MASS), rel=1e-9)


@pytest.mark.parametrize("when", [5e-324, 1e-310, 1e-30])
@pytest.mark.parametrize("stretching", [False, True])
def test_a_break_just_after_the_first_time_is_one_at_it(when, stretching):
    """Steps before it had no length: "invalid value encountered in divide"."""
    cubic = rd.NodeForce(0.5, lambda t, u, v: -1e3 * u**3)
    tension = rd.Tension(1000.0, stretching=stretching)
    scene = rd.Scene(rd.Rope(1.0, 0.2, axial_stiffness=1e5), tension=tension, parts=[cubic])
    model, time = scene.compile(elements=4), np.linspace(0.0, 0.01, 51)
    late, soon = (
        model.transient(time, drive=("z", 0.5), force=rd.Step(5.0, time=at)).value
        for at in (when, 0.0)
    )
    assert late == pytest.approx(soon, abs=1e-12 * np.abs(soon).max())


def test_dampers_couple_modes_that_turn_within_a_step():
    """A damped resonator on a stiff point: 1.7e-5 of a row that is hardly moved, 5e-8 was said."""
    n, density, mass, stiffness = 4, 0.11, 0.0065, 5.6e7
    tuned, frequency, phase = 18257.5, 59.878, 1.5
    parts = [
        rd.PointMass(0.5, mass),
        rd.Spring(0.5, stiffness),
        rd.Resonator(0.5, mass / 10, tuned, damping_ratio=0.03777),
        rd.Stop(0.25, 1e3, gap=1.0),
        rd.NodeForce(0.25, lambda t, u, v: 0 * u),
    ]
    scene = rd.Scene(rd.Rope(1.0, density), tension=326.17, parts=parts)
    time = np.linspace(0.0, 0.3674, 101)
    found = scene.compile(elements=n, element="rigid").transient(
        time,
        drive=("z", 0.5),
        force=rd.Sine(1.0, frequency, phase=phase),
        response=[("z", 0.25), ("z", 0.5), ("z", 0.75)],
        quantity="velocity",
        tolerance=1e-4,
    )
    assert found.cost.method == "steps"
    M = np.diag([density / n] * 3 + [mass / 10])
    M[1, 1] += mass
    spring = mass / 10 * (2 * np.pi * tuned) ** 2
    between = np.array([0, 1, 0, -1.0])
    K = np.zeros((4, 4))
    K[:3, :3] = 326.17 * n * (2 * np.eye(3) - np.eye(3, k=1) - np.eye(3, k=-1))
    K[1, 1] += stiffness
    K += spring * np.outer(between, between)
    C = 2 * 0.03777 * np.sqrt(spring * mass / 10) * np.outer(between, between)
    A = np.block([[np.zeros((4, 4)), np.eye(4)], [-la.solve(M, K), -la.solve(M, C)]])
    # of modes, as powers of the exponential of a step would round
    rate, right = la.eig(A)
    push = la.solve(right, np.concatenate([np.zeros(4), la.solve(M, [0, 1, 0, 0])]))
    omega = 2j * np.pi * frequency
    turn = np.exp(omega * time + 1j * phase)
    grown = np.exp(np.multiply.outer(rate, time)) * np.exp(1j * phase)
    down = np.exp(np.multiply.outer(rate, time)) * np.exp(-1j * phase)
    ahead = (turn - grown) / (omega - rate)[:, None]
    back = (turn.conj() - down) / (-omega - rate)[:, None]
    exact = (right[4:7] @ (push[:, None] * (ahead - back) / 2j)).real
    off = np.abs(found.value - exact)
    assert (off <= found.error + 1e-10 * np.abs(exact).max(axis=1, keepdims=True)).all()
    assert off[2].max() < 1e-6 * np.abs(exact[2]).max()


@pytest.mark.parametrize("ends", [("free", "free"), ("pinned", "free")])
def test_rigid_motion_beside_modes_that_turn_within_a_step_has_an_error(ends):
    """What turns not at all was divided by its own frequency: an error that is no number."""
    mass = [rd.PointMass(0.5, 0.1), rd.Resonator(0.5, 0.02, 5000.0, damping_ratio=0.05)]
    laws = [rd.Stop(0.25, 1e3, gap=1.0), rd.NodeForce(0.25, lambda t, u, v: -10.0 * u)]
    rope = rd.Rope(1.0, 0.3, bending_stiffness=50.0)
    found, linear = (
        rd.Scene(rope, ends=ends, parts=[*mass, *others])
        .compile(elements=8, element="rigid")
        .transient(
            np.linspace(0.0, 0.1, 51),
            drive=MIDDLE,
            force=rd.Sine(1.0, 20.0),
            response=MIDDLE,
        )
        for others in (laws, [rd.Spring(0.25, 10.0)])
    )
    assert found.cost.method == "steps"
    assert (np.abs(found.value - linear.value) <= found.error + linear.error).all()
    assert found.error.max() < 1e-4 * np.abs(found.value).max()  # measured: 3e-7
