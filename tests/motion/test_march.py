"""Implicit time steps against the same scheme over dense matrices, energies and closed forms."""

import dataclasses
import math

import numpy as np
import pytest
from random_scene import WIDTHS, damped, log_uniform, taut_scene

import ropedyn as rd
from ropedyn import _core
from ropedyn.chain.chain import Chain

EPS = 2.0**-52
POWER, STOP, GIVEN = range(3)


def g_of(rho):
    """Of the scheme that multiplies the fastest motion by rho in each step."""
    return 0.25 if rho == 1 else (1 - math.sqrt((1 + rho) / 2)) / (1 - rho)


@dataclasses.dataclass
class March:
    """A chain through time; with prepared False only its description."""

    chain: object
    prepared: bool = True
    rho: float = 1.0
    h: float = 1e-3
    rate: float = 0.0
    spring_rate: float = 0.0
    string: float = 0.0
    string_drag: float = 0.0
    stretching: float = 0.0
    mass_rate: float = 0.0
    extra: float = 0.0
    refined: bool = True
    laws: tuple = ()
    """(node, coordinate index, kind, numbers)"""

    def __post_init__(self):
        chain = self.chain
        distinct, width = len(chain.length), len(chain.coordinate)
        n, a = chain.nodes, 0 if chain.attached_kind is None else len(chain.attached_kind)
        self.width = width
        self.beside = (
            np.full(distinct, self.rate),
            self.spring_rate,
            np.full(distinct, self.string),
            np.full(distinct, self.string_drag),
            self.stretching,
            self.mass_rate,
        )
        node, row = self.rows([law[:2] for law in self.laws])
        kind = np.array([law[2] for law in self.laws], dtype=np.int32)
        value = np.zeros((len(self.laws), 4))
        for k, law in enumerate(self.laws):
            value[k, : len(law[3])] = law[3]
        self.law = (node, row, kind, value)
        self.g = g_of(self.rho)
        self.theta = self.g * self.h
        self.state = (
            np.zeros((n, width)),
            np.zeros((n, width)),
            np.zeros((n - 1, width)),
            np.zeros(a),
            np.zeros(a),
        )
        if self.prepared:
            self.factor()

    def factor(self):
        self.plan = _core.march_factor(self.chain, self.beside, self.law, self.theta, self.extra)

    def rows(self, places):
        """Ports at nodes: (node, coordinate index)."""
        node = np.zeros(len(places), dtype=np.int32)
        row = np.zeros((len(places), 2, self.width))
        for k, (at, i) in enumerate(places):
            last = int(at == self.chain.nodes - 1)
            node[k], row[k, last, i] = at - last, 1.0
        return node, row

    def run(self, steps, drives=(), force=None, moved=(), speed=None, extra=None, read=()):
        force = np.zeros((steps, 2, len(drives))) if force is None else force
        speed = np.zeros((steps, 2, len(moved))) if speed is None else speed
        place = np.array(moved, dtype=np.int32).reshape(-1, 2)
        return _core.march(
            self.chain,
            self.beside,
            self.law,
            self.plan,
            self.g,
            self.h,
            self.state,
            (*self.rows(drives), None),
            force,
            place,
            speed,
            extra,
            (*self.rows(read), None),
            True,
            self.refined,
        )


def plain(chain):
    """The chain without the end correction that no march can have."""
    mass = chain.mass * np.eye(chain.mass.shape[1])
    return chain._replace(mass=mass)


def dense(march, M, K, C, force, y):
    """Steps of the scheme over matrices: (u, v) after each."""
    g, h, theta = march.g, march.h, march.theta
    A = M / theta**2 + C / theta + K
    scale = 1 / np.sqrt(np.abs(np.diag(A)))
    inverse = np.linalg.inv(A * np.outer(scale, scale)) * np.outer(scale, scale)

    def stage(u, v, p):
        d = inverse @ (p + M @ v / theta - K @ u)
        return d / theta, (d / theta - v) / theta

    u, v = y
    after = []
    for p in force:
        k1 = stage(u, v, p[0])
        k2 = stage(u + (1 - 2 * g) * h * k1[0], v + (1 - 2 * g) * h * k1[1], p[1])
        u = u + h / 2 * (k1[0] + k2[0])
        v = v + h / 2 * (k1[1] + k2[1])
        after.append((u, v))
    return after


def matrices(march):
    """M, K, C over all coordinates, held ones too, and which are free."""
    chain = march.chain
    size = chain.nodes * march.width
    bare = chain._replace(
        held=np.zeros_like(chain.held),
        attached_kind=None,
        attached_term=None,
        attached_row=None,
        attached_value=None,
    )
    elastic, elastic_beside, pull, pull_beside, springs, mass, dashpots = _core.assemble(bare)
    blocks = [(elastic + pull, elastic_beside + pull_beside), (springs, None), (mass, None)]
    K, S, M, C = (np.zeros((size, size)) for _ in range(4))
    w = march.width
    for matrix, (diagonal, beside) in zip((K, S, M), blocks):
        for i, block in enumerate(diagonal):
            matrix[i * w : i * w + w, i * w : i * w + w] += block
        for i, block in enumerate(() if beside is None else beside):
            matrix[i * w : i * w + w, i * w + w : i * w + 2 * w] += block
            matrix[i * w + w : i * w + 2 * w, i * w : i * w + w] += block.T
    for i, block in enumerate(dashpots):
        C[i * w : i * w + w, i * w : i * w + w] += block
    T = strings(march)
    C += march.rate * K + march.spring_rate * S + march.string_drag * T
    free = (chain.held[chain.term_of] == 0).ravel()
    return M, K + S + (march.string + march.extra) * T, C, free


def strings(march):
    """Stiffness of strings of tension 1 beside all elements."""
    chain, w = march.chain, march.width
    T = np.zeros((chain.nodes * w,) * 2)
    if 1 not in chain.coordinate:
        return T
    z = int(np.flatnonzero(chain.coordinate == 1)[0])
    for e, length in enumerate(chain.length[chain.element_of]):
        at = np.array([e * w + z, e * w + w + z])
        T[np.ix_(at, at)] += np.array([[1, -1], [-1, 1]]) / length
    return T


def scene_of(random, width):
    """A random scene with dashpots that is not pushed, springs not negative."""
    scene = damped(random, taut_scene(random, width, most=1e4))
    parts = [p for p in scene.parts if not (isinstance(p, rd.Spring) and p.stiffness < 0)]
    return scene.replace(parts=parts, damping=None)


def relative(value, expected, scale):
    """The largest difference over the largest value, each coordinate in its own scale."""
    return float(np.abs((value - expected) / scale).max() / np.abs(expected / scale).max())


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("rho", [1.0, 0.5, 0.0])
def test_steps_are_those_of_the_dense_scheme(width, rho):
    worst = 0.0
    for seed in range(6):
        random = np.random.default_rng([width, seed])
        scene = scene_of(random, width)
        kind = ["rigid", "tensed"][seed % 2]
        model = scene.compile(elements=int(random.integers(8, 13)), element=kind)
        chain = plain(model.chain.only(WIDTHS[width]))
        first = 2 * math.pi / math.sqrt(max(lowest(model), 1e-3))
        tension = {"string": log_uniform(random, 1e-1, 1e3), "string_drag": 0.1}
        march = March(
            chain,
            rho=rho,
            h=first / 30,
            rate=log_uniform(random, 1e-6, 1e-3),
            spring_rate=1e-3,
            **(tension if seed % 3 else {}),
        )
        M, K, C, free = matrices(march)
        K, C, M = (matrix[np.ix_(free, free)] for matrix in (K, C, M))
        steps = 8
        i = int(random.choice(np.flatnonzero(free)))
        force = np.zeros((steps, 2, len(free)))
        force[:, :, i] = random.standard_normal((steps, 2))
        march.run(steps, drives=[divmod(i, width)], force=force[:, :, i : i + 1])
        zero = np.zeros(int(free.sum()))
        u, v = dense(march, M, K, C, force[:, :, free], (zero, zero))[-1]
        A = M / march.theta**2 + C / march.theta + K
        scale = 1 / np.sqrt(np.diag(A))
        digits = EPS * np.linalg.cond(A * np.outer(scale, scale))
        for value, expected in zip(march.state[:2], (u, v)):
            error = relative(value.ravel()[free], expected, scale)
            worst = max(worst, error / (1e-12 + 30 * digits))
    assert worst <= 1.0  # the dense reference has no more digits than its condition leaves


def lowest(model):
    """Eigenvalue of the first mode with one of a rigid motion left out."""
    modes = [f for f in model.modes(3).frequency if f > 1e-3]
    return (2 * math.pi * modes[0]) ** 2 if modes else 1.0


def test_compression_is_refused_where_it_grows_by_more_than_a_step():
    """Exactly where the matrix of a stage is not positive definite."""
    refused = 0
    for seed in range(60):
        random = np.random.default_rng(seed)
        width = int(random.integers(2, 5))
        scene = scene_of(random, width).replace(tension=0.0)
        model = scene.compile(elements=int(random.integers(8, 16)), element="rigid")
        push = scene.rope.bending_stiffness * log_uniform(random, 1, 3000)
        march = March(
            plain(model.chain.only(WIDTHS[width])),
            prepared=False,
            h=log_uniform(random, 1e-5, 1e1),
            string=-push,
        )
        M, K, C, free = matrices(march)
        A = (M / march.theta**2 + C / march.theta + K)[np.ix_(free, free)]
        scale = 1 / np.sqrt(np.abs(np.diag(A)))
        least = np.linalg.eigvalsh(A * np.outer(scale, scale))[0]
        if least > 0:
            march.factor()
            continue
        refused += 1
        with pytest.raises(rd.SolveError, match="shorter steps"):
            march.factor()
    assert 10 < refused < 50


def bending(
    parts=(), ends=("clamped", "pinned"), tension=10.0, element="rigid", elements=8, **more
):
    """A chain of z and beta."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, rotary_inertia=1e-5)
    scene = rd.Scene(rope, tension=tension, ends=ends, parts=parts, **more)
    return plain(scene.compile(elements=elements, element=element).chain)


def pushed(march, steps=12, seed=0):
    """Steps under a random force at node 3, and those of the dense scheme: states after."""
    random = np.random.default_rng(seed)
    M, K, C, free = matrices(march)
    K, C, M = (matrix[np.ix_(free, free)] for matrix in (K, C, M))
    force = np.zeros((steps, 2, len(free)))
    i = 3 * march.width
    force[:, :, i] = random.standard_normal((steps, 2))
    march.run(steps, drives=[divmod(i, march.width)], force=force[:, :, i : i + 1])
    zero = np.zeros(int(free.sum()))
    after = dense(march, M, K, C, force[:, :, free], (zero, zero))[-1]
    A = M / march.theta**2 + C / march.theta + K
    scale = 1 / np.sqrt(np.diag(A))
    return [relative(a.ravel()[free], b, scale) for a, b in zip(march.state[:2], after)]


@pytest.mark.parametrize(
    "ends", [("free", "free"), ("clamped", "free"), ("free", "pinned"), ("pinned", "clamped")]
)
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_ends_and_supports_are_those_of_the_matrices(ends, element):
    chain = bending([rd.Support(0.5), rd.PointMass(0.25, 1.0)], ends, element=element)
    assert max(pushed(March(chain, h=5e-3, rho=0.7))) < 1e-11


def test_difference_chain_marches():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, rotary_inertia=1e-3)
    chain = plain(rd.Scene(rope).compile(elements=8, element="difference").chain)
    assert max(pushed(March(chain, h=5e-3))) < 1e-11


@pytest.mark.parametrize("bent", [{}, {"bending_stiffness": 1.0}])
def test_hanging_rope_marches_without_mass_along_it(bent):
    rope = rd.Rope(1.0, 0.1, axial_stiffness=1e4, **bent)
    model = rd.Scene(rope, tension=10.0, gravity=rd.Gravity()).compile(elements=12)
    march = March(plain(model.chain), h=5e-3)
    assert not march.chain.mass[:, 0].any()
    assert max(pushed(march)) < 1e-12


@pytest.mark.parametrize("stiffness", [0.0, 1e-3, 5.0, 1e5])
@pytest.mark.parametrize(
    ("element", "tension"), [("rigid", 0.0), ("rigid", 10.0), ("tensed", 10.0)]
)
def test_hinges_are_those_of_the_matrices(stiffness, element, tension):
    chain = bending([rd.Hinge(0.5, stiffness=stiffness)], element=element, tension=tension)
    march = March(chain, h=5e-3, rho=0.8, rate=1e-3, string=3.0, string_drag=0.02)
    bare = chain._replace(hinge=None)
    assert not np.array_equal(
        matrices(march)[1], matrices(dataclasses.replace(march, chain=bare))[1]
    )
    assert max(pushed(march)) < 1e-11


def test_resonator_is_one_more_mass():
    part = rd.Resonator(0.5, 0.05, 3.0, damping_ratio=0.1)
    march = March(bending([part]), h=5e-3, rho=0.6, mass_rate=2.0)
    M, K, C, free = matrices(march)
    mass, k, _, c = march.chain.attached_value[0]
    n, foot = len(free), 4 * march.width
    M, K, C = (np.pad(matrix, (0, 1)) for matrix in (M, K, C))
    M[n, n], C[n, n] = mass, march.mass_rate * mass
    both, pair = np.ix_([foot, n], [foot, n]), np.array([[1.0, -1.0], [-1.0, 1.0]])
    K[both] += k * pair
    C[both] += c * pair
    free = np.append(free, True)
    K, C, M = (matrix[np.ix_(free, free)] for matrix in (K, C, M))
    steps = 40
    force = np.zeros((steps, 2, n + 1))
    force[:10, :, foot] = 1.0
    march.run(steps, drives=[(4, 0)], force=force[:, :, foot : foot + 1])
    zero = np.zeros(int(free.sum()))
    u, v = dense(march, M, K, C, force[:, :, free], (zero, zero))[-1]
    scale = 1 / np.sqrt(np.diag(K))
    shown = [np.append(a.ravel(), b)[free] for a, b in zip(march.state[:2], march.state[3:])]
    assert relative(shown[0], u, scale) < 1e-11
    assert relative(shown[1], v, scale) < 1e-11


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_held_coordinates_move_as_they_are_told(element):
    chain = bending([rd.Support(0.5)], ("clamped", "pinned"), element=element)
    march = March(chain, h=5e-3, rho=0.9, rate=1e-3, string=2.0)
    M, K, C, free = matrices(march)
    moved = [(0, 0), (0, 1), (4, 0), (8, 0)]
    steps, n = 10, len(free)
    speed = np.random.default_rng(1).standard_normal((steps, 2, len(moved)))
    march.run(steps, moved=moved, speed=speed)
    u, v = np.zeros(n), np.zeros(n)
    held = [i * march.width + j for i, j in moved]
    A = M / march.theta**2 + C / march.theta + K
    ff, fh = np.ix_(free, free), np.ix_(free, held)

    def stage(u, v, s):
        d = np.zeros(n)
        d[held] = march.theta * s
        p = (M @ v / march.theta - K @ u)[free] - A[fh] @ d[held]
        d[free] = np.linalg.solve(A[ff], p)
        return d / march.theta, (d / march.theta - v) / march.theta

    on = (1 - 2 * march.g) * march.h
    for s in speed:
        k1 = stage(u, v, s[0])
        k2 = stage(u + on * k1[0], v + on * k1[1], s[1])
        u, v = u + march.h / 2 * (k1[0] + k2[0]), v + march.h / 2 * (k1[1] + k2[1])
    scale = 1 / np.sqrt(np.diag(A))
    assert relative(march.state[0].ravel(), u, scale) < 1e-11
    assert relative(march.state[1].ravel(), v, scale) < 1e-11
    assert np.allclose(
        march.state[0].ravel()[held], march.h / 2 * speed.sum(axis=(0, 1)), rtol=1e-13
    )


def balance(answer):
    """What a step has more or less of energy than it was given, over all there is."""
    _, energy, taken, done, _ = answer
    assert done == len(energy)
    total = energy[:, 0] + energy[:, 1]
    given = energy[:, 2] - energy[:, 3] - taken.sum(axis=1)
    size = np.abs(energy).sum(axis=1)[1:] + np.abs(taken[1:]).sum(axis=1)
    return np.abs(np.diff(total) - given[1:]).max() / size.max()


def everything():
    """A chain with all there is, at midpoint steps."""
    parts = [rd.Support(0.5), rd.Dashpot(0.3, 0.5), rd.Hinge(0.25, stiffness=0.5)]
    parts += [rd.Resonator(0.75, 0.05, 3.0, damping_ratio=0.1), rd.Spring(0.625, 100.0)]
    damping = {"rate": 1e-3, "spring_rate": 2e-3, "string": 3.0, "string_drag": 0.1}
    laws = ((3, 0, POWER, (0.3, 0.0)), (5, 0, POWER, (0.2, 2.0)), (6, 0, STOP, (50.0, 1e-4, 1.0)))
    chain = bending(parts, element="tensed")
    return March(chain, h=5e-3, mass_rate=1.0, stretching=1e4, laws=laws, **damping)


def test_all_energy_is_accounted_for():
    random = np.random.default_rng(2)
    march, steps = everything(), 200
    force, speed = random.standard_normal((steps, 2, 2)), random.standard_normal((steps, 2, 2))
    extra = 1.0 + 0.5 * random.standard_normal((steps, 2))
    answer = march.run(
        steps,
        drives=[(2, 0), (6, 1)],
        force=force,
        moved=[(4, 0), (0, 0)],
        speed=0.1 * speed,
        extra=extra,
    )
    assert balance(answer) < 1e-13
    assert (answer[2].sum(axis=0) > 0)[:2].all()
    assert (answer[1][:, 3] > 0).all()


@pytest.mark.parametrize(("elements", "steps"), [(8, 20000), (64, 20000), (1000, 1000)])
def test_energy_does_not_drift(elements, steps):
    """The rounding of a step is the same in every step: solved once it adds up to 1e-11."""
    march = March(bending(ends=("clamped", "clamped"), elements=elements, tension=100.0), h=1e-3)
    x = np.linspace(0, 1, elements + 1)[1:-1]
    march.state[1][1:-1, 0] = np.sin(np.pi * x) + 0.1 * x * (1 - x)
    energy = march.run(steps)[1]
    total = energy[:, 0] + energy[:, 1]
    assert np.ptp(total) < 1e-12 * total[0]


@pytest.mark.parametrize("elements", [64, 4096])
def test_turned_back_in_time_it_returns(elements):
    """Midpoint steps are reversible: what comes back has lost no digits."""
    march = March(bending(elements=elements), h=1e-2, stretching=0.0)
    x = np.linspace(0, 1, elements + 1)[1:-1]
    march.state[1][1:-1, 0] = np.sin(np.pi * x) ** 3
    start = march.state[1].copy()
    march.run(100)
    march.state[1][:] *= -1
    march.run(100)
    assert np.abs(march.state[1] + start)[:, 0].max() < 1e-11
    assert np.abs(march.state[0])[:, 0].max() < 1e-13


@pytest.mark.parametrize("elements", [8, 1000])
def test_mode_moves_as_one_mass(elements):
    """By the scalar scheme with its eigenvalue, whatever the number of elements."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, rotary_inertia=1e-5)
    model = rd.Scene(rope, tension=10.0).compile(elements=elements, element="rigid")
    modes = model.modes(2)
    march = March(plain(model.chain), h=0.1 / modes.frequency[1])
    shape = modes.shape[1] / np.abs(modes.shape[1][:, 0]).max()
    march.state[1][:] = shape
    steps = 25
    read = march.run(steps)[0]
    stiffness = np.array([[(2 * math.pi * modes.frequency[1]) ** 2]])
    one, none = np.ones((1, 1)), np.zeros((1, 1))
    after = dense(march, one, stiffness, none, np.zeros((steps, 2, 1)), (np.zeros(1), np.ones(1)))
    u, v = (float(y[0]) for y in after[-1])
    assert read.shape == (steps, 3, 0)
    # a shape to 1e-12 leaves so much of other modes
    for value, expected in zip(march.state[:2], (u, v)):
        assert np.abs(value - expected * shape)[:, 0].max() < 1e-11 * abs(expected)


def test_damping_of_the_scheme_is_all_that_is_lost():
    march = March(bending(), h=2e-2, rho=0.0)
    march.state[1][1:-1, 0] = 1.0
    energy = march.run(50)[1]
    total = energy[:, 0] + energy[:, 1]
    assert (np.diff(total) <= 1e-12 * total[0]).all()
    assert not energy[:, 2:].any()


def mass_on_spring(mass=1.0, spring=1.0, **more):
    """One coordinate x at the end of one element."""
    flexibility = np.zeros((1, 3, 3))
    flexibility[0, 0, 0] = 1 / spring
    integers = {"coordinate": [0], "first": [0, 1], "element": [0], "term": [0, 1]}
    chain = Chain(
        kind=1,
        length=np.ones(1),
        tension=np.zeros(1),
        flexibility=flexibility,
        mass=np.array([[[0.0]], [[mass]]]),
        stiffness=np.zeros((2, 1, 1)),
        held=np.array([[1], [0]], dtype=np.uint8),
        **{name: np.array(values, dtype=np.int32) for name, values in integers.items()},
    )
    return March(chain, **more)


def order(error, h):
    """Exponent of a step in an error."""
    return math.log(error[0] / error[1]) / math.log(h[0] / h[1])


@pytest.mark.parametrize("rho", [1.0, 0.6, 0.0])
def test_second_order(rho):
    def error(h):
        march = mass_on_spring(h=h, rho=rho)
        march.state[0][1], march.state[2][0] = 1.0, 1.0
        read = march.run(round(1 / h), read=[(1, 0)])[0][-1, :, 0]
        return np.abs(read - [math.cos(1), -math.sin(1), -math.cos(1)])

    for coarse, fine in zip(error(1 / 64), error(1 / 128)):
        assert order((coarse, fine), (2, 1)) == pytest.approx(2, abs=0.1)


def test_dry_friction_takes_four_times_its_stop_off_the_swing_each_period():
    force, turns = 0.05, 3
    march = mass_on_spring(h=2 * math.pi / 4096, rho=0.5, laws=((1, 0, POWER, (force, 0.0)),))
    march.state[0][1], march.state[2][0] = 1.0, 1.0
    answer = march.run(4096 * turns, read=[(1, 0)])
    # one period swings from x to x - 4 force/k; second order but for the steps where it turns
    assert answer[0][-1, 0, 0] == pytest.approx(1 - 4 * force * turns, abs=1e-4)
    assert answer[2].sum() == pytest.approx((1 - (1 - 4 * force * turns) ** 2) / 2, rel=1e-4)


def test_dry_friction_sticks():
    march = mass_on_spring(h=0.05, rho=0.5, laws=((1, 0, POWER, (0.3, 0.0)),))
    march.state[0][1], march.state[2][0] = 1.0, 1.0
    read = march.run(400, read=[(1, 0)])[0][:, :, 0]
    assert np.ptp(read[-100:, 0]) < 1e-14
    assert abs(read[-1, 0]) < 0.3  # the spring does not overcome it
    assert abs(read[-1, 1]) < 1e-15


def test_quadratic_damper_stops_hyperbolically():
    def error(h):
        march = mass_on_spring(spring=1e-30, h=h, laws=((1, 0, POWER, (2.0, 2.0)),))
        march.state[1][1] = 1.0
        return abs(march.run(round(1 / h), read=[(1, 0)])[0][-1, 1, 0] - 1 / 3)

    assert order((error(1 / 64), error(1 / 128)), (2, 1)) == pytest.approx(2, abs=0.1)
    assert error(1 / 128) < 1e-4


@pytest.mark.parametrize("power", [0.3, 0.5, 1.0, 1.5, 2.0, 3.0])
def test_power_law_holds_in_each_stage(power):
    """v + c |v|^p sign v/m = lean/m is met by the force found."""
    for lean in (1e-9, -0.3, 1e6):
        kind, value = np.array([POWER], dtype=np.int32), np.array([[0.7, power, 0.0, 0.0]])
        one, nothing = np.array([lean]), np.zeros(1)
        force, residual = _core.march_laws(
            (kind, value), 0.01, one, np.array([[2e-3]]), nothing, nothing
        )
        v = (lean + 2e-3 * force[0]) / 0.01
        assert residual == 0
        # |v|^p carries the rounding of lean - C f
        slack = 8 * EPS * (abs(lean) / 0.01) * power * abs(v) ** (power - 1) * 0.7
        assert force[0] == pytest.approx(
            -0.7 * abs(v) ** power * np.sign(v), rel=1e-12, abs=max(slack, 1e-300)
        )


def test_mass_leaves_a_stop_as_it_came():
    """Half a wave of sqrt(k/m) in contact, then the same speed back."""

    def speed(h):
        march = mass_on_spring(spring=1e-30, h=h, laws=((1, 0, STOP, (100.0, 0.25, 1.0)),))
        march.state[1][1] = 1.0
        read = march.run(round(1 / h), read=[(1, 0)])[0][:, :, 0]
        expected = 0.25 - (1 - 0.25 - math.pi / 10)
        return abs(read[-1, 1] + 1), abs(read[-1, 0] - expected)

    assert max(speed(1 / 2048)) < 2e-3
    assert max(speed(1 / 8192)) < 5e-4


@pytest.mark.parametrize("seed", range(20))
def test_laws_together_are_each_met(seed):
    random = np.random.default_rng(seed)
    m = int(random.integers(2, 8))
    root = random.standard_normal((m, m)) * np.exp(random.uniform(-3, 3, (m, 1)))
    C, lean = root @ root.T, random.standard_normal(m) * np.exp(random.uniform(-3, 3, m))
    kind = random.integers(0, 3, m).astype(np.int32)
    power = random.choice([0.0, 0.5, 1.0, 2.0], m)
    value = np.stack([np.exp(random.uniform(-3, 3, m)), power, np.ones(m), np.zeros(m)], axis=1)
    value[kind == STOP, 1], value[kind == STOP, 3] = 0.1, 0.5
    start, given, theta = 0.1 * random.standard_normal(m), random.standard_normal(m), 0.1
    force, residual = _core.march_laws((kind, value), theta, lean, C, start, given)
    x = lean + C @ force
    slack = 1e-9 * (np.abs(lean) + np.abs(C) @ np.abs(force))
    assert residual < 1e-12
    for k in range(m):
        c, p = value[k, :2]
        if kind[k] == GIVEN:
            assert force[k] == given[k]
        elif kind[k] == STOP:
            depth = start[k] + x[k] - 0.1
            push = max(0.0, c * depth + 0.5 * x[k] / theta) if depth > 0 else 0.0
            edge = abs(depth) <= slack[k] and force[k] <= 0
            assert edge or -force[k] == pytest.approx(push, abs=(c + 0.5 / theta) * slack[k])
        elif p == 0:
            slides = abs(x[k]) > slack[k]
            assert abs(force[k]) <= c * (1 + 1e-12)
            assert not slides or force[k] == pytest.approx(-c * np.sign(x[k]))
        else:
            slope = p * c * (abs(x[k]) / theta) ** (p - 1) / theta
            expected = -c * (abs(x[k]) / theta) ** p * np.sign(x[k])
            assert force[k] == pytest.approx(expected, rel=1e-9, abs=slope * slack[k])


def test_hook_takes_the_same_steps():
    laws = [(3, 0, POWER, (0.3, 0.0)), (5, 0, POWER, (0.2, 2.0))]
    march, hooked = (March(bending(), h=5e-3, rho=0.8, laws=laws) for _ in range(2))
    steps, drives = 30, [(4, 0)]
    force = np.random.default_rng(3).standard_normal((steps, 2, 1)) * 10
    march.run(steps, drives=drives, force=force)
    common = (hooked.chain, hooked.beside, hooked.law, hooked.plan, hooked.g, hooked.h)
    place, nothing = np.zeros((0, 2), dtype=np.int32), np.zeros(0)
    for p in force:
        for stage in range(2):
            x, C, q = _core.march_stage(
                *common, hooked.state, stage, (*hooked.rows(drives), None), p[stage], place, nothing
            )
            found = _core.march_laws(hooked.law[2:], hooked.theta, x, C, q, np.zeros(2))[0]
            _core.march_finish(*common, hooked.state, stage, found)
    for one, other in zip(march.state, hooked.state):
        assert np.allclose(one, other, rtol=1e-12, atol=1e-14 * np.abs(one).max(initial=0.0))


def test_stretching_keeps_energy_and_is_of_second_order():
    def motion(h):
        march = March(bending(ends=("pinned", "pinned")), h=h, stretching=1e5)
        x = np.linspace(0, 1, 9)
        march.state[1][1:-1, 0] = 3.0 * np.sin(np.pi * x[1:-1])
        answer = march.run(round(0.1 / h), read=[(4, 0)])
        energy = answer[1]
        total = energy[:, 0] + energy[:, 1]
        assert np.ptp(total) <= 1e-11 * total[0]
        return answer[0][-1, 0, 0]

    coarse, fine, finest = (motion(h) for h in (1e-3 / 4, 1e-3 / 8, 1e-3 / 16))
    assert order((coarse - fine, fine - finest), (2, 1)) == pytest.approx(2, abs=0.15)


def test_tension_in_time_is_that_of_the_matrices():
    march = March(bending(), h=5e-3, rho=0.9)
    M, K, _, free = matrices(march)
    T = strings(march)
    K, T, M = (matrix[np.ix_(free, free)] for matrix in (K, T, M))
    steps, a = 20, march.theta
    extra = 5 * np.sin(np.arange(2 * steps)).reshape(steps, 2)
    v = np.zeros(len(free))
    v[2:-2:2] = 1.0
    march.state[1][:] = v.reshape(-1, 2)
    march.run(steps, extra=extra)

    def stage(u, v, e):
        stiff = K + e * T
        d = np.linalg.solve(M / a**2 + stiff, M @ v / a - stiff @ u)
        return d / a, (d / a - v) / a

    u, v = np.zeros(int(free.sum())), v[free]
    on = (1 - 2 * march.g) * march.h
    for e in extra:
        k1 = stage(u, v, e[0])
        k2 = stage(u + on * k1[0], v + on * k1[1], e[1])
        u, v = u + march.h / 2 * (k1[0] + k2[0]), v + march.h / 2 * (k1[1] + k2[1])
    scale = 1 / np.sqrt(np.diag(K))
    assert relative(march.state[0].ravel()[free], u, scale) < 1e-11
    assert relative(march.state[1].ravel()[free], v, scale) < 1e-11


def test_internal_force_at_rest_is_the_load():
    """A cantilever pushed at its tip, with a string beside it, after fast motion has died out."""
    chain = bending(ends=("clamped", "free"), tension=0.0)
    march = March(chain, h=1e3, rho=0.0, rate=1e-3, string=3.0, string_drag=0.1)
    steps, inside = 8, np.array([[1.0, 0.0]])
    answer = _core.march(
        *(march.chain, march.beside, march.law, march.plan, march.g, march.h, march.state),
        (*march.rows([(8, 0)]), None),
        np.full((steps, 2, 1), 2.0),
        np.zeros((0, 2), dtype=np.int32),
        np.zeros((steps, 2, 0)),
        None,
        (np.array([3], dtype=np.int32), np.zeros((1, 2, 2)), inside),
        False,
        False,
    )
    assert answer[0][-1, 0, 0] == pytest.approx(2.0, rel=1e-11)
    F, G, _ = _core.triples(chain)
    u, _, f, *_ = march.state
    element = chain.element_of[3]
    open_ = u[4] - F[element] @ u[3] - G[element] @ f[3]
    assert np.abs(open_).max() < 1e-12 * np.abs(u).max()
