"""Bad input: each argument of what describes a scene refuses what has no meaning and says why."""

from collections import OrderedDict
from functools import partial

import numpy as np
import pytest
from bad import (
    BAD_COUNT,
    HUGE,
    HUGER,
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
        {"unknown_key": {"w": 1.0}, "held_key": {"beta": 1.0}},
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
        {"unknown": "w", "empty": "", "capital": "Z"},
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


@pytest.mark.parametrize(("argument", "call", "wrong_types", "wrong_values"), arguments(ARGUMENTS))
def test_what_has_no_meaning_is_refused_by_name(argument, call, wrong_types, wrong_values):
    refuses(argument, call, wrong_types, wrong_values)


# signatures: what Python itself refuses, by the argument's name
@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: rd.Rope(1.0), "linear_density"),
        (lambda: rd.Rope(1.0, 0.1, 1.0), "positional"),
        (lambda: rd.Rope(1.0, 0.1, stiffness=1.0), "stiffness"),
        (lambda: rope().replace(stiffness=1.0), "stiffness"),
        (lambda: rd.End(w="held"), "w"),
        (lambda: rd.PointMass(0.5), "mass"),
        (lambda: rd.Spring(0.5, 1.0, "z"), "positional"),
        (rd.Support, "x"),
        (lambda: rd.AddedMass(0.1, 0.2), "linear_density"),
        (lambda: rd.AddedMass(0.1, 0.2, 1.0, 1e-6), "positional"),
        (lambda: rd.LocalChange(0.1), "stop"),
        (lambda: rd.LocalChange(0.1, 0.2, 0.5), "positional"),
        (lambda: rd.LocalChange(0.1, 0.2, shear=0.5), "shear"),
        (rd.StiffnessDamping, "gamma"),
        (lambda: rd.RayleighDamping(1.0), "stiffness"),
        (rd.Scene, "rope"),
        (lambda: rd.Scene(rope(), 100.0), "positional"),
        (lambda: scene().replace(gravity=9.81), "gravity"),
        (lambda: scene().compile(elements=4, accuracy=1e-6), "accuracy"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_missing_and_unknown_arguments_are_named(call, argument):
    with pytest.raises(TypeError, match=argument):
        call()


@pytest.mark.parametrize(
    "given", [{"tolerance": 1e-3}, {"below": 100.0}], ids=["tolerance", "below"]
)
def test_tolerance_and_below_go_together(given):
    with pytest.raises(rd.SceneError, match=r"tolerance.*below"):
        scene().compile(**given)


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
