"""Bad questions: each argument refuses what has no meaning and says which, what and why."""

from functools import partial

import numpy as np
import pytest
from bad import (
    BAD_ARRAY,
    BAD_COUNT,
    BAD_POINT,
    FRF,
    HUGE,
    MODEL,
    NAN,
    NEGATIVE,
    NO_POINT,
    NOT_A_COUNT,
    NOT_A_NUMBER,
    NOT_A_WORD,
    NOT_AN_ARRAY,
    NOT_FINITE,
    PEAKS,
    ZERO,
    add,
    arguments,
    refuses,
    scene,
    without,
)

import ropedyn as rd

ARGUMENTS = []
row = partial(add, ARGUMENTS)

SOLVER = (NOT_A_WORD, {"unknown": "magic", "empty": "", "later": "newton"})
row("Model.modes", "number", MODEL.modes, without(NOT_A_COUNT, "none"), BAD_COUNT)
row(
    "Model.modes",
    "below",
    lambda v: MODEL.modes(below=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row("Model.modes", "solver", lambda v: MODEL.modes(1, solver=v), *SOLVER)
row("Model.frf", "solver", lambda v: MODEL.frf([1.0], drive=("z", 0.5), solver=v), *SOLVER)
row("Model.static", "solver", lambda v: MODEL.static({("z", 0.5): 1.0}, solver=v), *SOLVER)
row(
    "Model.frf",
    "frequency",
    lambda v: MODEL.frf(v, drive=("z", 0.5)),
    NOT_AN_ARRAY,
    BAD_ARRAY,
)
row("Model.frf", "drive", lambda v: MODEL.frf([1.0], drive=v), NO_POINT, BAD_POINT)
row(
    "Model.frf, several drives",
    "drive[1]",
    lambda v: MODEL.frf([1.0], drive=[("z", 0.5), v]),
    NO_POINT,
    BAD_POINT,
)
row(
    "Model.frf",
    "response",
    lambda v: MODEL.frf([1.0], drive=("z", 0.5), response=v),
    without(NO_POINT, "none"),
    BAD_POINT | {"no_points": []},
)
row(
    "Model.frf, several responses",
    "response[1]",
    lambda v: MODEL.frf([1.0], drive=("z", 0.5), response=[("z", 0.5), v]),
    NO_POINT,
    BAD_POINT,
)
QUANTITY = (NOT_A_WORD, {"unknown": "velocity", "empty": ""})
row(
    "Model.frf",
    "quantity",
    lambda v: MODEL.frf([1.0], drive=("z", 0.5), quantity=v),
    *QUANTITY,
)
row("FRF.to", "quantity", FRF.to, *QUANTITY)
row(
    "FRF.to at 0 Hz",
    "quantity",
    MODEL.frf([0.0], drive=("z", 0.5), quantity="mobility").to,
    {},
    {"integral_of_nothing": "receptance"},
)
INDEX = (
    {"none": None, "text": "0", "float": 0.0, "complex": 1j, "list": [0]},
    {"beyond": 1, "huge": HUGE},
)
row("FRF.peaks", "drive", FRF.peaks, *INDEX)
row("FRF.curve", "response", FRF.curve, *INDEX)
row("FRF.curve", "drive", lambda v: FRF.curve(0, v), *INDEX)
row(
    "Model.static",
    "load",
    MODEL.static,
    {
        "none": None,
        "number": 3.0,
        "point": ("z", 0.5),
        "pairs": [(("z", 0.5), 1.0)],
        "word_key": {"z": 1.0},
        "number_key": {0.5: 1.0},
        "swapped_key": {(0.5, "z"): 1.0},
    },
    {"empty": {}} | {f"key_{k}": {v: 1.0} for k, v in BAD_POINT.items()},
)
row(
    "Model.static",
    "load[('z', 0.5)]",
    lambda v: MODEL.static({("z", 0.5): v}),
    NOT_A_NUMBER,
    NOT_FINITE,
)

row("ask.modes", "number", rd.ask.modes, without(NOT_A_COUNT, "none"), BAD_COUNT)
row(
    "ask.modes",
    "below",
    lambda v: rd.ask.modes(below=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "ask.frf",
    "frequency",
    lambda v: rd.ask.frf(v, drive=("z", 0.5)),
    NOT_AN_ARRAY,
    BAD_ARRAY,
)
# which coordinates there are and how long the rope is comes with the model
UNKNOWN_POINT = without(BAD_POINT, "absent_coordinate", "left_of_the_rope", "right_of_the_rope")
row("ask.frf", "drive", lambda v: rd.ask.frf([1.0], drive=v), NO_POINT, UNKNOWN_POINT)
row(
    "ask.frf, several drives",
    "drive[1]",
    lambda v: rd.ask.frf([1.0], drive=[("z", 0.5), v]),
    NO_POINT,
    UNKNOWN_POINT,
)
row(
    "ask.frf",
    "drive[0]",
    lambda v: rd.ask.frf([1.0], drive=v),
    {},
    {"internal_force": ("F_z", 0.5)},
)
row(
    "ask.frf",
    "response",
    lambda v: rd.ask.frf([1.0], drive=("z", 0.5), response=v),
    without(NO_POINT, "none"),
    UNKNOWN_POINT | {"no_points": []},
)
row("ask.frf", "quantity", lambda v: rd.ask.frf([1.0], drive=("z", 0.5), quantity=v), *QUANTITY)

row("Peaks", "frequency", rd.Peaks, NOT_AN_ARRAY, BAD_ARRAY | {"zero": [0.0]})
row(
    "Peaks",
    "std",
    lambda v: rd.Peaks([1.0, 2.0], std=v),
    without(NOT_AN_ARRAY, "none"),
    BAD_ARRAY | {"three_of_two": [0.1, 0.1, 0.1]},
)
row(
    "Peaks",
    "damping_ratio",
    lambda v: rd.Peaks([1.0, 2.0], damping_ratio=v),
    without(NOT_AN_ARRAY, "none"),
    without(BAD_ARRAY, "negative") | {"three_of_two": [0.1, 0.1, 0.1]},
)
row(
    "Peaks",
    "order",
    lambda v: rd.Peaks([1.0, 2.0], order=v),
    {
        "number": 1,
        "text": "12",
        "dict": {1: 2, 2: 1},
        "floats": [1.0, 2.0],
        "bools": [True, False],
        "nones": [1, None],
        "complex": [1, 2j],
        "nan": [1, NAN],
    },
    {
        "empty": [],
        "three_of_two": [1, 2, 3],
        "zero": [0, 1],
        "negative": [1, -2],
        "twice": [1, 1],
        "huge": [1, HUGE],
        "rows": np.array([[1, 2]]),
    },
)
row(
    "compare",
    "calculated",
    lambda v: rd.compare(v, PEAKS),
    {"none": None, "numbers": [20.0], "peaks": PEAKS, "scene": scene(), "class": rd.Modes},
)
row(
    "compare",
    "measured",
    lambda v: rd.compare(MODEL, v),
    {**NOT_AN_ARRAY, "modes": MODEL.modes(1), "class": rd.Peaks},
    {**BAD_ARRAY, "zero": [20.0, 0.0]},
)
POINTS = [("z", 0.2), ("z", 0.5)]
SHAPES = [[1.0, 2.0]]
row(
    "compare",
    "within",
    lambda v: rd.compare(MODEL, PEAKS, within=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "compare",
    "band",
    lambda v: rd.compare(MODEL, PEAKS, band=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "compare",
    "shapes",
    lambda v: rd.compare(MODEL, 20.0, shapes=v, points=POINTS),
    {"text": "ab", "words": [["a", "b"]], "bools": [[True, False]], "object": object()},
    {
        "none": None,
        "one_point": [[1.0]],
        "two_peaks": [[1.0, 2.0]] * 2,
        "ragged": [[1.0], [1.0, 2.0]],
        "nan": [[NAN, 1.0]],
    },
)
row(
    "compare",
    "points",
    lambda v: rd.compare(MODEL, 20.0, shapes=SHAPES, points=v),
    {"number": 0.5, "numbers": [0.2, 0.5], "word": "z"},
    {
        "none": None,
        "outside": [("z", 0.2), ("z", 7.0)],
        "absent": [("z", 0.2), ("x", 0.5)],
        "end": [("z", 0.2), ("end", 0, "z")],
        "force": [("z", 0.2), ("F_z", 0.5)],
    },
)
row(
    "Comparison.plot",
    "of",
    lambda v: rd.compare(MODEL, 20.0).plot(of=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "shape", "no_shapes": "mac", "no_response": "phase"},
)

TABLE = rd.Table.of("a table", {"a": [1, 2]})
row(
    "Table.column",
    "name",
    TABLE.column,
    NOT_A_WORD,
    {"unknown": "b", "empty": ""},
)
row(
    "Table.of",
    "columns",
    lambda v: rd.Table.of("title", v),
    {"none": None, "number": 3, "list": [[1, 2]]},
    {"unequal": {"a": [1, 2], "b": [1]}},
)

NOT_A_PATH = {"none": None, "number": 3.5, "list": ["a"], "bytes": b"rope.toml", "nan": NAN}
row("Scene.load", "path", rd.Scene.load, NOT_A_PATH)
row("Scene.save", "path", lambda v: scene().save(v), NOT_A_PATH)
row("load", "path", rd.load, NOT_A_PATH)
row("Answer.save", "path", PEAKS.save, NOT_A_PATH)


@pytest.mark.parametrize(("argument", "call", "wrong_types", "wrong_values"), arguments(ARGUMENTS))
def test_what_has_no_meaning_is_refused_by_name(argument, call, wrong_types, wrong_values):
    refuses(argument, call, wrong_types, wrong_values)


# signatures: what Python itself refuses, by the argument's name
@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: MODEL.modes(1, animated=True), "animated"),
        (lambda: MODEL.frf([1.0]), "drive"),
        (lambda: MODEL.frf([1.0], ("z", 0.5)), "positional"),
        (MODEL.static, "load"),
        (lambda: rd.ask.frf([1.0]), "drive"),
        (lambda: rd.ask.frf([1.0], ("z", 0.5)), "positional"),
        (rd.Peaks, "frequency"),
        (lambda: rd.compare(MODEL), "measured"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_missing_and_unknown_arguments_are_named(call, argument):
    with pytest.raises(TypeError, match=argument):
        call()


@pytest.mark.parametrize(("number", "below"), [(None, None), (2, 100.0)], ids=["neither", "both"])
def test_modes_take_either_number_or_below(number, below):
    for ask in (MODEL.modes, rd.ask.modes):
        with pytest.raises(rd.SceneError, match=r"number.*below"):
            ask(number, below=below)


@pytest.mark.parametrize("number", [10, 10**9])
def test_more_modes_than_the_model_has_is_refused_with_how_many_there_are(number):
    # 3 free nodes: z and nothing else has inertia
    with pytest.raises(rd.SolveError, match=f"number must be at most 3, .* got {number}"):
        MODEL.modes(number)


@pytest.mark.parametrize("exponent", [0.5, 2])
@pytest.mark.parametrize(
    "ask",
    [
        lambda model: model.modes(2),
        lambda model: model.count(below=50.0),
        lambda model: model.frf([10.0], drive=("z", 0.5)),
        lambda model: model.static({("z", 0.5): 1.0}),
        lambda model: model.damping_matrix(),
    ],
    ids=["modes", "count", "frf", "static", "damping"],
)
def test_a_dashpot_that_is_not_linear_is_refused_where_time_is_not_integrated(ask, exponent):
    parts = [rd.Support(0.3), rd.Dashpot(0.5, 1.0, exponent=exponent)]
    model = scene(parts=parts).compile(elements=4)
    with pytest.raises(rd.SceneError, match=rf"parts\[1\].exponent must be 1, got {exponent:.1f}"):
        ask(model)
