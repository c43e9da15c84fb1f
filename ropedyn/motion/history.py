"""Motion over time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..base.answer import Answer, Cost, Frozen, axes, kept_as
from ..base.array import Complex, Real
from ..base.check import NEAR
from ..base.computed import Lazy, Read, lazy
from ..base.drawing import draw
from ..base.errors import SceneError
from ..base.table import Table
from ..base.unit import MOTIONS, QUANTITIES, label
from ..chain.port import Point
from ..chain.tip import is_tip
from ..curves.measured import Measured
from ..response.moved_end import is_end
from ..scene.force import Force
from ..scene.toml import force_from, force_words
from ..signal.ringdown import RingDown, ring_down
from ..signal.spectrum import Spectrum, amplitude, spectrum
from .response_estimate import estimated, is_struck_between

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def ended_by(error: BaseException | None) -> str:
    """Return why a motion ends before it should; nothing where it does not."""
    if error is None:
        return ""
    told = f"{type(error).__name__}: {error}"
    return "interrupted" if isinstance(error, KeyboardInterrupt) else told


class ForceWords(tuple[Any, ...]):
    """Forces as a file tells them."""

    __slots__ = ()


KEPT_LAW = kept_as(lambda law: list(map(force_words, law)), ForceWords)
"""How a file keeps the forces that drive: in words, which their values at the times complete."""


@dataclass(frozen=True, eq=False)
class Balance(Frozen):
    """Where the energy is; see `History`."""

    energy: dict[str, Real] = field(metadata=axes("time", unit="J", keyed=True))


@dataclass(frozen=True, eq=False)
class History(Answer):
    """Motion over time.

    What it would take other runs to know (`mesh_error`, of linear motion also `energy`) is computed
    when it is first asked for.

    Attributes
    ----------
    drive : tuple of points
        What the forces act on, or whose motion is given.
    response : tuple of points
        What is watched.
    quantity : {"displacement", "velocity", "acceleration"}
        Of the responses.
    time : ndarray, shape (t,)
        [s].
    value : ndarray, shape (responses, t)
        [m, rad, and these per s or s^2; N, N m].
    force : ndarray, shape (drives, t)
        What drives, at these times [N, N m; m, rad]; of a blow at an instant nothing.
    error : ndarray, shape (responses, t)
        Absolute error that the method causes and that covers that of every value: of modes those
        that were left out, of the line sums that end earlier, of steps by Richardson's
        extrapolation; and rounding.
    mesh_error : ndarray, shape (responses, t)
        Absolute error that the elements cause: the distance to the motion of the continuous spans
        of the same scene and the error of that. 0 for continuous spans, infinite where they have no
        answer, as where something is not linear but stops and friction.
    total_error : ndarray, shape (responses, t)
        Absolute error of the values, all of it: of modes that were left out, steps and elements.
        A tolerance is kept for the chain as it is: coarse elements are wrong by far more.
    energy : dict of ndarray, shape (t,)
        "kinetic" and "strain", what the forces put in since t = 0 ("input") and what dampers took
        ("dissipated") [J]: kinetic + strain - input + dissipated stays what it was before the first
        time; blows at it are in the input. The modal method integrates input and dissipated
        at 4 values for each rad of the modes and forces, 16 at least between two times: 2 s at
        10 kHz of 126 modes take 10 s. Work of a tension that pulsates is input; of an
        end that jumps, what stays of it. Where stops or a `NodeForce` act, what they took since
        then is "laws" and belongs to the sum. What a damped element takes of a blow at an instant
        between its nodes is infinite, and in none. Refused where a pulsating tension turns an end
        of a laid rope, and between nodes where the tension varies.
    snapshot_time : ndarray, shape (s,)
        When the whole rope was looked at [s].
    x : ndarray, shape (nodes,)
        Where [m].
    coordinates : tuple of str
        Of every node.
    snapshot : ndarray, shape (s, nodes, coordinates)
        Displacement of the whole rope [m, rad].
    sure_until : float
        Where stops and friction make motion chaotic and ``partial=True`` asked for it anyway: until
        when modes, elements apart, and rounding leave it within the tolerance [s]; errors are
        infinite after it. Infinite where nothing limits it.
    stopped : str
        Why it ends before the last time that was asked for; empty where it does not.
    released : bool
        Whether loads were let go at the first time.
    cost : Cost
        What it cost.

    Examples
    --------
    A string that is let go keeps its energy:

    >>> import numpy as np
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=8)
    >>> time = np.linspace(0.0, 0.04, 5)
    >>> history = model.transient(time, start={("z", 1.0): 20.0}, response=("z", 1.0))
    >>> history.value.round(4)
    array([[ 0.01  ,  0.0002, -0.0091,  0.0007,  0.0091]])
    >>> (history.energy["kinetic"] + history.energy["strain"]).round(6)
    array([0.1, 0.1, 0.1, 0.1, 0.1])
    >>> bool((history.error < 1e-12).all()), bool((history.mesh_error < 2e-3).all())
    (True, True)
    >>> bool((history.total_error >= history.mesh_error).all())
    True
    """

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    coordinates: tuple[str, ...]
    time: Real = field(metadata=axes("time", unit="s"))
    value: Real = field(metadata=axes("response", "time"))
    force: Real = field(metadata=axes("drive", "time"))
    snapshot_time: Real = field(metadata=axes("snapshot", unit="s"))
    x: Real = field(metadata=axes("node", unit="m"))
    snapshot: Real = field(metadata=axes("snapshot", "node", "coordinate", unit="m or rad"))
    cost: Cost
    balance: Lazy[Balance] = lazy(Balance)
    error: Lazy[Real] = lazy(np.ndarray, axes("response", "time"))
    mesh_error: Lazy[Real] = lazy(np.ndarray, axes("response", "time"))
    sure_until: float = math.inf
    stopped: str = ""
    released: bool = False
    law: tuple[Force, ...] = field(default=(), repr=False, metadata=KEPT_LAW)

    def __post_init__(self) -> None:
        if isinstance(self.law, ForceWords):
            law = (force_from(one, self.time, f) for one, f in zip(self.law, self.force))
            object.__setattr__(self, "law", tuple(law))
        super().__post_init__()

    energy = Read[dict[str, Real]]("balance", "Energies over time [J], each shape (t,).")

    @property
    def total_error(self) -> Real:
        """Absolute error of the values: of modes left out, steps and elements together."""
        return self.error + self.mesh_error

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit."""
        return tuple(label(r, quantity=self.quantity) for r in self.response)

    def table(self) -> Table:
        """Return every response over time."""
        columns: dict[str, Any] = {"time [s]": self.time}
        columns |= dict(zip(self.labels, self.value))
        return Table.of(f"{self.quantity} over time", columns)

    def plot_snapshots(self, ax: Axes | None = None, *, coordinate: str | None = None) -> Axes:
        """Plot one coordinate along the rope, a line for each snapshot.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        coordinate : str, optional
            z where there is one, else the first.

        Raises
        ------
        SceneError
            If there are no snapshots, or no such coordinate.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=8)
        >>> push = {"drive": ("z", 0.5), "force": rd.Step(9.0)}
        >>> history = model.transient([0.0, 0.01], **push, snapshots=[0.005, 0.01])
        >>> history.plot_snapshots().get_ylabel()
        'transverse displacement [m]'
        """
        return draw(self, "snapshots", ax, coordinate=coordinate)

    def spectrum(self, *, window: str = "hann") -> Spectrum:
        """Return the amplitudes of the responses over frequency.

        Parameters
        ----------
        window : str
            That weights the times; one that scipy.signal knows. What is neither 0 at both ends of
            the record nor repeats itself after it leaks to other frequencies, less with "hann"
            than with "boxcar" (no weights).

        Returns
        -------
        Spectrum

        Raises
        ------
        SceneError
            If the times have not equal steps, to 1e-6 of one, or the window is unknown.

        References
        ----------
        F. J. Harris, On the use of windows for harmonic analysis with the discrete Fourier
        transform, Proceedings of the IEEE 66 (1978) 51-83.

        Examples
        --------
        A string that is let go swings at its natural frequencies, the first at 5 Hz:

        >>> import numpy as np
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile(elements=64)
        >>> time = np.linspace(0.0, 2.0, 401)[:-1]
        >>> history = model.transient(time, start={("z", 0.5): 0.4}, response=("z", 0.5))
        >>> spectrum = history.spectrum()
        >>> print(spectrum.frequency[spectrum.amplitude[0].argmax()])
        5.0
        """
        of, quantity = self.response, self.quantity
        return spectrum(self.time, self.value, window, response=of, quantity=quantity)

    def amplitude(self, frequency: ArrayLike, *, last: float | None = None) -> Complex:
        """Fit steady motion at one or several frequencies.

        By least squares together with what stands still and what drifts steadily. Motion is
        Re(value exp(+i omega t)), t from 0, as in `Model.frf`; a force `Sine` of amplitude A is
        then -i A, so the receptance is the amplitude over -i A.

        Parameters
        ----------
        frequency : float or array_like, shape (k,)
            [Hz]; several, such as a frequency and its multiples, are fitted together.
        last : float, optional
            How much of the end of the record is taken [s]; all of it where left out.

        Returns
        -------
        ndarray of complex, shape (responses,) or (responses, k)
            Unit of the responses.

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If a frequency is not below half the rate of the times, or `last` is too short.

        Examples
        --------
        What is left of a steady force when the transients have gone is the frequency response:

        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ViscousDamping(2.0))
        >>> model, time = scene.compile(elements=64), np.linspace(0.0, 4.0, 2001)
        >>> drive = ("z", 0.5)
        >>> history = model.transient(time, drive=drive, force=rd.Sine(3.0, 20.0))
        >>> ratio = history.amplitude(20.0, last=1.0) / -3j / model.frf(20.0, drive=drive).value[0]
        >>> print(abs(ratio).round(6))
        [1.]
        """
        return amplitude(self.time, self.value, frequency, last)

    def ring_down(
        self,
        near: ArrayLike | None = None,
        *,
        response: int = 0,
        since: float | None = None,
    ) -> RingDown:
        """Estimate frequencies and damping ratios from the decay of free motion.

        About each frequency the record is shifted to 0 Hz, low-passed and thinned (a record of less
        than some 30 periods only low-passed), which leaves decaying modes what they are; the matrix
        pencil finds their rates, least squares refine
        them, and the noise that is left tells their standard errors. Modes close by are fitted
        together. Sums of decaying modes are known to about 1e-4 of a frequency and better: what a
        low-pass leaves of other modes is no noise, and standard errors may say less.

        Parameters
        ----------
        near : float or array_like, shape (k,), optional
            Where modes are looked for [Hz], to a quarter of it: the nearest natural frequency of
            what has 5e-4 of the strongest motion there; the strongest line of the spectrum where
            left out.
        response : int
            Of which response.
        since : float, optional
            From when on motion is free [s]; where left out since the force last changed (a blow at
            an instant is not seen).

        Returns
        -------
        RingDown

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If times have not equal steps, the record of free motion is too short, or `near` is not
            below half the rate of the times.
        SolveError
            If nothing moves there.

        References
        ----------
        Y. Hua, T. K. Sarkar, Matrix pencil method for estimating parameters of exponentially
        damped/undamped sinusoids in noise, IEEE Transactions on Acoustics, Speech, and Signal
        Processing 38 (1990) 814-824.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ModalDamping(0.01))
        >>> model, time = scene.compile(elements=64), np.linspace(0.0, 4.0, 2001)
        >>> history = model.transient(time, start={("z", 0.5): 0.4}, response=("z", 0.5))
        >>> print(history.ring_down().damping_ratio.round(6))
        [0.01]
        """
        over_time = self.time, self.value, self.force
        return ring_down(*over_time, labels=self.labels, response=response, near=near, since=since)

    def frf(
        self,
        *,
        drive: int = 0,
        segments: int = 1,
        window: str | None = None,
        band: ArrayLike | None = None,
    ) -> Measured:
        """Estimate the responses per force, as a measurement does: H1 = S_fx / S_ff.

        One segment: the ratio of the Fourier transforms of the whole record, of the force the exact
        one of what drove, a blow at an instant, a half sine or a step between two times too. That
        is exact, but for what lies above half the rate of the times, if motion starts from rest and
        has decayed at the end, as after a blow or a chirp, velocities and accelerations also under
        a force that is held from there on. Several segments, each half over the next, are averaged,
        as for noise; then there is a coherence, and of the force its samples are taken, which are
        straight lines where it was given so. `Measured.notes` says which, and what folds or is cut
        off.

        Parameters
        ----------
        drive : int
            To which drive; others must be at rest.
        segments : int
            How many.
        window : str, optional
            That weights each segment; "boxcar" of one and "hann" of several where left out.
        band : pair of float, optional
            Lowest and highest frequency [Hz]; where left out all where the force is not less than
            1e-3 of its largest line.

        Returns
        -------
        Measured

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If times have not equal steps, nothing drives at the times, or something else does, as
            loads that were let go, or a blow shorter than two steps hits what follows it at once:
            the acceleration asked for, or between nodes the element.

        References
        ----------
        J. S. Bendat, A. G. Piersol, Random Data: Analysis and Measurement Procedures (2010),
        section 9.2.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ModalDamping(0.01))
        >>> model, time = scene.compile(elements=64), np.arange(40_000) / 2000.0
        >>> blow = rd.Impulse(0.01, duration=0.01)
        >>> measured = model.transient(time, drive=("z", 0.5), force=blow).frf(band=(2.0, 20.0))
        >>> measured.peaks()[0].frequency.round(2)
        array([ 5.  , 14.99])
        """
        if self.released:
            raise SceneError(
                "start must be nothing for a response per force, which begins at rest: the motion "
                "of what was let go is in it"
            )
        order = MOTIONS[self.quantity]
        self._refuse_struck(drive, order)
        found, notes = estimated(
            self.time,
            self.value,
            self.force,
            self.law,
            drive=drive,
            segments=segments,
            window=window,
            band=band,
            order=order,
            error=self.error,
        )
        return Measured(
            frequency=found.frequency,
            value=found.value,
            drive=(self.drive[drive],),
            response=self.response,
            quantity=list(QUANTITIES)[order],
            coherence=found.coherence,
            averages=found.averages,
            notes=notes,
        )

    def _refuse_struck(self, drive: int, order: int) -> None:
        """Refuse what follows a blow at once, which no sample shows.

        So does the acceleration of what it hits, and between nodes all motion of the element.
        """
        if drive not in range(len(self.law)) or is_end(self.drive[drive]):
            return
        if not is_struck_between(self.law[drive], self.time):
            return
        x, struck = self.x, self.drive[drive]
        is_node = np.isclose(x, struck[1], rtol=0.0, atol=NEAR * x[-1]).any()
        if order < 2 and (is_node or self.cost.elements < len(x) - 1):  # or of continuous spans
            return
        first = x[max(int(np.searchsorted(x, struck[1])) - 1, 0)]
        last = x[min(int(np.searchsorted(x, struck[1], side="right")), len(x) - 1)]
        for point in self.response:
            if not is_tip(point) and first < point[1] < last:
                asked = f"response must not be {point}"
                if order == 2:
                    asked = f'quantity must be "displacement" or "velocity" of {point}'
                raise SceneError(
                    f"{asked} for a response per force where a blow between two times hits "
                    f"{struck}: no sample of the {self.quantity} shows what follows it at once"
                )
