"""The axis of a rope in space."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.array import Index, Real
from ..base.errors import SceneError
from .catenary import catenaries, checked_loads, placed
from .piece import CatenaryPiece, Piece, UniformPiece
from .polyline import checked_points, polyline

TURNED = 1e-12  # Frames that differ by less are one.

Vector = tuple[float, float, float]


class Kink(NamedTuple):
    """A joint at which the frame jumps.

    Attributes
    ----------
    s : float
        Where [m].
    turn : ndarray, shape (3, 3)
        Takes components in the frame on its left to those in the frame on its right.
    """

    s: float
    turn: Real


@dataclass(frozen=True)
class Axis:
    """The line that a rope follows in space, by arc length s from its left end.

    Made by `line`, `arc`, `ring`, `helix`, `catenary` or `points`. The frame of a section is
    right-handed: x along the tangent, z towards the centre of the curve, y = z cross x. Along
    the axis it turns by the rates (tau, kz, ky) that belong to (alpha, beta, gamma):
    x' = kz z + ky y, and tau turns it about x; here ky = 0. A joint at which it jumps is a kink.

    Attributes
    ----------
    pieces : tuple
        One after another: ``UniformPiece(length, torsion, curvature)`` [m, rad/m], a line, an arc
        or a helix, or ``CatenaryPiece(length, parameter, begin)`` [m].
    begins : tuple of (position, frame)
        Of each piece, in space: x, y, z [m], and rows of the matrix whose columns are the unit
        vectors of the frame.
    words : mapping
        What made it, as a file keeps it: `from_words`.
    closed : bool
        Whether its end is its beginning, as of a `ring`: a rope on it has no ends.

    Examples
    --------
    A quarter of a circle, and where it ends:

    >>> import math
    >>> import ropedyn as rd
    >>> arc = rd.Axis.arc(2.0, math.pi / 2)
    >>> arc.position(arc.length).round(9), arc.rates(0.0)
    (array([2., 0., 2.]), array([0. , 0.5, 0. ]))

    A spring of ten turns:

    >>> spring = rd.Axis.helix(0.005, math.radians(8.5744), 10)
    >>> print(round(spring.length, 4), spring.rates(0.0).round(3))
    0.3177 [ 29.485 195.554   0.   ]
    """

    pieces: tuple[Piece, ...]
    begins: tuple[tuple[Vector, tuple[Vector, Vector, Vector]], ...]
    words: Mapping[str, Any] = field(default_factory=dict, repr=False, compare=False)
    closed: bool = False

    @staticmethod
    def from_words(words: Mapping[str, Any]) -> Axis:
        """Return the axis that its `words` say, as a file keeps them.

        Parameters
        ----------
        words : mapping
            ``kind``, "line", "arc", "ring", "helix", "catenary" or "points", the arguments of what
            makes it, and perhaps ``reversed``.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If there is no such kind, an argument is missing or unknown, or as what makes it does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.from_words({"kind": "arc", "radius": 2.0, "angle": 1.5}).length
        3.0
        """
        check.instance(words, "axis", Mapping, "a mapping with its kind")
        given = dict(words)
        kind = check.one_of(given.pop("kind", None), "axis.kind", KINDS)
        back = check.instance(given.pop("reversed", False), "axis.reversed", bool, "True or False")
        make = getattr(Axis, kind)
        takes = inspect.signature(make).parameters
        for name in given:
            check.one_of(name, f"a key of axis of kind {kind!r}", tuple(takes))
        for name, one in takes.items():
            if name not in given and one.default is one.empty:
                raise SceneError(f"axis.{name} must be given of kind {kind!r}, got nothing")
        found: Axis = make(**given)
        return found.reversed() if back else found

    @staticmethod
    def line(length: float) -> Axis:
        """Return a straight axis, along X.

        Parameters
        ----------
        length : float
            [m].

        Raises
        ------
        TypeError
            If it is not a number.
        SceneError
            If it is not positive.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.line(2.0).is_straight
        True
        """
        long = check.number(length, "length", "m", sign="positive")
        return _placed(UniformPiece(long), kind="line", length=long)

    @staticmethod
    def arc(radius: float, angle: float) -> Axis:
        """Return an arc of a circle, which begins along X and bends towards Z.

        Parameters
        ----------
        radius : float
            [m].
        angle : float
            That the tangent turns by [rad].

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If something is not positive.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.arc(2.0, 1.5).length
        3.0
        """
        r = check.number(radius, "radius", "m", sign="positive")
        turned = check.number(angle, "angle", "rad", sign="positive")
        return _placed(UniformPiece(r * turned, 0.0, 1 / r), kind="arc", radius=r, angle=turned)

    @staticmethod
    def ring(radius: float) -> Axis:
        """Return a whole circle, whose end is its beginning: a rope on it has no ends.

        It begins along X and bends towards Z. An arc of 2 pi has two ends at one place.

        Parameters
        ----------
        radius : float
            [m].

        Raises
        ------
        TypeError
            If it is not a number.
        SceneError
            If it is not positive.

        Examples
        --------
        A free ring moves in 2 pairs below 55 Hz, beside its 6 rigid motions:

        >>> import math
        >>> import ropedyn as rd
        >>> rod = rd.Rope(
        ...     rd.Axis.ring(1.0), 62.83, bending_stiffness=981748.0, torsional_stiffness=755190.0
        ... )
        >>> modes = rd.Scene(rod, planes="both").compile().modes(below=55.0)
        >>> print(modes.frequency[6:].round(2), modes.plane[6:])
        [51.85 51.85 53.38 53.38] ['y' 'y' 'z' 'z']
        """
        r = check.number(radius, "radius", "m", sign="positive")
        return replace(Axis.arc(r, 2 * math.pi), words={"kind": "ring", "radius": r}, closed=True)

    @staticmethod
    def helix(
        radius: float,
        pitch_angle: float,
        turns: float | None = None,
        hand: str = "right",
        *,
        length: float | None = None,
    ) -> Axis:
        """Return a helix, which begins along X and bends towards Z.

        Parameters
        ----------
        radius : float
            Of the cylinder [m].
        pitch_angle : float
            Between the tangent and the cross-section of the cylinder [rad], from 0, a circle, to
            pi/2, a line, whose frame does not turn.
        turns : float, optional
            Around the cylinder.
        hand : {"right", "left"}
            As a screw.
        length : float, optional
            Along the helix [m], in place of `turns`; a line has no other.

        Raises
        ------
        TypeError
            If something is of the wrong type.
        SceneError
            If a number is out of range, the hand unknown, or not one of turns and length given.

        Examples
        --------
        >>> import math
        >>> import ropedyn as rd
        >>> helix = rd.Axis.helix(1.0, math.atan(0.5 / math.pi), 1)
        >>> print(round(math.dist(helix.position(0.0), helix.position(helix.length)), 9))
        1.0
        """
        r = check.number(radius, "radius", "m", sign="positive")
        pitch = check.number(pitch_angle, "pitch_angle", "rad", sign="nonnegative")
        if pitch > math.pi / 2:
            raise SceneError(f"pitch_angle must be at most pi/2 [rad], got {pitch_angle!r}")
        around = check.optional(turns, "turns", sign="positive")
        long = check.optional(length, "length", "m", sign="positive")
        if (around is None) == (long is None):
            raise SceneError(f"give either turns or length, got {turns!r} and {length!r}")
        sign = 1 if check.one_of(hand, "hand", ("right", "left")) == "right" else -1
        words: dict[str, Any] = {"radius": r, "pitch_angle": pitch, "hand": hand}
        words |= {"length": long} if around is None else {"turns": around}
        # the float next to pi/2 has a cosine of 6e-17, which is none
        c, s = 0.0 if pitch == math.pi / 2 else math.cos(pitch), math.sin(pitch)
        if around is not None:
            if c == 0:
                raise SceneError("length must be given where pitch_angle is pi/2: it does not turn")
            long = 2 * math.pi * r * around / c
        assert long is not None
        return _placed(UniformPiece(long, sign * s * c / r, c * c / r), kind="helix", **words)

    @staticmethod
    def catenary(
        span: float, rise: float = 0.0, *, parameter: float, loads: Iterable[Any] = ()
    ) -> Axis:
        """Return a catenary above X, which hangs towards -Z; at weights on it it has kinks.

        Parameters
        ----------
        span : float
            Level distance of the ends [m].
        rise : float
            Of the right end above the left one [m].
        parameter : float
            Horizontal tension over weight per length, H/w [m].
        loads : iterable of (float, float), optional
            Weights that hang on it: the place as a share of the arc length, and how many metres
            of the rope weigh as much, m/mu [m].

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If something is not finite, or not positive where it must be, or the axis would be
            longer than numbers are, or no pieces are found that hang so.

        Examples
        --------
        >>> import ropedyn as rd
        >>> axis = rd.Axis.catenary(100.0, 30.0, parameter=200.0)
        >>> axis.position(axis.length).round(9)
        array([100.,   0.,  30.])
        >>> loaded = rd.Axis.catenary(100.0, 30.0, parameter=200.0, loads=[(0.5, 20.0)])
        >>> loaded.position(loaded.length).round(9), len(loaded.kinks)
        (array([100.,   0.,  30.]), 1)
        """
        over = check.number(span, "span", "m", sign="positive")
        up = check.number(rise, "rise", "m")
        c = check.number(parameter, "parameter", "m", sign="positive")
        if over > 1000 * c or abs(up) > 1e150:
            raise SceneError(f"parameter must be at least span/1000 [m], got {parameter!r}")
        carried = checked_loads(loads)
        words: dict[str, Any] = {"span": over, "rise": up, "parameter": c}
        words |= {"loads": [list(one) for one in carried]} if carried else {}
        return _axis(placed(catenaries(over, up, c, carried)), kind="catenary", **words)

    @staticmethod
    def points(xyz: ArrayLike, fillet: float | None = None) -> Axis:
        """Return straight arms from point to point, with sharp or rounded corners.

        The frame follows without turning about the tangent as far as z can point to the inside
        of the corner before, of the first arm to that of the first one.

        Parameters
        ----------
        xyz : array_like, shape (n, 3)
            Points in space [m].
        fillet : float, optional
            Radius of the arcs that round the corners [m]; sharp where left out.

        Raises
        ------
        TypeError
            If something is not a number.
        SceneError
            If there are fewer than two points, two in a row are the same, the axis turns back
            along itself, or an arc does not fit.

        Examples
        --------
        >>> import ropedyn as rd
        >>> corner = [[0, 0, 0], [1, 0, 0], [1, 0, 1]]
        >>> [kink.s for kink in rd.Axis.points(corner).kinks]
        [1.0]
        >>> rounded = rd.Axis.points(corner, fillet=0.2)
        >>> len(rounded.pieces), rounded.kinks, rounded.position(rounded.length).round(9)
        (3, (), array([1., 0., 1.]))
        """
        radius = check.optional(fillet, "fillet", "m", sign="positive")
        points = checked_points(xyz)
        words: dict[str, Any] = {"kind": "points", "xyz": points.tolist()}
        words |= {} if radius is None else {"fillet": radius}
        return _axis(polyline(points, radius), **words)

    @property
    def length(self) -> float:
        """Arc length [m]."""
        return math.fsum(piece.length for piece in self.pieces)

    @property
    def is_straight(self) -> bool:
        """Whether it is one straight line."""
        bent = any(self.rates(s)[1] != 0 for s in self.joints[:-1])
        return not bent and not self.kinks

    @property
    def is_uniform(self) -> bool:
        """Whether curvature and torsion are constant in each piece.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.arc(1.0, 2.0).is_uniform, rd.Axis.catenary(9.0, parameter=5.0).is_uniform
        (True, False)
        """
        return all(isinstance(piece, UniformPiece) for piece in self.pieces)

    @property
    def joints(self) -> Real:
        """Arc lengths at which pieces begin, and that of the end, shape (pieces + 1,) [m].

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 2, 0]]).joints
        array([0., 1., 3.])
        """
        return np.concatenate([[0.0], np.cumsum([piece.length for piece in self.pieces])])

    @property
    def hangs(self) -> bool:
        """Whether it is of catenaries, each of which hangs under its own weight.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.arc(1.0, 2.0).hangs, rd.Axis.catenary(9.0, parameter=5.0).hangs
        (False, True)
        """
        return all(isinstance(piece, CatenaryPiece) for piece in self.pieces)

    @property
    def kinks(self) -> tuple[Kink, ...]:
        """Joints at which the frame jumps, of a closed one that of its ends, at 0, too."""
        found = []
        for k, s in enumerate(self.joints[:-1]):
            if k == 0 and not self.closed:
                continue
            left = self._of(k - 1, np.array([self.pieces[k - 1].length]))[1][0]
            turn = np.array(self.begins[k][1]).T @ left
            if np.abs(turn - np.eye(3)).max() > TURNED:
                found.append(Kink(float(s), turn))
        return tuple(found)

    def position(self, s: ArrayLike) -> Real:
        """Return where points of the axis lie in space.

        Parameters
        ----------
        s : float or array_like
            Arc lengths [m].

        Returns
        -------
        ndarray, shape (3,) or s.shape + (3,)
            X, Y, Z [m].

        Raises
        ------
        SceneError
            If one lies beyond the ends.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.line(2.0).position([0.5, 2.0])
        array([[0.5, 0. , 0. ],
               [2. , 0. , 0. ]])
        """
        return self._each(s, lambda k, at: self._of(k, at)[0], (3,))

    def frame(self, s: ArrayLike) -> Real:
        """Return the frames of sections; at a joint that of the piece on its right.

        Parameters
        ----------
        s : float or array_like
            Arc lengths [m].

        Returns
        -------
        ndarray, shape (3, 3) or s.shape + (3, 3)
            Columns are the unit vectors x, y and z in space.

        Raises
        ------
        SceneError
            If one lies beyond the ends.

        Examples
        --------
        >>> import math
        >>> import ropedyn as rd
        >>> rd.Axis.arc(1.0, math.pi).frame(math.pi / 2).round(9)[:, 0]
        array([0., 0., 1.])
        """
        return self._each(s, lambda k, at: self._of(k, at)[1], (3, 3))

    def rates(self, s: ArrayLike) -> Real:
        """Return the rates (tau, kz, ky); at a joint those of the piece on its right.

        Parameters
        ----------
        s : float or array_like
            Arc lengths [m].

        Returns
        -------
        ndarray, shape (3,) or s.shape + (3,)
            [rad/m].

        Raises
        ------
        SceneError
            If one lies beyond the ends.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Axis.arc(2.0, 1.0).rates(1.0)
        array([0. , 0.5, 0. ])
        """
        return self._each(s, lambda k, at: self.pieces[k].rates(at), (3,))

    def turned(self, s: ArrayLike) -> Real:
        """Return the angle that curvature turns the tangent by up to arc lengths, corners apart.

        Parameters
        ----------
        s : float or array_like
            Arc lengths [m].

        Returns
        -------
        ndarray, shape s.shape
            [rad].

        Raises
        ------
        SceneError
            If one lies beyond the ends.

        Examples
        --------
        >>> import ropedyn as rd
        >>> corner = [[0, 0, 0], [1, 0, 0], [1, 0, 1]]
        >>> rounded = rd.Axis.points(corner, fillet=0.2)
        >>> rounded.turned([0.5, rounded.length]).round(6)
        array([0.      , 1.570796])
        """
        whole = np.concatenate([[0.0], np.cumsum([one.turned(one.length) for one in self.pieces])])
        return self._each(s, lambda k, at: whole[k] + self.pieces[k].turned(at), ())

    def reversed(self) -> Axis:
        """Return the same line from its other end, x and y of its frames turned round.

        Examples
        --------
        >>> import ropedyn as rd
        >>> helix = rd.Axis.helix(1.0, 0.2, 2)
        >>> helix.reversed().pieces == helix.pieces
        True
        """
        back = []
        for k, piece in reversed(list(enumerate(self.pieces))):
            place, frame = self._of(k, np.array([piece.length]))
            back.append((piece.backward(), place[0], frame[0] * [-1.0, -1.0, 1.0]))
        return replace(
            _axis(back),
            closed=self.closed,
            words={**self.words, "reversed": not self.words.get("reversed", False)},
        )

    def _of(self, k: int, s: Real) -> tuple[Real, Real]:
        """Return positions and frames in space, by the arc length of piece k."""
        place, frame = self.pieces[k].travel(s)
        begin, turned = (np.array(one) for one in self.begins[k])
        return begin + place @ turned.T, turned @ frame

    def _each(self, s: ArrayLike, of: Any, shape: tuple[int, ...]) -> Real:
        given = check.numbers(np.ravel(np.asarray(s)), "s", "m")
        at = np.array([check.position(float(one), "s", self.length) for one in given])
        joints = self.joints
        piece: Index = np.clip(np.searchsorted(joints, at, side="right") - 1, 0, len(joints) - 2)
        found = np.empty((len(at), *shape))
        for k in np.unique(piece):
            here = piece == k
            found[here] = of(k, at[here] - joints[k])
        return found.reshape((*np.shape(s), *shape))


KINDS = ("line", "arc", "ring", "helix", "catenary", "points")


def _axis(placed: Iterable[tuple[Piece, Real, Real]], **words: Any) -> Axis:
    pieces, begins = [], []
    for piece, position, frame in placed:
        pieces.append(piece)
        rows = tuple(tuple(float(v) for v in row) for row in frame)
        begins.append((tuple(float(v) for v in position), rows))
    return Axis(tuple(pieces), tuple(begins), words)  # type: ignore[arg-type]


def _placed(piece: UniformPiece, **words: Any) -> Axis:
    """Return an axis of one piece from the origin on, its frame that of space."""
    return _axis([(piece, np.zeros(3), np.eye(3))], **words)
