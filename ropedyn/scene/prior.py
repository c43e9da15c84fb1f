"""What is known of numbers of a scene before they are identified."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..base import check
from ..base.errors import SceneError
from ..base.parameter import Description, given
from ..base.table import Table
from .bench.bending_test import BendingTest
from .bench.static_test import StaticTest
from .bench.torsion_test import TorsionTest
from .path import unit_of
from .rope import given_tests


def _checked(known: Any) -> dict[str, tuple[float, float]]:
    what = 'a mapping such as {"tension": (300.0, 15.0)}'
    check.instance(known, "known", Mapping, what)
    if not known:
        raise SceneError(f"known must be {what} with at least one entry, got {{}}")
    return {_path(path): _pair(path, pair) for path, pair in known.items()}


def _path(path: Any) -> str:
    return str(check.instance(path, "path", str, 'a string such as "tension"'))


def _pair(path: str, pair: Any) -> tuple[float, float]:
    what = "a value and its standard uncertainty such as (300.0, 15.0)"
    name = f"prior[{path!r}]"
    check.instance(pair, name, (tuple, list), what)
    if len(pair) != 2:
        raise SceneError(f"{name} must be {what}, got {check.shown(pair)}")
    unit = unit_of(path)
    value = check.number(pair[0], f"{name}[0]", unit)
    return value, check.number(pair[1], f"{name}[1]", unit, sign="positive")


class Prior(Description, Mapping[str, tuple[float, float]], eq=False, repr=False):
    """Values of numbers of a scene with their standard uncertainties: independent and normal.

    A mapping from path to (value, std), which `identify` takes.

    Parameters
    ----------
    known : mapping from str to (float, float)
        Paths as ``"tension"`` or ``"bending_stiffness"``, and for each its value and standard
        uncertainty > 0, in the units of the scene.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If there is nothing, a value is not finite or an uncertainty not positive.

    Examples
    --------
    >>> import ropedyn as rd
    >>> prior = rd.Prior({"tension": (300.0, 15.0)})
    >>> prior["tension"]
    (300.0, 15.0)
    >>> bent = rd.BendingTest(0.5, [0.0, 2.0, 4.0], [1.0e-3, 2.5e-3, 4.1e-3])
    >>> print(prior | rd.Prior.of(bending=bent))
    known before
    path                 value     std
    -----------------  -------  ------
    tension                300      15
    bending_stiffness  53.7634  1.0013
    """

    known: Mapping[str, tuple[float, float]] = given(_checked)

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

    def __getitem__(self, path: str) -> tuple[float, float]:
        return self.known[path]

    def __iter__(self) -> Iterator[str]:
        return iter(self.known)

    def __len__(self) -> int:
        return len(self.known)

    def __or__(self, other: Mapping[str, tuple[float, float]]) -> Prior:
        """Return both, of a path that both have what the right one says."""
        if not isinstance(other, Mapping):
            return NotImplemented
        return Prior({**self, **other})

    def __repr__(self) -> str:
        return f"Prior({self.known!r})"

    def __str__(self) -> str:
        return str(self.table())

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def table(self) -> Table:
        """Return one row for each number.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Prior({"tension": (300.0, 15.0)}).table().column("std")
        (15.0,)
        """
        value, std = zip(*self.known.values())
        return Table.of("known before", {"path": tuple(self.known), "value": value, "std": std})


def _told(test: StaticTest) -> tuple[float, float]:
    if not 0 < test.std < float("inf"):
        raise SceneError(
            f"reading_std must be given to the {type(test).__name__}: its {len(test.load)} "
            f"readings tell no standard error, got {test.std:g} N m^2"
        )
    return test.stiffness, test.std
