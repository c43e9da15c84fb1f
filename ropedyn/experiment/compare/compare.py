"""Calculated against measured peaks, responses and shapes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.answer import Answer, axes
from ...base.array import Complex, Flags, Integer, Real
from ...base.drawing import draw
from ...base.errors import SceneError
from ...base.table import Table, numbers
from ...chain.port import Point
from ...curves.measured import Measured
from ...curves.peaks import Peaks
from ...curves.resonance import Resonances
from ...eigen.modes import Modes
from ...model import Model
from ...response.frf import FRF
from ...signal.likeness import frac, frac_over, mac, residues
from ...space.model import SpaceModel
from .calculated import CalculatedPeaks, calculated_peaks, is_motion
from .cause import likely_cause, tension_alone
from .measured import MeasuredPeaks, measured_peaks
from .numbering import Pairing, Verdict, common_factor, numbered, verdict, weighed
from .pairing import calculated_at, drive_of, paired
from .slips import slips
from .unit_slips import ANGULAR, slips_of_peaks

if TYPE_CHECKING:
    from matplotlib.axes import Axes


BAND = 0.1  # FRAC at each line is taken over this part of the measured range by default.
FEWEST = 10  # That part has so many lines at least.


@dataclass(frozen=True, eq=False)
class Comparison(Answer):
    """Calculated against measured peaks, responses and shapes; made by `compare`.

    Attributes
    ----------
    order : ndarray of int, shape (k,)
        Which calculated peak each measured one is, from 1; 0 where it has no partner. Modes are
        counted without rigid motion and without growth.
    measured, calculated : ndarray, shape (k,)
        [Hz]; calculated is NaN where there is no partner, and so is all that follows from it.
    difference : ndarray, shape (k,)
        (calculated - measured)/measured [%].
    std : ndarray, shape (k,)
        Standard uncertainty of the measured peaks [Hz], NaN where it is not known.
    error : ndarray, shape (k,)
        Of the calculated peaks [Hz]: by mesh and rounding, of a response by the fit to them.
    damping_ratio, calculated_damping_ratio : ndarray, shape (k,)
        NaN where it is not known or nothing damps.
    all_calculated : ndarray, shape (m,)
        Every calculated peak, paired or not [Hz].
    visible : ndarray of bool, shape (m,)
        Whether the drive of a measured response shows anything of it in any of them; True where
        peaks alone were compared.
    status : {"trusted", "ambiguous", "refused"}
        Whether the pairs are the right ones: ambiguous where other pairs have a twentieth of the
        probability or there are less than three, refused where there are none.
    reason : str
        Why, in words.
    factor : float
        Common factor of measured over calculated frequencies that the pairs were found with, the
        median of all; 1 without pairs.
    hint : str
        What the differences show of their cause, where pairs are trusted and prove it: numbers of
        the scene of which one alone explains them, rotational springs at the ends, and whether
        these can be told apart. Else empty.
    notes : tuple of str
        What a reader must know: a factor that all peaks have in common, slips in what was
        measured, maxima of responses that are no peaks.
    response : tuple of str
        What each response is; empty where peaks alone were compared.
    frequency : ndarray, shape (f,), or None
        Lines of the responses [Hz].
    measured_value, calculated_value : ndarray of complex, shape (responses, f), or None
        The responses.
    frac : ndarray, shape (responses,), or None
        Frequency response assurance criterion over all lines, from 0 to 1.
    frac_over_frequency : ndarray, shape (responses, f), or None
        Of the lines within a band around each line.
    band : float or None
        Its width [Hz].
    mac : ndarray, shape (k, m), or None
        Modal assurance criterion of each measured and each calculated shape, from 0 to 1.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile()
    >>> found = rd.compare(model.modes(3), rd.Peaks([24.8, 75.5], std=0.1))
    >>> found.order, found.residual.round(3), found.missed
    (array([1, 3]), array([ 0.2, -0.5]), array([2]))
    >>> found.score.round(1), found.peaks().column("mode")
    (array([ 2., -5.]), (1, 3))
    """

    said = ("frac", "mac")

    order: Integer = field(metadata=axes("peak"))
    measured: Real = field(metadata=axes("peak", unit="Hz"))
    calculated: Real = field(metadata=axes("peak", unit="Hz"))
    difference: Real = field(metadata=axes("peak", unit="%"))
    std: Real = field(metadata=axes("peak", unit="Hz"))
    error: Real = field(metadata=axes("peak", unit="Hz"))
    damping_ratio: Real = field(metadata=axes("peak"))
    calculated_damping_ratio: Real = field(metadata=axes("peak"))
    all_calculated: Real = field(metadata=axes("calculated", unit="Hz"))
    visible: Flags = field(metadata=axes("calculated"))
    status: str = "trusted"
    reason: str = ""
    factor: float = 1.0
    hint: str = ""
    notes: tuple[str, ...] = ()
    response: tuple[str, ...] = ()
    frequency: Real | None = field(default=None, metadata=axes("frequency", unit="Hz"))
    measured_value: Complex | None = field(default=None, metadata=axes("response", "frequency"))
    calculated_value: Complex | None = field(default=None, metadata=axes("response", "frequency"))
    frac: Real | None = field(default=None, metadata=axes("response"))
    frac_over_frequency: Real | None = field(default=None, metadata=axes("response", "frequency"))
    band: float | None = None
    mac: Real | None = field(default=None, metadata=axes("peak", "calculated"))

    @property
    def residual(self) -> Real:
        """Calculated less measured frequencies [Hz], shape (k,)."""
        return self.calculated - self.measured

    @property
    def score(self) -> Real:
        """Residuals over the root of std^2 + error^2, shape (k,); NaN where that is not known."""
        spread = np.hypot(self.std, self.error)
        with np.errstate(divide="ignore", invalid="ignore"):
            return self.residual / spread

    @property
    def missed(self) -> Integer:
        """Visible calculated peaks from the lowest to the highest measured one that none is."""
        f, low = self.all_calculated, self.measured.min(initial=np.inf)
        within = self.visible & (f >= low) & (f <= self.measured.max(initial=0.0))
        number = np.arange(1, len(f) + 1)
        return np.setdiff1d(number[within], self.order)

    def peaks(self) -> Table:
        """Return the pairs with their differences, of what is known of any."""
        none = self.order == 0
        columns: dict[str, Any] = {
            "measured [Hz]": self.measured,
            "std [Hz]": self.std,
            "calculated [Hz]": self.calculated,
            "error [Hz]": self.error,
            "difference [Hz]": self.residual,
            "difference [%]": self.difference,
            "difference/std": self.score,
            "damping ratio measured": self.damping_ratio,
            "damping ratio calculated": self.calculated_damping_ratio,
        }
        always = ("measured [Hz]", "calculated [Hz]", "difference [Hz]", "difference [%]")
        columns = {
            name: numbers(values)
            for name, values in columns.items()
            if name in always or not np.isnan(values).all()
        }
        columns["mode"] = tuple(None if n else k for n, k in zip(none, self.order.tolist()))
        why = "" if self.status == "trusted" else f": {self.reason}"
        return Table.of(f"calculated against measured peaks, {self.status}{why}", columns)

    def table(self) -> Table:
        """Return the pairs with their differences."""
        return self.peaks()

    def report(self) -> str:
        """Return as text the pairs, FRAC of each response, notes and hint, as far as there are any.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=90.0).compile()
        >>> peaks = rd.Peaks([15.81, 31.62, 47.43, 63.25], std=0.01)
        >>> print(rd.compare(model, peaks).report().splitlines()[-1].split(":")[0])
        All shifts are alike within their uncertainty
        """
        lines = [str(self.peaks())]
        if self.frac is not None:
            lines += [f"FRAC of {r}: {value:.4g}" for r, value in zip(self.response, self.frac)]
        lines += [*self.notes, *([self.hint] if self.hint else [])]
        return "\n".join(lines)

    def plot(self, ax: Axes | None = None, *, of: str | None = None) -> Axes:
        """Plot what was compared.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        of : {"response", "phase", "frac", "mac", "peaks"}, optional
            Amplitudes or phases of both responses over frequency with the pairs of peaks, FRAC over
            frequency, MAC of each two shapes, or calculated over measured peaks. Where left out
            responses, and peaks where there are none.

        Raises
        ------
        SceneError
            If that was not compared.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> rd.compare(model, [15.5, 31.0]).plot().get_ylabel()
        'calculated [Hz]'
        """
        return draw(self, "plot", ax, of=of)


def compare(
    calculated: Model | SpaceModel | Modes | FRF,
    measured: Peaks | Measured | Resonances | ArrayLike,
    *,
    within: float | None = None,
    band: float | None = None,
    shapes: ArrayLike | None = None,
    points: Sequence[Point] | None = None,
) -> Comparison:
    """Compare what was calculated with a measurement.

    Each measured peak has the calculated partner that makes the sum of d^2, d = log(measured/
    calculated) less a factor that all have in common, over all pairs smallest, where a pair that is
    left out costs the square of half the distance to the next calculated one, in the same measure:
    a peak in the middle between two modes says nothing about which of them it is. So a peak that is
    no mode and a mode that shows no peak stay alone, and pairs never cross. The factor is the one
    that makes the pairs most probable, by how they scatter, what they leave out and how far it is
    from 1; the status says whether others are possible. Of a whole response, modes of which the
    drive shows nothing in any response have no peak.

    Where the uncertainties of the peaks prove that one number of the scene, or the give of its
    ends, explains all differences, and which, the `hint` of the comparison says so.

    Parameters
    ----------
    calculated : Model, SpaceModel, Modes or FRF
        Of a model the modes that are needed are computed, damped ones where the scene damps, whose
        natural frequencies are compared, and the response at the measured lines.
        Of an FRF its peaks count, to the drive of the measurement or else the first one.
    measured : Peaks, Measured, Resonances or array_like of frequencies [Hz]
        Of a whole response the peaks of all its responses are merged, as by `Peaks.of`; its line at
        0 Hz is not compared. With orders of `Peaks` each is compared with that mode in any case.
    within : float, optional
        Largest relative error that the calculated frequencies may have: no pair is farther apart
        than that and three standard uncertainties of the peak, and no common factor is sought.
    band : float, optional
        Width of the band around each line that `Comparison.frac_over_frequency` is taken over [Hz];
        a tenth of the measured range, or ten lines where that is wider, where left out.
    shapes : array_like of real or complex, shape (k, points), optional
        Measured shapes, one for each peak; of a whole response those that its peaks show in two
        responses and more, where left out.
    points : sequence of points, optional
        Where, such as ``[("z", 0.2), ("z", 0.5)]``; of one coordinate, or MAC depends on units.

    Returns
    -------
    Comparison

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If there is no calculated peak, or fewer than the orders ask for; if an FRF has other lines
        or points than the measurement.
    SolveError
        If the model has no response at a measured line, as on an undamped resonance.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=64)
    >>> comparison = rd.compare(model, rd.Peaks([15.5, 22.0, 31.0], std=0.1))
    >>> comparison.order
    array([1, 0, 2])
    >>> comparison.difference.round(2)
    array([2.  ,  nan, 1.97])
    """
    kinds = (Model, SpaceModel, Modes, FRF)
    check.instance(calculated, "calculated", kinds, "a Model, Modes or FRF")
    if within is not None:
        within = check.number(within, "within", sign="positive")
    if band is not None:
        band = check.number(band, "band", "Hz", sign="positive")
    peaks = measured_peaks(measured)
    drive = 0
    if isinstance(calculated, FRF) and peaks.curves is not None:
        drive = drive_of(calculated, peaks.curves)
    found = calculated_peaks(
        calculated, peaks.highest, max(len(peaks.frequency), 2), peaks.last, drive
    )
    visible = np.ones(len(found.frequency), dtype=np.bool_)
    if peaks.curves is not None:
        visible = found.visible(peaks.curves.drive[0], peaks.curves.response)
    numbering, (status, reason) = _numbering(found.frequency, visible, peaks, within)
    slipped = _slips(calculated, peaks)
    if status == "trusted" and any(ANGULAR in note for note in slipped):
        status, reason = "ambiguous", "the frequencies may be rad/s"
    order = numbering.order
    mine = np.where(order > 0, order - 1, len(found.frequency))
    partner, error, damping = (
        np.append(column, np.nan)[mine]
        for column in (found.frequency, found.error, found.damping_ratio)
    )
    hint = ""
    if status == "trusted":
        hint = likely_cause(found, order, peaks.frequency, peaks.std)
    return Comparison(
        order=order,
        measured=peaks.frequency,
        calculated=partner,
        difference=100 * (partner - peaks.frequency) / peaks.frequency,
        std=peaks.std,
        error=error,
        damping_ratio=peaks.damping_ratio,
        calculated_damping_ratio=damping,
        all_calculated=found.frequency,
        visible=visible,
        status=status,
        reason=reason,
        factor=math.exp(numbering.shift),
        hint=hint,
        notes=(*_alike(found, numbering, peaks, hint), *slipped, *found.notes, *peaks.left_out),
        mac=_mac(found, peaks, shapes, points, drive),
        **_responses(calculated, peaks.curves, band),
    )


def _numbering(
    calculated: Real, visible: Flags, peaks: MeasuredPeaks, within: float | None
) -> tuple[Pairing, Verdict]:
    """Return which calculated peak each measured one is, and what that is worth."""
    if peaks.order is not None:
        if peaks.last > len(calculated):
            raise SceneError(
                f"measured.order must be at most {len(calculated)}, the calculated peaks there "
                f"are, got {peaks.last}"
            )
        one = weighed(peaks.frequency, calculated, peaks.std, peaks.order)
        return one, Verdict("trusted", "the orders are given")
    seen = calculated[visible]
    if within is None:
        found = numbered(peaks.frequency, seen, peaks.std)
    else:
        order = paired(peaks.frequency, seen, std=peaks.std, within=within)
        found = [weighed(peaks.frequency, seen, peaks.std, order)]
    number = np.append(0, np.flatnonzero(visible) + 1)
    found = [one._replace(order=number[one.order]) for one in found]
    return found[0], verdict(found)


def _alike(
    found: CalculatedPeaks, numbering: Pairing, peaks: MeasuredPeaks, hint: str
) -> list[str]:
    """Say which factor all peaks have in common, if any, and what would explain it."""
    common = common_factor(numbering, peaks.frequency, found.frequency)
    if common is None:
        return []
    where = "above" if common > 1 else "below"
    said = f"all peaks lie {100 * abs(common - 1):.3g} % {where} the calculated ones: one factor"
    by_tension = "" if hint else tension_alone(found, numbering.order, peaks.frequency)
    return [f"{said}; {by_tension}" if by_tension else said]


def _slips(calculated: Model | SpaceModel | Modes | FRF, peaks: MeasuredPeaks) -> tuple[str, ...]:
    """Name slips in what was measured."""
    model = calculated if isinstance(calculated, Model) else None
    if peaks.curves is not None:
        return slips(peaks.curves, model)
    if model is None or peaks.order is not None:
        return ()
    return slips_of_peaks(peaks.frequency, model)


def _responses(
    calculated: Model | SpaceModel | Modes | FRF, measured: Measured | None, band: float | None
) -> dict[str, Any]:
    """Return what a comparison says about responses."""
    if measured is None or isinstance(calculated, Modes):
        return {}
    value, f = calculated_at(calculated, measured), measured.frequency
    if band is None:
        wide = FEWEST * float(np.median(np.diff(f))) if len(f) > 1 else float(f[0])
        band = max(BAND * float(f[-1] - f[0]), wide)
    return {
        "response": measured.labels,
        "frequency": f,
        "measured_value": measured.value,
        "calculated_value": value,
        "frac": frac(measured.value, value),
        "frac_over_frequency": frac_over(measured.value, value, f, band),
        "band": band,
    }


def _mac(
    found: CalculatedPeaks,
    peaks: MeasuredPeaks,
    shapes: ArrayLike | None,
    points: Sequence[Point] | None,
    drive: int,
) -> Real | None:
    """Return MAC of all measured and calculated shapes, or None where there are none."""
    if (shapes is None) != (points is None):
        raise SceneError(
            f"shapes must be given together with points, got {check.shown(shapes)} and points "
            f"{check.shown(points)}"
        )
    if shapes is not None:
        where = found.checked(points, "points")
        size = (len(peaks.frequency), len(where))
        measured = check.matrix(shapes, "shapes", size, "peak and point", np.complex128)
    else:
        curves = peaks.curves
        if curves is None or len(peaks.frequency) == 0 or not found.has_shapes:
            return None
        rows = [k for k, point in enumerate(curves.response) if is_motion(point)]
        if len(rows) < 2:
            return None
        where = tuple(curves.response[k] for k in rows)
        measured = residues(
            curves.frequency,
            curves.value[rows],
            curves.quantity,
            peaks.frequency,
            peaks.damping_ratio,
            decay=curves.decay,
        )
    calculated = found.shapes(where, drive)
    return None if calculated is None else mac(measured, calculated)
