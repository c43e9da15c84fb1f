"""Peaks of measured responses: frequencies between the lines, with their uncertainty, in noise."""

import numpy as np
import pytest
from damped_ropes import damped_rope
from made_history import made
from scipy.signal import cont2discrete, lfilter
from scipy.special import stdtrit
from test_measured import noisy

import ropedyn as rd
from ropedyn.curves.measured import by_coherence, by_differences

LINES = np.arange(40.0, 170.0, 0.5)  # Hz
POINT = {"drive": ("z", 0.5), "response": ("z", 0.5)}
RNG = np.random.default_rng(7)
QUANTITIES = ["receptance", "mobility", "accelerance"]


def receptance(frequency, modes):
    """Return the sum of modes: frequency [Hz], damping ratio, modal constant [1/kg]."""
    omega = 2 * np.pi * frequency
    return sum(
        a / ((2 * np.pi * f) ** 2 - omega**2 + 2j * ratio * 2 * np.pi * f * omega)
        for f, ratio, a in modes
    )


def with_noise(value, rng, size):
    """Add noise of this standard deviation to real and imaginary part."""
    return value + size * (rng.normal(size=value.shape) + 1j * rng.normal(size=value.shape))


def measured(value, frequency=LINES, quantity="receptance", **changes):
    return rd.Measured(frequency, value, quantity=quantity, **POINT, **changes)


def trials(ratio, share, known, count=120):
    """Return the errors of the peak at about 100 Hz and their stated standard uncertainties."""
    rng = np.random.default_rng(3)
    errors, stated = [], []
    for _ in range(count):
        exact = 100.0 + rng.uniform(-0.25, 0.25)
        modes = [(30.0, 0.01, 0.8), (exact, ratio, 1.0), (190.0, 0.01, -1.2)]
        clean = receptance(LINES, modes) * (2j * np.pi * LINES) ** 2
        size = share * np.abs(clean).max()
        # the coherence of n averages that leaves noise of this size:
        # size^2 = |H|^2 (1 - gamma^2)/(2 n gamma^2)
        coherence = 1 / (1 + 2 * 20 * (size / np.abs(clean)) ** 2)
        more = {"coherence": coherence, "averages": 20} if known else {}
        (peaks,) = measured(with_noise(clean, rng, size), quantity="accelerance", **more).peaks()
        (at,) = np.flatnonzero(np.abs(peaks.frequency - exact) < 3)
        errors.append((peaks.frequency[at] - exact, peaks.damping_ratio[at] - ratio))
        stated.append((peaks.std[at], peaks.damping_ratio_std[at]))
    return np.array(errors), np.array(stated)


@pytest.mark.claim(
    "standard uncertainty of measured peaks: factor between the stated and the true one",
    "120 trials with noise of known size, peaks from 0.06 to 8 lines wide",
    1.3,
)
@pytest.mark.parametrize("known", [False, True], ids=["by_residual", "by_coherence"])
@pytest.mark.parametrize(
    ("ratio", "share"), [(1.5e-4, 1e-2), (1e-3, 1e-3), (5e-3, 3e-2), (0.02, 5e-3)]
)
def test_uncertainty_of_a_peak_is_what_noise_makes_of_it(ratio, share, known, claim):
    errors, stated = trials(ratio, share, known)
    # 120 trials know a standard deviation to 6 %; other modes add a little. Noise that the lines
    # alone tell, 18 numbers less 8 unknowns, makes intervals of Student's t, 2.228/1.960 as wide
    wide = 1.0 if known else stdtrit(10, 0.975) / 1.959964
    factor = wide * np.sqrt(np.mean((errors / stated) ** 2, axis=0))
    claim(np.maximum(factor, 1 / factor).max())


def test_a_peak_narrower_than_a_line_is_found_between_the_lines():
    # lines 682 to 692 Hz of a measured free beam, 1 Hz apart: github.com/ladisk/pyuff (MIT),
    # data/meas_point_1.txt, four digits after the point
    real = [-3.8622, -4.8187, -6.3935, -9.2691, -17.4761, -87.2958]
    real += [23.2352, 10.7653, 7.2007, 5.1363, 4.1837]
    imag = [0.1664, 0.1878, 0.2759, 0.5731, 1.862, 54.2845]
    imag += [2.4937, 0.2277, 0.1063, 0.0855, 0.0632]
    value = np.array(real) + 1j * np.array(imag)
    (peaks,) = measured(value, np.arange(682.0, 693.0), quantity="accelerance").peaks()
    # a circle fit through all three reference points says 687.17
    assert peaks.frequency == pytest.approx([687.17], abs=0.02)
    assert peaks.damping_ratio == pytest.approx([1.5e-4], abs=0.3e-4)
    assert 1e-4 < peaks.std[0] < 1e-2


@pytest.mark.parametrize("quantity", QUANTITIES)
@pytest.mark.parametrize("ratio", [1e-5, 1e-3, 0.1])
def test_one_mode_without_noise_is_found_exactly(quantity, ratio):
    clean = receptance(LINES, [(100.2, ratio, 1.0)])
    clean = clean * (2j * np.pi * LINES) ** QUANTITIES.index(quantity)
    (peaks,) = measured(clean, quantity=quantity).peaks()
    # rounding of the lines, eps of the largest, over the slope that a line's distance makes
    assert peaks.frequency == pytest.approx([100.2], rel=1e-11)
    assert peaks.damping_ratio == pytest.approx([ratio], abs=1e-9)
    assert peaks.std[0] < 1e-8


def test_noise_alone_shows_no_peak():
    for seed in range(6):
        rng = np.random.default_rng(seed)
        slope = 1e-6 * (1 + np.arange(3000) / 1000) * np.exp(1j)
        value = with_noise(slope, rng, 1e-8 * (1 + seed))
        (peaks,) = measured(value, np.arange(3000) + 1.0).peaks()
        assert len(peaks.frequency) == 0


def test_a_broad_peak_in_noise_is_one_peak():
    clean = receptance(LINES, [(100.0, 0.05, 1.0)])
    for seed in range(10):
        noise = 0.01 * np.abs(clean).max()
        (peaks,) = measured(with_noise(clean, np.random.default_rng(seed), noise)).peaks()
        assert peaks.frequency == pytest.approx([100.0], abs=5 * peaks.std[0])


def test_peaks_side_by_side_are_two():
    clean = receptance(LINES, [(100.0, 1e-3, 1.0), (104.0, 1e-3, 0.5)])
    noise = 1e-3 * np.abs(clean).max()
    (peaks,) = measured(with_noise(clean, RNG, noise)).peaks()
    assert (np.abs(peaks.frequency - [100.0, 104.0]) < 4 * peaks.std).all()


def test_a_calculated_response_peaks_at_its_modes():
    scene = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0), tension=1000.0)
    model = scene.replace(damping=rd.ModalDamping(0.005)).compile(elements=32)
    exact = model.modes(5).frequency
    frf = model.frf(np.linspace(10.0, exact[4] * 1.1, 1500), drive=("z", 0.31))
    (peaks,) = frf.peaks()
    # other modes tilt a peak smoothly: that is no noise, and the error says what it is roughly
    assert (np.abs(peaks.frequency - exact) < 6 * peaks.std).all()
    np.testing.assert_allclose(peaks.frequency, exact, rtol=1e-5)


def test_a_peak_with_too_few_lines_lies_anywhere_between_two():
    clean = receptance(LINES[:5], [(41.1, 1e-3, 1.0)])
    (peaks,) = measured(clean, LINES[:5]).peaks()
    assert peaks.frequency == pytest.approx([41.1], rel=1e-6)
    assert peaks.std == pytest.approx([0.5 / np.sqrt(12)])
    assert peaks.damping_ratio_std.tolist() == [np.inf]


@pytest.mark.parametrize("segments", [120, 480])
def test_a_peak_that_a_window_widens_keeps_its_frequency(segments):
    # one mode at 25.13 Hz, 0.1 Hz wide, driven by noise for 120 s: 2 and 8 Hz are four lines
    omega, ratio, step = 2 * np.pi * 25.13, 2e-3, 2e-3
    top, bottom, _ = cont2discrete(([1.0], [1.0, 2 * ratio * omega, omega**2]), step, "zoh")
    force = np.random.default_rng(5).normal(size=60_000)
    motion = lfilter(top.ravel(), bottom, force)
    history = made(step * np.arange(len(force)), motion, force=force)
    (peaks,) = history.frf(segments=segments, band=(5.0, 80.0)).peaks()
    # lines beside the peak are known to leak, which its uncertainty sees
    assert peaks.frequency == pytest.approx([25.13], abs=3 * peaks.std[0])
    assert peaks.std[0] < segments / 240  # a line


def test_noise_by_coherence_is_that_of_the_response():
    found = noisy(127)
    off = found.value[0] - 2e-3
    assert found.averages == pytest.approx(0.53 * 127)
    each = by_coherence(found.value[0], found.coherence[0], found.averages)
    # real and imaginary parts of some 64 lines
    scatter = np.sqrt(np.mean(np.abs(off) ** 2) / 2)
    assert np.sqrt(np.mean(each**2)) == pytest.approx(scatter, rel=0.25)


def test_noise_by_differences_is_that_of_the_response():
    value = with_noise(receptance(LINES, [(100.0, 1e-3, 1.0)]), RNG, 1e-8)
    # beside the peak; a median of some 40 numbers
    beside = by_differences(value)[np.abs(LINES - 100) > 25]
    assert np.median(beside) == pytest.approx(1e-8, rel=0.2)


def test_table_of_resonances_shows_their_uncertainty():
    (peaks,) = measured(receptance(LINES, [(100.2, 1e-3, 1.0)])).peaks()
    assert peaks.table().columns[:2] == ("frequency [Hz]", "std [Hz]")


# peaks of responses of damped ropes: truth are their damped modes


def peaks_of_rope(seed):
    """Return what peaks of a random rope are off by: in std, in half widths, in lines."""
    random = np.random.default_rng(seed)
    scene = damped_rope(random)
    model = scene.compile()
    number = int(random.integers(3, 9))
    undamped = model.modes(number + 4).frequency
    modes = model.modes(number + 6, damped=True)
    exact, ratio = modes.natural_frequency, modes.damping_ratio
    top = (undamped[number - 1] + undamped[number]) / 2
    lines = 10.0 ** random.uniform(-1, 1) * top / np.median(2 * ratio * exact)
    lines = np.linspace(0, top, int(np.clip(lines, 60, 6000)) + 1)[1:]
    points = [("z", scene.rope.length * x) for x in random.uniform(0.03, 0.97, 2)]
    quantity = QUANTITIES[random.integers(3)]
    frf = model.frf(lines, drive=points[0], response=points, quantity=quantity)
    noise = (0.0, 1e-4, 1e-3, 1e-2, 5e-2)[random.integers(5)]
    source = frf
    if noise:
        size = noise * np.abs(frf.value).max(axis=1, keepdims=True)
        value = with_noise(frf.value, random, size)
        source = rd.Measured(lines, value, drive=points[0], response=points, quantity=quantity)
    found = []
    for one in source.peaks():
        assert (one.damping_ratio >= 0).all()
        for f, std in zip(one.frequency, one.std):
            k = np.argmin(np.abs(exact - f))
            off = f - exact[k]
            found.append((noise, off / std, off / (ratio[k] * exact[k]), off / lines[0]))
    return found


def sample_of_peaks(seeds):
    """Return the share of peaks without a mode, and of intervals that hold theirs, in noise."""
    found = np.abs([one for seed in seeds for one in peaks_of_rope(seed)])
    none = (found[:, 2] > 1) & (found[:, 3] > 0.5)
    noisy = ~none & (found[:, 0] > 0)
    clean = ~none & (found[:, 0] == 0)
    covered = found[:, 1] < 1.96
    return np.mean(none), np.mean(covered[noisy]), np.mean(covered[clean]), found[clean, 2]


def test_peaks_of_damped_ropes_are_modes_within_their_intervals():
    false, noisy, clean, off = sample_of_peaks(range(60_000, 60_040))
    assert false == 0
    # some 250 peaks in noise, 95 %: 4 standard deviations of the share
    assert noisy > 0.89
    assert clean > 0.93
    assert np.median(off) < 1e-3  # half widths


@pytest.mark.slow
@pytest.mark.claim(
    "peaks of responses of damped ropes: shares of peaks without a mode, and of 95 % intervals "
    "that miss theirs beyond 5 %",
    "600 random ropes, noise of 0 to 5 %, lines from a tenth to ten a half width; damped modes",
    0.015,
)
def test_peaks_of_many_damped_ropes_are_modes_within_their_intervals(claim):
    false, noisy, clean, _ = sample_of_peaks(range(61_000, 61_600))
    claim(max(false, 0.95 - noisy, 0.95 - clean))


@pytest.mark.parametrize(
    ("modes", "why"),
    [
        ([(100.0, -0.02, 1.0)], "its damping ratio would be -0.02"),
        ([(100.0, 1.5, 1.0), (30.0, 0.3, 1.0)], None),
    ],
)
def test_what_grows_is_no_peak_and_is_named(modes, why):
    (peaks,) = measured(receptance(LINES, modes)).peaks()
    assert len(peaks.frequency) == 0
    if why is None:
        assert peaks.left_out == ()
    else:
        (text,) = peaks.left_out
        assert text.startswith("the maximum at 100 Hz of z at 0.500 m [m/N] is no peak: ")
        assert why in text


def test_neighbours_do_not_move_a_peak():
    # two broad modes beside each other, no noise: as constants beside each other they would be off
    # by a tenth of their half width
    exact = [(80.0, 0.03, 1.0), (100.0, 0.03, -1.0), (125.0, 0.03, 1.0)]
    (peaks,) = measured(receptance(LINES, exact)).peaks()
    off = peaks.frequency - [f for f, _, _ in exact]
    assert (np.abs(off) < 1e-3).all()
    assert (np.abs(off) < 3 * peaks.std).all()


# all responses together


def resonances(frequency, std, ratio=0.0, label="z"):
    n = len(frequency)
    return rd.Resonances(
        label=label,
        frequency=np.array(frequency),
        amplitude=np.ones(n),
        damping_ratio=np.full(n, ratio),
        std=np.broadcast_to(std, n).astype(float),
        damping_ratio_std=np.full(n, 0.1 * ratio),
    )


def test_peaks_of_several_responses_are_their_weighted_means():
    found = rd.Peaks.of([resonances([10.0, 20.0], 0.1, 0.01), resonances([10.1], 0.2, 0.02)])
    # weights 100 and 25; of the ratios 1e6 and 2.5e5
    assert found.frequency == pytest.approx([10.02, 20.0], rel=1e-14)
    assert found.std == pytest.approx([1 / np.sqrt(125), 0.1], rel=1e-14)
    assert found.damping_ratio == pytest.approx([0.012, 0.01], rel=1e-14)


def test_scatter_is_the_uncertainty_where_it_is_more():
    found = rd.Peaks.of([resonances([10.0 + x], 1e-3, 0.01) for x in (0.0, 0.03, 0.06)])
    assert found.frequency == pytest.approx([10.03])
    # standard deviation 0.03 of three
    assert found.std == pytest.approx([0.03 / np.sqrt(3)])


def test_peaks_of_one_response_stay_apart():
    assert len(rd.Peaks.of(resonances([10.0, 10.001], 0.1, 0.01)).frequency) == 2


def test_peaks_farther_than_their_width_are_two():
    assert len(rd.Peaks.of([resonances([x], 1e-3, 0.01) for x in (10.0, 10.2)]).frequency) == 2


def test_peaks_nearer_than_a_line_are_one():
    clean = np.array([receptance(LINES, [(f, 1e-4, 1.0)]) for f in (100.0, 100.3)])
    given = {"drive": ("z", 0.5), "response": [("z", 0.5), ("z", 0.2)]}
    found = rd.Peaks.of(rd.Measured(LINES, clean, **given))
    assert found.frequency == pytest.approx([100.15], abs=0.15)


@pytest.mark.parametrize(
    ("given", "error", "words"),
    [
        ([], rd.SceneError, "at least one peak"),
        (3.0, TypeError, "measured must be"),
        ([3.0], TypeError, r"measured\[0\] must be"),
    ],
)
def test_nothing_to_merge_is_refused(given, error, words):
    with pytest.raises(error, match=words):
        rd.Peaks.of(given)


def test_peaks_know_their_damping():
    assert rd.Peaks([1.0, 2.0], damping_ratio=0.01).damping_ratio == (0.01, 0.01)
    assert rd.Peaks([1.0], damping_ratio=[0.01]).table().columns[-1] == "damping ratio"
    with pytest.raises(rd.SceneError, match="damping_ratio must be one number or 2"):
        rd.Peaks([1.0, 2.0], damping_ratio=[0.1, 0.2, 0.3])
