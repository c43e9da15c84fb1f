"""Nodes and directions of universal files as points of a rope."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.errors import SceneError
from ...chain.port import Point
from . import uff
from .uff import DIRECTIONS, OWN, Record

AXES = ("X", "Y", "Z")
"""Of the nodes in a file."""


class Line(NamedTuple):
    """One response to one drive."""

    record: Record
    response: Point
    drive: Point
    sign: int


def located(records: Sequence[Record], file: Path, positions: Any, coordinate: Any) -> list[Line]:
    """Say where on the rope each record is and which way it counts."""
    own = [(record, m) for record in records if (m := OWN.match(record.fields["id2"]))]
    if positions is None and coordinate is None and len(own) == len(records):
        return [_own(record, match) for record, match in own]
    where = _positions(positions, records, file)
    lines = []
    for record in records:
        rx, dx = (where[record.fields[side]] for side in ("rsp_node", "ref_node"))
        if rx is None or dx is None:
            continue
        codes = [record.fields[side] for side in ("rsp_dir", "ref_dir")]
        (r, plus), (d, minus) = (_turned(code, coordinate, records, file) for code in codes)
        lines.append(Line(record, (r, rx), (d, dx), plus * minus))
    if not lines:
        raise SceneError(f"positions must leave a response of {str(file)!r}, got {positions!r}")
    return lines


def _own(record: Record, match: re.Match[str]) -> Line:
    """Return the points that `write` has written down."""
    points = []
    for name, x in (match["r"], match["rx"]), (match["d"], match["dx"]):
        try:
            at = float(x)
        except ValueError:
            at = np.nan
        points.append(
            check.point((name, at), "the second line of a record", check.COORDINATES, None)
        )
    return Line(record, points[0], points[1], 1)


def _positions(given: Any, records: Sequence[Record], file: Path) -> dict[int, float | None]:
    """Return where each node is, None for one that is left out."""
    nodes = sorted({record.fields[side] for record in records for side in ("rsp_node", "ref_node")})
    what = f"a position [m] for each node of {str(file)!r} ({', '.join(map(str, nodes))})"
    if given is None:
        raise SceneError(
            f'positions must be {what}, such as {{{nodes[0]}: 0.5}}, or "X", "Y" or "Z", got None'
        )
    if isinstance(given, str):
        axis = check.one_of(given, "positions", AXES)
        given = uff.nodes(file, axis)
    check.instance(given, "positions", Mapping, what)
    for node in nodes:
        if node not in given:
            raise SceneError(
                f"positions must be {what}, got {check.shown(dict(given))} without node {node}; "
                "None leaves a node out"
            )
    return {node: check.optional(given[node], f"positions[{node}]", "m") for node in nodes}


def _turned(code: int, coordinate: Any, records: Sequence[Record], file: Path) -> tuple[str, int]:
    """Return which coordinate of the rope a direction is and with which sign."""
    axis = DIRECTIONS[abs(code)] if abs(code) < len(DIRECTIONS) else str(code)
    codes = {abs(r.fields[side]) for r in records for side in ("rsp_dir", "ref_dir")}
    axes = [DIRECTIONS[k] if k < len(DIRECTIONS) else str(k) for k in sorted(codes)]
    what = f"which coordinate of the rope each direction in {str(file)!r} is ({', '.join(axes)})"
    such = f'such as {{"{axes[0]}": "z"}}'
    if isinstance(coordinate, str) and len(axes) == 1:
        coordinate = {axes[0]: coordinate}
    if not isinstance(coordinate, (str, Mapping, type(None))):
        raise TypeError(f"coordinate must say {what}, {such}, got {check.shown(coordinate)}")
    if not isinstance(coordinate, Mapping) or axis not in coordinate:
        raise SceneError(f"coordinate must say {what}, {such}, got {check.shown(coordinate)}")
    name = coordinate[axis]
    signed = [sign + word for word in check.COORDINATES for sign in ("", "-")]
    check.one_of(name, f"coordinate[{axis!r}]", signed)
    sign = -1 if name.startswith("-") != (code < 0) else 1
    return name.removeprefix("-"), sign


def chosen(lines: Sequence[Line], file: Path, drive: Any, response: Any) -> list[Line]:
    """Return the responses to one drive, one for each point."""
    drives = list(dict.fromkeys(line.drive for line in lines))
    if drive is None and len(drives) > 1:
        one = len({line.response for line in lines}) == 1
        raise SceneError(
            f"drive must be one of those of {str(file)!r}, {_list(drives)}, got None"
            + one * "; with reciprocal=True these are watched and what was watched is driven"
        )
    cause = drives[0] if drive is None else _one(drive, "drive", drives, file)
    to_it = [line for line in lines if line.drive == cause]
    if response is not None:
        points = check.points(response, "response", forces=True)
        points = (points,) if isinstance(points[0], str) else points
        there = list(dict.fromkeys(line.response for line in to_it))
        wanted = [_one(point, "response", there, file) for point in points]
        to_it = [line for point in wanted for line in to_it if line.response == point]
    for k, line in enumerate(to_it):
        for other in to_it[:k]:
            if other.response == line.response:
                both = f"{other.record.number} and {line.record.number} of {str(file)!r}"
                raise SceneError(
                    f"records must leave one of datasets {both}: both are {line.response!r} to "
                    f"{cause!r}"
                )
    return to_it


def _one(given: Any, name: str, there: Sequence[Point], file: Path) -> Point:
    point = check.points(given, name, forces=name == "response")
    for one in there:
        if point[0] == one[0] and abs(point[1] - one[1]) <= check.NEAR * abs(one[1]):
            return one
    raise SceneError(f"{name} must be one of those of {str(file)!r}, {_list(there)}, got {given!r}")


def _list(points: Sequence[Point]) -> str:
    return ", ".join(map(repr, points))
