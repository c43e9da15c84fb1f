"""Undamped lines go by real numbers: the same answer as by complex ones, whoever goes along."""

import numpy as np
import pytest

import ropedyn as rd

SHORT = rd.Rope(2.0, 0.1, bending_stiffness=0.8)
MASSES = rd.Scene(
    SHORT,
    tension=1000.0,
    parts=[rd.PointMass(0.25 * k + 0.01 * k * (k % 3), 0.02) for k in range(1, 8)],
)
PARTS = rd.Scene(
    SHORT.replace(rotary_inertia=1e-5),
    tension=40.0,
    ends=("pinned", rd.End(z="free", beta="free", spring={"z": 1e3})),
    parts=[
        rd.Support(0.9),
        rd.Hinge(1.1),
        rd.Spring(0.3, 1e5),
        rd.PointMass(1.3, 0.1, rotary_inertia=1e-4),
        rd.PointMass(1.3 + 1e-6, 1e-9),
    ],
)
SCENES = {
    "masses": MASSES,
    "slack": MASSES.replace(tension=0.0),
    "compressed": MASSES.replace(tension=-20.0),
    "parts": PARTS,
}
HOWS = {
    "spans": {},
    "tensed": {"elements": 64},
    "long": {"elements": 301},
    "rigid": {"elements": 64, "element": "rigid"},
}
LINES = np.concatenate([[0.0], np.geomspace(1e-3, 1e5, 61), np.linspace(1.0, 200.0, 41)])
BARELY = rd.StiffnessDamping(1e-40)
"""So little that no digit of a response knows it, but the arithmetic is complex."""


@pytest.mark.parametrize("response", [("z", 0.5), ("z", 1.2)], ids=["driven", "apart"])
@pytest.mark.parametrize("how", HOWS)
@pytest.mark.parametrize("name", SCENES)
def test_real_arithmetic_answers_what_complex_arithmetic_does(name, how, response):
    scene = SCENES[name]
    one, other = (
        each.compile(**HOWS[how]).frf(LINES, drive=("z", 0.5), response=response)
        for each in (scene, scene.replace(damping=BARELY))
    )
    assert not np.any(one.value.imag)
    off = np.abs(one.value - other.value)
    assert (off <= one.rounding_limit + other.rounding_limit).all()


@pytest.mark.parametrize("how", HOWS)
@pytest.mark.parametrize("name", SCENES)
def test_a_line_has_the_same_bits_alone_and_among_others(name, how):
    model = SCENES[name].compile(**HOWS[how])
    many = model.frf(LINES, drive=("z", 0.5)).value.ravel()
    for k in range(0, len(LINES), 7):
        assert model.frf(LINES[k : k + 1], drive=("z", 0.5)).value.ravel()[0] == many[k]
