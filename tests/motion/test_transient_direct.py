"""The direct method: order, energy, agreement with exponentials, refusals, long runs."""

import pickle
import resource
import signal

import numpy as np
import pytest
from dense_motion import Dense

import ropedyn as rd

ROPE = rd.Rope(
    1.0, 0.1, bending_stiffness=0.5, torsional_stiffness=2.0, polar_inertia=1e-5, lay_slope=0.1
)
LAGGING = ROPE.replace(rotary_inertia=1e-5)
TIME = np.linspace(0.0, 0.02, 9)
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
SAMPLES = 1e-3 * np.sin(200.0 * TIME) ** 2


def chain(damping=None, element="tensed", rope=ROPE, **more):
    scene = rd.Scene(rope, tension=100.0, damping=damping, **more)
    return scene.compile(elements=6, element=element)


def marched(model, response, step, **asked):
    """One response by steps."""
    history = model.transient(TIME, response=response, method="direct", step=step, **asked)
    return history.value[0]


def errors(model, response, exact, steps, **asked):
    """Largest errors relative to the largest value."""
    value = exact[:, Dense(model).at(*response)]
    return (
        np.array([np.abs(marched(model, response, h, **asked) - value).max() for h in steps])
        / np.abs(value).max()
    )


def order(found, steps):
    return np.log(found[0] / found[-1]) / np.log(steps[0] / steps[-1])


PLUCK = {("z", 0.5): 1.0}


@pytest.mark.parametrize("response", [("z", 0.5), ("alpha", 1 / 3), ("beta", 1 / 3)])
@pytest.mark.parametrize(
    ("element", "damping"),
    [
        ("rigid", None),
        ("rigid", rd.StiffnessDamping(1e-4)),
        ("tensed", rd.RayleighDamping(3.0, 1e-4)),
        ("tensed", rd.ViscousDamping(2.0)),
    ],
)
def test_pluck_and_release_is_of_second_order(element, damping, response):
    model = chain(damping, element, LAGGING)
    dense = Dense(model)
    exact, _ = dense.motion(TIME, u=dense.rest(dense.load(("z", 0.5))))
    steps = (2e-5, 1e-5, 5e-6)
    found = errors(model, response, exact, steps, start=PLUCK)
    # the highest modes are only just resolved: their error is not yet in proportion to h^2
    assert order(found[-2:], steps[-2:]) == pytest.approx(2.0, abs=0.15)
    assert found[-1] < 5e-3


def test_sine_drives_motion_to_second_order():
    model = chain()
    dense = Dense(model)
    for quantity in ("displacement", "velocity"):
        exact = dense.motion(TIME, load=dense.load(("z", 0.5)), omega=2 * np.pi * 60, phase=0.0)
        steps = (1e-4, 5e-5)
        found = errors(
            model,
            ("z", 0.5),
            exact[quantity == "velocity"],
            steps,
            drive=("z", 0.5),
            force=rd.Sine(1.0, 60.0),
            quantity=quantity,
        )
        assert order(found, steps) == pytest.approx(2.0, abs=0.02)


def test_blow_at_an_instant_is_a_jump_of_velocity():
    model = chain()
    dense = Dense(model)
    mass = np.where(dense.moves, np.diag(dense.M), 1.0)
    exact, _ = dense.motion(TIME, v=dense.load(("z", 0.5), 0.1) / mass)
    steps = (5e-5, 2.5e-5)
    found = errors(model, ("z", 1 / 3), exact, steps, drive=("z", 0.5), force=rd.Impulse(0.1))
    assert order(found, steps) == pytest.approx(2.0, abs=0.1)


def test_moment_on_a_rotation_without_inertia_turns_it_at_once():
    model = chain()
    dense = Dense(model)
    exact, _ = dense.motion(TIME, load=dense.load(("beta", 0.5)))
    steps = (1e-5, 5e-6)
    found = errors(model, ("beta", 0.5), exact, steps, drive=("beta", 0.5), force=rd.Step(1.0))
    assert found[-1] < 1e-4
    released, _ = dense.motion(TIME, u=dense.rest(dense.load(("beta", 0.5))))
    found = errors(model, ("beta", 0.5), released, steps, start={("beta", 0.5): 1.0})
    assert found[-1] < 3e-4


def test_step_inside_a_step_is_met():
    """A force that begins between two times, nowhere near a multiple of the step."""
    model = STRING.compile(elements=4)
    begin = TIME[3] + 1.234e-4
    late = model.transient(
        TIME, drive=("z", 0.5), force=rd.Step(1.0, time=begin), method="direct", tolerance=1e-6
    )
    dense = Dense(model)
    since = np.concatenate([[begin], TIME[begin < TIME]])
    exact, _ = dense.motion(since, load=dense.load(("z", 0.5)))
    value = np.zeros(len(TIME))
    value[begin < TIME] = exact[1:, dense.at("z", 0.5)]
    assert np.abs(late.value[0] - value).max() <= 1e-6 * np.abs(value).max()


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("count", [2, 41])
def test_true_error_is_within_the_tolerance(tolerance, count):
    model = STRING.compile(elements=8)
    dense = Dense(model)
    time = np.linspace(0.0, 0.1, count)
    history = model.transient(
        time, start=PLUCK, response=("z", 0.25), method="direct", tolerance=tolerance
    )
    exact = dense.motion(time, u=dense.rest(dense.load(("z", 0.5))))[0][:, dense.at("z", 0.25)]
    true = np.abs(history.value[0] - exact)
    assert true.max() <= tolerance * np.abs(exact).max()
    assert np.abs(history.error[0]).max() <= tolerance * np.abs(history.value).max()
    assert true.max() <= history.error.max()


@pytest.mark.parametrize("law", [rd.Stop(0.375, 3e3, gap=2e-3), rd.Dashpot(0.375, 3.0, exponent=2)])
def test_error_of_steps_covers_laws_that_bend(law):
    """Where two runs cross they tell nothing, and errors fall by other powers than smooth ones."""
    rope = rd.Rope(1.0, 0.4, bending_stiffness=0.5, rotary_inertia=1e-4)
    scene = rd.Scene(rope, tension=100.0, damping=rd.StiffnessDamping(1e-3), parts=[law])
    model, time = scene.compile(elements=8, element="rigid"), np.linspace(0.0, 0.5, 400)
    asked = {"drive": ("z", 0.25), "force": rd.Sine(3.0, 7.0), "response": ("z", 0.5)}
    history, finer = (
        model.transient(time, **asked, method="direct", tolerance=t) for t in (1e-4, 1e-6)
    )
    true = np.abs(history.value - finer.value)
    assert true.max() <= history.error.max()
    assert (true <= history.error + finer.error).mean() >= 0.98  # measured: 0.99 and 1


def test_step_error_of_given_steps_covers_the_true_one():
    model = STRING.compile(elements=8)
    dense = Dense(model)
    history = model.transient(TIME, start=PLUCK, response=("z", 0.25), method="direct", step=1e-4)
    exact = dense.motion(TIME, u=dense.rest(dense.load(("z", 0.5))))[0][:, dense.at("z", 0.25)]
    true = np.abs(history.value[0] - exact)
    assert (true <= history.error[0]).all()
    # half as much again, and what two runs say of it is right to a tenth
    assert history.error.max() <= 1.65 * true.max()


@pytest.mark.claim(
    "Energy balance of marches under forces, end motion and dampings: what is missing over the "
    "largest there is",
    reference="input = kinetic + strain + dissipated",
    accepted=1e-12,
)
@pytest.mark.parametrize("damping", [None, rd.RayleighDamping(3.0, 1e-5), rd.ViscousDamping(2.0)])
def test_energy_balances_to_rounding(damping, claim):
    history = chain(damping).transient(
        TIME,
        drive=[("z", 0.5), ("end", 0, "z")],
        force=[rd.Impulse(0.1, time=1e-3, duration=2e-3), rd.Sine(1e-3, 80.0)],
        response=("z", 1 / 3),
        start={("z", 1 / 3): 10.0},
        method="direct",
        step=5e-5,
    )
    e = history.energy
    kept = e["kinetic"] + e["strain"] - e["input"] + e["dissipated"]
    # 400 steps, each rounded: the energies are up to some 1 J
    claim(np.ptp(kept) / (e["kinetic"] + e["strain"]).max())
    assert damping is None or e["dissipated"][-1] > 0.01 * e["strain"][0]


@pytest.mark.claim(
    "Energy of undamped motion of 64 tensed elements over 10^4 steps, 10^5 on demand: relative "
    "change",
    reference="its value at first",
    accepted=1e-13,
)
@pytest.mark.parametrize("steps", [10_000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_undamped_energy_stays_over_many_steps(steps, claim):
    model = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=0.5), tension=100.0).compile(elements=64)
    time = np.linspace(0.0, 1e-4 * steps, 11)
    history = model.transient(time, start=PLUCK, response=("z", 0.25), method="direct", step=1e-4)
    energy = history.energy["kinetic"] + history.energy["strain"]
    # twice 1e-14 measured over 10^5 steps, of both kinds of element
    claim(np.ptp(energy) / energy[0])


def test_moved_end_is_where_it_is_said_to_be():
    """A string much stiffer than its inertia follows the line between its ends."""
    model = STRING.compile(elements=4)
    motion = rd.Sine(1e-3, 5.0, phase=0.3)
    history = model.transient(
        TIME,
        drive=("end", 0, "z"),
        force=motion,
        response=[("z", 0.0), ("z", 0.5)],
        method="direct",
        step=1e-4,
    )
    assert history.value[0] == pytest.approx(motion.value(TIME), rel=1e-9)
    assert history.energy["input"][-1] != 0


@pytest.mark.parametrize("force", [rd.Sine(1e-3, 30.0, phase=0.4), SAMPLES])
def test_velocity_of_a_moved_end_is_that_of_its_motion(force):
    history = STRING.compile(elements=4).transient(
        TIME,
        drive=("end", 1, "z"),
        force=force,
        response=("z", 1.0),
        quantity="velocity",
        method="direct",
        step=5e-5,
    )
    if isinstance(force, rd.Sine):
        rate = force.rate(TIME)
    else:
        slope = np.diff(force) / np.diff(TIME)
        rate = np.append(slope, slope[-1])  # from the right where it bends
    # of second order in 2 pi 30 Hz step, whose square is 9e-5
    assert np.abs(history.value[0] - rate).max() < 1e-4 * np.abs(rate).max()
    e = history.energy
    kept = e["kinetic"] + e["strain"] - e["input"]
    assert np.ptp(kept) < 1e-12 * e["input"].max()


def test_jump_of_an_end_leaves_the_energy_of_a_stretched_element():
    history = STRING.compile(elements=4).transient(
        TIME,
        drive=("end", 0, "z"),
        force=rd.Step(1e-3),
        response=("z", 0.5),
        method="direct",
        step=5e-5,
    )
    assert history.energy["input"][0] == pytest.approx(100.0 / 0.25 * 1e-6 / 2, rel=1e-6)
    assert history.energy["input"][-1] == history.energy["input"][0]


def test_base_motion_is_inertia_seen_from_the_base():
    """Both ends moved alike: relative motion is that under -m a on every mass."""
    model = STRING.compile(elements=4)
    dense = Dense(model)
    omega, size = 2 * np.pi * 40.0, 1e-3
    history = model.transient(
        TIME,
        drive=[("end", 0, "z"), ("end", 1, "z")],
        force=[rd.Sine(size, 40.0)] * 2,
        response=("z", 0.25),
        method="direct",
        step=1e-5,
    )
    load = np.diag(dense.M) * size * omega**2
    # the base sets out with a velocity, so that all else seems to move back
    back = -size * omega * np.ones(dense.size)
    seen, _ = dense.motion(TIME, v=back, load=load, omega=omega, phase=0.0)
    exact = seen[:, dense.at("z", 0.25)] + size * np.sin(omega * TIME)
    # second order: of the highest of three modes, 300 Hz
    assert np.abs(history.value[0] - exact).max() < 1e-4 * np.abs(exact).max()


def test_jump_of_an_end_is_a_wave():
    model = STRING.compile(elements=4)
    dense = Dense(model)
    history = model.transient(
        TIME,
        drive=("end", 1, "z"),
        force=rd.Step(1e-3),
        response=("z", 0.5),
        method="direct",
        tolerance=1e-6,
    )
    # the end pulls its neighbour by T/l times where it is
    load = dense.load(("z", 0.75), 1e-3 * 100.0 / 0.25)
    exact = dense.motion(TIME, load=load)[0][:, dense.at("z", 0.5)]
    assert np.abs(history.value[0] - exact).max() <= 2e-6 * np.abs(exact).max()


@pytest.mark.parametrize("element", ["tensed", "rigid"])
@pytest.mark.parametrize("x", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("name", ["F_z", "M_beta"])
def test_internal_forces_at_rest_are_those_of_the_frequency_response(element, x, name):
    """A load that grows slowly is met by the static internal force."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=0.5)
    damping = rd.StiffnessDamping(1e-3) if element == "rigid" else rd.RayleighDamping(400.0, 1e-3)
    scene = rd.Scene(rope, tension=100.0, damping=damping)
    model = scene.compile(elements=4, element=element)
    if element == "rigid":
        model = scene.replace(damping=(damping, rd.ViscousDamping(100.0))).compile(
            elements=4, element=element
        )
    history = model.transient(
        [0.0, 4.0],
        drive=("z", 0.25),
        force=rd.Step(1.0),
        response=(name, x),
        method="direct",
        step=0.01,
        spectral_radius=0.0,
    )
    static = model.frf([0.0], drive=("z", 0.25), response=(name, x)).value[0, 0].real
    assert history.value[0, -1] == pytest.approx(static, rel=1e-6)


def test_resonator_is_a_mass_on_a_spring():
    absorber = rd.Resonator(0.5, 0.02, 30.0, damping_ratio=0.05)
    damping = rd.RayleighDamping(20.0, 0.0)
    model = STRING.replace(parts=[absorber], damping=damping).compile(elements=2)
    history = model.transient(
        np.linspace(0.0, 2.0, 5),
        drive=("z", 0.5),
        force=rd.Sine(1.0, 25.0, phase=0.2),
        method="direct",
        step=1e-4,
    )
    steady = model.frf([25.0], drive=("z", 0.5)).value[0, 0] * np.exp(
        1j * (2 * np.pi * 25.0 * history.time + 0.2 - np.pi / 2)
    )
    # of second order: (omega h)^2 times some periods of the absorber's resonance
    assert history.value[0, -1] == pytest.approx(steady.real[-1], rel=2e-3)


BEAM = rd.Rope(1.0, 0.1, bending_stiffness=0.5)
HEAVY = BEAM.replace(axial_stiffness=1e3)
BLOW = {"drive": ("z", 0.25), "force": rd.Impulse(0.1, duration=5e-3)}
SHAKEN = {"drive": ("end", 0, "z"), "force": SAMPLES}


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
@pytest.mark.parametrize(
    ("scene", "asked"),
    [
        (rd.Scene(BEAM, tension=-5.0), BLOW),
        (rd.Scene(BEAM, tension=100.0, parts=[rd.Hinge(0.5, stiffness=0.3)]), BLOW),
        (rd.Scene(HEAVY, tension=100.0, gravity=rd.Gravity(98.0)), BLOW),
        (
            rd.Scene(
                BEAM,
                tension=100.0,
                ends=(
                    "pinned",
                    rd.End(z="free", spring={"z": 50.0}, dashpot={"z": 0.5}, mass={"z": 0.01}),
                ),
            ),
            BLOW,
        ),
        (
            rd.Scene(BEAM, tension=100.0, parts=[rd.Resonator(0.5, 0.02, 20.0)]),
            {"drive": ("z", 0.25), "force": rd.Chirp(1.0, 20.0, 80.0, 0.01)},
        ),
        (rd.Scene(BEAM, tension=100.0), SHAKEN),
        (rd.Scene(BEAM, tension=100.0), {**SHAKEN, "force": rd.Step(1e-3, time=3.21e-3)}),
    ],
)
def test_steps_tell_what_the_sum_over_modes_tells(scene, asked, quantity):
    """Rigid elements have the same lumps in both."""
    model = scene.compile(elements=4, element="rigid")
    response = [("z", 0.5), ("z", 0.75), ("beta", 0.5)]
    # samples and jumps of an end bend and jump what is exact
    asked = {**asked, "response": response, "quantity": quantity}
    exact = model.transient(TIME, **asked)
    stepped = model.transient(TIME, method="direct", tolerance=1e-3, **asked)
    scale = np.abs(exact.value).max(axis=1, keepdims=True)
    assert (np.abs(stepped.value - exact.value) < 1e-3 * scale).all()


def test_snapshots_are_taken_when_they_are_asked_for():
    model = chain()
    dense = Dense(model)
    when = np.array([0.0, 1.2345e-3, 0.01])
    history = model.transient(
        TIME, start=PLUCK, response=("z", 0.5), method="direct", step=1e-5, snapshots=when
    )
    exact, _ = dense.motion(when, u=dense.rest(dense.load(("z", 0.5))))
    z = model.coordinates.index("z")
    number = dense.number[1:-1, z]
    shape = history.snapshot[:, 1:-1, z]
    assert history.snapshot.shape == (3, len(model.x), len(model.coordinates))
    assert np.abs(shape - exact[:, number]).max() < 1e-4 * np.abs(exact[:, number]).max()
    assert shape[0] == pytest.approx(exact[0, number], rel=1e-12)


def test_other_times_are_other_looks_at_the_same_motion():
    model = STRING.compile(elements=8)
    uneven = np.array([0.0, 1e-3, 1.5e-3, 4e-3, 4.1e-3, 0.01])
    asked = {"start": PLUCK, "response": ("z", 0.25), "method": "direct"}
    value = model.transient(uneven, tolerance=1e-7, **asked).value
    fine = model.transient(np.linspace(0, 0.01, 101), tolerance=1e-7, **asked)
    at = np.rint(uneven * 1e4).astype(int)
    assert np.abs(value - fine.value[:, at]).max() < 2e-7 * np.abs(fine.value).max()


def test_numerical_damping_takes_only_what_steps_do_not_resolve():
    model = STRING.compile(elements=64)
    kept, lost = (
        model.transient(
            [0.0, 1.0],
            start={("z", 0.5): 1.0},
            response=("z", 0.5),
            method="direct",
            step=2e-4,
            spectral_radius=radius,
        ).energy
        for radius in (1.0, 0.0)
    )
    last = lost["kinetic"][-1] + lost["strain"][-1]
    assert 0.5 < last / lost["strain"][0] < 0.99
    assert kept["kinetic"][-1] + kept["strain"][-1] == pytest.approx(kept["strain"][0], rel=1e-12)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (STRING.replace(damping=rd.LossFactor(0.01)), "in proportion to velocity"),
        (STRING.replace(damping=rd.ModalDamping(0.01)), "in proportion to velocity"),
        (
            STRING.replace(parts=[rd.BrokenWire(0.5, 0.05, 3e-4, radius=0.0)]),
            "broken wire",
        ),
        (
            rd.Scene(ROPE, tension=100.0, damping=rd.StiffnessDamping(1e-4)),
            'element must be "rigid"',
        ),
        (rd.Scene(ROPE, tension=-60.0), "elements must be more"),
    ],
)
def test_what_has_no_steps_is_refused_by_name(scene, words):
    with pytest.raises(rd.SceneError, match=words):
        scene.compile(elements=2).transient(
            [0.0, 0.1],
            force=rd.Sine(1.0, 5.0),
            drive=("z", 0.5),
            response=("z", 0.5),
            method="direct",
        )


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ({"drive": ("beta", 0.5), "force": rd.Impulse(1.0)}, "has no mass"),
        (
            {"drive": ("end", 0, "z"), "force": rd.Impulse(1.0), "response": ("z", 0.5)},
            "motion of an end",
        ),
        (
            {"start": PLUCK, "response": ("F_z", 0.5), "quantity": "velocity"},
            'quantity must be "displacement"',
        ),
        (
            {"drive": ("z", 0.4), "force": rd.Step(1.0), "quantity": "acceleration"},
            'element must be "tensed"',
        ),
    ],
)
def test_questions_without_an_answer_are_refused(asked, words):
    model = chain(element="rigid", rope=rd.Rope(1.0, 0.1, bending_stiffness=0.5))
    with pytest.raises(rd.SceneError, match=words):
        model.transient([0.0, 0.1], method="direct", **asked)


def test_continuous_spans_have_no_steps():
    with pytest.raises(rd.SceneError, match="elements must be given"):
        STRING.compile().transient([0.0, 0.1], start=PLUCK, response=("z", 0.5), method="direct")


def interrupt(fraction):
    if fraction > 0.5:
        signal.raise_signal(signal.SIGINT)


def test_interrupted_march_is_an_answer_where_that_is_wanted():
    model = STRING.compile(elements=2)
    time = np.linspace(0.0, 20.0, 2001)
    asked = {"start": PLUCK, "response": ("z", 0.5), "method": "direct", "step": 1e-3}
    whole = model.transient(time, **asked)
    part = model.transient(time, progress=interrupt, partial=True, **asked)
    assert part.stopped == "interrupted"
    assert 1000 <= len(part.time) < 2001
    assert np.array_equal(part.value, whole.value[:, : len(part.time)])
    assert part.energy["strain"].shape == part.time.shape
    with pytest.raises(KeyboardInterrupt):
        model.transient(time, progress=interrupt, **asked)


def test_histories_pickle_before_and_after_they_are_asked():
    model = STRING.compile(elements=4)
    history = model.transient(TIME, start=PLUCK, response=("z", 0.5), method="direct", step=1e-4)
    copy = pickle.loads(pickle.dumps(history))
    assert np.array_equal(copy.value, history.value)
    assert np.array_equal(copy.error, history.error)
    assert history.cost.method == "direct"
    assert history.cost.sweeps >= 2 * 200


@pytest.mark.parametrize("steps", [100_000, pytest.param(10_000_000, marks=pytest.mark.slow)])
def test_memory_does_not_grow_with_the_steps(steps):
    model = STRING.compile(elements=2)
    asked = {"start": PLUCK, "response": ("z", 0.5), "method": "direct", "step": 1e-4}
    model.transient([0.0, 1.0], **asked)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    model.transient([0.0, 1e-4 * steps], **asked)
    # kilobytes: blocks of 4096 steps, whatever their number
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 8_000


@pytest.mark.parametrize("stretching", [False, True])
def test_responses_that_are_rounding_by_symmetry_take_no_finer_steps(stretching):
    """A moment in the middle of two elements turns it and does not lift it."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=0.1, rotary_inertia=1e-4, axial_stiffness=1e3)
    tension = rd.Tension(100.0, stretching=stretching)
    model = rd.Scene(rope, tension=tension).compile(elements=2)
    history, alone = (
        model.transient(
            TIME,
            drive=("beta", 0.5),
            force=rd.Chirp(0.06, 5.0, 60.0, 0.1),
            response=response,
            method="direct",
        )
        for response in ([("z", 0.5), ("beta", 0.5)], ("beta", 0.5))
    )
    assert np.abs(history.value[0]).max() < 1e-12 * np.abs(history.value[1]).max()
    assert history.cost.sweeps == alone.cost.sweeps


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
@pytest.mark.parametrize(
    ("element", "rope", "tension"),
    [
        ("rigid", rd.Rope(1.0, 0.1), 100.0),
        ("rigid", BEAM.replace(rotary_inertia=1e-4), 100.0),
        ("difference", BEAM.replace(rotary_inertia=1e-4), 0.0),
    ],
)
def test_force_between_nodes_moves_a_chain_as_the_sum_over_modes_tells(
    element, rope, tension, quantity
):
    scene = rd.Scene(rope, tension=tension, damping=rd.RayleighDamping(20.0, 0.0))
    model = scene.compile(elements=4, element=element)
    asked = {
        "drive": [("z", 0.35), ("z", 0.8)],
        "force": [rd.Sine(1.0, 20.0, phase=0.3), rd.Impulse(0.1, duration=5e-3)],
        "response": [("z", 0.35), ("z", 0.3), ("z", 0.5)],
        "quantity": quantity,
    }
    exact = model.transient(TIME, **asked).value
    stepped = model.transient(TIME, method="direct", tolerance=1e-3, **asked)
    assert (np.abs(stepped.value - exact).max(axis=1) < 1e-3 * np.abs(exact).max(axis=1)).all()
    energy = stepped.energy
    change = energy["kinetic"] + energy["strain"] - energy["input"] + energy["dissipated"]
    assert np.ptp(change) < 1e-9 * energy["input"].max()


@pytest.mark.parametrize("name", ["F_z", "M_beta"])
def test_force_between_nodes_leaves_the_internal_forces_of_the_frequency_response(name):
    rope = BEAM.replace(rotary_inertia=1e-4)
    scene = rd.Scene(rope, tension=100.0, damping=rd.ViscousDamping(100.0))
    model = scene.compile(elements=4, element="rigid")
    asked = {"drive": ("z", 0.1), "response": [(name, 0.0), (name, 0.25)]}
    history = model.transient(
        [0.0, 4.0],
        force=rd.Step(1.0),
        method="direct",
        step=0.01,
        spectral_radius=0.0,
        **asked,
    )
    static = model.frf([0.0], **asked).value[:, 0].real
    assert history.value[:, -1] == pytest.approx(static, rel=1e-6)


@pytest.mark.parametrize(
    ("damping", "response", "quantity"),
    [
        (None, ("z", 0.4), "acceleration"),
        (rd.RayleighDamping(0.0, 1e-4), ("z", 0.4), "displacement"),
        (None, ("F_z", 0.4), "displacement"),
    ],
)
def test_shape_of_a_driven_element_is_refused_where_it_is_not_known(damping, response, quantity):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping).compile(
        elements=4, element="rigid"
    )
    with pytest.raises(rd.SceneError, match='"tensed"'):
        model.transient(
            [0.0, 0.1],
            drive=("z", 0.35),
            force=rd.Step(1.0),
            response=response,
            quantity=quantity,
            method="direct",
        )


@pytest.mark.parametrize("drive", [("beta", 0.5), ("z", 0.35)])
@pytest.mark.parametrize(
    "force", [rd.Sine(1.0, 20.0, phase=0.3), rd.Chirp(1.0, 10.0, 80.0, 0.01), SAMPLES]
)
def test_velocity_of_what_has_no_inertia_follows_the_force(force, drive):
    scene = rd.Scene(BEAM, tension=100.0, damping=rd.RayleighDamping(20.0, 0.0))
    model = scene.compile(elements=4, element="rigid")
    asked = {
        "drive": drive,
        "force": force,
        "response": [("beta", 0.5), ("beta", 0.25)],
        "quantity": "velocity",
    }
    exact = model.transient(TIME, **asked).value
    # of second order: on the way to 300 Hz of the shortest waves
    for step, most in ((2e-5, 4e-4), (5e-6, 4e-5)):
        stepped = model.transient(TIME, method="direct", step=step, **asked).value
        assert np.abs(stepped - exact).max() < most * np.abs(exact).max()


def test_acceleration_of_what_has_no_inertia_is_refused_under_a_force():
    model = rd.Scene(BEAM, tension=100.0).compile(elements=4)
    asked = {"force": rd.Sine(1.0, 20.0), "quantity": "acceleration", "method": "direct"}
    with pytest.raises(rd.SceneError, match="on a coordinate without mass"):
        model.transient(TIME, drive=("beta", 0.5), **asked)
    model.transient(TIME, drive=("beta", 0.5), response=("z", 0.5), step=1e-4, **asked)


@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
@pytest.mark.parametrize("size", [2.0**-600, 2.0**600])
def test_motion_is_in_proportion_to_forces_of_any_size(size, quantity):
    """Energies leave the range of numbers: motion does not."""
    model = STRING.compile(elements=4)
    asked = {"drive": ("z", 0.5), "quantity": quantity, "method": "direct"}
    one, other = (
        model.transient(TIME, force=rd.Sine(amplitude, 40.0), **asked) for amplitude in (1.0, size)
    )
    assert np.array_equal(other.value, size * one.value)


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("method", ["modal", "direct"])
def test_the_error_of_a_chain_counts_in_what_its_elements_cause(element, method):
    scene = rd.Scene(
        rd.Rope(1.0, 0.4, bending_stiffness=1.54),
        tension=2830.0,
        damping=rd.RayleighDamping(10.0, 1e-5),
    )
    time = np.linspace(0.0, 0.2, 101)
    push = {"drive": ("z", 0.3), "force": rd.Sine(1.0, 70.0), "response": ("z", 0.6)}
    exact = scene.compile().transient(time, **push).value
    model = scene.compile(elements=8, element=element)
    history = model.transient(time, **push, method=method)
    wrong, largest = np.abs(history.value - exact), np.abs(exact).max()
    # 8 and 42 % where the steps alone are right to 6e-5
    assert history.error.max() < 1e-4 * largest < 0.05 * wrong.max()
    assert (history.total_error >= wrong).all()
    assert (history.total_error <= wrong + 2 * history.error + 1e-5 * largest).all()
