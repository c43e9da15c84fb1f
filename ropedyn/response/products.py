"""Products of two fields along continuous spans: those of a drive and of a load on a response."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Index, Real
from ..base.computed import computed
from ..base.unit import FORCE
from ..chain.chain import Chain
from ..chain.compile import station_nodes, stations_of
from ..chain.compiled import Compiled
from ..chain.port import Point, locate, moving
from ..scene import damping
from ..scene.stations import stations_at
from .hamiltonian import Span, generator, hamiltonian
from .harmonic import solve_harmonic
from .span_waves import SpanWaves, rule

MOST = 1 << 21  # So many numbers of a field are held at once.


class Products(NamedTuple):
    """Of y = (u, f), motion and internal forces, see hamiltonian.py."""

    # (spans, drives, responses, f, 2 width, 2 width) integral of y_response y_drive^T over each
    # span [m]
    span: Complex
    # (spans, drives, responses, f) y_response^T H y_drive, H the Hamiltonian, at the left and at
    # the right end of each span. It is the same as far as there is no load
    first: Complex
    last: Complex
    node: Complex  # (stations, drives, responses, f, width) of the motion there
    # (spans, drives, responses, f, width) of the jumps across the hinges at the left end of each
    # span
    jump: Complex


@dataclass(frozen=True, eq=False)
class Loaded:
    """Continuous spans and the unit loads that make the fields."""

    model: Compiled  # of continuous spans
    coordinates: tuple[str, ...]  # of the components that are driven
    # on motion, where the loads act
    drives: tuple[Point, ...]
    responses: tuple[Point, ...]

    @computed
    def chain(self) -> Chain:
        """Of the coordinates."""
        return self.model.chain.only(self.coordinates)

    @computed
    def stations(self) -> Real:
        """Where spans begin and end [m]."""
        return stations_of(self.model.scene)

    @computed
    def _elements(self) -> list[int]:
        begins = station_nodes(self.model)[:-1]
        return [int(e) for e in self.chain.element_of[begins]]

    @computed
    def spans(self) -> list[Span]:
        """What each span is made of."""
        return [Span.of(self.chain, e) for e in self._elements]

    @computed
    def loads(self) -> list[Point]:
        """Drives and responses, each once."""
        return list(dict.fromkeys([*self.drives, *self.responses]))

    def products(self, frequency: Real) -> Products:
        """Integrate, so many frequencies at a time that the fields are not too large."""
        w = len(self.coordinates)
        shape = (len(self.spans), len(self.drives), len(self.responses), len(frequency))
        whole = Products(
            span=np.zeros((*shape, 2 * w, 2 * w), dtype=np.complex128),
            first=np.zeros(shape, dtype=np.complex128),
            last=np.zeros(shape, dtype=np.complex128),
            node=np.zeros((shape[0] + 1, *shape[1:], w), dtype=np.complex128),
            jump=np.zeros((*shape, w), dtype=np.complex128),
        )
        waves = self._waves(frequency)
        for lines, pieces in self._readings(waves):
            size = 2 * w * len(self.loads) * sum(len(piece.x) for piece in pieces)
            step = max(MOST // size, 1)
            for some in (lines[k : k + step] for k in range(0, len(lines), step)):
                these = [one.at(some) for one in waves]
                for into, found in zip(whole, self._at(frequency[some], pieces, these)):
                    into[:, :, :, some] = found
        return whole

    def _at(
        self, frequency: Real, pieces: Sequence[Unloaded], waves: Sequence[SpanWaves]
    ) -> Products:
        """Return the products at these frequencies."""
        factor, width = self._factor(frequency), len(self.coordinates)
        form = self._forms(factor)
        nodes, fields = self._fields(frequency, pieces)
        d = [self.loads.index(point) for point in self.drives]
        r = [self.loads.index(point) for point in self.responses]
        shape = (len(self.spans), len(d), len(r), len(frequency))
        span = np.zeros((*shape, 2 * width, 2 * width), dtype=np.complex128)
        first, last = np.zeros(shape, dtype=np.complex128), np.zeros(shape, dtype=np.complex128)
        for piece, y in zip(pieces, fields):
            product = piece.products(waves[piece.span], y, r, d)
            span[piece.span] += product
            along = np.einsum("drfij,fij->drf", product, form[piece.span]) / piece.reach
            last[piece.span] = along
            if piece.begin in self.stations:
                first[piece.span] = along
        jump = np.zeros((*shape, width), dtype=np.complex128)
        for k, opens in self._jumps(pieces, fields, nodes, form, factor):
            jump[k] = opens[d][:, None] * opens[r]
        node = np.moveaxis(nodes[d][:, None] * nodes[r], 2, 0)
        return Products(span, first, last, np.moveaxis(node, 3, 4), jump)

    def _factor(self, frequency: Real) -> Complex:
        omega = 2 * np.pi * frequency
        return np.ascontiguousarray(damping.factors(self.model.scene.dampings, omega).T)

    def _forms(self, factor: Complex) -> list[Complex]:
        return [hamiltonian(span, self.coordinates, factor) for span in self.spans]

    def _waves(self, frequency: Real) -> list[SpanWaves]:
        """Return those of each span, equal ones once."""
        factor, elements = self._factor(frequency), self._elements
        found = {
            e: SpanWaves.of(hamiltonian(span, self.coordinates, factor))
            for e, span in dict(zip(elements, self.spans)).items()
        }
        return [found[e] for e in elements]

    def _readings(self, waves: Sequence[SpanWaves]) -> Iterator[tuple[Index, list[Unloaded]]]:
        """Yield frequencies by their numbers, with the pieces as they are integrated there."""
        # where the waves of a piece can be told apart two places say all of it. Where its waves are
        # longer than itself it has a quadrature, which few points are enough for
        within = [p[1] for p in self.loads if locate(self.stations, p[1])[1] is not None]
        edges = stations_at(self.model.scene.rope.length, [*self.stations.tolist(), *within])
        which = np.searchsorted(self.stations, (edges[1:] + edges[:-1]) / 2) - 1
        told = np.array([waves[k].tell(reach) for k, reach in zip(which, np.diff(edges))])
        mostly = told.sum(axis=1) > told.shape[1] / 2
        good = told[mostly].all(axis=0)
        for lines, by_waves in ((good, mostly), (~good, np.zeros_like(mostly))):
            if lines.any():
                rate = [wave.rate[lines] for wave in waves]
                yield (
                    np.flatnonzero(lines),
                    [
                        Unloaded.of(k, begin, end, rate[k], by_waves=by)
                        for k, begin, end, by in zip(which, edges, edges[1:], by_waves.tolist())
                    ],
                )

    def _fields(self, frequency: Real, pieces: Sequence[Unloaded]) -> tuple[Complex, list[Complex]]:
        """Return the motion of stations, (loads, stations, width, f), and y at points of pieces."""
        w = len(self.coordinates)
        names = [*self.coordinates, *(FORCE[c] for c in self.coordinates)]
        asked = [(c, float(x)) for x in self.stations for c in self.coordinates]
        asked += [(name, float(x)) for piece in pieces for x in piece.x for name in names]
        value = solve_harmonic(self.model, frequency, drive=self.loads, response=asked).value
        nodes, inside = np.split(value, [w * len(self.stations)], axis=1)
        cuts = np.cumsum([2 * w * len(piece.x) for piece in pieces])[:-1]
        loads, count = len(self.loads), len(frequency)
        return nodes.reshape(loads, -1, w, count), [
            one.reshape(loads, -1, 2 * w, count) for one in np.split(inside, cuts, axis=1)
        ]

    def _jumps(
        self,
        pieces: Sequence[Unloaded],
        fields: Sequence[Complex],
        nodes: Complex,
        form: Sequence[Complex],
        factor: Complex,
    ) -> list[tuple[int, Complex]]:
        """Return how far hinges open, by the span on their right: (loads, f, width)."""
        from scipy.linalg import expm

        if self.chain.hinge is None:
            return []
        found, w = [], len(self.coordinates)
        node = np.searchsorted(self.model.x, self.stations[:-1])
        hinges = self.chain.hinge[self.chain.term_of[node]]
        for k in np.flatnonzero(hinges.any(axis=1)).tolist():
            first = next(i for i, piece in enumerate(pieces) if piece.span == k)
            back = expm(generator(form[k]) * (pieces[first].begin - pieces[first].x[0]))
            y = np.einsum("fij,ljf->lfi", back, fields[first][:, 0])
            opens = np.zeros((*y.shape[:2], w), dtype=np.complex128)
            for c in np.flatnonzero(hinges[k]).tolist():
                if np.isinf(hinges[k, c]):
                    opens[..., c] = y[..., c] - nodes[:, k, c]
                else:
                    opens[..., c] = y[..., w + c] * hinges[k, c] / factor[damping.SPRING]
            found.append((k, opens))
        return found


@dataclass(frozen=True, eq=False)
class Unloaded:
    """A stretch of a span without loads."""

    span: int  # to which it belongs
    begin: float  # [m]
    end: float  # [m]
    x: Real  # (points,) where the fields are asked for [m]
    # (points,) of a quadrature [m]; None where the waves are told from two points near the ends
    weight: Real | None

    @classmethod
    def of(cls, span: int, begin: float, end: float, rate: Complex, *, by_waves: bool) -> Unloaded:
        """Choose the points for waves of these rates, shape (f, 2 width)."""
        reach = end - begin
        if by_waves:
            near = min(reach / 4, 1 / float(np.abs(rate).max()))
            return cls(span, begin, end, np.array([begin + near, end - near]), None)
        waves, decay = (float(np.abs(part).max(initial=0.0)) for part in (rate.imag, rate.real))
        points, weight = rule(waves * reach, decay * reach)
        return cls(span, begin, end, begin + reach * points, reach * weight)

    @property
    def reach(self) -> float:
        """Its length [m]."""
        return self.end - self.begin

    def products(self, waves: SpanWaves, y: Complex, r: list[int], d: list[int]) -> Complex:
        """Integrate y_r y_d^T of some of the loads' fields at x, (loads, points, 2 width, f)."""
        if self.weight is not None:
            weighted = y[r] * self.weight[:, None, None]
            return np.einsum("rgif,dgjf->drfij", weighted, y[d], optimize=True)
        first, last = waves.amplitudes(y, float(self.x[0] - self.begin), self.reach)
        return waves.products((first[r], last[r]), (first[d], last[d]), self.reach)


def driven(model: Compiled, drives: Sequence[Point]) -> tuple[str, ...]:
    """Return the coordinates of the components that some drive moves."""
    moved = {moving(point) for point in drives}
    wanted = {c for component in model.components if moved & set(component) for c in component}
    return tuple(c for c in model.coordinates if c in wanted)
