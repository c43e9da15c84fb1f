"""The scene: a rope, what holds and loads it, and what stands on it."""

from __future__ import annotations

import dataclasses
import math
import os
from collections.abc import Iterable
from dataclasses import KW_ONLY
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.computed import computed
from ..base.errors import SceneError
from ..base.parameter import Description, given, instance, positions
from . import damping as _damping
from . import end as _end
from . import left as _left
from . import toml
from .checked import checked_damping, checked_ends, checked_parts, checked_tension
from .damping import Damping
from .end import End
from .gravity import Gravity
from .parts import part as _part
from .parts.node import Part
from .parts.stretch import Stretch, changeable, refuse_uneven, ropes
from .rope import Rope
from .stations import stations_at
from .tension import Tension
from .weight import Grade, curves, grade, pulls, refuse_slack

if TYPE_CHECKING:
    from ..family.family import Family
    from ..model import Model

EFFECTS = (
    "tension",
    Tension.pulsating,
    Tension.growing,
    "bending",
    "twist",
    "stretch",
    "lay",
    "rotary inertia",
    "polar inertia",
    *(kind.kind for kind in _part.KINDS),
    *(kind.kind for kind in _damping.KINDS),
    Gravity.kind,
    Gravity.grading,
)
"""The effects that a scene can have, in their fixed order."""


class Scene(Description):
    """A rope with its tension, ends, damping, parts and weight.

    Parameters
    ----------
    rope : Rope
        The rope.
    tension : float or Tension
        [N]; negative is compression, which needs bending stiffness. A `Tension` may pulsate or grow
        with the amplitude; one that does neither is its number.
    ends : pair of {"clamped", "pinned", "free"} or End
        Left and right end.
    damping : StiffnessDamping, RayleighDamping, LossFactor, ViscousDamping, ModalDamping, optional
        A tuple of them is their sum.
    parts : sequence of PointMass, Spring, Dashpot, Support, Hinge, Resonator, BrokenWire, \
NodeForce, Stop, AddedMass, LocalChange
        What stands on the rope, and what changes it over a stretch.
    gravity : Gravity, optional
        The rope's own weight: of an inclined rope its change of tension, of one with axial
        stiffness sag, which needs tension > 0 and something that holds the rope along x; the rope
        has no inertia along x then.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If something has no meaning: a position off the rope, a part on a coordinate that the
        scene does not have, a rope that nothing holds together.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.35, 0.1017, bending_stiffness=1.54), tension=2830.0)
    >>> scene.effects
    ('tension', 'bending')
    >>> scene.without("tension").tension
    0.0
    """

    rope: Rope = instance(Rope, "a Rope")
    _: KW_ONLY
    tension: float | Tension = given(checked_tension, default=0.0)
    ends: tuple[str | End, str | End] = given(checked_ends, default=("clamped", "clamped"))
    damping: Damping | tuple[Damping, ...] | None = given(checked_damping, default=None)
    parts: tuple[Part | Stretch, ...] = given(checked_parts, default=())
    gravity: Gravity | None = instance(Gravity, "a Gravity or None", default=None)

    def _agree(self) -> None:
        self._check_coordinates()
        self._check_places()
        self._check_tension()
        # a rope that is changed must be one
        if changing := _part.stretches(self.parts):
            ends = stations_at(self.rope.length, _part.places(changing))
            ropes(self.rope, changing, ends)
        self._check_gravity()
        self._check_stretching()

    def _check_coordinates(self) -> None:
        bends = self.rope.bending_stiffness is not None
        least = self.mean_tension
        if isinstance(self.tension, Tension):
            least -= self.tension.amplitude
        if least < 0 and not bends:
            raise SceneError(
                f"tension must be >= 0 for a rope without bending_stiffness [N], got {least:g}"
            )
        if not self.coordinates:
            raise SceneError(
                "rope must have a stiffness or the scene a tension: tension is 0 and "
                "bending_stiffness, torsional_stiffness and axial_stiffness are None"
            )

    def _check_places(self) -> None:
        for i, part in enumerate(self.parts):
            for name in positions(part):
                check.position(getattr(part, name), f"parts[{i}].{name}", self.rope.length)
            if isinstance(part, Stretch):
                self._check_stretch(i, part)
                continue
            for coordinate in part.stands_on:
                if coordinate not in self.coordinates:
                    chosen = hasattr(part, "coordinate")
                    name = f"parts[{i}].coordinate" if chosen else f"coordinate of a {part.kind}"
                    raise SceneError(
                        f"{name} must be one the scene has ({', '.join(self.coordinates)}), "
                        f"got {coordinate!r}"
                    )
            if isinstance(part, _part.Hinge):
                self._check_hinge(i, part.x)
        for i, end in enumerate(self.ends):
            for name, values in _end.end_of(end).standing.items():
                for coordinate in values:
                    if coordinate not in self.coordinates:
                        raise SceneError(
                            f"ends[{i}].{name} must stand on coordinates the scene has "
                            f"({', '.join(self.coordinates)}), got {coordinate!r}"
                        )

    def _check_stretch(self, i: int, part: Stretch) -> None:
        least = check.NEAR * self.rope.length
        if not part.stop - part.start > least:
            raise SceneError(
                f"parts[{i}].stop must lie more than {least:g} m beyond start, {part.start!r} m, "
                f"got {part.stop!r}"
            )
        for name, what in part.acts_on.items():
            factor = getattr(part, name)
            if factor != 1 and what not in changeable(self.rope, self.coordinates):
                raise SceneError(
                    f"parts[{i}].{name} must be 1 where the scene has no {what} "
                    f"({', '.join(self.coordinates)}), got {factor!r}"
                )

    def _check_hinge(self, i: int, x: float) -> None:
        margin = check.NEAR * self.rope.length
        if not margin < x < self.rope.length - margin:
            raise SceneError(
                f"parts[{i}].x must lie between the ends of the rope for a hinge, got {x!r} m: "
                'there say End(beta="free", spring={"beta": stiffness})'
            )

    def _check_tension(self) -> None:
        at = self.tension.at if isinstance(self.tension, Tension) else "middle"
        if not isinstance(at, str):
            check.position(at, "at of the tension", self.rope.length)
        if not self.is_graded:
            return
        if self.sags:
            raise SceneError(
                "gravity of an inclined rope with axial_stiffness both curves it and changes its "
                "tension along it, which is not solved together: say sag=False or "
                f"own_weight=False, got {self.gravity}"
            )
        if self.rope.lay_slope:
            raise SceneError(
                "lay_slope must be 0 or None where the tension grows along the rope, got "
                f"{self.rope.lay_slope!r}"
            )
        if self.rope.bending_stiffness is None:
            pulsating = self.tension.amplitude if isinstance(self.tension, Tension) else 0.0
            refuse_slack(self.grade, pulsating, (self._is_bare(0), self._is_bare(1)))

    def _is_bare(self, end: int) -> bool:
        """Whether an end is free along z and nothing stands on it."""
        term, at = _end.end_of(self.ends[end]).term(), end * self.rope.length
        margin = check.NEAR * self.rope.length
        beside = any(abs(x - at) <= margin for x in _part.places(_part.standing(self.parts)))
        return not beside and "z" not in {*term.held, *term.mass, *term.stiffness, *term.damping}

    def _check_gravity(self) -> None:
        if self.gravity is None:
            return
        if self.gravity.sag and self.rope.axial_stiffness is None and not self.is_graded:
            raise SceneError("gravity needs axial_stiffness of the rope [N], got None")
        if not self.sags:
            return
        tension = self.mean_tension
        if not tension > 0:
            raise SceneError(f"tension must be > 0 where there is gravity, got {tension:g}")
        lengthening = self.gravity.lengthening(self.rope, tension)
        if not math.isfinite(lengthening):
            raise SceneError(
                "gravity must be small enough for 1 + (w L/H)^2/8 to be a number, got "
                f"g = {self.gravity.g!r} m/s^2 with the tension {tension!r} N"
            )
        terms = [_end.end_of(end).term() for end in self.ends]
        terms += [part.term() for part in _part.standing(self.parts)]
        if not any("x" in (*term.held, *term.stiffness) for term in terms):
            raise SceneError(
                "ends must hold x where there is gravity, or a Support or Spring: the rope has no "
                f"inertia along x, got ends {check.shown(self.ends)}"
            )

    def _check_stretching(self) -> None:
        if not isinstance(self.tension, Tension) or not self.tension.stretching:
            return
        refuse_uneven(self.parts, "where the tension is stretching")
        if self.rope.axial_stiffness is None:
            raise SceneError(
                "tension must not be stretching without axial_stiffness of the rope [N], got None"
            )
        if self.gravity is not None:
            raise SceneError(
                "tension must not be stretching where there is gravity: along a sag it is not the "
                "integral of the slope alone"
            )
        if not all("x" in _end.end_of(end).term().held for end in self.ends):
            raise SceneError(
                "ends must hold x where the tension is stretching, "
                f"got ends {check.shown(self.ends)}"
            )

    @property
    def is_graded(self) -> bool:
        """Whether the tension grows along the rope by its own weight."""
        return pulls(self.gravity) != 0

    @property
    def sags(self) -> bool:
        """Whether the weight curves the rope."""
        return curves(self.gravity, self.rope)

    @computed
    def grade(self) -> Grade:
        """The tension along the rope."""
        tension = self.tension if isinstance(self.tension, Tension) else Tension(self.tension)
        return grade(self.rope, tension, self.gravity, self.parts)

    def tension_at(self, x: Any) -> Real:
        """Return the tension at places along the rope [N], of a mass on its right.

        Parameters
        ----------
        x : float or array_like
            Places [m].

        Raises
        ------
        SceneError
            If one lies off the rope.

        Examples
        --------
        >>> import math
        >>> import ropedyn as rd
        >>> tension, up = rd.Tension(100.0, at="start"), rd.Gravity(10.0, inclination=math.pi / 2)
        >>> scene = rd.Scene(rd.Rope(30.0, 2.0), tension=tension, gravity=up)
        >>> scene.tension_at([0.0, 15.0, 30.0])
        array([100., 400., 700.])
        """
        places = check.numbers(np.atleast_1d(x), "x", "m")
        for place in places:
            check.position(float(place), "x", self.rope.length)
        return self.grade.at(places).reshape(np.shape(x))

    @property
    def mean_tension(self) -> float:
        """The tension about which motion is small, its mean along the rope [N].

        Examples
        --------
        >>> import ropedyn as rd
        >>> tension = rd.Tension(1000.0, amplitude=100.0, frequency=50.0)
        >>> rd.Scene(rd.Rope(1.0, 0.1), tension=tension).mean_tension
        1000.0
        """
        if self.is_graded:
            return self.grade.mean
        return self.tension.mean if isinstance(self.tension, Tension) else self.tension

    @computed
    def coordinates(self) -> tuple[str, ...]:
        """Coordinates of a node: z with bending or tension, beta with bending, and so on.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0)).coordinates
        ('z', 'beta')
        """
        return _left.coordinates_of(self.rope, self.mean_tension)

    @property
    def dampings(self) -> tuple[Damping, ...]:
        """The dampings whose sum acts, none or one or more.

        Examples
        --------
        >>> import ropedyn as rd
        >>> damping = rd.ViscousDamping(2.0)
        >>> rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping).dampings
        (ViscousDamping(coefficient=2.0),)
        """
        if self.damping is None:
            return ()
        return self.damping if isinstance(self.damping, tuple) else (self.damping,)

    @property
    def effects(self) -> tuple[str, ...]:
        """What acts in this scene, in a fixed order."""
        rope = self.rope
        stands = {part.kind for part in self.parts} | {d.kind for d in self.dampings}
        for end in self.ends:
            stands |= {_end.STANDING[name] for name in _end.end_of(end).standing}
        acts = {
            "tension": self.mean_tension != 0,
            Tension.pulsating: isinstance(self.tension, Tension) and self.tension.pulsates,
            Tension.growing: isinstance(self.tension, Tension) and self.tension.stretching,
            "bending": rope.bending_stiffness is not None,
            "twist": rope.torsional_stiffness is not None,
            "stretch": rope.axial_stiffness is not None,
            "lay": bool(rope.lay_coupling or rope.lay_slope),
            "rotary inertia": bool(rope.rotary_inertia and rope.bending_stiffness),
            "polar inertia": bool(rope.polar_inertia and rope.torsional_stiffness),
            Gravity.kind: self.sags,
            Gravity.grading: self.is_graded,
        }
        return tuple(effect for effect in EFFECTS if acts.get(effect, effect in stands))

    def replace(self, **changes: Any) -> Scene:
        """Return a scene with these arguments changed.

        Parameters
        ----------
        **changes
            Any argument of `Scene`.

        Raises
        ------
        TypeError
            If there is no such argument.
        SceneError
            As `Scene` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> scene.replace(tension=200.0).tension
        200.0
        """
        return dataclasses.replace(self, **changes)

    def without(self, *effects: str) -> Scene:
        """Return a scene that never had these effects.

        What stood on a coordinate that goes with them is dropped too.

        Parameters
        ----------
        *effects : str
            Names out of `effects`; an effect that the scene does not have changes nothing.

        Raises
        ------
        TypeError
            If a name is not a string.
        SceneError
            If there is no such effect, or nothing is left that could vibrate, or that holds a rope
            with weight along x.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
        >>> scene = rd.Scene(rope, tension=100.0, parts=[rd.PointMass(0.5, 0.1)])
        >>> scene.without("bending", "point mass").effects
        ('tension',)
        """
        for effect in effects:
            check.one_of(effect, "effect", EFFECTS)
        return self.replace(**_left.left_of(self, effects))

    def compile(
        self,
        *,
        elements: int | None = None,
        element: str | None = None,
        tolerance: float | None = None,
        below: float | None = None,
    ) -> Model:
        """Compile the scene to continuous spans, or to a chain of nodes and elements.

        Parameters
        ----------
        elements : int, optional
            Over the whole rope. There is a node at every station (end or part); the stretches
            between stations share the elements as equally as can be. Left out: continuous spans.
        element : {"continuous", "rigid", "tensed", "difference"}, optional
            ``"continuous"``, the default without `elements`: exact spans at each frequency, no
            discretisation error; with `elements` there are more nodes to look at. ``"tensed"``,
            the default with `elements`: the exact static tensed beam, with end-corrected lumping;
            of fourth order in bending, of second in twist, stretch and strings, and in bending with
            rotary inertia or a hinge that moves: `Model.mesh_order`. ``"rigid"``: beam elements
            between rigid node frames, tension as a string in parallel; second order in the length
            of elements. ``"difference"``: the kinematics of the 2015 study.
        tolerance, below : float, optional
            Instead of `elements`: the smallest chain, ``"tensed"`` where left out, whose relative
            mesh error of every frequency (and rate of growth) below `below` [Hz] is within
            `tolerance`, to 5 % of its elements. Rigid motion has no relative error; a frequency
            that only the chain has below the limit counts too. The continuous spans are solved
            once; one small chain tells the constant of its error C n^-p, which predicts how many
            elements are needed, and a few more correct that. `Model.choice` says what was chosen
            and why.

        Returns
        -------
        Model

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If there are fewer elements than stretches between stations or more than 10^7, the
            element is unknown, or is ``"difference"`` with bending and tension, or continuous with
            L sqrt(T/B) beyond 10^10, or only one of `tolerance` and `below` is given, or a
            tolerance for a number of elements or for continuous spans.
        SolveError
            If no chain of this kind meets the tolerance: rounding forbids it, it needs more than
            10^7 elements, or refinement leads elsewhere, as with ``"difference"``.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> scene.compile().modes(1).frequency.round(6)
        array([15.811388])
        >>> scene.compile(elements=8).size
        7
        >>> str(scene.compile(tolerance=1e-3, below=20.0).choice).partition(";")[0]
        '21 tensed elements: relative mesh error 0.000932 <= 0.001 of 1 frequency below 20 Hz'
        """
        from ..model import compile_model

        return compile_model(
            self, elements=elements, element=element, tolerance=tolerance, below=below
        )

    def family(
        self, paths: Iterable[str], *, elements: int | None = None, element: str | None = None
    ) -> Family:
        """Compile a family: ropes like this one that differ in a few numbers.

        Parameters
        ----------
        paths : sequence of str
            The numbers that differ: ``"tension"``, a property of the rope as
            ``"bending_stiffness"`` or ``"length"``, of a part as ``"parts[0].mass"``, of an end as
            ``"ends[0].spring.beta"``, and what else has a number in the scene. Springs of the ends
            exist whatever the scene says: 0 is free, infinite held.
        elements, element
            Of chains, as `compile` takes them: continuous spans where left out.

        Returns
        -------
        Family

        Raises
        ------
        TypeError
            If a path is not a string.
        SceneError
            If the scene has no number at a path, or one is given twice, or as `compile` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(["tension"])
        >>> family.modes([[1000.0], [4000.0]], 2).frequency.round(9).tolist()
        [[25.0, 50.0], [50.0, 100.0]]
        """
        from ..family.family import compile_family

        return compile_family(self, paths, elements, element)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene as TOML, whole or not at all.

        Parameters
        ----------
        path : path
            Of the file.

        Raises
        ------
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> with TemporaryDirectory() as folder:
        ...     scene.save(Path(folder, "rope.toml"))
        ...     Path(folder, "rope.toml").read_text().splitlines()[0]
        'tension = 100.0'
        """
        toml.save(self, path)

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scene:
        """Read a scene from TOML.

        Parameters
        ----------
        path : path
            Of the file; keys are the names of the arguments.

        Raises
        ------
        OSError
            If the file cannot be read.
        SceneError
            If it is not TOML, a key is unknown or missing, or a value has no meaning.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> with TemporaryDirectory() as folder:
        ...     scene.save(Path(folder, "rope.toml"))
        ...     rd.Scene.load(Path(folder, "rope.toml")) == scene
        True
        """
        return toml.load(Scene, path)
