"""Tracking: the walk against dense linear algebra, what it covers, and what is left out."""

import types
import warnings

import numpy as np
import pytest
from scipy import stats

import ropedyn as rd
from ropedyn.experiment.track import tracking
from ropedyn.experiment.track.walk import Seen, _back, _mixed, _pairs, walk

SCENE = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
DAYS = np.array([0.0, 1.0, 1.0, 2.5, 4.0, 4.5])
OWN = 1e-3 * np.array([1.0, 0.7, 1.3, 1.0, 0.8, 1.1])
Y = 7.0 + 1e-3 * np.array([0.0, 1.2, -0.4, 2.1, np.nan, 3.0])


# the walk


def dense(day, y, own, covariate, step, scatter):
    """Mean and covariance of level and what is seen of it, and ln likelihood: all matrices full."""
    n, told = len(day), np.isfinite(y)
    walked = step**2 * np.minimum.outer(day - day[0], day - day[0])
    regressors = np.column_stack([np.ones(n), *covariate])
    k, x = (walked + np.diag((scatter * own) ** 2))[np.ix_(told, told)], regressors[told]
    inverse = np.linalg.inv(k)
    precision = x.T @ inverse @ x
    covariance = np.linalg.inv(precision)
    b = covariance @ x.T @ inverse @ y[told]
    gain = walked[:, told] @ inverse
    mean = regressors @ b + gain @ (y[told] - x @ b)
    share = regressors - gain @ x
    var = np.diag(walked - gain @ walked[told]) + np.einsum("ik,kl,il->i", share, covariance, share)
    rest = y[told] - x @ b
    determinants = np.linalg.slogdet(k)[1] + np.linalg.slogdet(precision)[1]
    return mean, np.sqrt(var), -0.5 * (determinants + rest @ inverse @ rest)


@pytest.mark.parametrize("theta", [(), (np.array([1.0, -0.5, 0.3, 0.9, -1.2, 0.1]),)])
def test_walk_of_given_step_is_that_of_full_matrices(theta):
    told, zero = np.isfinite(Y), np.zeros(len(Y))
    columns = np.column_stack([np.where(told, Y - 7.0, 0.0), zero, zero + 1.0, *theta])
    seen = Seen(np.diff(DAYS, prepend=DAYS[0]), columns, OWN, 5 * OWN, told)
    pairs = _pairs(seen, np.geomspace(1e-4, 1e-2, 3))
    expected = [dense(DAYS, Y - 7.0, OWN, theta, s, k) for s, k in zip(*pairs[:2])]
    ln_w = np.array([ln for _, _, ln in expected]) + np.log(pairs.step)
    # ln likelihoods of about 30: 1e-14 measured
    np.testing.assert_allclose(np.log(pairs.weight[0] / pairs.weight), ln_w[0] - ln_w, atol=1e-12)
    for i, (mean, std, _) in enumerate(expected):
        one = pairs.take(np.arange(len(expected)) == i)
        found, own, _ = _mixed(columns[:, 2:], *_back(seen, one), one)
        # 8e-18 of 1e-3 measured, and 6e-13 where a small step is the rest of large ones
        np.testing.assert_allclose(found, mean, atol=5e-16)
        np.testing.assert_allclose(own, std, rtol=2e-11)


def test_what_all_days_share_stays_however_many_there_are():
    for n in (2, 10, 200):
        found = walk(np.arange(float(n)), np.zeros(n), np.full(n, 1e-3), np.full(n, 0.02))
        # of two days that agree up to half of the variance may be anew on each
        assert (found.std > (0.0199 if n > 2 else 0.014)).all()
        assert (found.std < 0.0201).all()
        assert (found.own_std < (2e-3 if n > 2 else 0.01)).all()


def test_scatter_tells_how_much_of_what_is_unknown_is_anew_each_day():
    rng = np.random.default_rng(4)
    n = 100
    found = walk(np.arange(float(n)), rng.normal(0, 0.012, n), np.full(n, 1e-3), np.full(n, 0.02))
    # the standard deviation of 100 numbers is known to 7 %
    assert found.scatter == pytest.approx(12.0, rel=0.2)
    assert found.own_std.max() < 0.005
    # .012^2 + .016^2 = .02^2
    assert np.median(found.std) == pytest.approx(0.016, rel=0.1)


def test_days_that_share_errors_of_different_size_do_not_tell_them():
    rng = np.random.default_rng(5)
    n, common = 60, np.tile([0.03, 0.02], 30)
    y = common + rng.normal(0, 1e-4, n)
    assert (walk(np.arange(float(n)), y, np.full(n, 1e-4), common).std > 0.019).all()


def test_constant_tension_is_known_as_the_mean_of_all_days():
    rng = np.random.default_rng(6)
    n = 400
    found = walk(np.arange(n, dtype=float), rng.normal(0, 1e-3, n), np.full(n, 1e-3))
    # the flat prior of the step leaves up to 4 times the standard deviation of the mean
    assert found.own_std.max() < 4 * 1e-3 / np.sqrt(n)
    assert found.step[0] < 1e-3 / np.sqrt(n)


def test_a_day_far_from_its_neighbours_is_seen():
    rng = np.random.default_rng(7)
    y = rng.normal(0, 1e-3, 40)
    y[11] += 0.1
    off = np.abs(walk(np.arange(40.0), y, np.full(40, 1e-3)).off)
    assert off.argmax() == 11
    assert off[11] > 6 > np.delete(off, [10, 11, 12]).max()


def made(rng, n, ratio, understated):
    """A walk, and what is inside of how it is found: own, whole, coefficient of the covariate."""
    t, own = np.cumsum(rng.exponential(1.0, n)), 1e-3 * np.exp(rng.normal(0.0, 0.3, n))
    theta = 10 * np.sin(t / 3) + rng.normal(0, 3, n)
    x = np.cumsum(1e-3 * ratio * rng.normal(size=n) * np.sqrt(np.diff(t, prepend=t[0])))
    x += 3e-4 * theta
    z = np.sqrt(1e-4 - (1e-3 * understated) ** 2) * rng.normal()
    y = x + z + understated * own * rng.normal(size=n)
    found = walk(t, y, own, np.full(n, 1e-2), theta)
    return [
        np.mean(np.abs(found.mean - x - z) < 1.96 * found.own_std),
        np.mean(np.abs(found.mean - x) < 1.96 * found.std),
        abs(found.coefficient[0] - 3e-4) < 1.96 * found.coefficient[1],
    ]


def covered(seed, walks, understated, ns=(6, 12, 30), ratios=(0.1, 0.5, 1.0, 3.0)):
    """Shares of days whose truth is inside 95 %: without and with what is common, coefficients."""
    rng, found = np.random.default_rng(seed), []
    for n in ns:
        for ratio in ratios:
            found += [made(rng, n, ratio, understated) for _ in range(walks)]
    return np.mean(found, axis=0)


def test_intervals_of_walks_cover():
    own, whole, coefficient = covered(101, 6, 1.0)
    # 72 walks, whose common error is one number each: std .026
    assert own > 0.93
    assert whole > 0.88
    assert coefficient > 0.88


def excess(inside, count, low, high):
    """How far outside low .. high the share is beyond its 99 % binomial interval."""
    interval = stats.binomtest(round(inside * count), count).proportion_ci(0.99)
    return max(low - interval.high, interval.low - high, 0.0)


@pytest.mark.slow
@pytest.mark.claim(
    "Walks of 6 to 30 days, steps .1 to 3 times the noise: how far the 99 % interval of what 95 % "
    "intervals cover is outside .93 to .99, worst of tension and coefficient of temperature",
    reference="simulated walks, seed 2024, 1200 of them",
    accepted=0.0,
)
def test_intervals_of_many_walks_cover(claim):
    shares = covered(2024, 100, 1.0)
    claim(max(excess(share, 1200, 0.93, 0.99) for share in shares))


@pytest.mark.slow
@pytest.mark.claim(
    "The same where the records scatter five times as much as their peaks say: shortfall from .90",
    reference="simulated walks, seed 2025, 1200 of them",
    accepted=0.0,
)
def test_intervals_of_walks_with_understated_noise_cover(claim):
    claim(max(0.0, *(0.90 - share for share in covered(2025, 100, 5.0))))


# the verb


def fit(tension=1000.0, half_width=0.02, peaks=0.002, status="trusted"):
    """What `track` reads of a fit."""
    interval = tension * np.exp(np.array([-half_width, half_width]))
    return types.SimpleNamespace(
        status=status,
        value={"tension": tension},
        interval=lambda level: {"tension": interval},
        budget={"peaks": peaks, "ends": half_width},
    )


@pytest.fixture
def tracked(monkeypatch):
    """Track fits as if they had just been identified."""
    monkeypatch.setattr(tracking, "identify", lambda scene, one, paths, **options: one)
    return lambda fits, **options: rd.track(SCENE, fits, **options)


def test_own_and_common_parts_of_a_fit_make_its_whole_interval(tracked):
    track = tracked([fit()] * 50)
    assert track.measured_std[0] == pytest.approx(1000.0 * 0.002 / 1.96, rel=1e-4)
    half = np.log(track.interval(0.95)[:, 1] / track.tension)
    # what 50 records leave of their own part is below a tenth of the common one
    np.testing.assert_allclose(half, 0.02, rtol=0.01)
    assert (np.log(track.interval(0.95, common=False)[:, 1] / track.tension) < 0.0021).all()


def test_records_that_are_not_trusted_are_left_out_and_named(tracked):
    fits = [fit(), fit(4000.0, status="ambiguous"), fit(), fit(status="refused"), fit()]
    track = tracked(fits, time=[0.0, 1.0, 2.0, 3.5, 4.0])
    assert track.status == ("trusted", "ambiguous", "trusted", "refused", "trusted")
    assert track.notes[:2] == (
        "record 1 (day 1) left out: ambiguous",
        "record 3 (day 3.5) left out: refused",
    )
    assert np.isnan(track.measured).tolist() == [False, True, False, True, False]
    np.testing.assert_allclose(track.tension, 1000.0, rtol=1e-12)
    # between two records the walk may have gone further
    assert track.own_std[1] > max(track.own_std[0], track.own_std[2])


def test_an_open_interval_is_left_out(tracked):
    wide = fit()
    wide.interval = lambda level: {"tension": np.array([900.0, np.inf])}
    track = tracked([fit(), wide, fit()])
    assert "record 1 (day 1) left out: its tension is told from 900 to inf N only" in track.notes


def test_a_record_with_other_orders_is_named(tracked):
    rng = np.random.default_rng(8)
    fits = [fit(1000.0 * np.exp(rng.normal(0, 1e-3))) for _ in range(30)]
    track = tracked([*fits[:9], fit(1250.0), *fits[9:]])
    (note,) = [note for note in track.notes if "off what the others say" in note]
    assert note.startswith("record 9 (day 9) is ")


def test_scatter_beyond_the_peaks_is_named_and_contained(tracked):
    rng = np.random.default_rng(9)
    fits = [fit(1000.0 * np.exp(rng.normal(0, 3e-3)), half_width=0.002) for _ in range(40)]
    track = tracked(fits)
    assert any(note.startswith("records scatter ") for note in track.notes)
    assert track.scatter == pytest.approx(3.0, rel=0.3)
    # what ends leave open would explain it
    ends = tracked([fit(float(one), half_width=0.02) for one in track.measured])
    assert not ends.notes


def test_temperature_is_taken_out_of_the_level(tracked):
    rng = np.random.default_rng(10)
    warm = 15 + 8 * np.sin(np.arange(40) / 4)
    tension = 1000.0 * np.exp(-0.002 * (warm - warm.mean()) + rng.normal(0, 1e-3, 40))
    track = tracked([fit(one) for one in tension], temperature=warm)
    low, high = track.coefficient_interval
    assert low < -0.002 < high
    # 40 records of .1 %, temperatures of 5.7 K rms: .1 %/5.7/sqrt(40) = .003 % for a constant level
    assert high - low < 2e-4
    np.testing.assert_allclose(track.level, 1000.0, rtol=2e-3)
    assert "temperature -0." in track.report()


def test_dates_become_days_and_come_back(tracked):
    dates = np.datetime64("2024-03-01T06:00") + np.array([0, 12, 36]) * np.timedelta64(1, "h")
    track = tracked([fit()] * 3, time=dates)
    assert track.time.tolist() == [0.0, 0.5, 1.5]
    assert (track.dates() == dates).all()
    assert track.table().column("time")[1] == "2024-03-01T18:00:00"


def test_a_track_is_saved_and_loaded(tracked, tmp_path):
    track = tracked([fit(), fit(1010.0), fit()], temperature=None)
    track.save(tmp_path / "track.nc")
    loaded = rd.load(tmp_path / "track.nc")
    assert str(loaded.report()) == track.report()
    assert loaded.interval().tolist() == track.interval().tolist()


@pytest.mark.parametrize("since", [None, np.datetime64("2024-03-01") + np.arange(4)])
def test_a_track_is_drawn(tracked, since):
    ax = tracked([fit(), fit(1010.0), fit(status="refused"), fit()], time=since).plot()
    assert ax.get_ylabel() == "tension [N]"
    assert "left out" in [text.get_text() for text in ax.get_legend().get_texts()]


def test_records_of_a_string_are_tracked():
    tension = np.array([1000.0, 1020.0, 1010.0, 1030.0])
    base = np.sqrt(tension / 0.1) / 4.0
    peaks = [rd.Peaks([f, 2 * f, 3 * f], std=1e-3 * f, order=[1, 2, 3]) for f in base]
    done = []
    track = rd.track(SCENE, peaks, progress=done.append)
    assert done == [0.25, 0.5, 0.75, 1.0]
    assert (np.abs(track.measured - tension) < 0.1 * track.measured_std).all()
    low, high = track.interval().T
    assert ((low < tension) & (tension < high)).all()
    again = rd.track(SCENE, list(track.fits))
    assert again.tension.tolist() == track.tension.tolist()


def test_a_record_that_fails_is_named_and_warnings_stay_with_fits():
    peaks = [rd.Peaks([25.0, 50.0, 75.0], std=0.1, order=[1, 2, 3])] * 3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        track = rd.track(SCENE, [*peaks, [1e200, 2e200]])
    assert track.status[3] == "failed"
    assert track.fits[3] is None
    assert "record 3 (day 3) left out: measured[0] must be between" in track.notes[0]


BAD = {
    "no list": ({"measured": 3.0}, TypeError, "measured must be a list of records"),
    "no tension": ({"unknown": "bending_stiffness"}, rd.SceneError, 'must have "tension" among'),
    "short time": ({"time": [0.0]}, rd.SceneError, "time must have 3 values, one for each"),
    "time back": ({"time": [0.0, 2.0, 1.0]}, rd.SceneError, r"got 1.0 after 2.0 at time\[2\]"),
    "one time": ({"time": [1.0, 1.0, 1.0]}, rd.SceneError, "time must differ between records"),
    "NaT": ({"time": np.array(["NaT"] * 3, "M8[D]")}, rd.SceneError, "time must be dates"),
    "NaN": ({"temperature": [1.0, np.nan, 2.0]}, rd.SceneError, r"temperature\[1\] must be a"),
    "text": ({"temperature": "warm"}, TypeError, "temperature must be a one-dimensional"),
    "three": ({"temperature": [1.0, 2.0, 3.0]}, rd.SceneError, "at least 4 records that tell"),
    "progress": ({"progress": 3}, TypeError, "progress must be None, True or callable"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_named(tracked, name):
    given, error, message = BAD[name]
    with pytest.raises(error, match=message):
        tracked(**({"fits": given.pop("measured", [fit()] * 3)} | given))


def test_equal_temperatures_and_too_few_records_are_named(tracked):
    with pytest.raises(rd.SceneError, match=r"temperature must differ .*, got 20.0 for all"):
        tracked([fit()] * 5, temperature=[20.0] * 5)
    with pytest.raises(rd.SceneError, match=r"at least 2 .*, got 1: record 0 is refused"):
        tracked([fit(status="refused"), fit()])


def test_a_record_of_the_wrong_type_is_named():
    with pytest.raises(TypeError, match=r"measured\[1\]: "):
        rd.track(SCENE, [rd.Peaks([25.0, 50.0], std=0.1, order=[1, 2]), "text"])


def test_same_input_same_bits():
    one, other = (walk(DAYS, Y, OWN, 5 * OWN) for _ in range(2))
    assert one.std.tobytes() == other.std.tobytes()


@pytest.mark.parametrize("seed", [1, 2])
def test_a_change_is_told_where_nobody_knows_the_ends(seed):
    """Nearly pinned ends explain the peaks of one day and nearly clamped ones those of another."""
    spring = rd.End(beta="free", spring={"beta": 5e6})
    rope = rd.Rope(60.0, 80.0, bending_stiffness=1.5e6)
    cable = rd.Scene(rope, tension=5.0e6, ends=(spring, spring))
    drawn = rd.Scene(rope.replace(bending_stiffness=1.58e6), tension=5.0e6)
    random, orders = np.random.default_rng(seed), np.array([1, 2, 4, 5, 7, 8])
    days = []
    for tension in (5.0e6, 4.9e6):
        frequency = cable.replace(tension=tension).compile().modes(8).frequency[orders - 1]
        std = 6e-4 * frequency
        days.append(rd.Peaks(frequency + random.normal(0.0, std), std=std, order=orders))
    track = rd.track(drawn, days, ends="unknown")
    change = np.log(track.measured[1] / track.measured[0])
    assert abs(change - np.log(0.98)) <= 4 * np.hypot(*track.measured_std) / 5e6 + 2e-3
