"""A record of motion over time."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from ...base import check
from ...base.answer import TRANSIENT, Answer, axes
from ...base.drawing import draw
from ...base.progress import Progress
from ...base.reading import reading
from ...base.table import Table
from ...base.unit import MOTIONS, label
from ...chain.port import Point
from ..files import records
from ..measured import Measured
from ..peaks import Peaks
from .find_peaks import find_peaks
from .given import channels_given, drive_of, force_given, points_of, times_given
from .hits import measured_response
from .repair import channels_of, grid_of, on_grid, pieces_of
from .spectrum import RecordSpectrum, spectrum_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MISSING = ("refuse", "gap")
"""What a value of NaN may be."""


@dataclass(frozen=True, eq=False)
class Record(Answer):
    """Recorded motion over time.

    What is wrong with it is put right where that changes nothing else, and named in `notes`: gaps
    up to 0.05 s are bridged, times that jitter resampled; longer gaps split it; channels that are
    dead or clipped too often are not used; drift is taken away before anything is estimated.

    Parameters
    ----------
    time : array_like, shape (t,), or None
        [s], increasing. Steps of more than one and a half are gaps. None with `rate`.
    value : array_like, shape (channels, t) or (t,)
        [m/s^2, rad/s^2, or these times s or s^2].
    rate : float, optional
        Samples a second [Hz], in place of time.
    response : point or sequence of points
        Where each channel is, such as ``("z", 3.5)``.
    quantity : {"acceleration", "velocity", "displacement"}
        Of the channels.
    force : array_like, shape (t,), optional
        What drove the rope [N, N m], such as a hammer; None where nobody did on purpose.
    drive : point, optional
        Where the force acts.
    missing : {"refuse", "gap"}, optional
        What a value of NaN is: an error, or a gap of all channels.
    notes : sequence of str, optional
        What is known about the record; what is found wrong with it is added.

    Attributes
    ----------
    time : ndarray, shape (t,)
        [s], at equal steps.
    value, force : ndarray, shape (channels, t) and (t,)
        NaN in gaps that split the record.
    rate : float
        Samples a second [Hz].
    pieces : tuple of tuple of int
        Starts and stops of uninterrupted stretches of samples.
    used : tuple of int
        Numbers of the channels that peaks are sought in.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If shapes do not fit, times do not increase or jitter too much, something is not finite, a
        rate is not positive, or there are less than 16 samples.

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> time = np.arange(1000) / 50.0
    >>> motion = np.sin(9.0 * time)
    >>> record = rd.Record(time, [motion, 0.0 * time], response=[("z", 3.5), ("z", 6.0)])
    >>> record.rate, record.pieces, record.used
    (50.0, ((0, 1000),), (0,))
    >>> record.notes
    ('channel 1 (z at 6.000 m) is dead: not used',)
    """

    time: Any = field(metadata=axes("time", unit="s"))
    value: Any = field(metadata=axes("response", "time"))
    _: KW_ONLY
    rate: Any = None
    response: Any
    quantity: str = "acceleration"
    force: Any = field(default=None, metadata=axes("time"))
    drive: Any = None
    missing: str = "refuse"
    notes: tuple[str, ...] = ()
    pieces: tuple[tuple[int, int], ...] = field(init=False, metadata=TRANSIENT)
    used: tuple[int, ...] = field(init=False, metadata=TRANSIENT)

    def __post_init__(self) -> None:
        check.one_of(self.quantity, "quantity", MOTIONS)
        check.one_of(self.missing, "missing", MISSING)
        response, drive = points_of(self.response), drive_of(self.drive, self.force)
        rate = check.optional(self.rate, "rate", "Hz", sign="positive")
        value = channels_given(self.value, response, self.quantity, self.missing)
        force = force_given(self.force, drive, value.shape[1], self.missing)
        rows = value if force is None else np.vstack([value, force])
        grid = grid_of(times_given(self.time, rate, value.shape[1]), rate)
        rows, repaired = on_grid(grid, rows)
        pieces, split = pieces_of(rows, grid.rate)
        channels = channels_of(rows[: len(value)], response)
        notes = [*repaired, *split, *channels.notes]
        found = {
            "time": grid.start + np.arange(rows.shape[1]) / grid.rate,
            "value": rows[: len(value)],
            "rate": grid.rate,
            "response": response,
            "force": None if force is None else rows[-1],
            "drive": drive,
            "missing": "gap" if np.isnan(rows).any() else "refuse",
            "notes": (*self.notes, *(note for note in notes if note not in self.notes)),
            "pieces": pieces,
            "used": channels.used,
        }
        for name, one in found.items():
            object.__setattr__(self, name, one)
        super().__post_init__()

    @classmethod
    def read(
        cls,
        path: str | os.PathLike[str],
        *,
        time: str | int | None = None,
        rate: float | None = None,
        response: Mapping[str | int, Point] | Sequence[Point] | None = None,
        quantity: str | None = None,
        force: Mapping[str | int, Point] | None = None,
        unit: str | Mapping[str | int, str] | None = None,
        missing: str = "refuse",
        delimiter: str | None = None,
        decimal: str = ".",
        comments: str = "#",
        skip: int = 0,
    ) -> Self:
        r"""Read text in columns, or time responses of a universal file (dataset 58, function 1).

        What `write` has written needs nothing else. Of other files, what they do not say must be
        said here; nothing is guessed.

        Parameters
        ----------
        path : path
            ``.csv``, ``.txt``, ``.dat`` or ``.tsv``; ``.uff``, ``.unv`` or ``.uf``.
        time : str or int, optional
            Of text: name or number, from 0, of the column of times [s].
        rate : float, optional
            Samples a second [Hz]; of text in place of `time`.
        response : dict or list of points
            Where all channels are, in their order, that are neither time nor force; or which
            channel is where: ``{"a1": ("z", 3.5)}``. Channels are names or numbers of columns, or
            first lines or numbers of datasets, both from 0; a dataset in the direction -Z is turned
            round.
        quantity : {"acceleration", "velocity", "displacement"}, optional
            The unit, or the type of the ordinate of a universal file, says it too; acceleration
            where nothing does.
        force : dict, optional
            Which channel is the force, and where it acts: ``{"hammer": ("z", 9.0)}``.
        unit : str or dict, optional
            Of the motions, such as ``"g"`` or ``"mm/s"``; or one for each channel by its name, that
            of the force too. SI where neither this nor the file says it.
        missing : {"refuse", "gap"}, optional
            What a value of NaN is: an error, or a gap.
        delimiter : str, optional
            Of text; found where left out.
        decimal : {".", ","}, optional
            Of text.
        comments : str, optional
            Of text: how lines begin that are left out.
        skip : int, optional
            Of text: how many lines are left out first. One line of names may follow.

        Returns
        -------
        Record

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If something is not said, has no meaning for such a file, or the file is damaged; the
            message names it.
        ImportError
            If pyuff is missing for a universal file.
        OSError
            If the file cannot be read.

        Examples
        --------
        >>> import tempfile
        >>> import ropedyn as rd
        >>> path = tempfile.mkdtemp() + "/run.csv"
        >>> with open(path, "w") as file:
        ...     _ = file.write("t,a1\n" + "".join(f"{k / 64},{k % 7}\n" for k in range(99)))
        >>> record = rd.Record.read(path, time="t", response={"a1": ("z", 3.5)}, unit="g")
        >>> print(record.rate, record.labels, record.value.max().round(3))
        64.0 ('z at 3.500 m [m/s^2]',) 58.84
        """
        file = check.path(path)
        said = records.Said(time, rate, response, quantity, force, unit, missing)
        layout = {
            "delimiter": delimiter,
            "decimal": decimal,
            "comments": comments,
            "skip": skip,
        }
        motion = records.read(file, said, layout)
        with reading(path, "a whole file of a record"):
            return cls(**motion._asdict())

    def write(self, path: str | os.PathLike[str], *, binary: bool = False) -> None:
        """Write the record in SI for other programs, whole or not at all.

        `Record.read` reads it without being told more.

        Parameters
        ----------
        path : path
            ``.csv`` for text in columns, which keeps every bit; ``.uff`` or ``.unv`` for a
            universal file with a dataset 58 for each channel, by pyuff.
        binary : bool, optional
            Whether a universal file is binary and keeps every bit of the values, or is ASCII with
            12 digits.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If the suffix is none of these, or a universal file would have to hold gaps.
        ImportError
            If pyuff is missing for a universal file.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> import tempfile
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> record = rd.Record(None, np.sin(np.arange(99.0)), rate=64.0, response=("z", 3.5))
        >>> path = tempfile.mkdtemp() + "/run.csv"
        >>> record.write(path)
        >>> bool((rd.Record.read(path).value == record.value).all())
        True
        """
        motion = records.RecordContent(
            self.time,
            self.value,
            self.rate,
            self.response,
            self.quantity,
            self.force,
            self.drive,
            self.missing,
            self.notes,
        )
        records.write(motion, check.path(path), binary)

    @property
    def labels(self) -> tuple[str, ...]:
        """What each channel is, with its unit."""
        return tuple(label(point, quantity=self.quantity) for point in self.response)

    def peaks(self, below: float | None = None, progress: Progress = None) -> Peaks:
        """Find what resonates, of the motion alone: nobody needs to know what drives it.

        Sinusoids are found by Thomson's harmonic test and taken away. Maxima of the first singular
        value of the spectral densities are candidates, and to each one mode is fitted in a band of
        the Fourier lines of the whole record; the fit says how uncertain it is.

        Parameters
        ----------
        below : float, optional
            Highest frequency [Hz]; 0.8 of half the rate where left out. Lower ones save time.
        progress : None, True or callable, optional
            What takes the fraction that is done.

        Returns
        -------
        Peaks
            With `std`, `damping_ratio`, `damping_ratio_std`, `kind`, `shape`, `sensors`, `snr` and
            `band`. Those of a kind other than "mode" stay in the list.

        Raises
        ------
        TypeError
            If below is no number, or progress is none of these.
        SceneError
            If below is not between the lowest frequency that the record can show, 40 in its
            longest piece, and half the rate.
        SolveError
            If every channel is dead, the record is too short, or nothing stands out of the noise.

        Examples
        --------
        A string of 2 Hz, 4 Hz, ... under a random load:

        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(10.0, 1.0), tension=1600.0, damping=rd.ModalDamping(0.01))
        >>> time = np.arange(20000) / 50.0
        >>> load = np.random.default_rng(1).standard_normal(len(time))
        >>> push = {"drive": ("z", 2.3), "force": load, "response": ("z", 1.5)}
        >>> history = scene.compile().transient(time, **push)
        >>> record = rd.Record(time, history.value, response=("z", 1.5), quantity="displacement")
        >>> peaks = record.peaks(below=9.0)
        >>> [f for f, kind in zip(peaks.frequency.round(1).tolist(), peaks.kind) if kind == "mode"]
        [2.0, 4.0, 6.0, 8.0]
        """
        return find_peaks(self, below, progress)

    def frf(
        self,
        estimator: str = "H1",
        *,
        decay: float | None = None,
        gate: bool = True,
        length: float | None = None,
    ) -> Measured:
        """Estimate the response per force, from hits or a force that acts all the time.

        Parameters
        ----------
        estimator : {"H1", "H2", "Hv"}
            Right where the motion is noisy, the force, or both in proportion to their size.
        decay : float, optional
            [1/s] of the window exp(-decay t) on force and motion of hits; what they need where left
            out.
        gate : bool
            Whether the force of hits is set to 0 between its pulses.
        length : float, optional
            Of each record of a hit, or each segment of noise [s].

        Returns
        -------
        Measured
            With `decay`, `averages`, `coherence`; of several hits `std`; `notes` say what was left
            out.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If there is no force or no usable hit (each with its reason), or a value has no meaning.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 1.0), tension=64.0, damping=rd.ModalDamping(0.01))
        >>> time, drive = np.arange(2048) / 256.0, ("z", 0.3)
        >>> force = 10 * np.sin(np.pi * np.clip((time - 0.5) / 0.03, 0.0, 1.0)) ** 2
        >>> value = scene.compile(elements=32).transient(time, drive=drive, force=force).value
        >>> how = {"response": [drive], "quantity": "displacement", "force": force, "drive": drive}
        >>> (peaks,) = rd.Record(time, value, **how).frf(decay=0.5).peaks()
        >>> print(peaks.frequency[:3].round(2), peaks.damping_ratio[:3].round(3))
        [ 4.    7.99 11.96] [0.01 0.01 0.01]
        """
        return measured_response(self, estimator=estimator, decay=decay, gate=gate, length=length)

    def spectrum(self, segment: float | None = None, window: str = "hann") -> RecordSpectrum:
        """Return the power spectral density of each channel, by Welch's method.

        Drift is taken away, and each piece of the record is cut into segments that half overlap.

        Parameters
        ----------
        segment : float, optional
            Length of the segments [s]; a twelfth of the longest piece where left out.
        window : str, optional
            That weights each; one that scipy.signal knows.

        Returns
        -------
        RecordSpectrum

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If segments are longer than the longest piece or shorter than 16 samples, or the window
            is unknown.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> time = np.arange(6000) / 50.0
        >>> motion = np.sin(2 * np.pi * 3.0 * time)
        >>> spectrum = rd.Record(time, motion, response=("z", 3.5)).spectrum(10.0)
        >>> print(spectrum.frequency[spectrum.psd[0].argmax()])
        3.0
        >>> print(((spectrum.psd[0] * 0.1).sum() / np.mean(motion**2)).round(2))
        1.0
        """
        return spectrum_of(self, segment, window)

    def plot_spectrogram(
        self, ax: Axes | None = None, *, channel: int = 0, segment: float | None = None
    ) -> Axes:
        """Plot the power spectral density of one channel over time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        channel : int, optional
            Which one, from 0.
        segment : float, optional
            Length of what one density is of [s]; a fiftieth of the record where left out.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        TypeError, SceneError
            If there is no such channel, or segments are too short or too long.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> record = rd.Record(None, np.sin(np.arange(5000.0)), rate=50.0, response=("z", 3.5))
        >>> record.plot_spectrogram().get_ylabel()
        'frequency [Hz]'
        """
        check.count(channel, "channel", least=0, most=len(self.response) - 1)
        return draw(self, "spectrogram", ax, channel=channel, segment=segment)

    def table(self) -> Table:
        """Return one row for each channel."""
        value = self.value
        columns = {
            "channel": self.labels,
            "mean": tuple(np.nanmean(value, axis=1).tolist()),
            "standard deviation": tuple(np.nanstd(value, axis=1).tolist()),
            "largest": tuple(np.nanmax(np.abs(value), axis=1).tolist()),
            "used": tuple("yes" if k in self.used else "no" for k in range(len(value))),
        }
        samples = sum(stop - start for start, stop in self.pieces)
        return Table.of(f"{samples / self.rate:.6g} s at {self.rate:.6g} Hz", columns)
