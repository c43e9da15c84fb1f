"""Many ropes identified side by side: each as if alone, and what became of it."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from given_ends import fitted
from scipy.optimize import least_squares
from test_identify import BOTH, DENSITY, LENGTH, TENSION, noisy, pinned_beam, scene

import ropedyn as rd

ORDERS = list(range(1, 9))
SPRING = "ends[0].spring.beta"


def beams(count, noise, seed=3):
    """Tensions and stiffnesses of pinned ropes and eight peaks of each."""
    random = np.random.default_rng(seed)
    true = np.stack(
        [TENSION * 10 ** random.uniform(-1, 1, count), 10 ** random.uniform(0, 2, count)], axis=1
    )
    exact = np.array([pinned_beam(8, *row) for row in true])
    return true, exact * (1 + noise * random.normal(size=exact.shape))


def peaks_of(frequency, std=None):
    return [rd.Peaks(f, std=None if std is None else std * f, order=ORDERS) for f in frequency]


GUESS = scene(3 * TENSION, 3.0)
TRUE, MEASURED = beams(40, 1e-3)
FITS = fitted(GUESS, peaks_of(MEASURED, 1e-3), BOTH)


def test_ropes_are_where_least_squares_of_the_closed_form_are():
    for fit, f in zip(FITS, MEASURED):
        found = least_squares(
            lambda u, f=f: (pinned_beam(8, *np.exp(u)) / f - 1) / 1e-3,
            np.log([TENSION, 10.0]),
            **dict.fromkeys(("ftol", "xtol", "gtol"), 1e-14),
        )
        # fits end within 1e-4 standard deviations of the minimum
        assert (np.abs(fit.value - np.exp(found.x)) <= 1e-3 * fit.std).all()
        assert fit.chi_square == pytest.approx(2 * found.cost, rel=1e-6)


def test_a_rope_among_others_is_what_it_is_alone():
    intervals, linear = FITS.interval(), FITS.interval(0.9, method="linear")
    for k in (0, 17, 39):
        alone = fitted(GUESS, peaks_of(MEASURED, 1e-3)[k], BOTH)
        # sums over rows may be rounded otherwise
        np.testing.assert_allclose(FITS.value[k], alone.value, rtol=1e-12)
        np.testing.assert_allclose(FITS[k].std, alone.std, rtol=1e-12)
        np.testing.assert_allclose(intervals[k], alone.interval(), rtol=1e-9)
        np.testing.assert_allclose(linear[k], alone.interval(0.9, method="linear"), rtol=1e-12)


@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_threads_and_executors_find_the_same(pool, monkeypatch):
    monkeypatch.setattr("ropedyn.experiment.identify.found.ROPES", 16)
    shares = []
    peaks = peaks_of(MEASURED, 1e-3)
    threaded = fitted(GUESS, peaks, BOTH, threads=3, progress=shares.append)
    assert shares[-1] == 1.0
    with pool(2) as executor:
        sent = fitted(GUESS, peaks, BOTH, executor=executor)
    for fits in (threaded, sent):
        np.testing.assert_array_equal(fits.value, fitted(GUESS, peaks, BOTH, threads=1).value)
        assert fits[3].interval().tolist() == sent[3].interval().tolist()


def test_peaks_of_many_ropes_differ_in_number_orders_and_std():
    f = noisy(pinned_beam(9, TENSION, 2.0), 1e-3, 4)
    given = [
        rd.Peaks(f[:4], std=1e-3 * f[:4]),
        rd.Peaks(f[[1, 3, 6]], order=[2, 4, 7]),
        rd.Peaks(np.delete(f, 3), std=1e-3 * np.delete(f, 3), order=[1, 2, 3, 5, 6, 7, 8, 9]),
    ]
    fits = fitted(scene(400.0, 5.0), given, BOTH)
    assert [fit.orders.tolist() for fit in fits][1:] == [[2, 4, 7], [1, 2, 3, 5, 6, 7, 8, 9]]
    assert fits[0].freedom is None and fits[1].freedom == pytest.approx(1.0)
    for fit, peaks in zip(fits, given):
        alone = fitted(scene(400.0, 5.0), peaks, BOTH)
        np.testing.assert_allclose(fit.value, alone.value, rtol=1e-9)
        assert str(fit.peaks()) == str(alone.peaks())


def test_a_slack_scene_guesses_the_tension_of_each_rope():
    fits = fitted(scene(0.0, 3.0), peaks_of(MEASURED[:5]), BOTH)
    np.testing.assert_allclose(fits.value, FITS.value[:5], rtol=1e-3)


def test_every_rope_says_what_became_of_it(monkeypatch, tmp_path):
    """One that converges, one whose stiffness does not show, one with too few peaks."""
    string = pinned_beam(8, TENSION, 1e-9) * (1 - 1e-4 * np.arange(8))
    given = [*peaks_of([MEASURED[0], string], 1e-3), rd.Peaks([9.0])]
    with pytest.warns(rd.IdentifyWarning, match="rope 1: bending_stiffness goes to 0"):
        fits = fitted(GUESS, given, BOTH)
    assert fits.status == ("trusted", "trusted", "refused")
    assert fits[1].value_is_bound and fits[2] is None and list(fits.failed) == [2]
    # the second takes 17 evaluations
    monkeypatch.setattr("ropedyn.experiment.fitting.minimum.EVALUATIONS", 4)
    fits = fitted(GUESS, given, BOTH)
    assert fits.status == ("trusted", "refused", "refused")
    assert fits.table().column("status") == fits.status
    assert list(fits.failed) == [1, 2] and fits[1] is None
    assert np.isnan(fits.value[1:]).all() and np.isnan(fits.interval()[1:]).all()
    lines = fits.report().splitlines()
    assert lines[0] == "3 ropes: 1 trusted, 2 refused"
    assert lines[1].startswith("rope 1 refused: identification must converge within 8 steps")
    assert lines[2].startswith("rope 2 refused: measured must have at least 2 peaks")
    with pytest.raises(rd.SolveError, match="identification must converge within 8 steps"):
        fitted(GUESS, given[1], BOTH)
    fits.save(tmp_path / "fits.nc")
    again = rd.load(tmp_path / "fits.nc")
    assert again.status == fits.status and again.report() == fits.report()
    assert (again[0].report(), again[0].scene) == (fits[0].report(), fits[0].scene)
    assert again[1] is None and str(again.failed[1]) == str(fits.failed[1])
    monkeypatch.setattr("ropedyn.experiment.identify.fits.MOST_KEPT", 2)
    fits = fitted(GUESS, given, BOTH)
    fits.save(tmp_path / "many.nc")
    again = rd.load(tmp_path / "many.nc")
    np.testing.assert_array_equal(again.interval(), fits.interval())
    with pytest.raises(rd.SceneError, match="a file keeps 2 fits at most, got 3: identify again"):
        again[0]


def test_orders_that_are_said_wrong_are_noted_for_each_rope():
    wrong = [np.append(np.delete(f, 3), 1.1 * f[-1]) for f in MEASURED[:6]]
    with pytest.warns(rd.IdentifyWarning, match="off by more than their std") as caught:
        fits = fitted(GUESS, peaks_of(wrong, 1e-3), BOTH)
    assert fits.notes == tuple(str(one.message) for one in caught)
    assert sum(note.count("rope ") for note in fits.notes) == 6


def test_a_stiff_end_goes_to_infinity_and_says_so():
    clamped = scene(TENSION, 20.0, ("clamped", "pinned")).compile().modes(8).frequency
    start = scene(TENSION, 20.0, (rd.End(beta="free", spring={"beta": 10.0}), "pinned"))
    given = peaks_of([noisy(clamped, 1e-3, seed) for seed in range(8)], 1e-3)
    with pytest.warns(rd.IdentifyWarning):
        fits = fitted(start, given, ["tension", SPRING])
    ends = fits.value[:, 1]
    endless = np.isinf(fits.interval(0.95)[:, 1, 1])
    assert endless.sum() >= 6
    assert fits.status == tuple(np.where(endless, "ambiguous", "trusted"))
    for value, std in zip(ends, fits.std[:, 1]):
        # at the bound, which has no std, or too stiff to be told, or finite by chance of noise
        assert np.isinf(value) == np.isnan(std)
        assert np.isinf(value) or np.isinf(std) or value > 100.0


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
@pytest.mark.parametrize("known", [True, False])
def test_intervals_of_new_ropes_cover_the_truth(known, seed=20251):
    true, measured = beams(400, 1e-3, seed)
    fits = fitted(GUESS, peaks_of(measured, 1e-3 if known else None), BOTH)
    assert set(fits.status) == {"trusted"}
    for method in ("profile", "linear"):
        low, high = np.moveaxis(fits.interval(0.95, method=method), 2, 0)
        share = ((low <= true) & (true <= high)).mean(axis=0)
        # four standard deviations of a share of 95 % of 400
        np.testing.assert_allclose(share, 0.95, atol=4 * np.sqrt(0.95 * 0.05 / 400))


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
def test_profiles_of_a_stiffness_that_hardly_shows_cover_the_truth():
    random = np.random.default_rng(8)
    exact = pinned_beam(8, TENSION, 0.05)
    measured = exact * (1 + 2e-3 * random.normal(size=(300, 8)))
    fits = fitted(GUESS, peaks_of(measured, 2e-3), BOTH)
    assert set(fits.status) == {"trusted"}
    low, high = np.moveaxis(fits.interval(0.95), 2, 0)
    share = ((low <= [TENSION, 0.05]) & (high >= [TENSION, 0.05])).mean(axis=0)
    # at a bound more is covered: three standard deviations of a share of 95 % of 300
    assert (share >= 0.95 - 3 * np.sqrt(0.95 * 0.05 / 300)).all()


def test_a_path_that_no_frequency_depends_on_is_named_for_each_rope():
    string = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=900.0, damping=rd.RayleighDamping(1.0, 0.0))
    fits = fitted(string, [rd.Peaks([10.0]), rd.Peaks([11.0])], "damping.mass")
    assert fits.status == ("refused", "refused")
    assert all(why.startswith("unknown[0] must change natural") for why in fits.failure)


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
def test_an_unknown_end_is_not_left_in_the_worse_of_two_valleys():
    """A spring of 0 and one of infinity are both at the end of a valley: the deeper one counts."""
    clamped, spring = (
        ("clamped", "clamped"),
        (rd.End(beta="free", spring={"beta": 10.0}), "clamped"),
    )
    random = np.random.default_rng(17)
    given = []
    for _ in range(60):
        bending = 10 ** random.uniform(0, 2)
        tension = 10 ** random.uniform(1, 4) * bending / LENGTH**2
        exact = scene(tension, bending, clamped).compile().modes(8).frequency
        given.append(exact * (1 + 1e-3 * random.normal(size=8)))
    fits = fitted(scene(TENSION, 10.0, spring), peaks_of(given, 1e-3), [*BOTH, SPRING])
    without = fitted(scene(TENSION, 10.0, clamped), peaks_of(given, 1e-3), BOTH)
    solved = np.array(fits.status) != "refused"
    assert solved.sum() >= 55
    # a spring more fits no worse; 1e-3 is what the end of a flat valley leaves
    assert (8e6 * (fits.rms**2 - without.rms**2)[solved] < 1e-3).all()
