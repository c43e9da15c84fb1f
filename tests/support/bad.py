"""Values without a meaning, and what must be said of them."""

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
    "unknown_coordinate": ("w", 0.5),
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
FRF = MODEL.frf(np.linspace(1.0, 60.0, 60), drive=("z", 0.5))
PEAKS = rd.Peaks([20.0, 50.0])


def without(values, *names):
    return {k: v for k, v in values.items() if k not in names}


def add(table, what, argument, call, wrong_types, wrong_values=None):
    """Add what is called with a value: what raises TypeError there, and what SceneError."""
    table.append((what, argument, call, wrong_types, wrong_values or {}))


def arguments(table):
    """Return a parameter of a test for each argument: all that it refuses."""
    return [pytest.param(*row[1:], id=f"{row[0]}-{row[1]}".replace(" ", "_")) for row in table]


def refuses(argument, call, wrong_types, wrong_values):
    """Each message names the argument, what must hold, and what was given."""
    complaints = [
        f"{name}: {complaint}"
        for values, error in ((wrong_types, TypeError), (wrong_values, rd.SceneError))
        for name, value in values.items()
        if (complaint := complaint_about(argument, call, value, error))
    ]
    assert not complaints, "\n".join(complaints)


def complaint_about(argument, call, value, error):
    """What is wrong with how a value is refused, or None."""
    try:
        call(value)
    except Exception as caught:
        message = str(caught)
        if not isinstance(caught, error):
            return f"raises {caught!r}, not {error.__name__}"
    else:
        return "is accepted"
    if argument not in message or "must" not in message:
        return f"does not say what of {argument} must hold: {message}"
    if not any(text in message for text in descriptions(value)):
        return f"does not say what was given: {message}"
    return None


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
