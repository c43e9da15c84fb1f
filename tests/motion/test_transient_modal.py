"""Motion over time by modes, against closed forms and exponentials of assembled matrices."""

import pickle

import numpy as np
import pytest
import scipy.linalg

import ropedyn as rd

LENGTH, DENSITY, TENSION = 1.3, 0.1, 100.0
SPEED = np.sqrt(TENSION / DENSITY)
STRING = rd.Rope(LENGTH, DENSITY)
ROPE = rd.Rope(LENGTH, DENSITY, bending_stiffness=0.8)
TIME = np.array([0.0, 0.0013, 0.013, 0.02, 0.05, 0.2])


def sines(x, count):
    """Shapes of a string or a pinned beam at x, modal mass 1, and wave numbers."""
    k = np.arange(1, count + 1) * np.pi / LENGTH
    return np.sqrt(2 / LENGTH / DENSITY) * np.sin(k * x), k


# --- against closed forms -----------------------------------------------------------------------


def test_plucked_string_is_two_waves():
    """d'Alembert: half of the triangle goes to the left and half to the right."""
    model = rd.Scene(STRING, tension=TENSION).compile()
    at, load = 0.4, 2.0
    time = np.linspace(0.0, 3 * LENGTH / SPEED, 200)

    def triangle(x):
        x = np.mod(x, 2 * LENGTH)
        odd = np.where(x > LENGTH, -1.0, 1.0)
        x = np.where(x > LENGTH, 2 * LENGTH - x, x)
        shape = np.minimum(x * (LENGTH - at), at * (LENGTH - x)) / LENGTH
        return odd * load / TENSION * shape

    asked = {"start": {("z", at): load}, "response": [("z", 0.9), ("z", at)]}
    found = [model.transient(time, **asked)]
    found += [model.transient(time, **asked, modes=n, tolerance=1e-2) for n in (64, 250)]
    for history in found:
        for x, value, most in zip((0.9, at), history.value, history.error):
            exact = (triangle(x - SPEED * time) + triangle(x + SPEED * time)) / 2
            # that of modes is attained at t = 0
            assert (np.abs(value - exact) <= most * (1 + 1e-9)).all()
            assert most.max() < 1e-2 * np.abs(exact).max()
    assert found[0].cost.method == "modal"
    assert found[0].error.max() < 1e-3 * np.abs(found[0].value).max()
    assert found[2].error.max() < found[1].error.max()


def test_plucked_string_is_its_sines():
    model = rd.Scene(STRING, tension=TENSION).compile()
    asked = {"response": ("z", 0.9), "modes": 30, "tolerance": 0.1}
    history = model.transient(TIME, start={("z", 0.4): 2.0}, **asked)
    (a, k), (b, _) = sines(0.4, 30), sines(0.9, 30)
    w = SPEED * k
    exact = 2.0 * (a * b / w**2) @ np.cos(np.outer(w, TIME))
    np.testing.assert_allclose(history.value[0], exact, atol=1e-12 * np.abs(exact).max())
    assert history.cost.unknowns == 30


def oscillated(w, decay, drive, time):
    """A mode at rest under sin(drive t): damped, with p = -decay +- i sqrt(w^2 - decay^2)."""
    steady = 1 / (w**2 - drive**2 + 2j * decay * drive)
    p = -decay + 1j * np.sqrt(w**2 - decay**2)
    # q = Im(steady e^(i drive t)) + Re(c e^(pt)), q(0) = q'(0) = 0
    start, slope = steady.imag, (1j * drive * steady).imag
    c = -start + 1j * (slope - p.real * start) / p.imag
    return (steady * np.exp(1j * drive * time)).imag + (c * np.exp(p * time)).real


@pytest.mark.parametrize("ratio", [0.0, 0.05])
def test_mass_on_a_string_is_an_oscillator(ratio):
    mass, drive = 0.5, 2 * np.pi * 3.0
    w = np.sqrt(4 * TENSION / LENGTH / mass)
    dashpot = [rd.Dashpot(LENGTH / 2, 2 * ratio * w * mass)] if ratio else []
    parts = [rd.PointMass(LENGTH / 2, mass), *dashpot]
    scene = rd.Scene(rd.Rope(LENGTH, 1e-14), tension=TENSION, parts=parts)
    middle = ("z", LENGTH / 2)
    model = scene.compile(elements=2)
    history = model.transient(TIME, drive=middle, force=rd.Sine(0.7, 3.0))
    exact = 0.7 / mass * oscillated(w, ratio * w, drive, TIME)
    np.testing.assert_allclose(history.value[0], exact, atol=1e-11 * np.abs(exact).max())


@pytest.mark.parametrize("span", [1e-7, 1e-5, 1e-3])
def test_mass_let_go_begins_as_an_oscillator(span):
    """Far within a period derivatives lost (omega t)^2 of their digits, and no error said so."""
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=2)
    mass, stiffness = (m().toarray()[0, 0] for m in (model.mass_matrix, model.stiffness_matrix))
    omega, time = np.sqrt(stiffness / mass), np.linspace(0.0, span, 6)
    exact = [-omega * np.sin(omega * time), -(omega**2) * np.cos(omega * time)]
    for quantity, rest in zip(("velocity", "acceleration"), exact):
        asked = {"start": {("z", 0.5): 1.0}, "response": ("z", 0.5), "quantity": quantity}
        history = model.transient(time, **asked)
        off = np.abs(history.value[0] - rest / stiffness)
        assert history.cost.method == "modal"
        assert (off <= history.error[0]).all()
        assert off.max() <= 1e-13 * np.abs(rest).max() / stiffness  # measured: 4e-15


def test_string_under_a_sine_is_the_sum_of_its_modes_and_the_static_rest():
    model = rd.Scene(STRING, tension=TENSION, damping=rd.ViscousDamping(0.3)).compile()
    asked = {"drive": ("z", 0.4), "force": rd.Sine(0.7, 20.0), "response": ("z", 0.9)}
    history = model.transient(TIME, **asked, modes=25, tolerance=0.1)
    (a, k), (b, _) = sines(0.4, 25), sines(0.9, 25)
    w = SPEED * k
    motion = np.stack([oscillated(one, 0.3 / DENSITY / 2, 40 * np.pi, TIME) for one in w])
    rest = 0.4 * 0.4 / LENGTH / TENSION - (a * b / w**2).sum()
    exact = 0.7 * (a * b @ motion + rest * np.sin(40 * np.pi * TIME))
    np.testing.assert_allclose(history.value[0], exact, atol=1e-11 * np.abs(exact).max())
    every = model.transient(TIME, **asked, modes=400)
    assert np.abs(every.value - history.value).max() <= history.error.min()


def test_static_motion_of_the_modes_left_out_brings_the_sum_nearer():
    model = rd.Scene(STRING, tension=TENSION).compile()
    asked = {"drive": ("z", 0.4), "force": rd.Sine(0.7, 20.0)}
    few = model.transient(TIME, **asked, modes=5, tolerance=1.0).value[0]
    every = model.transient(TIME, **asked, modes=300).value[0]
    a, k = sines(0.4, 5)
    motion = np.stack([oscillated(SPEED * one, 0.0, 40 * np.pi, TIME) for one in k])
    alone = 0.7 * a * a @ motion
    assert np.abs(few - every).max() < 0.1 * np.abs(alone - every).max()


def test_beam_under_a_step_swings_to_twice_its_deflection():
    beam = rd.Rope(LENGTH, DENSITY, bending_stiffness=2.0)
    model = rd.Scene(beam, ends=("pinned", "pinned")).compile()
    begin = 0.004
    history = model.transient(
        TIME, drive=("z", 0.4), force=rd.Step(3.0, time=begin), response=("z", 0.9), modes=20
    )
    (a, k), (b, _) = sines(0.4, 20), sines(0.9, 20)
    w = k**2 * np.sqrt(2.0 / DENSITY)
    since = np.maximum(TIME - begin, 0.0)
    rest = model.static({("z", 0.4): 1.0}, points=13).displacement[9, 0] - (a * b / w**2).sum()
    exact = 3.0 * (a * b / w**2 @ (1 - np.cos(np.outer(w, since))) + rest * (begin <= TIME))
    np.testing.assert_allclose(history.value[0], exact, atol=1e-10 * np.abs(exact).max())


def test_string_moved_at_its_end_carries_the_wave():
    model = rd.Scene(STRING, tension=TENSION).compile()
    before = np.linspace(0.0, (2 * LENGTH - 0.6) / SPEED, 40)  # that is reflected comes back
    force = rd.Sine(0.01, 30.0)
    asked = {"drive": ("end", 0, "z"), "force": force, "response": ("z", 0.6)}
    history = model.transient(before, **asked)
    since = np.maximum(before - 0.6 / SPEED, 0.0)
    exact = 0.01 * np.sin(60 * np.pi * since)
    assert (np.abs(history.value[0] - exact) <= history.error[0]).all()
    assert history.error.max() <= 1e-3 * 0.01
    with pytest.raises(rd.SolveError, match="Error by 40 modes: up to inf"):
        model.transient(before, **asked, modes=40, tolerance=1e-3)
    assert np.isinf(model.transient(before, **asked, modes=40).error).all()
    assert (history.force[0] == force.value(before)).all()
    assert np.abs(history.force[0] - 0.01 * np.sin(60 * np.pi * before)).max() < 1e-16


def test_free_rope_under_a_force_moves_off_as_a_body():
    scene = rd.Scene(ROPE, ends=("free", "free"))
    x = ("z", LENGTH / 2)
    history = scene.compile(elements=16).transient([0.0, 50.0], drive=x, force=rd.Step(1.0))
    fall = 0.5 * 50.0**2 / (LENGTH * DENSITY)
    assert history.value[0, 1] == pytest.approx(fall, abs=0.1)  # the rest swings by as much
    with pytest.raises(rd.SceneError, match="no rest under a load"):
        scene.compile(elements=16).transient([0.0, 1.0], start={x: 1.0}, response=x)


# --- against exponentials of matrices -----------------------------------------------------------


class Dense:
    """The assembled chain as a first-order system, what has no mass condensed."""

    def __init__(self, model):
        self.model = model
        K, M, C = (
            one().toarray()
            for one in (model.stiffness_matrix, model.mass_matrix, model.damping_matrix)
        )
        moves = (np.abs(M).sum(axis=1) + np.abs(C).sum(axis=1)) > 0
        still = ~moves
        K, self.whole = self._condensed(K, moves, still), K
        self.M, self.C, self.K = M[np.ix_(moves, moves)], C[np.ix_(moves, moves)], K
        self.moves, n = np.flatnonzero(moves), moves.sum()
        solved = np.linalg.solve(self.M, np.hstack([self.K, self.C]))
        self.A = np.block([[np.zeros((n, n)), np.eye(n)], [-solved]])

    @staticmethod
    def _condensed(K, moves, still):
        follows = np.linalg.solve(K[np.ix_(still, still)], K[np.ix_(still, moves)])
        return K[np.ix_(moves, moves)] - K[np.ix_(moves, still)] @ follows

    def of(self, x):
        """Which state is z at x."""
        free = self.model.chain.held[self.model.chain.term_of] == 0
        number = np.cumsum(free.ravel()).reshape(free.shape) - 1
        row = number[np.abs(self.model.x - x).argmin(), self.model.coordinates.index("z")]
        return int(np.flatnonzero(self.moves == row)[0])

    def under_a_sine(self, x, frequency, time):
        """Motion, velocity and acceleration, each (n, t), from rest under sin."""
        n, w = len(self.K), 2 * np.pi * frequency
        big = np.zeros((2 * n + 2, 2 * n + 2))
        big[: 2 * n, : 2 * n] = self.A
        big[n : 2 * n, 2 * n] = np.linalg.solve(self.M, np.eye(n)[self.of(x)])
        big[2 * n, 2 * n + 1], big[2 * n + 1, 2 * n] = w, -w
        start = np.append(np.zeros(2 * n + 1), 1.0)
        state = np.stack([scipy.linalg.expm(big * t) @ start for t in time], axis=1)
        return state[:n], state[n : 2 * n], (big @ state)[n : 2 * n]

    def let_go(self, x, time):
        """Motion after a load of 1."""
        n = len(self.K)
        start = np.append(np.linalg.solve(self.K, np.eye(n)[self.of(x)]), np.zeros(n))
        return np.stack([scipy.linalg.expm(self.A * t) @ start for t in time], axis=1)[:n]


CHAINS = {
    "string": rd.Scene(STRING, tension=TENSION),
    "rope": rd.Scene(ROPE, tension=TENSION),
    "drag": rd.Scene(ROPE, tension=TENSION, damping=rd.ViscousDamping(0.4)),
    "rayleigh": rd.Scene(STRING, tension=TENSION, damping=rd.RayleighDamping(0.4, 1e-4)),
    "rope with a dashpot": rd.Scene(
        ROPE, tension=TENSION, parts=[rd.Dashpot(LENGTH / 3, 1.0), rd.PointMass(LENGTH / 2, 0.2)]
    ),
    "overdamped string": rd.Scene(STRING, tension=TENSION, parts=[rd.Dashpot(LENGTH / 3, 20.0)]),
}
UNCOUPLED = ("string", "rope", "drag", "rayleigh")  # Damping does not couple their modes.


def apart(model, **how):
    """How far motion is from the exponential of the matrices, relative to the largest value."""
    dense, pushed, seen = Dense(model), model.x[4], model.x[6]
    exact = dense.under_a_sine(pushed, 20.0, TIME)
    asked = {"drive": ("z", pushed), "response": ("z", seen)} | how
    for quantity, one in zip(("displacement", "velocity", "acceleration"), exact):
        history = model.transient(TIME, **asked, force=rd.Sine(1.0, 20.0), quantity=quantity)
        yield history, np.abs(history.value[0] - one[dense.of(seen)])
    history = model.transient(TIME, start={("z", pushed): 0.4}, response=("z", seen), **how)
    yield history, np.abs(history.value[0] - 0.4 * dense.let_go(pushed, TIME)[dense.of(seen)])


@pytest.mark.claim(
    "Motion of chains by all their modes, of proportional damping: under a sine and let go, "
    "displacement, velocity and acceleration",
    reference="scipy.linalg.expm of the assembled matrices",
    accepted=8e-12,
)
@pytest.mark.parametrize("name", UNCOUPLED)
def test_all_modes_of_a_chain_are_the_exponential_of_its_matrices(name, claim):
    for history, error in apart(CHAINS[name].compile(elements=12)):
        assert history.cost.method == "modal"
        claim(error.max() / np.abs(history.value).max())
        assert (error <= history.error[0]).all()


@pytest.mark.claim(
    "Motion of chains by the line, proportional damping and not, overdamped too, asked for to "
    "1e-7: under a sine and let go, displacement, velocity and acceleration",
    reference="scipy.linalg.expm of the assembled matrices",
    accepted=1e-7,
)
@pytest.mark.parametrize("name", CHAINS)
def test_line_of_a_chain_is_the_exponential_of_its_matrices(name, claim):
    model = CHAINS[name].compile(elements=12)
    for history, error in apart(model, method="line", tolerance=1e-7):
        assert history.cost.method == "line"
        claim(error.max() / np.abs(history.value).max())
        assert (error <= history.error[0]).all()


def test_damping_that_drives_is_refused_by_name():
    """Stiffness damping of what pushes away makes modes grow, as fast as nothing bounds."""
    scene = rd.Scene(
        STRING,
        tension=TENSION,
        parts=[rd.Spring(LENGTH / 3, -20.0)],
        damping=rd.StiffnessDamping(1e-4),
    )
    asked = {"drive": ("z", 0.4), "force": rd.Sine(1.0, 20.0)}
    with pytest.raises(rd.SceneError, match="which drives where it pushes away"):
        scene.compile(elements=12).transient(TIME, **asked)


# --- what else an answer says -------------------------------------------------------------------


@pytest.mark.parametrize("name", ["rope", "drag", "rayleigh"])
def test_energy_is_that_of_the_matrices(name):
    model = CHAINS[name].compile(elements=12)
    dense, pushed = Dense(model), model.x[4]
    u, v, _ = dense.under_a_sine(pushed, 20.0, TIME)
    energy = model.transient(TIME, drive=("z", pushed), force=rd.Sine(1.0, 20.0)).energy
    kinetic = np.einsum("it,ij,jt->t", v, dense.M, v) / 2
    strain = np.einsum("it,ij,jt->t", u, dense.K, u) / 2
    for own, exact in (("kinetic", kinetic), ("strain", strain)):
        np.testing.assert_allclose(energy[own], exact, atol=1e-10 * exact.max())


FORCES = {
    "sines": [rd.Sine(1.0, 20.0), rd.Sine(2.0, 33.0)],
    "hammer": [rd.Impulse(0.01, time=0.0333, duration=0.001), rd.Step(1.0, time=0.01)],
    "blows": [rd.Impulse(0.01, time=0.0333), (rd.Impulse(0.02), rd.Impulse(0.01, time=0.0333))],
    "samples": [np.random.default_rng(1).normal(size=41), rd.Chirp(1.0, 5.0, 90.0, 0.15)],
}


@pytest.mark.parametrize("name", FORCES)
@pytest.mark.parametrize(
    "damping", [None, rd.RayleighDamping(0.4, 1e-4), rd.ModalDamping(0.03)], ids=str
)
def test_energy_is_kept_to_rounding(name, damping):
    """Input and losses are Gauss sums that know nothing of the balance."""
    model = rd.Scene(ROPE, tension=TENSION, damping=damping).compile(elements=12)
    history = model.transient(
        np.linspace(0.0, 0.2, 41),
        drive=[("z", 0.4), ("z", 0.7)],
        force=FORCES[name],
        start={("z", 0.6): 3.0},
    )
    energy = history.energy
    total = energy["kinetic"] + energy["strain"] - energy["input"] + energy["dissipated"]
    assert np.ptp(total) < 1e-9 * energy["strain"].max()
    assert energy["dissipated"][-1] > 0 or damping is None


@pytest.mark.parametrize(
    ("force", "damping"),
    [
        (rd.Sine(1.0, 5000.0), None),  # 55 times the fastest mode
        (rd.Step(1.0), rd.RayleighDamping(0.0, 1e-10)),  # what lags is gone in 1e-9 s
        (rd.Sine(1.0, 20.0), rd.RayleighDamping(0.0, 1e-2)),  # overdamped up to 4e4/s
    ],
)
def test_energy_is_kept_where_forces_or_decay_are_faster_than_modes(force, damping):
    model = rd.Scene(STRING, tension=TENSION / 10, damping=damping).compile(elements=4)
    energy = model.transient([0.0, 0.3, 1.0], drive=("z", 0.4), force=force).energy
    total = energy["kinetic"] + energy["strain"] - energy["input"] + energy["dissipated"]
    most = max(energy["kinetic"].max(), energy["strain"].max())
    assert np.ptp(total) < 1e-9 * most


def test_energy_of_moved_ends_is_refused():
    model = CHAINS["rope"].compile(elements=6)
    asked = {"drive": ("end", 0, "z"), "force": rd.Sine(1.0, 5.0), "response": ("z", 0.4)}
    with pytest.raises(rd.SceneError, match="energy is not told where an end is moved"):
        _ = model.transient(TIME, **asked).energy


def test_snapshots_are_the_responses_of_all_nodes():
    asked = {"drive": ("z", 0.4), "force": rd.Step(1.0), "snapshots": [0.0, 0.013, 0.05]}
    for elements in (12, None):
        model = CHAINS["rope"].compile(elements=elements)
        history = model.transient(TIME, **asked, response=("beta", 0.65), modes=11, tolerance=0.1)
        assert history.snapshot.shape == (3, len(history.x), 2)
        middle = np.abs(history.x - 0.65).argmin()
        np.testing.assert_allclose(
            history.snapshot[:, middle, 1], history.value[0, [0, 2, 4]], rtol=1e-9, atol=1e-15
        )
        assert (history.snapshot[:, [0, -1]] == 0).all()


def test_mesh_error_is_the_distance_to_continuous_spans():
    asked = {"drive": ("z", 0.4), "force": rd.Sine(1.0, 20.0), "response": ("z", 0.9)}
    chain = CHAINS["string"].compile(elements=16).transient(TIME, **asked)
    true = CHAINS["string"].compile().transient(TIME, **asked)
    distance = np.abs(chain.value - true.value) + true.error
    np.testing.assert_array_equal(chain.mesh_error, distance)
    assert (true.mesh_error == 0).all()


def test_no_force_has_the_bound_of_no_motion():
    """Also of an end, whose motion has none."""
    model = rd.Scene(ROPE, ends=("pinned", "free")).compile(elements=8)
    history = model.transient(TIME, drive=("end", 0, "z"), force=rd.Step(0.0), response=("z", 0.65))
    assert not history.error.any()
    assert not history.value.any()


@pytest.mark.parametrize("elements", [4, None])
@pytest.mark.parametrize("quantity", ["displacement", "velocity", "acceleration"])
def test_half_sine_too_short_for_numbers_is_refused(elements, quantity):
    """Its force is 1e298 N, its derivatives are beyond."""
    model = rd.Scene(STRING, tension=TENSION).compile(elements=elements)
    blow = rd.Impulse(0.01, duration=1e-300)
    with pytest.raises(rd.SolveError, match="the motion grows beyond"):
        model.transient(TIME, drive=("z", 0.4), force=blow, quantity=quantity)


def test_blow_at_an_instant_has_no_bound_but_of_all_modes():
    asked = {"drive": ("z", 0.4), "force": rd.Impulse(0.01), "response": ("z", 0.9)}
    model = CHAINS["rope"].compile(elements=12)
    history = model.transient(TIME, **asked)
    assert history.error.max() < 1e-9 * np.abs(history.value).max()  # 1.6e-10: rounding
    with pytest.raises(rd.SolveError, match="Error by 5 modes: up to inf"):
        model.transient(TIME, **asked, modes=5, tolerance=1e-3)
    assert np.isinf(model.transient(TIME, **asked, modes=5).error).all()


@pytest.mark.parametrize("elements", [6, None])
def test_which_of_equal_modes_has_which_ratio_is_said_not_to_be_known(elements):
    """Spans of one length, ratios of 0.11 and 0.004: their mean was taken, to 3e-11."""
    ratios = [0.11, 0.004, *60 * [0.01]]
    scene = rd.Scene(STRING, tension=TENSION, parts=[rd.Support(LENGTH / 2)])
    asked = {"drive": ("z", LENGTH / 3), "force": rd.Sine(1.0, 20.0)}
    time = np.linspace(0.0, 0.1, 101)

    def moved(damping, **more):
        given = scene.replace(damping=damping)
        model = given.compile(elements=elements, element=elements and "rigid")
        return model.transient(time, **asked, **more)

    with pytest.raises(rd.SolveError, match="one damping ratio for modes that lie too close"):
        moved(rd.ModalDamping(ratios))
    told = moved(rd.ModalDamping(ratios), tolerance=10.0)
    for first in ratios[:2]:
        other = moved(rd.ModalDamping([first, first, *60 * [0.01]]))
        assert (np.abs(told.value - other.value) <= told.error + other.error).all()


def test_history_pickles_with_what_was_not_asked_yet():
    history = (
        CHAINS["rope"]
        .compile(elements=6)
        .transient(TIME, drive=("z", 0.4), force=rd.Sine(1.0, 20.0), progress=lambda fraction: None)
    )
    again = pickle.loads(pickle.dumps(history))
    np.testing.assert_array_equal(again.mesh_error, history.mesh_error)
    np.testing.assert_array_equal(again.energy["input"], history.energy["input"])


def test_progress_ends_at_one():
    told = []
    model = CHAINS["rope"].compile(elements=6)
    drive = [("z", 0.4), ("z", 0.7)]
    model.transient(TIME, drive=drive, force=[rd.Sine(1.0, 20.0)] * 2, progress=told.append)
    assert told == [0.5, 1.0]


# --- shapes -------------------------------------------------------------------------------------


@pytest.mark.parametrize("mode", [1, 3])
def test_a_string_that_begins_as_a_sine_stays_one(mode):
    model = rd.Scene(STRING, tension=TENSION).compile()
    omega = mode * np.pi * SPEED / LENGTH
    time, where = np.linspace(0.0, 3.3 * LENGTH / SPEED, 200), 0.4
    seen = np.sin(mode * np.pi * where / LENGTH)

    def sine(x):
        return np.sin(mode * np.pi * x / LENGTH)

    shaped = model.transient(time, start=sine, response=("z", where))
    moving = model.transient(time, velocity=sine, response=("z", where))
    exact = {shaped: seen * np.cos(omega * time), moving: seen * np.sin(omega * time) / omega}
    for history, true in exact.items():
        assert (np.abs(history.value[0] - true) <= history.error[0]).all()
        assert history.error.max() <= 2e-5 * np.abs(true).max()  # 1.5e-5 of mode 3
    pushed = {"drive": ("z", 0.9), "force": rd.Sine(1.0, 0.3 * SPEED / LENGTH)}
    both = model.transient(time, start=sine, response=("z", where), **pushed)
    alone = model.transient(time, response=("z", where), **pushed)
    apart = np.abs(both.value - shaped.value - alone.value)
    assert (apart <= shaped.error + alone.error + both.error).all()


def test_a_shape_with_a_kink_is_within_its_error():
    model = rd.Scene(STRING, tension=TENSION).compile()
    time, where, kink = np.linspace(0.0, 2.0 * LENGTH / SPEED, 300), 0.4, 0.37 * LENGTH

    def triangle(x):
        return np.minimum(x / kink, (LENGTH - x) / (LENGTH - kink))

    def wave(x):
        x = np.mod(x, 2 * LENGTH)
        return np.where(x > LENGTH, -triangle(2 * LENGTH - x), triangle(x))

    history = model.transient(time, start=triangle, response=("z", where), tolerance=0.02)
    exact = (wave(where - SPEED * time) + wave(where + SPEED * time)) / 2
    assert (np.abs(history.value[0] - exact) <= history.error[0]).all()
    with pytest.raises(rd.SolveError, match="start and velocity are known to"):
        model.transient(time, start=triangle, response=("z", where))


def test_places_beside_stiff_springs_do_not_jump_where_no_inertia_is_left_out():
    # all modes are summed: what they leave of the slope there is rounding, which damped stiffness
    # made a velocity of 1.3e-5 of the largest at the first time, with 1e-10 said
    x = 0.7 * 4 / 9
    scene = rd.Scene(
        rd.Rope(0.7, 0.38, bending_stiffness=0.0745),
        tension=159.0,
        ends=("clamped", "pinned"),
        damping=rd.RayleighDamping(1.1, 1e-6),
        parts=[rd.Spring(x, 1e12)],
    )
    moved = scene.compile(elements=9, element="rigid").transient(
        np.linspace(0, 0.1, 100),
        drive=("z", x),
        force=rd.Sine(0.62, 4.8, phase=0.22),
        response=[("beta", x), ("beta", 0.7 / 9)],
        quantity="velocity",
        method="modal",
    )
    assert (np.abs(moved.value[:, 0]) < 1e-12 * np.abs(moved.value).max(axis=1)).all()
