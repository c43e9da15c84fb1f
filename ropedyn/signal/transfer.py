"""Response per force from averaged spectra of both."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Flags, Real

FLOOR = 1e-3  # Lines where the force is less than this part of its largest line are left out.


class Spectra(NamedTuple):
    """Sums or means over records, conj(F) F and so on; any more axes may stand before f."""

    force: Real  # (.., f)
    cross: Complex  # (.., responses, f) of a response with the force, conj(F) X
    motion: Real  # (.., responses, f)

    @property
    def total(self) -> Spectra:
        """The sum over the first axis."""
        return Spectra(self.force.sum(axis=0), self.cross.sum(axis=0), self.motion.sum(axis=0))


def h1(spectra: Spectra) -> Complex:
    """Noise of the response alone averages out: S_fx/S_ff."""
    return np.asarray(spectra.cross / spectra.force[..., None, :])


def h2(spectra: Spectra) -> Complex:
    """Noise of the force alone averages out: S_xx/S_xf."""
    below = spectra.cross.conj()
    return np.divide(spectra.motion, below, out=np.zeros_like(below), where=below != 0)


def hv(spectra: Spectra) -> Complex:
    """Both have noise in proportion to their size: the geometric mean of H1 and H2."""
    size = np.sqrt(spectra.motion / spectra.force[..., None, :])
    return np.asarray(np.exp(1j * np.angle(spectra.cross)) * size)


ESTIMATORS = {"H1": h1, "H2": h2, "Hv": hv}
"""How responses follow from spectra: J. S. Bendat, A. G. Piersol, Random Data (2010), 9.2."""


def coherence_of(spectra: Spectra) -> Real:
    """Return the share of the motion that follows from the force."""
    power = spectra.force[..., None, :] * spectra.motion
    share = np.divide(np.abs(spectra.cross) ** 2, power, out=np.zeros_like(power), where=power > 0)
    # rounding may lift it above 1
    return np.minimum(share, 1.0)


def forced(power: Real) -> Flags:
    """Return at which lines the force is not small."""
    return np.asarray(power > FLOOR**2 * power.max())
