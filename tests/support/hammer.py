"""Records of a hammer: a held rope of known modes, hit by smooth pulses, by its own forward model.

Each mode is an oscillator of given frequency and damping; its motion under a force that is straight
between samples of sixteen times the rate is exact (first order hold), so that the record is right
to (pi f/16 rate)^2/3. Both channels then go through the same filter against aliases.
"""

import dataclasses
import functools
import types

import numpy as np
from scipy import signal

FINER = 16


@dataclasses.dataclass(frozen=True)
class HeldString:
    """A string of 1 m and 1 kg: as many modes as asked for, and the static rest of the others."""

    count: int
    first: float  # [Hz]
    ratio: float | tuple[float, ...]  # of damping, of all or of each
    drive: float
    response: tuple[float, ...]

    @property
    def modes(self):
        """Frequencies [rad/s], ratios, residues, and the rest."""
        n = np.arange(1, self.count + 1)
        response = np.array(self.response)
        shape = 2 * np.sin(n * np.pi * self.drive) * np.sin(np.outer(response, n * np.pi))
        own = 2 * np.pi * self.first * n
        low, high = np.minimum(self.drive, response), np.maximum(self.drive, response)
        static = low * (1 - high) / (2 * self.first) ** 2
        rest = static - (shape / own**2).sum(axis=1)
        return own, np.broadcast_to(self.ratio, self.count), shape, rest


def exact_receptance(string, s):
    """Motion per force at complex s, (responses, lines)."""
    own, ratio, shape, rest = string.modes
    below = own**2 + 2 * ratio * own * s[:, None] + s[:, None] ** 2
    return shape @ (1 / below).T + rest[:, None]


def pulses(time, hits, width):
    """A force of hits (when it begins, how strong, N) that are squares of half a sine."""
    force = np.zeros(len(time))
    for begin, peak in hits:
        inside = (time >= begin) & (time < begin + width)
        force[inside] += peak * np.sin(np.pi * (time[inside] - begin) / width) ** 2
    return force


def motion(string, force, rate, quantity):
    """Motion under a finely sampled force, (responses, t), of this quantity."""
    own, ratio, shape, rest = string.modes
    row = ("displacement", "velocity", "acceleration").index(quantity)
    changes = force
    for _ in range(row):
        changes = np.gradient(changes, 1 / rate)
    value = np.outer(rest, changes)
    for w, zeta, residue in zip(own, ratio, shape.T):
        A, B = np.array([[0, 1], [-w * w, -2 * zeta * w]]), np.array([[0], [1]])
        C = np.vstack([np.eye(2), A[1]])[row]
        D = float(row == 2)
        a, b, c, d, _ = signal.cont2discrete((A, B, C[None], [[D]]), 1 / rate, method="foh")
        top, below = signal.ss2tf(a, b, c, d)
        value += np.outer(residue, signal.lfilter(top[0], below, force))
    return value


@functools.lru_cache(maxsize=16)
def _made(string, rate, duration, hits, width, quantity):
    fine = np.arange(int(duration * rate) * FINER) / (rate * FINER)
    return _sampled(string, pulses(fine, hits, width), rate, quantity)


def _sampled(string, push, rate, quantity):
    """Force and motion at the rate of the record."""
    value = motion(string, push, rate * FINER, quantity)
    return tuple(signal.resample_poly(one, 1, FINER, axis=-1) for one in (push, value))


def record(
    string,
    *,
    hits=(),
    rate=512.0,
    duration=40.0,
    width=0.02,
    quantity="acceleration",
    noise=0.0,
    force_noise=0.0,
    seed=0,
    force=None,
):
    """A record as `measured_response` takes it; noise in parts of the rms of each response."""
    if force is None:
        push, value = (one.copy() for one in _made(string, rate, duration, hits, width, quantity))
    else:
        push, value = _sampled(string, force(int(duration * rate) * FINER), rate, quantity)
    rng = np.random.default_rng(seed)
    value += noise * value.std(axis=1, keepdims=True) * rng.standard_normal(value.shape)
    push += force_noise * np.abs(push).max() * rng.standard_normal(len(push))
    return types.SimpleNamespace(
        rate=rate,
        time=np.arange(len(push)) / rate,
        value=value,
        response=tuple(("z", x) for x in string.response),
        quantity=quantity,
        force=push,
        drive=(("z", string.drive),),
        notes=(),
    )
