"""Elements and nodes of a chain in any precision, by the numbers that its arrays are of."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .chain import ATTACHED, CHANNELS, KINDS, TRANSVERSE, Chain

Array = NDArray[Any]

SECTION, TENSION, SPRING, INERTIA, DASHPOT = range(5)  # The rows of factors.
DIFFERENCE, RIGID = KINDS.index("difference"), KINDS.index("rigid")
WIRE = ATTACHED.index("broken wire")
AMPLIFIED = 4.0  # Joints that move more than so many times what their ends do are not joined.
REACH = 0.5  # Series begin at pieces across which nothing changes by more.
GROWS = 0.125  # Nor does the tension of a string: its series go on as powers of that.
CUT = 12  # An element is cut in half as often as this at most, whatever moves within.
FADED = 0.5  # What of a motion arrives at the other end; of less, I + D has not all digits.
TERMS = 24  # REACH^24/24! is nothing at 64 digits of 2, and at 113 with 10 more terms.


class Triple(NamedTuple):
    """An element or several: u_b = F u_a + G f_b, f_a = F^T f_b - Q u_a, F = I + D.

    D has the digits of what is short, F those of what fades on the way.
    """

    D: Array  # (lines or 1, width, width)
    G: Array
    Q: Array
    F: Array


class Rows(NamedTuple):
    """Equations between two stations, each (lines or 1, width, width).

    ahead u_b + behind u_a = soft f_b and f_a = turn f_b + stiff u_a.
    """

    ahead: Array
    behind: Array
    soft: Array
    turn: Array
    stiff: Array


class Strut(NamedTuple):
    """An element beside a string that pushes, which may have no triple.

    With g on the right end of the element: u_b = F u_a + G g, f_b = g + K (u_b - u_a) and f_a =
    F^T g + K (u_b - u_a).
    """

    F: Array
    G: Array
    K: Array


class CarriedFoot(NamedTuple):
    """Structures of a node: force -w v y for each, with e y = v^T u."""

    lever: Array  # (lines, structures, width)
    weight: Array  # (lines, structures)
    gap: Array  # (lines, structures)


# matrices of many lines ---------------------------------------------------------------------------


def turned(A: Array) -> Array:
    """Return the transposes."""
    return np.swapaxes(A, -1, -2)


def identity(A: Array) -> Array:
    """Return a unit matrix of that kind of number."""
    return np.eye(A.shape[-1], dtype=A.dtype)


def sizes(A: Array) -> Array:
    """Return |re| + |im|."""
    return np.abs(A.real) + np.abs(A.imag) if np.iscomplexobj(A) else np.abs(A)


def inverse(A: Array) -> Array:
    """Return the inverses of (lines, width, width)."""
    width = A.shape[-1]
    if width == 1:
        with np.errstate(divide="ignore", invalid="ignore"):
            return 1 / A
    whole = np.concatenate([A, np.broadcast_to(identity(A), A.shape)], axis=2)
    _core.eliminate(whole, width)
    found = np.ascontiguousarray(whole[..., width:])
    _core.substitute(whole, found)
    return found


# elements -----------------------------------------------------------------------------------------


class Frame(NamedTuple):
    """In which frame numbers are: u = z u^, f = f^/z."""

    chain: Chain
    names: list[str]
    factor: Array  # (5, lines or 1), real where nothing is damped
    z: Array  # (width,)

    def at(self, name: str) -> int:
        """Return which coordinate that is, -1 where it is absent."""
        return self.names.index(name) if name in self.names else -1

    @property
    def bent(self) -> tuple[tuple[int, int], ...]:
        """The pairs (across, turn) of planes that bend."""
        pairs = [(self.at(a), self.at(b)) for a, b in TRANSVERSE]
        return tuple(pair for pair in pairs if min(pair) >= 0)


def join(one: Triple, two: Triple, between: Array | None) -> tuple[Triple, Array]:
    """Join two with a stiffness between; return how much the joint moves as well."""
    # M = (I + G1 K)^-1, K = Q2 + N: F2 M F1, G2 + F2 M G1 F2^T, Q1 + F1^T K M F1
    K = two.Q if between is None else two.Q + between
    M = inverse(identity(one.D) + one.G @ K)
    X = -(M @ one.G) @ K
    Y = two.D + X + two.D @ X
    D = Y + one.D + Y @ one.D
    G = two.G + two.F @ (M @ one.G) @ turned(two.F)
    Q = one.Q + turned(one.F) @ (K @ M) @ one.F
    F = identity(D) + D
    fades = sizes(np.diagonal(F, axis1=1, axis2=2)) < FADED
    F = np.where(fades[:, :, None] | fades[:, None], two.F @ M @ one.F, F)
    return Triple(D, G, Q, F), M


def is_calm(M: Array) -> bool:
    """Whether nothing is near a resonance."""
    return bool((sizes(M) <= AMPLIFIED).all())


def section_of(f: Frame, e: int) -> Array:
    """Return the flexibility over coordinates, scaled, 0 across, (lines, width, width)."""
    channel = [CHANNELS[name] for name in f.names]
    S = f.chain.flexibility[e][channel][:, channel]
    S = S / (f.z[:, None] * f.z) / f.factor[SECTION][:, None, None]
    for a, b in TRANSVERSE:
        i = f.at(a)
        if i < 0:
            continue
        S[:, i] = S[:, :, i] = 0
        if f.at(b) < 0:
            S[:, i, i] = 1 / (f.chain.tension[e] * f.factor[TENSION] * f.z[i] ** 2)
    return S


def rate_matrix(f: Frame, e: int) -> Array:
    """Return E of d/ds (u, f) = E (u, f), (lines, 2 width, 2 width)."""
    chain, w = f.chain, len(f.names)
    S = section_of(f, e)
    q = np.zeros((f.factor.shape[1], w), dtype=f.factor.dtype)
    if chain.inertia is not None:
        q = q + f.factor[INERTIA][:, None] * chain.inertia[e]
    if chain.drag is not None:
        q = q + f.factor[DASHPOT][:, None] * chain.drag[e]
    Phi = np.zeros((w, w), dtype=S.real.dtype)
    for z, beta in f.bent:
        Phi[z, beta] = f.z[beta] / f.z[z]
        q[:, beta] += f.chain.tension[e] * f.factor[TENSION]
    if chain.sag is not None and min(f.at("x"), f.at("z")) >= 0:
        Phi[f.at("x"), f.at("z")] = chain.sag[e] * f.z[f.at("z")] / f.z[f.at("x")]
    lines = max(len(S), len(q))
    E = np.zeros((lines, 2 * w, 2 * w), dtype=np.result_type(S, q))
    E[:, :w, :w], E[:, w:, w:], E[:, :w, w:] = Phi, -Phi.T, S
    E[:, range(w, 2 * w), range(w)] = q * f.z**2
    return E


def summed(E: Array, length: Any) -> Triple:
    """Return the triple of a short piece by the series of the exponential."""
    h = E * length
    # sum of h^n/n! without the first term, by Horner
    X = h / TERMS
    for n in range(TERMS - 1, 0, -1):
        X = (h + h @ X) / n
    return of_transition(X)


def of_transition(X: Array) -> Triple:
    """Return the triple of a transition I + X of (u, f)."""
    w = X.shape[1] // 2
    back = inverse(identity(X)[:w, :w] + X[:, w:, w:])
    D = turned(-back @ X[:, w:, w:])
    return Triple(D, X[:, :w, w:] @ back, back @ X[:, w:, :w], turned(back))


def pieces_of(f: Frame, e: int, patient: bool) -> list[Triple]:
    """Return the pieces of a tensed or continuous element, from left to right."""
    if f.chain.rise is not None and f.chain.rise[e] != 0:
        return graded_pieces(f, e, patient)
    E, length = rate_matrix(f, e), f.chain.length[e]
    change = float((sizes(E).sum(axis=2).max() * length).real)
    halvings = max(0, int(np.ceil(np.log2(max(change, 1e-300) / REACH))))
    piece = summed(E, length / 2**halvings)
    for k in range(halvings):
        joined, M = join(piece, piece, None)
        if patient and not is_calm(M) and halvings - k <= CUT:
            return [piece] * 2 ** (halvings - k)
        piece = joined
    return [piece]


def graded_count(f: Frame, e: int) -> int:
    """Return into how many pieces an element is cut along which the tension grows."""
    chain = f.chain
    assert chain.rise is not None
    rise, mean = float(abs(chain.rise[e])), float(abs(chain.tension[e]))
    if rise == 0:
        return 1
    strings = any(f.at(a) >= 0 and f.at(b) < 0 for a, b in TRANSVERSE)
    change = float((sizes(rate_matrix(f, e)).sum(axis=2).max() * chain.length[e]).real)
    change = (change + rise / mean) / REACH
    change = max(change, rise / (mean - rise / 2) / GROWS if strings else 0.0)
    return int(2 ** max(0, int(np.ceil(np.log2(max(change, 1e-300))))))


def graded_pieces(f: Frame, e: int, patient: bool) -> list[Triple]:
    """Return the pieces of an element along which the tension grows."""
    chain, pull = f.chain, f.factor[TENSION][:, None, None]
    assert chain.rise is not None
    E, length, rise = rate_matrix(f, e), chain.length[e], chain.rise[e]
    w, mean = len(f.names), chain.tension[e]
    strings = [f.at(a) for a, b in TRANSVERSE if f.at(a) >= 0 and f.at(b) < 0]
    count = graded_count(f, e)
    step, T = length / count, mean - rise / 2 + rise * np.arange(count)[:, None] / count
    # of E + s slope, and of strings T z' = F with T + s slope
    A, slope = np.repeat(E[None], count, axis=0), np.zeros_like(E)
    grows = np.zeros((count, 1, 2 * w, 1), dtype=T.dtype)
    for _, beta in f.bent:
        of_tension = pull[:, 0, 0] * f.z[beta] ** 2
        A[:, :, w + beta, beta] += (T - mean) * of_tension
        slope[:, w + beta, beta] = rise / length * of_tension
    for z in strings:
        A[:, :, z, w + z] = 1 / (T * pull[:, 0, 0] * f.z[z] ** 2)
        grows[:, 0, z, 0] = rise / count / T[:, 0]
    A, slope = A * step, slope * step**2
    last, Y = np.zeros_like(A), np.broadcast_to(identity(A), A.shape)
    X = np.zeros_like(A)
    for n in range(TERMS):
        last, Y = Y, (A @ Y + slope @ last - n * grows * Y) / (n + 1)
        X = X + Y
    every = of_transition(X.reshape(-1, 2 * w, 2 * w))
    many = [Triple(*(one.reshape(count, -1, w, w)[k] for one in every)) for k in range(count)]
    while len(many) > 1:
        joined = [join(one, two, None) for one, two in zip(many[::2], many[1::2])]
        if patient and not all(is_calm(M) for _, M in joined):
            break
        many = [one for one, _ in joined]
    return many


def levers(f: Frame, e: int) -> list[list[tuple[int, int, Any]]]:
    """Return what each end force causes: c s^p in a channel, as (channel, p, c)."""
    # at a distance s from the tip; where the rope hangs that along x is a load across as well
    loads: list[list[tuple[int, int, Any]]] = []
    for i, name in enumerate(f.names):
        across = any(name == a and f.at(b) >= 0 for a, b in TRANSVERSE)
        over = 1 / f.z[i]
        loads.append([(CHANNELS["beta"] if name == "z" else CHANNELS.get(name, 0), across, over)])
        if name == "y" and across:
            loads[-1] = [(CHANNELS["gamma"], 1, over)]
    x = f.at("x")
    if f.chain.sag is not None and x >= 0 and f.at("z") >= 0:
        loads[x].append((CHANNELS["beta"], 2, f.chain.sag[e] / 2 / f.z[x]))
    return loads


def stiff_element(f: Frame, e: int) -> tuple[Triple, Array]:
    """Return the triple of a rigid or difference element without its string, and the string."""
    chain, length, w = f.chain, f.chain.length[e], len(f.names)
    S, loads = chain.flexibility[e], levers(f, e)
    G = np.zeros((w, w), dtype=S.dtype)
    for i in range(w):
        for j in range(w):
            G[i, j] = sum(
                a * b * S[c, d] * length ** (1 + p + q) / (1 + p + q)
                for c, p, a in loads[i]
                for d, q, b in loads[j]
            )
    G = G / f.factor[SECTION][:, None, None]
    D = np.zeros((1, w, w), dtype=S.dtype)
    string = np.zeros((f.factor.shape[1], w, w), dtype=f.factor.dtype)
    for z, beta in f.bent:
        string[:, z, z] = chain.tension[e] / length * f.factor[TENSION] * f.z[z] ** 2
        if chain.kind == RIGID:
            D[0, z, beta] = length * f.z[beta] / f.z[z]
    x, z = f.at("x"), f.at("z")
    if chain.sag is not None and min(x, z) >= 0:
        D[0, x, z] = chain.sag[e] * length * f.z[z] / f.z[x]
        if f.at("beta") >= 0 and chain.kind == RIGID:
            D[0, x, f.at("beta")] = chain.sag[e] * length**2 / 2 * f.z[f.at("beta")] / f.z[x]
    return Triple(D, G, np.zeros((1, w, w), dtype=S.dtype), identity(D) + D), string


def beside_string(bent: Triple, string: Array) -> tuple[Triple, Array]:
    """Return an element with its string beside it, and how much that amplifies."""
    unit = identity(bent.D)
    X = inverse(unit + bent.G @ string)
    D = X @ bent.D
    return Triple(D, X @ bent.G, turned(bent.D) @ string @ D, unit + D), X


def rows_of(one: Triple) -> Rows:
    """Return the equations of a triple."""
    unit = np.broadcast_to(identity(one.D), (1, *one.D.shape[1:]))
    return Rows(unit, -one.F, one.G, turned(one.F), -one.Q)


def hinge_rows(f: Frame, compliance: Array) -> Rows:
    """Return the equations across a hinge, a spring whose force is 0 where it is free."""
    w, free = len(compliance), np.isinf(compliance)
    unit = np.eye(w, dtype=f.z.dtype)[None]
    closed = unit * np.where(free, 0, 1)
    soft = np.where(free, 0, compliance) / f.z**2 / f.factor[SPRING][:, None]
    soft = np.where(free, 1, soft)
    return Rows(closed, -closed, unit * soft[:, None, :], unit, 0 * unit)


# nodes --------------------------------------------------------------------------------------------


def node_term(f: Frame, term: int) -> Array:
    """Return the stiffness of what stands at a node, structures apart, (lines, width, width)."""
    chain = f.chain
    N = f.factor[SPRING][:, None, None] * chain.stiffness[term]
    N = N + f.factor[INERTIA][:, None, None] * chain.mass[term]
    if chain.damping is not None:
        N = N + f.factor[DASHPOT][:, None, None] * chain.damping[term]
    return N * (f.z[:, None] * f.z)


def krylov(p: Array) -> tuple[list[Array], Array]:
    """Return Krylov's functions times exp(-growth), and exp(-growth); see csrc/base/krylov.h."""
    root = np.sqrt(np.sqrt(p.astype(np.result_type(p, np.complex64))))
    turn = [root, 1j * root]
    growth = np.abs(root.real) + np.abs(root.imag)
    one = np.exp(-growth)
    small = np.abs(p) < 64
    C, c = (np.exp(x - growth) / 2 + np.exp(-x - growth) / 2 for x in turn)
    S, s = (np.exp(x - growth) / 2 - np.exp(-x - growth) / 2 for x in turn)
    s = s / 1j
    safe = np.where(small, 1, root)
    found = [(C + c) / 2, (S + s) / (2 * safe), (C - c) / (2 * safe**2), (S - s) / (2 * safe**3)]
    found.append((found[0] - one) / safe**4)
    for j, factorial in enumerate((1, 1, 2, 6, 24)):
        total = np.ones_like(root)
        for n in range(TERMS - 2, 0, -1):
            a = 4 * n + j
            total = 1 + p * total / (a * (a - 1) * (a - 2) * (a - 3))
        found[j] = np.where(small, total / factorial * one, found[j])
    return found, one


def foot_of(f: Frame, k: int) -> tuple[Array, Array, Array, Array]:
    """Return w, e, v (lines, 2) and rest (lines, 2) of a structure; see csrc/chain/attached.c."""
    chain = f.chain
    assert chain.attached_value is not None
    assert chain.attached_kind is not None
    a, b, c, d = chain.attached_value[k]
    inertia, dashpot = f.factor[INERTIA], f.factor[DASHPOT]
    none = np.zeros_like(inertia)
    if chain.attached_kind[k] != WIRE:
        drag = dashpot * d / b
        lever = np.stack([none + 1, none], axis=1)
        gap = (c + inertia) / c + drag
        return -inertia * a * (1 + drag), gap, lever, np.stack([none, none], axis=1)
    turn = np.where(dashpot == 0, 0, 2 * d)
    pull = -inertia * a
    damped = bool(np.any(turn != 0))
    stiff = b * (1 + 1j * turn) if damped else none + b
    functions, one = krylov(-4 * pull / stiff)
    k0, k1, k2, k3, k4 = functions
    plain = np.abs(k1) >= 2 * np.abs(k3)
    with np.errstate(divide="ignore", invalid="ignore"):
        weight = np.where(plain, pull * k1, 2 * pull * k3)
        lever = np.stack(
            [np.where(plain, 1, k2 / (2 * k3)), np.where(plain, c * k2 / k1, c)], axis=1
        )
        rest = np.stack(
            [
                np.where(plain, 0, -pull * k4 / k3),
                np.where(plain, -2 * c * c * pull * k4 / k1, 0),
            ],
            axis=1,
        )
    found = weight, (one + k0) / 2, lever, rest
    if np.iscomplexobj(inertia) or damped:
        return found
    return tuple(part.real for part in found)  # type: ignore[return-value]


def tip_of_wire(value: Array, inertia: Array, dashpot: Array) -> Array:
    """Return how a wire's tip moves per displacement and rotation of its foot, (2, f)."""
    mass, stiffness, length, ratio = value
    q = -inertia * mass / (stiffness * (1 + 1j * np.where(dashpot == 0, 0, 2 * ratio)))
    at_tip, grown = krylov(q)
    at_foot, one = krylov(-4 * q)
    over = one / grown / ((one + at_foot[0]) / 2)
    return np.stack([at_tip[0] * over, length * at_tip[1] * over])


def feet_at(f: Frame, term: int) -> tuple[CarriedFoot | None, Array | None]:
    """Return the structures of a node term, and what of them is no resonance."""
    chain = f.chain
    if chain.attached_term is None or not (chain.attached_term == term).any():
        return None, None
    assert chain.attached_row is not None
    levers_, weights, gaps, rests = [], [], [], []
    for k in np.flatnonzero(chain.attached_term == term):
        weight, gap, lever, rest = foot_of(f, int(k))
        row = chain.attached_row[k] * f.z
        levers_.append(lever @ row)
        weights.append(weight)
        gaps.append(gap)
        rests.append(np.einsum("fi,ij,ik->fjk", rest, row, row))
    foot = CarriedFoot(np.stack(levers_, axis=1), np.stack(weights, axis=1), np.stack(gaps, axis=1))
    return foot, sum(rests)
