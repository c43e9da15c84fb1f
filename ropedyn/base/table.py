"""Tables: what every answer can show as text, HTML, CSV and data frame."""

from __future__ import annotations

import csv
import html
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from . import check, extra
from .errors import SceneError

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Table:
    """Named columns with their units, in rows.

    Attributes
    ----------
    title : str
        What the table shows.
    columns : tuple of str
        Names, with units in brackets.
    rows : tuple of tuple
        Numbers, strings or None where there is nothing.

    Examples
    --------
    >>> import ropedyn as rd
    >>> table = rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)})
    >>> print(table)
    two ropes
    rope   mass [kg]
    -----  ---------
    thin         0.1
    thick       0.25
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Any, ...], ...]

    @staticmethod
    def of(title: str, columns: Mapping[str, Sequence[Any] | np.ndarray[Any, Any]]) -> Table:
        """Build a table from columns of equal length.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)}).rows
        (('thin', 0.1), ('thick', 0.25))
        """
        check.instance(columns, "columns", Mapping, "a mapping from names to columns")
        values = [
            np.asarray(c).tolist() if not isinstance(c, tuple) else c for c in columns.values()
        ]
        if len({len(column) for column in values}) > 1:
            lengths = {name: len(column) for name, column in zip(columns, values)}
            raise SceneError(f"columns must have equal lengths, got {lengths}")
        return Table(title, tuple(columns), tuple(zip(*values)))

    def column(self, name: str) -> tuple[Any, ...]:
        """Return one column.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Peaks([64.0, 130.0]).table().column("frequency [Hz]")
        (64.0, 130.0)
        """
        at = self.columns.index(check.one_of(name, "name", self.columns))
        return tuple(row[at] for row in self.rows)

    def __str__(self) -> str:
        cells = [list(self.columns)] + [[_text(v) for v in row] for row in self.rows]
        widths = [max(len(row[k]) for row in cells) for k in range(len(self.columns))]
        right = [all(not isinstance(row[k], str) for row in self.rows) for k in range(len(widths))]
        lines = [
            "  ".join(
                cell.rjust(width) if number else cell.ljust(width)
                for cell, width, number in zip(row, widths, right)
            ).rstrip()
            for row in cells
        ]
        rule = "  ".join("-" * width for width in widths)
        return "\n".join([self.title, lines[0], rule, *lines[1:]])

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{html.escape(c)}</th>" for c in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{html.escape(_text(v))}</td>" for v in row) + "</tr>"
            for row in self.rows
        )
        caption = f"<caption>{html.escape(self.title)}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def to_csv(self) -> str:
        """Return the table as comma-separated text with every digit.

        Examples
        --------
        >>> import ropedyn as rd
        >>> table = rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)})
        >>> print(table.to_csv(), end="")
        rope,mass [kg]
        thin,0.1
        thick,0.25
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows(self.rows)
        return text.getvalue()

    def to_records(self) -> list[dict[str, Any]]:
        """Return one dictionary for each row.

        Examples
        --------
        >>> import ropedyn as rd
        >>> table = rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)})
        >>> table.to_records()
        [{'rope': 'thin', 'mass [kg]': 0.1}, {'rope': 'thick', 'mass [kg]': 0.25}]
        """
        return [dict(zip(self.columns, row)) for row in self.rows]

    def to_dataframe(self) -> pd.DataFrame:
        """Return a pandas data frame.

        Raises
        ------
        ImportError
            If pandas is missing; ``pip install 'ropedyn[io]'`` brings it.

        Examples
        --------
        >>> import ropedyn as rd
        >>> table = rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)})
        >>> list(table.to_dataframe()["rope"])
        ['thin', 'thick']
        """
        return extra.pandas().DataFrame(list(self.rows), columns=list(self.columns))


def numbers(values: np.ndarray[Any, Any]) -> tuple[float | None, ...]:
    """Return numbers for a column, None for NaN."""
    return tuple(None if np.isnan(value) else value for value in values.tolist())


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, complex):
        return f"{value:.6g}"
    return str(value)
