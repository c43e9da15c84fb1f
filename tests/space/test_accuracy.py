"""What accuracy costs where six coordinates are solved: one way, held against cuts of itself."""

import math

import numpy as np
import pytest

import ropedyn as rd

ROPE = rd.Rope(rd.Axis.arc(1.0, math.pi / 2), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
ARC = rd.Scene(ROPE, planes="both")
STAY = rd.Scene(
    rd.Rope(100.0, 2.0, axial_stiffness=2e7),
    tension=3000.0,
    gravity=rd.Gravity(inclination=0.5),
)


@pytest.mark.parametrize("scene", [ARC, STAY])
@pytest.mark.parametrize(
    "question", [rd.ask.modes(4), rd.ask.frf(np.linspace(1.0, 9.0, 5), drive=("z", 0.4))]
)
def test_spans_are_priced_and_chains_refused_by_a_row(scene, question):
    cost = rd.accuracy_cost(scene, question, repeat=1)
    is_chain = np.array(cost.element) != "continuous"
    assert all("must be left out" in text for text in cost.refusal[is_chain])
    # rounding of other arithmetic, within the bound
    assert 0 < cost.error[-1] <= cost.estimated_error[-1]
    assert cost.refusal[-1] == ""
    assert "take continuous spans" in cost.verdict


def test_cuts_change_nothing_but_rounding():
    whole = ARC.compile().modes(8)
    cut = ARC.compile(elements=7, element="continuous")
    assert len(cut.x) == 8
    found = cut.modes(8)
    assert (
        np.abs(found.frequency - whole.frequency) <= found.rounding_error + whole.rounding_error
    ).all()
    with pytest.raises(rd.SceneError, match="elements must be"):
        ARC.compile(elements=0, element="continuous")
    with pytest.raises(rd.SceneError, match="elements must be left out for a rope on an axis"):
        ARC.compile(elements=7)
