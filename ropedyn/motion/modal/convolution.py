"""Motion of a sum over modes that forces cause, without steps."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.errors import SceneError, SolveError
from ...scene.force import Chirp, Force, Impulse, Samples, Sine, Step, Sum, rotation
from .chirp import chirp_between, under_chirp
from .expansion import Expansion
from .exponentials import Exponentials, Oscillators, evaluate, invert, rates
from .recurrence import straight_lines

LARGEST = 1e300  # A growing mode may reach this.
SOON = 1e-9  # What lasts for less of the time that is asked for is told as what lasts so long.


def motion_under(
    expansion: Expansion, drive: int, given: Force | float, time: Real, order: int
) -> Real:
    """Return what a force moves, or the motion after a static load [N, N m] is let go."""
    if isinstance(given, float):
        return release(expansion, drive, given, time, order)
    return convolve(expansion, drive, given, time, order)


def convolve(expansion: Expansion, drive: int, force: Force, time: Real, order: int) -> Real:
    """Return what one force moves, from rest at the first time, shape (responses, t)."""
    # what the force did before the first time is not felt, and nothing is sampled: sines, steps and
    # blows are exponentials, chirps have Faddeeva's function, straight lines an exact recurrence.
    # Where something jumps, it is the value from the right.
    if isinstance(force, Sum):
        still = np.zeros((len(expansion.rest[drive]), len(time)))
        return sum((convolve(expansion, drive, one, time, order) for one in force.forces), still)
    modes = _oscillators(expansion, drive)
    rest = expansion.rest[drive][:, None]
    with np.errstate(all="ignore"):  # numbers that are not finite are refused at the end
        if isinstance(force, Chirp):
            value = _chirp(modes, rest, force, time, order)
        elif isinstance(force, Samples):
            value = straight_lines(modes, rest, force, time, order)
        else:
            value = _sines(modes, rest, pieces(force, float(time[0])), time, order)
    return refuse_infinite(value, time)


def release(expansion: Expansion, drive: int, load: float, time: Real, order: int) -> Real:
    """Return the motion after a static load is let go at the first time, shape (responses, t)."""
    modes = _oscillators(expansion, drive)
    growing = modes.square <= 0
    if (growing & ((modes.a != 0) | (modes.b != 0)).any(axis=0)).any():
        raise SceneError("start must be None where the rope has no rest under a load")
    rest = load * np.divide(1.0, modes.square, out=np.zeros_like(modes.square), where=~growing)
    with np.errstate(all="ignore"):  # as above
        state, span = (rest, np.zeros_like(rest)), float(time[-1] - time[0])
        terms = _motion(modes, SinePiece(time[0]), state, span, order)
        value = evaluate(terms.rate, _seen(modes, terms), time - time[0])
    return refuse_infinite(value, time)


def _oscillators(expansion: Expansion, drive: int) -> Oscillators:
    """Return the modes that a drive moves; late/(1 + lag s) is late (1 + lag s)/(1 + lag s)^2."""
    sigma, square, a, b = *expansion[:2], expansion.a[drive], expansion.b[drive]
    if not expansion.lag:
        return Oscillators(sigma, square, a, b)
    rate, late = 1 / expansion.lag, expansion.late[drive, :, None]
    one, other = np.append(a, late * rate**2, axis=1), np.append(b, late * rate, axis=1)
    return Oscillators(np.append(sigma, rate), np.append(square, rate**2), one, other)


def refuse_infinite(value: Real, time: Real) -> Real:
    """Refuse what has left the numbers."""
    bad = ~(np.abs(value) <= LARGEST).all(axis=0)
    if bad.any():
        when = float(time[np.argmax(bad)])
        raise SolveError(f"the motion grows beyond {LARGEST:g} until t = {when:g} s")
    return value


def _chirp(modes: Oscillators, rest: Real, force: Chirp, time: Real, order: int) -> Real:
    """Return the responses to a chirp: while it lasts, and free after it."""
    begin, end = float(time[0]), force.duration
    if begin >= end:
        return np.zeros((len(rest), len(time)))
    now = chirp_between(force, begin, min(end, float(time[-1])))
    last = np.searchsorted(time, end)
    value = np.zeros((len(rest), len(time)))
    value[:, :last], q, v = under_chirp(modes, rest, now, time[:last] - begin, order)
    if last < len(time):
        span = max(float(time[-1] - end), SOON * float(time[-1] - begin))
        terms = _motion(modes, SinePiece(end), (q, v), span, order)
        value[:, last:] = evaluate(terms.rate, _seen(modes, terms), time[last:] - end)
    return value


def _sines(modes: Oscillators, rest: Real, turns: list[SinePiece], time: Real, order: int) -> Real:
    """Return the responses to pieces of sines."""
    value = np.zeros((len(rest), len(time)))
    q = v = np.zeros_like(modes.sigma)
    turns = [piece for piece in turns if piece.start <= time[-1]]
    least = SOON * float(time[-1] - time[0])
    for piece, following in zip(turns, [*turns[1:], None]):
        stop = time[-1] if following is None else following.start
        until = len(time) if following is None else np.searchsorted(time, stop)
        now = slice(np.searchsorted(time, piece.start), until)
        v = v + piece.kick
        span = max(float(stop - piece.start), least)
        terms = _motion(modes, piece, (q, v), span, order)
        value[:, now] = evaluate(terms.rate, _seen(modes, terms), time[now] - piece.start)
        if rest.any():
            value[:, now] += rest * piece.value(time[now], order)
        if following is not None:
            terms = _motion(modes, piece, (q, v), span) if order else terms
            last = terms.weight * np.exp(terms.rate * (stop - piece.start))
            q, v = terms.state(last, len(q))
    return value


def _motion(
    modes: Oscillators, piece: SinePiece, state: tuple[Real, Real], span: float, order: int = 0
) -> Exponentials:
    """Return the motion of each mode under a piece from a state, differentiated."""
    q, v = state
    for _ in range(order):  # s^order would lose digits of poles that are told together
        q, v = v, piece.cosine - modes.square * q - 2 * modes.sigma * v
        w, cosine, sine = piece[1:4]
        piece = piece._replace(cosine=w * sine, sine=-w * cosine)
    # Q(s) = ((cosine s + sine w)/(s^2 + w^2) + v + (s + 2 sigma) q)/(s^2 + 2 sigma s + square)
    w = piece.frequency
    acts = piece.cosine != 0 or (piece.sine != 0 and w != 0)
    forced = np.array([] if not acts else [1j * w, -1j * w] if w else [0])
    own = rates(modes.sigma, modes.square)
    poles = np.concatenate([own, np.broadcast_to(forced, (len(own), len(forced)))], axis=1)

    def numerator(s: Complex, k: Index) -> Complex:
        free = v[k] + (s + 2 * modes.sigma[k]) * q[k]
        if not acts:
            return free
        force = piece.cosine * s + piece.sine * w if w else piece.cosine
        return force + free * np.prod(s[:, None] - forced, axis=1)

    return invert(poles, numerator, span)


def _seen(modes: Oscillators, terms: Exponentials) -> Complex:
    """Return the weights of the responses, shape (responses, j)."""
    k = terms.mode
    return (modes.a[:, k] + modes.b[:, k] * terms.rate) * terms.weight


class SinePiece(NamedTuple):
    """A force cosine cos(w (t - start)) + sine sin(w (t - start)) until the next piece."""

    # a blow at its start moves what it hits by `kick`

    start: float  # [s]
    frequency: float = 0.0  # w [rad/s]
    cosine: float = 0.0  # [N]
    sine: float = 0.0  # [N]
    kick: float = 0.0  # [N s]

    def value(self, time: Real, order: int) -> Real:
        """Return the force at times [s], `order` times differentiated."""
        angle = self.frequency * (time - self.start) + order * math.pi / 2
        wave = self.cosine * np.cos(angle) + self.sine * np.sin(angle)
        return np.asarray(np.float64(self.frequency) ** order * wave)


def pieces(force: Force, begin: float) -> list[SinePiece]:
    """Return what acts from a time on, in turn."""
    if isinstance(force, Sine):
        w = 2 * math.pi * force.frequency
        angle = float(rotation(force.frequency, begin, force.phase))
        return [_sine(begin, w, force.amplitude, angle)]
    if isinstance(force, Step):
        return [SinePiece(max(force.time, begin), cosine=force.amplitude)]
    assert isinstance(force, Impulse)
    start, end = max(force.time, begin), force.time + force.duration
    if force.duration == 0:
        return [SinePiece(start, kick=force.impulse)] if force.time >= begin else []
    if end <= begin:
        return []
    w = math.pi / force.duration
    return [_sine(start, w, force.amplitude, w * (start - force.time)), SinePiece(end)]


def felt(force: Force, begin: float, time: Real) -> Real:
    """Return a force as its motion has it: after many turns an ulp of the frequency is seen."""
    if isinstance(force, Sum):
        return np.sum([felt(one, begin, time) for one in force.forces], axis=0)
    if isinstance(force, Sine):
        return pieces(force, begin)[0].value(time, 0)
    return force.value(time)


def _sine(start: float, w: float, amplitude: float, phase: float) -> SinePiece:
    """Return amplitude sin(w (t - start) + phase)."""
    return SinePiece(start, w, amplitude * math.sin(phase), amplitude * math.cos(phase))
