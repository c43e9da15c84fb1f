"""The scene: a rope, what holds and loads it, and what stands on it."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..base import check
from . import left, toml
from .agree import agree
from .card import card, card_html, card_text, warn_of
from .described import EFFECTS, Described
from .hung import catenary_scene

if TYPE_CHECKING:
    from ..family.family import Family
    from ..model import Model


class Scene(Described):
    """A rope with its tension, ends, damping, parts and weight.

    Parameters
    ----------
    rope : Rope
        The rope.
    tension : float or Tension
        [N]; negative is compression, which needs bending stiffness.
    ends : pair of {"clamped", "pinned", "free"} or End
        Left and right end.
    damping : StiffnessDamping, RayleighDamping, LossFactor, ViscousDamping, ModalDamping, \
WireFriction, optional
        A tuple of them is their sum.
    parts : sequence of PointMass, Spring, Dashpot, Support, Hinge, Resonator, BrokenWire, \
NodeForce, Stop, AddedMass, LocalChange
        What stands on the rope, and what changes it over a stretch.
    gravity : Gravity, optional
        The rope's own weight: of an inclined rope its change of tension, of one with axial
        stiffness sag, which needs tension > 0 and something that holds the rope along x; the rope
        has no inertia along x then. Sag acts in the plane of z; in that of y the rope is straight.
        A rope on a catenary has the tension that its weight gives it, and needs no other.
    planes : {"z", "both"}
        Whether the rope moves across in one plane, or in that of y too, with the coordinates y and
        gamma = dy/dx; only a torque, turned principal axes and an axis tie the planes.
    torque : float
        M_alpha that the rope carries at rest [N m], dead (semitangential) where an end turns.
    axial_force : float
        Of a helix, along the axis of its cylinder [N]; positive pulls. The axis is that of the
        loaded spring, in which it leaves tension, shear, bending and twist.

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

    def __repr__(self) -> str:
        return card_text("Scene of a rope", card(self))

    def _repr_html_(self) -> str:
        return card_html("Scene of a rope", card(self))

    def _agree(self) -> None:
        agree(self)
        if self.sags and self.is_graded:
            self.on_catenary()

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
        return self.replace(**left.left_of(self, effects))

    def on_catenary(self) -> Scene:
        """Return a scene of the same rope on the catenary that its weight hangs it in.

        The rope of this scene is described by its chord: its length, its inclination, and of its
        tension the component along the chord. On the curve that component is

            T_ref + w sin(inclination) (s - s_ref)

        exactly, with w the weight per length, and masses between add theirs: T_ref is the tension
        of the scene, s_ref the place of `Tension`, a share of the arc as it is of the chord. The
        horizontal tension H and with it the parameter H/w follow. Density and stiffnesses are those
        of a metre of the curve; parts stand at their share of the arc; x is along the tangent there
        and z towards the centre of the curve, alpha and beta alike; what an end clamps is the rope
        as it hangs.

        `compile` does so itself where a parabola may be a thousandth of a frequency off.

        Raises
        ------
        SceneError
            If gravity does not curve the rope or makes another curve of it (resonators, stretches
            of other weight), bending rounds off the kinks at masses, or for what is not carried
            along a curve: laid ropes, twist in one plane, a tension that is not constant.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
        >>> hanging = rd.Scene(rope, tension=1000.0, gravity=rd.Gravity()).on_catenary()
        >>> print(round(hanging.rope.length, 6), hanging.tension_at([0.0, 50.0]).round(3))
        116.829055 [1521.029 1013.536]
        """
        return catenary_scene(self)

    def needed(self, question: Any, tolerance: float) -> tuple[str, ...]:
        """Name the effects that an answer needs; nothing is left out of the scene by that.

        Parameters
        ----------
        question
            Any of ``rd.ask``.
        tolerance : float
            How far the answer may be off, relative: of frequencies, damping ratios, responses line
            by line, of motion over time by the largest of each response.

        Returns
        -------
        tuple of str
            The smallest set of `effects` whose answer is within the tolerance of that of all of
            them, error bars included as far as they are known; no mode or response may be lost.
            Effects that alone change more all stay; of the others the most are left out that can be
            at once, of equally many those that change least. Beyond 8 such effects one by one,
            those that change least first.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If the tolerance is not a number > 0, or the question has no answer.
        SolveError
            If the scene with all its effects has no answer.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=0.01, torsional_stiffness=9.0)
        >>> scene = rd.Scene(rope, tension=1000.0, ends=("pinned", "pinned"))
        >>> scene.needed(rd.ask.modes(1), 1e-2), scene.needed(rd.ask.modes(1), 1e-6)
        (('tension',), ('tension', 'bending'))
        """
        from ..study.needed import needed

        return needed(self, question, tolerance)

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
            Of a rope on an axis, with torque or turned principal axes a `SpaceModel`, which takes
            no arguments here.

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

        Warns
        -----
        UnitWarning
            If no steel rope has such numbers: a unit may have slipped.

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
        scene = toml.load(Scene, path)
        warn_of(scene)
        return scene
