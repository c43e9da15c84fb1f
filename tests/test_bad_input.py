"""Bad input: each public argument refuses what has no meaning and says which, what, and why."""

import math
from collections import OrderedDict
from decimal import Decimal

import numpy as np
import pytest

import ropedyn as rd

NAN, INF = math.nan, math.inf
HUGE, HUGER = 10**400, 10**5000  # beyond a float; and beyond what Python turns into text

# what is no number at all, and what is one without meaning anywhere
NOT_A_NUMBER = {
    "none": None,
    "text": "1.0",
    "bytes": b"1",
    "list": [1.0],
    "empty": [],
    "dict": {},
    "object": object(),
    "complex": 1 + 1j,
    "bool": True,
    "array": np.array([1.0, 2.0]),
    "decimal": Decimal(1),
}
NOT_FINITE = {
    "nan": NAN,
    "inf": INF,
    "minus_inf": -INF,
    "float32_nan": np.float32("nan"),
    "huge": HUGE,
    "huger": HUGER,
}
NEGATIVE = {"negative": -1.0, "minus_tiny": -5e-324}
ZERO = {"zero": 0, "zero_float": 0.0}
NOT_A_WORD = {"none": None, "number": 3, "list": ["z"], "bytes": b"z", "nan": NAN}
NOT_A_COUNT = {
    **{k: v for k, v in NOT_A_NUMBER.items() if k != "list"},
    "float": 2.0,
    "nan": NAN,
    "inf": INF,
}
BAD_COUNT = {"zero": 0, "negative": -3, "huge": HUGE, "huger": HUGER}
NOT_AN_ARRAY = {
    "none": None,
    "text": "1.0",
    "texts": ["a", "b"],
    "object": object(),
    "dict": {"f": 1.0},
    "complex": [1 + 1j],
    "bools": [True, False],
    "nones": [1.0, None],
    "huge": [HUGE],
}
BAD_ARRAY = {
    "empty": [],
    "empty_rows": np.empty((0, 3)),
    "rows": [[1.0, 2.0]],
    "ragged": [[1.0], [1.0, 2.0]],
    "nan": [1.0, NAN],
    "inf": [INF],
    "negative": [-1.0],
}
NO_POINT = {"none": None, "word": "z", "number": 0.5, "dict": {"z": 0.5}, "swapped": (0.5, "z")}
NO_POINT |= {"number_word": (3, 0.5), "none_position": ("z", None), "text_position": ("z", "0.5")}
NO_POINT |= {"complex_position": ("z", 0.5j), "list_position": ("z", [0.5])}
BAD_POINT = {
    "empty": (),
    "short": ("z",),
    "long": ("z", 0.5, 1.0),
    "unknown_coordinate": ("y", 0.5),
    "empty_word": ("", 0.5),
    "absent_coordinate": ("x", 0.5),
    "left_of_the_rope": ("z", -0.01),
    "right_of_the_rope": ("z", 1.01),
    "nan": ("z", NAN),
    "inf": ("z", INF),
    "huge": ("z", HUGE),
}


def rope(**changes):
    given = {"length": 1.0, "linear_density": 0.1, "bending_stiffness": 1.0}
    return rd.Rope(**given | {"torsional_stiffness": 0.5} | changes)


def scene(**changes):
    return rd.Scene(**{"rope": rope(), "tension": 100.0} | changes)


MODEL = scene(damping=rd.StiffnessDamping(1e-4)).compile(elements=4)
GRID = np.linspace(1.0, 60.0, 60)
FRF = MODEL.frf(GRID, drive=("z", 0.5))
PEAKS = rd.Peaks([20.0, 50.0])


def table():
    return rd.Table.of("a table", {"a": [1, 2]})


# (what it is, argument, what is called with the value, what raises TypeError, what SceneError)
ARGUMENTS = []


def row(what, argument, call, wrong_types, wrong_values=None):
    ARGUMENTS.append((what, argument, call, wrong_types, wrong_values or {}))


def without(values, *names):
    return {k: v for k, v in values.items() if k not in names}


for name in ("length", "linear_density"):
    row(
        "Rope",
        name,
        lambda v, name=name: rope(**{name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | NEGATIVE | ZERO,
    )
for name in ("bending_stiffness", "torsional_stiffness", "axial_stiffness"):
    row(
        "Rope",
        name,
        lambda v, name=name: rope(**{name: v}),
        without(NOT_A_NUMBER, "none"),
        NOT_FINITE | NEGATIVE | ZERO,
    )
for name in ("rotary_inertia", "polar_inertia"):
    row(
        "Rope",
        name,
        lambda v, name=name: rope(**{name: v}),
        without(NOT_A_NUMBER, "none"),
        NOT_FINITE | NEGATIVE,
    )
row(
    "Rope",
    "lay_coupling",
    lambda v: rope(axial_stiffness=1.0, lay_coupling=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | {"indefinite": 10.0, "indefinite_negative": -1e200},
)
row(
    "Rope",
    "lay_slope",
    lambda v: rope(lay_slope=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE,
)
row("Rope.replace", "length", lambda v: rope().replace(length=v), NOT_A_NUMBER, NOT_FINITE | ZERO)

for name in ("x", "z", "alpha", "beta"):
    row(
        "End",
        name,
        lambda v, name=name: rd.End(**{name: v}),
        NOT_A_WORD | {"bool": True},
        {"unknown": "glued", "empty": "", "capital": "Held"},
    )
for name, wrong in (
    ("spring", ZERO),
    ("dashpot", ZERO | NEGATIVE),
    ("mass", NEGATIVE),
):
    row(
        "End",
        name,
        lambda v, name=name: rd.End(z="free", **{name: v}),
        {"none": None, "number": 3.0, "list": [("z", 1.0)], "text": "z", "number_key": {3: 1.0}},
        {"unknown_key": {"y": 1.0}, "held_key": {"beta": 1.0}},
    )
    row(
        "End",
        f"{name}['z']",
        lambda v, name=name: rd.End(z="free", **{name: {"z": v}}),
        NOT_A_NUMBER,
        NOT_FINITE | wrong,
    )

PARTS = {
    "PointMass": lambda **v: rd.PointMass(**{"x": 0.5, "mass": 1.0} | v),
    "Spring": lambda **v: rd.Spring(**{"x": 0.5, "stiffness": 1.0} | v),
    "Dashpot": lambda **v: rd.Dashpot(**{"x": 0.5, "damping": 1.0} | v),
    "Support": lambda **v: rd.Support(**{"x": 0.5} | v),
}
for part, build in PARTS.items():
    row(part, "x", lambda v, build=build: build(x=v), NOT_A_NUMBER, NOT_FINITE)
    row(
        f"Scene with {part}",
        "parts[0].x",
        lambda v, build=build: scene(parts=[build(x=v)]),
        {},
        {"left": -0.01, "right": 1.01, "far": 1e300, "minus_far": -1e300},
    )
for name in ("mass", "rotary_inertia", "polar_inertia"):
    row(
        "PointMass",
        name,
        lambda v, name=name: PARTS["PointMass"](**{name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | NEGATIVE,
    )
row(
    "Spring",
    "stiffness",
    lambda v: rd.Spring(0.5, v),
    NOT_A_NUMBER,
    NOT_FINITE | ZERO,
)
for name, wrong in (("damping", ZERO), ("exponent", {})):
    row(
        "Dashpot",
        name,
        lambda v, name=name: PARTS["Dashpot"](**{name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | wrong | NEGATIVE,
    )
for part in ("Spring", "Dashpot", "Support"):
    row(
        part,
        "coordinate",
        lambda v, part=part: PARTS[part](coordinate=v),
        NOT_A_WORD,
        {"unknown": "y", "empty": "", "capital": "Z"},
    )
    row(
        f"Scene with {part}",
        "parts[0].coordinate",
        lambda v, part=part: scene(parts=[PARTS[part](coordinate=v)]),
        {},
        {"absent": "x"},
    )

STRETCHES = {
    "AddedMass": lambda **v: rd.AddedMass(**{"start": 0.2, "stop": 0.6, "linear_density": 1.0} | v),
    "LocalChange": lambda **v: rd.LocalChange(**{"start": 0.2, "stop": 0.6} | v),
}
for part, build in STRETCHES.items():
    for name in ("start", "stop"):
        row(part, name, lambda v, b=build, n=name: b(**{n: v}), NOT_A_NUMBER, NOT_FINITE)
    row(
        part,
        "stop",
        lambda v, build=build: build(stop=v),
        {},
        {"at_start": 0.2, "before": 0.1, "far_before": -1e300},
    )
    row(
        f"Scene with {part}",
        "parts[0].start",
        lambda v, build=build: scene(parts=[build(start=v, stop=1.1e300)]),
        {},
        {"left": -0.01, "right": 1.01, "far": 1e300, "minus_far": -1e300},
    )
    row(
        f"Scene with {part}",
        "parts[0].stop",
        lambda v, build=build: scene(parts=[build(stop=v)]),
        {},
        {"right": 1.01, "far": 1e300, "too_near": 0.2 + 1e-10},
    )
for name in ("linear_density", "polar_inertia"):
    row(
        "AddedMass",
        name,
        lambda v, name=name: STRETCHES["AddedMass"](**{name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | NEGATIVE,
    )
for name in ("bending", "torsion", "density"):
    row(
        "LocalChange",
        name,
        lambda v, name=name: STRETCHES["LocalChange"](**{name: v}),
        NOT_A_NUMBER,
        NOT_FINITE | NEGATIVE | ZERO,
    )

row(
    "StiffnessDamping",
    "gamma",
    rd.StiffnessDamping,
    NOT_A_NUMBER,
    NOT_FINITE | NEGATIVE,
)
row(
    "RayleighDamping",
    "mass",
    lambda v: rd.RayleighDamping(v, 0.0),
    NOT_A_NUMBER,
    NOT_FINITE | NEGATIVE,
)
row(
    "RayleighDamping",
    "stiffness",
    lambda v: rd.RayleighDamping(0.0, v),
    NOT_A_NUMBER,
    NOT_FINITE | NEGATIVE,
)

row("LossFactor", "eta", rd.LossFactor, NOT_A_NUMBER, NOT_FINITE | NEGATIVE)
row("ViscousDamping", "coefficient", rd.ViscousDamping, NOT_A_NUMBER, NOT_FINITE | NEGATIVE)
row(
    "ModalDamping",
    "ratio",
    rd.ModalDamping,
    without(NOT_A_NUMBER, "list", "array", "empty")
    | {"rows": [[0.1]], "ragged": [0.1, [0.2]], "array": np.array(0.1)},
    NOT_FINITE | NEGATIVE | {"empty": []},
)
row(
    "ModalDamping",
    "ratio[1]",
    lambda v: rd.ModalDamping([0.01, v]),
    without(NOT_A_NUMBER, "list", "array", "empty"),
    NOT_FINITE | NEGATIVE,
)

row("Scene", "rope", lambda v: scene(rope=v), NOT_A_NUMBER | {"class": rd.Rope})
row("Scene", "tension", lambda v: scene(tension=v), NOT_A_NUMBER, NOT_FINITE)
row(
    "Scene of a string",
    "tension",
    lambda v: rd.Scene(rd.Rope(1.0, 0.1), tension=v),
    {},
    {"zero": 0.0, "negative": -1.0},
)
row(
    "Scene",
    "ends",
    lambda v: scene(ends=v),
    {
        "none": None,
        "word": "clamped",
        "end": rd.End(),
        "number": 3,
        "none_inside": ("clamped", None),
        "number_inside": (3, "clamped"),
        "class_inside": (rd.End, "clamped"),
    },
    {
        "empty": (),
        "one": ("clamped",),
        "three": ("clamped",) * 3,
        "unknown": ("clamped", "glued"),
        "empty_word": ("", "clamped"),
    },
)
row(
    "Scene",
    "damping",
    lambda v: scene(damping=v),
    {
        "number": 1e-4,
        "nan": NAN,
        "text": "stiffness",
        "dict": {"gamma": 1e-4},
        "class": rd.StiffnessDamping,
        "none_inside": (None,),
        "number_inside": [rd.StiffnessDamping(0.0), 0.1],
        "complex": 1j,
    },
)
row(
    "Scene",
    "parts",
    lambda v: scene(parts=v),
    {
        "none": None,
        "number": 3,
        "text": "mass",
        "part": rd.Support(0.5),
        "none_inside": [None],
        "class_inside": [rd.Support],
        "end_inside": [rd.Support(0.5), rd.End()],
        "nested": [[rd.Support(0.5)]],
        "dict": OrderedDict(mass=1.0),
    },
)
row(
    "Scene.without",
    "effect",
    lambda v: scene().without("twist", v),
    NOT_A_WORD | {"tuple": ("twist", "lay")},
    {"unknown": "flutter", "empty": "", "capital": "Twist", "class": "PointMass"},
)
row("Scene.replace", "tension", lambda v: scene().replace(tension=v), NOT_A_NUMBER, NOT_FINITE)
row("Scene.replace", "rope", lambda v: scene().replace(rope=v), NOT_A_NUMBER)

row(
    "Scene.compile",
    "elements",
    lambda v: scene().compile(elements=v),
    without(NOT_A_COUNT, "none"),
    BAD_COUNT | {"a_billion": 10**9},
)
row(
    "Scene.compile with parts",
    "elements",
    lambda v: scene(parts=[rd.Support(0.3), rd.Support(0.6)]).compile(elements=v),
    {},
    {"fewer_than_spans": 2},
)
row(
    "Scene.compile",
    "element",
    lambda v: scene().compile(elements=4, element=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "cubic", "empty": "", "no_geometric_stiffness": "difference"},
)
row(
    "Scene.compile",
    "tolerance",
    lambda v: scene().compile(tolerance=v, below=100.0),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO | {"whole": 1.0, "more": 2.5},
)
row(
    "Scene.compile",
    "below",
    lambda v: scene().compile(tolerance=1e-3, below=v),
    without(NOT_A_NUMBER, "none"),
    NOT_FINITE | NEGATIVE | ZERO,
)
row(
    "Scene.compile within a tolerance",
    "element",
    lambda v: scene().compile(tolerance=1e-3, below=100.0, element=v),
    without(NOT_A_WORD, "none"),
    {"unknown": "stiff", "continuous": "continuous", "no tension": "difference"},
)
row(
    "Scene.compile within a tolerance",
    "elements",
    lambda v: scene().compile(tolerance=1e-3, below=100.0, elements=v),
    {},
    {"some": 4, "none at all": 0, "text": "four", "huger": HUGER},
)
row(
    "Scene.compile without elements",
    "elements",
    lambda v: scene().compile(element=v),
    {},
    {"tensed": "tensed", "rigid": "rigid"},
)

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
    without(NOT_A_WORD, "list") | {"none_inside": ["sweep", None]},
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
    NOT_A_WORD,
    {"unknown": "magic", "of_responses_only": "band", "of_chains_only": "lapack"},
)
row("effect_cost", "repeat", lambda v: effect_cost(repeat=v), NOT_A_COUNT, BAD_COUNT)
row(
    "effect_cost",
    "progress",
    lambda v: effect_cost(progress=v),
    {"number": 3, "text": "yes", "nan": NAN, "list": [print]},
)
row(
    "EffectCost.verdict",
    "row",
    EFFECTS.verdict,
    {"none": None, "text": "0", "float": 0.0, "list": [0]},
    {"beyond": len(EFFECTS.effect), "negative": -1, "huge": HUGE},
)

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
    {"none": None, "numbers": [20.0], "number": 20.0, "modes": MODEL.modes(1), "class": rd.Peaks},
)

row(
    "Table.column",
    "name",
    lambda v: table().column(v),
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

CASES = [
    pytest.param(call, argument, value, error, id=f"{what}-{argument}-{name}".replace(" ", "_"))
    for what, argument, call, wrong_types, wrong_values in ARGUMENTS
    for values, error in ((wrong_types, TypeError), (wrong_values, rd.SceneError))
    for name, value in values.items()
]


def descriptions(value):
    """What a message may say of a value: itself, the part of it that is wrong, type or shape."""
    if value is HUGER:
        return ["int"]
    if isinstance(value, float):
        return [repr(value), f"got {value:g}", f"is {value:g}"]
    if isinstance(value, str):
        return [repr(value), f'"{value}"']
    inside = []
    if isinstance(value, (dict, OrderedDict)):
        inside = [*value.keys(), *value.values()]
    elif isinstance(value, (list, tuple)):
        inside = [*value, f"got {len(value)}"]
    elif isinstance(value, np.ndarray):
        inside = [value.shape, *value.ravel().tolist()]
    for one in list(inside):
        if isinstance(one, tuple):
            inside += one
    texts = [" ".join(repr(one).split())[:57] for one in [value, *inside]]
    texts += [one for one in inside if isinstance(one, str) and one.startswith("got ")]
    return [*texts, type(value).__name__]


@pytest.mark.parametrize(("call", "argument", "value", "error"), CASES)
def test_what_has_no_meaning_is_refused_by_name(call, argument, value, error):
    with pytest.raises((rd.SceneError, TypeError)) as caught:
        call(value)
    message = str(caught.value)
    assert isinstance(caught.value, error), message
    assert argument in message
    assert "must" in message
    assert any(text in message for text in descriptions(value)), message


# signatures: what Python itself refuses, by the argument's name
@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: rd.Rope(1.0), "linear_density"),
        (lambda: rd.Rope(1.0, 0.1, 1.0), "positional"),
        (lambda: rd.Rope(1.0, 0.1, stiffness=1.0), "stiffness"),
        (lambda: rope().replace(stiffness=1.0), "stiffness"),
        (lambda: rd.End(y="held"), "y"),
        (lambda: rd.PointMass(0.5), "mass"),
        (lambda: rd.Spring(0.5, 1.0, "z"), "positional"),
        (rd.Support, "x"),
        (lambda: rd.AddedMass(0.1, 0.2), "linear_density"),
        (lambda: rd.AddedMass(0.1, 0.2, 1.0, 1e-6), "positional"),
        (lambda: rd.LocalChange(0.1), "stop"),
        (lambda: rd.LocalChange(0.1, 0.2, 0.5), "positional"),
        (lambda: rd.LocalChange(0.1, 0.2, axial=0.5), "axial"),
        (rd.StiffnessDamping, "gamma"),
        (lambda: rd.RayleighDamping(1.0), "stiffness"),
        (rd.Scene, "rope"),
        (lambda: rd.Scene(rope(), 100.0), "positional"),
        (lambda: scene().replace(gravity=9.81), "gravity"),
        (lambda: scene().compile(elements=4, accuracy=1e-6), "accuracy"),
        (lambda: MODEL.modes(1, animated=True), "animated"),
        (lambda: MODEL.frf([1.0]), "drive"),
        (lambda: MODEL.frf([1.0], ("z", 0.5)), "positional"),
        (MODEL.static, "load"),
        (lambda: rd.ask.frf([1.0]), "drive"),
        (lambda: rd.ask.frf([1.0], ("z", 0.5)), "positional"),
        (lambda: rd.accuracy_cost(scene()), "question"),
        (lambda: rd.accuracy_cost(scene(), rd.ask.modes(1), [8]), "positional"),
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


@pytest.mark.parametrize(
    "given", [{"tolerance": 1e-3}, {"below": 100.0}], ids=["tolerance", "below"]
)
def test_tolerance_and_below_go_together(given):
    with pytest.raises(rd.SceneError, match=r"tolerance.*below"):
        scene().compile(**given)


@pytest.mark.parametrize("number", [10, 10**9])
def test_more_modes_than_the_model_has_is_refused_with_how_many_there_are(number):
    # 3 free nodes: z and nothing else has inertia
    with pytest.raises(rd.SolveError, match=f"number must be at most 3, .* got {number}"):
        MODEL.modes(number)


@pytest.mark.parametrize(
    ("name", "missing"),
    [
        ("lay_slope", "bending_stiffness"),
        ("lay_slope", "torsional_stiffness"),
        ("lay_coupling", "axial_stiffness"),
        ("lay_coupling", "torsional_stiffness"),
    ],
)
def test_lay_needs_the_stiffnesses_it_couples(name, missing):
    whole = {"axial_stiffness": 10.0, name: 0.1}
    with pytest.raises(rd.SceneError, match=f"{name} needs {missing}, got None"):
        rope(**whole | {missing: None})


@pytest.mark.parametrize("name", ["spring", "dashpot", "mass"])
def test_what_stands_at_an_end_needs_a_coordinate_that_the_scene_has(name):
    end = rd.End(x="free", **{name: {"x": 1.0}})
    with pytest.raises(
        rd.SceneError, match=rf"ends\[1\].{name} must .* \(z, alpha, beta\), got 'x'"
    ):
        scene(ends=("clamped", end))


@pytest.mark.parametrize("number", [HUGE, -HUGE, 10**308], ids=["huge", "minus_huge", "largest"])
def test_elements_of_an_absurd_size_are_refused_before_any_memory_is_taken(number):
    with pytest.raises(rd.SceneError, match="elements must be a whole number from 1 to 10000000"):
        scene().compile(elements=number)


ABSURD = {
    "short": {"length": 1e-200},
    "long": {"length": 1e200},
    "shortest": {"length": 5e-324},
    "light": {"linear_density": 5e-324},
    "heavy": {"linear_density": 1e308},
    "limp": {"bending_stiffness": 1e-320},
    "stiff": {"bending_stiffness": 1e308},
    "twists": {"torsional_stiffness": 5e-324},
    "turns_heavily": {"rotary_inertia": 1e308},
    "steep": {"lay_slope": 1e300},
    "slack": {"tension": 5e-324},
    "tight": {"tension": 1e308},
    "squeezed": {"tension": -1e308},
}
QUESTIONS = {
    "modes": (lambda model: model.modes(1), ("frequency", "shape", "modal_mass")),
    "frf": (lambda model: model.frf([1.0], drive=("z", 0.5)), ("value", "rounding_error")),
    "static": (lambda model: model.static({("z", 0.5): 1.0}), ("displacement", "force")),
    "frf_between": (lambda model: model.frf([1.0], drive=("z", 0.3e-2)), ("value",)),
}


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("name", ABSURD)
def test_absurd_magnitudes_are_answered_or_refused_never_nan(name, question):
    change = dict(ABSURD[name])
    tension = change.pop("tension", 100.0)
    ask, fields = QUESTIONS[question]
    length = change.get("length", 1.0)
    try:
        model = rd.Scene(rope(**change), tension=tension).compile(elements=4)
        if length < 0.5:  # the questions stand at 0.5 m: off this rope
            ask = {
                "modes": ask,
                "static": lambda model: model.static({("z", length / 2): 1.0}),
            }.get(question, lambda model: model.frf([1.0], drive=("z", length / 2)))
        answer = ask(model)
    except rd.RopedynError as refusal:
        assert len(str(refusal)) > 20  # a sentence
        return
    for field in fields:
        assert np.isfinite(getattr(answer, field)).all(), field


@pytest.mark.parametrize("frequency", [1e154, 1e200, 1e308])
def test_frequencies_whose_square_overflows_are_refused_by_name(frequency):
    with pytest.raises(rd.RopedynError, match=r"frequency.*e\+"):
        MODEL.frf([1.0, frequency], drive=("z", 0.5))


@pytest.mark.parametrize("below", [1e154, 1e200, 1e308])
def test_a_limit_above_every_mode_finds_all_of_them(below):
    # a bound that is larger than any frequency has a meaning, whatever its square does
    assert len(MODEL.modes(below=below).frequency) == 3


@pytest.mark.parametrize("exponent", [0.5, 2])
@pytest.mark.parametrize(
    "ask",
    [
        lambda model: model.modes(2),
        lambda model: model.count(below=50.0),
        lambda model: model.frf([10.0], drive=("z", 0.5)),
        lambda model: model.static({("z", 0.5): 1.0}),
        lambda model: model.damping(),
    ],
    ids=["modes", "count", "frf", "static", "damping"],
)
def test_a_dashpot_that_is_not_linear_is_refused_where_time_is_not_integrated(ask, exponent):
    parts = [rd.Support(0.3), rd.Dashpot(0.5, 1.0, exponent=exponent)]
    model = scene(parts=parts).compile(elements=4)
    with pytest.raises(rd.SceneError, match=rf"parts\[1\].exponent must be 1, got {exponent:.1f}"):
        ask(model)
