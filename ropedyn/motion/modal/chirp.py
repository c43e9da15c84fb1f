"""Modes under a force whose frequency grows or falls steadily."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...scene.force import Chirp
from .exponentials import SLICE, Oscillators, invert, rates, unity

STEADY = 1e-17  # Up to this growth of the frequency [rad/s^2] times time^2 a chirp is a sine.
SMOOTH = 4.0  # Up to this change of the exponent a rule of Gauss has all digits.
NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)


class Chirping(NamedTuple):
    """amplitude sin(phase + frequency t + growth t^2/2), t since the motion began."""

    amplitude: float  # [N]
    phase: float  # [rad]
    frequency: float  # [rad/s]
    growth: float  # [rad/s^2]
    span: float  # How long it is asked for [s]

    def value(self, t: Real, order: int) -> Real:
        """Return it at times [s], `order` times differentiated."""
        angle = self.phase + (self.frequency + self.growth * t / 2) * t
        w = self.frequency + self.growth * t
        if order == 0:
            wave = np.sin(angle)
        elif order == 1:
            wave = w * np.cos(angle)
        else:
            wave = self.growth * np.cos(angle) - w**2 * np.sin(angle)
        return np.asarray(self.amplitude * wave)


def chirp_between(force: Chirp, begin: float, end: float) -> Chirping:
    """Return a chirp as it is between two times."""
    rate = (force.stop - force.start) / force.duration
    angle = 2 * math.pi * (force.start + rate * begin / 2) * begin + force.phase
    w = 2 * math.pi * (force.start + rate * begin)
    return Chirping(force.amplitude, angle, w, 2 * math.pi * rate, end - begin)


def transform(force: Chirp, s: Complex, begin: float, end: float) -> Complex:
    """Return the integral of a chirp times e^(-s (t - begin)) between two times."""
    span = min(end, force.duration) - begin
    if span <= 0:
        return np.zeros(len(s), dtype=np.complex128)
    # what it does to a motion e^(s t) by its end, undone
    moved = follow(s, chirp_between(force, begin, begin + span), np.array([span]))[:, 0]
    return np.asarray(np.exp(-s * span) * moved)


def under_chirp(
    modes: Oscillators, rest: Real, force: Chirping, t: Real, order: int
) -> tuple[Real, Real, Real]:
    """Return the responses at times since the motion began, and q and q' at the end."""
    value = rest * force.value(t, order)
    terms = invert(rates(modes.sigma, modes.square), unity, force.span)
    seen = modes
    for k in range(order):
        seen, direct = seen.derivative()
        value = value + direct[:, None] * force.value(t, order - 1 - k)
    weight = (seen.a[:, terms.mode] + seen.b[:, terms.mode] * terms.rate) * terms.weight
    step = max(1, SLICE // max(1, len(terms.rate)))
    for first in range(0, len(t), step):
        now = slice(first, first + step)
        wave = follow(terms.rate, force, t[now])
        value[:, now] += weight.real @ wave.real - weight.imag @ wave.imag
    end = terms.weight * follow(terms.rate, force, np.array([force.span]))[:, 0]
    return value, *terms.state(end, len(modes.sigma))


def follow(rate: Complex, force: Chirping, t: Real) -> Complex:
    """Return the integral of e^(rate (t - s)) force(s) from 0 to t, shape (j, t)."""
    one = _follow_turning(rate, force, t)
    turns = rate.imag != 0
    other = one.copy()
    other[turns] = _follow_turning(np.conj(rate[turns]), force, t)
    return force.amplitude * (one - np.conj(other)) / 2j


def _follow_turning(rate: Complex, force: Chirping, t: Real) -> Complex:
    """Return the same under e^(i angle)."""
    if force.growth < 0:
        w, c = -force.frequency, -force.growth
        mirrored = force._replace(phase=-force.phase, frequency=w, growth=c)
        return np.conj(_follow_turning(np.conj(rate), mirrored, t))
    turning = np.empty((len(rate), len(t)), dtype=complex)
    change = (np.abs(1j * force.frequency - rate) + force.growth * force.span) * force.span
    smooth = change < SMOOTH
    turning[smooth] = _by_gauss(rate[smooth, None], force, t)
    by = _by_sine if force.growth * force.span**2 < STEADY else _by_faddeeva
    turning[~smooth] = by(rate[~smooth, None], force, t)
    return turning * np.exp(1j * force.phase)


def _by_gauss(s: Complex, force: Chirping, t: Real) -> Complex:
    total = np.zeros((len(s), len(t)), dtype=np.complex128)
    for x, weight in zip((NODES + 1) / 2, WEIGHTS / 2) if len(s) else ():
        angle = (force.frequency + force.growth * x * t / 2) * x * t
        total += weight * np.exp(s * ((1 - x) * t) + 1j * angle)
    return total * t


def _by_sine(s: Complex, force: Chirping, t: Real) -> Complex:
    turn = 1j * force.frequency
    return np.asarray((np.exp(turn * t) - np.exp(s * t)) / (turn - s))


def _by_faddeeva(s: Complex, force: Chirping, t: Real) -> Complex:
    """Integrate by Faddeeva's function w, with z = kappa (t + (frequency + i s)/growth).

        sqrt(pi)/(2 kappa) (e^(s t) w(i z_0) - e^(i angle) w(i z) + 2 e^(s t + z_0^2) if passed),
        kappa^2 = -i growth/2,

    where w(i z) is -w(-i z) with Re z < 0, and passed says that the sign of Re z has changed: the
    frequency has been at the mode's. So no term is larger than the motion may be.
    """
    kappa = math.sqrt(force.growth / 2) * np.exp(-0.25j * math.pi)
    apart = force.frequency + 1j * s
    z0, z = kappa * apart / force.growth, kappa * (t + apart / force.growth)
    angle = (force.frequency + force.growth * t / 2) * t
    turning = np.exp(s * t) * _signed(z0) - np.exp(1j * angle) * _signed(z)
    passed = (z0.real < 0) & (z.real >= 0)
    late = s * t - 0.5j * apart**2 / force.growth
    turning[passed] += 2 * np.exp(late[passed])
    return np.asarray(math.sqrt(math.pi) / 2 / kappa * turning)


def _signed(z: Complex) -> Complex:
    from scipy.special import wofz

    sign = np.where(z.real < 0, -1.0, 1.0)
    return np.asarray(sign * wofz(1j * sign * z), dtype=np.complex128)
