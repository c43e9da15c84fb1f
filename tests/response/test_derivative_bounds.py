"""`FRF.derivative_error` bounds the true error and is no useless bound: of damped ropes, of chains,
of sums over modes, of tips of wires.

Undamped ones that carry parts however light are in tests/eigen/test_derivative_error.py.
"""

import dataclasses

import mpmath
import numpy as np
import pytest
from conftest import EPS, samples

import ropedyn as rd
from ropedyn.chain.compile import remeshed
from ropedyn.chain.wide import Number
from ropedyn.response.measured import _answers
from ropedyn.scene import damping
from ropedyn.scene.path import value_at, with_values

STEPS = ((0.08, 6), (0.05, 6), (0.04, 5))
"""Differences reach so far, by so many steps to each side: where they differ they are no reference.

Wide numbers have 1e-19 of a response, which costs 3e-16 of the derivative."""
DAMPINGS = {
    "damping.coefficient": lambda r: rd.ViscousDamping(10 ** r.uniform(-3, 0)),
    "damping.gamma": lambda r: rd.StiffnessDamping(10 ** r.uniform(-7, -4)),
    "damping.eta": lambda r: rd.LossFactor(10 ** r.uniform(-4, -2)),
}
PATHS = ["tension", "linear_density", "parts[0].mass", "parts[1].stiffness", "parts[2].mass"]
PATHS += ["parts[2].frequency", "parts[2].damping_ratio"]
AT_REST = "parts[0].x", "length"
"""Of chains, drives and responses would have to move with the nodes."""


def random_response(random):
    """A response of a damped rope that carries parts, of spans or elements, and a path."""
    bends = random.random() < 0.5
    kind = random.choice(["continuous", "tensed", "rigid"] if bends else ["continuous", "tensed"])
    name = str(random.choice(list(DAMPINGS)))
    T, B = 10 ** random.uniform(1, 3), 10 ** random.uniform(-1, 2) if bends else None
    parts = [
        rd.PointMass(0.25, 10 ** random.uniform(-3, 0)),
        rd.Spring(0.5, 10 ** random.uniform(0, 4)),
        rd.Resonator(
            0.625, 10 ** random.uniform(-3, -1), 10 ** random.uniform(0, 2), damping_ratio=0.01
        ),
    ]
    rope = rd.Rope(1.0, 0.1, bending_stiffness=B)
    scene = rd.Scene(rope, tension=T, parts=parts, damping=DAMPINGS[name](random))
    exact = kind == "continuous"
    elements = {} if exact else {"elements": int(random.choice([8, 16, 64])), "element": str(kind)}
    lines = np.sqrt(T / 0.1) / 2 * random.uniform(0.3, 6, 4)
    frf = scene.compile(**elements).frf(lines, drive=("z", 0.125), response=("z", 0.875))
    paths = [*PATHS, name, *(["bending_stiffness"] if bends else []), *(AT_REST if exact else ())]
    return frf, str(random.choice(paths))


def difference(frf, path, reach, steps):
    """The derivative at every line by differences in wide numbers, of steps to both sides."""
    question, model = frf.rates.answered[0].question, frf.rates.model
    here = value_at(model.scene, path)
    off = np.array([k for k in range(-steps, steps + 1) if k]) * reach / steps
    p = np.array([float(here * (1 + one)) for one in off])
    t, total = p.astype(Number) - Number(here), 0
    for k in range(len(p)):
        # that of the polynomial which is 1 at this step and 0 at all others
        beside = np.delete(t, k)
        weight = -sum(np.prod(-np.delete(beside, j)) for j in range(len(beside)))
        weight = -weight / np.prod(t[k] - beside)
        scene = with_values(model.scene, {path: p[k]})
        factor = np.ascontiguousarray(damping.factors(scene.dampings, question.omega).T)
        moved = dataclasses.replace(question, model=remeshed(model, scene), factor=factor)
        total = total + weight * _answers(moved)[0][0, 0]
    return total.astype(complex)


def bounds_over_errors(seed):
    """Of the lines of a response at which differences are a reference."""
    frf, path = random_response(np.random.default_rng(5_500 + seed))
    found = [difference(frf, path, *step) for step in STEPS]
    bound, value = frf.derivative_error(path)[0], frf.derivative(path)[0]
    unsure = np.max([np.abs(one - found[0]) for one in found[1:]], axis=0)
    told = unsure < bound / 5
    error = np.maximum(np.abs(value - found[0]), np.finfo(float).eps / 2 * np.abs(value))
    return (bound / error)[told]


@pytest.mark.parametrize("seeds", samples(2, 100))
def test_derivatives_of_damped_responses_are_right_to_their_bounds(seeds):
    ratio = np.concatenate([bounds_over_errors(seed) for seed in seeds])
    assert ratio.min() >= 1  # 1.6 of 100 scenes
    assert np.median(ratio) <= 10  # 9.6


def test_derivatives_of_undamped_responses_are_real():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=747.0, parts=[rd.PointMass(0.3, 1e-3)])
    frf = scene.compile().frf([43.0], drive=("z", 0.02), response=("z", 0.97))
    for path in ("tension", "parts[0].x"):
        assert frf.derivative(path).imag == 0  # as much as the error of the real part once


def test_chain_tells_that_its_equal_elements_lose_digits():
    """1 - (kl)^2 is rounded at all of 4096 equal elements alike, at (kl)^2 = 4e-6."""
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    error = [
        scene.compile(elements=n).frf([40.0], drive=("z", 0.5)).derivative_error("tension")
        for n in (64, 4096)
    ]
    assert error[1] > 100 * error[0]


# --- sums over modes, and tips of wires ----------------------------------------------------------

ELEMENTS, DRIVEN, TOLD = 12, 2, 9
SUMMED = ["tension", "linear_density", "damping.ratio", "parts[0].stiffness", "parts[1].mass"]


def summed(T, mu, ratio, k, m, f):
    """A sum over the modes of a string of masses with a spring and a mass on it."""
    n = ELEMENTS
    own = [mu / n + (m if i == 8 else 0) for i in range(1, n)]
    K = mpmath.zeros(n - 1)
    for i in range(n - 1):
        K[i, i] = 2 * T * n + (k if i == 2 else 0)
        if i:
            K[i, i - 1] = K[i - 1, i] = -T * n
    root = [mpmath.sqrt(one) for one in own]
    for i in range(n - 1):
        for j in range(n - 1):
            K[i, j] /= root[i] * root[j]
    value, shape = mpmath.eigsy(K)
    omega, d, r = 2 * mpmath.pi * f, DRIVEN - 1, TOLD - 1
    return mpmath.fsum(
        shape[d, i] * shape[r, i] / (root[d] * root[r])
        / (value[i] - omega**2 + 2j * ratio * omega * mpmath.sqrt(value[i]))
        for i in range(n - 1)
    )  # fmt: skip


def modal_case(random):
    """A chain whose modes are all summed up, a number of it, and what the derivative by that is."""
    numbers = [10 ** random.uniform(*ends) for ends in ((1, 3), (-2, 0), (-3, -1), (0, 4), (-3, 0))]
    T, mu, ratio, k, m = map(float, numbers)
    parts = [rd.Spring(3 / ELEMENTS, k), rd.PointMass(8 / ELEMENTS, m)]
    scene = rd.Scene(rd.Rope(1.0, mu), tension=T, parts=parts, damping=rd.ModalDamping(ratio))
    at = int(random.integers(len(SUMMED)))
    f = float(np.sqrt(T / mu) / 2 * random.uniform(0.3, 6))
    model = scene.compile(elements=ELEMENTS)
    drive, response = (("z", k / ELEMENTS) for k in (DRIVEN, TOLD))
    frf = model.frf([f], drive=drive, response=response)
    with mpmath.workdps(50):
        off, given = mpmath.mpf(10) ** -17, [mpmath.mpf(one) for one in (T, mu, ratio, k, m)]

        def value(step):
            moved = [one * (1 + step) if i == at else one for i, one in enumerate(given)]
            return summed(*moved, mpmath.mpf(f))

        return frf, SUMMED[at], 0, complex((value(off) - value(-off)) / (2 * off * given[at]))


WIRES = ["tension", "linear_density", "parts[0].length", "parts[0].diameter", "parts[0].density"]
WIRES += ["parts[0].youngs_modulus", "parts[0].damping_ratio"]


def at_tip(T, mu, length, d, density, E, ratio, f):
    """The tip of a wire at 0.3 of a string that is driven at 0.7."""
    k = 2 * mpmath.pi * f * mpmath.sqrt(mu / T)
    x, y = mpmath.mpf(0.3), mpmath.mpf(0.7)

    def string(a, b):
        return mpmath.sin(k * a) * mpmath.sin(k * (1 - b)) / (T * k * mpmath.sin(k))

    stiffness = E * (1 + 2j * ratio) * mpmath.pi * d**4 / 64
    turn = (2 * mpmath.pi * f) ** 2 * density * mpmath.pi * d**2 / 4 / stiffness
    turn = mpmath.root(turn, 4)
    z = turn * length
    c, s, C, S = mpmath.cos(z), mpmath.sin(z), mpmath.cosh(z), mpmath.sinh(z)
    carried = -stiffness * turn**3 * (c * S + s * C) / (1 + c * C)
    return string(x, y) / (1 + string(x, x) * carried) * (c + C) / (1 + c * C)


def tip_case(random):
    """The tip of a wire on a string, a number of both, and what the derivative by that is."""
    given = [10 ** random.uniform(*ends) for ends in ((1, 3), (-2, 0), (-2, 0), (-4, -3))]
    given = [*map(float, given), 7850.0, 2e11, float(10 ** random.uniform(-4, -1))]
    T, mu, length, d, density, E, ratio = given
    own = {"radius": 0.0, "density": density, "youngs_modulus": E, "damping_ratio": ratio}
    wire = rd.BrokenWire(0.3, length, d, **own)
    at = int(random.integers(len(WIRES)))
    f = float(random.choice([np.sqrt(T / mu) / 2, wire.frequency]) * random.uniform(0.3, 6))
    model = rd.Scene(rd.Rope(1.0, mu), tension=T, parts=[wire]).compile()
    frf = model.frf([f], drive=("z", 0.7), response=[("z", 0.3), ("wire", 0)])
    with mpmath.workdps(50):
        off, given = mpmath.mpf(10) ** -17, [mpmath.mpf(one) for one in given]

        def value(step):
            moved = [one * (1 + step) if i == at else one for i, one in enumerate(given)]
            return at_tip(*moved, mpmath.mpf(f))

        return frf, WIRES[at], 1, complex((value(off) - value(-off)) / (2 * off * given[at]))


@pytest.mark.parametrize("seeds", samples(20, 1000))
@pytest.mark.parametrize("case", [modal_case, tip_case])
def test_derivatives_of_sums_and_tips_are_right_to_their_bounds(case, seeds):
    ratio = []
    for seed in seeds:
        frf, path, k, expected = case(np.random.default_rng([5, seed]))
        wrong = abs(frf.derivative(path)[k, 0] - expected)
        ratio.append(frf.derivative_error(path)[k, 0] / max(wrong, EPS / 2 * abs(expected)))
    assert min(ratio) >= 1  # 1.9 of 200 tips, 3.7 of 200 sums
    assert np.median(ratio) <= 100  # 8.3 and 59
