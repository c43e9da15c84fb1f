"""Quantities of pint: every argument takes them in any unit of its dimension, and in no other."""

import dataclasses
import math
import numbers

import numpy as np
import pint
import pytest

import ropedyn as rd
from ropedyn.base import check
from ropedyn.scene import damping, force
from ropedyn.scene.parts import part
from ropedyn.scene.path import unit_of, value_at, with_values

Q = pint.UnitRegistry().Quantity

# each number that describes something: plain, its unit, and another unit of that dimension
DESCRIBED = {
    rd.Rope: {
        "length": (1.2, "m", "ft"),
        "linear_density": (0.1, "kg/m", "g/cm"),
        "bending_stiffness": (1.5, "N m^2", "kN mm^2"),
        "torsional_stiffness": (0.4, "N m^2", "kgf cm^2"),
        "axial_stiffness": (9e5, "N", "kN"),
        "lay_coupling": (-12.0, "N m", "J"),
        "lay_slope": (0.1, "", "percent"),
        "rotary_inertia": (1e-5, "kg m", "g mm"),
        "polar_inertia": (1e-6, "kg m", "g mm"),
    },
    rd.PointMass: {
        "x": (0.5, "m", "cm"),
        "mass": (0.02, "kg", "g"),
        "rotary_inertia": (1e-5, "kg m^2", "g cm^2"),
        "polar_inertia": (1e-6, "kg m^2", "g cm^2"),
    },
    rd.Spring: {"x": (0.5, "m", "inch"), "stiffness": (40.0, "N/m", "N/mm")},
    rd.Dashpot: {
        "x": (0.5, "m", "cm"),
        "damping": (4.0, "N s/m", "N s/mm"),
        "exponent": (1.0, "", "percent"),
    },
    rd.Support: {"x": (0.5, "m", "cm")},
    rd.Hinge: {"x": (0.5, "m", "cm"), "stiffness": (3.0, "N m", "N mm/rad")},
    rd.Resonator: {
        "x": (0.5, "m", "cm"),
        "mass": (0.02, "kg", "g"),
        "frequency": (50.0, "Hz", "rpm"),
        "damping_ratio": (0.02, "", "percent"),
    },
    rd.AddedMass: {
        "start": (0.1, "m", "cm"),
        "stop": (0.3, "m", "cm"),
        "linear_density": (0.2, "kg/m", "g/m"),
        "polar_inertia": (1e-6, "kg m", "g mm"),
    },
    rd.LocalChange: {
        "start": (0.1, "m", "cm"),
        "stop": (0.3, "m", "cm"),
        "bending": (0.9, "", "percent"),
        "torsion": (0.8, "", "percent"),
        "axial": (0.7, "", "percent"),
        "lay": (0.6, "", "percent"),
        "density": (0.7, "", "percent"),
    },
    rd.BrokenWire: {
        "x": (0.5, "m", "cm"),
        "length": (0.02, "m", "mm"),
        "diameter": (5e-4, "m", "um"),
        "radius": (2e-3, "m", "mm"),
        "angle": (0.3, "rad", "deg"),
        "youngs_modulus": (2e11, "N/m^2", "GPa"),
        "density": (7800.0, "kg/m^3", "g/cm^3"),
        "damping_ratio": (0.01, "", "percent"),
        "poissons_ratio": (0.3, "", "percent"),
    },
    rd.Stop: {
        "x": (0.5, "m", "cm"),
        "stiffness": (1e4, "N/m", "N/mm"),
        "gap": (1e-3, "m", "um"),
    },
    rd.StiffnessDamping: {"gamma": (1e-4, "s", "us")},
    rd.RayleighDamping: {"mass": (0.3, "1/s", "1/minute"), "stiffness": (1e-5, "s", "us")},
    rd.LossFactor: {"eta": (0.02, "", "percent")},
    rd.ViscousDamping: {"coefficient": (0.3, "N s/m^2", "Pa s")},
    rd.ModalDamping: {"ratio": (0.02, "", "percent")},
    rd.WireFriction: {},
    rd.Tension: {
        "friction": (0.2, "", "percent"),
        "mean": (300.0, "N", "kgf"),
        "amplitude": (30.0, "N", "lbf"),
        "frequency": (7.0, "Hz", "rad/s"),
        "phase": (0.3, "rad", "deg"),
    },
    rd.Gravity: {"g": (9.81, "m/s^2", "standard_gravity"), "inclination": (0.1, "rad", "deg")},
    rd.Sine: {
        "amplitude": (3.0, "N", "kgf"),
        "frequency": (20.0, "Hz", "rpm"),
        "phase": (0.2, "rad", "deg"),
    },
    rd.Chirp: {
        "amplitude": (3.0, "N m", "J"),
        "start": (2.0, "Hz", "rpm"),
        "stop": (0.03, "Hz", "1/hour"),
        "duration": (9.0, "s", "minute"),
        "phase": (0.2, "rad", "turn"),
    },
    rd.Step: {"amplitude": (1e-3, "m", "mm"), "time": (0.1, "s", "ms")},
    rd.Impulse: {
        "impulse": (0.2, "N s", "kg m/s"),
        "time": (0.1, "s", "ms"),
        "duration": (1e-3, "s", "us"),
    },
}
OTHERS = {
    rd.Stop: {"side": 1},
    rd.NodeForce: {"law": lambda t, u, v: 0.0},
    rd.WireFriction: {"stiffness": [3.0], "slip": [1e-4]},
}
"""Arguments without a unit that must be given."""
ARGUMENTS = [
    pytest.param(kind, name, id=f"{kind.__name__}-{name}")
    for kind, given in DESCRIBED.items()
    for name in given
]


def described(kind, **changes):
    plain = {name: value for name, (value, _, _) in DESCRIBED[kind].items()}
    return kind(**plain | OTHERS.get(kind, {}) | changes)


def test_no_number_of_a_description_is_left_out():
    kinds = {*part.KINDS, *damping.KINDS, *force.KINDS}
    kinds |= {rd.Rope, rd.Tension, rd.Gravity}
    assert {kind.__name__ for kind in kinds} - {k.__name__ for k in DESCRIBED} <= {"NodeForce"}
    for kind, given in DESCRIBED.items():
        made = described(kind)
        of_numbers = {
            field.name
            for field in dataclasses.fields(made)
            if isinstance(getattr(made, field.name), float)
        }
        assert of_numbers == set(given), kind


@pytest.mark.parametrize(("kind", "name"), ARGUMENTS)
def test_a_description_takes_any_unit_of_the_dimension(kind, name):
    value, unit, other = DESCRIBED[kind][name]
    given = Q(value, unit) if other == "rad/s" or "rpm" in other else Q(value, unit).to(other)
    if other == "rad/s":
        given = Q(2 * math.pi * value, other)
    if other == "rpm":
        given = Q(60 * value, other)
    made = described(kind, **{name: given})
    found = getattr(made, name)
    assert type(found) is float
    # a few factors of the registry, each rounded
    assert found == pytest.approx(value, rel=1e-14)
    assert dataclasses.replace(made, **{name: value}) == described(kind)


@pytest.mark.parametrize(("kind", "name"), ARGUMENTS)
def test_a_description_refuses_any_other_dimension(kind, name):
    unit = DESCRIBED[kind][name][1]
    with pytest.raises(rd.SceneError) as caught:
        described(kind, **{name: Q(3, "kelvin")})
    message = str(caught.value)
    assert message.startswith(f"{name} must be")
    assert unit in message
    assert repr(Q(3, "kelvin")) in message


@pytest.mark.parametrize(
    ("coordinate", "name", "good", "bad"),
    [
        ("z", "spring", "kN/m", "N m"),
        ("beta", "spring", "N m/deg", "N/m"),
        ("z", "dashpot", "kg/s", "N m s"),
        ("alpha", "dashpot", "N mm s", "N s/m"),
        ("x", "mass", "g", "kg m^2"),
        ("beta", "mass", "kg mm^2", "kg"),
    ],
)
def test_an_end_takes_the_unit_of_its_coordinate(coordinate, name, good, bad):
    end = rd.End(**{coordinate: "free", name: {coordinate: Q(2.0, good)}})
    (found,) = getattr(end, name).values()
    assert found == pytest.approx(Q(2.0, good).to_base_units().magnitude, rel=1e-14)
    with pytest.raises(rd.SceneError, match="must be a finite number"):
        rd.End(**{coordinate: "free", name: {coordinate: Q(2.0, bad)}})


@pytest.mark.parametrize("kind", [rd.Spring, rd.Stop])
def test_a_part_takes_the_unit_of_its_coordinate(kind):
    part = described(kind, coordinate="beta", stiffness=Q(3.0, "N m"), **gap(kind, "rad"))
    assert part.stiffness == 3.0
    with pytest.raises(rd.SceneError, match=r"stiffness must be .* \[N m\]"):
        described(kind, coordinate="beta", **gap(kind, "rad"), stiffness=Q(3.0, "N/m"))


def gap(kind, unit):
    return {"gap": Q(0.01, unit)} if kind is rd.Stop else {}


@pytest.mark.parametrize(("exponent", "unit"), [(2, "N s^2/m^2"), (0, "N"), (0.5, "N*(s/m)^0.5")])
def test_the_unit_of_a_dashpot_goes_with_its_exponent(exponent, unit):
    assert rd.Dashpot(0.5, Q(2.0, unit), exponent=exponent).damping == pytest.approx(2.0)
    with pytest.raises(rd.SceneError, match="damping must be"):
        rd.Dashpot(0.5, Q(2.0, "N s/m"), exponent=exponent)


# frequency


@pytest.mark.parametrize(
    ("given", "hertz"),
    [
        (Q(50, "Hz"), 50.0),
        (Q(0.05, "kHz"), 50.0),
        (Q(50, "1/s"), 50.0),
        (Q(100 * math.pi, "rad/s"), 50.0),
        (Q(18000, "deg/s"), 50.0),
        (Q(3000, "rpm"), 50.0),
        (Q(50, "turn/s"), 50.0),
        (1 / Q(20, "ms"), 50.0),
    ],
)
def test_an_angle_per_time_is_a_frequency_by_its_cycles(given, hertz):
    # the registry itself says that 1 rad/s is 1 Hz
    assert check.number(given, "frequency", "Hz") == pytest.approx(hertz, rel=1e-14)
    assert rd.Peaks(given).frequency[0] == pytest.approx(hertz, rel=1e-14)


@pytest.mark.parametrize("unit", ["s", "rad", "rad/s^2", "rad^2/s", "m/s", "s/rad", ""])
def test_what_is_no_frequency_is_refused(unit):
    with pytest.raises(rd.SceneError, match=r"frequency must be .*\[Hz\]"):
        rd.Peaks(Q([3.0], unit))


@pytest.mark.parametrize("unit", ["rad", "deg", "m", "Hz"])
def test_a_plain_number_has_no_unit(unit):
    with pytest.raises(rd.SceneError, match="eta must be"):
        rd.LossFactor(Q(0.1, unit))


# arrays

MODEL = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, damping=rd.LossFactor(0.01)).compile()


@pytest.mark.parametrize(
    "given",
    [
        Q([0.02, 0.05], "kHz"),
        Q(np.array([20, 50]), "Hz"),
        [Q(20, "Hz"), Q(3000, "rpm")],
        (Q(0.02, "kHz"), 50.0),
    ],
)
def test_arrays_and_lists_of_quantities_are_arrays(given):
    np.testing.assert_allclose(check.frequencies(given), [20.0, 50.0], rtol=1e-14)


@pytest.mark.parametrize(
    "given",
    [
        Q([20.0, 50.0], "m"),
        [Q(20.0, "Hz"), Q(1.0, "m")],
        [50.0, Q(20.0, "Hz")],
        [Q(20.0, "")],
        Q([[20.0]], "Hz"),
        Q([20.0, math.nan], "Hz"),
        Q([-20.0], "Hz"),
    ],
)
def test_arrays_without_meaning_are_refused(given):
    with pytest.raises(rd.SceneError, match="frequency"):
        check.frequencies(given)


def test_what_is_masked_is_no_number():
    force = np.ma.masked_array([1, 2, 3], mask=[False, True, False])
    with pytest.raises(rd.SceneError, match=r"force\[1\] must be a finite number, got nan"):
        check.numbers(force, "force")
    assert check.numbers(np.ma.masked_array([1, 2]), "force").tolist() == [1.0, 2.0]


def test_an_array_is_no_number():
    with pytest.raises(TypeError, match="tension must be a finite number"):
        rd.Scene(rd.Rope(1.0, 0.1), tension=Q([1.0, 2.0], "N"))


@pytest.mark.parametrize("bad", [Q(math.nan, "N"), Q(math.inf, "kN")])
def test_what_is_not_finite_is_refused_with_a_unit_too(bad):
    with pytest.raises(rd.SceneError, match="tension must be a finite number"):
        rd.Scene(rd.Rope(1.0, 0.1), tension=bad)


# questions

TIME = np.linspace(0.0, 0.05, 51)
PULSATING = rd.Scene(rd.Rope(1.0, 0.1), tension=rd.Tension(1000.0, amplitude=1.0, frequency=90.0))
CHAIN = MODEL.scene.replace(damping=None).compile(elements=8)
DAMPED = MODEL.scene.replace(damping=rd.ViscousDamping(2.0)).compile(elements=8)
PAIRS = {
    "modes": (
        lambda: MODEL.modes(below=Q(0.12, "kHz")).frequency,
        lambda: MODEL.modes(below=120.0).frequency,
    ),
    "count": (lambda: MODEL.count(below=Q(7200, "rpm")), lambda: MODEL.count(below=120.0)),
    "frf": (
        lambda: MODEL.frf(Q([0.01, 0.06], "kHz"), drive=("z", Q(25, "cm"))).value,
        lambda: MODEL.frf([10.0, 60.0], drive=("z", 0.25)).value,
    ),
    "static": (
        lambda: MODEL.static({("z", Q(500, "mm")): Q(1, "kgf")}).displacement,
        lambda: MODEL.static({("z", 0.5): 9.80665}).displacement,
    ),
    "tolerance": (
        lambda: PULSATING.compile(tolerance=Q(1, "percent"), below=Q(0.1, "kHz")).size,
        lambda: PULSATING.compile(tolerance=0.01, below=100.0).size,
    ),
    "transient": (
        lambda: (
            CHAIN.transient(
                Q(TIME * 1e3, "ms"), drive=("z", Q(1, "ft")), force=Q(np.cos(TIME), "kN")
            ).value
        ),
        lambda: CHAIN.transient(TIME, drive=("z", 0.3048), force=1e3 * np.cos(TIME)).value,
    ),
    "velocity": (
        lambda: (
            CHAIN.transient(TIME, velocity={("z", 0.3): Q(2e-3, "kN s")}, response=("z", 0.4)).value
        ),
        lambda: CHAIN.transient(TIME, velocity={("z", 0.3): 2.0}, response=("z", 0.4)).value,
    ),
    "stepped sine": (
        lambda: DAMPED.stepped_sine(Q([20.0], "Hz"), drive=("z", 0.3), amplitude=Q(1, "kN")).value,
        lambda: DAMPED.stepped_sine([20.0], drive=("z", 0.3), amplitude=1e3).value,
    ),
    "stability": (
        lambda: (
            PULSATING.compile(elements=8)
            .stability_map(Q([90.0, 110.0], "Hz"), Q([0.01, 0.02], "kN"))
            .growth
        ),
        lambda: PULSATING.compile(elements=8).stability_map([90.0, 110.0], [10.0, 20.0]).growth,
    ),
    "ask": (
        lambda: rd.ask.modes(below=Q(0.12, "kHz")).of(MODEL).frequency,
        lambda: rd.ask.modes(below=120.0).of(MODEL).frequency,
    ),
    "damage": (
        lambda: (
            MODEL.modes(2)
            .damage()
            .frequency_change(Q(10, "cm"), Q(20, "cm"), linear_density=Q(10, "percent"))
        ),
        lambda: MODEL.modes(2).damage().frequency_change(0.1, 0.2, linear_density=0.1),
    ),
    "peaks": (
        lambda: rd.Peaks(Q([1.0, 2.0], "kHz"), std=Q(3, "Hz")).std,
        lambda: rd.Peaks([1000.0, 2000.0], std=3.0).std,
    ),
    "modal damping": (
        lambda: rd.ModalDamping(Q([1, 2], "percent")).ratio,
        lambda: rd.ModalDamping([0.01, 0.02]).ratio,
    ),
    "bending test": (
        lambda: (
            rd.BendingTest(
                Q(50, "cm"), Q([0.0, 1.0], "kgf"), Q([0.1, 2.1], "mm"), x=Q(40, "cm")
            ).stiffness
        ),
        lambda: rd.BendingTest(0.5, [0.0, 9.80665], [1e-4, 2.1e-3], x=0.4).stiffness,
    ),
    "torsion test": (
        lambda: rd.TorsionTest(Q(50, "cm"), Q([0, 100], "N mm"), Q([0, 10], "deg")).stiffness,
        lambda: rd.TorsionTest(0.5, [0.0, 0.1], np.deg2rad([0, 10])).stiffness,
    ),
    "prior": (
        lambda: rd.Prior({"tension": (Q(0.3, "kN"), Q(10, "N"))})["tension"],
        lambda: rd.Prior({"tension": (300.0, 10.0)})["tension"],
    ),
    "plan": (
        lambda: (
            rd.plan_measurement(
                MODEL.scene, 2, places=Q([20, 35], "cm"), std=Q(1, "mHz")
            ).record_length
        ),
        lambda: rd.plan_measurement(MODEL.scene, 2, places=[0.2, 0.35], std=1e-3).record_length,
    ),
}


@pytest.mark.parametrize("what", PAIRS)
def test_questions_take_quantities(what):
    given, plain = (ask() for ask in PAIRS[what])
    np.testing.assert_allclose(given, plain, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(
    ("drive", "response", "quantity", "given", "plain"),
    [
        ("z", "z", "receptance", Q([3 + 1j, 2j], "um/N"), 1e-6),
        ("z", "z", "mobility", Q([3 + 1j, 2j], "mm/s/N"), 1e-3),
        ("z", "alpha", "accelerance", Q([3 + 1j, 2j], "deg/s^2/N"), math.pi / 180),
        ("alpha", "z", "receptance", Q([3 + 1j, 2j], "1/kN"), 1e-3),
    ],
)
def test_measured_responses_are_in_any_unit_of_theirs(drive, response, quantity, given, plain):
    points = {"drive": (drive, 0.5), "response": (response, 0.5), "quantity": quantity}
    measured = rd.Measured([1.0, 2.0], given, **points)
    np.testing.assert_allclose(measured.value, [plain * given.magnitude], rtol=1e-14)
    with pytest.raises(rd.SceneError, match="value must be finite numbers"):
        rd.Measured([1.0, 2.0], Q([3.0, 2.0], "kg"), **points)
    several = points | {"response": [("z", 0.5), ("beta", 0.5)]}
    with pytest.raises(rd.SceneError, match="must be plain numbers where responses have"):
        rd.Measured([1.0, 2.0], Q([[3.0, 2.0]] * 2, "um/N"), **several)


def test_measured_frequencies_are_in_any_unit():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=900.0)
    fit = rd.identify(scene, Q([3000.0, 6000.0], "rpm"), ["tension"], orders=[1, 2])
    assert fit.value["tension"] == pytest.approx(1000.0, rel=1e-9)


def test_units_of_a_drive_are_those_of_its_coordinate():
    with pytest.raises(rd.SceneError, match=r"force must be .*\[N\]"):
        CHAIN.transient(TIME, drive=("z", 0.3), force=Q(np.cos(TIME), "N m"))
    with pytest.raises(rd.SceneError, match=r"amplitude must be .*\[N\]"):
        CHAIN.stepped_sine([20.0], drive=("z", 0.3), amplitude=Q(1, "mm"))


# paths

EVERYTHING = rd.Scene(
    described(rd.Rope),
    tension=described(rd.Tension, friction=0.0),
    gravity=dataclasses.replace(described(rd.Gravity), own_weight=False),
    ends=(
        rd.End(
            x="free",
            z="free",
            alpha="free",
            beta="free",
            **{
                name: dict.fromkeys(("x", "z", "alpha", "beta"), 2.0)
                for name in ("spring", "dashpot", "mass")
            },
        ),
        "clamped",
    ),
    # friction between wires, which has no number of its own, stands beside no ratio
    damping=[described(kind) for kind in damping.KINDS if kind is not rd.WireFriction],
    parts=[described(kind) for kind in DESCRIBED if kind in part.KINDS],
)


def paths():
    scene = EVERYTHING
    named = {"": scene.rope, "tension.": scene.tension, "gravity.": scene.gravity}
    named |= {f"parts[{i}].": part for i, part in enumerate(scene.parts)}
    named |= {f"damping[{i}].": one for i, one in enumerate(scene.dampings)}
    for start, thing in named.items():
        for field in dataclasses.fields(thing):
            if isinstance(getattr(thing, field.name), float):
                yield start + field.name
    for name in ("spring", "dashpot", "mass"):
        yield from (f"ends[0].{name}.{c}" for c in ("x", "z", "alpha", "beta"))


@pytest.mark.parametrize("path", list(paths()))
def test_the_unit_of_a_path_is_that_of_the_number_there(path):
    value, unit = value_at(EVERYTHING, path), unit_of(path)
    fitting = 0
    for one in unit.split(" or "):
        try:
            changed = with_values(EVERYTHING, {path: Q(value, one)})
        except rd.SceneError:
            continue
        fitting += 1
        assert value_at(changed, path) == pytest.approx(value, rel=1e-14)
    assert fitting == 1


# plain numbers


def test_plain_numbers_are_not_asked_for_units(monkeypatch):
    def asked(value):
        raise AssertionError(value)

    monkeypatch.setattr(check, "is_quantity", asked)
    for value in (1, 1.0, np.float32(1), np.int64(1)):
        assert isinstance(value, numbers.Real)
        assert check.number(value, "x", "m") == 1.0


def test_a_scene_of_quantities_is_saved_as_plain_numbers(tmp_path):
    rope = rd.Rope(Q(120, "cm"), Q(100, "g/m"), bending_stiffness=Q(1.5, "N m^2"))
    scene = rd.Scene(rope, tension=Q(0.3, "kN"), parts=[rd.PointMass(Q(50, "cm"), Q(20, "g"))])
    scene.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == scene
    assert (scene.tension, scene.rope.length, scene.parts[0].x) == (300.0, 1.2, 0.5)
