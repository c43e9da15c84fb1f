"""What effects change and cost: changes by closed forms; nothing depends on the speed."""

import dataclasses
import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.experiment.compare.difference import motions

EPS = np.finfo(float).eps
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
FUNDAMENTAL = math.sqrt(100.0 / 0.1) / 2
LAID = rd.Rope(
    1.35,
    0.1,
    bending_stiffness=1.5,
    torsional_stiffness=0.15,
    polar_inertia=1.4e-7,
    rotary_inertia=1e-6,
    lay_slope=0.02,
)
BEAM = rd.Rope(1.2, 0.1, bending_stiffness=1.5, rotary_inertia=2e-5)
TWISTED = BEAM.replace(torsional_stiffness=0.2, polar_inertia=1e-6)
PINNED = ("pinned", "pinned")


def cost(scene, question, **how):
    return rd.effect_cost(scene, question, **{"repeat": 1} | how)


def row(answer, effect):
    return answer.effect.tolist().index(effect)


def changes(answer, effect):
    return {name: value[row(answer, effect)] for name, value in answer.change.items()}


# modes


def test_a_mass_that_halves_the_first_frequency_of_a_string():
    # a mass m in the middle: cot(x) = x m/(mu L), f = 2 x/pi f0: x = pi/4 for m = 4 mu L/pi; the
    # second mode has its node there
    loaded = STRING.replace(parts=[rd.PointMass(0.5, 0.1 * 4 / math.pi)])
    answer = cost(loaded, rd.ask.modes(2))
    half = FUNDAMENTAL / 2
    right = (half, half / math.sqrt(2), 100.0, 100.0 / math.sqrt(2), 0.0)
    # a difference of two frequencies, each right to a few eps
    found = list(changes(answer, "point mass").values())
    np.testing.assert_allclose(found, right, rtol=32 * EPS)
    assert answer.beyond_error.tolist() == [False, True]


@pytest.mark.parametrize("elements", [None, 256])
def test_the_share_of_rotary_inertia_on_a_pinned_beam(elements):
    tension, k = 300.0, np.arange(1, 6)
    answer = cost(rd.Scene(BEAM, tension=tension, ends=PINNED), rd.ask.modes(5), elements=elements)
    # omega^2 = (B q^4 + T q^2)/(mu + j q^2), q = k pi/L
    q = k * math.pi / BEAM.length
    stiffness = BEAM.bending_stiffness * q**4 + tension * q**2
    before, after = (
        np.sqrt(stiffness / (BEAM.linear_density + j * q**2)) / (2 * math.pi)
        for j in (BEAM.rotary_inertia, 0.0)
    )
    largest = changes(answer, "rotary inertia")["largest [Hz]"]
    at = row(answer, "rotary inertia")
    assert largest == pytest.approx((after - before).max(), abs=answer.error[at])
    # the error bars say something: of this change of 0.4 Hz at least three digits are right
    assert answer.error[at] < 1e-3 * largest
    assert answer.beyond_error[at]


def test_twist_that_nothing_couples_changes_no_bit_of_transverse_modes():
    answer = cost(rd.Scene(TWISTED, tension=300.0), rd.ask.modes(8))
    for effect in ("twist", "polar inertia"):
        assert set(changes(answer, effect).values()) == {0.0}
    families = rd.Scene(TWISTED, tension=300.0).compile().modes(8).family
    twists = np.count_nonzero(families == "torsional")
    assert 0 < twists < 8
    assert answer.only_with[row(answer, "twist")] == twists
    assert answer.beyond_error[row(answer, "twist")]


def test_bending_is_all_there_is_of_transverse_modes():
    answer = cost(rd.Scene(TWISTED.replace(polar_inertia=1e-9)), rd.ask.modes(4))
    at = row(answer, "bending")
    assert (answer.only_with[at], answer.beyond_error[at]) == (4, True)
    assert np.isnan(list(changes(answer, "bending").values())).all()


def test_partners_are_found_where_other_modes_have_come_between():
    # without tension the transverse modes lie so low that the torsional one is the seventh
    scene = rd.Scene(TWISTED, tension=3000.0, ends=PINNED)
    assert scene.compile().modes(3).family.tolist().count("torsional") == 1
    bare = scene.without("tension").compile().modes(9).family.tolist()
    assert bare.index("torsional") == 6
    answer = cost(scene, rd.ask.modes(3))
    assert answer.only_with[row(answer, "tension")] == 0
    # that of the second transverse mode, not of one with the torsional mode
    q = 2 * math.pi / BEAM.length
    right = math.sqrt(3000.0 * q**2 + 1.5 * q**4) - math.sqrt(1.5 * q**4)
    right /= 2 * math.pi * math.sqrt(BEAM.linear_density + BEAM.rotary_inertia * q**2)
    found = changes(answer, "tension")["largest [Hz]"]
    assert found == pytest.approx(right, rel=64 * EPS)


@pytest.mark.parametrize("lay", [None, 0.02])
def test_a_twist_without_inertia_has_no_modes(lay):
    rope = LAID.replace(lay_slope=lay)
    scene = rd.Scene(rope, tension=300.0, parts=[rd.PointMass(0.5, 0.1)])
    disc = scene.replace(parts=[rd.PointMass(0.5, 0.1, polar_inertia=1e-7)])
    twists = np.count_nonzero(scene.compile().modes(16).family == "torsional")
    for one, kept in ((scene, 0), (disc, 1)):
        answer = cost(one, rd.ask.modes(16))
        assert answer.only_with[row(answer, "polar inertia")] == twists - kept > 0


@dataclasses.dataclass
class Shares:
    """Modes of which only the share of twist in the kinetic energy is known."""

    twist: list

    coordinates = ("z", "alpha", "beta")

    @property
    def frequency(self):
        return np.array(self.twist)

    @property
    def energy(self):
        twist = np.array(self.twist)
        return {"z": 0.9 * (1 - twist), "alpha": twist, "beta": 0.1 * (1 - twist)}


@pytest.mark.parametrize(
    ("twist", "torsional"),
    [
        ([0.01, 0.98, 0.02], [1]),
        ([0.55, 0.45], [0]),
        ([0.45, 0.55], [1]),
        ([0.49, 0.49, 0.01], [1]),  # mixed, most of either is transverse
        ([0.52, 0.51, 0.98], [0, 2]),
        ([], []),
    ],
)
def test_of_two_mixed_modes_one_is_torsional(twist, torsional):
    assert np.flatnonzero(motions(Shares(twist)) == "torsional").tolist() == torsional


def test_modes_that_lay_mixes_are_compared_with_what_they_were():
    # the torsional frequency is put on the second transverse one: both modes are half twist
    laid = LAID.replace(rotary_inertia=None, polar_inertia=1e-12)
    second = rd.Scene(laid, tension=300.0).compile().modes(2).frequency[1]
    # C as the tilted section has it, 1/C' = (1/C + H^2/B)/(1 + H^2); f = sqrt(C'/p)/2L
    H, B, C = laid.lay_slope, laid.bending_stiffness, laid.torsional_stiffness
    polar = (1 + H**2) / (1 / C + H**2 / B) / (2 * laid.length * second) ** 2
    scene = rd.Scene(laid.replace(polar_inertia=polar), tension=300.0)
    energy = scene.compile().modes(6).energy["alpha"]
    assert np.count_nonzero((energy > 0.2) & (energy < 0.8)) == 2
    answer = cost(scene, rd.ask.modes(6))
    at = row(answer, "lay")
    assert answer.only_with[at] == 0
    # compared with the wrong modes, neighbours are 20 % and more away
    assert 0 < changes(answer, "lay")["largest [%]"] < 5


def test_modes_below_a_limit_are_compared_one_by_one():
    answer = cost(rd.Scene(BEAM, tension=300.0), rd.ask.modes(below=200.0))
    number = len(rd.Scene(BEAM, tension=300.0).compile().modes(below=200.0).frequency)
    other = cost(rd.Scene(BEAM, tension=300.0), rd.ask.modes(number))
    for name in answer.change:
        assert answer.change[name].tolist() == other.change[name].tolist()


def test_damping_changes_no_undamped_frequency_but_its_damping_ratio():
    scene = rd.Scene(BEAM, damping=rd.StiffnessDamping(1e-4))
    answer = cost(scene, rd.ask.modes(3))
    *frequency, ratio = changes(answer, "stiffness damping").values()
    assert set(frequency) == {0.0}
    assert answer.matters[row(answer, "stiffness damping")] == "yes: damping ratio"
    # of the third mode, gamma omega/2: shares of an energy whose sum is 1 to a few eps
    highest = 2 * math.pi * scene.compile().modes(3).frequency[2]
    assert ratio == pytest.approx(1e-4 * highest / 2, rel=64 * EPS)


def test_a_dashpot_changes_the_damping_ratio_of_the_mode_that_it_is_at():
    # first order: c phi^2/(2 omega M), phi = 1 and M = mu L/2 in the middle of a string; where the
    # second mode stands still it does nothing
    answer = cost(STRING.replace(parts=[rd.Dashpot(0.5, 0.01)]), rd.ask.modes(2))
    omega = 2 * math.pi * FUNDAMENTAL
    ratio = changes(answer, "dashpot")["damping ratio [1]"]
    assert ratio == pytest.approx(0.01 / (0.1 * omega), rel=64 * EPS)


def test_damping_ratios_that_are_not_given_are_not_compared():
    answer = cost(STRING.replace(damping=rd.ModalDamping([0.01, 0.03])), rd.ask.modes(3))
    assert changes(answer, "modal damping")["damping ratio [1]"] == 0.03


# what the rope carries

FEATHER = rd.Resonator(0.3, 1e-12, 1.3 * FUNDAMENTAL)
BRISTLE = rd.BrokenWire(0.7, 0.05, 1e-5, radius=0.0)


@pytest.mark.parametrize("elements", [None, 20])  # with a node where the resonator stands
def test_the_mode_of_a_light_resonator_is_only_there_with_it(elements):
    scene = STRING.replace(parts=[FEATHER, FEATHER])
    assert scene.compile().modes(3).frequency[0] == pytest.approx(FUNDAMENTAL, rel=1e-9)
    answer = cost(scene, rd.ask.modes(5), elements=elements)
    at = row(answer, "resonator")
    assert answer.only_with[at] == 2
    # of its neighbours the change is of the order of the mass ratio, 1e-11; those of another order
    # are 20 % and more away
    assert changes(answer, "resonator")["largest [%]"] < 1e-7


def test_of_two_modes_that_a_resonator_makes_of_one_the_other_is_compared():
    # in the middle of the half wave: f (1 -+ sqrt(m/(mu L/2))/2), right to the mass ratio
    tuned = rd.Resonator(0.5, 1e-8, FUNDAMENTAL)
    answer = cost(STRING.replace(parts=[tuned]), rd.ask.modes(2))
    assert answer.only_with[row(answer, "resonator")] == 1
    split = FUNDAMENTAL * math.sqrt(1e-8 / 0.05) / 2
    assert changes(answer, "resonator")["largest [Hz]"] == pytest.approx(split, rel=1e-3)


def test_a_wire_keeps_its_modes_when_a_resonator_goes():
    scene = STRING.replace(parts=[FEATHER, BRISTLE])
    modes = scene.compile().modes(6)
    own = [int((modes.energy[f"{kind} mass"] > 0.5).sum()) for kind in ("resonator", "broken wire")]
    assert own == [1, 2]
    answer = cost(scene, rd.ask.modes(6))
    for effect, number in zip(("resonator", "broken wire"), own):
        assert answer.only_with[row(answer, effect)] == number
        # both weigh 1e-6 of the rope at most
        assert changes(answer, effect)["largest [%]"] < 0.01


# frequency response


def test_a_spring_of_nine_times_the_static_stiffness_is_20_decibel():
    # in the middle of a string 4 T/L, with the spring ten times as much
    scene = STRING.replace(parts=[rd.Spring(0.5, 9 * 400.0)])
    answer = cost(scene, rd.ask.frf([0.0], drive=("z", 0.5)))
    found = changes(answer, "spring")
    assert found["largest [dB]"] == pytest.approx(20.0, rel=32 * EPS)
    assert found["median [dB]"] == found["largest [dB]"]
    assert math.isnan(found["peak shift [Hz]"])


def test_levels_and_peaks_are_those_of_the_two_responses():
    question = rd.ask.frf(np.linspace(5.0, 100.0, 200), drive=("z", 0.3))
    scene = rd.Scene(BEAM, tension=300.0, damping=rd.StiffnessDamping(1e-4))
    scene = scene.replace(parts=[rd.PointMass(0.5, 0.004)])
    whole, left = (question.of(s.compile()) for s in (scene, scene.without("point mass")))
    level = np.abs(20 * np.log10(np.abs(left.value / whole.value)))
    found = changes(cost(scene, question), "point mass")
    # two ways to the logarithm of a ratio: 20 log10 is right to some 1e-14
    assert found["largest [dB]"] == pytest.approx(level.max(), abs=1e-12)
    assert found["median [dB]"] == pytest.approx(np.median(level), abs=1e-12)
    one, other = whole.peaks()[0], left.peaks()[0]
    largest = one.amplitude.argmax()
    assert found["peak shift [Hz]"] == other.frequency[largest] - one.frequency[largest] > 0
    # without tension all peaks lie so low that the nearest one is another
    assert math.isnan(changes(cost(scene, question), "tension")["peak shift [Hz]"])


def test_a_response_that_only_lay_drives_is_lost_without_it():
    lines = np.linspace(10.0, 90.0, 5)
    scene = rd.Scene(LAID, tension=300.0)
    answer = cost(scene, rd.ask.frf(lines, drive=("z", 0.3), response=[("z", 0.5), ("alpha", 0.5)]))
    at = row(answer, "lay")
    assert (answer.only_with[at], answer.beyond_error[at]) == (1, True)
    # of the other one the level is known
    alone = cost(scene, rd.ask.frf(lines, drive=("z", 0.3), response=("z", 0.5)))
    # the rope is cut at other places: a few eps of the responses, of the levels ten times that
    assert answer.largest[at] == pytest.approx(alone.largest[at], abs=1e-12)
    assert (alone.largest[at] > 0, alone.only_with[at]) == (True, 0)


def test_a_response_that_is_zero_by_symmetry_is_there_with_a_mass_off_the_middle():
    question = rd.ask.frf([20.0, 33.0], drive=("z", 0.6), response=("beta", 0.6))
    middle, off = (rd.Scene(BEAM, tension=300.0, parts=[rd.PointMass(x, 0.01)]) for x in (0.6, 0.4))
    answer = cost(off, question)
    at = row(answer, "point mass")
    assert (answer.only_with[at], math.isnan(answer.largest[at])) == (1, True)
    with_none = cost(middle, question)
    assert (with_none.largest[at], with_none.only_with[at]) == (0.0, 0)
    assert not with_none.beyond_error[at]


def test_several_drives_are_all_compared():
    drives = [("z", 0.3), ("alpha", 0.3)]
    scene = rd.Scene(TWISTED, tension=300.0)
    answer = cost(scene, rd.ask.frf([20.0, 30.0], drive=drives))
    alone = [cost(scene, rd.ask.frf([20.0, 30.0], drive=one)) for one in drives]
    at = row(answer, "polar inertia")
    assert answer.largest[at] == alone[1].largest[at] > 0
    assert alone[0].largest[at] == 0.0


# error bars


def test_a_change_within_the_error_of_the_mesh_is_none():
    scene = rd.Scene(BEAM.replace(rotary_inertia=1e-9), tension=300.0)
    coarse, fine = (cost(scene, rd.ask.modes(3), elements=n) for n in (8, None))
    at = row(fine, "rotary inertia")
    assert (coarse.largest[at] > 0, coarse.beyond_error[at]) == (True, False)
    assert coarse.matters[at] == "none beyond mesh and rounding"
    assert (fine.beyond_error[at], fine.matters[at]) == (True, "yes: frequency")
    assert fine.largest[at] > fine.error[at]


@pytest.mark.parametrize(
    "question", [rd.ask.modes(4), rd.ask.frf([20.0, 33.0], drive=("z", 0.3))], ids=["modes", "frf"]
)
def test_a_change_within_rounding_is_none(question):
    scene = STRING.replace(parts=[rd.PointMass(0.37, 1e-18)])
    answer = cost(scene, question)
    at = row(answer, "point mass")
    assert not answer.beyond_error[at]
    assert answer.matters[at] == "none beyond rounding"
    assert answer.table().column("changes the answer")[at + 1] == "none beyond rounding"


# rows


def test_unknowns_are_those_of_what_was_solved():
    scene = rd.Scene(TWISTED, tension=300.0)
    modes = cost(scene, rd.ask.modes(3), elements=16)
    frf = cost(scene, rd.ask.frf([20.0], drive=("z", 0.3)), elements=16)
    # 15 nodes move in z, alpha and beta; a response in z asks nothing of alpha
    assert (modes.unknowns_with, frf.unknowns_with) == (45, 30)
    named = dict(zip(modes.effect.tolist(), zip(modes.unknowns_without, frf.unknowns_without)))
    assert named["bending"] == (30, 15)
    assert named["twist"] == (30, 30)
    assert named["rotary inertia"] == (45, 30)


def test_what_leaves_nothing_to_ask_is_a_row_with_the_reason():
    scene = rd.Scene(TWISTED, tension=300.0)
    answer = cost(scene, rd.ask.frf([20.0], drive=("alpha", 0.3)))
    refused = answer.refusal != ""
    assert answer.effect[refused].tolist() == ["twist"]
    assert "drive[0] must be a coordinate the scene has" in answer.refusal[refused][0]
    assert answer.matters[row(answer, "twist")] == "no answer without it"
    for numbers in (answer.seconds_without, answer.error, answer.share, *answer.change.values()):
        assert np.isnan(numbers[refused]).all()
    assert not answer.beyond_error[refused].any()
    table = answer.table()
    assert table.rows[row(answer, "twist") + 1][3:-1] == (None,) * (len(table.columns) - 4)


def test_a_string_without_tension_is_a_row_with_the_reason():
    answer = cost(STRING, rd.ask.modes(1))
    assert answer.effect.tolist() == ["tension"]
    assert answer.refusal[0].startswith("rope must have a stiffness or the scene a tension")


def test_what_a_chain_has_too_few_modes_for_is_a_row_with_the_reason():
    scene = rd.Scene(TWISTED.replace(rotary_inertia=None), tension=300.0)
    answer = cost(scene, rd.ask.modes(10), elements=8)
    assert answer.refusal[row(answer, "twist")].startswith("number must be at most 7")


def test_the_scene_itself_must_have_an_answer():
    with pytest.raises(rd.SceneError, match="question must have an answer, got modes below 1 Hz"):
        cost(STRING, rd.ask.modes(below=1.0))
    with pytest.raises(rd.SolveError, match="resonance"):
        cost(STRING.replace(ends=("free", "free")), rd.ask.frf(0.0, drive=("z", 0.5)))


@pytest.mark.parametrize("how", [{}, {"elements": 16}, {"elements": 16, "element": "rigid"}])
def test_the_way_is_that_of_compile(how):
    answer = cost(STRING, rd.ask.modes(1), solver="lapack" if how else "sweep", **how)
    model = STRING.compile(**how)
    assert answer.elements == len(model.x) - 1
    assert answer.way == (f"{model.element}, 16, lapack" if how else "continuous")
    assert answer.cost.unknowns == model.size


def test_rows_are_the_effects_of_the_scene():
    scene = rd.Scene(LAID, tension=300.0, parts=[rd.PointMass(0.5, 0.1), rd.Hinge(0.7)])
    answer = cost(scene, rd.ask.modes(2))
    assert tuple(answer.effect) == scene.effects
    assert answer.table().column("left out") == ("nothing", *scene.effects)


def test_progress_takes_growing_fractions_up_to_one():
    fractions = []
    cost(rd.Scene(BEAM, tension=300.0), rd.ask.modes(1), repeat=2, progress=fractions.append)
    # three effects; then twice what compiles and what asks, of the whole and without each
    assert fractions == [*np.arange(1, 4) / 6, *0.5 + np.arange(1, 17) / 32]


# times


def made(*times, lower=None, upper=None):
    """An answer whose whole scene took the first time and what is left of it the others."""
    size = len(times) - 1
    lower, upper = lower or times, upper or times
    return rd.EffectCost(
        question="a question",
        way="continuous",
        elements=1,
        effect=np.array([f"effect {k}" for k in range(size)]),
        change={
            "largest [Hz]": np.array([0.0, 2.0, 1.0, np.nan])[:size],
            "rms [Hz]": np.ones(size),
        },
        error=np.zeros(size),
        changed=np.array(["", "frequency", "frequency", ""])[:size],
        beyond_error=np.array([False, True, True, True])[:size],
        seen=np.ones(size, dtype=bool),
        goes_along=np.full(size, ""),
        only_with=np.array([0, 0, 1, 2])[:size],
        unsure=np.zeros(size, dtype=int),
        seconds_with=times[0],
        lower_quartile_with=lower[0],
        upper_quartile_with=upper[0],
        seconds_without=np.array(times[1:]),
        lower_quartile_without=np.array(lower[1:]),
        upper_quartile_without=np.array(upper[1:]),
        unknowns_with=3,
        unknowns_without=np.full(size, 2),
        refusal=np.array(["" if t == t else "no" for t in times[1:]]),
    )


def test_times_whose_quartiles_overlap_are_the_same():
    answer = made(
        4.0, 2.0, 3.9, 6.0, 3.0, lower=(3.5, 1.0, 3.0, 4.6, 2.0), upper=(4.5, 3.0, 4.0, 7.0, 3.5)
    )
    # the last one touches
    assert answer.costs.tolist() == ["more", "the same", "less", "the same"]
    assert answer.share.tolist() == pytest.approx([0.5, 0.025, -0.5, 0.25], rel=4 * EPS)
    assert answer.table().column("effect costs") == (None, *answer.costs)


def test_shares_lie_between_their_quartiles():
    answer = cost(rd.Scene(BEAM, tension=300.0), rd.ask.modes(2), repeat=5)
    least, most = answer.share_quartiles
    assert ((least <= answer.share) & (answer.share <= most)).all()
    assert (answer.lower_quartile_without > 0).all()
    assert 0 < answer.lower_quartile_with <= answer.seconds_with <= answer.upper_quartile_with


def test_what_all_took_together_is_what_each_took_once():
    answer = made(4.0, 2.0, math.nan, 1.0)
    assert answer.costs.tolist() == ["more", "", "more"]
    assert answer.cost.seconds == 7.0


# the figure


def test_the_figure_has_the_largest_change_on_top():
    answer = made(4.0, 2.0, 4.0, 5.0, 3.0)
    ax = answer.plot()
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels == [
        "effect 3\n2 modes only with it",
        "effect 1",
        "effect 2\n1 mode only with it",
        "effect 0\nnone beyond rounding",
    ]
    # a bar for each change, from the left border to its size
    ends = [bar.get_x() + bar.get_width() for bar in ax.patches]
    assert ends == pytest.approx([2.0, 1.0], rel=4 * EPS)
    above = next(other for other in ax.figure.axes if other is not ax)
    shares = [float(mark.lines[0].get_xdata()[0]) for mark in above.containers]
    assert shares == [25.0, 0.0, -25.0, 50.0]


def test_the_figure_puts_what_changes_most_for_its_time_on_top():
    # 2 Hz for 2 s, 1 Hz for 0.1 s
    answer = made(4.0, 4.0, 2.0, 3.9)
    np.testing.assert_allclose(answer.per_second[1:], [1.0, 10.0], rtol=1e-12)
    labels = [text.get_text() for text in answer.plot().get_yticklabels()]
    assert [label.partition("\n")[0] for label in labels] == ["effect 2", "effect 1", "effect 0"]


def test_a_level_without_end_has_a_bar_to_the_border():
    answer = made(4.0, 2.0, 4.0)
    for beyond, bars in (([True, False], 1), ([False, False], 0)):
        changes = {"largest [dB]": np.array([np.inf, np.inf])}
        one = dataclasses.replace(answer, change=changes, beyond_error=np.array(beyond))
        ax = one.plot()
        assert len(ax.patches) == bars
        assert all(bar.get_x() + bar.get_width() == ax.get_xlim()[1] for bar in ax.patches)


def test_the_figure_of_refusals_alone_has_their_names():
    ax = made(4.0, math.nan).plot()
    assert [text.get_text() for text in ax.get_yticklabels()] == ["effect 0\nno answer without it"]
    assert not ax.patches


# motion over time

TIMES = np.linspace(0.0, 0.2, 201)
TAPPED = rd.ask.motion(TIMES, drive=("z", 0.3), force=rd.Impulse(0.01, duration=4e-3))


def test_what_damping_changes_of_a_motion_is_what_it_takes_of_a_swinging_string():
    # a string let go from its first mode, nearly: the pluck of the middle has modes k with 1/k^2
    scene = STRING.replace(damping=rd.ViscousDamping(0.4))
    question = rd.ask.motion(TIMES, start={("z", 0.5): 1.0}, response=("z", 0.5))
    answer = cost(scene, question)
    change = changes(answer, "viscous damping")
    free = STRING.compile().transient(TIMES, start={("z", 0.5): 1.0}, response=("z", 0.5)).value
    damped = scene.compile().transient(TIMES, start={("z", 0.5): 1.0}, response=("z", 0.5)).value
    apart = 100 * np.abs(free - damped) / np.abs(damped).max()
    assert change["largest [%]"] == pytest.approx(apart.max(), rel=1e-12)
    assert change["rms [%]"] == pytest.approx(np.sqrt(np.mean(apart**2)), rel=1e-12)
    # both begin at the pluck, their largest value
    assert change["peak [%]"] == pytest.approx(0.0, abs=1e-3)
    assert answer.beyond_error[row(answer, "viscous damping")]


def test_twist_that_nothing_couples_changes_no_bit_of_a_motion():
    answer = cost(rd.Scene(TWISTED, tension=300.0), TAPPED)
    for effect in ("twist", "polar inertia"):
        assert set(changes(answer, effect).values()) == {0.0}
        assert answer.matters[row(answer, effect)] == "none beyond rounding"


def test_a_change_whose_error_bars_nobody_knows_is_not_told():
    scene = STRING.replace(parts=[rd.Stop(0.5, gap=1.0, stiffness=1e4)])
    # a blow at an instant has no bound on continuous spans
    struck = rd.ask.motion(TIMES, drive=("z", 0.3), force=rd.Impulse(0.01))
    answer = cost(scene, struck, elements=16, element="rigid")
    at = row(answer, "stop")
    assert np.isinf(answer.error[at])
    assert answer.matters[at].endswith("not all error bars are known")
    assert "beyond" not in answer.matters[at]


def test_a_motion_that_is_only_there_with_an_effect_is_counted():
    laid = rd.Scene(LAID, tension=300.0)
    question = rd.ask.motion(
        TIMES[:20], drive=("z", 0.3), force=rd.Sine(1.0, 20.0), response=("alpha", 0.5)
    )
    answer = cost(laid, question)
    assert answer.only_with[row(answer, "lay")] == 1
    assert answer.beyond_error[row(answer, "lay")]
