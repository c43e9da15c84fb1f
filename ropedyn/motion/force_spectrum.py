"""Fourier transforms of forces over a record, exact where their functions of time are known."""

from __future__ import annotations

import math
from functools import singledispatch

import numpy as np

from ..base.array import Complex, Real
from ..scene.force import Chirp, Force, Impulse, Samples, Sine, Step, Sum
from .modal.chirp import chirp_between, follow
from .modal.exponentials import ramp


@singledispatch
def transform(force: Force, omega: Real, begin: float, end: float) -> Complex:
    """Return the integral of force e^(-i omega t) from begin to end, shape of omega [N s]."""
    raise NotImplementedError(f"no transform of a {type(force).__name__}")


def _turning(rate: Real, begin: float, end: float) -> Complex:
    """Return the integral of e^(i rate t) from begin to end, 0 where the end is before."""
    length = max(end - begin, 0.0)
    wave = np.exp(0.5j * rate * (begin + end))
    return np.asarray(length * np.sinc(rate * length / (2 * np.pi)) * wave)


def _sine(
    amplitude: float, frequency: float, phase: float, omega: Real, *, begin: float, end: float
) -> Complex:
    """Transform amplitude sin(frequency t + phase), frequency in rad/s, between two times."""
    one = np.exp(1j * phase) * _turning(frequency - omega, begin, end)
    other = np.exp(-1j * phase) * _turning(-frequency - omega, begin, end)
    return np.asarray(amplitude / 2j * (one - other))


@transform.register
def _(force: Sine, omega: Real, begin: float, end: float) -> Complex:
    w = 2 * math.pi * force.frequency
    return _sine(force.amplitude, w, force.phase, omega, begin=begin, end=end)


@transform.register
def _(force: Step, omega: Real, begin: float, end: float) -> Complex:
    return np.asarray(force.amplitude * _turning(-omega, max(begin, force.time), end))


@transform.register
def _(force: Impulse, omega: Real, begin: float, end: float) -> Complex:
    if force.duration == 0:
        acts = begin <= force.time <= end
        return np.asarray(force.impulse * acts * np.exp(-1j * omega * force.time))
    w = math.pi / force.duration
    first, last = max(begin, force.time), min(end, force.time + force.duration)
    return _sine(force.amplitude, w, -w * force.time, omega, begin=first, end=last)


@transform.register
def _(force: Chirp, omega: Real, begin: float, end: float) -> Complex:
    last = min(end, force.duration)
    if last <= begin:
        return np.zeros(omega.shape, dtype=np.complex128)
    chirp = chirp_between(force, begin, last)
    if chirp.is_steady:
        phase = chirp.phase - chirp.frequency * begin
        wave = chirp.amplitude, chirp.frequency, phase
        return _sine(*wave, omega, begin=begin, end=last)
    # the motion of a pole at i omega at the end, turned back to t = 0
    moved = follow(np.asarray(1j * omega), chirp, np.array([last - begin]))[:, 0]
    return np.asarray(np.exp(-1j * omega * last) * moved)


@transform.register
def _(force: Samples, omega: Real, begin: float, end: float) -> Complex:
    """Each sample stands for a hat, h sinc^2(omega h/2) e^(-i omega t), those at the ends half.

    omega must be that of the lines of the record.
    """
    time, sample = force.time, force.sample
    h = (end - begin) / (len(time) - 1)
    hats = np.fft.rfft(sample) * np.sinc(omega * h / (2 * np.pi)) ** 2
    hats *= np.exp(-1j * omega * begin)
    turn = np.asarray(1j * omega * h, dtype=np.complex128)
    hats -= sample[0] * ramp(turn) * np.exp(-1j * omega * begin)
    hats -= sample[-1] * ramp(-turn) * np.exp(-1j * omega * end)
    return np.asarray(h * hats)


@transform.register
def _(force: Sum, omega: Real, begin: float, end: float) -> Complex:
    return np.asarray(sum(transform(one, omega, begin, end) for one in force.forces))
