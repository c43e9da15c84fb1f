"""Chains converge with the order that they say, along each coordinate."""

import math

import numpy as np
import pytest

import ropedyn as rd

ROPE = rd.Rope(1.3, 0.1, bending_stiffness=2.0)
STRING = rd.Rope(1.3, 0.1)
TWIST = {"torsional_stiffness": 1.0, "polar_inertia": 1e-5}
CASES = {
    "bending": (rd.Scene(ROPE, tension=300.0), "transverse", 4),
    "bending beside twist": (rd.Scene(ROPE.replace(**TWIST), tension=300.0), "transverse", 4),
    "twist beside bending": (rd.Scene(ROPE.replace(**TWIST), tension=300.0), "torsional", 2),
    "stretch": (rd.Scene(ROPE.replace(axial_stiffness=1e4), tension=300.0), "axial", 2),
    "string": (rd.Scene(STRING, tension=300.0), "transverse", 2),
    "rotary inertia": (
        rd.Scene(ROPE.replace(rotary_inertia=1e-3), tension=300.0),
        "transverse",
        2,
    ),
    "twist coupled by the lay": (
        rd.Scene(
            ROPE.replace(torsional_stiffness=1.0, polar_inertia=1e-3, lay_slope=0.4),
            tension=300.0,
        ),
        "transverse",
        2,
    ),
    "hinge": (rd.Scene(ROPE, tension=300.0, parts=[rd.Hinge(0.325)]), "transverse", 2),
    "hinge and support": (
        rd.Scene(ROPE, tension=300.0, parts=[rd.Hinge(0.325), rd.Support(0.325)]),
        "transverse",
        4,
    ),
    "part with springs and inertia": (
        rd.Scene(ROPE, tension=300.0, parts=[rd.PointMass(0.325, 0.05, rotary_inertia=1e-2)]),
        "transverse",
        4,
    ),
    "resonator": (
        rd.Scene(ROPE, tension=300.0, parts=[rd.Resonator(0.325, 0.02, 60.0)]),
        "transverse",
        4,
    ),
}
FAMILY = {"transverse": "z", "torsional": "alpha", "axial": "x"}


@pytest.mark.parametrize("name", CASES)
def test_chain_converges_with_the_order_that_it_says(name):
    scene, family, order = CASES[name]
    exact = scene.compile().modes(6)
    k = int(np.flatnonzero(exact.family == family)[0])
    coarse, fine = (scene.compile(elements=n) for n in (64, 128))
    assert fine.mesh_order[FAMILY[family]] == order
    errors = [abs(m.modes(6).eigenvalue[k] / exact.eigenvalue[k] - 1) for m in (coarse, fine)]
    # the next term is (k h)^2 of this one, 0.02 at most
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


def test_rotary_inertia_turns_nodes_by_so_much():
    """-(lambda j beta)^2 l^2/12B per length: of lambda -lambda j^2 k^2 l^2/12B(mu + j k^2)."""
    j, n = 1e-3, 128
    scene = rd.Scene(ROPE.replace(rotary_inertia=j), tension=300.0, ends=("pinned", "pinned"))
    exact, chain = scene.compile().modes(1), scene.compile(elements=n).modes(1)
    k, value = np.pi / 1.3, exact.eigenvalue[0]
    expected = -value * j**2 * k**2 * (1.3 / n) ** 2 / (24.0 * (0.1 + j * k**2))
    # beside it l^4: 1e-8 of 4e-6
    assert chain.eigenvalue[0] / value - 1 == pytest.approx(expected, rel=1e-2)


def test_cost_counts_what_is_read():
    modes = rd.Scene(STRING, tension=300.0).compile(elements=16).modes(3)
    before = modes.cost.seconds
    assert modes.mesh_error.all()
    after = modes.cost.seconds
    assert after > before
    assert modes.mesh_error.all()
    assert modes.cost.seconds == after


@pytest.mark.parametrize("elements", [None, 8])
def test_unknowns_of_continuous_spans_are_those_of_stations(elements):
    element = "continuous" if elements else None
    scene = rd.Scene(STRING, tension=300.0)
    assert scene.compile(elements=elements, element=element).size == 0
    parts = [rd.PointMass(0.4, 0.1), rd.Support(0.8)]
    assert scene.replace(parts=parts).compile(elements=elements, element=element).size == 1
