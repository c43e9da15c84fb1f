"""What is known of numbers of a scene before they are identified."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...base.parameter import Description, depending, given
from ...base.table import Table
from ..path import signs_of, unit_of
from .bending_test import BendingTest
from .given import given_tests
from .joint_normal import EPS, JointNormal
from .laid import PATHS as laid_paths
from .laid import Laid
from .static_test import StaticTest
from .torsion_test import TorsionTest

NORMAL, LOG_NORMAL, LAID = DISTRIBUTIONS = ("normal", "log-normal", "laid")

POSITIVE = {"positive", "nonnegative", "nonzero"}  # Signs of what is positive by its nature.
MOST_FACTOR = 1e10  # Of what is known to a factor.
SIZES = (1e-150, 1e150)  # Relative std of log-normal numbers, whose squares are numbers.
EQUAL = 1e-6  # What is said twice agrees to this share.
MOST_DRAWN = 100_000_000  # Rows that are drawn at once.


def _checked(known: Any) -> dict[str, tuple[float, float]]:
    what = 'a mapping such as {"tension": (300.0, 15.0)}'
    check.instance(known, "known", Mapping, what)
    if not known:
        raise SceneError(f"known must be {what} with at least one entry, got {{}}")
    return {_path(path): _pair(path, pair) for path, pair in known.items()}


def _path(path: Any) -> str:
    return str(check.instance(path, "path", str, 'a string such as "tension"'))


def _two(name: str, pair: Any, what: str) -> None:
    check.instance(pair, name, (tuple, list), what)
    if len(pair) != 2:
        raise SceneError(f"{name} must be {what}, got {check.shown(pair)}")


def _pair(path: str, pair: Any) -> tuple[float, float]:
    name, unit = f"prior[{path!r}]", unit_of(path)
    _two(name, pair, "a value and its standard uncertainty such as (300.0, 15.0)")
    sign = "positive" if signs_of(path) == {"positive"} else "any"
    value = check.number(pair[0], f"{name}[0]", unit, sign=sign)
    return value, check.number(pair[1], f"{name}[1]", unit, sign="positive")


def _covariance(value: Any, name: str, prior: Prior) -> Real | None:
    """Return a covariance whose diagonal is that of the standard uncertainties."""
    if value is None:
        return None
    p, std = len(prior), prior.std
    covariance: Real = check.matrix(value, name, (p, p), "a row for each path", np.float64)
    share = covariance / np.outer(std, std)
    for i, path in enumerate(prior):
        if not abs(share[i, i] - 1) <= EQUAL:
            raise SceneError(
                f"{name}[{i}][{i}] must be the square of prior[{path!r}][1], "
                f"{std[i] ** 2:g}, got {covariance[i, i]:g}"
            )
    uneven = np.abs(share - share.T) > EQUAL
    if uneven.any():
        i, j = np.argwhere(uneven)[0]
        raise SceneError(
            f"{name} must be symmetric, got {covariance[i, j]:g} at [{i}][{j}] and "
            f"{covariance[j, i]:g} at [{j}][{i}]"
        )
    least = float(np.linalg.eigvalsh(share)[0])
    if least <= EPS:
        raise SceneError(
            f"{name} must be positive definite, got one whose correlations have the eigenvalue "
            f"{least:.3g}"
        )
    covariance.flags.writeable = False
    return covariance


def _distribution(value: Any, name: str, prior: Prior) -> dict[str, str]:
    """Return a word for each path, that of its nature where none is said."""
    if value is None or isinstance(value, Mapping):
        said = value or {}
    else:
        said = dict.fromkeys(prior, check.one_of(value, name, DISTRIBUTIONS))
    for path in said:
        check.one_of(path, f"key of {name}", tuple(prior))
        check.one_of(said[path], f"{name}[{path!r}]", DISTRIBUTIONS)
        if said[path] == LOG_NORMAL and not _may_be_log_normal(*prior[path]):
            raise SceneError(
                f"prior[{path!r}] must have a mean > 0 and a std between {SIZES[0]:g} and "
                f"{SIZES[1]:g} of it to be log-normal, got {prior[path]}"
            )
    laid = [path for path in laid_paths if said.get(path) == LAID]
    if LAID in said.values() and (len(laid) < 3 or list(said.values()).count(LAID) > 3):
        raise SceneError(
            f'{name} must be "laid" of axial_stiffness, lay_coupling and torsional_stiffness '
            f"together and of nothing else, got {check.shown(dict(said))}"
        )
    return {path: said.get(path, _natural(path, pair)) for path, pair in prior.items()}


def _natural(path: str, pair: tuple[float, float]) -> str:
    """Return log-normal of tensions, stiffnesses, masses, lengths and the like, which are > 0."""
    signs = signs_of(path)
    positive = path == "tension" or (signs and signs <= POSITIVE)
    return LOG_NORMAL if positive and _may_be_log_normal(*pair) else NORMAL


def _may_be_log_normal(mean: float, std: float) -> bool:
    return mean > 0 and SIZES[0] < std / mean < SIZES[1]


class Prior(Description, Mapping[str, tuple[float, float]], eq=False, repr=False):
    """What is known of numbers of a scene: values with standard uncertainties, correlated or not.

    A mapping from path to (value, std), which `identify` takes.

    Parameters
    ----------
    known : mapping from str to (float, float)
        Paths as ``"tension"`` or ``"bending_stiffness"``, and for each its mean and standard
        deviation > 0, in the units of the scene.
    covariance : array_like, shape (p, p), optional
        Of the numbers, in the order of the paths, with the squares of the standard deviations on
        its diagonal; independent where left out.
    distribution : {"normal", "log-normal", "laid"}, or mapping of it by path, optional
        Where left out log-normal of what is positive by its nature, as tension, stiffness, mass,
        length and damping, if its mean is; normal of the others, as positions and inclinations.
        "laid" of axial_stiffness EA, lay_coupling D and torsional_stiffness C together: ln EA, D/EA
        and ln(C - D^2/EA) are normal, so that none is a rope that cannot be.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If there is nothing, a value is not finite or an uncertainty not positive; if a covariance
        is not symmetric, positive definite and one of these uncertainties, or none that log-normal
        numbers can have.

    Notes
    -----
    A log-normal number has the mean and the standard deviation that are given:
    ln p ~ N(ln m - s^2/2, s^2) with s^2 = ln(1 + (std/m)^2). One as uncertain as it is large has
    its median at 0.71 m; what is known to a factor is better said by `Prior.by_factor`.

    Examples
    --------
    >>> import ropedyn as rd
    >>> prior = rd.Prior({"tension": (300.0, 15.0)})
    >>> prior["tension"]
    (300.0, 15.0)
    >>> bent = rd.BendingTest(0.5, [0.0, 2.0, 4.0], [1.0e-3, 2.5e-3, 4.1e-3])
    >>> print(prior | rd.Prior.of(bending=bent))
    known before
    path                 value     std  distribution
    -----------------  -------  ------  ------------
    tension                300      15  log-normal
    bending_stiffness  53.7634  1.0013  log-normal
    """

    known: Mapping[str, tuple[float, float]] = given(_checked)
    covariance: Any = depending(_covariance, default=None)
    distribution: Any = depending(_distribution, default=None)

    def _agree(self) -> None:
        """Refuse covariances that there are not."""
        self.law  # noqa: B018

    @staticmethod
    def of(*, bending: BendingTest | None = None, torsion: TorsionTest | None = None) -> Prior:
        """Return what tests say of a rope.

        Parameters
        ----------
        bending : BendingTest, optional
            Of ``"bending_stiffness"``.
        torsion : TorsionTest, optional
            Of ``"torsional_stiffness"``.

        Returns
        -------
        Prior

        Raises
        ------
        TypeError
            If something is no such test.
        SceneError
            If there is no test, or one with too few readings for a standard error, or with none.
        """
        return Prior({test.stiffness_name: _told(test) for test in given_tests(bending, torsion)})

    @staticmethod
    def by_factor(known: Mapping[str, tuple[float, float]]) -> Prior:
        """Return what is known to a factor: log-normal numbers by median and factor.

        Parameters
        ----------
        known : mapping from str to (float, float)
            For each path a median > 0 and a factor > 1: ln p ~ N(ln median, (ln factor)^2), so that
            with 68 % the number is between median/factor and median*factor.

        Returns
        -------
        Prior

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If there is nothing, a median is not positive or a factor not above 1.

        Examples
        --------
        >>> import ropedyn as rd
        >>> prior = rd.Prior.by_factor({"tension": (3.9e6, 1.1)})
        >>> [round(number) for number in prior["tension"]]
        [3917754, 374251]
        """
        check.instance(known, "known", Mapping, 'a mapping such as {"tension": (3.9e6, 1.5)}')
        return Prior(
            {_path(path): _by_factor(path, pair) for path, pair in known.items()},
            distribution=LOG_NORMAL,
        )

    def __getitem__(self, path: str) -> tuple[float, float]:
        return self.known[path]

    def __iter__(self) -> Iterator[str]:
        return iter(self.known)

    def __len__(self) -> int:
        return len(self.known)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Prior):
            return Mapping.__eq__(self, other)
        return (
            dict(self.known) == dict(other.known)
            and dict(self.distribution) == dict(other.distribution)
            and list(self) == list(other)
            and np.array_equal(self.correlation, other.correlation)
        )

    __hash__ = None  # type: ignore[assignment]

    def __or__(self, other: Mapping[str, tuple[float, float]]) -> Prior:
        """Return both, of a path that both have what the right one says."""
        if not isinstance(other, Mapping):
            return NotImplemented
        right = other if isinstance(other, Prior) else Prior(other)
        kept = [path for path in self if path not in right]
        return _joined([self.marginal(kept), right] if kept else [right], {**self, **right})

    def __repr__(self) -> str:
        told = [repr(dict(self.known))]
        if self.covariance is not None:
            told.append(f"covariance={self.covariance.tolist()!r}")
        if any(self.distribution[path] != _natural(path, self[path]) for path in self):
            told.append(f"distribution={dict(self.distribution)!r}")
        return f"Prior({', '.join(told)})"

    def __str__(self) -> str:
        return str(self.table())

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    @property
    def mean(self) -> Real:
        """Means of the numbers, shape (p,)."""
        return np.array([value for value, _ in self.known.values()])

    @property
    def std(self) -> Real:
        """Standard deviations of the numbers, shape (p,)."""
        return np.array([std for _, std in self.known.values()])

    @property
    def correlation(self) -> Real:
        """Between the numbers, shape (p, p).

        Examples
        --------
        >>> import ropedyn as rd
        >>> known = {"tension": (300.0, 10.0), "length": (2.0, 0.1)}
        >>> rd.Prior(known, covariance=[[100.0, 0.5], [0.5, 0.01]]).correlation.tolist()
        [[1.0, 0.5], [0.5, 1.0]]
        """
        correlation = np.eye(len(self))
        if self.covariance is not None:
            correlation = self.covariance / np.outer(self.std, self.std)
            np.fill_diagonal(correlation, 1.0)
        return correlation

    @computed
    def law(self) -> JointNormal:
        """The joint distribution.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Prior({"tension": (300.0, 15.0)}).law.by_log.tolist()
        [True]
        """
        by_log = np.array([self._by_log(path) for path in self])
        laid = None
        if LAID in self.distribution.values():
            laid = Laid(*(list(self).index(path) for path in laid_paths))
        correlation = None if self.covariance is None else self.correlation
        return JointNormal.of(self.mean, self.std, by_log, correlation, laid)

    def _by_log(self, path: str) -> bool:
        """Whether a variable of the law is the logarithm of a number, or of C - D^2/EA."""
        word = self.distribution[path]
        return word == LOG_NORMAL or (word == LAID and path != "lay_coupling")

    def table(self) -> Table:
        """Return one row for each number, with correlations where there are any.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Prior({"tension": (300.0, 15.0)}).table().column("std")
        (15.0,)
        """
        columns: dict[str, Any] = {
            "path": tuple(self),
            "value": tuple(self.mean.tolist()),
            "std": tuple(self.std.tolist()),
            "distribution": tuple(self.distribution.values()),
        }
        if self.covariance is not None:
            for path, column in zip(self, self.correlation.T.tolist()):
                columns[f"correlation with {path}"] = tuple(column)
        return Table.of("known before", columns)

    def marginal(self, paths: Iterable[str]) -> Prior:
        """Return what is known of some of the numbers, in another order if asked.

        Parameters
        ----------
        paths : iterable of str
            Some of the paths.

        Returns
        -------
        Prior

        Raises
        ------
        SceneError
            If there is none of these paths, or they are none.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Prior({"tension": (300.0, 15.0), "length": (2.0, 0.01)}).marginal(["length"])
        Prior({'length': (2.0, 0.01)})
        """
        paths = [check.one_of(path, "path", tuple(self)) for path in paths]
        at = np.array([list(self).index(path) for path in paths], dtype=np.intp)
        covariance = None if self.covariance is None else self.covariance[np.ix_(at, at)]
        known, words = {path: self[path] for path in paths}, dict(self.distribution)
        if not set(laid_paths) <= set(paths):
            # of some laid numbers no law is known but their moments
            words = {path: NORMAL if word == LAID else word for path, word in words.items()}
        return Prior(
            known, covariance=covariance, distribution={path: words[path] for path in known}
        )

    def residual(self, values: ArrayLike) -> tuple[Real, Real]:
        """Return independent residuals of variance 1, as least squares add them, and their slopes.

        Of one independent normal number (p - mean)/std, of a log-normal one
        (ln p - ln median)/s; of correlated numbers combinations of these.

        Parameters
        ----------
        values : array_like, shape (n, p)
            Rows of numbers, in the order of the paths.

        Returns
        -------
        residual : ndarray, shape (n, p)
            NaN or infinite where a log-normal number is not positive.
        slope : ndarray, shape (n, p, p)
            Derivatives of the residuals by the numbers.

        Raises
        ------
        SceneError
            If the rows have not a number for each path.

        Examples
        --------
        >>> import ropedyn as rd
        >>> prior = rd.Prior({"tension": (300.0, 15.0)}, distribution="normal")
        >>> residual, slope = prior.residual([[330.0]])
        >>> residual.round(9).tolist(), slope.round(9).tolist()
        ([[2.0]], [[[0.066666667]]])
        """
        return self.law.residual(self._rows(values))

    def log_density(self, values: ArrayLike) -> Real:
        """Return the logarithm of the density of numbers.

        Parameters
        ----------
        values : array_like, shape (n, p)
            Rows of numbers, in the order of the paths.

        Returns
        -------
        ndarray, shape (n,)
            Minus infinity where a log-normal number is not positive.

        Raises
        ------
        SceneError
            If the rows have not a number for each path.

        Examples
        --------
        >>> import ropedyn as rd
        >>> prior = rd.Prior({"tension": (300.0, 15.0)}, distribution="normal")
        >>> prior.log_density([[300.0], [330.0]]).round(4).tolist()
        [-3.627, -5.627]
        """
        return self.law.log_density(self._rows(values))

    def draw(self, rng: np.random.Generator, n: int) -> Real:
        """Draw numbers at random.

        Parameters
        ----------
        rng : numpy.random.Generator
            What draws; of the same seed the same numbers.
        n : int
            How many rows.

        Returns
        -------
        ndarray, shape (n, p)
            In the order of the paths.

        Raises
        ------
        TypeError
            If `rng` is no generator or `n` no whole number.
        SceneError
            If `n` is not positive.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> prior = rd.Prior({"tension": (300.0, 15.0)})
        >>> prior.draw(np.random.default_rng(1), 2).round(2).tolist()
        [[304.84], [312.18]]
        """
        what = "a numpy.random.Generator such as numpy.random.default_rng(1)"
        check.instance(rng, "rng", np.random.Generator, what)
        n = check.count(n, "n", most=MOST_DRAWN)
        return self.law.colour(rng.standard_normal((n, len(self))))

    def _rows(self, values: ArrayLike) -> Real:
        rows = np.asarray(values, dtype=np.float64)
        if rows.ndim != 2 or rows.shape[1] != len(self):
            raise SceneError(
                f"values must be rows of {len(self)} numbers, in the order of the paths, got an "
                f"array of shape {rows.shape}"
            )
        return rows


def _joined(priors: list[Prior], order: Iterable[str]) -> Prior:
    """Return priors that know nothing of each other as one, in an order of the paths."""
    known = {path: pair for prior in priors for path, pair in prior.items()}
    covariance = None
    if any(prior.covariance is not None for prior in priors):
        covariance, at = np.zeros((len(known), len(known))), 0
        for prior in priors:
            block = slice(at, at := at + len(prior))
            covariance[block, block] = prior.correlation * np.outer(prior.std, prior.std)
    distribution = {path: word for prior in priors for path, word in prior.distribution.items()}
    return Prior(known, covariance=covariance, distribution=distribution).marginal(order)


def _by_factor(path: str, pair: Any) -> tuple[float, float]:
    """Return mean and standard deviation of a log-normal number by its median and its factor."""
    name = f"known[{path!r}]"
    _two(name, pair, "a median and a factor such as (3.9e6, 1.5)")
    median = check.number(pair[0], f"{name}[0]", unit_of(path), sign="positive")
    factor = check.number(pair[1], f"{name}[1]", sign="positive")
    if factor <= 1 or factor > MOST_FACTOR:
        raise SceneError(f"{name}[1] must be a factor > 1 and <= {MOST_FACTOR:g}, got {factor!r}")
    variance = math.log(factor) ** 2
    mean = median * math.exp(variance / 2)
    return mean, mean * math.sqrt(math.expm1(variance))


def _told(test: StaticTest) -> tuple[float, float]:
    if not 0 < test.std < float("inf"):
        raise SceneError(
            f"reading_std must be given to the {type(test).__name__}: its {len(test.load)} "
            f"readings tell no standard error, got {test.std:g} N m^2"
        )
    return test.stiffness, test.std
