"""The frequency response that a record of force and motion tells."""

from __future__ import annotations

from typing import Any, Protocol

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError
from ...chain.port import Point
from ...signal.estimate import estimate
from ...signal.hits import SAID, FromHits, Hit, Hits, find_hits, is_of_hits, response_of_hits
from ...signal.transfer import ESTIMATORS
from ..measured import Measured

PER_FORCE = {"displacement": "receptance", "velocity": "mobility", "acceleration": "accelerance"}
"""What a motion per force is called."""
SEGMENTS = 16  # A force that acts all the time is averaged over so many segments.
LEAST = 16  # A record of a hit has so many samples at least.


class Recorded(Protocol):
    """What is asked of a record."""

    @property
    def rate(self) -> float:
        """Samples per second [Hz]."""

    @property
    def time(self) -> Real:
        """When the samples were taken, shape (t,) [s]."""

    @property
    def value(self) -> Real:
        """Motion, shape (channels, t)."""

    @property
    def response(self) -> tuple[Point, ...]:
        """Where."""

    @property
    def quantity(self) -> str:
        """Which motion."""

    @property
    def force(self) -> Real | None:
        """Of the drive, shape (t,) [N]."""

    @property
    def drive(self) -> tuple[Point, ...] | None:
        """One point."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What was mended."""


def measured_response(
    record: Recorded,
    *,
    estimator: str = "H1",
    decay: float | None = None,
    gate: bool = True,
    length: float | None = None,
) -> Measured:
    """Estimate the response per force of hits, or of a force that acts all the time."""
    check.one_of(estimator, "estimator", ESTIMATORS)
    check.instance(gate, "gate", bool, "True or False")
    decay = check.optional(decay, "decay", "1/s", sign="nonnegative")
    length = check.optional(length, "length", "s", sign="positive")
    if record.force is None or not record.drive:
        raise SceneError("force must be recorded for a response per force, got a record without")
    if not record.force.any() or float(record.force.min()) == float(record.force.max()):
        raise SceneError("force must act for a response per force, got the same at all times")
    found = (
        _of_hits(record, record.force, length, estimator=estimator, decay=decay, gate=gate)
        if is_of_hits(record.force)
        else _of_noise(record, record.force, estimator, decay, length)
    )
    found["notes"] = (*record.notes, *found["notes"])
    return Measured(
        drive=record.drive, response=record.response, quantity=PER_FORCE[record.quantity], **found
    )


def _of_hits(record: Recorded, force: Real, length: float | None, **how: Any) -> dict[str, Any]:
    rate = record.rate
    samples = None if length is None else round(length * rate)
    if samples is not None and not LEAST <= samples <= len(force):
        raise SceneError(
            f"length must be from {LEAST / rate:g} to {len(force) / rate:g} s, {LEAST} samples to "
            f"the whole record, got {length}"
        )
    hits = find_hits(rate, force, record.value, samples)
    if not hits.used or hits.length < LEAST:
        raise SceneError(
            f"force must have a hit that can be used, got {len(hits.each)}: "
            + ("; ".join(_said(record, hit) for hit in hits.each) or "none out of the noise")
        )
    found = response_of_hits(rate, force, record.value, hits, **how)
    return {
        "frequency": found.frequency,
        "value": found.value,
        "coherence": found.coherence,
        "averages": float(len(hits.used)),
        "std": found.std,
        "decay": found.decay,
        "notes": tuple(_notes(record, hits, found)),
    }


def _said(record: Recorded, hit: Hit) -> str:
    at = float(record.time[hit.pulses[0].start])
    return f"the hit at {at:.4g} s is left out: {hit.reason or 'its record is too short'}"


def _notes(record: Recorded, hits: Hits, found: FromHits) -> list[str]:
    """Say what was left out, what is double, and what the window cuts."""
    notes = [_said(record, hit) for hit in hits.each if hit.reason]
    for hit in hits.used:
        if len(hit.pulses) > 1:
            at = float(record.time[hit.pulses[0].start])
            notes.append(f"the hit at {at:.4g} s has {len(hit.pulses)} pulses, all of them gated")
    if len(hits.used) == 1:
        notes.append("one hit was used: nothing tells its noise, more hits would")
    if found.behind > SAID:
        notes.append(
            f"{found.behind:.1%} of the motion comes behind records of "
            f"{hits.length / record.rate:.3g} s: a longer one or a larger decay would cut less"
        )
    if found.before > SAID:
        notes.append(
            f"the rope still has up to {found.before:.1%} of its motion when it is hit, which is "
            "taken for the hit's: wait longer between hits"
        )
    return notes


def _of_noise(
    record: Recorded, force: Real, estimator: str, decay: float | None, length: float | None
) -> dict[str, Any]:
    if decay:
        raise SceneError(
            f"decay is the window of hits, got {decay} 1/s for a force that acts all the time"
        )
    duration = len(force) / record.rate
    segments = SEGMENTS
    if length is not None:
        if not 2 * LEAST / record.rate <= length <= 2 * duration / 3:
            raise SceneError(
                f"length must be from {2 * LEAST / record.rate:g} to {2 * duration / 3:g} s, two "
                f"segments that half overlap, got {length}"
            )
        segments = max(2, round(2 * duration / length) - 1)
    rest = record.value - record.value.mean(axis=1, keepdims=True)
    found = estimate(
        record.time,
        rest,
        (force - force.mean())[None],
        drive=0,
        segments=segments,
        window="hann",
        band=None,
        at_rest=False,
        estimator=estimator,
    )
    return {**found._asdict(), "notes": ()}
