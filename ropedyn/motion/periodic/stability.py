"""Whether periodic motion comes back to itself when it is disturbed.

A disturbance e^(s t) times a motion of the period goes on where

    D(s) = det(I - H(s + i k omega) (r_u + r_v (s + i l omega))^) = 0.

D repeats itself along i omega, tends to 1 far to the right, and has the poles of H. So it has as
many zeros with Re s > 0, 0 <= Im s < omega, as it winds about 0 on the way from s = 0 up to
i omega, backwards, and as many more as the linear scene itself has motions that grow. D(conj s) =
conj D(s): half the way is enough. More harmonics multiply D by a number, which turns nothing, and
move it besides by less than it is all the way, so that it winds as often with all of them (Rouche's
theorem).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...base.array import Complex, Real
from .balance import HarmonicBalance

TURN = 0.5  # D turns by at most so much between neighbours and past their middle [rad].
LOOKS = 17  # At first, beside those where H is known to change.
ROUNDS = 40  # The way is halved so often at most.
CLOSED = 0.05  # D is real at both ends, but for so much [rad]: there are enough harmonics.
FINER = 2  # The slopes of forces are sampled so much closer than the forces.
FEWEST = 8  # Harmonics at first,
MOST = 256  # and at most, or twice those at first.
MOVED = 0.5  # Besides a multiple, twice as many move D by at most so much of it.
BATCH = 1 << 19  # Numbers of matrices that are looked at together.


def growing(
    balance: HarmonicBalance, x: Real, omega: float, free: int, most: int = MOST
) -> int | None:
    """Return how many disturbances grow, None where that cannot be told by so many harmonics.

    The linear scene has `free` of them itself.
    """
    fine = replace(balance, harmonics=FINER * balance.harmonics)
    x = balance.wider(x, fine.harmonics)
    felt = fine.force.felt(*fine.motion(fine.complex(x), omega))
    if not (felt.by_u.any() or felt.by_v.any()):
        return free
    stiff, drag = (np.fft.fft(one, axis=2) / fine.samples for one in (felt.by_u, felt.by_v))
    harmonics = _least(balance, felt.by_u, felt.by_v, omega)
    before, most = None, min(max(most, 2 * harmonics), fine.samples // 4)
    while harmonics <= most:
        strip = _Strip(fine, stiff, drag, omega, harmonics)
        way, D, size = strip.followed()
        turns = float(np.angle(D[1:] / D[:-1]).sum() / np.pi)
        closes = abs(turns - round(turns)) <= CLOSED / np.pi
        if closes and before is not None and _moved(D, size, *before.at(way)) <= MOVED:
            return free - round(turns)
        harmonics, before = 2 * harmonics, strip
    return None


def _moved(D: Complex, size: Real, sign: Complex, other: Real) -> float:
    """Return how far a multiple of that with fewer harmonics is from D, at most, over D."""
    with np.errstate(over="ignore"):
        share = sign / D * np.exp(other - size - np.median(other - size))
    return float(np.abs(1 - share).max())


def _least(balance: HarmonicBalance, by_u: Real, by_v: Real, omega: float) -> int:
    """Return how many harmonics answer to the forces by more than what causes them."""
    k = np.arange(balance.harmonics + 1.0) * omega
    H = np.abs(balance.transfer.at(k)[:, : balance.points, :-1]).max(axis=(1, 2))
    loud = np.flatnonzero(H * (np.abs(by_u).max() + k * np.abs(by_v).max()) > 1)
    return min(balance.harmonics, max(FEWEST, int(loud.max(initial=0)) + 1))


class _Strip:
    """D on the way from 0 to i omega/2."""

    def __init__(
        self, balance: HarmonicBalance, stiff: Complex, drag: Complex, omega: float, harmonics: int
    ) -> None:
        self.balance, self.omega = balance, omega
        self.k = np.arange(-harmonics, harmonics + 1)
        pairs = (self.k[:, None] - self.k) % balance.samples
        # (k, p, l j)
        wide = (len(self.k), len(stiff), -1)
        self.stiff = stiff[..., pairs].transpose(2, 0, 3, 1).reshape(wide)
        self.drag = drag[..., pairs].transpose(2, 0, 3, 1).reshape(wide) if drag.any() else None

    def followed(self) -> tuple[Real, Complex, Real]:
        """Return a way on which D turns little between neighbours, D/|D| and ln |D| there."""
        way = self._looks()
        D, size = self.at(way)
        for _ in range(ROUNDS):
            step = np.angle(D[1:] / D[:-1])
            open_ = np.abs(step) > TURN
            # a neighbour of what turns is looked at too
            open_[:-1] |= np.abs(step[1:]) > TURN
            open_[1:] |= np.abs(step[:-1]) > TURN
            open_ &= np.diff(way) > 1e-13 * self.omega
            if not open_.any():
                break
            at = np.flatnonzero(open_)
            middle = (way[at] + way[at + 1]) / 2
            sign, own = self.at(middle)
            way = np.insert(way, at + 1, middle)
            D, size = np.insert(D, at + 1, sign), np.insert(size, at + 1, own)
        return way, D, size

    def _looks(self) -> Real:
        """Return where D is looked at first: also beside peaks of H, folded into the strip.

        A peak leads D around a circle that begins and ends at one place, and is opposite to it.
        """
        half = self.omega / 2
        peak = self.balance.transfer.peaks()
        peak = peak[peak <= self.k[-1] * self.omega + half]
        away = np.abs((peak + half) % self.omega - half)
        looks = np.unique(np.concatenate([np.linspace(0.0, half, LOOKS), away]))
        return looks[np.append(True, np.diff(looks) > 1e-12 * half)]

    def at(self, nu: Real) -> tuple[Complex, Real]:
        """Return D/|D| and ln |D| at s = i nu."""
        m, n = self.balance.points, len(self.k)
        most = max(1, BATCH // (m * n) ** 2)
        parts = [self._some(nu[a : a + most]) for a in range(0, len(nu), most)]
        sign, size = (np.concatenate(one) for one in zip(*parts))
        return sign, size

    def _some(self, nu: Real) -> tuple[Complex, Real]:
        m, n = self.balance.points, len(self.k)
        omega = nu[:, None] + self.k * self.omega
        H = self.balance.transfer.at(omega)[..., :m, :-1]
        moved: Complex = H @ self.stiff
        if self.drag is not None:
            moved += (H @ self.drag) * np.repeat(1j * omega, m, axis=1)[:, None, None]
        matrix = np.eye(n * m) - moved.reshape(len(nu), n * m, n * m)
        sign, size = np.linalg.slogdet(matrix)
        return np.where(sign == 0, 1.0, sign), size
