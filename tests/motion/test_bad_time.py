"""Bad input about time: each argument refuses what has no meaning and says which, what and why."""

from functools import partial

import numpy as np
import pytest
from bad import (
    BAD_ARRAY,
    BAD_COUNT,
    BAD_POINT,
    HUGE,
    MODEL,
    NEGATIVE,
    NO_POINT,
    NOT_A_COUNT,
    NOT_A_NUMBER,
    NOT_A_WORD,
    NOT_AN_ARRAY,
    NOT_FINITE,
    ZERO,
    add,
    arguments,
    refuses,
    without,
)
from made_history import decaying, made

import ropedyn as rd

ARGUMENTS = []
row = partial(add, ARGUMENTS)
NOT_TRUTH = {"none": None, "number": 1, "text": "yes", "list": [True]}
LAW = {"none": None, "number": 3.0, "text": "-k*u", "list": [min]}

TENSION = {"mean": 100.0, "amplitude": 10.0, "frequency": 20.0}
for name, wrong in {
    "mean": {},
    "amplitude": NEGATIVE,
    "frequency": NEGATIVE | ZERO,
    "phase": {},
}.items():
    row(
        "Tension",
        name,
        lambda v, name=name: rd.Tension(**TENSION | {name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | wrong,
    )
row("Tension", "stretching", lambda v: rd.Tension(100.0, stretching=v), NOT_TRUTH)

for kind, given in {
    rd.NodeForce: {"x": 0.5, "law": min},
    rd.Stop: {"x": 0.5, "stiffness": 1.0},
}.items():
    row(
        kind.__name__,
        "x",
        lambda v, kind=kind, given=given: kind(**given | {"x": v}),
        NOT_A_NUMBER,
        NOT_FINITE,
    )
    row(
        kind.__name__,
        "coordinate",
        lambda v, kind=kind, given=given: kind(**given, coordinate=v),
        NOT_A_WORD,
        {"unknown": "w", "empty": "", "capital": "Z"},
    )
row("NodeForce", "law", lambda v: rd.NodeForce(0.5, v), LAW)
row("Stop", "stiffness", lambda v: rd.Stop(0.5, v), NOT_A_NUMBER, NOT_FINITE | NEGATIVE | ZERO)
row("Stop", "gap", lambda v: rd.Stop(0.5, 1.0, gap=v), NOT_A_NUMBER, NOT_FINITE | NEGATIVE)
row(
    "Stop",
    "side",
    lambda v: rd.Stop(0.5, 1.0, side=v),
    NOT_A_NUMBER,
    NOT_FINITE | ZERO | {"half": 0.5, "two": 2, "beyond": -1.5},
)

FORCES = {
    rd.Sine: ({"amplitude": 1.0, "frequency": 20.0, "phase": 0.0}, {"frequency": NEGATIVE}),
    rd.Chirp: (
        {"amplitude": 1.0, "start": 10.0, "stop": 20.0, "duration": 1.0, "phase": 0.0},
        {"start": NEGATIVE, "stop": NEGATIVE, "duration": NEGATIVE | ZERO},
    ),
    rd.Step: ({"amplitude": 1.0, "time": 0.0}, {"time": NEGATIVE}),
    rd.Impulse: (
        {"impulse": 1.0, "time": 0.0, "duration": 0.0},
        {"time": NEGATIVE, "duration": NEGATIVE},
    ),
}
for kind, (given, wrong) in FORCES.items():
    for name in given:
        row(
            kind.__name__,
            name,
            lambda v, kind=kind, name=name, given=given: kind(**given | {name: v}),
            NOT_A_NUMBER,
            NOT_FINITE | wrong.get(name, {}),
        )

TIMES = [0.0, 0.1, 0.2]
WHERE = ("z", 0.5)


def run(time=TIMES, **changes):
    return MODEL.transient(time, **{"drive": WHERE, "force": rd.Step(1.0)} | changes)


row(
    "Model.transient",
    "time",
    run,
    NOT_AN_ARRAY,
    BAD_ARRAY | {"one": [0.0], "equal": [0.0, 0.1, 0.1], "falling": [0.1, 0.0]},
)
row("Model.transient", "drive", lambda v: run(drive=v), without(NO_POINT, "none"), BAD_POINT)
row(
    "Model.transient",
    "drive",
    lambda v: run(drive=v),
    {},
    {"end_alone": ("end",), "third_end": ("end", 2, "z"), "far_end": ("end", 0, "z", 1)},
)
row(
    "Model.transient",
    "force",
    lambda v: run(force=v),
    without(NOT_AN_ARRAY, "none") | {"dict": {"t": 1.0}},
    without(BAD_ARRAY, "negative") | {"two": [1.0, 2.0]},
)
row(
    "Model.transient of two drives",
    "force",
    lambda v: run(drive=[WHERE, ("z", 0.3)], force=v),
    {},
    {"one": [rd.Step(1.0)], "three": [rd.Step(1.0)] * 3, "alone": rd.Step(1.0)},
)
row("Model.transient", "response", lambda v: run(response=v), without(NO_POINT, "none"), BAD_POINT)
row("Model.transient", "quantity", lambda v: run(quantity=v), NOT_A_WORD, {"frf": "mobility"})
row(
    "Model.transient",
    "start",
    lambda v: run(start=v),
    {"number": 3.0, "point": WHERE, "pairs": [(WHERE, 1.0)], "word_key": {"z": 1.0}},
    {"empty": {}} | {f"key_{k}": {v: 1.0} for k, v in BAD_POINT.items()},
)
row(
    "Model.transient",
    "start[('z', 0.5)]",
    lambda v: run(start={WHERE: v}),
    NOT_A_NUMBER,
    NOT_FINITE,
)
row(
    "Model.transient",
    "start at x",
    lambda v: run(start=lambda x: v),
    {"word": "a", "complex": 1j},
    {"nan": float("nan"), "infinite": float("inf")},
)
row("Model.transient", "method", lambda v: run(method=v), NOT_A_WORD, {"later": "newmark"})
row("Model.transient by the line", "modes", lambda v: run(modes=v, method="line"), {}, {"few": 3})
row("Model.transient", "modes", lambda v: run(modes=v), without(NOT_A_COUNT, "none"), BAD_COUNT)
for name, wrong in {
    "tolerance": NEGATIVE | ZERO,
}.items():
    row(
        "Model.transient",
        name,
        lambda v, name=name: run(**{name: v}),
        without(NOT_A_NUMBER, "none"),
        NOT_FINITE | wrong,
    )
row(
    "Model.transient",
    "snapshots",
    lambda v: run(snapshots=v),
    without(NOT_AN_ARRAY, "none"),
    BAD_ARRAY | {"late": [0.3], "falling": [0.2, 0.1]},
)
row("Model.transient", "progress", lambda v: run(progress=v), {"number": 3, "text": "yes"})
row("Model.transient", "partial", lambda v: run(partial=v), NOT_TRUTH)

TIME = np.linspace(0.0, 1.0, 200)
HISTORY = made(TIME, decaying(TIME, (20.0, 0.01, 1.0)), force=rd.Sine(3.0, 20.0).value(TIME))
INDEX = (
    {"none": None, "text": "0", "float": 0.0, "complex": 1j, "list": [0]},
    {"beyond": 1, "negative": -1, "huge": HUGE},
)
row(
    "History.spectrum",
    "window",
    lambda v: HISTORY.spectrum(window=v),
    NOT_A_WORD,
    {"unknown": "round", "empty": "", "needs_a_number": "kaiser"},
)
row(
    "History.amplitude",
    "frequency",
    HISTORY.amplitude,
    NOT_AN_ARRAY,
    BAD_ARRAY | {"zero": [0.0], "twice": [20.0, 20.0], "beyond": [99.6]},
)
row(
    "History.amplitude",
    "last",
    lambda v: HISTORY.amplitude(20.0, last=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "History.ring_down",
    "near",
    lambda v: HISTORY.ring_down(v, since=0.0),
    without(NOT_AN_ARRAY, "none"),
    BAD_ARRAY | {"zero": [0.0], "beyond": [99.6]},
)
row("History.ring_down", "response", lambda v: HISTORY.ring_down(response=v), *INDEX)
row(
    "History.ring_down",
    "since",
    lambda v: HISTORY.ring_down(since=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE,
)
row("History.frf", "drive", lambda v: HISTORY.frf(drive=v), *INDEX)
row("History.frf", "segments", lambda v: HISTORY.frf(segments=v), NOT_A_COUNT, BAD_COUNT)
row(
    "History.frf",
    "window",
    lambda v: HISTORY.frf(window=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "round", "empty": ""},
)
row(
    "History.frf",
    "band",
    lambda v: HISTORY.frf(band=v),
    without(NOT_AN_ARRAY, "none"),
    BAD_ARRAY | {"one": [3.0], "three": [1.0, 2.0, 3.0], "falling": [3.0, 2.0]},
)


def measured(**changes):
    given = {"frequency": [10.0, 20.0], "value": [1e-4, 2e-4], "drive": WHERE, "response": WHERE}
    return rd.Measured(**given | changes)


# which coordinates there are and how long the rope is comes with the model
ANYWHERE = ("absent_coordinate", "left_of_the_rope", "right_of_the_rope")
row(
    "Measured",
    "frequency",
    lambda v: measured(frequency=v),
    NOT_AN_ARRAY,
    BAD_ARRAY | {"falling": [20.0, 10.0]},
)
row(
    "Measured",
    "value",
    lambda v: measured(value=v),
    {"none": None, "text": "1.0", "object": object(), "dict": {"v": 1.0}},
    {"one": [1e-4], "nan": [1e-4, np.nan], "three": [1.0, 2.0, 3.0], "ragged": [[1.0], [1.0, 2.0]]},
)
row("Measured", "drive", lambda v: measured(drive=v), NO_POINT, without(BAD_POINT, *ANYWHERE))
row("Measured", "response", lambda v: measured(response=v), NO_POINT, without(BAD_POINT, *ANYWHERE))
row("Measured", "quantity", lambda v: measured(quantity=v), NOT_A_WORD, {"motion": "velocity"})
row(
    "Measured",
    "coherence",
    lambda v: measured(coherence=v),
    {"text": "1.0", "complex": [1j, 1j], "object": object()},
    {"one": [0.5], "nan": [0.5, np.nan], "negative": [-0.1, 0.5], "beyond": [0.5, 1.1]},
)


ASK = {"drive": ("z", 0.5), "force": rd.Step(1.0)}
MADE = [0.0, 0.1]
row("ask.motion", "time", lambda v: rd.ask.motion(v, **ASK), NOT_AN_ARRAY, BAD_ARRAY)
row(
    "ask.motion",
    "drive",
    lambda v: rd.ask.motion(MADE, **ASK | {"drive": v}),
    {"number": 3, "text": "z"},
)
row(
    "ask.motion",
    "force",
    lambda v: rd.ask.motion(MADE, **ASK | {"force": v}),
    {"text": "step", "class": rd.Step, "complex": 1j},
    {"short": [1.0], "long": [1.0, 2.0, 3.0], "nan": [0.0, np.nan], "infinite": [0.0, np.inf]},
)
row(
    "ask.motion, several drives",
    "force",
    lambda v: rd.ask.motion(MADE, drive=[("z", 0.5), ("z", 0.2)], force=v),
    {},
    {"one": rd.Step(1.0), "three": [rd.Step(1.0)] * 3},
)
row(
    "ask.motion",
    "response",
    lambda v: rd.ask.motion(MADE, **ASK, response=v),
    {"number": 3, "text": "z"},
    {"no_points": []},
)
row(
    "ask.motion",
    "start",
    lambda v: rd.ask.motion(MADE, start=v),
    {"number": 3.0, "point": ("z", 0.5), "pairs": [(("z", 0.5), 1.0)]},
)
row(
    "ask.motion",
    "quantity",
    lambda v: rd.ask.motion(MADE, **ASK, quantity=v),
    NOT_A_WORD,
    {"unknown": "receptance", "empty": ""},
)
row(
    "ask.motion",
    "tolerance",
    lambda v: rd.ask.motion(MADE, **ASK, tolerance=v),
    NOT_A_NUMBER,
    NOT_FINITE | NEGATIVE | ZERO,
)


@pytest.mark.parametrize(("argument", "call", "wrong_types", "wrong_values"), arguments(ARGUMENTS))
def test_what_has_no_meaning_is_refused_by_name(argument, call, wrong_types, wrong_values):
    refuses(argument, call, wrong_types, wrong_values)
