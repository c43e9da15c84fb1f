"""Twist and tension at twice the frequency, against assembled matrices with quadratic terms."""

import math

import numpy as np
import pytest
import second_order
from conftest import long

import ropedyn as rd
from ropedyn.chain.compile import section
from ropedyn.response import second_harmonic
from ropedyn.scene.end import end_of

B, C, EA, D, T, LENGTH = 1.54, 0.1485, 6e5, 120.0, 2830.0, 1.35
ROPE = rd.Rope(
    LENGTH,
    0.1162,
    bending_stiffness=B,
    torsional_stiffness=C,
    axial_stiffness=EA,
    lay_coupling=D,
    polar_inertia=1.394e-7,
    rotary_inertia=1e-5,
)
SWIVEL = "clamped", rd.End(alpha="free")
DAMPING = (rd.StiffnessDamping(1e-4), rd.ViscousDamping(0.5))
NUMBER = {"x": 0, "z": 1, "alpha": 2, "beta": 3}
RESPONSES = [("alpha", LENGTH), ("alpha", 0.54), ("x", 0.54), ("F_x", 0.0), ("M_alpha", 0.0)]


def scene(rope=ROPE, ends=SWIVEL, parts=(), tension=T):
    return rd.Scene(rope, tension=tension, ends=ends, damping=DAMPING, parts=parts)


def assembled(of, elements):
    """Return the same rope by matrices."""
    rope = of.rope
    held = tuple(
        tuple(NUMBER[c] for c in end_of(end).term().held if c in NUMBER) for end in of.ends
    )
    masses = tuple((p.x, p.mass) for p in of.parts)
    inertia = (rope.linear_density, rope.linear_density, rope.polar_inertia, rope.rotary_inertia)
    return second_order.Second(
        second_order.Rope(
            rope.length,
            np.linalg.inv(section(rope)),
            of.tension,
            inertia,
            of.dampings[0].gamma,
            of.dampings[1].coefficient,
            held,
            masses,
        ),
        elements,
    )


def by_matrices(of, elements, frequency, drive, responses=RESPONSES):
    rope = assembled(of, elements)
    motion, (tension, torque) = rope.twice(frequency, (NUMBER[drive[0]], drive[1]))
    at_left = {"F_x": tension, "M_alpha": torque}
    return np.array(
        [at_left[c] if c in at_left else motion[rope.number(NUMBER[c], x)] for c, x in responses]
    )


CASES = {
    "swivel": (scene(), ("z", 0.27)),
    "with masses": (scene(parts=[rd.PointMass(0.27, 0.01), rd.PointMass(0.81, 0.03)]), ("z", 0.27)),
    "alpha held": (scene(ends=("pinned", "clamped")), ("z", 0.27)),
    "x free": (scene(ends=("clamped", rd.End(x="free", alpha="free"))), ("z", 0.81)),
    "moment": (scene(), ("beta", 0.27)),
    "lay of both kinds": (scene(ROPE.replace(lay_slope=0.05)), ("z", 0.27)),
    "twisted, lay of both kinds": (scene(ROPE.replace(lay_slope=0.05)), ("alpha", 0.54)),
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("frequency", [93.8, *long(20.0, 260.0)])
def test_twice_the_frequency_is_what_matrices_with_quadratic_terms_say(name, frequency):
    of, drive = CASES[name]
    found = of.compile().frf([frequency], drive=drive, response=RESPONSES, harmonic=2).value[:, 0]
    coarse, fine = (by_matrices(of, n, frequency, drive) for n in (100, 200))
    # bars are of second order: what is extrapolated is of fourth, 7e-5 off at most, 1e-3 with half
    # as many elements
    right = fine + (fine - coarse) / 3
    assert (np.abs(found - right) <= 1e-4 * np.abs(right)).all()
    assert (found[right == 0] == 0).all()


def test_a_string_pushed_slowly_twists_its_swivel_by_the_mean_of_its_slopes():
    rope = ROPE.replace(bending_stiffness=None, rotary_inertia=None)
    a, T = 0.4 * LENGTH, 700.0
    model = rd.Scene(rope, tension=T, ends=SWIVEL).compile()
    found = model.frf([0.0], drive=("z", a), response=[("alpha", LENGTH), ("F_x", 0.3)], harmonic=2)
    left, right = (LENGTH - a) / (LENGTH * T), a / (LENGTH * T)
    mean = (left**2 * a + right**2 * (LENGTH - a)) / LENGTH / 4
    tension = EA * mean - D**2 * mean / C
    exact = [-D * LENGTH / C * mean, tension]
    # sweeps and integrals to rounding
    np.testing.assert_allclose(found.value[:, 0], exact, rtol=1e-12)
    assert (found.rounding_error < 1e-11).all()


def test_a_mode_of_even_slopes_drives_no_twist_that_is_even():
    # held at both ends, driven in the middle: z'^2 is even, its gradient odd
    model = scene(ends=("clamped", "clamped")).compile()
    asked = {"drive": ("z", LENGTH / 2), "harmonic": 2}
    middle, side = model.frf(
        [60.0], response=[("alpha", LENGTH / 2), ("alpha", LENGTH / 4)], **asked
    ).value[:, 0]
    assert abs(middle) < 1e-10 * abs(side)


@pytest.mark.parametrize(
    ("rope", "drive", "response"),
    [
        (ROPE, ("z", 0.3), ("z", 0.3)),
        (ROPE, ("z", 0.3), ("beta", 0.3)),
        (ROPE, ("alpha", 0.3), ("alpha", LENGTH)),
        (ROPE, ("x", 0.3), ("F_x", 0.0)),
        (ROPE.replace(lay_coupling=None), ("z", 0.3), ("alpha", LENGTH)),
    ],
)
def test_what_is_zero_is_so_to_the_bit(rope, drive, response):
    found = scene(rope).compile().frf([60.0], drive=drive, response=response, harmonic=2)
    assert found.value.tolist() == [[0.0]]
    assert found.rounding_error.tolist() == [[0.0]]


def test_motion_of_an_end_is_per_its_square():
    # an end that moves slowly across turns a string by u/L, all of it
    rope = ROPE.replace(bending_stiffness=None, rotary_inertia=None)
    model = rd.Scene(rope, tension=T, ends=SWIVEL).compile()
    asked = {"drive": ("end", 0, "z"), "response": ("alpha", LENGTH), "harmonic": 2}
    found = model.frf([0.0], **asked)
    exact = -D * LENGTH / C / LENGTH**2 / 4
    assert found.value[0, 0] == pytest.approx(exact, rel=1e-12)
    assert found.labels == ("alpha at 1.350 m [rad/m^2]",)


def test_errors_are_told_of_integral_and_rounding():
    of, drive = CASES["with masses"]
    lines = np.linspace(5.0, 600.0, 30)
    model = of.compile()
    found = model.frf(lines, drive=drive, response=RESPONSES[0], harmonic=2)
    # other pieces and nodes: what stands beside the rope moves no place, but its station does
    parts = [*of.parts, rd.Spring(0.611, 1e-12), rd.Spring(1.1, 1e-12)]
    other = (
        of.replace(parts=parts).compile().frf(lines, drive=drive, response=RESPONSES[0], harmonic=2)
    )
    away = np.abs(found.value - other.value) / np.abs(other.value)
    assert (away <= found.rounding_error + other.rounding_error).all()
    assert found.rounding_error.max() < 1e-8


def test_drives_are_alone_and_lines_come_in_any_number(monkeypatch):
    of, _ = CASES["swivel"]
    lines = np.linspace(5.0, 200.0, 7)
    drives = [("z", 0.3), ("z", 0.8)]
    both = of.compile().frf(lines, drive=drives, response=RESPONSES, harmonic=2)
    assert both.value.shape == (2, len(RESPONSES), 7)
    monkeypatch.setattr(second_harmonic, "TOLD", 1)
    for k, drive in enumerate(drives):
        one = of.compile().frf(lines, drive=drive, response=RESPONSES, harmonic=2)
        np.testing.assert_allclose(one.value, both.value[k], rtol=1e-9)


def test_velocities_turn_twice_as_fast(tmp_path):
    of, drive = CASES["swivel"]
    asked = {"drive": drive, "response": ("alpha", LENGTH), "harmonic": 2}
    found = of.compile().frf([30.0], **asked)
    mobility = of.compile().frf([30.0], quantity="mobility", **asked)
    np.testing.assert_allclose(mobility.value, found.value * 2j * math.tau * 30.0, rtol=1e-14)
    np.testing.assert_allclose(found.to("mobility").value, mobility.value, rtol=1e-14)
    assert mobility.labels == ("alpha at 1.350 m [rad/s/N^2]",)
    assert "rad/N^2" in str(found)
    assert "rad/N^2" in found.plot().get_legend_handles_labels()[1][0]
    found.save(tmp_path / "twice.nc")
    again = rd.load(tmp_path / "twice.nc")
    assert isinstance(again, rd.SecondHarmonic)
    assert (again.value == found.value).all()


@pytest.mark.parametrize(
    "call",
    [
        lambda found: found.peaks(),
        lambda found: found.write("twice.csv"),
        lambda found: found.derivative("tension"),
        lambda found: rd.compare(found, [30.0, 60.0]),
    ],
)
def test_what_a_second_harmonic_does_not_have_is_refused(call):
    of, drive = CASES["swivel"]
    found = of.compile().frf([30.0], drive=drive, response=("alpha", LENGTH), harmonic=2)
    with pytest.raises(rd.SceneError, match="harmonic 2"):
        call(found)


REFUSED = {
    "harmonic 3": ({"harmonic": 3}, {}, rd.SceneError, "harmonic must be"),
    "harmonic 0": ({"harmonic": 0}, {}, rd.SceneError, "harmonic must be"),
    "harmonic of no kind": ({"harmonic": "2"}, {}, TypeError, "harmonic must be"),
    "harmonic of half": ({"harmonic": 2.0}, {}, TypeError, "harmonic must be"),
    "decay": ({"decay": 1.0}, {}, rd.SceneError, "decay must be 0 where harmonic is 2"),
    "solver": ({"solver": "lapack"}, {}, rd.SceneError, 'solver must be "sweep" where harmonic'),
    "no response": ({"response": None}, {}, rd.SceneError, "response must be given where harmonic"),
    "quantity": ({"quantity": "velocity"}, {}, rd.SceneError, "quantity must be"),
    "no stretch": (
        {"response": ("alpha", 0.3)},
        {"rope": ROPE.replace(axial_stiffness=None, lay_coupling=None)},
        rd.SceneError,
        "axial_stiffness of the rope must be given where harmonic is 2",
    ),
    "gravity": (
        {},
        {"gravity": rd.Gravity()},
        rd.SceneError,
        "gravity must be None where harmonic",
    ),
    "modal damping": ({}, {"damping": rd.ModalDamping(0.01)}, rd.SceneError, "must not be modal"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_second_harmonic_is_refused_by_name(name):
    asked, changes, kind, words = REFUSED[name]
    model = scene().replace(**changes).compile()
    given = {"drive": ("z", 0.3), "response": ("F_x", 0.0), "harmonic": 2} | asked
    with pytest.raises(kind, match=words):
        model.frf([60.0], **given)


def test_chains_are_refused_by_name():
    with pytest.raises(rd.SceneError, match="elements must be left out where harmonic is 2"):
        scene().compile(elements=8).frf([1.0], drive=("z", 0.3), response=("x", 0.3), harmonic=2)


def test_the_tip_of_a_wire_has_no_second_harmonic():
    wire = rd.BrokenWire(0.4, 0.05, 3e-4, radius=2e-3)
    model = scene(parts=[wire]).compile()
    with pytest.raises(rd.SceneError, match="tip of a wire where harmonic is 2"):
        model.frf([1.0], drive=("z", 0.3), response=("wire", 0), harmonic=2)
