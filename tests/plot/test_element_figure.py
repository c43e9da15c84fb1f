"""Figures 2 to 4 of the 2015 study: what they show is calculated."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.plot.element import STIFFNESS, LoadedElement, element


def test_load_motion_and_reaction_are_those_of_the_rope():
    loaded = LoadedElement.drawn()
    axis, (C, B, A) = loaded.axis, STIFFNESS
    rope = rd.Rope(axis, 1.0, bending_stiffness=(B, A), torsional_stiffness=C)
    model = rd.Scene(rope, ends=("clamped", "free"), planes="both").compile()
    own, sign = axis.frame(axis.length), np.array([1.0, -1.0, 1.0])  # beta = -theta_y
    load = [*(own.T @ loaded.force), *(own.T @ loaded.moment * sign)]
    at = [(c, axis.length) for c in model.coordinates]
    static = model.static(dict(zip(at, load)), points=1)
    u, theta = loaded.moved()
    assert own.T @ u == pytest.approx(static.displacement[-1, :3], rel=1e-11)
    assert own.T @ theta * sign == pytest.approx(static.displacement[-1, 3:], rel=1e-11)
    # what holds the left end is against V and L there
    force, moment = loaded.cut(0.0)
    first = axis.frame(0.0)
    assert -first.T @ force == pytest.approx(static.force[0, :3], rel=1e-11)
    assert -first.T @ moment * sign == pytest.approx(static.force[0, 3:], rel=1e-11)


def test_three_panels_are_drawn():
    figure = element()
    assert [ax.get_title()[0] for ax in figure.axes] == ["2", "3", "4"]
