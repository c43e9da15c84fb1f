"""Forces convolved with modes: against closed forms of many digits."""

import math

import mpmath as mp
import numpy as np
import pytest
from exact_convolution import by_gauss, forced, free
from hypothesis import given, settings
from hypothesis import strategies as st

import ropedyn as rd
from ropedyn.motion.modal.convolution import convolve, release
from ropedyn.motion.modal.expansion import Expansion
from ropedyn.motion.modal.exponentials import _circle, _close, _grids, is_uniform
from ropedyn.motion.modal.recurrence import changes
from ropedyn.motion.modal.truncation import _variation, left_out
from ropedyn.scene.force import Chirp, Impulse, Samples, Sine, Step, Sum, peak

# sigma [1/s], square [rad^2/s^2]
KINDS = {
    "undamped": (0.0, 400.0**2),
    "light": (2.0, 400.0**2),
    "critical": (50.0, 2500.0),
    "nearly critical": (50.0, 2500.0001),
    "overdamped": (80.0, 2500.0),
    "stiff": (1e6, 1.0),
    "rigid": (0.0, 0.0),
    "rigid with drag": (3.0, 0.0),
    "rigid with little drag": (1e-9, 0.0),
    "growing": (0.5, -100.0),
    "slow": (1e-3, 1e-4),
    "fast": (10.0, 1e10),
}
EPS = 2.0**-52
ORDERS = (0, 1, 2)


def expansion(sigma, square, a=1.0, b=0.0, rest=0.0):
    """One drive, one response, modes side by side."""
    sigma, square = np.atleast_1d(sigma).astype(float), np.atleast_1d(square).astype(float)
    a, b = (np.broadcast_to(each, (1, 1, len(sigma))).astype(float) for each in (a, b))
    return Expansion(sigma, square, a, b, np.full((1, 1), rest), np.zeros((1, 1)))


MODE = {kind: expansion(*rates) for kind, rates in KINDS.items()}
STRING = 2 * math.pi * 40.0 * np.arange(1, 13)
"""Of a string of 40 Hz [rad/s]."""
MANY = expansion(
    np.append(0.01 * STRING, [0, 50.0, 80.0]),
    np.append(STRING**2, [0, 2500.0, 900.0]),
    a=np.cos(np.arange(15.0)),
    b=1e-3 * np.sin(np.arange(15.0)),
    rest=1e-6,
)._replace(late=np.full((1, 1), 7e-4), lag=1 / 30)
GRID = np.arange(600) / 1024
SMALLEST = 1e-290
"""Of a force whose motion has all its digits: doubles below 2e-308 lose them."""
FORCES = {
    "sine": Sine(2.0, 70.0, phase=0.3),
    "resonant sine": Sine(2.0, 40.0),
    "chirp": Chirp(2.0, 20.0, 130.0, 0.4),
    "falling chirp": Chirp(2.0, 130.0, 20.0, 0.4),
    "step": Step(3.0, time=0.1),
    "blow": Impulse(0.1, time=0.05),
    "half sine": Impulse(0.1, time=0.05, duration=3e-3),
    "samples": Samples(GRID, np.sin(100 * GRID) + GRID),
}


def followed(sigma, square, state, force):
    """q, q' and q'' of a state under a force."""
    q, v = state
    return [float(each) for each in (q, v, force - 2 * mp.mpf(sigma) * v - mp.mpf(square) * q)]


def assert_follows(kind, force, time, exact, w=0.0):
    """Compare all orders; exact gives q, q', q'' at each time."""
    _, square = KINDS[kind]
    span = time[-1] - time[0]
    # the largest value is that of all times, not only of those where exact ones are known; and
    # where forces that nearly balance accelerate, of what they balance
    fine = np.union1d(time, np.linspace(time[0], time[-1], 2000))
    size = 0.0
    for order in ORDERS:
        size = max(size / span, np.abs(convolve(MODE[kind], 0, force, fine, order)).max())
        if order == 2:
            size = max(size, np.abs(force.value(fine)).max())
        value = convolve(MODE[kind], 0, force, time, order)[0]
        error = np.abs(value - [each[order] for each in exact]).max()
        allowed = 1e-13 + 2 * EPS * span * (w + math.sqrt(abs(square)))  # phases round
        assert error <= allowed * size, (order, error / size)


def some_times(begin, span):
    """From much shorter than the span on."""
    return begin + span * np.concatenate([[0, 1e-4, 1e-2, 0.1, 0.3], np.linspace(0.5, 1, 3)])


def frequencies(kind, span):
    """Of sines: below, at, near and above the mode; so slow that they are straight lines."""
    sigma, square = KINDS[kind]
    own = math.sqrt(max(square - sigma**2, 0)) / 2 / math.pi or 5.0
    return [1e-7, own, own + 1e-6 / span, own + 0.05 / span, own + 0.3 / span, 70.0]


@pytest.mark.parametrize("span", [2.0, 1e-4])
@pytest.mark.parametrize("kind", KINDS)
def test_sine_moves_every_kind_of_mode_as_its_closed_form(kind, span):
    sigma, square = KINDS[kind]
    for frequency, phase in zip(frequencies(kind, span), [0.0, 0.3, 0.0, 1.0, 2.0, 0.5]):
        time, w = some_times(0.25, span), 2 * math.pi * frequency
        with mp.workdps(30):  # as many turns take digits
            start = (phase + 2 * mp.pi * mp.mpf(frequency) / 4) % (2 * mp.pi)
        cosine, sine = mp.sin(start), mp.cos(start)
        exact = []
        for t in time:
            since = mp.mpf(float(t - 0.25))
            f = cosine * mp.cos(w * since) + sine * mp.sin(w * since)
            exact.append(followed(sigma, square, forced(sigma, square, w, cosine, sine, since), f))
        assert_follows(kind, Sine(1.0, frequency, phase=phase), time, exact, w)


@pytest.mark.parametrize("kind", KINDS)
def test_step_moves_every_kind_of_mode_as_its_closed_form(kind):
    sigma, square = KINDS[kind]
    time = some_times(0.5, 1.5)
    exact = [[0.0] * 3] * 3  # acts from 0.6 on
    for t in time[3:]:
        since = mp.mpf(float(t - 0.6))
        exact.append(followed(sigma, square, forced(sigma, square, 0, 3, 0, since), 3))
    assert_follows(kind, Step(3.0, time=0.6), time, exact)


@pytest.mark.parametrize("duration", [0.0, 1e-3, 0.45])
@pytest.mark.parametrize("kind", KINDS)
def test_blow_moves_every_kind_of_mode_as_its_closed_form(kind, duration):
    sigma, square = KINDS[kind]
    time = np.array([0.5, 0.6, 0.6003, 0.8, 1.0, 1.1, 1.6])
    blow = Impulse(2.0, time=0.6, duration=duration)
    exact = []
    w = math.pi / duration if duration else 0.0
    for t in time:
        since = mp.mpf(float(t - 0.6))
        if since < 0:
            exact.append([0.0] * 3)
        elif duration and t < 0.6 + duration:
            state = forced(sigma, square, w, 0, blow.amplitude, since)
            exact.append(followed(sigma, square, state, blow.amplitude * mp.sin(w * since)))
        else:
            state = (0, 2)
            if duration:
                state = forced(sigma, square, w, 0, blow.amplitude, mp.mpf(0.6 + duration - 0.6))
            since = mp.mpf(float(t - (0.6 + duration)))
            exact.append(followed(sigma, square, free(sigma, square, *state, since), 0))
    assert_follows(kind, blow, time, exact, w if duration > 0.1 else 0)


@pytest.mark.parametrize("sweep", [(0, 40), (60, 20), (63.6, 63.7), (60, 60 + 1e-7), (60, 60)])
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "stiff"])
def test_chirp_moves_every_kind_of_mode_as_its_integral(kind, sweep):
    sigma, square = KINDS[kind]
    begin, span = 0.1, 0.05 if kind != "fast" else 1e-3
    force = Chirp(2.0, *sweep, 0.5, phase=0.4)
    rate = 2 * mp.pi * (mp.mpf(force.stop) - force.start) / force.duration
    start = 2 * mp.pi * mp.mpf(force.start)

    def value(t):
        absolute = t + mp.mpf(begin)
        return 2 * mp.sin(mp.mpf(0.4) + (start + rate * absolute / 2) * absolute)

    time = begin + span * np.array([0, 1.0])
    exact = []
    for t in time:
        since = mp.mpf(float(t)) - mp.mpf(begin)
        state = by_gauss(sigma, square, value, since, 5 if kind == "fast" else 2)
        exact.append(followed(sigma, square, state, value(since)))
    assert_follows(kind, force, time, exact, 400.0)


def test_chirp_passes_resonance_and_leaves_free_vibration():
    # many cycles: against the same chirp by straight lines, h^2/12 f'' from it
    modes = expansion([0.0, 4.0], [400.0**2, 300.0**2], a=[1.0, 2.0], b=[0.0, 1e-3])
    time = np.arange(0.0, 1.5, 2e-6)
    for force in (Chirp(1.0, 20.0, 120.0, 1.0), Chirp(1.0, 120.0, 20.0, 1.0)):
        some = slice(None, None, 5000)
        value = convolve(modes, 0, force, time[some], 0)[0]
        sampled = convolve(modes, 0, Samples(time, force.value(time)), time, 0)[0, some]
        nearness = (2 * math.pi * 120 * 2e-6) ** 2 / 8
        # the last sample before it ends is joined to 0 by a line
        jump = 2e-6 * np.abs(force.value(np.array([1.0 - 2e-6]))) / 400
        assert np.abs(value - sampled).max() <= 3 * nearness * np.abs(value).max() + jump


@pytest.mark.parametrize("kind", KINDS)
def test_ramp_by_samples_is_the_integral_of_a_step(kind):
    _, square = KINDS[kind]
    for grid in (np.arange(0, 201) / 128, np.cumsum(np.random.default_rng(5).random(201)) / 100):
        time = grid - grid[0]
        ramp = convolve(MODE[kind], 0, Samples(time, 3 * time), time, 1)[0]
        step = convolve(MODE[kind], 0, Step(3.0), time, 0)[0]
        allowed = 1e-13 + 4 * EPS * time[-1] * math.sqrt(abs(square))  # phases round
        assert np.abs(ramp - step).max() <= allowed * np.abs(step).max()


@pytest.mark.parametrize("kind", KINDS)
def test_samples_move_every_kind_of_mode_as_lines_one_by_one(kind):
    # a line from f to f + d over h is f cos(0 t) and the slope as a sine without frequency
    sigma, square = KINDS[kind]
    rng = np.random.default_rng(3)
    time, sample = np.array([0.5, 0.51, 0.53, 0.9, 1.4]), rng.normal(size=5)
    slope = np.diff(sample) / np.diff(time)
    w = mp.mpf(10) ** -25  # a sine so slow is a line
    exact, state = [], (mp.mpf(0), mp.mpf(0))
    exact.append(followed(sigma, square, state, sample[0]))
    for k in range(4):
        h = mp.mpf(float(time[k + 1] - time[k]))
        own = free(sigma, square, *state, h)
        driven = forced(sigma, square, w, sample[k], slope[k] / w, h)
        state = own[0] + driven[0], own[1] + driven[1]
        exact.append(followed(sigma, square, state, sample[k + 1]))
    assert_follows(kind, Samples(time, sample), time, exact)


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("name", FORCES)
def test_motion_does_not_depend_on_the_times_asked_for(name, order):
    force = FORCES[name]
    value = convolve(MANY, 0, force, GRID, order)
    some = np.unique(np.append(np.random.default_rng(1).integers(0, len(GRID), 150), [0, 599]))
    assert is_uniform(GRID) and not is_uniform(GRID[some])
    again = convolve(MANY, 0, force, GRID[some], order)
    assert np.abs(again - value[:, some]).max() <= 1e-12 * np.abs(value).max()


def test_times_of_grids_side_by_side_are_one_grid_each():
    h = 2.0**-9
    stages = (np.arange(400)[:, None] + [0.06, 0.28, 0.58, 0.86, 1.0]).ravel() * h
    time = np.concatenate([[0.0], stages, stages[-1] + np.array([0.1, 0.3, 0.35]) * h])
    parts = list(_grids(time))
    assert len(parts) == 6
    assert sorted(np.concatenate([np.arange(len(time))[one] for one in parts])) == list(
        range(len(time))
    )
    for order in ORDERS:
        value = convolve(MANY, 0, FORCES["sine"], time, order)
        some = np.append(0, np.random.default_rng(2).choice(len(time), 300, replace=False))
        some.sort()
        again = convolve(MANY, 0, FORCES["sine"], time[np.unique(some)], order)
        apart = np.abs(again - value[:, np.unique(some)]).max()
        assert apart <= 1e-12 * np.abs(value).max()


@pytest.mark.parametrize("name", [name for name in FORCES if name != "blow"])
def test_orders_are_derivatives(name):
    # Simpson's rule over each half of a grid: h^4/2880 of the fifth derivative of 500 Hz
    force, h = FORCES[name], 2.0**-18
    time = 0.2 + h * np.arange(2001)
    for order in (1, 2):
        low, high = (convolve(MANY, 0, force, time, k)[0] for k in (order - 1, order))
        if name == "samples":
            kink = np.searchsorted(time, GRID)
            low, high = low[: kink[kink > 0].min()], high[: kink[kink > 0].min()]
            low, high = low[: len(low) // 2 * 2 - 1], high[: len(high) // 2 * 2 - 1]
        area = h / 3 * (high[:-2:2] + 4 * high[1:-1:2] + high[2::2])
        assert np.abs(np.diff(low[::2]) - area).max() <= 1e-9 * np.abs(high).max() * h + (
            8 * EPS * np.abs(low).max()
        )


def test_what_relaxes_does_so_at_its_own_rate():
    modes = expansion([], [], rest=0.25)._replace(late=np.full((1, 1), 2.0), lag=1 / 30)
    value = convolve(modes, 0, Step(3.0), GRID, 0)[0]
    assert value == pytest.approx(3 * (0.25 - 2 * np.expm1(-30 * GRID)), rel=1e-13)
    speed = convolve(modes, 0, Step(3.0), GRID, 1)[0]
    assert speed == pytest.approx(180 * np.exp(-30 * GRID), rel=1e-13)


def test_what_follows_at_once_is_the_force_itself():
    modes = expansion([], [], rest=2.0)
    for force in (FORCES["sine"], FORCES["chirp"], FORCES["step"], FORCES["samples"]):
        value = convolve(modes, 0, force, GRID, 0)[0]
        assert value == pytest.approx(2 * force.value(GRID), rel=1e-13, abs=1e-12)
    slope = convolve(modes, 0, Sine(2.0, 70.0), GRID, 1)[0]
    w = 2 * math.pi * 70
    assert slope == pytest.approx(4 * w * np.cos(w * GRID), abs=1e-9)


@pytest.mark.parametrize("order", ORDERS)
def test_forces_add(order):
    both = Sum((FORCES["sine"], FORCES["half sine"]))
    parts = [convolve(MANY, 0, one, GRID, order) for one in both.forces]
    assert np.array_equal(convolve(MANY, 0, both, GRID, order), parts[0] + parts[1])


@settings(deadline=None, max_examples=25)
@given(
    st.floats(-1e3, 1e3).filter(lambda force: not 0 < abs(force) < SMALLEST),
    st.floats(0.1, 400.0),
    st.floats(-4, 4),
)
def test_motion_is_linear_in_the_force(factor, frequency, phase):
    time = GRID[:200]
    one = convolve(MANY, 0, Sine(1.0, frequency, phase=phase), time, 0)
    assert convolve(MANY, 0, Sine(factor, frequency, phase=phase), time, 0) == pytest.approx(
        factor * one, rel=1e-12, abs=1e-12 * abs(factor) * np.abs(one).max()
    )
    # sin(angle + phase) from its two quarters
    parts = [convolve(MANY, 0, Sine(1.0, frequency, phase=p), time, 0) for p in (0, math.pi / 2)]
    again = math.cos(phase) * parts[0] + math.sin(phase) * parts[1]
    assert one == pytest.approx(again, abs=1e-12 * max(np.abs(part).max() for part in parts))


@pytest.mark.parametrize(
    ("force", "largest"),
    [
        (Sine(5.0, 8.0), 5.0),
        (Sine(5.0, 1e-9), 5e-9 * math.pi),  # twice what it reaches
        (Sum((Sine(5.0, 8.0), Step(2.0))), 7.0),
        (Impulse(math.pi / 500, time=0.1, duration=2e-3), 4.93480220054),
        (Samples(np.array([0.0, 0.1, 0.25]), np.array([0.0, 3.0, 0.0])), 3.0),
    ],
)
def test_peak_is_that_between_times_too(force, largest):
    """Of a sine at the times that it is zero it was nothing: what rounds it had no size."""
    time = np.array([0.0, 0.125, 0.25]) if not isinstance(force, Samples) else force.time
    assert peak(force, time) == pytest.approx(largest, rel=1e-12)


@pytest.mark.parametrize("name", ["step", "blow", "half sine"])
def test_later_force_moves_later(name):
    force, later = FORCES[name], 0.25
    time = GRID[:300]
    shifted = type(force)(*[vars(force)["amplitude" if name == "step" else "impulse"]], time=later)
    if name == "half sine":
        shifted = Impulse(0.1, time=later, duration=force.duration)
    value = convolve(MANY, 0, force, force.time + time, 0)
    again = convolve(MANY, 0, shifted, later + time, 0)
    assert np.abs(value - again).max() <= 1e-12 * np.abs(value).max()


def test_nothing_is_felt_before_the_first_time():
    time = 0.5 + GRID
    for force in (Impulse(1.0, time=0.4), Impulse(1.0, time=0.4, duration=0.05)):
        assert not convolve(MANY, 0, force, time, 0).any()
    assert not convolve(MANY, 0, Chirp(1.0, 10.0, 20.0, 0.4), time, 0).any()
    early, now = (convolve(MANY, 0, Step(1.0, time=t), time, 0) for t in (0.0, 0.5))
    assert np.array_equal(early, now)
    assert not convolve(MANY, 0, Step(1.0, time=2.0), time, 0).any()


def test_step_at_the_last_time_has_just_begun():
    value = convolve(MANY, 0, Step(1.0, time=GRID[-1]), GRID, 0)[0]
    assert not value[:-1].any()
    assert value[-1] == pytest.approx(1e-6, abs=1e-15)


def test_letting_go_is_the_rest_less_a_step():
    held = MANY._replace(square=np.where(MANY.square == 0, 1e4, MANY.square))
    static = (held.a[0, 0] / held.square).sum() + held.late[0, 0] + held.rest[0, 0]
    for order, still in ((0, static), (1, 0), (2, 0)):
        value = release(held, 0, 7.0, GRID, order)
        expected = 7 * still - convolve(held, 0, Step(7.0), GRID, order)
        assert np.abs(value - expected).max() <= 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("modes", [MODE["rigid"], MODE["growing"]])
def test_what_has_no_rest_is_not_let_go(modes):
    with pytest.raises(rd.SceneError, match="no rest"):
        release(modes, 0, 1.0, GRID, 0)


def test_rigid_motion_that_nothing_sees_may_be_let_go():
    modes = expansion([0.0, 1.0], [0.0, 400.0], a=[0.0, 1.0])
    assert release(modes, 0, 2.0, GRID, 0)[0, 0] == pytest.approx(2 / 400, rel=1e-14)


@pytest.mark.parametrize(
    "force", [Sine(1.0, 3.0), Step(1.0), Samples(np.array([0.0, 200.0]), np.ones(2))]
)
def test_growth_beyond_numbers_is_refused_with_its_time(force):
    time = np.linspace(0.0, 200.0, 400)
    with pytest.raises(rd.SolveError, match=r"grows beyond 1e\+300 until t = 7\d"):
        convolve(MODE["growing"], 0, force, time, 0)
    value = convolve(MODE["growing"], 0, force, time[time < 60], 0)
    assert np.isfinite(value).all()


@pytest.mark.parametrize("kind", KINDS)
def test_forces_beyond_measure_are_answered_or_refused(kind):
    for force in (
        Sine(1.0, 0.0, phase=1.0),
        Sine(1e200, 5.0),
        Sine(1.0, 1e150),
        Chirp(1.0, 0.0, 0.0, 1.0),
        Chirp(1.0, 0.0, 1e12, 1.0),
        Chirp(1.0, 1.0, 2.0, 1e-300),
        Impulse(1.0, duration=1e-300),
        Impulse(1.0, duration=1e12),
    ):
        try:
            value = convolve(MODE[kind], 0, force, GRID[:40], 0)
        except rd.SolveError:
            continue
        assert np.isfinite(value).all()


@pytest.mark.parametrize("turn", [1e-9, 1e-3, 0.4, 1.6, 30.0, 1e4])
@pytest.mark.parametrize("ratio", [0.0, 1e-3, 0.7, 1 - 1e-9, 1.0, 1 + 1e-13, 1.5, 1e3, 1e6])
def test_change_over_a_step_has_all_its_digits(turn, ratio):
    h = 0.01
    sigma, square = ratio * turn / h, (turn / h) ** 2
    _, S, P, R, *_ = changes(np.array([sigma]), np.array([square]), np.array([h]))[0, :, 0]
    with mp.workdps(80):
        split = mp.sqrt(mp.mpf(sigma) ** 2 - mp.mpf(square)) or mp.mpf(10) ** -30
        near, far = -sigma + split, -sigma - split
        exact = [
            mp.re((one(near) - one(far)) / (near - far))
            for one in (
                lambda s: mp.exp(s * h),
                lambda s: mp.expm1(s * h) / s,
                lambda s: (mp.expm1(s * h) - s * h) / s**2 / h,
            )
        ]
        size = float(abs(far)) * h
    # S is at most h and 1/far, its integrals so much times h or what the spring lets
    most = min(h, h / size) * np.array([1.0, min(h, h / turn), min(h, h / turn) / 2])
    turns = 1 + turn * (ratio < 1)  # phases have their rounding
    off = np.abs([float(one - other) for one, other in zip((S, P, R), exact)])
    assert (off <= 8 * EPS * turns * np.maximum(most, np.abs([float(one) for one in exact]))).all()


def test_recurrence_keeps_its_phase_and_amplitude_over_many_steps():
    # free vibration after one triangle: q = Re c e^(s t); angles per step below and above 1.5, up
    # to which series give the step
    steps = 100_000
    h = 2.0**-13
    time = np.arange(steps + 1) * h
    sample = np.zeros(steps + 1)
    sample[0] = 1
    for turn in (1e-3, 0.1, 2.5):
        sigma, square = 1e-6 * turn / h, (turn / h) ** 2
        value = convolve(expansion(sigma, square), 0, Samples(time, sample), time, 0)[0]
        for n in (steps // 2, steps):
            with mp.workdps(40):
                s = -mp.mpf(sigma) + mp.j * mp.sqrt(mp.mpf(square) - mp.mpf(sigma) ** 2)
                force = 1 / s - (1 - mp.exp(-s * h)) / (s**2 * h)
                c = force / (s - mp.conj(s)) * 2
                exact = float(mp.re(c * mp.exp(s * h * n)))
            # one rounding of the rate's square turns the phase by a quarter of it
            assert abs(value[n] - exact) <= (1e-12 + n * turn * EPS) * float(abs(c)), (turn, n)


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.6, 1.5])
@pytest.mark.parametrize("order", [0, 1])
@pytest.mark.parametrize("name", FORCES)
def test_modes_left_out_move_within_their_bound(name, order, ratio):
    # modes 4 ... 40 of the string are left out; what they do beyond their static response
    omega = 2 * math.pi * 40.0 * np.arange(4, 41)
    share = np.cos(np.arange(4.0, 41.0))
    modes = expansion(ratio * omega, omega**2, a=share * 1e4)
    bound = np.abs(share * 1e4 / omega**2).sum()
    static = expansion([], [], rest=(share * 1e4 / omega**2).sum())
    force = FORCES[name]
    moved, still = (convolve(one, 0, force, GRID, order) for one in (modes, static))
    most = left_out(force, GRID, bound, omega[0], order, ratio=ratio)
    assert np.abs(moved - still).max() <= most


def test_bound_of_modes_left_out_falls_with_their_frequency():
    sine = Sine(1.0, 40.0)
    low, high = (float(left_out(sine, GRID, 1.0, 2 * math.pi * f)) for f in (400.0, 4000.0))
    # from rest, a sine has a kink: the free motion falls as 1/f
    assert high == pytest.approx(low / 10, rel=0.2)
    assert low < 0.15
    assert float(left_out(sine, GRID, 0.0, 1.0)) == 0
    assert math.isinf(left_out(Impulse(1.0), GRID, 1.0, 1e4))
    assert math.isinf(left_out(Chirp(1.0, 0.0, 1e160, 1.0), GRID, 1.0, 1e4))
    assert float(left_out(Step(0.0), GRID, math.inf, 1e4)) == 0
    assert math.isinf(left_out(Step(1.0), GRID, 1.0, 1e4, 1))
    assert float(left_out(Step(2.0), GRID, 1.0, 1e4)) == 2.0


def test_bound_takes_every_response():
    assert left_out(Step(2.0), GRID, np.array([1.0, 0.0, 3.0]), 1e4).tolist() == [2.0, 0.0, 6.0]


def test_poles_are_close_by_half_of_what_time_or_decay_tells_apart():
    """1/(2 span) without decay and a quarter of the decay of both more; none is close to itself."""
    still = np.array([10j, 10.4j, 11j])
    expected = np.array([[False, True, False], [True, False, False], [False, False, False]])
    np.testing.assert_array_equal(_close(still, 1.0), expected)
    decaying = np.array([-8.0, -6.0, -3.6]) + 0j
    np.testing.assert_array_equal(_close(decaying, 1.0), expected)


def test_a_circle_has_as_few_nodes_as_its_digits_ask_for():
    """Between a quarter and 4 over the span it is 1 wide, and 20! > e^38 > 18!."""
    poles = np.array([10j - 1e-6, 10j + 1e-6, 1000j])
    radius, nodes = _circle(poles, np.array([True, True, False]), 1.0)
    assert (radius, nodes) == (pytest.approx(1.0, rel=1e-15), 20)


def test_a_sine_varies_by_what_it_turns_from_where_it_begins():
    """sin(pi/6) at first, and no more than 2 pi f (end - begin) after that."""
    jump, whole = _variation(Sine(3.0, 1.0), 1 / 12, 1 / 12 + 0.01, 0)
    assert jump == pytest.approx(1.5, rel=1e-14)
    assert whole == pytest.approx(1.5 + 3.0 * 2 * np.pi * 0.01, rel=1e-14)
