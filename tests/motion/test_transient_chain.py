"""Motion of chains against exponentials of their matrices, refusals, what is kept of a run."""

import pickle
import signal

import numpy as np
import pytest
from dense_motion import Dense

import ropedyn as rd
from ropedyn import _core

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


def wrong(model, response, exact, **asked):
    """Check that the error covers the distance to what is exact; return its share."""
    value = exact[:, Dense(model).at(*response)]
    history = model.transient(TIME, response=response, **asked)
    off = np.abs(history.value[0] - value)
    assert (off <= history.error[0] + 1e-12 * np.abs(value).max()).all()
    return off.max() / np.abs(value).max()


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
def test_pluck_and_release_is_that_of_the_matrices(element, damping, response):
    model = chain(damping, element, LAGGING)
    dense = Dense(model)
    exact, _ = dense.motion(TIME, u=dense.rest(dense.load(("z", 0.5))))
    assert wrong(model, response, exact, start=PLUCK) < 1e-4


def test_sine_drives_motion_as_the_matrices_say():
    model = chain()
    dense = Dense(model)
    for quantity in ("displacement", "velocity"):
        exact = dense.motion(TIME, load=dense.load(("z", 0.5)), omega=2 * np.pi * 60, phase=0.0)
        asked = {"drive": ("z", 0.5), "force": rd.Sine(1.0, 60.0), "quantity": quantity}
        assert wrong(model, ("z", 0.5), exact[quantity == "velocity"], **asked) < 1e-9


def test_blow_at_an_instant_is_a_jump_of_velocity():
    model = chain()
    dense = Dense(model)
    mass = np.where(dense.moves, np.diag(dense.M), 1.0)
    exact, _ = dense.motion(TIME, v=dense.load(("z", 0.5), 0.1) / mass)
    assert wrong(model, ("z", 1 / 3), exact, drive=("z", 0.5), force=rd.Impulse(0.1)) < 1e-9


def test_moment_on_a_rotation_without_inertia_turns_it_at_once():
    model = chain()
    dense = Dense(model)
    exact, _ = dense.motion(TIME, load=dense.load(("beta", 0.5)))
    assert wrong(model, ("beta", 0.5), exact, drive=("beta", 0.5), force=rd.Step(1.0)) < 1e-9
    released, _ = dense.motion(TIME, u=dense.rest(dense.load(("beta", 0.5))))
    assert wrong(model, ("beta", 0.5), released, start={("beta", 0.5): 1.0}) < 1e-9


def test_step_inside_a_step_is_met():
    """A force that begins between two times, nowhere near a multiple of the step."""
    model = STRING.compile(elements=4)
    begin = TIME[3] + 1.234e-4
    late = model.transient(TIME, drive=("z", 0.5), force=rd.Step(1.0, time=begin), tolerance=1e-6)
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
    history = model.transient(time, start=PLUCK, response=("z", 0.25), tolerance=tolerance)
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
    history, finer = (model.transient(time, **asked, tolerance=t) for t in (1e-3, 1e-4))
    true = np.abs(history.value - finer.value)
    assert true.max() <= history.error.max()
    assert (true <= history.error + finer.error).mean() >= 0.98  # measured: 0.99 and 1


def test_moved_end_is_where_it_is_said_to_be():
    """A string much stiffer than its inertia follows the line between its ends."""
    model = STRING.compile(elements=4)
    motion = rd.Sine(1e-3, 5.0, phase=0.3)
    history = model.transient(
        TIME,
        drive=("end", 0, "z"),
        force=motion,
        response=[("z", 0.0), ("z", 0.5)],
    )
    assert history.value[0] == pytest.approx(motion.value(TIME), rel=1e-9)


@pytest.mark.parametrize("force", [rd.Sine(1e-3, 30.0, phase=0.4), SAMPLES])
def test_velocity_of_a_moved_end_is_that_of_its_motion(force):
    history = STRING.compile(elements=4).transient(
        TIME,
        drive=("end", 1, "z"),
        force=force,
        response=("z", 1.0),
        quantity="velocity",
    )
    if isinstance(force, rd.Sine):
        rate = force.rate(TIME)
    else:
        slope = np.diff(force) / np.diff(TIME)
        rate = np.append(slope, slope[-1])  # from the right where it bends
    assert np.abs(history.value[0] - rate).max() < 1e-9 * np.abs(rate).max()


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
    push = {"drive": ("z", 0.25), "force": rd.Step(1.0)}
    history = model.transient(np.linspace(0.0, 4.0, 4001), **push, response=(name, x))
    static = model.frf([0.0], drive=("z", 0.25), response=(name, x)).value[0, 0].real
    assert history.value[0, -1] == pytest.approx(static, rel=1e-6)


def test_resonator_is_a_mass_on_a_spring():
    absorber = rd.Resonator(0.5, 0.02, 30.0, damping_ratio=0.05)
    damping = rd.RayleighDamping(20.0, 0.0)
    model = STRING.replace(parts=[absorber], damping=damping).compile(elements=2)
    history = model.transient(
        np.linspace(0.0, 2.0, 401),
        drive=("z", 0.5),
        force=rd.Sine(1.0, 25.0, phase=0.2),
    )
    steady = model.frf([25.0], drive=("z", 0.5)).value[0, 0] * np.exp(
        1j * (2 * np.pi * 25.0 * history.time + 0.2 - np.pi / 2)
    )
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
    ],
)
def test_the_line_tells_what_the_sum_over_modes_tells(scene, asked, quantity):
    model = scene.compile(elements=4, element="rigid")
    response = [("z", 0.5), ("z", 0.75), ("beta", 0.5)]
    asked = {**asked, "response": response, "quantity": quantity}
    exact = model.transient(TIME, **asked)
    line = model.transient(TIME, method="line", tolerance=1e-2, **asked)
    apart, said = np.abs(line.value - exact.value), line.error + exact.error
    assert (apart.max(axis=1) <= said.max(axis=1)).all()


def test_snapshots_are_taken_when_they_are_asked_for():
    model = chain()
    dense = Dense(model)
    when = np.array([0.0, 1.2345e-3, 0.01])
    history = model.transient(TIME, start=PLUCK, response=("z", 0.5), snapshots=when)
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
    asked = {"start": PLUCK, "response": ("z", 0.25)}
    value = model.transient(uneven, tolerance=1e-7, **asked).value
    fine = model.transient(np.linspace(0, 0.01, 101), tolerance=1e-7, **asked)
    at = np.rint(uneven * 1e4).astype(int)
    assert np.abs(value - fine.value[:, at]).max() < 2e-7 * np.abs(fine.value).max()


def interrupt(fraction):
    if fraction > 0.5:
        signal.raise_signal(signal.SIGINT)


LAW = rd.NodeForce(0.5, lambda t, u, v: -1e5 * u**3)


def test_interrupted_run_is_an_answer_where_that_is_wanted():
    model = STRING.replace(parts=[LAW]).compile(elements=2)
    time = np.linspace(0.0, 20.0, 2001)
    asked = {"start": PLUCK, "response": ("z", 0.5)}
    whole = model.transient(time, **asked)
    part = model.transient(time, progress=interrupt, partial=True, **asked)
    assert part.stopped == "interrupted"
    assert 1000 <= len(part.time) <= 2001  # a whole block of steps is taken
    # the first of the runs, with the longest steps
    assert np.abs(part.value - whole.value[:, : len(part.time)]).max() < 1e-2 * part.value.max()
    with pytest.raises(KeyboardInterrupt):
        model.transient(time, progress=interrupt, **asked)


def test_histories_pickle_before_and_after_they_are_asked():
    model = STRING.compile(elements=4)
    history = model.transient(TIME, start=PLUCK, response=("z", 0.5))
    copy = pickle.loads(pickle.dumps(history))
    assert np.array_equal(copy.value, history.value)
    assert np.array_equal(copy.error, history.error)


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
        "force": [rd.Sine(1.0, 20.0), rd.Impulse(0.1, duration=5e-3)],
        "response": [("z", 0.35), ("z", 0.3), ("z", 0.5)],
        "quantity": quantity,
    }
    exact = model.transient(TIME, **asked)
    line = model.transient(TIME, method="line", **asked)
    assert (np.abs(line.value - exact.value) <= line.error + exact.error).all()
    energy = exact.energy
    change = energy["kinetic"] + energy["strain"] - energy["input"] + energy["dissipated"]
    assert np.ptp(change) < 1e-9 * energy["input"].max()


@pytest.mark.parametrize("name", ["F_z", "M_beta"])
def test_force_between_nodes_leaves_the_internal_forces_of_the_frequency_response(name):
    rope = BEAM.replace(rotary_inertia=1e-4)
    # viscous damping alone leaves rotations, which it does not reach, ringing for seconds
    damping = (rd.StiffnessDamping(1e-3), rd.ViscousDamping(100.0))
    scene = rd.Scene(rope, tension=100.0, damping=damping)
    model = scene.compile(elements=4, element="rigid")
    asked = {"drive": ("z", 0.1), "response": [(name, 0.0), (name, 0.25)]}
    history = model.transient(np.linspace(0.0, 4.0, 4001), force=rd.Step(1.0), **asked)
    static = model.frf([0.0], **asked).value[:, 0].real
    assert history.value[:, -1] == pytest.approx(static, rel=1e-6)


@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
@pytest.mark.parametrize("size", [2.0**-600, 2.0**600])
def test_motion_is_in_proportion_to_forces_of_any_size(size, quantity):
    """Energies leave the range of numbers: motion does not."""
    model = STRING.compile(elements=4)
    asked = {"drive": ("z", 0.5), "quantity": quantity}
    one, other = (
        model.transient(TIME, force=rd.Sine(amplitude, 40.0), **asked) for amplitude in (1.0, size)
    )
    assert np.array_equal(other.value, size * one.value)


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("method", ["modal", "line"])
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
    history = model.transient(time, **push, method=method, tolerance=1e-4)
    wrong, largest = np.abs(history.value - exact), np.abs(exact).max()
    # 8 and 42 % where the motion of the elements is known to 1e-4
    assert history.error.max() < 1e-4 * largest < 0.05 * wrong.max()
    assert (history.total_error >= wrong).all()
    assert (history.total_error <= wrong + 2 * history.error + 1e-5 * largest).all()


# --- energies of what modes do not part ---------------------------------------------------------


@pytest.mark.claim(
    "Energy of chains whose dampers couple modes: what is missing over the largest there is",
    reference="input = kinetic + strain + dissipated",
    accepted=5e-4,
)
@pytest.mark.parametrize("part", [rd.Dashpot(0.4, 3.0), rd.Resonator(0.4, 0.02, 20.0)], ids=str)
@pytest.mark.parametrize(
    "force",
    [rd.Impulse(0.1, time=1e-3, duration=2e-3), rd.Sine(1.0, 80.0), rd.Impulse(0.1, time=1e-3)],
    ids=str,
)
def test_energy_balances_where_dampers_couple_modes(part, force, claim):
    damping = rd.StiffnessDamping(1e-4)
    scene = rd.Scene(LAGGING, tension=100.0, parts=[part], damping=damping)
    history = scene.compile(elements=5, element="rigid").transient(
        np.linspace(0.0, 0.02, 201),
        drive=("z", 0.6),
        force=force,
        response=("z", 0.4),
        start={("z", 0.2): 10.0},
    )
    e = history.energy
    assert history.cost.method == "line"
    kept = e["kinetic"] + e["strain"] - e["input"] + e["dissipated"]
    assert e["dissipated"][-1] > 0.01 * e["strain"][0]
    claim(np.ptp(kept) / (e["kinetic"] + e["strain"]).max())


def test_ctrl_c_leaves_what_phases_had_told():
    parts = [rd.Stop(0.25, 1e4, gap=1e-4), rd.Dashpot(0.5, 0.5, exponent=0.0)]
    model = STRING.replace(parts=parts).compile(elements=8)
    time = np.linspace(0.0, 1.0, 2001)
    asked = {"drive": ("z", 0.5), "force": rd.Sine(20.0, 30.0), "response": ("z", 0.25)}
    whole = model.transient(time, **asked)
    part = model.transient(time, progress=interrupt, partial=True, **asked)
    assert (part.cost.method, part.stopped) == ("events", "interrupted")
    assert 1000 <= len(part.time) < 2001
    assert np.abs(part.value - whole.value[:, : len(part.time)]).max() < 1e-9 * whole.value.max()
    with pytest.raises(KeyboardInterrupt):
        model.transient(time, progress=interrupt, **asked)


@pytest.mark.parametrize("partial", [False, True])
def test_ctrl_c_ends_phases_of_all_components_at_once(partial):
    """Those after the first were followed all the same."""
    rope = rd.Rope(1.0, 0.1, torsional_stiffness=2.0, polar_inertia=1e-5)
    parts = [
        rd.Dashpot(0.5, 0.5, exponent=0.0),
        rd.Dashpot(0.5, 0.01, exponent=0.0, coordinate="alpha"),
    ]
    model = rd.Scene(rope, tension=100.0, parts=parts).compile(elements=8)
    drive, calls = [("z", 0.25), ("alpha", 0.25)], []

    def stop(_):
        calls.append(1)
        signal.raise_signal(signal.SIGINT)

    asked = {"drive": drive, "force": [rd.Sine(20.0, 30.0), rd.Sine(1.0, 30.0)], "response": drive}
    with pytest.raises(KeyboardInterrupt):
        model.transient(np.linspace(0.0, 1.0, 501), **asked, progress=stop, partial=partial)
    assert len(calls) == 1


def test_ctrl_c_between_blocks_of_steps_leaves_those_before(monkeypatch):
    """It came from the core or the recording of a block, and nothing was left."""
    model = STRING.replace(parts=[LAW]).compile(elements=2)
    time = np.linspace(0.0, 20.0, 2001)
    asked = {"start": PLUCK, "response": ("z", 0.5)}
    steps, calls = _core.collocate, []
    monkeypatch.setattr("ropedyn.motion.smooth.passage.BLOCK", 1 << 10)

    def stopped(*given):
        calls.append(1)
        if len(calls) == 4:
            raise KeyboardInterrupt
        return steps(*given)

    monkeypatch.setattr("ropedyn._core.collocate", stopped)
    part = model.transient(time, partial=True, **asked)
    assert part.stopped == "interrupted"
    assert 1 < len(part.time) < 2001
    assert np.isinf(part.error).all()
