"""Many lines of ropes whose tension grows: what lies between a few is interpolated."""

import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.response.bands import FEW

G = 9.81
HOIST = rd.Scene(
    rd.Rope(1000.0, 8.4, bending_stiffness=2000.0),
    tension=rd.Tension(196e3, at="start"),
    gravity=rd.Gravity(G, inclination=math.pi / 2),
)
SCENES = {
    "hoist": HOIST,
    "with parts": HOIST.replace(
        parts=[rd.PointMass(430.0, 200.0), rd.Spring(810.0, 3e4), rd.Dashpot(300.0, 50.0)]
    ),
    "loss factor": HOIST.replace(damping=rd.LossFactor(0.03)),
    "viscous": HOIST.replace(damping=rd.ViscousDamping(0.4)),
    "of its rate": HOIST.replace(damping=rd.StiffnessDamping(2e-3)),
    "of its rate most": HOIST.replace(damping=rd.StiffnessDamping(20.0)),
    "foot in compression": rd.Scene(
        rd.Rope(40.0, 3.0, bending_stiffness=900.0),
        tension=rd.Tension(-60.0, at="start"),
        gravity=rd.Gravity(G, inclination=math.pi / 2),
    ),
}
ASK = {"drive": [("z", 0.25)], "response": [("z", 0.7), ("beta", 0.9)]}


def asked(scene, frequency, **how):
    """Return the response at shares of the length."""
    length = scene.rope.length
    points = {k: [(c, share * length) for c, share in v] for k, v in ASK.items()}
    return scene.compile(element="continuous").frf(frequency, **points, **how)


def lines_of(scene, count):
    """Return so many lines up to the tenth mode, none at one."""
    modes = scene.compile(element="continuous").modes(10).frequency
    return np.linspace(0.0037, 1.00123, count) * modes[-1]


@pytest.mark.parametrize("name", SCENES)
def test_many_lines_are_those_that_are_asked_a_few_at_a_time(name):
    scene = SCENES[name]
    f = lines_of(scene, 300)
    many = asked(scene, f)
    few = np.concatenate([asked(scene, part).value for part in np.split(f, 6)], axis=-1)
    off = np.abs(many.value - few)
    # both are rounded
    assert (off <= 2 * many.rounding_bound * np.abs(few)).all()
    # 5e-15 was measured in the median, which resonances do not multiply
    assert np.median(off / np.abs(few)) < 5e-14


def test_forces_at_the_left_end_are_those_of_the_piece_that_each_band_is_cut_into():
    # the piece that tells them was that of the highest line: 22 % off, or an error without a name
    scene = HOIST.replace(damping=(rd.ViscousDamping(0.4), rd.StiffnessDamping(2.8)))
    model, ask = scene.compile(), {"drive": ("z", 250.0), "response": [("F_z", 0), ("M_beta", 0)]}
    for f in (np.linspace(0.01, 3.0, 300), np.geomspace(0.01, 40.0, 300)):
        many = model.frf(f, **ask)
        few = np.concatenate([model.frf(part, **ask).value for part in np.split(f, 10)], axis=-1)
        off = np.abs(many.value - few) / np.abs(few)
        # 2e-14 in the median, which resonances do not multiply
        assert (off <= 2 * many.rounding_bound).all()
        assert np.median(off) < 2e-12


def test_lines_in_any_order_and_by_several_threads_have_the_same_bits():
    f = lines_of(HOIST, 200)
    order = np.random.default_rng(0).permutation(len(f))
    value = asked(HOIST, f).value
    np.testing.assert_array_equal(asked(HOIST, f[order]).value, value[..., order])
    np.testing.assert_array_equal(asked(HOIST, f, threads=3).value, value)


def test_a_decay_is_on_every_line():
    f = lines_of(HOIST, 2 * FEW)
    many = asked(HOIST, f, decay=0.2)
    few = np.concatenate([asked(HOIST, f[k::4], decay=0.2).value for k in range(4)], axis=-1)
    order = np.concatenate([np.arange(k, len(f), 4) for k in range(4)])
    np.testing.assert_allclose(many.value[..., order], few, rtol=1e-12)


def test_lines_of_all_heights_are_as_exact():
    # from 1e-4 of the first mode, where inertia is 1e-8 of what it is there, and at 0
    f = np.concatenate([[0.0], np.geomspace(1e-5, 0.6, 200)])
    many = asked(HOIST, f).value
    few = np.concatenate([asked(HOIST, part).value for part in np.array_split(f, 5)], axis=-1)
    off = np.abs(many - few) / np.abs(few)
    assert np.median(off) < 5e-14


@pytest.mark.parametrize("method", ["line", "modal"])
def test_motion_under_own_weight_is_that_of_a_fine_chain(method):
    # rates that grow, and circles around modes: pieces at frequencies are not theirs
    rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
    scene = rd.Scene(
        rope,
        tension=2830.0,
        gravity=rd.Gravity(inclination=math.pi / 2, sag=False),
        damping=rd.ViscousDamping(0.5),
    )
    ask = {"drive": ("z", 0.54), "response": ("z", 0.945), "force": rd.Impulse(1.0, duration=6e-3)}
    time = np.linspace(0, 0.05, 40)
    found = scene.compile().transient(time, method=method, tolerance=1e-4, **ask)
    coarse, fine = (
        scene.compile(elements=n).transient(time, method="modal", **ask).value for n in (200, 400)
    )
    truth = fine + (fine - coarse) / 3
    # off by 1.4e-6 and 5e-7, where pieces at |s| had 9e-3 by the line and 5e-5 by modes; chains are
    # 1.8e-6 apart
    most = np.abs(truth).max()
    assert (np.abs(found.value - truth) <= found.error + 2e-6 * most).all()
    assert found.error.max() <= 1e-4 * most
