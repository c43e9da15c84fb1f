"""Numbers of ropes on an axis by their peaks, and what is compared with measurements."""

import numpy as np
import pytest
from scipy.stats import binom

import ropedyn as rd

ARC = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
ARCH = rd.Scene(ARC, ends=("pinned", "pinned"), planes="both", tension=120.0)
FREQUENCY = ARCH.compile().modes(8).frequency
GUESS = ARCH.replace(tension=90.0, rope=ARC.replace(bending_stiffness=40.0))
SOUGHT = ["tension", "bending_stiffness"]
ORDERS = range(1, 9)
SPRUNG = rd.Scene(
    ARC,
    planes="both",
    tension=120.0,
    ends=("clamped", rd.End(beta="free", spring={"beta": 20.0})),
    parts=[rd.PointMass(0.7, 0.2)],
)


@pytest.mark.claim(
    "T and B of an arch by eight noise-free peaks of both planes",
    reference="the numbers that made the peaks",
    accepted=1e-14,
)
def test_peaks_without_noise_give_back_tension_and_bending(claim):
    fit = rd.identify(GUESS, rd.Peaks(FREQUENCY, std=1e-4 * FREQUENCY), SOUGHT, orders=ORDERS)
    assert fit.status == "trusted" and fit.ends == "given"
    claim(max(abs(fit.value["tension"] / 120 - 1), abs(fit.value["bending_stiffness"] / 50 - 1)))
    assert fit.scene.rope.axis == ARC.axis
    assert "cross-checks" not in fit.report()


def test_springs_and_masses_come_back_too():
    modes = SPRUNG.compile().modes(8)
    guess = SPRUNG.replace(
        ends=("clamped", rd.End(beta="free", spring={"beta": 30.0})),
        parts=[rd.PointMass(0.7, 0.25)],
    )
    sought = ["ends[1].spring.beta", "parts[0].mass", "tension"]
    fit = rd.identify(guess, rd.Peaks(modes.frequency), sought, orders=ORDERS, ends="given")
    found = [fit.value[path] for path in sought]
    assert found == pytest.approx([20.0, 0.2, 120.0], rel=1e-8)


def test_a_hanging_rope_tells_its_bending():
    rope = rd.Rope(
        rd.Axis.catenary(10.0, parameter=9.0), 0.8, bending_stiffness=2.0, torsional_stiffness=1.0
    )
    scene = rd.Scene(rope, planes="both", gravity=rd.Gravity())
    peaks = scene.compile().modes(5).frequency
    guess = scene.replace(rope=rope.replace(bending_stiffness=2.4))
    fit = rd.identify(guess, rd.Peaks(peaks), ["bending_stiffness"], orders=range(1, 6))
    assert fit.value["bending_stiffness"] == pytest.approx(2.0, rel=1e-8)


def covered(seeds):
    """Return how many 95 % intervals of T and of B hold the true one."""
    ropes = []
    for seed in seeds:
        noise = 1e-3 * np.random.default_rng(seed).standard_normal(len(FREQUENCY))
        ropes.append(rd.Peaks(FREQUENCY * (1 + noise), std=1e-3 * FREQUENCY))
    fits = rd.identify(GUESS, ropes, SOUGHT, orders=ORDERS, threads=1)
    bounds = fits.interval(0.95)
    true = np.array([120.0, 50.0])
    return ((bounds[:, :, 0] <= true) & (true <= bounds[:, :, 1])).sum(axis=0)


def within(count, of):
    """Whether chance alone leaves so many of them in less than one of 10 000 cases."""
    low, high = binom.ppf([5e-5, 1 - 5e-5], of, 0.95)
    return low <= count <= high


def test_intervals_of_95_percent_hold_the_numbers():
    assert all(within(count, 12) for count in covered(range(12)))


@pytest.mark.slow
@pytest.mark.claim(
    "95 % intervals of T and B of an arch by 200 samples of noisy peaks: the distance of the share "
    "that hold them from 0.95, within the limits of chance",
    reference="the numbers that made the peaks",
    accepted=0.06,
)
def test_intervals_of_95_percent_hold_the_numbers_of_200_samples(claim):
    counts = covered(range(1000, 1200))
    assert all(within(count, 200) for count in counts)
    claim(max(abs(count / 200 - 0.95) for count in counts))


def test_peaks_are_compared_with_a_model_on_an_axis():
    comparison = rd.compare(
        ARCH.compile(), rd.Peaks(FREQUENCY[:6] * 1.001, std=1e-3 * FREQUENCY[:6])
    )
    assert comparison.status == "trusted" and comparison.order.tolist() == [1, 2, 3, 4, 5, 6]
    assert comparison.score == pytest.approx(-np.ones(6), rel=2e-2)


def test_responses_are_compared_with_a_model_on_an_axis():
    model = ARCH.replace(damping=rd.RayleighDamping(2.0, 1e-5)).compile()
    points = [("z", 0.7), ("z", 1.3), ("x", 1.1)]
    frf = model.frf(np.linspace(1.0, 60.0, 400), drive=points[0], response=points)
    measured = rd.Measured(
        frequency=frf.frequency, value=frf.value, drive=frf.drive, response=frf.response
    )
    comparison = rd.compare(model, measured)
    assert comparison.frac == pytest.approx(np.ones(3), rel=1e-12)
    # modes across the plane are not seen in it, the others have the measured shapes
    plane = model.modes(len(comparison.visible)).plane
    assert (comparison.visible == (plane == "z")).all()
    own = comparison.mac[np.arange(len(comparison.order)), comparison.order - 1]
    assert own == pytest.approx(np.ones(len(own)), abs=1e-5)
    assert "complex modes are not carried for a rope on an axis" in comparison.report()


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"ends": "unknown", "orders": ORDERS}, 'ends must be "given" of a rope on an axis'),
        ({}, "orders must be given for a rope on an axis"),
        ({"orders": None}, "orders must be given for a rope on an axis"),
    ],
)
def test_what_peaks_do_not_tell_on_an_axis_is_refused_by_name(asked, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.identify(GUESS, FREQUENCY, SOUGHT, **asked)


def test_other_verbs_of_experiments_are_refused_by_name():
    frf = ARCH.compile().frf(np.linspace(1.0, 9.0, 30), drive=("z", 0.7))
    measured = rd.Measured(
        frequency=frf.frequency, value=frf.value, drive=frf.drive, response=frf.response
    )
    with pytest.raises(rd.SceneError, match="measured must be peaks for a rope on an axis"):
        rd.identify(GUESS, measured, SOUGHT)
    with pytest.raises(rd.SceneError, match="rope must be straight for planning"):
        rd.plan_measurement(ARCH)


def test_damping_beside_peaks_says_that_it_is_left_out():
    damped = GUESS.replace(damping=rd.ViscousDamping(1.0))
    with pytest.warns(rd.IdentifyWarning, match="complex modes are not carried on an axis"):
        rd.identify(damped, rd.Peaks(FREQUENCY), SOUGHT, orders=ORDERS)
