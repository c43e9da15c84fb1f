"""Numbers that are finite and absurd: answered or refused, never nan."""

import numpy as np
import pytest
from bad import MODEL, rope

import ropedyn as rd

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
