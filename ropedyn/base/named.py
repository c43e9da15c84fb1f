"""Arrays whose rows have names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike


class Named(np.ndarray[Any, np.dtype[np.float64]]):
    """An array of numbers, one or a row of them for each path of a scene.

    It is an array in every calculation, and a mapping from paths to its rows: ``dict(named)``.

    Parameters
    ----------
    values : array_like, shape (p, ...)
    paths : sequence of str, length p

    Attributes
    ----------
    paths : tuple of str or None
        None of an array that has not a row for each of them any more.

    Examples
    --------
    >>> from ropedyn.base.named import Named
    >>> value = Named([1000.0, 2.0], ["tension", "bending_stiffness"])
    >>> float(value["tension"]), float(value[1])
    (1000.0, 2.0)
    >>> value
    Named({'tension': 1000.0, 'bending_stiffness': 2.0})
    >>> print(value)
    tension 1000., bending_stiffness 2.
    """

    paths: tuple[str, ...] | None

    def __new__(cls, values: ArrayLike, paths: Sequence[str]) -> Named:
        """Copy the values."""
        named = np.array(values, dtype=np.float64).view(cls)
        named.paths = tuple(paths)
        return named

    def __array_finalize__(self, obj: Any) -> None:
        paths = getattr(obj, "paths", None)
        self.paths = paths if paths is not None and self.shape[:1] == (len(paths),) else None

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            return np.asarray(self)[self._row(key)]
        # rows that were taken out are no longer those of the paths
        return np.asarray(self)[key]

    def __contains__(self, key: object) -> bool:
        if isinstance(key, str):
            return key in self.keys()
        return bool(super().__contains__(key))

    def keys(self) -> tuple[str, ...]:
        """Return the paths."""
        return self.paths or ()

    def items(self) -> Iterator[tuple[str, Any]]:
        """Return the paths with their rows."""
        return zip(self.keys(), np.asarray(self))

    def __repr__(self) -> str:
        if self.paths is None:
            return repr(np.asarray(self))
        rows = {path: row.tolist() for path, row in self.items()}
        return f"Named({rows})"

    def __str__(self) -> str:
        if self.paths is None:
            return str(np.asarray(self))
        return ", ".join(
            f"{path} {np.array2string(row, precision=6)}" for path, row in self.items()
        )

    def __reduce__(self) -> tuple[Any, ...]:
        return Named, (np.asarray(self), self.paths or ())

    def _row(self, path: str) -> int:
        if path not in self.keys():
            raise KeyError(path)
        return self.keys().index(path)
