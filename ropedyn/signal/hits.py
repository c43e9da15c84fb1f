"""Hits with a hammer: where they are in a force, which can be used, and the response they tell.

Each record begins before its hit, and force and motion both get exp(-decay t) from there on: their
ratio is the response at i omega + decay, whatever the decay, so that nothing has to be taken off a
damping that was identified at the same complex frequency.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Flags, Index, Real
from .leak import PARTS, Leak, carried, lacking
from .transfer import ESTIMATORS, Spectra, coherence_of, forced

BRIEF = 0.1  # Hits are seen, at a tenth of the largest, for less than this share of the time.
STANDING = 10.0  # A pulse stands out of the noise by so many of its standard deviations,
FAINT = 0.02  # and is at least this part of the largest.
RINGING = 16  # A filter against aliases makes a pulse ring for so many samples at least.
WEAK = 0.1  # A hit has at least this part of the median one.
REBOUND = 1.0  # Pulses closer than this are one hit [s],
AMONG = 0.25  # if they are closer than this part of the longest pause as well.
EVEN = 0.5  # A record that is shorter than this part of the median one is cut.
LAST = 1e-3  # The decay that is chosen leaves this part of the motion behind a record.
SAID = 0.01  # More than this part of the motion that a record lacks, or has too much, is said.
NEIGHBOURS = 9  # The scatter of so many lines is averaged.
EDGES = 0.25  # A flat top has so many samples beside it at most, in parts of its own.
FLAT = 3  # So many samples one after the other on the extreme of a channel are clipped.


class Pulse(NamedTuple):
    """One blow."""

    start: int  # first sample
    stop: int  # behind the last one
    peak: float  # largest force [N]


class Hit(NamedTuple):
    """One record: from the first pulse to before the next hit."""

    start: int  # first sample, shortly before the pulse
    pulses: tuple[Pulse, ...]
    reason: str  # why it cannot be used; empty where it can


class Hits(NamedTuple):
    """What was found in a record over time."""

    length: int  # of each record, samples
    each: tuple[Hit, ...]

    @property
    def used(self) -> list[Hit]:
        """Those that can be used."""
        return [hit for hit in self.each if not hit.reason]


class FromHits(NamedTuple):
    """Responses per force."""

    frequency: Real  # (f,) [Hz]
    value: Complex  # (responses, f) at i omega + decay
    coherence: Real | None  # (responses, f), of several hits
    std: Real | None  # (responses, f) of either part, of several hits
    decay: float  # [1/s]
    behind: float  # part of the motion that comes behind the records, with the window
    before: float  # part of the motion that the rope has when it is hit


# --- where they are ------------------------------------------------------------------------------


def is_of_hits(force: Real) -> bool:
    """Whether a force acts for so small a share of the time that it is one of hits."""
    size = np.abs(force - np.median(force))
    return bool(size.max(initial=0.0) > 0 and (size > BRIEF * size.max()).mean() < BRIEF)


def find_hits(rate: float, force: Real, value: Real, length: int | None) -> Hits:
    """Find hits in a force (t,) and say which of them the motion (responses, t) can be used of."""
    pulses = find_pulses(force)
    if not pulses:
        return Hits(0, ())
    groups = _grouped(pulses, len(force), rate, length)
    start = [max(group[0].start - _beside(group[0]), 0) for group in groups]
    room = np.diff(np.append(start, len(force)))
    if length is None:
        length = int(room[room >= EVEN * np.median(room)].min())
    median = float(np.median([_strongest(group) for group in groups]))
    flat = np.stack([clipped(channel) for channel in (force, *value)])
    hits = []
    for first, group, there in zip(start, groups, room.tolist()):
        reason = _too_short(there, length, first + there == len(force), rate)
        reason = reason or _too_weak(_strongest(group), median)
        reason = reason or _overloaded(flat, group, slice(first, first + length))
        hits.append(Hit(first, tuple(group), reason))
    return Hits(length, tuple(hits))


def find_pulses(force: Real) -> list[Pulse]:
    """Find the blows of a force of either sign with an offset."""
    from scipy.ndimage import find_objects, label
    from scipy.stats import median_abs_deviation

    push = force - np.median(force)
    push *= np.sign(push[np.abs(push).argmax()])
    noise = float(median_abs_deviation(push, scale="normal"))
    marked, _ = label(push > max(FAINT * push.max(), STANDING * noise))
    spans = [(one[0].start, one[0].stop) for one in find_objects(marked)]
    joined: list[tuple[int, int]] = []
    for start, stop in spans:
        # what a filter makes ring after a blow belongs to it
        if joined and start - joined[-1][1] <= joined[-1][1] - joined[-1][0]:
            joined[-1] = joined[-1][0], stop
        else:
            joined.append((start, stop))
    return [Pulse(a, b, float(push[a:b].max())) for a, b in joined]


def _grouped(
    pulses: Sequence[Pulse], samples: int, rate: float, length: int | None
) -> list[list[Pulse]]:
    """Put the pulses of one hit together."""
    if length is None:
        starts = [pulse.start for pulse in pulses]
        pause = int(np.diff([*starts, samples]).max())
        near = min(AMONG * pause, REBOUND * rate)
    groups: list[list[Pulse]] = []
    for pulse in pulses:
        if groups:
            since = groups[-1][0].start if length is not None else groups[-1][-1].start
            if pulse.start - since < (near if length is None else length):
                groups[-1].append(pulse)
                continue
        groups.append([pulse])
    return groups


def _beside(pulse: Pulse) -> int:
    """Return how far a filter may make a pulse ring to both sides, samples."""
    return max(RINGING, pulse.stop - pulse.start)


def _strongest(group: Sequence[Pulse]) -> float:
    return max(pulse.peak for pulse in group)


# --- which can be used ---------------------------------------------------------------------------


def _too_short(room: int, length: int, is_last: bool, rate: float) -> str:
    if room >= length:
        return ""
    end = "the record ends" if is_last else "the next hit comes"
    return f"its response is cut: {end} after {room / rate:.3g} of {length / rate:.3g} s"


def _too_weak(peak: float, median: float) -> str:
    if peak >= WEAK * median:
        return ""
    return f"it has no force: {peak:.3g} N, a median hit {median:.3g} N"


def _overloaded(flat: Flags, group: Sequence[Pulse], part: slice) -> str:
    """Say which channel is clipped, of the force and each response, (1 + responses, t)."""
    # a force that is nothing between hits lies on its least there
    if any(flat[0, pulse.start : pulse.stop].any() for pulse in group):
        return "its force is clipped"
    over = np.flatnonzero(flat[1:, part].any(axis=1))
    return f"response {over[0]} is clipped" if len(over) else ""


def clipped(channel: Real) -> Flags:
    """Return which samples lie on the extreme of the channel, several in a row, (t,)."""
    # a rounded top on the last step of a converter is as wide again by 0.7 two steps lower, where
    # one that is cut has its edges
    from scipy.ndimage import find_objects, label

    found = np.zeros(len(channel), dtype=np.bool_)
    steps = np.abs(np.diff(channel))
    step = steps[steps > 0].min(initial=np.inf)
    for extreme in (channel.max(), channel.min()):
        near, _ = label(np.abs(channel - extreme) <= 2 * step)
        for (run,) in find_objects(near):
            on = channel[run] == extreme
            if on.sum() >= FLAT and on.size < (1 + EDGES) * on.sum():
                found[run] = on
    return found


# --- what they tell ------------------------------------------------------------------------------


def response_of_hits(
    rate: float,
    force: Real,
    value: Real,
    hits: Hits,
    *,
    estimator: str,
    decay: float | None,
    gate: bool,
) -> FromHits:
    """Estimate responses (responses, t) per force from the hits that can be used."""
    used, n = hits.used, hits.length
    push = np.stack([_push(force, hit, n, gate) for hit in used])
    rest = value - _offset(value, used, n)
    moved = np.stack([rest[:, hit.start : hit.start + n] for hit in used])
    F = np.fft.rfft(push)
    lines = np.flatnonzero(forced((np.abs(F) ** 2).sum(axis=0)))
    lines = lines[lines > 0]
    behind = lacking(F, moved, lines)
    before = carried(F, moved, [rest[:, : hit.start] for hit in used], lines)
    if decay is None:
        decay = float(np.log(max(behind.share, LAST) / LAST)) * rate / n
    each = _spectra(push, moved, np.exp(-decay * np.arange(n) / rate), lines)
    whole = each.total
    less = float(np.exp(-decay * n / rate))
    behind = Leak(less * behind.share, less * behind.size)
    several = len(used) > 1
    std = jackknifed(each, estimator, alike(decay * n / rate)) if several else None
    return FromHits(
        frequency=np.asarray(lines * (rate / n), dtype=np.float64),
        value=ESTIMATORS[estimator](whole),
        coherence=coherence_of(whole) if several else None,
        std=None if std is None else _widened(std, behind, before),
        decay=decay,
        behind=behind.share,
        before=before.share,
    )


def _widened(std: Real, *cuts: Leak) -> Real:
    """Add what is alike in all hits, which do not scatter by it, where it is not small."""
    square = std**2
    for cut in cuts:
        if cut.share > SAID:
            square = square + cut.size**2 / 2
    return np.asarray(np.sqrt(square))


def alike(long: float) -> float:
    """Return how many lines count as one, for a window e^(-d t) that is `long`, d T."""
    # noise times e^(-d t) over T, with lines 1/T apart, is correlated by 1/(1 + i k pi/d T) between
    # lines k apart: the sum of the real parts over all k is d T coth d T
    return 1.0 if long == 0 else long / float(np.tanh(long))


def _offset(value: Real, used: Sequence[Hit], n: int) -> Real:
    """Return the mean before hits, where the rope rests, (responses, 1)."""
    parts = [value[:, max(0, hit.start - n // PARTS) : hit.start] for hit in used]
    before = np.concatenate(parts, axis=1)
    return np.asarray((before if before.size else value).mean(axis=1, keepdims=True))


def _spectra(push: Real, moved: Real, window: Real, lines: Index) -> Spectra:
    """Return those of each hit with a window on force and motion."""
    F, X = np.fft.rfft(push * window)[:, lines], np.fft.rfft(moved * window)[..., lines]
    return Spectra(np.abs(F) ** 2, F.conj()[:, None] * X, np.abs(X) ** 2)


def _push(force: Real, hit: Hit, n: int, gate: bool) -> Real:
    """Return the force of a hit without its offset, and gated without all but its pulses."""
    push = np.asarray(force[hit.start : hit.start + n], dtype=np.float64)
    acts = np.zeros(n, dtype=np.bool_)
    for pulse in hit.pulses:
        first = max(pulse.start - hit.start - _beside(pulse), 0)
        acts[first : pulse.stop - hit.start + _beside(pulse)] = True
    push = push - (np.median(push[~acts]) if not acts.all() else 0.0)
    return np.where(acts, push, 0.0) if gate else push


def jackknifed(each: Spectra, estimator: str, alike: float) -> Real:
    """Return the standard uncertainty of either part of a response over hits, (responses, f).

    It is that of the jackknife, its square averaged over neighbouring lines, so many of which are
    alike, and widened so that two of it are what Student's t says for so few.
    """
    # B. Efron, R. Tibshirani, An Introduction to the Bootstrap (1993), 11.5. Noise over force is
    # smooth; without the mean, lines whose few hits agree by chance would decide a fit
    from scipy.ndimage import uniform_filter1d
    from scipy.special import ndtri, stdtrit

    n, whole = len(each.force), each.total
    others = Spectra(whole.force - each.force, whole.cross - each.cross, whole.motion - each.motion)
    left = ESTIMATORS[estimator](others)
    square = np.sum(np.abs(left - left.mean(axis=0)) ** 2, axis=0) * (n - 1) / n
    square = uniform_filter1d(square, NEIGHBOURS, axis=1, mode="nearest")
    freedom = 2 * (n - 1) * max(1.0, NEIGHBOURS / alike)
    wider = stdtrit(freedom, 0.975) / ndtri(0.975)
    return np.asarray(wider * np.sqrt(square / 2))
