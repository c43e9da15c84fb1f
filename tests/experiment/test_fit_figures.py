"""What a fit shows, keeps and says of its damping beside its numbers."""

import warnings

import numpy as np
import pytest
from dirty_record import dirty_record

import ropedyn as rd

BOTH = ["tension", "bending_stiffness"]
ROPE = rd.Rope(2.0, 0.5, bending_stiffness=8.0)
TRUE = rd.Scene(ROPE, tension=1000.0, ends=("pinned", "pinned"))
GUESS = TRUE.replace(tension=800.0, rope=ROPE.replace(bending_stiffness=4.0))
PEAKS = rd.Peaks(TRUE.compile().modes(7).frequency, std=0.02)


@pytest.fixture(scope="module")
def fit():
    return rd.identify(GUESS, PEAKS, BOTH, orders=range(1, 8))


def ambiguous():
    with pytest.warns(rd.IdentifyWarning, match="ambiguous"):
        every_second = rd.Peaks(np.asarray(PEAKS.frequency)[1::2], std=0.02)
        return rd.identify(GUESS.replace(tension=500.0), every_second, BOTH)


# --- figures ------------------------------------------------------------------------------------


def test_the_figure_of_the_budget_shows_the_interval_of_the_tension(fit):
    ax = fit.plot(of="budget")
    assert ax.get_xlabel() == "tension [N]"
    low, high = fit.interval(0.95)["tension"]
    left, right = ax.get_xlim()
    assert left < low < high < right


def test_the_figure_of_the_ends_shows_their_likelihood(fit):
    drawn = fit.plot(of="ends")
    assert drawn.get_lines() or drawn.patches or drawn.collections


def test_there_is_no_figure_of_ends_that_were_given():
    given = rd.identify(GUESS, PEAKS, BOTH, orders=range(1, 8), ends="given")
    with pytest.raises(rd.SceneError, match="of"):
        given.plot(of="ends")
    with pytest.raises(rd.SceneError, match=r"of must be one of .*everything"):
        given.plot(of="everything")


# --- files --------------------------------------------------------------------------------------


def test_a_file_keeps_candidates_with_their_intervals(tmp_path):
    fit = ambiguous()
    fit.save(tmp_path / "fit.nc")
    again = rd.load(tmp_path / "fit.nc")
    assert again.status == "ambiguous" and len(again.candidates) == len(fit.candidates)
    for one, other in zip(again.candidates, fit.candidates):
        assert one.probability == other.probability
        np.testing.assert_array_equal(one.orders, other.orders)
        np.testing.assert_array_equal(one.interval(0.95), other.interval(0.95))
    np.testing.assert_array_equal(again.interval(0.95), fit.interval(0.95))
    assert again.to_json() == fit.to_json()


def test_a_fit_says_of_which_record_it_is():
    record, truth = dirty_record(902, duration=200.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rd.IdentifyWarning)
        fit = rd.identify(truth.scene, record, BOTH, prior={"tension": (truth.tension, 5e5)})
    assert fit.record["rate"] == pytest.approx(record.rate)
    assert fit.record["channels"] == list(record.labels)
    assert fit.record["notes"] == list(record.notes)


# --- damping ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changed",
    [
        {"damping": rd.LossFactor(0.05)},
        {"damping": rd.ViscousDamping(3.0)},
        {"parts": [rd.Dashpot(0.63, 6.0)]},
    ],
    ids=["loss factor", "viscous", "dashpot"],
)
def test_frequencies_that_damping_moves_tell_the_numbers(changed):
    """Peaks of a noise-free damped response, which a fit of natural frequencies would miss."""
    lines = np.linspace(1.0, 160.0, 4000)
    damped = TRUE.replace(**changed)
    peaks = rd.Peaks.of(damped.compile().frf(lines, drive=("z", 0.27)))
    orders = range(1, len(peaks.frequency) + 1)
    with warnings.catch_warnings():
        # noise-free peaks are so well known that the model of the peaks shows
        warnings.simplefilter("ignore", rd.IdentifyWarning)
        guess = GUESS.replace(**changed)
        found = rd.identify(guess, peaks, BOTH, orders=orders, ends="given")
    np.testing.assert_allclose(found.value, [1000.0, 8.0], rtol=1e-6)


def test_the_damping_ratios_of_peaks_tell_damping_beside_the_tension():
    damped = TRUE.replace(damping=rd.StiffnessDamping(2e-4))
    modes = damped.compile().modes(7, damped=True)
    ratio = modes.damping_ratio
    peaks = rd.Peaks(
        modes.natural_frequency, std=0.02, damping_ratio=ratio, damping_ratio_std=ratio / 50
    )
    guess = GUESS.replace(damping=rd.StiffnessDamping(1e-3))
    sought = [*BOTH, "damping.gamma"]
    found = rd.identify(guess, peaks, sought, orders=range(1, 8), ends="given")
    assert found.value["damping.gamma"] == pytest.approx(2e-4, rel=1e-6)
    low, high = found.interval(0.95)["damping.gamma"]
    assert low < 2e-4 < high
