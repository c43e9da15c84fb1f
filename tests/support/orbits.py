"""Random orbits of small chains with a law, and their monodromy by integration over time."""

import numpy as np
from scipy.integrate import solve_ivp

import ropedyn as rd
from ropedyn.motion.periodic.asked import SteppedSine
from ropedyn.motion.periodic.branches import traced
from ropedyn.motion.periodic.driven import Driven
from ropedyn.motion.periodic.stability import growing
from ropedyn.motion.periodic.state import settled

ACCURATE = {"rtol": 1e-9, "atol": 1e-12, "method": "DOP853"}
UNSURE = 1e-3
"""A multiplier so near 1 is not told by integration: such orbits are left out."""


def random_scene(rng, stops):
    """A string of two to four elements that hits stops or hardens."""
    elements = int(rng.integers(2, 5))
    at = 1.0 / elements * int(rng.integers(1, elements))
    damping = rd.RayleighDamping(float(10 ** rng.uniform(0.0, 1.3)), 0.0)
    if stops:
        stiffness, gap = float(10 ** rng.uniform(2.5, 4.0)), float(rng.uniform(0.5e-3, 4e-3))
        parts = [rd.Stop(at, stiffness, gap=gap)]
        if rng.uniform() < 0.5:
            parts.append(rd.Stop(at, stiffness, gap=float(rng.uniform(0.5e-3, 4e-3)), side=-1))
    else:
        cube = float(10 ** rng.uniform(5.0, 7.0))
        parts = [rd.NodeForce(at, lambda t, u, v: -cube * u**3)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=parts)
    return scene.compile(elements=elements, element="rigid")


def law_of(scene):
    """Force and slopes of what is not linear, of the displacement and velocity of its point."""

    def stopped(u, v):
        force = slope = 0.0
        for part in scene.parts:
            deep = part.side * u - part.gap
            if deep > 0:
                force -= part.side * part.stiffness * deep
                slope -= part.stiffness
        return force, slope, 0.0

    def hardening(u, v):
        law = scene.parts[0].law
        # a cubic of u, linear in v: five points are exact
        step = 1e-3
        far = law(0.0, u + 2 * step, v) - law(0.0, u - 2 * step, v)
        near = law(0.0, u + step, v) - law(0.0, u - step, v)
        by_v = (law(0.0, u, v + 1.0) - law(0.0, u, v - 1.0)) / 2
        return law(0.0, u, v), (8 * near - far) / (12 * step), by_v

    return stopped if isinstance(scene.parts[0], rd.Stop) else hardening


def random_states(rng, stops):
    """Steady states of all branches of one random scene."""
    model = random_scene(rng, stops)
    return states_of(model, float(10 ** rng.uniform(-0.5, 0.7)))


def states_of(model, amplitude, tolerance=1e-6):
    """Steady states of all branches of a string that is driven at its first node."""
    first = 15.8
    asked = SteppedSine.of(
        model,
        first * np.array([0.7, 1.1, 1.6]),
        drive=("z", float(model.x[1])),
        amplitude=amplitude,
        response=None,
        quantity="receptance",
        tolerance=tolerance,
        progress=None,
    )
    driven = Driven.of(asked)
    traces = traced(driven, driven.balance(16))
    return driven, [s for trace in traces for s in trace if s.kind == "step"]


def multipliers(driven, state):
    """How far the orbit is from closing after a period, relative, and its multipliers."""
    model, asked = driven.asked.model, driven.asked
    linear = model.scene.replace(parts=[]).compile(elements=len(model.x) - 1, element="rigid")
    M, C, K = (
        m().toarray() for m in (linear.mass_matrix, linear.damping_matrix, linear.stiffness_matrix)
    )
    n = len(M)
    at, push = np.eye(n)[[round(p[1] * (n + 1)) - 1 for p in (driven.points[0], asked.drive)]]
    law, omega = law_of(model.scene), state.place.p
    balance = state.balance
    F = np.outer(push, balance.driven()) + np.outer(at, balance.forces(state.place.x, omega)[0])
    s = 1j * omega * balance.order
    q = np.array([np.linalg.solve(M * a * a + C * a + K, F[:, k]) for k, a in enumerate(s)])
    weight = np.append(1.0, np.full(len(s) - 1, 2.0))[:, None]
    start = np.concatenate([(weight * q).real.sum(0), (weight * s[:, None] * q).real.sum(0)])
    inverse = np.linalg.inv(M)

    def rate(t, y):
        u, v, Y = y[:n], y[n : 2 * n], y[2 * n :].reshape(2 * n, 2 * n)
        force, slope, drag = law(at @ u, at @ v)
        a = inverse @ (asked.amplitude * np.cos(omega * t) * push + force * at - C @ v - K @ u)
        here = np.outer(at, at)
        turned = (C - drag * here) @ Y[n:] + (K - slope * here) @ Y[:n]
        Z = np.concatenate([Y[n:], -inverse @ turned])
        return np.concatenate([v, a, Z.ravel()])

    period = 2 * np.pi / omega
    begin = np.concatenate([start, np.eye(2 * n).ravel()])
    end = solve_ivp(rate, (0.0, period), begin, max_step=period / 100, **ACCURATE).y[:, -1]
    away = np.abs(end[: 2 * n] - start) / np.repeat(
        [np.abs(start[:n]).max(), np.abs(start[n:]).max()], n
    )
    return float(away.max()), np.linalg.eigvals(end[2 * n :].reshape(2 * n, 2 * n))


def compared(seed, stops, count, unstable):
    """Orbits as (growing by harmonic balance, by monodromy, how far from closing)."""
    rng, found = np.random.default_rng(seed), []
    while len(found) < count:
        try:
            driven, states = random_states(rng, stops)
        except rd.SolveError:
            continue
        grows = [growing(s.balance, s.place.x, s.place.p, 0) for s in states]
        left = unstable - sum(one[1] > 0 for one in found)
        wanted = [k for k, n in enumerate(grows) if n > 0][: 4 if left > 0 else 0]
        picked = set(rng.permutation(len(states))[:3].tolist()) | set(
            rng.permutation(wanted)[:3].tolist()
        )
        for k in sorted(picked):
            try:
                exact = settled(driven, [states[k]])
            except rd.SolveError:  # as where a stop is hardly touched
                continue
            if exact is None:
                continue
            (state,) = exact
            away, mu = multipliers(driven, state)
            if np.abs(np.abs(mu) - 1).min() < UNSURE:
                continue
            n = growing(state.balance, state.place.x, state.place.p, 0)
            found.append((n, int((np.abs(mu) > 1).sum()), away, state, mu))
    return found[:count]
