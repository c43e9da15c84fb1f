"""Modes and counts of spans in closed form, a row of numbers each; see csrc/closed."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Flags, Index, Integer, Real
from ..chain.chain import Chain
from ..chain.spans import Spans, spans_of

KINDS = {4: "bent", 3: "plain"}
"""What the core calls spans, by their numbers."""

ALONE = {"bent": [0, 1, 2, 3, 6, 7, 10, 11], "plain": [0, 1, 2, 4, 6]}
"""Which numbers of one span between springs the core takes."""


FINE = 1e-12
"""A row is certified to such a relative error: slow modes of heavy masses lose more in closed form,
and the walk along the chain keeps them."""

MOST = 1 << 17
"""Modes times spans of a chain, a third of a second: the walk along more looks for Ctrl-C."""


class ClosedModes(NamedTuple):
    """Of each row its lowest modes; wrong ones may stand where a row is not certified."""

    omega: Real  # (rows, k) [rad/s]
    error: Real  # (rows, k) relative, that rounding causes
    slope: Real | None  # (rows, k, values) d ln omega by each value, where asked for
    certified: Flags  # (rows,)


class ClosedSpans(NamedTuple):
    """Spans of one form, whatever their numbers."""

    kind: str  # as the core calls it
    taken: Index | None  # which numbers one span between springs takes, None of a chain of them
    hinged: NDArray[np.uint8]  # (stations,)

    def modes(self, number: Real, modes: int, jacobian: Real | None = None) -> ClosedModes:
        """Find the lowest modes of each row of numbers, and slopes by what numbers follow from."""
        if self.taken is None:
            found = _core.closed_chain_modes(self.kind, number, self.hinged, jacobian, modes)
        else:
            of = None if jacobian is None else jacobian[self.taken]
            found = _core.closed_modes(self.kind, number[:, self.taken], of, modes)
        omega, error, slope, certified = found
        return ClosedModes(omega, error, slope, certified & (error <= FINE).all(axis=1))

    def counts(self, number: Real, omega: float) -> Integer:
        """Count the eigenvalues below omega^2 of each row of numbers, -1 where not certain."""
        if self.taken is None:
            return _core.closed_chain_count(self.kind, number, self.hinged, omega)
        return _core.closed_count(self.kind, number[:, self.taken], omega)


def closed_form(spans: Spans, varied: Flags | None = None) -> ClosedSpans:
    """Return the closed form of spans some of whose numbers vary."""
    kind = KINDS[spans.span.shape[1]]
    number = np.where(varied, np.nan, spans.number) if varied is not None else spans.number
    taken = np.array(ALONE[kind])
    is_one = len(spans.span) == 1 and not spans.hinged.any() and not np.delete(number, taken).any()
    return ClosedSpans(kind, taken if is_one else None, spans.hinged)


def closed_eigenvalues(chain: Chain, number: int | None, limit: float) -> tuple[Real, Real] | None:
    """Return the lowest eigenvalues of a chain and their errors, None where not certified."""
    spans = spans_of(chain)
    if spans is None:
        return None
    form = closed_form(spans)
    row = spans.number[np.newaxis]
    wanted = int(form.counts(row, np.sqrt(limit))[0]) if number is None else number
    if wanted < 1:
        return None if wanted else (np.zeros(0), np.zeros(0))
    if form.taken is None and wanted * len(spans.span) > MOST:
        return None
    found = form.modes(row, wanted)
    if not found.certified[0]:
        return None
    eigenvalue = found.omega[0] ** 2
    return eigenvalue, eigenvalue * (2 * found.error[0] + np.finfo(float).eps)


def closed_count(chain: Chain, limit: float) -> int | None:
    """Count the eigenvalues of a chain below a limit, None where that is not certain."""
    spans = spans_of(chain)
    if spans is None:
        return None
    form = closed_form(spans)
    count = int(form.counts(spans.number[np.newaxis], np.sqrt(limit))[0])
    return None if count < 0 else count
