"""What effects matter, in words: against what two scenes answer, computed here once more."""

import dataclasses
import itertools
import math

import mpmath
import numpy as np
import pytest

import ropedyn as rd
from ropedyn.experiment.compare.difference import partners

STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
BEAM = rd.Rope(1.2, 0.1, bending_stiffness=1.5, rotary_inertia=2e-5)
LAID = BEAM.replace(torsional_stiffness=0.15, polar_inertia=1.4e-7, lay_slope=0.02)
LINES = np.linspace(5.0, 80.0, 40)
TIMES = np.linspace(0.0, 0.1, 101)
RESPONSE = rd.ask.frf(LINES, drive=("z", 0.3))
FEW = rd.ask.frf(LINES[::8], drive=("z", 0.3))
PULSATING = rd.Tension(300.0, amplitude=20.0, frequency=30.0)


def cost(scene, question, **how):
    return rd.effect_cost(scene, question, **{"repeat": 1} | how)


def row(answer, effect):
    return answer.effect.tolist().index(effect)


# --- what is stated, once more -------------------------------------------------------------------


def of_modes(scene, without, question):
    """Largest change of frequency [Hz] and of damping ratio, of modes of one motion alone."""
    before, after = (one.compile().modes(question.number) for one in (scene, without))
    own, left = (modes.family == "transverse" for modes in (before, after))
    count = min(own.sum(), left.sum())
    hertz = before.frequency[own][:count] - after.frequency[left][:count]
    ratio = before.damping_ratio[own][:count] - after.damping_ratio[left][:count]
    return {"largest [Hz]": abs(hertz).max(), "damping ratio [1]": abs(ratio).max()}


def of_response(scene, without, question):
    """Largest change of level [dB] and of phase [deg]."""
    before, after = (
        one.compile().frf(question.frequency, drive=question.drive).value
        for one in (scene, without)
    )
    return {
        "largest [dB]": abs(20 * np.log10(abs(after) / abs(before))).max(),
        "phase [deg]": np.degrees(abs(np.angle(after / before))).max(),
    }


def of_motion(scene, without, question):
    """Largest change in percent of the largest value."""
    before, after = (
        one.compile().transient(question.time, drive=question.drive, force=question.force).value
        for one in (scene, without)
    )
    return {"largest [%]": 100 * abs(after - before).max() / abs(before).max()}


def of_deflection(scene, without, question):
    """Change in percent, under the load."""
    before, after = (
        question.values(question.of(question.placed(one).compile()))[0] for one in (scene, without)
    )
    return {"largest [%]": 100 * abs(after / before - 1)}


TAP = rd.ask.motion(TIMES, drive=("z", 0.3), force=rd.Impulse(0.01, duration=4e-3))
TEN = {
    "a dashpot": (STRING.replace(parts=[rd.Dashpot(0.3, 0.5)]), rd.ask.modes(3), of_modes),
    "lay": (rd.Scene(LAID, tension=300.0), rd.ask.modes(4), of_modes),
    "a mass": (rd.Scene(BEAM, tension=300.0, parts=[rd.PointMass(0.5, 0.01)]), RESPONSE,
               of_response),
    "a spring": (STRING.replace(parts=[rd.Spring(0.6, 300.0)]), RESPONSE, of_response),
    "viscous": (STRING.replace(damping=rd.ViscousDamping(0.3)), TAP, of_motion),
    "a resonator": (STRING.replace(parts=[rd.Resonator(0.5, 0.01, 16.0, damping_ratio=0.1)]),
                    rd.ask.modes(4), None),
    "stiffness damping": (rd.Scene(BEAM, tension=300.0, damping=rd.StiffnessDamping(1e-4)),
                          rd.ask.modes(4), of_modes),
    "a change": (rd.Scene(BEAM, tension=300.0, parts=[rd.LocalChange(0.3, 0.5, bending=0.3)]),
                 rd.ask.static({("z", 0.4): 1.0}), of_deflection),
    "a hinge": (rd.Scene(BEAM, tension=300.0, parts=[rd.Hinge(0.5, stiffness=3.0)]), TAP,
                of_motion),
    "added mass": (STRING.replace(parts=[rd.AddedMass(0.2, 0.5, 0.03)]), rd.ask.modes(5), of_modes),
}  # fmt: skip


@pytest.mark.parametrize("name", [name for name in TEN if TEN[name][2]])
def test_changes_are_those_of_two_scenes(name):
    scene, question, again = TEN[name]
    answer = cost(scene, question)
    for k, effect in enumerate(answer.effect.tolist()):
        if answer.refusal[k] or math.isnan(answer.largest[k]):
            continue
        for measure, right in again(scene, scene.without(effect), question).items():
            # levels of a response near a node of it, and what lies below rounding
            assert answer.change[measure][k] == pytest.approx(right, rel=1e-9, abs=1e-9)


def rates_of_a_string(dashpot, place, steps=50):
    """Rates of a string followed from c = 0: T/v sinh kL + c sinh ka sinh kb = 0, b = L - a."""
    T, L = mpmath.mpf(STRING.tension), mpmath.mpf(STRING.rope.length)
    speed = mpmath.sqrt(T / mpmath.mpf(STRING.rope.linear_density))

    def rate(order):
        k = mpmath.mpc(0, order * mpmath.pi / L)
        for step in range(1, steps + 1):
            c = mpmath.mpf(dashpot) * step / steps
            k = mpmath.findroot(
                lambda k, c=c: (
                    T / speed * mpmath.sinh(k * L)
                    + c * mpmath.sinh(k * place) * mpmath.sinh(k * (L - place))
                ),
                k,
            )
        return complex(speed * k)

    return np.array([rate(order) for order in (1, 2, 3)])


@pytest.mark.parametrize(("c", "unsure"), [(0.5, 0), (2.0, 0), (5.0, 2)])
def test_a_change_of_damped_modes_is_that_of_rates_that_are_followed(c, unsure):
    scene = STRING.replace(parts=[rd.Dashpot(0.3, c)])
    answer = cost(scene, rd.ask.modes(3, damped=True))
    at = row(answer, "dashpot")
    with_it, without = rates_of_a_string(c, 0.3), rates_of_a_string(0.0, 0.3, 1)
    right = 100 * abs((without - with_it) / with_it).max()
    assert answer.unsure[at] == unsure
    # rates are right to a few eps, of which percent make a hundred; beside it what is left open
    off = abs(answer.change["largest [%]"][at] - right)
    assert off < (answer.error[at] if unsure else 1e-10 * right)


def test_partners_are_as_near_as_can_be_all_together():
    # the first one's nearest is the second one's too
    which, left_open = partners(np.array([10.0, 14.0]), np.array([9.9, 10.4]))
    np.testing.assert_array_equal(which, [0, 1])
    np.testing.assert_allclose(left_open, [4.0, 3.2])  # |14 - 9.9| - 0.1, |10 - 10.4| - 3.6


def test_partners_that_are_far_from_all_others_are_sure():
    found, right = np.array([1.0, 2.0, 3.0, 4.0]) + 0.1, np.array([1.0, 2.0, 3.0])
    which, left_open = partners(found, right)
    np.testing.assert_array_equal(which, [0, 1, 2])
    assert not left_open.any()


def test_a_change_that_could_be_of_other_modes_is_not_told():
    answer = cost(STRING.replace(parts=[rd.Dashpot(0.3, 0.5)]), rd.ask.modes(3, damped=True))
    at = row(answer, "dashpot")
    where = np.arange(len(answer.effect)) == at
    doubtful = dataclasses.replace(
        answer,
        unsure=answer.unsure + 2 * where,
        beyond_error=answer.beyond_error & ~where,
        changed=np.where(where, "", answer.changed),
    )
    assert doubtful.matters[at] == "not told: modes could have other partners"
    assert "of dashpot it is not told" in doubtful.verdict.lower()


# --- the verdict ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", TEN)
def test_the_verdict_names_every_effect_once_in_its_place(name):
    scene, question, _ = TEN[name]
    answer = cost(scene, question)
    needed, idle = answer.verdict.split(". ", 1)
    for k, effect in enumerate(answer.effect.tolist()):
        needs = answer.beyond_error[k] or answer.refusal[k] or answer.matters[k][:8] == "probably"
        assert (effect in needed) == bool(needs)
        assert (effect in idle) != bool(needs)


def test_a_decisive_dashpot_matters():
    answer = cost(STRING.replace(parts=[rd.Dashpot(0.5, 0.5)]), rd.ask.modes(2))
    assert answer.matters[row(answer, "dashpot")] == "yes: damping ratio"
    first, _ = answer.verdict.split(". ", 1)
    assert first == (
        "For 2 modes what matters is dashpot (damping ratio 0.0503); without tension there is no "
        "answer"
    )


def test_what_goes_along_is_what_is_not_there_any_more():
    scene = rd.Scene(LAID, tension=300.0, parts=[rd.Hinge(0.5), rd.PointMass(0.4, 0.01)])
    answer = cost(scene, rd.ask.modes(3))
    along = dict(zip(answer.effect.tolist(), answer.goes_along.tolist()))
    assert along["bending"] == "lay, rotary inertia, hinge"
    assert along["twist"] == "lay, polar inertia"
    assert along["point mass"] == along["lay"] == ""
    assert answer.table().column("goes along")[1:] == tuple(v or None for v in along.values())


def test_what_modes_cannot_see_is_said():
    answer = cost(rd.Scene(BEAM, tension=PULSATING), rd.ask.modes(3))
    at = row(answer, "pulsating tension")
    assert (answer.matters[at], answer.seen[at]) == ("not seen by this question", False)
    assert "it cannot tell pulsating tension, which motion can" in answer.verdict
    damping = rd.ViscousDamping(0.1)
    for question in (rd.ask.floquet(2), TAP):
        scene = rd.Scene(BEAM, tension=PULSATING, damping=damping)
        other = cost(scene, question, elements=12)
        at = row(other, "pulsating tension")
        assert other.seen[at]
        assert other.refusal[at] or other.largest[at] > 0


def test_of_damped_modes_damping_matters():
    scene = STRING.replace(parts=[rd.Dashpot(0.5, 0.5)])
    answer = cost(scene, rd.ask.modes(3, damped=True))
    assert answer.beyond_error[row(answer, "dashpot")]
    before, after = (
        one.compile().modes(3, damped=True).eigenvalue for one in (scene, scene.without("dashpot"))
    )
    off = 100 * abs(after - before) / abs(before)
    assert answer.largest[row(answer, "dashpot")] == pytest.approx(off.max(), rel=1e-9)


def test_a_stop_is_priced_by_motion():
    scene = STRING.replace(parts=[rd.Stop(0.5, gap=1e-5, stiffness=1e4)])
    answer = cost(scene, rd.ask.motion(TIMES[:31], drive=("z", 0.3), force=rd.Step(1.0)))
    at = row(answer, "stop")
    assert (answer.matters[at], answer.seen[at]) == ("yes: motion", True)


def test_an_effect_that_turns_a_response_changes_it():
    # where the receptance h is real, a dashpot c makes it h/(1 + i omega c h)
    c, f = 1e-3, 7.0
    h = STRING.compile().frf([f], drive=("z", 0.3)).value.real.item()
    tan = 2 * math.pi * f * c * h
    scene, question = STRING.replace(parts=[rd.Dashpot(0.3, c)]), rd.ask.frf([f], drive=("z", 0.3))
    answer = cost(scene, question)
    at = row(answer, "dashpot")
    # of the level it changes 10 lg(1 + tan^2), far less
    assert answer.change["largest [dB]"][at] == pytest.approx(10 * math.log10(1 + tan**2), rel=1e-6)
    assert answer.change["phase [deg]"][at] == pytest.approx(math.degrees(math.atan(tan)), rel=1e-9)
    assert "phase" in answer.matters[at] and "phase" in answer.verdict
    assert "dashpot" in scene.needed(question, 0.99 * abs(tan))
    assert "dashpot" not in scene.needed(question, 1.01 * abs(tan))


# --- what an answer needs ------------------------------------------------------------------------


def off(scene, out, question):
    """How far an answer is off without effects, relative."""
    try:
        return OFF[type(question)](scene, scene.without(*out), question)
    except rd.RopedynError:
        return math.inf


def off_response(scene, left, question):
    """Of a response, line by line."""
    whole, left = (
        one.compile().frf(question.frequency, drive=question.drive).value for one in (scene, left)
    )
    return abs(left / whole - 1).max()


def off_modes(scene, left, question):
    """Of frequencies and damping ratios."""
    whole, left = (one.compile().modes(question.number) for one in (scene, left))
    if (whole.family != left.family).any():
        return math.inf
    apart = abs(left.frequency / whole.frequency - 1).max()
    return max(apart, abs(left.damping_ratio - whole.damping_ratio).max())


OFF = {rd.ask.modes: off_modes, rd.ask.frf: off_response}


def drawn(seed):
    """A scene whose effects are of all sizes."""
    random = np.random.default_rng(seed)
    rope = rd.Rope(
        1.5,
        0.1,
        bending_stiffness=10 ** random.uniform(-4, 0),
        rotary_inertia=10 ** random.uniform(-9, -4),
        axial_stiffness=1e6,
    )
    parts = [
        rd.PointMass(random.uniform(0.2, 1.3), 10 ** random.uniform(-7, -2)),
        rd.Spring(random.uniform(0.2, 1.3), 10 ** random.uniform(-2, 3)),
        rd.Dashpot(random.uniform(0.2, 1.3), 10 ** random.uniform(-5, 0)),
    ]
    return rd.Scene(rope, tension=400.0, ends=("pinned", "pinned"), parts=parts)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("question", [rd.ask.modes(2), FEW], ids=["modes", "frf"])
def test_no_smaller_set_of_effects_is_within_the_tolerance(question, seed):
    scene, tolerance = drawn(seed), 1e-3
    kept = scene.needed(question, tolerance)
    assert set(kept) <= set(scene.effects)
    out = [effect for effect in scene.effects if effect not in kept]
    assert off(scene, out, question) <= tolerance
    for count in range(len(scene.effects)):
        for some in itertools.combinations(scene.effects, count):
            if len(scene.effects) - len(some) < len(kept):
                assert off(scene, some, question) > tolerance * (1 - 1e-6)


def test_of_many_effects_one_after_the_other_is_left_out(monkeypatch):
    scene = drawn(3)
    right = scene.needed(rd.ask.modes(2), 1e-3)
    monkeypatch.setattr("ropedyn.study.needed.MOST", 0)
    kept = scene.needed(rd.ask.modes(2), 1e-3)
    assert len(kept) >= len(right)
    out = [effect for effect in scene.effects if effect not in kept]
    assert off(scene, out, rd.ask.modes(2)) <= 1e-3


def test_a_response_keeps_what_it_would_lose():
    scene = rd.Scene(LAID, tension=300.0)
    twist = rd.ask.frf([20.0], drive=("z", 0.3), response=("alpha", 0.5))
    assert "lay" in scene.needed(twist, 0.5)
    assert "lay" not in scene.needed(rd.ask.frf([20.0], drive=("z", 0.3)), 0.5)


@pytest.mark.parametrize("tolerance", [0, -1.0, math.nan, math.inf])
def test_a_tolerance_without_meaning_is_refused(tolerance):
    with pytest.raises(rd.SceneError, match="tolerance must be"):
        STRING.needed(rd.ask.modes(1), tolerance)


def test_what_is_no_question_is_refused():
    with pytest.raises(TypeError, match=r"question must be made by ropedyn\.ask"):
        STRING.needed("modes", 1e-3)
