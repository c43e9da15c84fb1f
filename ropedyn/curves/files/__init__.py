"""Files of curves: universal files and text in columns, and what both hold."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from ...base.array import Complex, Real


class Content(NamedTuple):
    """Responses in SI, as they are read and written."""

    frequency: Real  # (f,) [Hz]
    value: Complex  # (responses, f) of what is read, (drives, responses, f) of what is written
    drive: Sequence[Any]  # points; of what is read one alone
    response: Sequence[Any]
    quantity: str
    coherence: Real | None = None  # (responses, f)
    averages: float | None = None
    std: Real | None = None  # (responses, f) of real and imaginary part
    decay: float = 0.0  # the value is the response at i omega + decay [1/s]
    notes: Sequence[str] = ()
