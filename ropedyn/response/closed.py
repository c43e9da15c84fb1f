"""Responses of spans in closed form; see csrc/closed/response.h."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Complex, Flags, Real
from ..base.check import NEAR
from ..chain.chain import Chain, roles
from ..chain.port import Point
from ..chain.spans import spans_of
from ..eigen.closed import ClosedSpans, closed_form

SLICE = 1 << 17  # So many lines of a row are solved in one call of the core: a look for Ctrl-C.


class Lines(NamedTuple):
    """Responses of rows, where they are certain."""

    value: Complex  # (rows, drives, responses, f)
    error: Real  # relative, as value
    certain: Flags  # (rows, f)


def closed_response(
    form: ClosedSpans,
    chain: Chain,
    number: Real,
    factor: Complex,
    points: tuple[Sequence[Point], Sequence[Point]],
) -> Lines | None:
    """Compute the responses of rows of numbers, None where what is asked has no closed form.

    Of `chain` only the damping counts, which all rows have; `points` are the drives and responses.
    """
    asked = [*points[0], *points[1]]
    if (
        form.taken is None
        or form.kind != "bent"
        or chain.damping is not None
        or set(roles([p[0] for p in asked])) != {"z"}
    ):
        return None
    drag = 0.0 if chain.drag is None else float(chain.drag[0, 0])
    own = number[:, form.taken]
    at = [np.array([p[1] for p in some]) for some in points]
    parts = [
        _core.closed_response(own, np.ascontiguousarray(factor[:, k : k + SLICE]), drag, *at)
        for k in range(0, max(factor.shape[1], 1), SLICE)
    ]
    found = Lines(*(np.concatenate(part, axis=-1) for part in zip(*parts)))
    # at an end that is held the answer is 0, and beside the rope none
    length = own[:, :1]
    x = np.concatenate(at)
    inside: Any = ((x > NEAR * length) & (x < length - NEAR * length)).all(axis=1, keepdims=True)
    return found._replace(certain=found.certain & inside)


def closed_lines(
    chain: Chain, factor: Complex, drives: Sequence[Point], responses: Sequence[Point]
) -> Lines | None:
    """Compute the responses of a chain, None where it or what is asked has no closed form."""
    spans = spans_of(chain.undamped)
    if spans is None:
        return None
    form = closed_form(spans)
    points = drives, responses
    return closed_response(form, chain, spans.number[np.newaxis], factor, points)
