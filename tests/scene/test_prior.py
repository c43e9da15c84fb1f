"""Priors: log-normal and correlated numbers, their moments, densities and residuals."""

import math
import pickle

import numpy as np
import pytest
from conftest import EPS
from scipy import integrate, stats

import ropedyn as rd

KNOWN = {"tension": (300.0, 90.0), "gravity.inclination": (0.2, 0.1), "length": (2.0, 0.1)}
CORRELATION = np.array([[1.0, 0.5, -0.4], [0.5, 1.0, 0.1], [-0.4, 0.1, 1.0]])
STD = np.array([std for _, std in KNOWN.values()])
COVARIANCE = CORRELATION * np.outer(STD, STD)
CORRELATED = rd.Prior(KNOWN, covariance=COVARIANCE)
ROWS = np.array([[310.0, 0.25, 1.9], [200.0, -0.3, 2.2], [1000.0, 0.0, 2.0]])


def numeric_slope(prior, row):
    """Central differences, off by 1e-8 of what is curved over 1e-4 of the numbers."""
    step = 1e-5 * np.diag(np.abs(row) + 0.1)
    up, down = (prior.residual(row + way * step)[0] for way in (1, -1))
    return ((up - down) / (2 * np.diagonal(step)[:, None])).T


@pytest.mark.parametrize(
    ("path", "value", "word"),
    [
        ("tension", 300.0, "log-normal"),
        ("tension", -300.0, "normal"),
        ("bending_stiffness", 2.0, "log-normal"),
        ("linear_density", 2.0, "log-normal"),
        ("length", 2.0, "log-normal"),
        ("parts[0].mass", 2.0, "log-normal"),
        ("ends[0].spring.beta", 2.0, "log-normal"),
        ("ends[0].spring.beta", -2.0, "normal"),
        ("damping.gamma", 1e-4, "log-normal"),
        ("damping.gamma", 0.0, "normal"),
        ("parts[0].x", 0.5, "normal"),
        ("gravity.inclination", 0.2, "normal"),
        ("lay_coupling", 0.2, "normal"),
    ],
)
def test_what_is_positive_by_its_nature_is_log_normal(path, value, word):
    assert rd.Prior({path: (value, 0.1)}).distribution == {path: word}
    assert rd.Prior({path: (value, 0.1)}, distribution="normal").distribution == {path: "normal"}


def test_draws_have_the_mean_and_covariance_that_were_given():
    n = 400_000
    rows = CORRELATED.draw(np.random.default_rng(18), n)
    # standard errors: std/sqrt(n) of means, sqrt((1 + r^2)/n) of normal covariances, 4 of them;
    # that of a log-normal variance of s = 0.29 is larger by 1.3
    np.testing.assert_allclose(
        (rows.mean(axis=0) - [300.0, 0.2, 2.0]) / STD, 0, atol=4 / math.sqrt(n)
    )
    np.testing.assert_allclose(
        np.cov(rows.T) / np.outer(STD, STD), CORRELATION, atol=4 * 1.3 * math.sqrt(2 / n)
    )
    assert (rows[:, [0, 2]] > 0).all()
    np.testing.assert_array_equal(rows[:5], CORRELATED.draw(np.random.default_rng(18), n)[:5])


def test_density_of_independent_numbers_is_that_of_the_textbook():
    s = math.sqrt(math.log1p(0.3**2))
    tension = stats.lognorm(s, scale=300.0 * math.exp(-(s**2) / 2))
    assert tension.mean() == pytest.approx(300.0, rel=10 * EPS)
    assert tension.std() == pytest.approx(90.0, rel=10 * EPS)
    prior = rd.Prior(KNOWN).marginal(["tension", "gravity.inclination"])
    expected = tension.logpdf(ROWS[:, 0]) + stats.norm(0.2, 0.1).logpdf(ROWS[:, 1])
    np.testing.assert_allclose(prior.log_density(ROWS[:, :2]), expected, rtol=20 * EPS)


def test_density_of_correlated_numbers_is_that_of_their_logarithms():
    """The covariance of g, the logarithms of some, that makes that of the numbers."""
    g = np.column_stack([np.log(ROWS[:, 0]), ROWS[:, 1], np.log(ROWS[:, 2])])
    relative = COVARIANCE / np.outer([300.0, 1.0, 2.0], [300.0, 1.0, 2.0])
    both = np.outer([1, 0, 1], [1, 0, 1])
    covariance = np.where(both, np.log1p(relative * both), relative)
    var = np.diagonal(covariance)
    centre = [math.log(300.0) - var[0] / 2, 0.2, math.log(2.0) - var[2] / 2]
    expected = stats.multivariate_normal(centre, covariance).logpdf(g) - g[:, 0] - g[:, 2]
    np.testing.assert_allclose(CORRELATED.log_density(ROWS), expected, rtol=1e-13)


def test_density_integrates_to_one():
    x = np.linspace(1e-3, 3000.0, 200_001)
    density = np.exp(rd.Prior({"tension": (300.0, 90.0)}).log_density(x[:, None]))
    assert integrate.trapezoid(density, x) == pytest.approx(1, abs=1e-9)


def test_what_is_positive_has_no_density_below_zero():
    rows = ROWS.copy()
    rows[1, 0], rows[2, 2] = 0.0, -1.0
    density = CORRELATED.log_density(rows)
    assert np.isfinite(density[0])
    assert (density[1:] == -np.inf).all()


@pytest.mark.parametrize("prior", [CORRELATED, rd.Prior(KNOWN, distribution="normal")])
def test_residuals_are_independent_and_have_their_slopes(prior):
    residual, slope = prior.residual(ROWS)
    for row, each in zip(ROWS, slope):
        np.testing.assert_allclose(each, numeric_slope(prior, row), rtol=1e-8, atol=1e-9)
    # where nothing is log-normal the density is their sum of squares; else of logarithms
    logarithm = np.log(ROWS[:, [0, 2]]).sum(axis=1) if prior is CORRELATED else 0.0
    off = prior.log_density(ROWS) + (residual**2).sum(axis=1) / 2 + logarithm
    np.testing.assert_allclose(off, off[0], atol=1e-12)
    drawn, _ = prior.residual(prior.draw(np.random.default_rng(3), 100_000))
    np.testing.assert_allclose(np.cov(drawn.T), np.eye(3), atol=4 * math.sqrt(2 / 100_000))


def test_a_factor_is_a_standard_deviation_of_the_logarithm():
    prior = rd.Prior.by_factor({"tension": (300.0, 3.0)})
    residual, _ = prior.residual([[100.0], [300.0], [900.0]])
    np.testing.assert_allclose(residual[:, 0], [-1, 0, 1], atol=1e-14)


def test_what_is_joined_knows_nothing_of_each_other():
    left = rd.Prior(KNOWN, covariance=COVARIANCE, distribution="normal")
    both = left | {"length": (3.0, 0.2), "linear_density": (1.0, 0.1)}
    assert list(both) == [*KNOWN, "linear_density"]
    assert both["length"] == (3.0, 0.2)
    expected = np.eye(4)
    expected[:2, :2] = CORRELATION[:2, :2]
    np.testing.assert_allclose(both.correlation, expected, atol=4 * EPS)
    assert list(both.distribution.values()) == ["normal", "normal", "log-normal", "log-normal"]
    assert rd.Prior(KNOWN) | rd.Prior(KNOWN) == rd.Prior(KNOWN)


def test_a_marginal_is_what_draws_of_all_say_of_some():
    some = CORRELATED.marginal(["length", "tension"])
    assert dict(some) == {"length": (2.0, 0.1), "tension": (300.0, 90.0)}
    np.testing.assert_allclose(some.correlation, [[1.0, -0.4], [-0.4, 1.0]], atol=4 * EPS)


def test_priors_are_equal_when_all_they_say_is():
    assert pickle.loads(pickle.dumps(CORRELATED)) == CORRELATED
    assert rd.Prior(KNOWN) != CORRELATED
    assert rd.Prior(KNOWN) != rd.Prior(KNOWN, distribution="normal")
    assert rd.Prior(KNOWN) == KNOWN
    assert eval(repr(CORRELATED), {"Prior": rd.Prior}) == CORRELATED
    normal = rd.Prior(KNOWN, distribution={"tension": "normal"})
    assert eval(repr(normal), {"Prior": rd.Prior}) == normal
    assert repr(rd.Prior(KNOWN)) == f"Prior({KNOWN!r})"


def test_a_table_has_the_correlations():
    table = CORRELATED.table()
    np.testing.assert_allclose(table.column("correlation with tension"), CORRELATION[0], atol=1e-15)
    assert table.column("distribution") == ("log-normal", "normal", "log-normal")
    assert "correlation" not in str(rd.Prior(KNOWN))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"covariance": COVARIANCE[:2]}, "covariance must be finite numbers of shape (3, 3)"),
        ({"covariance": COVARIANCE * math.nan}, "covariance must be finite numbers"),
        (
            {"covariance": COVARIANCE * [[1], [2], [1]]},
            "covariance[1][1] must be the square of prior['gravity.inclination'][1], 0.01, got 0.0",
        ),
        (
            {"covariance": COVARIANCE + np.outer([1, 0, 0], [0, 1, 0])},
            "covariance must be symmetric, got 5.5 at [0][1] and 4.5 at [1][0]",
        ),
        (
            {"covariance": np.outer(STD, STD)},
            "covariance must be positive definite, got one whose correlations have the eigenvalue",
        ),
        ({"distribution": "flat"}, 'distribution must be one of "normal", "log-normal", "laid"'),
        ({"distribution": {"tension": "flat"}}, "distribution['tension'] must be one of"),
        ({"distribution": {"mass": "normal"}}, "key of distribution must be one of"),
        (
            {"known": {"gravity.inclination": (0.0, 0.1)}, "distribution": "log-normal"},
            "prior['gravity.inclination'] must have a mean > 0 and a std between",
        ),
        (
            {
                "known": {"tension": (1.0, 2.0), "length": (1.0, 2.0)},
                "covariance": [[4.0, -3.9], [-3.9, 4.0]],
            },
            "covariance must be one that log-normal numbers can have",
        ),
        ({"known": {"length": (-1.0, 0.1)}}, "prior['length'][0] must be a finite number > 0 [m]"),
    ],
)
def test_what_no_distribution_has_is_refused(given, message):
    with pytest.raises(rd.SceneError) as caught:
        rd.Prior(**{"known": KNOWN} | given)
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "call", "message"),
    [
        (rd.SceneError, lambda p: p.log_density([1.0, 2.0, 3.0]), "values must be rows of 3"),
        (rd.SceneError, lambda p: p.residual(np.ones((2, 2))), "array of shape (2, 2)"),
        (rd.SceneError, lambda p: p.draw(np.random.default_rng(1), 0), "n must be a whole number"),
        (TypeError, lambda p: p.draw(1, 5), "rng must be a numpy.random.Generator"),
        (rd.SceneError, lambda p: p.marginal(["mass"]), 'path must be one of "tension"'),
        (
            rd.SceneError,
            lambda p: rd.Prior.by_factor({"tension": (1.0, 1.0)}),
            "known['tension'][1] must be a factor > 1",
        ),
        (TypeError, lambda p: rd.Prior.by_factor(3), "known must be a mapping such as"),
        (TypeError, lambda p: rd.Prior(KNOWN, covariance=[["a"] * 3] * 3), "covariance must be"),
        (TypeError, lambda p: rd.Prior(KNOWN, distribution=3), "distribution must be one of"),
    ],
)
def test_what_cannot_be_asked_is_refused(kind, call, message):
    with pytest.raises(kind) as caught:
        call(CORRELATED)
    assert message in str(caught.value)


LAID_KNOWN = {
    "axial_stiffness": (9e6, 1.5e6),
    "tension": (3e4, 3e3),
    "lay_coupling": (-1.2e4, 2.1e3),
    "torsional_stiffness": (25.0, 5.0),
}
LAID = dict.fromkeys(("axial_stiffness", "lay_coupling", "torsional_stiffness"), "laid")


def laid():
    """Return a prior of a laid rope, its tension among the numbers."""
    std = np.array([std for _, std in LAID_KNOWN.values()])
    share = np.array(
        [[1, 0.2, -0.9, 0.8], [0.2, 1, -0.1, 0.1], [-0.9, -0.1, 1, -0.85], [0.8, 0.1, -0.85, 1]]
    )
    return rd.Prior(LAID_KNOWN, covariance=share * np.outer(std, std), distribution=LAID)


def test_laid_numbers_have_the_moments_that_were_given():
    prior = laid()
    rows = prior.draw(np.random.default_rng(3), 400_000)
    EA, _, D, C = rows.T
    assert (EA * C > D**2).all() and (D < 0).any()
    # standard errors as of log-normal numbers, 4 of them
    np.testing.assert_allclose((rows.mean(axis=0) - prior.mean) / prior.std, 0, atol=4 / 632)
    np.testing.assert_allclose(np.corrcoef(rows.T), prior.correlation, atol=4 * 2 * 2.3 / 632)
    np.testing.assert_allclose(rows.std(axis=0) / prior.std, 1, atol=4 * 2 / 632)


def test_laid_numbers_have_residuals_slopes_and_a_density():
    prior = laid()
    rows = prior.draw(np.random.default_rng(4), 5)
    z, slope = prior.residual(rows)
    step = 1e-6 * rows[0]
    up, down = (prior.residual(rows[0] + way * np.diag(step))[0] for way in (1, -1))
    # central differences over 1e-6, of residuals of size 1
    assert np.abs((up - down).T / (2 * step) - slope[0]).max() / np.abs(slope[0]).max() < 1e-8
    # the density of z times that of z by the numbers
    size = np.log(np.abs(np.linalg.det(slope)))
    exact = -(z**2).sum(axis=1) / 2 - 2 * math.log(2 * math.pi) + size
    assert np.abs(prior.log_density(rows) - exact).max() < 1e-9
    beyond = rows[:1].copy()
    beyond[0, 3] = beyond[0, 2] ** 2 / beyond[0, 0] / 2
    assert prior.log_density(beyond)[0] == -math.inf


def test_some_laid_numbers_keep_their_moments_alone():
    prior = laid()
    assert prior.marginal(["tension", *LAID]).distribution == {"tension": "log-normal"} | LAID
    part = prior.marginal(["lay_coupling", "torsional_stiffness"])
    assert part.distribution == {"lay_coupling": "normal", "torsional_stiffness": "normal"}
    assert part.std.tolist() == prior.std[2:].tolist()
    assert (prior | {"length": (2.0, 0.1)}).distribution["lay_coupling"] == "laid"
    # each number a variable: of little doubt what the draws have
    std = 0.01 * prior.std
    near = rd.Prior(
        {path: (m, s) for path, m, s in zip(prior, prior.mean, std)},
        covariance=prior.correlation * np.outer(std, std),
        distribution=LAID,
    )
    law = near.law.apart
    rows = near.draw(np.random.default_rng(5), 100_000)
    found = np.cov(np.where(law.by_log, np.log(np.abs(rows)), rows).T)
    size = np.sqrt(np.diagonal(found))
    # standard errors of 1e5 draws, 5 of them
    off = (law.spread @ law.spread.T - found) / np.outer(size, size)
    assert np.abs(off).max() < 5 * math.sqrt(2 / 100_000)
    assert eval(repr(prior), {"Prior": rd.Prior}) == prior
    assert pickle.loads(pickle.dumps(prior)) == prior


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"lay_coupling": "laid"}, "together and of nothing else"),
        (LAID | {"tension": "laid"}, "together and of nothing else"),
        (LAID | {"tension": "normal"}, 'must be "log-normal" of what stands beside laid numbers'),
    ],
)
def test_laid_numbers_stand_together(words, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.Prior(LAID_KNOWN, distribution=words)


def test_moments_that_no_laid_rope_has_are_refused():
    known = LAID_KNOWN | {"torsional_stiffness": (15.0, 5.0)}
    with pytest.raises(rd.SceneError, match="covariance must be one of which ln EA"):
        rd.Prior(known, distribution=LAID)
