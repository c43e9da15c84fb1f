"""Laws that never act leave linear motion: what one method tells, the others do."""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import ropedyn as rd

STRING = rd.Rope(1.0, 0.2)
PINNED = {"elements": 8, "element": "rigid"}
TIME = np.linspace(0.0, 0.02, 101)
LAST = float(TIME[-1])
FAR = rd.Stop(0.375, 1e4, gap=1.0)
FAINT = rd.NodeForce(0.375, lambda t, u, v: -1e-9 * u**3)


def moved(part, damping=None, how=PINNED, time=TIME, **asked):
    """The motion with a law, with none where it is None, and with dampers that act on nothing."""
    parts = [] if part is None else [part]
    scene = rd.Scene(STRING, tension=1000.0, damping=damping, parts=parts)
    return scene.compile(**how).transient(time, **asked)


def off(history, other):
    """How far motions are apart, in parts of the largest of each response."""
    most = np.abs(other.value).max(axis=1, keepdims=True)
    return float((np.abs(history.value - other.value) / most).max())


@pytest.mark.parametrize(
    ("part", "method", "accepted"),
    [
        (FAR, "volterra", 2e-7),
        (FAINT, "collocation", 1e-9),
        (rd.Dashpot(0.375, 1e-9, exponent=0.0), "volterra", 2e-7),
    ],
)
def test_an_end_that_moves_damped_stiffness_pulls_with_its_rate_too(part, method, accepted):
    """The force lacked the damper's: 2 % off, and 1e-11 said."""
    damping = rd.RayleighDamping(0.0, 1e-4)
    asked = {"drive": ("end", 1, "z"), "force": rd.Sine(0.01, 30.0), "response": ("z", 0.375)}
    found, exact = (moved(one, damping, **asked) for one in (part, None))
    assert (found.cost.method, exact.cost.method) == (method, "modal")
    assert off(found, exact) <= accepted
    assert (np.abs(found.value - exact.value) <= found.error + exact.error).all()
    force = asked | {"response": ("F_z", 0.5)}
    assert (
        off(moved(part, damping, **force), moved(rd.Dashpot(0.375, 1e-9), damping, **force)) < 1e-3
    )
    with pytest.raises(rd.SceneError, match="drive must not be the motion of an end where stiff"):
        moved(FAR, damping, **asked, method="events")
    # undamped, phases take it
    assert moved(FAR, **asked).cost.method == "events"


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
@pytest.mark.parametrize("when", [0.0, 2.4321e-4, 0.01])
def test_an_element_that_is_struck_between_its_nodes_relaxes(when, quantity):
    """It was not there: all of the largest value off for 11 samples."""
    at = {"drive": ("z", 0.45), "force": rd.Impulse(0.1, time=when), "response": ("z", 0.48)}
    asked = {"damping": rd.RayleighDamping(0.0, 3e-5), "how": {"elements": 8}, "quantity": quantity}
    found, exact = moved(FAR, **at, **asked), moved(None, **at, **asked)
    assert (found.cost.method, exact.cost.method) == ("events", "modal")
    assert off(found, exact) < 1e-12
    with pytest.raises(rd.SceneError, match="energy is not told where a blow at an instant hits"):
        _ = found.energy


@pytest.mark.parametrize(
    "part", [FAR, FAINT, rd.Dashpot(0.375, 1e-9), rd.Dashpot(0.375, 1e-9, exponent=2.0)]
)
@pytest.mark.parametrize(
    ("drive", "quantity", "response"),
    [
        (("z", 0.75), "acceleration", ("z", 0.75)),
        (("end", 0, "z"), "displacement", ("F_z", 0.0)),
        (("z", 0.7), "displacement", ("z", 0.7)),
    ],
)
def test_a_jump_at_the_last_time_is_there(part, drive, quantity, response):
    """Of events it was not: an acceleration of 63 where 263 is right."""
    size = 5.0 if drive[0] == "z" else 0.002
    force = (rd.Sine(size, 40.0), rd.Step(size, time=LAST))
    asked = {"drive": drive, "force": force, "quantity": quantity, "response": response}
    found, exact = moved(part, **asked), moved(None, **asked)
    assert off(found, exact) < 1e-4  # measured: 1e-5 by the line
    assert (np.abs(found.value - exact.value) <= found.error + exact.error).all()
    before = moved(part, **(asked | {"force": force[0]}))
    assert np.abs(found.value - before.value)[0, -1] > 0.05 * np.abs(exact.value).max()
    assert np.abs(found.value - before.value)[0, :-1].max() < 1e-6 * np.abs(exact.value).max()


@pytest.mark.parametrize("ulps", [1, 3, 10, 100, 10_000])
def test_a_step_just_before_the_last_time_is_there(ulps):
    """What modes do for so short a time was told as of one mode: 77 % off after one ulp."""
    step = rd.Step(5.0, time=LAST - ulps * np.spacing(LAST))
    asked = {"drive": ("z", 0.75), "force": (rd.Sine(5.0, 40.0), step), "quantity": "acceleration"}
    found = moved(rd.Dashpot(0.375, 1e-9), rd.ViscousDamping(3.0), **asked)
    exact = moved(None, rd.ViscousDamping(3.0), **asked)
    assert (found.cost.method, exact.cost.method) == ("line", "modal")
    assert (np.abs(found.value - exact.value) <= found.error + exact.error).all()


@pytest.mark.parametrize("force", [0.1, 3.0])
@pytest.mark.parametrize("when", [0.0, 0.01])
def test_friction_holds_what_a_blow_elsewhere_does_not_move(force, when):
    """Rounding of modes that cancel let it slip: an acceleration of 120 where 0 is right."""
    friction = rd.Dashpot(0.25, force, exponent=0.0)
    blow = {"drive": ("z", 0.75), "force": rd.Impulse(0.02, time=when), "response": ("z", 0.25)}
    found = moved(friction, **blow, quantity="acceleration")
    arrives = when + 1e-9 > TIME
    assert found.cost.method == "events"
    assert np.abs(found.value[0, arrives]).max() <= 1e-12 * np.abs(found.value).max()
    # where it hits, friction slips at once
    here = moved(friction, **(blow | {"drive": ("z", 0.25)}), quantity="acceleration")
    assert here.value[0, when <= TIME][0] < -force


@pytest.mark.parametrize("unit", [1e3, 1e-3, 1e-6])
def test_a_stop_beside_friction_is_the_same_in_other_units_of_time(unit):
    """Flexibilities and inverse masses were solved for as they are: 3 % off in microseconds."""

    def followed(s):
        parts = [rd.Stop(0.335, 18_820.0), rd.Dashpot(0.67, 3.7, exponent=0.0)]
        scene = rd.Scene(rd.Rope(1.34, 0.171 * s * s), tension=2646.0, parts=parts)
        seen = {
            "drive": ("z", 0.335),
            "force": rd.Step(20.0),
            "response": [("z", 0.335), ("F_z", 0)],
        }
        return scene.compile(elements=6).transient(np.linspace(0.0, 0.03 * s, 150), **seen)

    assert off(followed(unit), followed(1.0)) < 1e-12


def test_a_stiff_stop_beside_friction_is_the_same_in_other_units_of_time():
    """A wire of 0.6 m and 3 g: 2e-3 off, 3e-8 said."""

    def followed(s):
        parts = [rd.Stop(0.15, 1e11), rd.Dashpot(0.3, 0.5, exponent=0.0)]
        scene = rd.Scene(rd.Rope(0.6, 0.005 * s * s), tension=700.0, parts=parts)
        seen = {"drive": ("z", 0.15), "force": rd.Step(2.0), "response": [("z", 0.15), ("F_z", 0)]}
        return scene.compile(elements=64).transient(np.linspace(0.0, 0.005 * s, 150), **seen)

    one, other = followed(1.0), followed(1e3)
    assert (np.abs(one.value - other.value) <= one.error + other.error).all()
    assert off(one, other) < 1e-6


@pytest.mark.parametrize("part", [FAINT, FAR])
@pytest.mark.parametrize("span", [3e-4, 1e-4, 1e-5])
def test_motion_that_has_hardly_begun_is_known_to_what_cancels(part, span):
    """Beside a smooth law 1e-31 was said of 6e-20 where 3e-21 is right."""
    time = np.linspace(0.0, span, 5)
    asked = {"drive": ("z", 0.875), "force": rd.Sine(20.0, 100.0, phase=1.0), "time": time}
    found = moved(part, **asked, response=("z", 0.25))
    # five elements away it moves as the twelfth power of time: below what any of them tells
    assert np.abs(found.value).max() <= found.error[0].min()
    assert (
        found.error.max() < 1e-7 * np.abs(moved(part, **asked, response=("z", 0.875)).value).max()
    )


@pytest.mark.parametrize(
    "force", [rd.Step(10.0), rd.Sine(10.0, 50.0, phase=1.0), np.linspace(10.0, 3.0, 101)]
)
def test_a_force_that_is_there_at_first_has_worked_on_the_element_it_pushes(force):
    """Of events it had not: a fifth of the largest kinetic energy was missing."""
    asked = {"drive": ("z", 0.45), "force": force, "how": {"elements": 8}}
    found, exact = moved(FAR, **asked).energy, moved(None, **asked).energy
    assert exact["input"][0] > 0
    for name, value in exact.items():
        assert found[name] == pytest.approx(value, abs=1e-12 * exact["input"].max())
    assert not found["laws"].any()


def test_a_stop_that_is_pressed_at_first_has_taken_nothing_since():
    """Events said what it stored, steps 0."""
    pressed = rd.Stop(0.25, 1e4)
    found = []
    for more in [], [FAINT]:
        scene = rd.Scene(STRING, tension=1000.0, parts=[pressed, rd.Dashpot(0.5, 2.0), *more])
        found.append(
            scene.compile(**PINNED).transient(TIME, start={("z", 0.25): 20.0}, response=("z", 0.25))
        )
    (by_events, by_steps), most = found, np.ptp(found[0].energy["laws"])
    assert (by_events.cost.method, by_steps.cost.method) == ("events", "steps")
    assert by_events.energy["laws"][0] == 0
    for name, value in by_steps.energy.items():
        assert by_events.energy[name] == pytest.approx(value, abs=1e-3 * most)


@pytest.mark.parametrize("part", [None, rd.Dashpot(0.375, 1.0), FAINT, FAR])
@pytest.mark.parametrize("end", [0, 1])
def test_energy_is_not_told_where_an_end_is_moved(part, end):
    """Beside dampers "tuple.index(x): x not in tuple"."""
    history = moved(part, drive=("end", end, "z"), force=rd.Sine(0.01, 30.0), response=("z", 0.5))
    with pytest.raises(rd.SceneError, match="energy is not told where an end is moved"):
        _ = history.energy


def test_a_step_at_the_last_time_beside_friction_at_rest_is_answered():
    """It was refused after 15 s: what held was looked at for too short a time."""
    last = 0.03700412748229481
    time = np.linspace(0.0, last, 69)
    parts = [rd.Dashpot(1 / 2, 2.74, exponent=0.0), rd.Dashpot(2 / 3, 27.68, exponent=0.0)]
    scene = rd.Scene(STRING, tension=1000.0, parts=[*parts, rd.Dashpot(1 / 3, 4.53)])
    model = scene.compile(elements=6, element="rigid")
    half = last - 0.023122368784884547
    blow = rd.Impulse(-0.148, time=last - half, duration=half)
    asked = {"drive": [("z", 2 / 3), ("z", 1 / 3)], "force": [blow, rd.Step(10.0, time=last)]}
    seen = {"response": [("z", 1 / 3), ("z", 1 / 2)], "quantity": "acceleration"}
    found = model.transient(time, **asked, **seen)
    assert found.cost.method == "events"
    assert found.value[0, -1] == pytest.approx(10.0 / (0.2 / 6), rel=1e-12)
    assert np.abs(found.value[1]).max() < 1e-9


@pytest.mark.parametrize("begin", [1e3, 1e6])
def test_a_jump_at_the_last_time_is_there_however_late(begin):
    time = begin + TIME
    force = (rd.Sine(5.0, 40.0), rd.Step(5.0, time=float(time[-1])))
    asked = {"drive": ("z", 0.75), "force": force, "quantity": "acceleration", "time": time}
    found, exact = moved(FAR, **asked), moved(None, **asked)
    assert found.value[0, -1] == pytest.approx(exact.value[0, -1], rel=1e-6)


@pytest.mark.parametrize("mass", [60.0, 100.0])
def test_a_mass_that_holds_a_law_apart_is_no_flexibility(mass):
    """Rounding was, of no mode: "cannot convert float NaN to integer"."""
    parts = [rd.PointMass(0.5, mass), rd.NodeForce(0.25, lambda t, u, v: -1e-9 * u**3)]
    asked = {"drive": ("z", 0.75), "force": rd.Sine(5.0, 40.0), "response": ("z", 0.75)}
    found, exact = (
        rd.Scene(STRING, tension=1000.0, parts=some).compile(**PINNED).transient(TIME, **asked)
        for some in (parts, parts[:1])
    )
    assert off(found, exact) < 1e-9


@pytest.mark.parametrize("begin", [0.0, 100.0])
def test_a_short_blow_between_nodes_puts_in_what_moves(begin):
    """Of what the element takes and gives back rounding of the times left 216 J of 0.02 J."""
    blow = rd.Impulse(0.0625, time=begin + 0.005, duration=2e-8)
    asked = {"drive": ("z", 0.45), "force": blow, "time": begin + TIME, "response": ("z", 0.5)}
    found = moved(FAR, **asked).energy
    stored = found["kinetic"] + found["strain"]
    assert found["input"][-1] == pytest.approx(stored[-1], rel=1e-4)  # 2e-6 of rounded times


@pytest.mark.parametrize("response", [("z", 5.0), ("M_beta", 5.0)], ids=str)
def test_stiffness_damping_beside_own_weight_is_the_same_beside_a_law_that_is_never_met(response):
    """Steps damped the tension along the rope as its mean: 3 % off, 4e-6 said; so did energies."""
    scene = rd.Scene(
        rd.Rope(10.0, 1.0, bending_stiffness=20.0, rotary_inertia=0.01),
        tension=100.0,
        damping=rd.StiffnessDamping(0.02),
        gravity=rd.Gravity(inclination=1.5, sag=False),
    )
    time = np.linspace(0.0, 2.0, 101)
    asked = {"drive": ("z", 5.0), "force": rd.Sine(1.0, 0.7), "response": response}
    far = scene.replace(parts=[rd.Stop(2.5, 1e3, gap=1e5)])
    plain, steps = (
        one.compile(elements=8, element="rigid").transient(time, **asked) for one in (scene, far)
    )
    assert (plain.cost.method, steps.cost.method) == ("line", "steps")
    apart = np.abs(plain.value - steps.value)
    assert (apart <= plain.error + steps.error).all()
    assert apart.max() < 1e-4 * np.abs(plain.value).max()  # measured: 1e-6
    velocity = scene.compile(elements=8, element="rigid").transient(
        time, **asked | {"response": ("z", 5.0), "quantity": "velocity"}
    )
    work = cumulative_simpson(asked["force"].value(time) * velocity.value[0], x=time, initial=0.0)
    energy = plain.energy
    kept = sum(energy[name] for name in ("kinetic", "strain", "dissipated"))
    assert np.abs(energy["input"] - work).max() < 1e-4 * work.max()  # measured: 5e-6
    assert np.abs(kept - energy["input"]).max() < 1e-4 * work.max()


@pytest.mark.parametrize(
    ("parts", "method"),
    [
        ([], "modal"),
        ([rd.Dashpot(0.375, 3.0)], "line"),
        ([rd.Stop(0.375, 1e4, gap=1e-4)], "events"),
        ([rd.Dashpot(0.375, 0.5, exponent=0.0)], "events"),
        ([rd.Dashpot(0.375, 0.5, exponent=2.0)], "collocation"),
    ],
    ids=str,
)
def test_motion_begun_days_later_is_the_same(parts, method):
    """Sines were rounded to 1.6e-8 and times of events to 1e-7 of the motion, 1e-11 said."""
    model = rd.Scene(STRING, tension=1000.0, parts=parts).compile(**PINNED)
    step, late = 2.0**-12, 2.0**20  # all times and turns are numbers
    time = step * np.arange(200)
    for force in (lambda begin: rd.Step(5.0, time=begin + 3 * step), lambda _: rd.Sine(5.0, 64.25)):
        now, later = (
            model.transient(begin + time, drive=("z", 0.25), force=force(begin))
            for begin in (0.0, late)
        )
        assert now.cost.method == method
        apart = np.abs(now.value - later.value)
        assert apart.max() <= 1e-10 * np.abs(now.value).max()  # measured: 0, collocation 2e-11
        assert (apart <= now.error + later.error).all()


def test_turns_of_sines_are_exact():
    rng = np.random.default_rng()
    for _ in range(200):
        frequency = rng.uniform(1, 2) * 10.0 ** rng.uniform(-40, 60)
        time = rng.uniform(-2, 2) * 10.0 ** rng.uniform(-3, 12) / frequency
        turns = float(Fraction(frequency) * Fraction(time) % 1)
        off = rd.Sine(1.0, frequency).value(np.array([time]))[0] - math.sin(2 * math.pi * turns)
        assert abs(off) < 1e-14  # 2 pi of rounding


@pytest.mark.parametrize("parts", [[], [rd.Dashpot(0.375, 3.0)]], ids=["modal", "coupled"])
def test_what_many_turns_round_is_part_of_the_error(parts):
    """Events said 2e-11 after 10 000 s, where rounding of the frequency is 4e-10."""
    damping = None if parts else rd.ModalDamping(0.01)
    scene = rd.Scene(STRING, tension=1000.0, damping=damping, parts=parts)
    model, time = scene.compile(**PINNED), np.linspace(0.0, 1e4, 20_001)
    asked = {"drive": ("z", 0.25), "response": ("z", 0.5)}
    history = model.transient(time, force=rd.Sine(5.0, 64.3), method="events", **asked)
    receptance = model.frf([64.3], **asked).value[0, 0]
    turns = [float(Fraction(64.3) * Fraction(t) % 1) for t in time.tolist()]
    steady = 5.0 * np.abs(receptance) * np.sin(2 * np.pi * np.array(turns) + np.angle(receptance))
    late = time > 100.0
    off, most = np.abs(history.value[0] - steady)[late], np.abs(steady).max()
    assert (off <= history.error[0, late]).all()
    assert history.error.max() < 1e-7 * most  # measured: 6e-9


@pytest.mark.parametrize(
    ("part", "method"),
    [
        (FAR, "events"),
        (FAINT, "collocation"),
        (rd.Dashpot(0.375, 1e-9, exponent=2.0), "collocation"),
        (rd.NodeForce(0.375, lambda t, u, v: -1e-9 * u**3, coordinate="y"), "collocation"),
    ],
)
def test_tips_of_wires_move_beside_laws(part, method):
    """Beside smooth laws they stood still, with an error of 0."""
    wires = [
        rd.BrokenWire(x, length, 3e-4, radius=0.0) for x, length in ((0.25, 0.05), (0.5, 0.03))
    ]
    free = rd.Scene(
        rd.Rope(1.0, 0.2, bending_stiffness=0.5), tension=1000.0, parts=wires, planes="both"
    )
    asked = {"drive": ("z", 0.75), "force": rd.Step(3.0), "response": [("wire", 1), ("wire", 0)]}
    found, exact = (
        scene.compile(elements=8).transient(TIME, **asked)
        for scene in (free.replace(parts=[*wires, part]), free)
    )
    assert (found.cost.method, exact.cost.method) == (method, "line")
    assert (np.abs(exact.value).max(axis=1) > 1e-5).all()
    assert (np.abs(found.value - exact.value) <= found.error + exact.error).all()
    assert off(found, exact) <= 1e-6  # measured: 2e-8 by the line
