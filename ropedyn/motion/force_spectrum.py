"""Fourier transforms of forces over a record, exact where their functions of time are known."""

from __future__ import annotations

import numpy as np

from ..base.array import Complex, Real
from ..scene.force import Chirp, Force, Samples, Sum
from .modal import chirp
from .modal.convolution import SinePiece, pieces
from .modal.exponentials import ramp


def transform(force: Force, omega: Real, begin: float, end: float) -> Complex:
    """Return the integral of force e^(-i omega t) from begin to end, shape of omega [N s].

    Of samples omega must be that of lines of the record, or of such as fold into them.
    """
    if isinstance(force, Sum):
        return np.asarray(sum(transform(one, omega, begin, end) for one in force.forces))
    if isinstance(force, Samples):
        return _of_samples(force, omega, begin, end)
    if isinstance(force, Chirp):
        s = np.asarray(1j * omega)
        return np.exp(-s * begin) * chirp.transform(force, s, begin, end)
    return _of_sines(pieces(force, begin), omega, end)


def _of_sines(turns: list[SinePiece], omega: Real, end: float) -> Complex:
    """Transform pieces of sines, each until the next one."""
    total = np.zeros(omega.shape, dtype=np.complex128)
    for piece, last in zip(turns, [*(one.start for one in turns[1:]), end]):
        w, now, until = piece.frequency, piece.start, min(last, end)
        if now <= end:
            total += piece.kick * np.exp(-1j * omega * now)
        half = (piece.cosine - 1j * piece.sine) / 2 * np.exp(-1j * w * now)
        total += half * _turning(w - omega, now, until)
        total += np.conj(half) * _turning(-w - omega, now, until)
    return total


def _turning(rate: Real, begin: float, end: float) -> Complex:
    """Return the integral of e^(i rate t) from begin to end, 0 where the end is before."""
    length = max(end - begin, 0.0)
    wave = np.exp(0.5j * rate * (begin + end))
    return np.asarray(length * np.sinc(rate * length / (2 * np.pi)) * wave)


def _of_samples(force: Samples, omega: Real, begin: float, end: float) -> Complex:
    """Each sample stands for a hat, h sinc^2(omega h/2) e^(-i omega t), those at the ends half."""
    time, sample = force.time, force.sample
    h = (end - begin) / (len(time) - 1)
    line = np.rint(omega * h / (2 * np.pi) * len(sample)).astype(int) % len(sample)
    hats = np.fft.fft(sample)[line] * np.sinc(omega * h / (2 * np.pi)) ** 2
    hats *= np.exp(-1j * omega * begin)
    turn = np.asarray(1j * omega * h, dtype=np.complex128)
    hats -= sample[0] * ramp(turn) * np.exp(-1j * omega * begin)
    hats -= sample[-1] * ramp(-turn) * np.exp(-1j * omega * end)
    return np.asarray(h * hats)
