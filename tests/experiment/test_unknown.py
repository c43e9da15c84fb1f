"""Numbers that are sought: tied ones, and nuisances that are known with an uncertainty."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.experiment.fitting.minimum import Point
from ropedyn.experiment.fitting.misfit import PeakMisfit, PriorMisfit
from ropedyn.experiment.fitting.natural_frequencies import NaturalFrequencies
from ropedyn.experiment.fitting.solution import Task
from ropedyn.experiment.fitting.unknown import Unknowns

TIE = ("ends[0].spring.beta", "ends[1].spring.beta")
NAME = "ends[0].spring.beta = ends[1].spring.beta"
BOTH = ["tension", "bending_stiffness"]


def scene(T, B, c, other=None, **more):
    """A rope between equal springs, or not."""
    ends = [rd.End(beta="free", spring={"beta": each}) for each in (c, other or c)]
    return rd.Scene(rd.Rope(2.0, 0.5, bending_stiffness=B), tension=T, ends=ends, **more)


TRUE, GUESS = scene(1000.0, 8.0, 60.0), scene(900.0, 5.0, 30.0, 50.0)
PINNED = TRUE.replace(ends=("pinned", "pinned"))
F = TRUE.compile().modes(8).frequency
PEAKS = rd.Peaks(F, std=1e-4 * F, order=range(1, 9))


def test_tied_springs_are_one_number_found_from_peaks():
    fit = rd.identify(GUESS, PEAKS, [*BOTH, TIE])
    assert fit.unknown == (*BOTH, NAME)
    np.testing.assert_allclose(fit.value, [1000.0, 8.0, 60.0], rtol=1e-9)
    assert [end.spring["beta"] for end in fit.scene.ends] == [fit.value[NAME]] * 2
    low, high = fit.interval()[NAME]
    assert low < 60.0 < high
    again = rd.identify(GUESS, PEAKS, [*BOTH, NAME])
    np.testing.assert_array_equal(again.value, fit.value)


def test_tied_springs_are_found_from_the_lowest_modes_without_orders():
    fit = rd.identify(GUESS, rd.Peaks(F, std=1e-4 * F), [*BOTH, TIE])
    np.testing.assert_allclose(fit.value, [1000.0, 8.0, 60.0], rtol=1e-9)


def test_many_ropes_are_tied_alike():
    fits = rd.identify(GUESS, [PEAKS, PEAKS], [*BOTH, TIE])
    np.testing.assert_allclose(fits.value, [[1000.0, 8.0, 60.0]] * 2, rtol=1e-9)


def test_tied_springs_are_found_from_a_response():
    frequency = np.linspace(5.0, 90.0, 300)
    points = {"drive": ("z", 0.5), "response": ("z", 0.8)}
    frf = TRUE.replace(damping=rd.LossFactor(0.05)).compile().frf(frequency, **points)
    measured = rd.Measured(frequency, frf.value, **points)
    guess = GUESS.replace(damping=rd.LossFactor(0.03))
    fit = rd.identify(guess, measured, [*BOTH, TIE, "damping.eta"])
    np.testing.assert_allclose(fit.value, [1000.0, 8.0, 60.0, 0.05], rtol=1e-9)


def test_slopes_of_tied_numbers_are_sums():
    calculated = NaturalFrequencies.of(Unknowns.of(GUESS, [TIE, "tension"]))
    u, step = np.array([[0.3, 0.1]]), 1e-4
    _, slope = calculated(u, 4)
    for i in range(2):
        up, down = (calculated(u + way * step * np.eye(2)[i], 4)[0] for way in (1, -1))
        # central differences over 1e-4 are off by 1e-8
        np.testing.assert_allclose(slope[..., i], (up - down) / (2 * step), rtol=1e-7)


def test_what_is_known_of_one_place_is_known_of_the_number():
    prior = {"ends[1].spring.beta": (50.0, 1e-6)}
    fit = rd.identify(GUESS, PEAKS, [*BOTH, TIE], prior=prior)
    assert fit.value[NAME] == pytest.approx(50.0, rel=1e-6)


def test_what_is_known_together_moves_together():
    """Peaks of a string tell T/m; how far T is known then hangs on the correlation of both."""
    string = rd.Scene(rd.Rope(2.0, 0.5), tension=1000.0)
    peaks = rd.Peaks([11.18, 22.36], std=1e-7, order=[1, 2])
    prior = rd.Prior(
        {"tension": (1000.0, 100.0), "linear_density": (0.5, 0.05)},
        covariance=np.outer([100.0, 0.05], [100.0, 0.05]) * [[1.0, 0.9], [0.9, 1.0]],
    )
    apart = rd.Prior(dict(prior))
    paths = ["tension", "linear_density"]
    found = [rd.identify(string, peaks, paths, prior=one) for one in (prior, apart)]
    # peaks tell ln T - ln m, both known to s; ln T + ln m has the variance 2 s^2 (1 + r), and half
    # of its std is that of ln T
    s = np.sqrt(np.log1p(0.1**2))
    r = np.log1p(0.9 * 0.1**2) / s**2
    for fit, correlated in zip(found, (r, 0.0)):
        expected = s * np.sqrt((1 + correlated) / 2)
        assert fit.std["tension"] / fit.value["tension"] == pytest.approx(expected, rel=1e-4)


def with_mass(prior):
    """Tension and stiffness with a mass known by weighing, fitted with it as a nuisance."""
    unknowns = Unknowns.of(PINNED, BOTH).with_nuisances(prior)
    f, orders = PINNED.compile().modes(8).frequency[None], np.arange(1, 9)[None]
    misfit = PeakMisfit(NaturalFrequencies.of(unknowns), f, 1e-4 * f, orders)
    known = PriorMisfit.of(unknowns, prior)
    task = Task(unknowns, misfit, 8, known, np.ones(1))
    row = np.zeros(1, dtype=np.intp)
    solution, failed = task.solve(row, Point.of(misfit, row, np.zeros((1, len(unknowns)))))
    assert not failed
    return unknowns, solution


def test_a_mass_that_is_not_sought_widens_the_tension():
    unknowns, solution = with_mass(rd.Prior({"linear_density": (0.5, 0.01)}))
    assert unknowns.paths == (*BOTH, "linear_density")
    assert (unknowns.shown, unknowns.hidden) == (2, 1)
    f = PINNED.compile().modes(8).frequency
    alone = rd.identify(PINNED, rd.Peaks(f, std=1e-4 * f, order=range(1, 9)), BOTH, ends="given")
    s = np.sqrt(np.log1p(0.02**2))
    expected = np.hypot(alone.std / alone.value, s)
    found = (solution.std / solution.value)[0, : unknowns.shown]
    # both go with the mass, as T/m and B/m are told
    np.testing.assert_allclose(found, expected, rtol=1e-3)
    half = np.diff(np.log(solution.interval(0.95)[0, 0]))[0] / 2
    # u is a logarithm: T is log-normal with the mass
    assert half == pytest.approx(1.959964 * expected[0], rel=1e-3)


def test_what_is_sought_is_no_nuisance():
    unknowns = Unknowns.of(GUESS, [TIE])
    assert unknowns.with_nuisances(["ends[1].spring.beta"]) is unknowns
    more = unknowns.with_nuisances(["length", "ends[0].spring.beta"])
    assert more.paths == (NAME, "length")
    assert more.only(np.array([False, True])).hidden == 1


@pytest.mark.parametrize(
    ("unknown", "kind", "message"),
    [
        ([("tension", "bending_stiffness")], rd.SceneError, "unknown[0] must tie numbers of one"),
        ([("length", "parts[0].x")], rd.SceneError, "unknown[0] must tie numbers of one kind"),
        ([TIE, TIE[0]], rd.SceneError, "unknown must be different paths"),
        ([(TIE[0], TIE[0])], rd.SceneError, "unknown must be different paths"),
        (["tension", ("tension", 3)], TypeError, "unknown[1][1] must be paths such as"),
        ([{"tension"}], TypeError, "unknown[0] must be paths such as"),
        ([("ends[0].spring.beta", "ends[1].spring.z")], rd.SceneError, "unknown[0] must tie"),
        ([("parts[0].mass", "parts[1].mass")], rd.SceneError, "unknown[0]: path must be that of"),
    ],
)
def test_what_cannot_be_tied_is_refused(unknown, kind, message):
    with pytest.raises(kind) as caught:
        rd.identify(TRUE, PEAKS, unknown)
    assert message in str(caught.value)


def test_a_nuisance_that_is_not_there_is_named():
    with pytest.raises(rd.SceneError, match=r"prior\['parts\[0\].mass'\]: path must be"):
        Unknowns.of(TRUE, BOTH).with_nuisances(["parts[0].mass"])


def test_a_log_normal_prior_of_a_negative_guess_is_refused():
    strut = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=10.0), tension=-5.0)
    with pytest.raises(rd.SceneError, match="must be of the sign of the scene's guess"):
        rd.identify(
            strut,
            [40.0, 150.0],
            "tension",
            ends="given",
            orders=[1, 2],
            prior={"tension": (5.0, 1.0)},
        )
