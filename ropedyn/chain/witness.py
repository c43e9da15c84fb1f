"""The linear system of a chain solved in any precision, by the numbers that its arrays are of.

Unknown are motion u and forces f on both sides of stations, by Gauss with row exchanges from one to
the next, so that no part of the chain alone can resonate: see docs/theory/errors.md. Runs of equal
elements are joined, two and two, as long as nothing in them is near a resonance of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .chain import ATTACHED, CHANNELS, CONTINUOUS, KINDS, TENSED, TRANSVERSE, Chain
from .port import Ports

Array = NDArray[Any]

SECTION, TENSION, SPRING, INERTIA, DASHPOT = range(5)  # The rows of factors.
DIFFERENCE, RIGID = KINDS.index("difference"), KINDS.index("rigid")
WIRE = ATTACHED.index("broken wire")
AMPLIFIED = 4.0  # Joints that move by more than this many times what their ends do are not joined,
CROWDED = 4096  # unless there were more stations than this.
REACH = 0.5  # Series begin at pieces across which nothing changes by more.
TERMS = 24  # REACH^24/24! is nothing at 64 digits of 2, and at 113 with 10 more terms.
AT_ONCE = 1 << 22  # Numbers of one elimination.
MOST_WORK = 1 << 19  # Stations times lines of one answer: some ten seconds.


class Triple(NamedTuple):
    """An element or several: u_b = (I + D) u_a + G f_b, f_a = (I + D)^T f_b - Q u_a."""

    D: Array  # (lines or 1, width, width)
    G: Array
    Q: Array


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


class Foot(NamedTuple):
    """Structures of a node: force -w v y for each, with e y = v^T u."""

    lever: Array  # (lines, structures, width)
    weight: Array  # (lines, structures)
    gap: Array  # (lines, structures)


class Loads(NamedTuple):
    """Forces on nodes, several at once."""

    node: Array  # (pushed,), each once or more often
    row: Array  # (pushed, width, loads)

    @classmethod
    def of(cls, ports: Ports) -> Loads:
        """Return unit loads at ports."""
        each = np.eye(len(ports.node), dtype=ports.row.dtype)
        rows = [ports.row[:, k, :, None] * each[:, None, :] for k in range(2)]
        return cls(np.concatenate([ports.node, ports.node + 1]), np.concatenate(rows))


class Fields(NamedTuple):
    """What loads cause at nodes, each (lines, nodes, width, loads)."""

    node: Array  # (nodes,)
    u: Array
    left: Array  # force on the left of the node
    right: Array  # and on its right


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
    one_, unit = identity(one.D) + one.D, identity(one.D)
    two_ = identity(two.D) + two.D
    M = inverse(unit + one.G @ K)
    X = -(M @ one.G) @ K
    Y = two.D + X + two.D @ X
    D = Y + one.D + Y @ one.D
    G = two.G + two_ @ (M @ one.G) @ turned(two_)
    Q = one.Q + turned(one_) @ (K @ M) @ one_
    return Triple(D, G, Q), M


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
    w, h = E.shape[1] // 2, E * length
    # sum of h^n/n! without the first term, by Horner
    X = h / TERMS
    for n in range(TERMS - 1, 0, -1):
        X = (h + h @ X) / n
    back = inverse(identity(h)[:w, :w] + X[:, w:, w:])
    return Triple(turned(-back @ X[:, w:, w:]), X[:, :w, w:] @ back, back @ X[:, w:, :w])


def pieces_of(f: Frame, e: int, patient: bool) -> tuple[Triple, int]:
    """Return a piece of a tensed or continuous element, and how many such it has."""
    E, length = rate_matrix(f, e), f.chain.length[e]
    change = float((sizes(E).sum(axis=2).max() * length).real)
    halvings = max(0, int(np.ceil(np.log2(max(change, 1e-300) / REACH))))
    piece = summed(E, length / 2**halvings)
    for k in range(halvings):
        joined, M = join(piece, piece, None)
        if patient and not is_calm(M):
            return piece, 2 ** (halvings - k)
        piece = joined
    return piece, 1


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
    return Triple(D, G, np.zeros((1, w, w), dtype=S.dtype)), string


def beside_string(bent: Triple, string: Array) -> tuple[Triple, Array]:
    """Return an element with its string beside it, and how much that amplifies."""
    unit = identity(bent.D)
    X = inverse(unit + bent.G @ string)
    D = X @ bent.D
    return Triple(D, X @ bent.G, turned(bent.D) @ string @ D), X


def rows_of(one: Triple) -> Rows:
    """Return the equations of a triple."""
    F = identity(one.D) + one.D
    unit = np.broadcast_to(identity(one.D), (1, *one.D.shape[1:]))
    return Rows(unit, -F, one.G, turned(F), -one.Q)


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


def feet_at(f: Frame, term: int) -> tuple[Foot | None, Array | None]:
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
    foot = Foot(np.stack(levers_, axis=1), np.stack(weights, axis=1), np.stack(gaps, axis=1))
    return foot, sum(rests)


# the chain ----------------------------------------------------------------------------------------


class Station(NamedTuple):
    """A node, or a joint of pieces where nothing stands, with what is on its right."""

    node: int  # -1 at a joint
    term: int  # -1 where nothing stands
    right: Rows | Strut | None  # None at the end


def stations_of(elements: Frame, frame: Frame, patient: bool, asked: Array) -> Iterator[Station]:
    """Yield the stations, from left to right; elements may be the same at all lines."""
    chain = frame.chain
    made: dict[int, tuple[Triple, int] | Strut] = {}
    for k in range(len(chain.first) - 1):
        e, term = int(chain.element[k]), int(chain.term[k])
        if e not in made:
            made[e] = element_of(elements, e, patient)
        begin, end = int(chain.first[k]), int(chain.first[k + 1])
        inner = asked[(asked > begin) & (asked < end)].tolist()
        yield from stretch(frame, made[e], term, [begin, *inner, end], patient)
    yield Station(chain.nodes - 1, int(chain.term[-1]), None)


def element_of(f: Frame, e: int, patient: bool) -> tuple[Triple, int] | Strut:
    """Return a piece of an element and how many it has, or the equations of one that has none."""
    if f.chain.kind in (TENSED, CONTINUOUS) or not f.bent:
        return pieces_of(f, e, patient)
    bent, string = stiff_element(f, e)
    if not (string != 0).any():
        return bent, 1
    whole, X = beside_string(bent, string)
    return (whole, 1) if is_calm(X) else Strut(identity(bent.D) + bent.D, bent.G, string)


def stretch(
    f: Frame, piece: tuple[Triple, int] | Strut, term: int, nodes: list[int], patient: bool
) -> Iterator[Station]:
    """Yield the stations of equal elements between nodes with the same term."""
    hinge = None if f.chain.hinge is None else f.chain.hinge[term]
    opens = hinge is not None and bool((hinge > 0).any())
    foot = f.chain.attached_term is not None and bool((f.chain.attached_term == term).any())
    alone = opens or foot or isinstance(piece, Strut) or piece[1] > 1
    alone |= bool(f.chain.held[term].any())
    powers = None if alone or isinstance(piece, Strut) else [piece[0]]
    N = node_term(f, term)
    for begin, end in pairwise(nodes):
        if powers is None:
            for node in range(begin, end):
                yield from single(f, piece, node, term, hinge if opens else None)
            continue
        left, at = end - begin, begin
        while 2 ** len(powers) <= left and len(powers) < 60:
            joined, M = join(powers[-1], powers[-1], N)
            if patient and not is_calm(M):
                break
            powers.append(joined)
        while left:
            k = min(len(powers), left.bit_length()) - 1
            yield Station(at, term, rows_of(powers[k]))
            at, left = at + 2**k, left - 2**k


def single(
    f: Frame, piece: tuple[Triple, int] | Strut, node: int, term: int, hinge: Array | None
) -> Iterator[Station]:
    """Yield the stations of a node and the element on its right."""
    if hinge is not None:
        yield Station(node, term, hinge_rows(f, hinge))
        node, term = -1, -1
    if isinstance(piece, Strut):
        yield Station(node, term, piece)
        return
    rows = rows_of(piece[0])
    yield Station(node, term, rows)
    for _ in range(piece[1] - 1):
        yield Station(-1, -1, rows)


def respond(chain: Chain, factor: Array, z: Array, loads: Loads, watched: Array) -> Fields | None:
    """Solve for what unit loads cause at nodes; None where that is too much work.

    Parameters
    ----------
    chain : Chain
        Of one component, its arrays and the factors of any kind of number.
    factor : ndarray, shape (5, lines)
        Real where nothing is damped.
    z : ndarray, shape (width, lines)
        Scales of motion, powers of 2.
    loads : Loads
    watched : ndarray of int
        Nodes.
    """
    asked = np.unique(np.concatenate([watched, loads.node]))
    asked = asked[asked < chain.nodes]
    order = np.argsort(np.abs(factor[INERTIA]), kind="stable")
    width, count = z.shape[0], len(order)
    # the fastest line has the most stations
    most = len(_elimination(chain, factor[:, order[-1:]], z[:, order[-1:]], loads, asked).stations)
    if most * count > MOST_WORK:
        return None
    step = max(1, AT_ONCE // (4 * width * (5 * width + loads.row.shape[2]) * most))
    parts = []
    for k in range(0, count, step):
        own = order[k : k + step]
        parts.append(_elimination(chain, factor[:, own], z[:, own], loads, asked).fields(asked))
    back = np.argsort(order, kind="stable")
    joined = [np.concatenate([getattr(p, n) for p in parts])[back] for n in ("u", "left", "right")]
    return Fields(asked, *joined)


def _elimination(chain: Chain, factor: Array, z: Array, loads: Loads, asked: Array) -> Elimination:
    """Return what solves some lines."""
    middle = z[:, z.shape[1] // 2]
    frame = Frame(chain, chain.names, factor, middle)
    # what does not change from line to line is made once
    same = chain.inertia is None and bool((factor[:2] == factor[:2, :1]).all())
    elements = frame._replace(factor=factor[:, :1]) if same else frame
    for patient in (True, False):
        stations = list(stations_of(elements, frame, patient, asked))
        if len(stations) <= CROWDED:
            break
    return Elimination(frame, z / middle[:, None], loads, stations)


class Elimination:
    """Gauss from station to station: f on the left, u, y of structures and f on the right."""

    def __init__(self, frame: Frame, ratio: Array, loads: Loads, stations: list[Station]) -> None:
        self.frame, self.loads, self.stations = frame, loads, stations
        self.r = np.ascontiguousarray(ratio.T)  # (lines, width)
        self.w, self.d = len(frame.names), loads.row.shape[2]
        self.dtype = np.result_type(frame.factor, frame.chain.flexibility, frame.z)
        self.memory: dict[int, tuple[Array, Foot | None]] = {}

    def node(self, term: int) -> tuple[Array, Foot | None]:
        """Return stiffness and structures of a node term, in the frame of each line."""
        if term not in self.memory:
            N = node_term(self.frame, term)
            foot, rest = feet_at(self.frame, term)
            N = N if rest is None else N + rest
            N = N * (self.r[:, :, None] * self.r[:, None, :])
            if foot is not None:
                foot = foot._replace(lever=foot.lever * self.r[:, None])
            self.memory[term] = N, foot
        return self.memory[term]

    def pushed(self, node: int) -> Array:
        """Return the loads on a node, (lines, width, loads)."""
        push = self.loads.row[self.loads.node == node].sum(axis=0)
        return push * self.frame.z[:, None] * self.r[:, :, None]

    def solve(self) -> list[tuple[Array, Array, Array]]:
        """Return f on the left, u and f on the right of all stations."""
        w, d, lines = self.w, self.d, len(self.r)
        carried = np.zeros((lines, w, 2 * w + d), dtype=self.dtype)
        carried[:, range(w), range(w)] = 1  # nothing pulls at the left end
        kept = []
        for station in self.stations:
            N, foot = self.node(station.term) if station.term >= 0 else (None, None)
            a = 0 if foot is None else foot.gap.shape[1]
            beside = w if isinstance(station.right, Strut) else 0
            own, more, rows = 3 * w + a + beside, 2 * w, 4 * w + a + beside
            if station.right is None:
                own, more, rows = 2 * w + a, 0, 2 * w + a
            A = np.zeros((lines, rows, own + more + d), dtype=self.dtype)
            A[:, :w, : 2 * w], A[:, :w, own + more :] = carried[..., : 2 * w], carried[..., 2 * w :]
            self._balance(A, station, N, foot, own + more)
            if isinstance(station.right, Rows):
                self._cross(A, station.right, own)
            elif station.right:
                self._cross_strut(A, station.right, own)
            _core.eliminate(A, own)
            kept.append((A, own, a))
            carried = A[:, own:, own:]
        return self._back(kept)

    def _balance(
        self, A: Array, station: Station, N: Array | None, foot: Foot | None, ends: int
    ) -> None:
        """Fill in the rows of a node: f right - f left = N u - sum of w v y - load."""
        w = self.w
        row, left, at = slice(w, 2 * w), range(w), range(w, 2 * w)
        A[:, at, left] = -1
        if station.right:
            a = 0 if foot is None else foot.gap.shape[1]
            A[:, at, range(2 * w + a, 3 * w + a)] = 1
        if N is not None:
            A[:, row, w : 2 * w] -= N
        if foot is not None:
            for k in range(foot.gap.shape[1]):
                y = 2 * w + k
                A[:, row, y] = foot.weight[:, k, None] * foot.lever[:, k]
                A[:, y, y] = foot.gap[:, k]
                A[:, y, w : 2 * w] = -foot.lever[:, k]
        if station.node >= 0:
            A[:, row, ends:] = -self.pushed(station.node)
        if station.term >= 0:
            for i in np.flatnonzero(self.frame.chain.held[station.term]):
                A[:, w + i] = 0
                A[:, w + i, w + i] = 1

    def _cross(self, A: Array, rows: Rows, own: int) -> None:
        """Fill in the equations of what is right of a node."""
        w, first = self.w, A.shape[1] - 2 * self.w
        over, product = self._ratios()
        one, two = slice(first, first + w), slice(first + w, first + 2 * w)
        f_next, u_next = slice(own, own + w), slice(own + w, own + 2 * w)
        u, right = slice(w, 2 * w), slice(own - w, own)
        A[:, one, u_next] = rows.ahead * over
        A[:, one, u] = rows.behind * over
        A[:, one, f_next] = -rows.soft / product
        A[:, two, right] = identity(A)[:w, :w]
        A[:, two, f_next] = -rows.turn / over
        A[:, two, u] = -rows.stiff * product

    def _cross_strut(self, A: Array, strut: Strut, own: int) -> None:
        """Fill in the equations of a strut, whose g is the last of the unknowns here."""
        w, first = self.w, A.shape[1] - 3 * self.w
        over, product = self._ratios()
        one, two, three = (slice(first + k * w, first + (k + 1) * w) for k in range(3))
        f_next, u_next = slice(own, own + w), slice(own + w, own + 2 * w)
        u, right, g = slice(w, 2 * w), slice(own - 2 * w, own - w), slice(own - w, own)
        unit, pull = identity(A)[:w, :w], strut.K * product
        A[:, one, u_next] = unit
        A[:, one, u] = -strut.F * over
        A[:, one, g] = -strut.G / product
        A[:, two, f_next] = A[:, three, right] = unit
        A[:, two, g] = -unit
        A[:, three, g] = -turned(strut.F) / over
        A[:, two, u_next] = A[:, three, u_next] = -pull
        A[:, two, u] = A[:, three, u] = pull

    def _ratios(self) -> tuple[Array, Array]:
        """Return r_j/r_i and r_i r_j, (lines, width, width)."""
        r = self.r
        return r[:, None, :] / r[:, :, None], r[:, :, None] * r[:, None, :]

    def _back(self, kept: list[tuple[Array, int, int]]) -> list[tuple[Array, Array, Array]]:
        w, d = self.w, self.d
        found: list[tuple[Array, Array, Array]] = []
        ahead = None
        for A, own, a in reversed(kept):
            x = np.ascontiguousarray(A[:, :own, A.shape[2] - d :])
            if ahead is not None:
                x -= A[:, :own, own : own + 2 * w] @ ahead
            _core.substitute(A, x)
            ahead = x[:, : 2 * w]
            end = slice(2 * w + a, 3 * w + a)
            last = x[:, end] if own > 2 * w + a else np.zeros_like(x[:, :w])
            found.append((x[:, :w], x[:, w : 2 * w], last))
        return found[::-1]

    def fields(self, asked: Array) -> Fields:
        """Return what is caused at nodes, in SI units."""
        z = self.frame.z * self.r
        found = self.solve()
        at = {s.node: k for k, s in enumerate(self.stations) if s.node >= 0}
        picked = [found[at[int(node)]] for node in asked]
        left, u, right = (np.stack([one[k] for one in picked], axis=1) for k in range(3))
        z = z[:, None, :, None]
        return Fields(asked, u * z, left / z, right / z)
