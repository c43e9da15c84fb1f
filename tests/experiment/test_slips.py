"""Slips in what was measured: found by name, and never claimed where all is right."""

from dataclasses import replace

import numpy as np
import pytest
from damped_ropes import damped_rope

import ropedyn as rd
from ropedyn.experiment.compare.slips import slips
from ropedyn.experiment.compare.unit_slips import slips_of_peaks

QUANTITIES = ("receptance", "mobility", "accelerance")


def case(seed, *, driven=True):
    """Return a noisy response, a model of a tension some 20 % off, and the generator."""
    random = np.random.default_rng(seed)
    scene = damped_rope(random)
    model = scene.compile()
    top = 1.05 * model.modes(int(random.integers(5, 10))).frequency[-1]
    lines = np.linspace(0.0, top, int(random.integers(800, 3000)))[1:]
    drive, *others = (("z", scene.rope.length * x) for x in random.uniform(0.05, 0.95, 3))
    quantity = QUANTITIES[random.integers(3)]
    response = [drive, others[0]] if driven else others
    value = model.frf(lines, drive=drive, response=response, quantity=quantity).value
    noise = random.normal(size=(2, *value.shape)) * 10 ** random.uniform(-5, -2)
    value = value + (noise[0] + 1j * noise[1]) * np.abs(value).max(axis=1, keepdims=True)
    measured = rd.Measured(lines, value, drive=drive, response=response, quantity=quantity)
    tension = scene.mean_tension * np.exp(random.normal(0, 0.2))
    return measured, scene.replace(tension=tension).compile(), random


def conjugate(measured, random):
    return replace(measured, value=measured.value.conj())


def another_quantity(measured, random):
    others = [name for name in QUANTITIES if name != measured.quantity]
    return replace(measured, quantity=others[random.integers(2)])


def degrees_for_radians(measured, random):
    phase = np.angle(measured.value)
    return replace(measured, value=np.abs(measured.value) * np.exp(1j * np.radians(phase)))


def angular(measured, random):
    return replace(measured, frequency=2 * np.pi * measured.frequency)


SLIPS = {
    "sign of phase": (conjugate, "take the complex conjugate", True, False),
    "quantity of a driven point": (another_quantity, "what was said to be", True, False),
    "quantity by the model": (another_quantity, "what was said to be", False, True),
    "radians": (degrees_for_radians, "multiply the phases by 180/pi", True, False),
    "rad/s": (angular, "divide them by 2 pi", True, True),
}


def found_share(what, seeds):
    """Return the share of slips that are found and named alone."""
    change, words, driven, with_model = SLIPS[what]
    found = 0
    for seed in seeds:
        measured, model, random = case(seed, driven=driven)
        said = slips(change(measured, random), model if with_model else None)
        found += len(said) == 1 and words in said[0]
    return found / len(seeds)


def claimed_share(seeds):
    """Return the share of right responses of which a slip is claimed."""
    claimed = 0
    for seed in seeds:
        measured, model, _ = case(seed, driven=seed % 2 == 0)
        claimed += bool(slips(measured) or slips(measured, model))
    return claimed / len(seeds)


@pytest.mark.parametrize("what", SLIPS)
def test_slips_are_found_by_name(what):
    # 95 of 100 by the large sample below
    assert found_share(what, range(40_000, 40_006)) >= 0.8


def test_no_slip_is_claimed_of_right_responses():
    assert claimed_share(range(41_000, 41_010)) == 0


@pytest.mark.slow
@pytest.mark.claim(
    "slips in responses that are not found: signs of phase, quantities, radians, rad/s",
    "100 random damped, noisy responses each",
    0.05,
)
@pytest.mark.parametrize("what", SLIPS)
def test_most_slips_are_found(what, claim):
    claim(1 - found_share(what, range(50_000, 50_100)))


@pytest.mark.slow
@pytest.mark.claim(
    "slips that are claimed of right responses", "200 random damped, noisy responses", 0.0
)
def test_right_responses_have_no_slip(claim):
    claim(claimed_share(range(51_000, 51_200)))


def test_a_sensor_of_the_other_sign_is_one_or_accelerance():
    # without a model either; amplitudes against a model tell
    measured, model, _ = case(42_000)
    measured = replace(measured, quantity="receptance", value=measured.to("receptance").value)
    turned = replace(measured, value=-measured.value)
    (either,) = slips(turned)
    assert 'read it with quantity="accelerance", or change the sign' in either
    (sign,) = slips(turned, model)
    assert "the sensor or the force has the other sign; change the sign" in sign


def test_a_response_below_its_first_resonance_has_no_slip():
    # phases within a few degrees, and no peak
    measured, _, _ = case(42_001)
    few = len(measured.frequency) // 20
    below = rd.Measured(
        measured.frequency[:few],
        np.linspace(1, 5, few) * np.exp(-1j * np.radians(np.linspace(0, 3, few))),
        drive=measured.drive,
        response=measured.drive,
    )
    assert slips(below) == ()


@pytest.mark.parametrize("seed", range(43_000, 43_012))
def test_angular_frequencies_of_peaks_are_named(seed):
    random = np.random.default_rng(seed)
    scene = damped_rope(random)
    f = scene.compile().modes(6).frequency * np.exp(random.normal(0, 1e-3, 6))
    model = scene.replace(tension=scene.mean_tension * np.exp(random.normal(0, 0.3))).compile()
    assert slips_of_peaks(f, model) == ()
    (text,) = slips_of_peaks(2 * np.pi * f, model)
    assert text.startswith("all peaks pair with modes after division by 2 pi")


def test_a_comparison_says_the_slips():
    measured, model, random = case(42_002)
    comparison = rd.compare(model, conjugate(measured, random))
    assert any("take the complex conjugate" in note for note in comparison.notes)
    assert "take the complex conjugate" in comparison.report()
    string = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
    found = rd.compare(string, 2 * np.pi * string.modes(5).frequency)
    assert any("divide them by 2 pi" in note for note in found.notes)
    assert found.status == "ambiguous"


def test_a_huge_stray_costs_nothing_and_is_named():
    scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, parts=[rd.PointMass(0.7, 0.05)])
    f = scene.compile().modes(5).frequency
    peaks = rd.Peaks([*f, 1e6], std=[*(1e-3 * f), 1e3])
    fit = rd.identify(scene, peaks, "tension")
    assert fit.orders.tolist() == [1, 2, 3, 4, 5, 0]
    with pytest.raises(rd.SceneError, match=r"at most 5000 modes, got a peak at 1e\+06 Hz"):
        rd.compare(scene.compile(), peaks)
