"""The exact discrete system of a model, eliminated in 60 digits: the reference of the sweep."""

import dataclasses
import itertools

import mpmath
import numpy as np
from exact_scene import (
    CHANNEL,
    drag,
    dragged,
    factors,
    inertia_of,
    is_stretch,
    places,
    rope_at,
    sag,
    section_of,
    standing,
)
from mpmath import mpf
from stored import stored

import ropedyn as rd

DIGITS = 60


def identity(w):
    return [[mpf(i == j) for j in range(w)] for i in range(w)]


def times(A, B):
    columns = list(zip(*B))
    return [[sum(map(_product, row, column)) for column in columns] for row in A]


def _product(a, b):
    return a * b


def plus(A, B, factor=1):
    return [[a + factor * b for a, b in zip(p, q)] for p, q in zip(A, B)]


def turned(A):
    return [list(row) for row in zip(*A)]


def inverse(A):
    if len(A) == 1:
        return [[1 / A[0][0]]]
    if len(A) == 2:
        (a, b), (c, d) = A
        over = 1 / (a * d - b * c)
        return [[d * over, -b * over], [-c * over, a * over]]
    rows = [[*row, *unit] for row, unit in zip(A, identity(len(A)))]
    for k in range(len(A)):
        best = max(range(k, len(A)), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        over = 1 / rows[k][k]
        rows[k] = [over * x for x in rows[k]]
        for i in range(len(A)):
            if i != k and rows[i][k] != 0:
                share = rows[i][k]
                rows[i] = [x - share * y for x, y in zip(rows[i], rows[k])]
    return [row[len(A) :] for row in rows]


def transfer(coordinates, length, curvature=0):
    """How a rigid body's end moves with the other; of one that hangs, x by the area under z too."""
    F = identity(len(coordinates))
    if "beta" in coordinates:
        F[coordinates.index("z")][coordinates.index("beta")] = length
    if curvature:
        x = F[coordinates.index("x")]
        x[coordinates.index("z")] = curvature * length
        if "beta" in coordinates:
            x[coordinates.index("beta")] = curvature * length**2 / 2
    return F


def cantilever(coordinates, S, length, curvature=0):
    """G = integral P^T S P ds of the tip.

    The end force of a coordinate causes c s^p in a channel of the section at the distance s from
    the tip; of rope that hangs that along x is a load along it, and moment c s^2/2, as well.
    """
    terms = {k: [(CHANNEL[k], int(k == "z"), mpf(1))] for k in coordinates}
    if curvature:
        terms["x"].append((CHANNEL["beta"], 2, curvature / 2))

    def entry(a, b):
        products = itertools.product(terms[a], terms[b])
        return sum(
            f * g * S[c][d] * length ** (1 + p + q) / (1 + p + q)
            for (c, p, f), (d, q, g) in products
        )

    return [[entry(a, b) for b in coordinates] for a in coordinates]


def tensed(coordinates, S, length, tension, curvature=0):
    """(F, G, Q) of the static tensed cantilever: closed in bending, else from the exponential."""
    w = len(coordinates)
    if coordinates == ("z", "beta") and tension != 0:
        bb = S[2][2]
        kappa = mpmath.sqrt(tension * bb)
        t = kappa * length
        tau, sech = mpmath.tanh(t) / kappa, mpmath.sech(t)
        if mpmath.im(kappa**2) == 0:
            # tan and cos under compression
            tau, sech = mpmath.re(tau), mpmath.re(sech)
        F = [[mpf(1), tau], [mpf(0), sech]]
        cross = (1 - sech) / tension
        G = [[(length - tau) / tension, cross], [cross, bb * tau]]
        return F, G, [[mpf(0), mpf(0)], [mpf(0), tension * tau]]
    if tension == 0:
        zero = [[mpf(0)] * w for _ in range(w)]
        return transfer(coordinates, length), cantilever(coordinates, S, length), zero
    # from pieces shorter than 1/kappa: the exponential of a long one is all growth
    radians = max(mpf(1), abs(tension * S[2][2]) * length**2)
    halvings = int(mpmath.ceil(mpmath.log(radians, 4)))
    piece = exponential(coordinates, S, length / 2**halvings, tension, curvature)
    for _ in range(halvings):
        piece = joined(piece, piece)
    return piece


def exponential(coordinates, S, length, tension, curvature=0):
    """(F, G, Q) from exp(l E), E of the state (u, f) with the static section and tension."""
    w = len(coordinates)
    E = mpmath.zeros(2 * w)
    for i, a in enumerate(coordinates):
        for j, b in enumerate(coordinates):
            if "z" not in (a, b):
                E[i, w + j] = S[CHANNEL[a]][CHANNEL[b]]
    z = coordinates.index("z")
    if "beta" in coordinates:
        beta = coordinates.index("beta")
        E[z, beta], E[w + beta, w + z], E[w + beta, beta] = 1, -1, tension
    else:
        E[z, w + z] = 1 / tension
    if curvature:
        x = coordinates.index("x")
        E[x, z], E[w + z, w + x] = curvature, -curvature
    e = mpmath.expm(E * length)
    e12, e21, e22 = (
        [[e[i + r, j + c] for j in range(w)] for i in range(w)] for r, c in ((0, w), (w, 0), (w, w))
    )
    back = inverse(e22)
    return turned(back), times(e12, back), times(back, e21)


def joined(one, two):
    """M = (I + G1 Q2)^-1: F2 M F1, G2 + F2 M G1 F2^T, Q1 + F1^T Q2 M F1."""
    (F1, G1, Q1), (F2, G2, Q2) = one, two
    M = inverse(plus(identity(len(F1)), times(G1, Q2)))
    F = times(F2, times(M, F1))
    G = plus(G2, times(F2, times(times(M, G1), turned(F2))))
    return F, G, plus(Q1, times(turned(F1), times(Q2, times(M, F1))))


@dataclasses.dataclass
class Exact:
    """The discrete system of a model, from the numbers of its scene alone."""

    model: rd.Model
    coordinates: tuple[str, ...]
    nudge: tuple[mpf, ...] = (mpf(1),) * 5
    """Times section, tension, springs, inertia, dashpots: what the condition of an answer asks."""

    def __post_init__(self):
        scene, model = self.model.scene, self.model
        self.count = len(model.x) - 1
        stations = sorted({mpf(0), mpf(scene.rope.length), *map(mpf, places(scene))})
        node = [int(np.abs(model.x - float(s)).argmin()) for s in stations]
        self.lengths, self.ropes = [], []
        for a, b, i, j in zip(stations, stations[1:], node, node[1:]):
            self.lengths += [(b - a) / (j - i)] * (j - i)
            self.ropes += [rope_at(scene, (a + b) / 2)] * (j - i)
        self.part_at = [
            (node[stations.index(mpf(p.x))], p) for p in scene.parts if not is_stretch(p)
        ]

    @property
    def scene(self):
        """What was compiled."""
        return self.model.scene

    def factors(self, omega):
        """On sections, tension, springs, inertia, dashpots."""
        return [p * q for p, q in zip(factors(self.model.scene, omega), self.nudge)]

    def triple(self, e, omega):
        scene, length = self.model.scene, self.lengths[e]
        c, (g, of_tension, *_) = self.coordinates, self.factors(omega)
        S = [[s / g for s in row] for row in section_of(scene, self.ropes[e])]
        T = mpf(scene.tension) * of_tension if "z" in c else mpf(0)
        curvature = sag(scene, self.ropes[e])[0]
        if c == ("z",):
            return [[mpf(1)]], [[length / T]], [[mpf(0)]]
        if self.model.element == "tensed" or (curvature and "beta" not in c):
            return tensed(c, S, length, T, curvature)
        if self.model.element == "difference":
            zero = [[mpf(0)] * len(c) for _ in c]
            return identity(len(c)), cantilever(c, S, length), zero
        F, G = transfer(c, length, curvature), cantilever(c, S, length, curvature)
        if T == 0:
            return F, G, [[mpf(0)] * len(c) for _ in c]
        # the string in parallel
        string = [[T / length * (a == b == "z") for b in c] for a in c]
        X = inverse(plus(identity(len(c)), times(G, string)))
        F2 = times(X, plus(F, times(G, string)))
        turned_less = plus(identity(len(c)), turned(F), -1)
        Q = times(times(turned_less, string), plus(F2, identity(len(c)), -1))
        return F2, times(X, G), [[-q for q in row] for row in Q]

    def term(self, node, omega):
        """Node term -omega^2 M + springs and the held coordinates."""
        scene, c = self.model.scene, self.coordinates
        _, _, spring, of_inertia, dashpot = self.factors(omega)
        # (length, inertia per length) of the elements on both sides
        left, right = (
            (self.lengths[e], inertia_of(scene, self.ropes[e]))
            if 0 <= e < self.count
            else (mpf(0), dict.fromkeys(c, mpf(0)))
            for e in (node - 1, node)
        )
        against = drag(scene)
        end = scene.ends[node > 0] if node in (0, self.count) else None
        here = standing(c, [part for at, part in self.part_at if at == node], end)
        N = [[mpf(0)] * len(c) for _ in c]
        for k, name in enumerate(c):
            here.mass[name] += sum(length * own[name] for length, own in (left, right)) / 2
            here.damping[name] += against[name] * (left[0] + right[0]) / 2
            N[k][k] = here.resistance(name, spring, of_inertia, dashpot)
        if self.model.element == "tensed" and "beta" in c:
            z, beta = c.index("z"), c.index("beta")
            N[z][beta] = N[beta][z] = (
                -of_inertia * (left[0] ** 2 * left[1]["z"] - right[0] ** 2 * right[1]["z"]) / 12
            )
        return N, [name in here.held for name in c]

    def assembled(self, omega):
        """Diagonal blocks, held coordinates as ones, and the blocks above the diagonal."""
        w, memory = len(self.coordinates), {}
        diagonal, beside, masks = [], [], []
        for node in range(self.count + 1):
            N, held = self.term(node, omega)
            diagonal.append(N)
            masks.append(held)
        for e, length in enumerate(self.lengths):
            same = length, id(self.ropes[e])
            if same not in memory:
                F, G, Q = self.triple(e, omega)
                Gi = inverse(G)
                FtGi = times(turned(F), Gi)
                memory[same] = plus(Q, times(FtGi, F)), [[-x for x in r] for r in FtGi], Gi
            here, between, there = memory[same]
            diagonal[e] = plus(diagonal[e], here)
            diagonal[e + 1] = plus(diagonal[e + 1], there)
            beside.append([list(row) for row in between])
        for node, held in enumerate(masks):
            for k in range(w):
                if held[k]:
                    for m in range(w):
                        diagonal[node][k][m] = diagonal[node][m][k] = mpf(k == m)
                        if node < self.count:
                            beside[node][k][m] = mpf(0)
                        if node > 0:
                            beside[node - 1][m][k] = mpf(0)
        return diagonal, beside, masks

    @stored
    def receptance(self, omega, drive, responses):
        """Displacements at (coordinate, node) per unit force at (coordinate, node)."""
        D, beside, masks = self.assembled(omega)
        coordinate, at = drive
        left, right = [], []
        P = D[0]
        for i in range(at):
            left.append(times(inverse(P), beside[i]))
            P = plus(D[i + 1], times(turned(beside[i]), left[i]), -1)
        P2 = D[-1]
        for i in range(self.count - 1, at - 1, -1):
            back = times(inverse(P2), turned(beside[i]))
            right.append(back)
            P2 = plus(D[i], times(beside[i], back), -1)
        whole = plus(plus(P, P2), D[at], -1)
        k = self.coordinates.index(coordinate)
        if masks[at][k]:
            return [mpf(0)] * len(responses)
        u = {at: [[row[k]] for row in inverse(whole)]}
        for i in range(at - 1, -1, -1):
            u[i] = [[-x[0]] for x in times(left[i], u[i + 1])]
        for i, back in zip(range(at + 1, self.count + 1), reversed(right)):
            u[i] = [[-x[0]] for x in times(back, u[i - 1])]
        return [u[node][self.coordinates.index(c)][0] for c, node in responses]


def omega_of(f):
    """The angular frequency the library works with: f is the user's number, pi has 60 digits."""
    return 2 * mpmath.pi * mpf(f)


@stored
def response(exact, f, drive, at):
    """The response at (coordinate, node) per unit force at (coordinate, node); f in Hz.

    At 0 Hz a part of the chain may be a mechanism though the whole is none, and has no inverse:
    there it is the response at 1e-60 rad/s, which differs from the one at rest by 1e-100.
    """
    try:
        return exact.receptance(omega_of(f), drive, [at])[0]
    except ZeroDivisionError:
        if f != 0:
            raise
        with mpmath.workdps(300):
            return exact.receptance(mpf(10) ** -60, drive, [at])[0]


def relative(value, exact):
    """|value - exact|/|exact|, 0 where both are 0."""
    if exact == 0:
        return 0.0 if value == 0 else float("inf")
    return float(abs(mpmath.mpmathify(complex(value)) / exact - 1))


@stored
def condition(exact, omega, drive, response):
    """1 + the sum of |d ln h/d ln p| over p: section, tension, springs, inertia, dashpots.

    What a relative change of 1 in each of the parts of the dynamic stiffness does to the
    answer h, to first order, by differences of 1e-20. What does not move at all has none: 1.
    """
    step = mpf(10) ** -20
    (h,) = exact.receptance(omega, drive, [response])
    if h == 0:
        return 1.0
    total = mpf(1)
    for part in range(4 + dragged(exact.scene)):
        nudge = tuple(1 + step * (k == part) for k in range(5))
        (near,) = dataclasses.replace(exact, nudge=nudge).receptance(omega, drive, [response])
        total += abs(near / h - 1) / step
    return float(total)


def error_over_condition(model, f, drive, response=None, *, digits=DIGITS):
    """Error of a response of the sweep over the condition of the answer.

    Parameters
    ----------
    model : Model
    f : float
        [Hz].
    drive, response : (coordinate, node)
        The response is the driven coordinate unless one is given.
    digits : int
        Of the reference.

    Returns
    -------
    float
        Relative error of the value over its `condition`.
    float
        Relative error over `rounding_error`.
    """
    response = response or drive
    x = model.x.tolist()
    frf = model.frf(
        f,
        drive=(drive[0], x[drive[1]]),
        response=(response[0], x[response[1]]),
        threads=1,
        solver="sweep",
    )
    with mpmath.workdps(digits):
        exact = Exact(model, model.component_of(drive[0]))
        (h,) = exact.receptance(omega_of(f), drive, [response])
        error = relative(frf.value[0, 0], h)
        covered = error / frf.rounding_error[0, 0] if error else 0.0
        return error / condition(exact, omega_of(f), drive, response), covered
