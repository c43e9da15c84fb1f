"""The linear system of a chain solved in any precision, by the numbers that its arrays are of.

Unknown are motion u and forces f on both sides of stations, by Gauss with row exchanges from one to
the next, so that no part of the chain alone can resonate: see docs/theory/errors.md. Runs of equal
elements are joined, two and two, as long as nothing in them is near a resonance of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np

from .. import _core
from .chain import CONTINUOUS, TENSED, Chain
from .port import Ports
from .wide_parts import (
    INERTIA,
    Array,
    CarriedFoot,
    Frame,
    Rows,
    Strut,
    Triple,
    beside_string,
    feet_at,
    graded_count,
    hinge_rows,
    identity,
    is_calm,
    join,
    node_term,
    pieces_of,
    rows_of,
    stiff_element,
    turned,
)

CROWDED = 4096  # Beyond so many stations all that can be joined is.
AT_ONCE = 1 << 22  # Numbers of one elimination.
MOST_GRADED = 128  # Pieces along which the tension grows: some tenths of a second.
MOST_WORK = 1 << 19  # Stations times lines of one answer: some ten seconds.


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


class NodeFields(NamedTuple):
    """What loads cause at nodes, each (lines, nodes, width, loads)."""

    node: Array  # (nodes,)
    u: Array
    left: Array  # force on the left of the node
    right: Array  # and on its right


class Station(NamedTuple):
    """A node, or a joint of pieces where nothing stands, with what is on its right."""

    node: int  # -1 at a joint
    term: int  # -1 where nothing stands
    right: Rows | Strut | None  # None at the end


def stations_of(elements: Frame, frame: Frame, patient: bool, asked: Array) -> Iterator[Station]:
    """Yield the stations, from left to right; elements may be the same at all lines."""
    chain = frame.chain
    made: dict[int, list[Triple] | Strut] = {}
    for k in range(len(chain.first) - 1):
        e, term = int(chain.element[k]), int(chain.term[k])
        if e not in made:
            made[e] = element_of(elements, e, patient)
        begin, end = int(chain.first[k]), int(chain.first[k + 1])
        inner = asked[(asked > begin) & (asked < end)].tolist()
        yield from stretch(frame, made[e], term, [begin, *inner, end], patient)
    yield Station(chain.nodes - 1, int(chain.term[-1]), None)


def element_of(f: Frame, e: int, patient: bool) -> list[Triple] | Strut:
    """Return the pieces of an element, or the equations of one that has none."""
    if f.chain.kind in (TENSED, CONTINUOUS) or not f.bent:
        return pieces_of(f, e, patient)
    bent, string = stiff_element(f, e)
    if not (string != 0).any():
        return [bent]
    whole, X = beside_string(bent, string)
    return [whole] if is_calm(X) else Strut(bent.F, bent.G, string)


def stretch(
    f: Frame, pieces: list[Triple] | Strut, term: int, nodes: list[int], patient: bool
) -> Iterator[Station]:
    """Yield the stations of equal elements between nodes with the same term."""
    hinge = None if f.chain.hinge is None else f.chain.hinge[term]
    opens = hinge is not None and bool((hinge > 0).any())
    foot = f.chain.attached_term is not None and bool((f.chain.attached_term == term).any())
    alone = opens or foot or isinstance(pieces, Strut) or len(pieces) > 1
    alone |= bool(f.chain.held[term].any())
    powers = None if alone or isinstance(pieces, Strut) else [pieces[0]]
    N = node_term(f, term)
    for begin, end in pairwise(nodes):
        if powers is None:
            for node in range(begin, end):
                yield from single(f, pieces, node, term, hinge if opens else None)
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
    f: Frame, pieces: list[Triple] | Strut, node: int, term: int, hinge: Array | None
) -> Iterator[Station]:
    """Yield the stations of a node and the element on its right."""
    if hinge is not None:
        yield Station(node, term, hinge_rows(f, hinge))
        node, term = -1, -1
    if isinstance(pieces, Strut):
        yield Station(node, term, pieces)
        return
    for piece in pieces:
        yield Station(node, term, rows_of(piece))
        node, term = -1, -1


def respond(
    chain: Chain, factor: Array, z: Array, loads: Loads, watched: Array
) -> NodeFields | None:
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
    if chain.rise is not None and _graded(chain, factor[:, order[-1:]], z[:, order[-1:]]):
        return None
    # the fastest line has the most stations
    most = len(_elimination(chain, factor[:, order[-1:]], z[:, order[-1:]], loads, asked).stations)
    if most * count > MOST_WORK:
        return None
    step = max(1, AT_ONCE // (4 * width * (5 * width + loads.row.shape[2]) * most))
    parts = []
    for k in range(0, count, step):
        own = order[k : k + step]
        with np.errstate(all="ignore"):  # what is singular has no numbers
            parts.append(_elimination(chain, factor[:, own], z[:, own], loads, asked).fields(asked))
    back = np.argsort(order, kind="stable")
    joined = [np.concatenate([getattr(p, n) for p in parts])[back] for n in ("u", "left", "right")]
    return NodeFields(asked, *joined)


def _graded(chain: Chain, factor: Array, z: Array) -> bool:
    """Say whether the tension grows along more pieces than are made."""
    frame = Frame(chain, chain.names, factor, z[:, 0])
    pieces = accumulate(graded_count(frame, int(e)) for e in chain.element)
    return any(total > MOST_GRADED for total in pieces)


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
        self.memory: dict[int, tuple[Array, CarriedFoot | None]] = {}

    def node(self, term: int) -> tuple[Array, CarriedFoot | None]:
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
        self, A: Array, station: Station, N: Array | None, foot: CarriedFoot | None, ends: int
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

    def fields(self, asked: Array) -> NodeFields:
        """Return what is caused at nodes, in SI units."""
        z = self.frame.z * self.r
        found = self.solve()
        at = {s.node: k for k, s in enumerate(self.stations) if s.node >= 0}
        picked = [found[at[int(node)]] for node in asked]
        left, u, right = (np.stack([one[k] for one in picked], axis=1) for k in range(3))
        z = z[:, None, :, None]
        return NodeFields(asked, u * z, left / z, right / z)
