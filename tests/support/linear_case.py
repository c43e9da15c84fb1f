"""Random linear scenes under random forces, and their exact motion by exponentials of matrices."""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import expm

import ropedyn as rd
from ropedyn.motion.modal.convolution import SinePiece, pieces

QUANTITIES = ("displacement", "velocity", "acceleration")


@dataclass(frozen=True)
class Case:
    """A question to `Model.transient`."""

    model: rd.Model
    time: np.ndarray
    drive: tuple
    force: object  # None: the load is let go
    response: tuple
    quantity: str
    load: float = 0.0

    @property
    def asked(self):
        """Its arguments."""
        pushed = {"drive": self.drive, "force": self.force}
        acts = pushed if self.force is not None else {"start": {self.drive: self.load}}
        return acts | {"response": self.response, "quantity": self.quantity}


def random_case(seed):
    """Return one of rigid elements, 4 to 64 of them, each with inertia in every coordinate."""
    random = np.random.default_rng(seed)

    def between(low, high):
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    length, density, tension = between(0.5, 3.0), between(0.05, 2.0), between(10.0, 5000.0)
    elements = int(between(4, 65))
    radius = 10 ** random.uniform(-2.5, -1.5) * length
    twists = random.random() < 0.2
    rope = rd.Rope(
        length,
        density,
        bending_stiffness=tension * length**2 * between(1e-5, 1e-1),
        rotary_inertia=density * radius**2,
        torsional_stiffness=between(0.1, 10.0) if twists else None,
        polar_inertia=density * radius**2 if twists else None,
    )
    speed = np.sqrt(tension / density)
    turn = np.pi * speed / length
    at = np.linspace(0.0, length, elements + 1)[1:-1]
    damping = [
        None,
        rd.StiffnessDamping(between(1e-5, 3e-2) / turn * 10),
        rd.RayleighDamping(between(1e-3, 1.0) * turn, between(1e-5, 1e-2) / turn),
        rd.ViscousDamping(density * turn * between(1e-3, 3.0)),
        (rd.StiffnessDamping(between(1e-4, 1e-2) / turn), rd.ViscousDamping(density * turn * 0.1)),
    ][random.integers(5)]
    parts = []
    for x in random.choice(at, min(int(random.integers(4)), len(at)), replace=False):
        kind = random.integers(3)
        if kind == 0:
            parts.append(rd.Dashpot(float(x), density * speed * between(0.01, 10.0)))
        elif kind == 1:
            parts.append(rd.PointMass(float(x), density * length * between(0.01, 3.0)))
        else:
            parts.append(rd.Spring(float(x), tension / length * between(0.1, 100.0)))
    ends = tuple(random.choice(["clamped", "pinned"], 2))
    if random.random() < 0.2:
        free = rd.End(
            z="free",
            beta="free",
            spring={"z": tension / length * between(0.1, 10.0)},
            dashpot={"z": density * speed * between(0.01, 10.0)},
        )
        ends = (ends[0], free)
    scene = rd.Scene(rope, tension=tension, ends=ends, damping=damping, parts=parts)
    model = scene.compile(elements=elements, element="rigid")
    count = int(random.integers(300, 2001))
    span = between(2.0, 40.0) * 2 * np.pi / turn
    time = np.arange(count) * (span / (count - 1))
    coordinates = ("z", "beta", "alpha") if twists else ("z", "beta")
    own = str(random.choice(coordinates, p=[0.7, 0.2, 0.1][: len(coordinates)] if twists else None))
    other = "alpha" if own == "alpha" else str(random.choice(["z", "beta"]))
    drive, response = (own, float(random.choice(at))), (other, float(random.choice(at)))
    if random.random() < 0.3:
        response = (own, drive[1])
    return Case(
        model,
        time,
        drive,
        _force(random, time, turn),
        response,
        str(random.choice(QUANTITIES, p=[0.6, 0.25, 0.15])),
        load=1.0,
    )


def _force(random, time, turn):
    """Return a force of any kind, or None."""
    span, phase = time[-1], float(random.uniform(0, 6))
    kind = random.integers(7)
    if kind == 0:
        return None
    if kind == 1:
        return rd.Sine(1.0, turn / 2 / np.pi * random.uniform(0.1, 8.0), phase=phase)
    if kind == 2:
        return rd.Step(1.0, time=float(random.choice([0.0, random.uniform(0, 0.8) * span])))
    if kind == 3:
        length = float(random.uniform(0.02, 1.0)) * 2 * np.pi / turn
        return rd.Impulse(1.0, time=float(random.uniform(0, 0.5)) * span, duration=length)
    if kind == 4:
        return np.cumsum(random.normal(size=len(time))) / 30
    if kind == 5:
        knots = random.normal(size=12)
        return np.interp(np.linspace(0, 11, len(time)), np.arange(12), knots)
    return (rd.Sine(1.0, turn / 4, phase=phase), rd.Step(-1.0, time=0.3 * float(span)))


@dataclass
class Exact:
    """States (u, v) of the assembled chain."""

    case: Case
    A: np.ndarray = field(init=False)
    is_still: bool = False  # By symmetry: what is there is rounding

    def __post_init__(self):
        model = self.case.model
        M, C, K = (
            one().toarray()
            for one in (model.mass_matrix, model.damping_matrix, model.stiffness_matrix)
        )
        n = len(M)
        solved = np.linalg.solve(M, np.hstack([K, C, np.eye(n)]))
        self.A = np.zeros((2 * n, 2 * n))
        self.A[:n, n:] = np.eye(n)
        self.A[n:] = -solved[:, : 2 * n]
        self.b = np.append(np.zeros(n), solved[:, 2 * n :][:, self.row(self.case.drive)])
        self.rest = np.linalg.solve(K, np.eye(n)[self.row(self.case.drive)])

    def row(self, point):
        """Which unknown a point is."""
        model = self.case.model
        free = model.chain.held[model.chain.term_of] == 0
        number = np.cumsum(free.ravel()).reshape(free.shape) - 1
        node = np.abs(model.x - point[1]).argmin()
        return int(number[node, model.coordinates.index(point[0])])

    def value(self):
        """The response at all times."""
        case, n = self.case, len(self.rest)
        force = case.force
        if force is None:
            states = self._piecewise(
                [SinePiece(0.0)], np.append(case.load * self.rest, np.zeros(n))
            )
            acts = np.zeros(len(case.time))
        elif isinstance(force, np.ndarray):
            states, acts = self._sampled(force), force
        else:
            several = force if isinstance(force, tuple) else (force,)
            still = np.zeros(2 * n)
            states = sum(self._piecewise(pieces(one, 0.0), still) for one in several)
            acts = sum(one.value(case.time) for one in several)
        row = self.row(case.response)
        most = np.abs(states[:, :n]).max(axis=0)
        self.is_still = bool(most[row] < 1e-9 * most.max())
        if case.quantity == "acceleration":
            return states @ self.A[n + row] + self.b[n + row] * acts
        return states[:, row + n * (case.quantity == "velocity")]

    def _sampled(self, sample):
        N, time = len(self.A), self.case.time
        big = np.zeros((N + 2, N + 2))
        big[:N, :N], big[:N, N], big[N, N + 1] = self.A, self.b, 1.0
        h = time[1] - time[0]
        E = expm(big * h)
        x, states = np.zeros(N), np.zeros((len(time), N))
        for k, (f, more) in enumerate(zip(sample[:-1], np.diff(sample))):
            x = E[:N, :N] @ x + E[:N, N] * f + E[:N, N + 1] * (more / h)
            states[k + 1] = x
        return states

    def _piecewise(self, turns, x):
        """States under pieces of sines, from the state x at the first time."""
        N, time = len(self.A), self.case.time
        states, now = np.zeros((len(time), N)), 0.0
        if turns[0].start > now:
            turns = [SinePiece(now), *turns]
        for piece, following in zip(turns, [*turns[1:], None]):
            if piece.start > time[-1]:
                break
            w = piece.frequency
            big = np.zeros((N + 2, N + 2))
            big[:N, :N], big[:N, N], big[N, N + 1], big[N + 1, N] = self.A, self.b, w, -w
            x = np.concatenate([x[:N] + piece.kick * self.b, [piece.cosine, piece.sine]])
            stop = np.inf if following is None else following.start
            mine = np.flatnonzero((time >= piece.start) & (time < stop))
            y, E = x, None
            for i, k in enumerate(mine):
                if i == 0:
                    y = expm(big * (time[k] - piece.start)) @ x
                else:
                    E = expm(big * (time[1] - time[0])) if E is None else E
                    y = E @ y
                states[k] = y[:N]
            if np.isfinite(stop):
                x = expm(big * (stop - piece.start)) @ x
        return states
