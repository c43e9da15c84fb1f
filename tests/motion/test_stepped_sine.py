"""Steady states under a stepped sine: against the direct response, and a bent resonance."""

import math

import numpy as np
import pytest
from scipy.optimize import root

import ropedyn as rd
from ropedyn.motion.periodic.slipping import Decays

DRIVE = rd.study2015.DRIVE
RESPONSES = [("z", 0.50625), ("beta", 0.50625), ("alpha", 0.3375)]


@pytest.fixture(scope="module")
def study():
    return rd.study2015.scene().compile(elements=8, element="difference")


def away(stepped, direct):
    return np.abs(stepped.value / direct.value - 1)


def test_steady_motion_of_a_linear_scene_is_its_response(study):
    lines = np.linspace(30.0, 250.0, 12)
    stepped = study.stepped_sine(lines, drive=DRIVE, amplitude=2.0, response=RESPONSES)
    assert (stepped.value == study.frf(lines, drive=DRIVE, response=RESPONSES).value).all()
    assert stepped.stable.all()


def test_steady_motion_is_what_integration_over_time_settles_on(study):
    """A stop that is met for half of the period, against motion over 200 periods."""
    f = 69.4
    scene = study.scene.replace(parts=[rd.Stop(DRIVE[1], 2e4)])
    model = scene.compile(elements=8, element="difference")
    stepped = model.stepped_sine([f], drive=DRIVE, amplitude=2.0)
    time = np.linspace(0.0, 200 / f, 200 * 512 + 1)
    force = rd.Sine(2.0, f, phase=np.pi / 2)
    history = model.transient(time, drive=DRIVE, force=force, tolerance=1e-5)
    settled = history.value[0, -512:] * np.exp(-2j * np.pi * f * time[-512:])
    assert abs(2 / 512 * settled.sum() / 2.0 / stepped.value[0, 0] - 1) < 1e-4


def test_quantities_and_moved_ends_are_those_of_the_direct_response():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
    scene = rd.Scene(rope, tension=100.0, damping=rd.RayleighDamping(20.0, 1e-5))
    model = scene.compile(elements=12)
    options = {"drive": ("end", 0, "z"), "response": ("z", 0.5), "quantity": "accelerance"}
    stepped = model.stepped_sine([20.0, 16.0], amplitude=1e-3, **options)
    # lumps with end correction in both
    assert away(stepped, model.frf([20.0, 16.0], **options)).max() < 1e-8
    assert stepped.labels == model.frf([20.0], **options).labels


# --- one mass on a string whose tension grows ---------------------------------------------------

LENGTH, DENSITY, TENSION, STIFFNESS, DECAY, FORCE = 1.0, 0.1, 100.0, 1e5, 12.0, 2.0
"""A string of two elements: m x'' + m DECAY x' + 4T/L x + 8 EA/L^3 x^3 = FORCE cos."""


def hard(**change):
    tension = rd.Tension(TENSION, stretching=True)
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=STIFFNESS)
    scene = rd.Scene(rope, tension=tension, damping=rd.RayleighDamping(DECAY, 0.0), **change)
    return scene.compile(elements=2)


def balanced(frequency, guess, harmonics=7):
    """Return the amplitude of the first harmonic of a periodic motion, near a guess."""
    mass, samples = DENSITY * LENGTH / 2, 16 * harmonics
    omega, turn = 2 * np.pi * frequency, 2 * np.pi * np.arange(samples) / samples
    k = np.arange(1, harmonics + 1)
    basis = np.concatenate([np.cos(np.outer(turn, k)), np.sin(np.outer(turn, k))], axis=1)
    rate = omega * np.concatenate(
        [-k * np.sin(np.outer(turn, k)), k * np.cos(np.outer(turn, k))], 1
    )

    def unbalanced(c):
        x, v = basis @ c, rate @ c
        a = -((omega * np.tile(k, 2)) ** 2 * basis) @ c
        stiff = 4 * TENSION / LENGTH * x + 8 * STIFFNESS / LENGTH**3 * x**3
        return 2 / samples * basis.T @ (mass * (a + DECAY * v) + stiff - FORCE * np.cos(turn))

    start = np.zeros(2 * harmonics)
    start[[0, harmonics]] = guess.real, -guess.imag
    found = root(unbalanced, start, tol=1e-14)
    assert np.abs(unbalanced(found.x)).max() < 1e-10
    return found.x[0] - 1j * found.x[harmonics]


def test_bent_resonance_is_that_of_harmonic_balance_and_jumps():
    model = hard()
    first = model.modes(1).frequency[0]
    lines = first * np.linspace(1.0, 1.7, 8)
    options = {"drive": ("z", LENGTH / 2), "amplitude": FORCE}
    up = model.stepped_sine(lines, **options)
    down = model.stepped_sine(lines[::-1], **options)
    rising, falling = FORCE * up.value[0], FORCE * down.value[0, ::-1]
    for f, one, error in zip(lines, rising, up.rounding_error[0]):
        assert abs(balanced(f, one) / one - 1) <= error
    for f, one, error in zip(lines, falling, down.rounding_error[0, ::-1]):
        assert abs(balanced(f, one) / one - 1) <= error
    # between the jump up and the jump down there are two motions
    assert (np.abs(rising) > 2 * np.abs(falling)).any()
    assert np.isclose(rising[0], falling[0], rtol=1e-3)
    assert np.isclose(rising[-1], falling[-1], rtol=1e-3)
    assert np.isinf(up.mesh_error).all()


def test_small_amplitudes_are_linear():
    model, linear = hard(), hard().scene.without("mean stretching").compile(elements=2)
    lines = [30.0, 31.0]
    small = model.stepped_sine(lines, drive=("z", 0.5), amplitude=1e-4, tolerance=1e-6)
    assert away(small, linear.frf(lines, drive=("z", 0.5))).max() < 1e-6


# --- one mass on a string whose tension pulsates -------------------------------------------------


def hill(frequency, pulsation, stiffness, terms=12):
    """Amplitude per force of m x'' + m DECAY x' + (4T/L + stiffness cos) x = cos, by Hill's sum.

    x is the real part of the sum of X_n exp(i (omega + n omega_p) t), where one more frequency may
    be -omega.
    """
    n = np.arange(-terms, terms + 1)
    omega = 2 * np.pi * (frequency + n * pulsation)
    mass = DENSITY * LENGTH / 2
    matrix = np.diag(4 * TENSION / LENGTH + mass * (1j * DECAY * omega - omega**2))
    matrix += stiffness / 2 * (np.eye(len(n), k=1) + np.eye(len(n), k=-1))
    x = np.linalg.solve(matrix, np.where(n == 0, 1.0, 0.0))
    return x[terms] + x[omega == -omega[terms]].sum().conj()


def pulsed(pulsation, amplitude):
    tension = rd.Tension(TENSION, amplitude=amplitude, frequency=pulsation)
    return hard().scene.replace(tension=tension).compile(elements=2)


@pytest.mark.parametrize("pulsation", [30.0, 10.0, 17.0])
def test_motion_under_a_tension_of_another_period_is_hills(pulsation):
    # both begin anew after 2, 2 and 20 periods of the drive
    stepped = pulsed(pulsation, 30.0).stepped_sine([20.0], drive=("z", LENGTH / 2), amplitude=1.0)
    exact = hill(20.0, pulsation, 4 * 30.0 / LENGTH)
    assert abs(stepped.value[0, 0] / exact - 1) <= stepped.rounding_error[0, 0]
    assert stepped.rounding_error[0, 0] < 1e-5


def test_law_of_another_period_is_hills():
    stiffness, omega = 120.0, 2 * np.pi * 30.0
    law = rd.NodeForce(LENGTH / 2, lambda t, u, v: -stiffness * np.cos(omega * t) * u)
    scene = hard(parts=[law]).scene.without("mean stretching")
    stepped = scene.compile(elements=2).stepped_sine([20.0], drive=("z", LENGTH / 2), amplitude=1.0)
    error = abs(stepped.value[0, 0] / hill(20.0, 30.0, stiffness) - 1)
    assert error <= stepped.rounding_error[0, 0] < 1e-5


def test_tension_that_never_begins_anew_with_the_drive_is_refused():
    with pytest.raises(rd.SolveError, match="do not begin anew together"):
        pulsed(20.0 * np.sqrt(2), 30.0).stepped_sine([20.0], drive=("z", LENGTH / 2), amplitude=1.0)


@pytest.mark.parametrize("gap", [0.0, 1e-5])
def test_a_stop_that_is_met_at_every_amplitude_has_a_steady_state(gap):
    """Of 26 frequencies 17 were refused; the motion over time is exact between events."""
    f, drive = 16.0, ("z", 0.5)
    parts = [rd.Stop(0.75, 4282.6, gap=gap)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(0.8), parts=parts)
    model, time = scene.compile(elements=4, element="rigid"), np.arange(12_801) / (64 * f)
    stepped = model.stepped_sine([f], drive=drive, amplitude=6.0)
    history = model.transient(time, drive=drive, force=rd.Sine(6.0, f, phase=np.pi / 2))
    last, turns = slice(-513, -1), np.exp(-2j * np.pi * f * time)
    settled = 2 * np.mean(history.value[0, last] * turns[last]) / 6.0
    assert abs(stepped.value[0, 0] / settled - 1) <= stepped.rounding_error[0, 0]  # 0.03 of it
    assert stepped.rounding_error[0, 0] <= 1e-5
    assert stepped.stable.all()
    if gap == 0:
        small = model.stepped_sine([f], drive=drive, amplitude=1e-4)
        error = abs(small.value[0, 0] / stepped.value[0, 0] - 1)
        assert error <= small.rounding_error[0, 0] + stepped.rounding_error[0, 0]


def test_motion_that_falls_where_nothing_is_stable_begins_at_rest():
    """The way from the fold was followed for 3000 steps, to where no step was short enough."""
    damping, parts = rd.RayleighDamping(6.0, 0.0), [rd.Stop(0.5, 1e4)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=parts)
    model, asked = scene.compile(elements=8), {"drive": ("z", 0.5), "amplitude": 1.0}
    swept = model.stepped_sine([8.0, 10.2], tolerance=1e-3, **asked)
    alone = model.stepped_sine([10.2], tolerance=1e-3, **asked)
    error = abs(swept.value[0, 1] / alone.value[0, 0] - 1)
    assert error <= swept.rounding_error[0, 1] + alone.rounding_error[0, 0] < 1e-2
    assert not swept.stable.any()


# --- what has no steady state -------------------------------------------------------------------


@pytest.mark.parametrize("elements", [2, None])
def test_undamped_motion_has_no_steady_state(elements):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=elements)
    with pytest.raises(rd.SolveError, match="no steady state"):
        model.stepped_sine([10.0], drive=("z", 0.5), amplitude=1.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency": [0.0]}, "frequency must be at least 1e-100 Hz, got 0.0"),
        ({"frequency": [1e-300]}, "frequency must be at least 1e-100 Hz, got 1e-300"),
        ({"drive": ("z", 0.0)}, r"drive must be free to move, got \('z', 0.0\), which a support"),
        ({"amplitude": 0.0}, "amplitude must be a finite number > 0"),
        ({"amplitude": 1e-150}, r"amplitude must lie in 1e-100 ... 1e\+100 N, got 1e-150"),
        ({"amplitude": 1e150}, r"amplitude must lie in 1e-100 ... 1e\+100 N, got 1e\+150"),
        ({"drive": [("z", 0.5), ("z", 0.2)]}, "drive must be one point"),
        ({"tolerance": -1.0}, "tolerance must be"),
    ],
)
def test_what_has_no_meaning_is_refused(change, message):
    given = {"frequency": [10.0], "drive": ("z", 0.5), "amplitude": 1.0} | change
    with pytest.raises(rd.SceneError, match=message):
        hard().stepped_sine(**given)


def test_what_symmetry_keeps_at_rest_is_disturbed():
    """In step both stops bend the motion; out of step it grows by rounding, in 500 periods."""
    f, zeta = 60.152, 0.014168
    parts = [
        rd.Dashpot(0.5, 0.0401888, exponent=0.0),
        rd.Stop(0.25, 266.959, side=-1),
        rd.Stop(0.75, 266.959, side=-1),
    ]
    damping = rd.ViscousDamping(0.2 * zeta * np.pi * np.sqrt(1000.0))
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=parts)
    model = scene.compile(elements=4, element="rigid")
    seen = [("z", 0.25), ("z", 0.75)]
    stepped = model.stepped_sine([f], drive=("z", 0.5), amplitude=1.0, response=seen)
    # a blow of a part of what drives, then long enough
    time = np.arange(500 * 32 + 1) / (32 * f)
    force = [rd.Sine(1.0, f, phase=np.pi / 2), rd.Impulse(1e-4 / f)]
    history = model.transient(
        time, drive=[("z", 0.5), ("z", 0.25)], force=force, response=seen, partial=True
    )
    turn = np.exp(-2j * np.pi * f * time[-257:-1])
    true = (2 * history.value[:, -257:-1] * turn).mean(axis=1)
    # the 31st harmonic is seen as the first in 32 samples
    assert np.abs(stepped.value[:, 0] / true - 1).max() < 5e-3
    assert not stepped.stable.any()


def test_a_law_that_raises_says_where():
    part = rd.NodeForce(0.5, lambda t, u, v: 1 / 0)
    model = rd.Scene(rd.Rope(1.0, 0.2), tension=100.0, parts=[part]).compile(elements=4)
    with pytest.raises(ZeroDivisionError) as raised:
        model.stepped_sine([10.0], drive=("z", 0.5), amplitude=1.0)
    assert "raised by parts[0].law(t=" in raised.value.__notes__[0]


@pytest.mark.parametrize(
    ("friction", "stiffness", "gap", "f"),
    [(0.04, 35_953.0, 4e-4, 25.2), (0.09, 413_553.0, 0.0, 27.8)],
)
def test_motion_that_never_repeats_with_the_drive_is_refused(friction, stiffness, gap, f):
    """The first is chaotic, the second repeats after three periods, by steps of 1/1500 of one."""
    parts = [
        rd.Dashpot(0.5, friction, exponent=0.0),
        rd.Stop(0.5, stiffness=stiffness, gap=gap),
    ]
    damping = rd.RayleighDamping(mass=6.0, stiffness=0.0)
    scene = rd.Scene(rd.Rope(1.0, 0.2), tension=100.0, damping=damping, parts=parts)
    model = scene.compile(elements=2, element="rigid")
    with pytest.raises(rd.SolveError, match=r"no steady state of its period: after \d+ periods"):
        model.stepped_sine([f], drive=("z", 0.5), amplitude=1.0)


def test_periods_that_are_slow_to_become_unlike_are_waited_for():
    """Of one period the motion grows by 1.06 each, until every second one is another."""
    f = 21.31475843509003
    parts = [rd.Dashpot(0.5, 0.65818, exponent=0.0), rd.Stop(0.75, 1253.234)]
    damping = rd.ViscousDamping(0.28284486)
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=parts)
    model = scene.compile(elements=4, element="rigid")
    seen = [("z", 0.25), ("z", 0.5), ("z", 0.75)]
    stepped = model.stepped_sine([f], drive=("z", 0.5), amplitude=1.0, response=seen)
    time = np.arange(300 * 64 + 1) / (64 * f)
    force = rd.Sine(1.0, f, phase=np.pi / 2)
    history = model.transient(time, drive=("z", 0.5), force=force, response=seen)
    turn = np.exp(-2j * np.pi * f * time[-257:-1])
    each = (2 * history.value[:, -257:-1] * turn).reshape(3, 4, 64).mean(axis=2)
    assert np.abs(each[:, 0] - each[:, 2]).max() < 1e-6 * np.abs(each).max()
    assert np.abs(each[:, 0] - each[:, 1]).max() > 0.1 * np.abs(each).max()
    off = np.abs(stepped.value[:, 0] / each.mean(axis=1) - 1)
    # the 63rd harmonic is seen as the first in 64 samples, and falls as 1/k^3
    assert (off <= stepped.rounding_error[:, 0] + 1e-5).all()
    assert stepped.rounding_error.max() <= 1e-3
    assert not stepped.stable.any()


@pytest.mark.parametrize(("decay", "ends"), [(0.0, 64), (1e-4, 64), (0.01, None)])
def test_changes_that_stay_as_they_are_end_what_is_followed(decay, ends):
    """From half of the looks to all of them they must fall below 0.9."""
    changes = np.abs(np.diff(np.exp((3j - decay) * np.arange(500)))).tolist()
    decays = Decays(32)
    ended = (n for n in range(1, 501) if not decays.go_on(changes[: n - 1]))
    assert next(ended, None) == ends


def test_undamped_modes_that_are_not_driven_do_not_hinder_the_steady_state():
    """A dashpot in the middle leaves every second mode undamped, at whose node it is driven."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, parts=[rd.Dashpot(0.5, 0.5)])
    f, drive = [2.0, 7.3, 33.0], ("z", 0.5)
    for elements in (16, None):
        model = scene.compile(elements=elements)
        stepped = model.stepped_sine(f, drive=drive, amplitude=1.0)
        exact = model.frf(f, drive=drive)
        error = np.abs(stepped.value / exact.value - 1)
        assert (error <= stepped.rounding_error + exact.rounding_error).all()
    with pytest.raises(rd.SolveError, match="no steady state"):
        model.stepped_sine(f, drive=("z", 0.25), amplitude=1.0)


@pytest.mark.parametrize(("force", "frequency", "ratio"), [(0.99, 38.0, 0.2), (0.998, 20.0, 0.05)])
def test_friction_that_just_slips_is_known_as_far_as_is_said(force, frequency, ratio):
    """Where it comes to rest creeps: 5 to 19 times as far off as was said.

    Against a run to a hundredth of the tolerance.
    """
    damping = rd.ViscousDamping(4 * math.pi * ratio * math.sqrt(100.0 / 0.1) / 2 * 0.1)
    friction = rd.Dashpot(0.5, force, exponent=0.0)
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=[friction])
    model = scene.compile(elements=2, element="rigid")
    asked = {"drive": ("z", 0.5), "amplitude": 1.0}
    found, exact = (model.stepped_sine([frequency], tolerance=one, **asked) for one in (1e-3, 1e-5))
    apart = np.abs(found.value - exact.value)
    known = found.rounding_error * np.abs(found.value) + exact.rounding_error * np.abs(exact.value)
    assert (apart <= known).all()
    assert (apart <= 1e-3 * np.abs(exact.value)).all()


@pytest.mark.parametrize("force", [4.085, 4.09])
def test_what_is_slow_to_settle_is_seen_behind_what_is_fast(force):
    """What changes fell by 0.28 at first, and by 0.9 when they had been believed: 2 to 4 times."""
    parts = [rd.PointMass(0.6, 0.0342036), rd.Dashpot(0.4, force, exponent=0.0)]
    damping = rd.RayleighDamping(5.354, 1.117e-4)
    scene = rd.Scene(rd.Rope(1.0, 0.643518), tension=520.862, damping=damping, parts=parts)
    model = scene.compile(elements=5, element="rigid")
    asked = {"drive": ("z", 0.8), "amplitude": 2.229995, "response": [("z", 0.4), ("z", 0.8)]}
    rough, fine = (model.stepped_sine([24.24963], tolerance=to, **asked) for to in (1e-5, 1e-7))
    off, said = np.abs(rough.value - fine.value), np.zeros((2, 1))
    for one in (rough, fine):
        said += one.rounding_error * np.abs(one.value)
    assert (off <= said).all()


def test_error_beside_friction_is_alike_in_every_unit_of_length():
    """Errors of displacements were those of rotations in another unit: 30 000 of all motion."""
    error = []
    for unit in (1.0, 1e-9):
        rope = rd.Rope(unit, 0.4 / unit**2, bending_stiffness=1.54 * unit**2)
        parts = [rd.Dashpot(0.5 * unit, 5.0, exponent=0.0)]
        damping = rd.RayleighDamping(2.0, 1e-5)
        model = rd.Scene(rope, tension=2830.0, damping=damping, parts=parts).compile(elements=8)
        asked = {"drive": ("z", 0.375 * unit), "amplitude": 12.0}
        seen = [("z", 0.25 * unit), ("beta", 0.25 * unit)]
        error.append(model.stepped_sine([43.0], **asked, response=seen).rounding_bound)
    assert max(one.max() for one in error) < 1e-3  # measured: 7e-5


@pytest.mark.parametrize("unit", [1e-9, 1e-6, 1e9])
def test_friction_slips_alike_in_every_unit_of_time(unit):
    """What counts as slow is so beside the period: of one second it was 4 times off at 1e-6 Hz."""

    def steady(q):
        damping = rd.RayleighDamping(1.853 * q, 0.009874 / q)
        friction = rd.Dashpot(0.5, 0.008854, exponent=0.0)
        scene = rd.Scene(rd.Rope(1.0, q**-2), tension=4.0, damping=damping, parts=[friction])
        model = scene.compile(elements=4, element="rigid")
        return model.stepped_sine([0.9 * q, 1.5 * q], drive=("z", 0.5), amplitude=0.012)

    found, plain = steady(unit), steady(1.0)
    off = np.abs(found.value - plain.value)
    assert (off <= plain.rounding_error * np.abs(plain.value)).all()
    assert found.stable.all()


@pytest.mark.parametrize(("force", "method"), [(0.1, "events"), (5.0, "balance")])
def test_ratios_of_modes_stand_beside_friction(force, method):
    """As drag that is the same for each mode; friction was called a dashpot, and refused."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    omega = 2 * np.pi * scene.compile(elements=4, element="rigid").modes(3).frequency
    friction, answers = rd.Dashpot(0.5, force, exponent=0.0), []
    for damping in (rd.RayleighDamping(4.0, 0.0), rd.ModalDamping((2.0 / omega).tolist())):
        damped = scene.replace(damping=damping, parts=[friction])
        model = damped.compile(elements=4, element="rigid")
        answers.append(model.stepped_sine([12.0], drive=("z", 0.25), amplitude=1.0))
        assert answers[-1].cost.method == method
    drag, ratios = answers
    off = np.abs(ratios.value / drag.value - 1)
    assert (off <= drag.rounding_error + ratios.rounding_error + 1e-12).all()


def test_friction_that_slides_all_the_time_beside_a_stop_has_a_steady_state():
    """While all friction holds nothing is found from rest, and it was refused."""
    parts = [
        rd.Dashpot(0.25, 0.1018, exponent=0.0),
        rd.Dashpot(0.5, 0.0259, exponent=0.0),
        rd.Stop(0.75, 347.2, gap=0.0009),
    ]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(1.2), parts=parts)
    model, drive = scene.compile(elements=4, element="rigid"), ("z", 0.5)
    found = model.stepped_sine([13.89], drive=drive, amplitude=1.0)
    assert found.cost.method == "events" and found.stable.all()
    samples, periods = 64, 150
    time = np.arange(samples * periods + 1) / (samples * 13.89)
    push = rd.Sine(1.0, 13.89, phase=math.pi / 2)
    moved = model.transient(time, drive=drive, force=push, response=drive, tolerance=1e-6).value[0]
    last = moved[-1 - 8 * samples : -1] @ np.exp(-2j * np.pi * np.arange(8 * samples) / samples)
    apart = abs(found.value[0, 0] - last / (4 * samples))
    known = found.rounding_error[0, 0] * abs(found.value[0, 0])
    assert apart <= known + 1e-4 * abs(found.value[0, 0])
