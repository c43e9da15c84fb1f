"""Bad measurements of costs: each argument refuses what has no meaning and says why."""

from functools import partial

import numpy as np
import pytest
from bad import (
    BAD_COUNT,
    FRF,
    HUGE,
    MODEL,
    NAN,
    NEGATIVE,
    NOT_A_COUNT,
    NOT_A_NUMBER,
    NOT_A_WORD,
    NOT_FINITE,
    ZERO,
    add,
    arguments,
    refuses,
    rope,
    scene,
    without,
)

import ropedyn as rd

ARGUMENTS = []
row = partial(add, ARGUMENTS)


FIRST = rd.ask.modes(1)


def accuracy_cost(question=FIRST, **how):
    return rd.accuracy_cost(scene(), question, **{"elements": 8, "repeat": 1} | how)


ACCURACY = accuracy_cost()
row(
    "accuracy_cost",
    "scene",
    lambda v: rd.accuracy_cost(v, rd.ask.modes(1)),
    {"none": None, "model": MODEL, "rope": rope(), "class": rd.Scene, "text": "rope.toml"},
)
row(
    "accuracy_cost",
    "question",
    accuracy_cost,
    {"none": None, "number": 10, "text": "modes", "answer": FRF, "function": rd.ask.modes},
)
row(
    "accuracy_cost",
    "elements",
    lambda v: accuracy_cost(elements=v),
    {k: v for k, v in NOT_A_COUNT.items() if k not in ("none", "empty", "array")}
    | {
        "floats": [2.0],
        "texts": ["8"],
        "nones": [8, None],
        "floats_array": np.array([8.0]),
        "no_axis": np.array(8),
    },
    BAD_COUNT | {"empty": [], "empty_array": np.array([], dtype=int), "zero_inside": [8, 0]},
)
row(
    "accuracy_cost",
    "element",
    lambda v: accuracy_cost(element=v),
    without(NOT_A_WORD, "list") | {"none_inside": ["rigid", None], "number_inside": (3,)},
    {"unknown": "cubic", "empty": "", "nothing": (), "unknown_inside": ["rigid", "cubic"]},
)
row(
    "accuracy_cost",
    "solver",
    lambda v: accuracy_cost(solver=v),
    without(NOT_A_WORD, "list", "none") | {"none_inside": ["sweep", None]},
    {"unknown": "magic", "nothing": [], "of_responses_only": "band"},
)
row(
    "accuracy_cost of continuous spans",
    "solver",
    lambda v: accuracy_cost(solver=v, element="continuous"),
    {},
    {"assembled": "lapack"},
)
row("accuracy_cost", "repeat", lambda v: accuracy_cost(repeat=v), NOT_A_COUNT, BAD_COUNT)
row(
    "accuracy_cost",
    "progress",
    lambda v: accuracy_cost(progress=v),
    {"number": 3, "text": "yes", "nan": NAN, "list": [print]},
)
row(
    "AccuracyCost.cheapest_within",
    "tolerance",
    ACCURACY.cheapest_within,
    NOT_A_NUMBER,
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "AccuracyCost.way",
    "row",
    ACCURACY.way,
    {"none": None, "text": "0", "float": 0.0, "list": [0]},
    {"beyond": len(ACCURACY.element), "negative": -1, "huge": HUGE},
)


def effect_cost(question=FIRST, **how):
    return rd.effect_cost(scene(), question, **{"repeat": 1} | how)


EFFECTS = effect_cost()
row(
    "effect_cost",
    "scene",
    lambda v: rd.effect_cost(v, rd.ask.modes(1)),
    {"none": None, "model": MODEL, "rope": rope(), "class": rd.Scene, "text": "rope.toml"},
)
row(
    "effect_cost",
    "question",
    effect_cost,
    {"none": None, "number": 10, "text": "modes", "answer": FRF, "function": rd.ask.modes},
)
row(
    "effect_cost",
    "elements",
    lambda v: effect_cost(elements=v),
    without(NOT_A_COUNT, "none"),
    BAD_COUNT,
)
row(
    "effect_cost",
    "element",
    lambda v: effect_cost(element=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "cubic", "empty": ""},
)
row(
    "effect_cost",
    "solver",
    lambda v: effect_cost(solver=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "magic", "of_responses_only": "band", "of_chains_only": "lapack"},
)
row("effect_cost", "repeat", lambda v: effect_cost(repeat=v), NOT_A_COUNT, BAD_COUNT)
row(
    "effect_cost",
    "progress",
    lambda v: effect_cost(progress=v),
    {"number": 3, "text": "yes", "nan": NAN, "list": [print]},
)


@pytest.mark.parametrize(("argument", "call", "wrong_types", "wrong_values"), arguments(ARGUMENTS))
def test_what_has_no_meaning_is_refused_by_name(argument, call, wrong_types, wrong_values):
    refuses(argument, call, wrong_types, wrong_values)


# signatures: what Python itself refuses, by the argument's name
@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: rd.accuracy_cost(scene()), "question"),
        (lambda: rd.accuracy_cost(scene(), rd.ask.modes(1), [8]), "positional"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_missing_and_unknown_arguments_are_named(call, argument):
    with pytest.raises(TypeError, match=argument):
        call()
