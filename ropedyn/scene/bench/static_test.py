"""What bending and torsion tests share: a stiffness is load times a factor per reading."""

from __future__ import annotations

import math
from typing import Any, ClassVar, NamedTuple

import numpy as np

from ...base import check
from ...base.answer import Answer
from ...base.array import Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...base.parameter import parameters
from ...base.table import Table


class StaticTest(Answer):
    """Base of tests: reading = offset + factor load/stiffness, by least squares.

    Examples
    --------
    >>> import ropedyn as rd
    >>> test = rd.TorsionTest(0.5, [0.0, 0.01, 0.02], [0.0, 0.034, 0.067])
    >>> test.load, test.reading, test.factor
    (array([0.  , 0.01, 0.02]), array([0.   , 0.034, 0.067]), 0.5)
    >>> test.load_label, test.reading_label
    ('torque [N m]', 'angle [rad]')
    >>> print(test.title)
    torsional stiffness C = 0.149254 +- 0.0013 N m^2
    >>> (test.residual * 1e3).round(2), round(test.line.slope, 3)
    (array([-0.17,  0.33, -0.17]), 3.35)
    """

    stiffness_name: ClassVar[str]
    symbol: ClassVar[str]
    names: ClassVar[tuple[str, str]]  # the parameters that are load and reading
    zero: float | None
    reading_std: float | None

    @property
    def load(self) -> Real:
        """What was put on [N, N m], shape (k,)."""
        return np.asarray(getattr(self, self.names[0]))

    @property
    def reading(self) -> Real:
        """What was read [m, rad], shape (k,)."""
        return np.asarray(getattr(self, self.names[1]))

    @property
    def load_label(self) -> str:
        """What was put on, with its unit."""
        return self._label(0)

    @property
    def reading_label(self) -> str:
        """What was read, with its unit."""
        return self._label(1)

    def _label(self, which: int) -> str:
        test: Any = self
        name = self.names[which]
        return f"{name} [{parameters(test)[name].unit}]"

    @property
    def factor(self) -> float:
        """Reading per load times the stiffness."""
        raise NotImplementedError

    @computed
    def line(self) -> StraightLine:
        """The straight line through the readings."""
        return StraightLine.through(self.load, self.reading, offset=self.zero, std=self.reading_std)

    @property
    def stiffness(self) -> float:
        """The stiffness [N m^2]."""
        return self.factor / self.line.slope

    @property
    def std(self) -> float:
        """Standard error of the stiffness [N m^2], to first order; infinite where none is left."""
        return self.stiffness * self.line.std / self.line.slope

    @property
    def offset(self) -> float:
        """Reading without load [m, rad]: the fitted one, or `zero`."""
        return self.line.offset

    @property
    def residual(self) -> Real:
        """Reading less the line [m, rad], shape (k,)."""
        return self.line.residual

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Return a confidence interval of the stiffness.

        Parameters
        ----------
        confidence : float
            Between 0 and 1.

        Returns
        -------
        tuple of float
            [N m^2], from Student's t interval of the slope: not symmetric about the stiffness. The
            upper one is infinite where the readings may as well not depend on the load.

        Raises
        ------
        TypeError
            If it is not a number.
        SceneError
            If it is not between 0 and 1.

        Examples
        --------
        >>> import ropedyn as rd
        >>> test = rd.TorsionTest(0.5, [0.0, 0.01, 0.02], [0.0, 0.034, 0.067], reading_std=1e-3)
        >>> [round(bound, 4) for bound in test.interval(0.95)]
        [0.1433, 0.1557]
        """
        share = check.number(confidence, "confidence", sign="positive")
        if not share < 1:
            raise SceneError(f"confidence must be between 0 and 1, got {confidence!r}")
        least, most = self.line.interval(share)
        return self.factor / most, self.factor / least if least > 0 else math.inf

    def _check_readings(self) -> None:
        """Refuse what has no line, or none that goes up."""
        loads, readings = self.names
        if len(self.load) != len(self.reading):
            raise SceneError(
                f"{readings} must have as many numbers as {loads}, {len(self.load)}, "
                f"got {len(self.reading)}"
            )
        if self.zero is None and not np.ptp(self.load) > 0:
            raise SceneError(
                f"{loads} must hold two different numbers, or the reading without load must be "
                f"given as zero, got {check.shown(self.load.tolist())}"
            )
        if not self.load.any():
            raise SceneError(f"{loads} must hold a number other than 0, got all 0")
        if not self.line.slope > 0:
            raise SceneError(
                f"{readings} must grow with {loads}, got the slope {self.line.slope:.6g}: check "
                "the signs"
            )

    def table(self) -> Table:
        """Return one row for each reading."""
        columns: dict[str, Any] = {
            self.load_label: self.load,
            self.reading_label: self.reading,
            self.reading_label.replace(self.names[1], "residual"): self.residual,
        }
        return Table.of(self.title, columns)

    @property
    def title(self) -> str:
        """What was found, in words."""
        error = f" +- {self.std:.2g}" if math.isfinite(self.std) else ""
        name = self.stiffness_name.replace("_", " ")
        return f"{name} {self.symbol} = {self.stiffness:.6g}{error} N m^2"


class StraightLine(NamedTuple):
    """y = offset + slope x."""

    slope: float  # of least squares; an offset that was given is itself
    offset: float  # of least squares; an offset that was given is itself
    std: float  # standard error of the slope, infinite where no y is left over to tell it
    residual: Real  # (k,) y less the line
    # degrees of freedom of the standard error, infinite where that of each y was given
    freedom: float

    @staticmethod
    def through(x: Real, y: Real, *, offset: float | None, std: float | None) -> StraightLine:
        """Return the line of k points; x must not be constant, nor 0 where the offset is given.

        With A = [x, 1], or x alone where the offset is given, the covariance is s^2 (A^T A)^-1; s
        is the standard uncertainty of each y, where that is left out the root of the sum of squared
        residuals per degree of freedom (Draper and Smith, Applied Regression Analysis, 3rd ed.,
        section 1.4).
        """
        width = float(np.abs(x).max())
        A = (x / width)[:, None]
        if offset is None:
            A = np.stack([A[:, 0], np.ones_like(x)], axis=1)
        known = 0.0 if offset is None else offset
        found = np.linalg.lstsq(A, y - known, rcond=None)[0]
        residual = y - known - A @ found
        freedom = len(x) - A.shape[1]
        if std is not None:
            s, freedom = std, math.inf
        else:
            s = math.sqrt(residual @ residual / freedom) if freedom > 0 else math.inf
        share = np.linalg.inv(A.T @ A)[0, 0]
        return StraightLine(
            slope=float(found[0]) / width,
            offset=known if offset is not None else float(found[1]),
            std=s * math.sqrt(share) / width,
            residual=residual,
            freedom=freedom,
        )

    def interval(self, confidence: float) -> tuple[float, float]:
        """Return the two-sided confidence interval of the slope, by Student's t."""
        from scipy.special import ndtri, stdtrit

        if not math.isfinite(self.std):
            return -math.inf, math.inf
        p = (1 + confidence) / 2
        t = ndtri(p) if math.isinf(self.freedom) else stdtrit(self.freedom, p)
        half = float(t) * self.std
        return self.slope - half, self.slope + half
