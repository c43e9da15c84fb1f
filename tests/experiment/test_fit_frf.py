"""Identification from whole frequency responses."""

import numpy as np
import pytest
from conftest import slow

import ropedyn as rd
from ropedyn.experiment.identify.fit_frf import line_std

LINES = np.linspace(5.0, 250.0, 150)
POINTS = [("z", 0.33), ("z", 1.1)]
UNKNOWN = ["tension", "bending_stiffness", "damping.gamma"]


def rope(tension, bending, gamma, **more):
    """A clamped rope."""
    return rd.Scene(
        rd.Rope(2.0, 0.3, bending_stiffness=bending),
        tension=tension,
        damping=rd.StiffnessDamping(gamma),
        **more,
    )


TRUTH = rope(1000.0, 5.0, 3e-4)
GUESS = rope(300.0, 20.0, 3e-5)
NEAR = rope(980.0, 5.5, 2e-4)
"""Where what is tested is not how the way is found."""


def measured(scene, *, lines=LINES, response=POINTS, quantity="accelerance", noise=None, factor=1):
    """The response of a scene, with complex noise of these standard deviations over the value."""
    frf = scene.compile().frf(lines, drive=POINTS[0], response=response, quantity=quantity)
    value = factor * frf.value + (0 if noise is None else noise(frf.value))
    return rd.Measured(lines, value, drive=POINTS[0], response=tuple(response), quantity=quantity)


def complex_noise(rng, shape):
    """Of standard deviation 1 in the real and in the imaginary part."""
    return rng.standard_normal(shape) + 1j * rng.standard_normal(shape)


def off(fit, scene, paths=UNKNOWN):
    """Relative errors of what was found."""
    from ropedyn.scene.path import value_at

    return np.abs(np.array([fit.value[p] / value_at(scene, p) - 1 for p in paths])).max()


@pytest.mark.claim(
    "T, B and damping from a whole noise-free response, guesses off by factors of 3 to 10",
    reference="what it was computed with",
    accepted=1e-13,
)
@pytest.mark.parametrize("quantity", ["receptance", *slow("mobility", "accelerance")])
def test_numbers_are_found_from_an_exact_response(quantity, claim):
    fit = rd.identify(GUESS, measured(TRUTH, quantity=quantity), UNKNOWN)
    claim(off(fit, TRUTH))
    assert off(fit, fit.scene) == 0
    assert fit.notes == ()


def test_guess_may_be_so_wrong_that_no_peak_overlaps_another():
    """The tension is off by 30, the bending stiffness by 20, the damping by 10."""
    fit = rd.identify(rope(30.0, 100.0, 3e-5), measured(TRUTH), UNKNOWN)
    assert off(fit, TRUTH) < 1e-8


def test_modes_below_the_first_line_do_not_mislead():
    data = measured(TRUTH, lines=np.linspace(60.0, 250.0, 120), response=POINTS[:1])
    assert off(rd.identify(rope(500.0, 20.0, 1e-4), data, UNKNOWN), TRUTH) < 1e-8


def test_modes_with_a_node_where_it_is_watched_do_not_mislead():
    """At the middle every second mode is not there."""
    lines, middle = LINES, ("z", 1.0)
    frf = TRUTH.compile().frf(lines, drive=middle)
    data = rd.Measured(lines, frf.value, drive=middle, response=middle)
    assert off(rd.identify(GUESS, data, UNKNOWN), TRUTH) < 1e-8


@pytest.mark.parametrize("factor", [-30.0, *slow(2.5e-4)])
def test_calibration_may_be_unknown(factor):
    fit = rd.identify(GUESS, measured(TRUTH, factor=factor), [*UNKNOWN, "calibration"])
    assert off(fit, TRUTH) < 1e-8
    assert fit.unknown == (*UNKNOWN, "calibration")
    assert abs(fit.value["calibration"] / factor - 1) < 1e-8
    np.testing.assert_allclose(fit.calculated, fit.measured, rtol=1e-7)


def test_numbers_of_ends_and_parts_are_found():
    soft = rd.End(beta="free", spring={"beta": 30.0})
    truth = rope(1000.0, 5.0, 3e-4, ends=(soft, "clamped"), parts=[rd.PointMass(0.7, 0.05)])
    other = rd.End(beta="free", spring={"beta": 5.0})
    guess = rope(1000.0, 5.0, 3e-4, ends=(other, "clamped"), parts=[rd.PointMass(0.6, 0.02)])
    paths = ["ends[0].spring.beta", "parts[0].mass", "parts[0].x"]
    assert off(rd.identify(guess, measured(truth), paths), truth, paths) < 1e-8


def test_chain_is_fitted_as_it_is():
    """By differences, which chains have in place of exact derivatives."""
    truth = rd.Scene(rd.Rope(2.0, 0.3), tension=1e3, damping=rd.ViscousDamping(1.0))
    lines = np.linspace(5.0, 60.0, 40)
    value = truth.compile(elements=12).frf(lines, drive=POINTS[0]).value
    data = rd.Measured(lines, value, drive=POINTS[0], response=POINTS[0])
    guess = truth.replace(tension=900.0, damping=rd.ViscousDamping(3.0))
    paths = ["tension", "damping.coefficient"]
    assert off(rd.identify(guess, data, paths, elements=12), truth, paths) < 1e-8


# --- noise ------------------------------------------------------------------------------------


def equal(rng):
    """Noise that is equal on all lines: 2 % of the mean amplitude."""
    return lambda value: 0.02 * np.abs(value).mean() * complex_noise(rng, value.shape)


def proportional(rng):
    """Noise in proportion to the amplitude: 5 %."""
    return lambda value: 0.05 * np.abs(value) * complex_noise(rng, value.shape)


def both(rng):
    """Noise of both kinds."""
    return lambda value: equal(rng)(value) + proportional(rng)(value)


@pytest.mark.parametrize(
    ("noise", "trials"),
    [(both, 4), *(pytest.param(one, 60, marks=pytest.mark.slow) for one in (equal, proportional))],
)
def test_standard_deviations_are_those_of_many_trials(noise, trials):
    """Of the errors of n trials and 2 numbers over their std the rms is 1 +- 1/sqrt(4 n)."""
    truth = rd.Scene(rd.Rope(2.0, 0.3), tension=1e3, damping=rd.ViscousDamping(2.0))
    guess = truth.replace(tension=990.0, damping=rd.ViscousDamping(3.0))
    lines, paths = np.linspace(5.0, 120.0, 80), ["tension", "damping.coefficient"]
    z = []
    for seed in range(trials):
        rng = np.random.default_rng(seed)
        data = measured(truth, lines=lines, response=POINTS[:1], noise=noise(rng))
        fit = rd.identify(guess, data, paths)
        z.append((np.asarray(fit.value) - [1e3, 2.0]) / np.asarray(fit.std))
    rms = np.sqrt(np.mean(np.square(z)))
    assert abs(rms - 1) < 4 / np.sqrt(4 * trials)


def test_noise_is_shared_out_to_its_kinds():
    rng = np.random.default_rng(1)
    clean = measured(TRUTH, lines=np.linspace(5.0, 250.0, 4000))
    for noise in (equal(rng), proportional(rng)):
        added = noise(clean.value[:1])
        true = np.full(4000, 0.02 * np.abs(clean.value[0]).mean())
        if noise.__qualname__.startswith("proportional"):
            true = 0.05 * np.abs(clean.value[0])
        std = line_std(
            rd.Measured(
                clean.frequency, clean.value[:1], drive=clean.drive, response=clean.response[:1]
            ),
            added,
        )[0]
        assert np.median(np.abs(np.log(std / true))) < 0.05


def test_coherence_tells_which_lines_are_noisy():
    rng = np.random.default_rng(2)
    exact = measured(TRUTH, response=POINTS[:1])
    coherence = np.where(LINES < 120.0, 0.999, 0.2)[None]
    coherence[0, 40] = 0.0
    size = np.sqrt((1 - coherence) / np.maximum(coherence, 1e-3) / 20)
    value = exact.value * (1 + size * complex_noise(rng, exact.value.shape))
    value[0, 40] *= 100
    plain, weighted = (
        rd.Measured(
            LINES,
            value,
            drive=POINTS[0],
            response=POINTS[:1],
            quantity="accelerance",
            coherence=told,
        )
        for told in (None, coherence)
    )
    fits = [rd.identify(NEAR, data, UNKNOWN) for data in (plain, weighted)]
    assert np.isinf(fits[1].measured_std[0, 40])
    assert fits[1].std["tension"] < fits[0].std["tension"] / 3
    z = (np.asarray(fits[1].value) - [1000.0, 5.0, 3e-4]) / np.asarray(fits[1].std)
    assert np.abs(z).max() < 4


def test_what_is_no_noise_is_noted():
    """A mass that the model knows nothing of."""
    truth = rope(1000.0, 5.0, 3e-4, parts=[rd.PointMass(0.7, 0.05)])
    with pytest.warns(rd.IdentifyWarning, match="response 1 differs from the model by more than"):
        fit = rd.identify(NEAR, measured(truth), UNKNOWN)
    assert fit.notes


def test_what_is_known_beforehand_counts():
    """Density, tension and bending act as ratios unless the response is calibrated."""
    rng = np.random.default_rng(3)
    data = measured(TRUTH, noise=equal(rng), factor=2.0)
    paths = [*UNKNOWN, "linear_density"]
    prior = {"linear_density": (0.3, 1e-4)}
    fit = rd.identify(NEAR, data, [*paths, "calibration"], prior=prior)
    assert abs(fit.value["linear_density"] - 0.3) < 1e-6
    assert fit.std["linear_density"] == pytest.approx(1e-4, rel=1e-2)
    assert abs(fit.value["calibration"] / 2 - 1) < 4 * fit.std["calibration"] / 2


# --- the answer -------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def noisy():
    """A fit of a response with noise."""
    return rd.identify(NEAR, measured(TRUTH, noise=equal(np.random.default_rng(4))), UNKNOWN)


def test_intervals_are_symmetric_where_numbers_are_well_told(noisy):
    by_profile, linear = noisy.interval(), noisy.interval(method="linear")
    width = np.ptp(np.asarray(linear), axis=1)
    np.testing.assert_allclose(by_profile, linear, atol=0.05 * width.max(), rtol=1e-2)
    assert (np.abs(noisy.correlation) <= 1).all()


def test_fit_reads_as_tables_and_a_figure(noisy, tmp_path):
    assert "tension" in str(noisy)
    assert "z at 0.330 m" in noisy.report()
    sums = [(np.abs(one) ** 2).sum(axis=1) for one in (noisy.residual, noisy.measured)]
    off = noisy.lines.column("off, rms over rms")
    assert off == pytest.approx(np.sqrt(sums[0] / sums[1]), rel=1e-12)
    ax = noisy.plot()
    assert len(ax.lines) == 2 * len(POINTS)
    assert "identified: tension" in ax.get_title()
    noisy.save(tmp_path / "fit.nc")
    again = rd.load(tmp_path / "fit.nc")
    assert again.value["tension"] == noisy.value["tension"]
    np.testing.assert_array_equal(again.residual, noisy.residual)
    np.testing.assert_array_equal(again.interval(0.99), noisy.interval(0.99))
    with pytest.raises(rd.SceneError, match="level must be one of"):
        again.interval(0.7)
    assert again.scene == noisy.scene


def test_a_line_at_0_hz_of_a_free_beam_is_left_out():
    beam = rd.Scene(
        rd.Rope(1.0, 0.5, bending_stiffness=20.0),
        ends=("free", "free"),
        damping=rd.LossFactor(0.01),
    )
    lines, ends = np.arange(0.0, 200.0, 2.0), ("z", 0.0)
    value = beam.compile().frf(lines[1:], drive=ends, quantity="accelerance").value
    data = rd.Measured(
        lines, np.insert(value, 0, 0.1, axis=1), drive=ends, response=ends, quantity="accelerance"
    )
    guess = beam.replace(rope=beam.rope.replace(bending_stiffness=30.0))
    fit = rd.identify(guess, data, ["bending_stiffness", "damping.eta"])
    assert fit.frequency[0] == 2.0
    assert fit.value["bending_stiffness"] == pytest.approx(20.0, rel=1e-8)


def test_a_damping_that_is_not_there_has_an_upper_bound():
    lines = np.linspace(5.0, 80.0, 80)
    true = rope(1000.0, 3.0, 1e-3)
    rng = np.random.default_rng(0)
    data = measured(true, lines=lines, noise=lambda v: 1e-3 * v * rng.normal(size=v.shape))
    both = (rd.StiffnessDamping(3e-3), rd.ViscousDamping(0.01))
    paths = ["damping[0].gamma", "damping[1].coefficient"]
    with pytest.warns(rd.IdentifyWarning, match="goes to 0: the response does not show it"):
        fit = rd.identify(true.replace(damping=both), data, paths)
    low, high = fit.interval(0.95)["damping[1].coefficient"]
    # 0.01 N s/m^2 broadens the first peak by 5 %: far more than noise of 0.1 % hides
    assert fit.value["damping[1].coefficient"] == low == 0
    assert 0 < high < 0.01


def test_notes_speak_of_the_response():
    data = measured(TRUTH, noise=lambda value: 1e-3 * value)
    with pytest.warns(rd.IdentifyWarning, match="the response cannot tell tension, bending"):
        fit = rd.identify(
            TRUTH, data, ["tension", "bending_stiffness", "linear_density", "calibration"]
        )
    assert any("what the response tells is" in note for note in fit.notes)


# --- what is refused --------------------------------------------------------------------------


def test_what_has_no_meaning_is_refused():
    data = measured(TRUTH)
    with pytest.raises(rd.SceneError, match='orders must be "auto" of a whole response, got'):
        rd.identify(GUESS, data, UNKNOWN, orders=[1, 2])
    with pytest.raises(rd.SceneError, match="unknown must not have 'calibration' of peaks"):
        rd.identify(GUESS, [10.0, 20.0], ["tension", "calibration"])
    with pytest.raises(rd.SceneError, match='ends must be "given" of a whole response'):
        rd.identify(GUESS, data, UNKNOWN, ends="unknown")
    few = rd.Measured([20.0], [1e-3], drive=POINTS[0], response=POINTS[0])
    with pytest.raises(rd.SceneError, match="measured must have more lines that are not 0 for 3"):
        rd.identify(GUESS, few, UNKNOWN)
    twisting = GUESS.replace(rope=GUESS.rope.replace(torsional_stiffness=1.0, polar_inertia=1e-6))
    with pytest.raises(rd.SceneError, match=r"unknown\[0\] must change the response that was mea"):
        rd.identify(twisting, data, ["torsional_stiffness"])
