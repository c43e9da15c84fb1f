"""What the prior of a construction does to orders and intervals, and that it is said."""

import numpy as np
import pytest
from constructed_ropes import UNKNOWN, constructed, told

import ropedyn as rd

SAID = pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")


def summed(seeds):
    """Return of no prior and of one: right, trusted though wrong, and widths of both relative."""
    found = [told(seed) for seed in seeds]
    right, wrong = (
        [sum(of(one[k]) for one in found) for k in (0, 1)]
        for of in (lambda row: row[1], lambda row: row[0] == "trusted" and not row[1])
    )
    both = [one for one in found if one[0][0] == one[1][0] == "trusted"]
    ratio = np.array([one[1][2] / one[0][2] for one in both])
    inside = np.array([one[1][3] for one in both])
    return right, wrong, ratio, inside


@SAID
def test_a_prior_of_its_construction_harms_no_orders_and_narrows_intervals():
    right, wrong, ratio, inside = summed(range(900, 908))
    assert right[1] >= right[0]
    assert wrong == [0, 0]
    # what is known already cannot widen a linear interval by more than the fit moves
    assert (ratio < 1.2).all() and (np.median(ratio, axis=0) <= 1.0 + 1e-6).all()
    assert inside.mean() > 0.7


@SAID
@pytest.mark.slow
@pytest.mark.claim(
    "4 of 8 peaks, ends known, prior of B from the construction: trusted orders that are wrong",
    reference="100 random ropes of four constructions, B drawn as the catalogue line leaves it",
    accepted=0.05,
)
def test_orders_with_a_prior_of_the_construction_are_rarely_wrong(claim):
    right, wrong, ratio, _ = summed(range(7000, 7100))
    assert right[1] >= right[0]
    assert np.median(ratio, axis=0)[1] <= 1.0
    claim(wrong[1] / 100)


@pytest.mark.parametrize("many", [False, True])
def test_a_report_says_what_the_prior_did(many):
    guess, _, measured, _, prior = constructed(3, 4)
    given = [measured] if many else measured
    fit = rd.identify(guess, given, UNKNOWN, ends="given", prior=prior)
    fit = fit[0] if many else fit
    (said,) = fit.said_of_prior
    assert said.startswith("without the prior of bending_stiffness: orders trusted, these with p")
    without = rd.identify(guess, measured, UNKNOWN, ends="given")
    wide = np.diff(without.interval(0.95)) / np.diff(fit.interval(0.95))
    assert f"95 % of tension {wide[0, 0]:.3g} times as wide" in said
    assert said in fit.report()
    assert without.said_of_prior == ()


def test_a_prior_without_which_nothing_is_told_is_said_so():
    rope = rd.Rope(2.0, 0.1, bending_stiffness=1.0)
    scene = rd.Scene(rope, tension=900.0, ends=("pinned", "pinned"))
    peaks = rd.Peaks(scene.compile().modes(1).frequency, std=0.1, order=[1])
    prior = {"bending_stiffness": (1.0, 0.1)}
    fit = rd.identify(scene, peaks, UNKNOWN, ends="given", prior=prior)
    assert fit.said_of_prior[0].startswith("without the prior of bending_stiffness: measured must")


def test_ropes_that_cannot_be_have_no_part_in_a_fit():
    made = rd.Construction.standard("8x19S", diameter=20e-3)
    section = made.section(radial_stiffness=0.02 * made.section().axial_stiffness)
    rope = rd.Rope.from_construction(4.0, section)
    ends = ("clamped", rd.End(x="free", alpha="free"))
    scene = rd.Scene(rope, tension=0.0, ends=ends).without("bending")
    prior = section.priors(n=1000).marginal(
        ["axial_stiffness", "lay_coupling", "torsional_stiffness"]
    )
    peaks = rd.Peaks(scene.compile().modes(3).frequency, std=0.5, order=[1, 2, 3])
    fit = rd.identify(scene, peaks, list(prior), ends="given", prior=prior)
    EA, D, C = (float(fit.value[path]) for path in prior)
    assert EA * C > D * D
    # the truth is one of the ropes of the prior, told by three exact peaks
    low, high = np.array(fit.interval(0.95)).T
    exact = [rope.axial_stiffness, rope.lay_coupling, rope.torsional_stiffness]
    assert (low < exact).all() and (exact < high).all()
