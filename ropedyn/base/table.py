"""Tables: what every answer can show as text, HTML, CSV and data frame."""

from __future__ import annotations

import csv
import html
import io
import json
import math
import re
import textwrap
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import check, extra
from .errors import SceneError

if TYPE_CHECKING:
    import pandas as pd


SHOWN, PRINTED = 9, 60  # Rows that a prompt and `print` show at most, with the gap.
WIDTH = 80  # Characters of a line at a prompt.


class Key(NamedTuple):
    """What programs call a column."""

    key: str  # of small letters, digits and underscores
    name: str  # without units
    unit: str  # "" of what has none

    @classmethod
    def of(cls, column: str) -> Key:
        """Part a heading, such as "frequency [Hz]" or "|z at 0.5 m [m/N]|"."""
        heading = column.replace("|", "")
        units = re.findall(r"\[([^\]]*)\]", heading)
        name = re.sub(r"\s*\[[^\]]*\]", "", heading)
        if column.startswith("|"):
            name = f"amplitude of {name}"
        return cls(_snake(name), name, units[-1] if units else "")


def _snake(words: str) -> str:
    return re.sub(r"[^0-9a-z]+", "_", words.lower()).strip("_")


def _number(value: Any) -> Any:
    """Return what JSON knows; None of what is not finite."""
    if isinstance(value, complex):
        return [value.real, value.imag]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _sheet(value: Any) -> Any:
    """Return what JSON has for something that a report says."""
    if isinstance(value, Table):
        return value._records()
    if isinstance(value, Mapping):
        return {str(name): _sheet(one) for name, one in value.items()}
    if isinstance(value, (np.ndarray, np.generic)):
        value = value.tolist()
    return [_sheet(one) for one in value] if isinstance(value, (list, tuple)) else _number(value)


@dataclass(frozen=True, repr=False)
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
        return self.to_text(rows=PRINTED)

    def __repr__(self) -> str:
        beyond = _wrapped(self._heading(0, 0), WIDTH).count("\n")
        return self.to_text(rows=max(1, SHOWN - beyond), width=WIDTH)

    def to_text(self, *, rows: int | None = None, width: int | None = None) -> str:
        """Return the table as text: whole, or its head and tail and the columns that fit.

        Parameters
        ----------
        rows : int, optional
            As many at most, the first and the last of them.
        width : int, optional
            Characters of a line at most, for which the last columns are left out.

        Examples
        --------
        >>> import ropedyn as rd
        >>> print(rd.Table.of("squares", {"n": range(100), "n n": [n * n for n in range(100)]}))
        ... # doctest: +ELLIPSIS
        squares, 100 rows
        ...
        >>> few = rd.Table.of("squares", {"n": range(5), "n n": [n * n for n in range(5)]})
        >>> print(few.to_text(rows=3))
        squares, 5 rows
          n  n n
        ---  ---
          0    0
        ...  ...
          4   16
        """
        shown = self._shown(rows)
        cells = [list(self.columns), *([_text(v) for v in row] for row in shown)]
        if len(shown) < len(self.rows):
            cells.insert(1 + (len(shown) + 1) // 2, ["..."] * len(self.columns))
        right = [all(not isinstance(row[k], str) for row in shown) for k in range(len(cells[0]))]
        widths = [max(len(row[k]) for row in cells) for k in range(len(cells[0]))]
        kept = self._fitting(widths, width)
        lines = [
            "  ".join(
                row[k].rjust(widths[k]) if right[k] else row[k].ljust(widths[k])
                for k in range(kept)
            ).rstrip()
            for row in cells
        ]
        rule = "  ".join("-" * width for width in widths[:kept])
        return "\n".join(
            [_wrapped(self._heading(len(shown), kept), width), lines[0], rule, *lines[1:]]
        )

    def _shown(self, most: int | None) -> tuple[tuple[Any, ...], ...]:
        """Return the first and the last rows, one less than may be where some are left out."""
        if most is None or len(self.rows) <= most:
            return self.rows
        return self.rows[: most // 2] + self.rows[len(self.rows) - (most - 1) // 2 :]

    def _fitting(self, widths: list[int], width: int | None) -> int:
        """Return how many columns fit into a line, one at least."""
        ends = np.cumsum([0, *widths]) + 2 * np.arange(len(widths) + 1) - 2
        if width is None:
            return len(widths)
        return max(1, int(np.searchsorted(ends, width, side="right")) - 1)

    def _heading(self, rows: int, columns: int) -> str:
        parts = [self.title]
        if rows < len(self.rows):
            parts.append(f"{len(self.rows)} rows")
        if columns < len(self.columns):
            parts.append(f"{columns} of {len(self.columns)} columns")
        return ", ".join(parts)

    def _repr_html_(self) -> str:
        shown = self._shown(PRINTED)
        rows = [[html.escape(_text(v)) for v in row] for row in shown]
        if len(shown) < len(self.rows):
            rows.insert((len(shown) + 1) // 2, ["..."] * len(self.columns))
        head = "".join(f"<th>{html.escape(c)}</th>" for c in self.columns)
        body = "".join(
            "<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>" for row in rows
        )
        caption = f"<caption>{html.escape(self._heading(len(shown), len(self.columns)))}</caption>"
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def to_csv(self) -> str:
        """Return the table as comma-separated text with every digit, under the keys of its JSON.

        Examples
        --------
        >>> import ropedyn as rd
        >>> table = rd.Table.of("two ropes", {"rope": ("thin", "thick"), "mass [kg]": (0.1, 0.25)})
        >>> print(table.to_csv(), end="")
        rope,mass
        thin,0.1
        thick,0.25
        """
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(one.key for one in self.keys)
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

    @property
    def keys(self) -> tuple[Key, ...]:
        """What programs call the columns, with their units.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Peaks([64.0, 130.0]).table().keys[0]
        Key(key='frequency', name='frequency', unit='Hz')
        """
        found = [Key.of(column) for column in self.columns]
        units = [_snake(one.unit.replace("%", "percent")) for one in found]
        # units part what is called alike, and numbers what has the same unit too
        for words in (units, [str(k) for k in range(len(found))]):
            often = Counter(one.key for one in found)
            found = [
                one._replace(key=f"{one.key}_{word}") if often[one.key] > 1 and word else one
                for one, word in zip(found, words)
            ]
        return tuple(found)

    def to_json(self, details: Mapping[str, Any] | None = None) -> str:
        """Return the table as JSON of the schema "ropedyn.table/1": `ropedyn schema table`.

        Parameters
        ----------
        details : mapping, optional
            What is said beside the table: numbers, texts, arrays, tables, and lists of these.

        Examples
        --------
        >>> import json
        >>> import ropedyn as rd
        >>> sheet = json.loads(rd.Peaks([64.0, 130.0]).table().to_json())
        >>> sheet["schema"], sheet["columns"][0]["unit"], sheet["rows"][1]["frequency"]
        ('ropedyn.table/1', 'Hz', 130.0)
        """
        keys = self.keys
        document: dict[str, Any] = {
            "schema": "ropedyn.table/1",
            "title": self.title,
            "columns": [one._asdict() for one in keys],
            "rows": self._records(),
        }
        if details:
            document["details"] = {name: _sheet(value) for name, value in details.items()}
        return json.dumps(document, indent=1, allow_nan=False)

    def _records(self) -> list[dict[str, Any]]:
        names = [one.key for one in self.keys]
        return [dict(zip(names, map(_number, row))) for row in self.rows]

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


def _wrapped(text: str, width: int | None) -> str:
    """Return a text in lines that fit, each of its own lines apart."""
    if width is None:
        return text
    return "\n".join(textwrap.fill(line, width) for line in text.split("\n"))


def _text(value: Any) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, complex):
        return f"{value:.6g}"
    return str(value)
