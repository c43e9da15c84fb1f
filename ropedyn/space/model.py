"""The model of a rope on an axis, and the questions it answers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.answer import Frozen
from ..base.array import Real
from ..base.computed import waited
from ..base.drawing import draw
from ..base.errors import SceneError, SolveError
from ..base.progress import Progress
from ..chain.port import Point
from ..eigen.animation import VIEWS
from ..eigen.modes import Modes
from ..motion.history import History
from ..response.deflection import Deflection
from ..response.frf import FRF
from ..scene.agree import in_space
from ..scene.card import Card, card, card_html, card_text
from ..scene.scene import Scene
from .compile import rope_of_scene
from .modes import solve_modes
from .motion import solve_stepped, solve_transient
from .response import solve_frf
from .rope import SIX, SpaceRope
from .shape import ShapeInSpace
from .spectrum import count_below
from .static import solve_static

if TYPE_CHECKING:
    from matplotlib.axes import Axes

ELSEWHERE = (
    *("floquet", "stability_map", "stiffness_matrix", "mass_matrix", "damping_matrix"),
    *("triples", "node_terms", "chain", "mesh_order"),
)
"""What a model of a straight rope has that this one does not carry."""
HIGHEST = 1e150  # Its square is a number [Hz].


@dataclass(frozen=True, eq=False, repr=False)
class SpaceModel(Frozen):
    """A rope on an axis in space, or with torque, exact at each frequency.

    Made by `Scene.compile`. All six coordinates are solved together, or three and three where the
    axis is plane and nothing ties its planes. Along a catenary or a twisted strip blocks are
    followed by polynomials. Coordinates at s, the arc length from the left end, are along the frame
    of the axis there; at a joint of two pieces along that on its left.

    Attributes
    ----------
    scene : Scene
        What was compiled.
    coordinates : tuple of str
        x, y, z, alpha, beta, gamma; of a string x, y and z.
    rope : SpaceRope
        Its pieces as arrays.

    Examples
    --------
    A spring of ten turns, clamped at both ends:

    >>> import math
    >>> import ropedyn as rd
    >>> d, E, G = 1e-3, 206e9, 79.2e9
    >>> A, J = math.pi * d**2 / 4, math.pi * d**4 / 64
    >>> wire = rd.Rope(
    ...     rd.Axis.helix(5e-3, math.radians(8.6), 10),
    ...     7900 * A,
    ...     bending_stiffness=E * J,
    ...     torsional_stiffness=2 * G * J,
    ...     axial_stiffness=E * A,
    ...     rotary_inertia=7900 * J,
    ...     polar_inertia=2 * 7900 * J,
    ... )
    >>> model = rd.Scene(wire, planes="both").compile()
    >>> print(model.modes(2).frequency.round(1))
    [245.5 246.2]
    """

    scene: Scene
    rope: SpaceRope

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Of every place."""
        return self.rope.coordinates

    @property
    def components(self) -> tuple[tuple[str, ...], ...]:
        """Coordinates that move together: they are solved all at once.

        Examples
        --------
        >>> import ropedyn as rd
        >>> arc = rd.Axis.arc(1.0, 2.0)
        >>> rope = rd.Rope(arc, 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
        >>> rd.Scene(rope, planes="both").compile().components
        (('x', 'z', 'beta'), ('y', 'alpha', 'gamma'))
        """
        there = ~self.rope.absent
        every = (tuple(SIX[c] for c in own if there[c]) for own in self.rope.own)
        return tuple(one for one in every if one)

    @property
    def element(self) -> str:
        """Kind of the elements, "continuous"."""
        return "continuous"

    @property
    def size(self) -> int:
        """Number of unknowns: coordinates of the ends of pieces that can move."""
        return self.rope.unknowns

    @property
    def x(self) -> Real:
        """Where pieces begin and end [m]."""
        return self.rope.x

    def __repr__(self) -> str:
        return card_text(*self._card)

    def _repr_html_(self) -> str:
        return card_html(*self._card)

    @property
    def _card(self) -> tuple[str, Card]:
        pieces = f"{len(self.rope.length)} pieces"
        return f"Model of {in_space(self.scene)}", card(self.scene) | {"model": pieces}

    def __getattr__(self, name: str) -> NoReturn:
        if name in ELSEWHERE:
            raise SceneError(f"{name} is not carried for {in_space(self.scene)}")
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    def plot(
        self,
        modes: Modes | None = None,
        k: int = 0,
        *,
        view: str = "isometric",
        scale: float | None = None,
        ax: Axes | None = None,
    ) -> Axes:
        """Plot the axis in space, and a mode on it.

        Parameters
        ----------
        modes : Modes, optional
            Of this model.
        k : int
            Which of them, from 0.
        view : {"isometric", "front", "top", "side"}
            Into a corner of space, or X and Z, X and Y, Y and Z.
        scale : float, optional
            By which the shape is multiplied; the farthest moves by a tenth of the axis' extent
            where left out.
        ax : Axes, optional
            Where to; of an isometric view one of the projection "3d".

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If there is no such mode or view, or the modes are another model's.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(
        ...     rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0
        ... )
        >>> model = rd.Scene(rope, planes="both").compile()
        >>> model.plot(model.modes(2), 1, view="front").get_xlabel()
        'X [m]'
        """
        check.one_of(view, "view", VIEWS)
        shape = None
        if modes is not None:
            check.instance(modes, "modes", Modes, "modes of this model")
            check.count(k, "k", least=0, most=len(modes.frequency) - 1)
            shape = ShapeInSpace.of(self.scene, modes, k, scale)
        return draw(self, "plot", ax, shape=shape, view=view)

    @waited
    def modes(
        self,
        number: int | None = None,
        *,
        below: float | None = None,
        points: int | None = None,
        damped: bool = False,
        solver: str = "sweep",
    ) -> Modes:
        """Find natural frequencies and shapes, certified by counts.

        Parameters
        ----------
        number : int, optional
            How many of the lowest.
        below : float, optional
            All below this frequency [Hz]; instead of `number`.
        points : int, optional
            Shapes are given at the ends of so many equal parts of each piece of the axis; 16 to a
            half wave of the highest mode where left out.
        damped : False
            Complex modes are not carried.
        solver : "sweep"
            There is no other.

        Returns
        -------
        Modes
            Double modes, those closer than a relative 1e-8 among them, are found together.
            `rounding_error` is a bound; `mesh_error` is 0, or where curvature, tension or
            section change along a piece how far shorter blocks are away.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If not exactly one of `number` and `below` is given, or a value has no meaning.
        SolveError
            If more modes are asked for than are finite, or counts do not confirm what was found.

        Examples
        --------
        An arch pinned at both ends:

        >>> import ropedyn as rd
        >>> rope = rd.Rope(
        ...     rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0
        ... )
        >>> modes = rd.Scene(rope, ends=("pinned", "pinned"), planes="both").compile().modes(2)
        >>> print(modes.frequency.round(3), modes.plane, modes.certified)
        [ 1.804 12.36 ] ['y' 'z'] True
        """
        if damped is not False:
            raise SceneError(f"damped must be False for {in_space(self.scene)}, got {damped!r}")
        _only_sweep(self.scene, solver)
        return solve_modes(self.scene, self.rope, number, below=below, points=points)

    def count(self, *, below: float) -> int:
        """Count the natural frequencies below a limit.

        Parameters
        ----------
        below : float
            [Hz].

        Returns
        -------
        int
            Motion that grows is counted too.

        Raises
        ------
        TypeError
            If the limit is not a number.
        SceneError
            If it is not positive.
        SolveError
            If it is too high for waves to be counted.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(
        ...     rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0
        ... )
        >>> rd.Scene(rope, planes="both").compile().count(below=100.0)
        7
        """
        limit = check.number(below, "below", "Hz", sign="positive")
        if limit > HIGHEST:
            raise SolveError(f"below must be at most {HIGHEST:g} Hz, got {limit!r}")
        return count_below(self.rope, (2 * math.pi * limit) ** 2)

    @waited
    def frf(
        self,
        frequency: ArrayLike,
        *,
        drive: Point | Sequence[Point],
        response: Point | Sequence[Point] | None = None,
        quantity: str = "receptance",
        solver: str = "sweep",
        threads: int | None = None,
        decay: float = 0.0,
        harmonic: int = 1,
        amplitude: float | None = None,
    ) -> FRF:
        """Compute the frequency response to a harmonic force or moment.

        Parameters
        ----------
        frequency : array_like, shape (f,)
            [Hz], each >= 0.
        drive : point or list of points
            Coordinate and arc length of a unit force or moment, such as ``("y", 0.5)``. With a list
            the values have a leading axis of drives.
        response : point or list of points, optional
            What is watched, such as ``("gamma", 0.5)``; the drive points where left out.
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration per force.
        solver : "sweep"
            There is no other.
        threads : int, optional
            One finds it whatever is given.
        decay : float, optional
            [1/s]: the response at i omega + decay, of force and motion both times exp(-decay t).
        harmonic : 1
            What slopes cause at twice the frequency is not carried.
        amplitude : float, optional
            Of no effect: nothing here depends on it.

        Returns
        -------
        FRF
            Motion is Re(value exp(+i omega t)), times exp(decay t).

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning.
        SolveError
            If a frequency lies on an undamped resonance.

        Examples
        --------
        What the free end of a quarter of a circle gives way by, pi R^3/4 B in its plane:

        >>> import math
        >>> import ropedyn as rd
        >>> axis = rd.Axis.arc(1.0, math.pi / 2)
        >>> rope = rd.Rope(axis, 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
        >>> model = rd.Scene(rope, ends=("clamped", "free"), planes="both").compile()
        >>> frf = model.frf([0.0], drive=("z", axis.length))
        >>> bool(math.isclose(frf.value[0, 0].real, math.pi / 4 / 50.0, rel_tol=1e-12))
        True
        """
        _only_sweep(self.scene, solver)
        if harmonic != 1:
            raise SceneError(f"harmonic must be 1 for {in_space(self.scene)}, got {harmonic!r}")
        check.optional(amplitude, "amplitude", sign="positive")
        if threads is not None:
            check.count(threads, "threads", most=1024)
        asked: Any = {"drive": drive, "response": response, "quantity": quantity, "decay": decay}
        return solve_frf(self.scene, self.rope, frequency, **asked)

    @waited
    def static(
        self,
        load: Mapping[Point, float],
        *,
        points: int | None = None,
        unstable: bool = False,
        solver: str = "sweep",
    ) -> Deflection:
        """Find the static deflection under forces and moments.

        Parameters
        ----------
        load : mapping from points to float
            Such as ``{("y", 0.5): 10.0}`` [N, N m].
        points : int, optional
            Given at the ends of so many equal parts of each piece of the axis (64 where left out)
            and under the loads.
        unstable : bool
            True: answer beyond a critical load too, and say so in it.
        solver : "sweep"
            There is no other.

        Returns
        -------
        Deflection

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning.
        SolveError
            If a rigid motion is free, or critical loads are met or exceeded: how many.

        Examples
        --------
        >>> import ropedyn as rd
        >>> axis = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]])
        >>> rope = rd.Rope(axis, 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
        >>> model = rd.Scene(rope, ends=("clamped", "free"), planes="both").compile()
        >>> static = model.static({("y", 2.0): 1.0})
        >>> print(static.displacement[-1, 1].round(6), round(1 / 150 + 1 / 30 + 1 / 150, 6))
        0.046667 0.046667
        """
        _only_sweep(self.scene, solver)
        check.instance(unstable, "unstable", bool, "True or False")
        return solve_static(self.scene, self.rope, load, points=points, unstable=unstable)

    @waited
    def transient(
        self,
        time: ArrayLike,
        *,
        drive: Any = None,
        force: Any = None,
        response: Point | Sequence[Point] | None = None,
        quantity: str = "displacement",
        start: Any = None,
        velocity: Any = None,
        method: str = "auto",
        modes: None = None,
        tolerance: float | None = None,
        snapshots: ArrayLike | None = None,
        progress: Progress = None,
        partial: bool = False,
    ) -> History:
        """Find the motion over time, by inversion of the exact transfer functions.

        Parameters
        ----------
        time : array_like, shape (t,)
            When the motion is asked for [s], increasing; it begins at the first.
        drive : point or list of points, optional
            What the force acts on, such as ``("y", 0.5)``. None: free motion.
        force : array_like, shape (t,), Sine, Chirp, Step or Impulse, or a tuple of them (their sum)
            [N, N m]; one for each of a list of drives. An array is straight between its samples.
        response : point or list of points, optional
            What is watched; the drive points where left out.
        quantity : {"displacement", "velocity", "acceleration"}
            Of the responses.
        start : mapping from points to float, or Deflection, optional
            Static loads [N, N m] that are let go at the first time.
        velocity : mapping from points to float, optional
            Impulses at the first time [N s, N m s].
        method : {"auto", "line"}
            Both are the line of `Model.transient`.
        modes, partial
            Belong to other methods of a straight rope: to be left out.
        tolerance : float, optional
            Part of each response's largest value that errors keep to, 1e-3.
        snapshots : array_like, optional
            When the displacement of the whole rope is kept [s].
        progress : None, True or callable
            As in `Model.transient`.

        Returns
        -------
        History
            `error` covers that of every value; `mesh_error` is 0, or where something changes along
            a piece the distance to what shorter pieces do. Energies are not carried.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning, the answer is infinite, or the method is another.
        SolveError
            If the error exceeds the tolerance: by how much.

        Examples
        --------
        An arch that is let go swings in its plane:

        >>> import ropedyn as rd
        >>> rope = rd.Rope(
        ...     rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0
        ... )
        >>> model = rd.Scene(rope, ends=("pinned", "pinned"), planes="both").compile()
        >>> time = [0.0, 0.02, 0.04, 0.06, 0.08]
        >>> history = model.transient(time, start={("z", 0.5): 1.0}, response=("z", 0.5))
        >>> print((1e3 * history.value[0]).round(3), history.cost.method)
        [ 0.272  0.001 -0.257 -0.012  0.244] line
        """
        asked: Any = {"drive": drive, "force": force, "response": response, "quantity": quantity}
        asked |= {"start": start, "velocity": velocity, "snapshots": snapshots}
        asked |= {"method": method, "modes": modes, "tolerance": tolerance}
        return solve_transient(self, time, partial=partial, progress=progress, **asked)

    @waited
    def stepped_sine(
        self,
        frequency: ArrayLike,
        *,
        drive: Point,
        amplitude: float,
        response: Point | Sequence[Point] | None = None,
        branches: bool = False,
        quantity: str = "receptance",
        tolerance: float | None = None,
        progress: Progress = None,
    ) -> FRF:
        """Find the steady motion under a sine whose frequency is stepped: that of `frf`.

        Parameters
        ----------
        frequency : array_like, shape (f,)
            [Hz], each > 0, in any order.
        drive : point, such as ``("z", 0.5)``
        amplitude : float
            Of a sine [N, N m].
        response : point or list of points, optional
            What is watched; the drive point where left out.
        branches : False
            Linear motion has one.
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration, per amplitude.
        tolerance, progress : optional
            Of `Model.stepped_sine`: nothing is iterated here.

        Returns
        -------
        FRF

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning; a `LossFactor`.
        SolveError
            If there is no steady state, or a frequency lies on an undamped resonance.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(
        ...     rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0
        ... )
        >>> model = rd.Scene(rope, planes="both").compile()
        >>> model.stepped_sine([12.0, 15.0], drive=("y", 0.5), amplitude=2.0).stable
        array([ True,  True])
        """
        asked: Any = {"drive": drive, "response": response, "quantity": quantity}
        asked |= {"amplitude": amplitude, "branches": branches, "tolerance": tolerance}
        return solve_stepped(self, frequency, progress=progress, **asked)


MOST_CUTS = 10_000
"""Into so many parts a rope is cut at most."""


def _only_sweep(scene: Scene, solver: Any) -> None:
    if solver != "sweep":
        raise SceneError(f'solver must be "sweep" for {in_space(scene)}, got {solver!r}')


def compile_space(
    scene: Scene, *, elements: int | None = None, element: str | None = None, **how: Any
) -> SpaceModel:
    """Compile a scene with a rope on an axis; see `Scene.compile`."""
    chain = {"elements": elements, "element": element} if element != "continuous" else {}
    for name, value in (how | chain).items():
        if value is not None:
            raise SceneError(
                f"{name} must be left out for {in_space(scene)}, whose pieces are exact, "
                f"got {check.shown(value)}"
            )
    rope = rope_of_scene(scene)
    if elements is not None:
        count = check.count(elements, "elements", most=MOST_CUTS)
        places = np.linspace(0.0, rope.x[-1], count + 1)[1:-1]
        rope, _ = rope.cut(places, check.NEAR * rope.x[-1])
    return SpaceModel(scene, rope)
