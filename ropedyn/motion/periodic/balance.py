"""Harmonic balance: the motion of the points alone, at a base frequency omega and its harmonics.

    q_k = H_qd(i k omega) F_k + H_qq(i k omega) r_k(q),   k = 0..K

with r_k the Fourier coefficients of the forces, sampled over a period. Motion is the sum of
q_k e^(i k omega t) over -K..K, q_-k = conj q_k. Unknown are the real numbers Re q_0..K, Im q_1..K.
Several motions at once, each at a frequency, stand in front of all shapes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ... import _core
from ...base.array import Complex, Real
from ...base.computed import computed
from .laws import Felt, PointForces
from .transfer import PanelledTransfer


class Linear(NamedTuple):
    """The balance about a motion, or about several in front of the shapes."""

    gap: Real  # (n,) what is not balanced
    jacobian: Real  # (n, n)
    slope: Real  # (n,) of the gap by the parameter


@dataclass(frozen=True)
class HarmonicBalance:
    """What is balanced: a drive of one amplitude on a scene, harmonics up to K."""

    transfer: PanelledTransfer  # (points and more, points + 1), the drive last
    force: PointForces
    points: int
    harmonics: int  # K
    amplitude: float  # of the drive
    turn: int = 1  # the harmonic that drives

    @computed
    def samples(self) -> int:
        """Of a period."""
        return int(2 ** np.ceil(np.log2(self.force.samples * self.harmonics)))

    @computed
    def order(self) -> Real:
        """The harmonics 0..K."""
        return np.arange(self.harmonics + 1.0)

    def complex(self, x: Real) -> Complex:
        """Return the harmonics, (points, K + 1), of the unknowns."""
        x = x.reshape(*x.shape[:-1], self.points, -1)
        q = x[..., : self.harmonics + 1].astype(np.complex128)
        q[..., 1:] += 1j * x[..., self.harmonics + 1 :]
        return q

    def real(self, q: Complex) -> Real:
        """Return the unknowns, (n,), of harmonics."""
        parts = np.concatenate([q.real, q.imag[..., 1:]], axis=-1)
        return parts.reshape(*parts.shape[:-2], -1)

    def wider(self, x: Real, harmonics: int) -> Real:
        """Return the unknowns of a balance with more harmonics, the new ones 0."""
        q = self.complex(x)
        more = np.zeros((*q.shape[:-1], harmonics + 1), dtype=np.complex128)
        more[..., : q.shape[-1]] = q
        return self.real(more)

    def motion(self, q: Complex, omega: Real | float) -> tuple[Real, Real, Real]:
        """Return the times of a period, and displacement and velocity there."""
        rate = np.asarray(omega)[..., None]
        both = np.stack([q, 1j * (rate * self.order)[..., None, :] * q])
        u, v = np.fft.irfft(both, self.samples, norm="forward")
        return 2 * np.pi / rate * (np.arange(self.samples) / self.samples), u, v

    def coefficients(self, sampled: Real) -> Complex:
        """Return Fourier coefficients 0..K of something over a period."""
        return np.fft.rfft(sampled, norm="forward")[..., : self.harmonics + 1]

    def forces(self, x: Real, omega: Real | float) -> Complex:
        """Return the harmonics of the forces, (points, K + 1)."""
        return self.coefficients(self.force.force(*self.motion(self.complex(x), omega)))

    def driven(self, share: Real | float = 1.0) -> Complex:
        """Return the harmonics of the drive, (K + 1,)."""
        F = np.zeros((*np.shape(share), self.harmonics + 1), dtype=np.complex128)
        F[..., self.turn] = share * self.amplitude / 2
        return F

    def at(self, x: Real, omega: Real | float, share: Real | float = 1.0) -> tuple[Linear, Real]:
        """Return the balance about a motion: slope by omega, and by the share of the drive."""
        q, k, m = self.complex(x), self.order, self.points
        rate = np.asarray(omega)[..., None]
        time, u, v = self.motion(q, omega)
        felt = self.force.felt(time, u, v)
        H, slope = (one[..., :m, :] for one in self.transfer.with_slope(rate * k))
        push = np.empty((*q.shape[:-2], m + 1, len(k)), dtype=np.complex128)
        push[..., :m, :], push[..., m, :] = self.coefficients(felt.force), self.driven(share)
        gap = q - _on(H, push)
        by_omega = -k * _on(slope, push)
        if felt.by_v.any():
            turned = np.einsum("...pjn,...jn->...pn", felt.by_v, v / rate[..., None])
            by_omega -= _on(H[..., :-1], self.coefficients(turned))
        by_share = -H[..., -1].swapaxes(-1, -2) * self.driven()
        linear = Linear(self.real(gap), self._jacobian(H, felt, omega), self.real(by_omega))
        return linear, self.real(by_share)

    def _jacobian(self, H: Complex, felt: Felt, omega: Real | float) -> Real:
        """Return the slope of what is not balanced by the unknowns."""
        m, n = self.points, self.points * (2 * self.harmonics + 1)

        def spectrum(slope: Real) -> Complex:
            return np.fft.rfft(slope, norm="forward").reshape(-1, m, m, self.samples // 2 + 1)

        by_v = spectrum(felt.by_v) if felt.by_v.any() else None
        rate = np.array(omega, dtype=np.float64).ravel()
        found = _core.balance(H.reshape(-1, *H.shape[-3:]), spectrum(felt.by_u), by_v, rate)
        return found.reshape(*np.shape(omega), n, n)


def _on(H: Complex, push: Complex) -> Complex:
    """Return H_k push_k, (points, K + 1)."""
    return np.asarray(np.einsum("...kip,...pk->...ik", H, push))
