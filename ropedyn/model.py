"""The model: a compiled scene, and the questions it answers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, overload

from numpy.typing import ArrayLike

from .base import check
from .base.computed import waited
from .base.progress import Progress
from .chain.compiled import Compiled, refuse_nonlinear, refuse_rubbing, rubbing
from .chain.port import Point
from .eigen.damped.damped import solve_damped
from .eigen.damped.damped_modes import DampedModes
from .eigen.eigen import solve_modes
from .eigen.modes import Modes
from .eigen.spectrum import count_modes
from .eigen.tolerance import compile_within
from .motion.history import History
from .motion.periodic.asked import SteppedSine
from .motion.periodic.branches import Branches, solve_branches
from .motion.periodic.stepped import solve_stepped
from .motion.request import STRAIGHT, Run
from .motion.solve import follow_motion
from .motion.turning import refuse_steady, turned
from .parametric.floquet import Floquet, solve_floquet
from .parametric.stability import StabilityMap, solve_stability
from .response.deflection import Deflection, solve_static
from .response.frf import FRF
from .response.friction.solve import solve_rubbing
from .response.second_harmonic import solver_of
from .scene.scene import Scene
from .space.hanging import Hanging
from .space.model import compile_space


@dataclass(frozen=True, eq=False, repr=False)
class Model(Compiled):
    """A chain of nodes and elements, or of continuous spans; plain data that pickles.

    Made by `Scene.compile`.

    Attributes
    ----------
    scene : Scene
        What was compiled.
    element : str
        Kind of the elements.
    coordinates : tuple of str
        Of every node, in their fixed order.
    components : tuple of tuple of str
        Coordinates that move together; an analysis computes only those its question touches.
    x : ndarray, shape (nodes,)
        Where the nodes stand [m].
    chain : Chain
        What the core reads.
    unknowns : tuple of int
        Of each component, coordinates of nodes (of stations of spans) that can move.
    choice : Choice or None
        Why there are so many elements, where `Scene.compile` chose them for a tolerance.
    """

    @overload
    def modes(
        self,
        number: int | None = None,
        *,
        below: float | None = None,
        solver: str = "sweep",
        points: int | None = None,
        damped: Literal[False] = False,
    ) -> Modes: ...

    @overload
    def modes(
        self,
        number: int | None = None,
        *,
        below: float | None = None,
        solver: str = "sweep",
        points: int | None = None,
        damped: Literal[True],
    ) -> DampedModes: ...

    @waited
    def modes(
        self,
        number: int | None = None,
        *,
        below: float | None = None,
        solver: str = "sweep",
        points: int | None = None,
        damped: bool = False,
    ) -> Modes | DampedModes:
        """Find natural frequencies and shapes, of the undamped model or complex ones.

        Parameters
        ----------
        number : int, optional
            How many of the lowest.
        below : float, optional
            All below this frequency [Hz].
        solver : {"sweep", "lapack"}
            ``"sweep"``: isolated by counts, refined by inverse iteration along the chain, nothing
            assembled: right to the last digits whatever n, and certified (csrc/modes/certify);
            clusters of eight modes and more within a relative 1e-8 are refused. ``"lapack"``: a
            dense symmetric problem of assembled matrices (see csrc/assembled), whose stiffness
            loses digits as n^4: of the first frequency of a clamped beam about 11 are right with
            64 elements, 7 with 512, 6 with 1024. Time grows as n^3; more than 8000 unknowns are
            refused, and Ctrl-C waits for the last call of LAPACK, which takes about 0.5 s
            with 2000 unknowns and 3 s with 3000, as n^3.
        points : int, optional
            Of continuous spans: shapes are given at the ends of so many equal parts of each span
            or element, exactly; 16 to a half wave of the highest mode where left out.
        damped : bool
            False: damping is ignored. True: rates s and complex shapes of free motion
            Re(shape e^(s t)), by the sweep: those of the least |s|, or |s|/2 pi below a frequency,
            all found and certified, overdamped ones among them (see `DampedModes`).

        Returns
        -------
        Modes, or DampedModes if `damped`

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If not exactly one of `number` and `below` is given, or a value has no meaning.
        SolveError
            If more modes are asked for than the model has finite ones (the message says how
            many), or the stiffness is negative where there is no mass. Of damped modes also: where
            stiffness damping makes infinitely many overdamped ones accumulate, at 1/(2 pi gamma)
            Hz, and where rounding decides where they are, as before a dashpot that matches the
            rope's impedance.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=64)
        >>> print(model.modes(2).frequency.round(2))
        [15.81 31.61]

        A dashpot near an end that damps the first mode best:

        >>> dashpot = rd.Dashpot(0.02, 15.93 * (100.0 * 0.1) ** 0.5)
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[dashpot]).compile()
        >>> print(model.modes(1, damped=True).damping_ratio.round(5))
        [0.01021]
        """
        refuse_nonlinear(self)
        check.instance(damped, "damped", bool, "True or False")
        if damped:
            return solve_damped(self, number, below=below, solver=solver, points=points)
        return solve_modes(self, number, below=below, solver=solver, points=points)

    def count(self, *, below: float) -> int:
        """Count the natural frequencies below a limit, by Sturm count.

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

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=64)
        >>> model.count(below=40.0)
        2
        """
        refuse_nonlinear(self)
        return count_modes(self, below)

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
        """Compute the frequency response to a harmonic force or moment, or motion of an end.

        Parameters
        ----------
        frequency : array_like, shape (f,)
            [Hz], each >= 0.
        drive : point or list of points
            Coordinate and position of a unit force or moment, such as ``("z", 0.5)``; or
            ``("end", 0, "z")``, a coordinate that the left end (0; the right one is 1) holds: it
            moves by 1 m or 1 rad then, and the value is the transmissibility. With a list the
            values have a leading axis of drives.
        response : point or list of points, optional
            What is watched; the drive points where left out. Also internal forces such as
            ``("F_z", 0.3)`` or ``("M_beta", 0.0)``, by sweep or band: what the rope right of the
            position puts on the rope left of it, just left of a load or mass there. And
            ``("wire", 0)``: the transverse motion of the tip of the first `BrokenWire`.
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration per force.
        solver : {"sweep", "lapack", "band"}
            ``"sweep"``: along the chain in scattering form (see csrc/sweep/sweep.h), right to
            nearly the last digits whatever n. ``"lapack"``: complex band LU of the assembled
            stiffness; loses digits with n as `modes` does. ``"band"``: that of the mixed form (see
            csrc/mixed/mixed.h), hundreds of times as long; its error grows as n at most.
        threads : int, optional
            Of sweep and band: how many share the frequencies; ROPEDYN_THREADS of the environment or
            all cores where left out. The bits do not depend on it.
        decay : float, optional
            [1/s]: the response at i omega + decay, of force and motion both times exp(-decay t).
        harmonic : {1, 2}
            2: what slopes that stretch the rope cause at twice the frequency, per square of the
            force, such as ``("alpha", L)`` or ``("F_x", 0.0)``; see `SecondHarmonic`.
        amplitude : float, optional
            Of one drive [N, N m; m, rad of an end]: needed with `WireFriction`, else of no effect.

        Returns
        -------
        FRF, with `WireFriction` a `FrictionResponse`
            Motion is Re(value exp(+i omega t)), times exp(decay t).

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning, or modal damping stands beside another or lacks a ratio.
        SolveError
            If a frequency lies on an undamped resonance that answers; the message names it.

        Notes
        -----
        With `ModalDamping` the response is the exact static one and a sum over the modes below
        eight times the highest frequency, 64 at least. A bound of what is left out is part of
        `FRF.mesh_error`; no other damping may act beside it, and internal forces are refused.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=64)
        >>> print(model.frf([0.0], drive=("z", 0.5)).value[0, 0].real.round(6))
        0.0025
        """
        given: Any = {"drive": drive, "response": response, "quantity": quantity}
        given |= {"solver": solver, "threads": threads, "decay": decay}
        if rubbing(self):
            given |= {"amplitude": amplitude, "harmonic": harmonic}
            return solve_rubbing(self, frequency, **given)
        refuse_nonlinear(self)
        return solver_of(harmonic)(self, frequency, **given)

    @waited
    def static(
        self,
        load: Mapping[Point, float],
        *,
        solver: str = "sweep",
        points: int | None = None,
        unstable: bool = False,
    ) -> Deflection:
        """Find the static deflection under forces and moments.

        Parameters
        ----------
        load : mapping from points to float
            Such as ``{("z", 0.5): 10.0}`` [N, N m]. ``{}``: the mean tension alone, from the slack
            rope on, with an end let go along x: it stretches a rope and turns a laid one's swivel.
        solver : {"sweep", "lapack", "band"}
            As `frf` at 0 Hz; ``"lapack"``: band LU of the assembled stiffness.
        points : int, optional
            Of continuous spans: so many equal parts of each are told apart, 64 where left out.
        unstable : bool
            True: answer beyond a critical load too, where no rope stays, and say so in it.

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
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=4)
        >>> print(model.static({("z", 0.5): 8.0}).displacement[2])
        [0.02]
        """
        refuse_nonlinear(self)
        return solve_static(self, load, solver=solver, points=points, unstable=unstable)

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
        modes: int | None = None,
        tolerance: float | None = None,
        snapshots: ArrayLike | None = None,
        progress: Progress = None,
        partial: bool = False,
    ) -> History:
        """Integrate the motion over time.

        Parameters
        ----------
        time : array_like, shape (t,)
            When the motion is asked for [s], increasing; it begins at the first.
        drive : point or list of points, optional
            What the force acts on, such as ``("z", 0.5)``, or ``("end", 0, "z")``, an end whose
            motion [m, rad] is given in place of a force. None: free motion.
        force : array_like, shape (t,), Sine, Chirp, Step or Impulse, or a tuple of them (their sum)
            [N, N m]; one for each of a list of drives. An array is straight between its samples.
        response : point or list of points, optional
            What is watched, as in `frf`; the drive points where left out.
        quantity : {"displacement", "velocity", "acceleration"}
            Of the responses.
        start : mapping from points to float, Deflection, or function, optional
            Static loads [N, N m] that are let go at the first time, at the mean tension and without
            what is not linear; or the shape, a function of x [m] for z, or {coordinate: function}.
        velocity : mapping from points to float, or function, optional
            Impulses at the first time [N s, N m s], or the velocity as `start` gives the shape,
            of what supports do not hold.
        method : {"auto", "modal", "line", "events"}
            ``"modal"``: the sum over modes, each exact, where damping does not couple them.
            ``"line"``: exact transfer functions inverted, for any damping. ``"events"``: stops and
            friction, in closed form between events. ``"auto"``: modal, else the line; of what is
            not linear events, collocation, Volterra's equation, or steps of all modes of a chain
            where laws act beside a tension that varies.
        modes : int, optional
            Of each component, that the modal method sums; where left out all of a chain of at most
            1000 unknowns, else those below eight times what force and times resolve, from 64 to
            400.
        tolerance : float, optional
            Part of each response's largest value that errors keep to (`History.total_error` adds
            that of elements); 1e-3, of linear motion with `modes` given any.
        snapshots : array_like, optional
            When the displacement of the whole rope is kept [s].
        progress : None, True or callable
            True: a line on stderr; a callable takes the fraction that is done.
        partial : bool
            True: where steps fail, or at Ctrl-C, what was computed before is the answer, see
            `History.stopped`; where contacts make motion chaotic, see `History.sure_until`.

        Returns
        -------
        History

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning, or the method does not take the scene.
        SolveError
            If the error exceeds the tolerance: by how much. If a step does not converge: when; its
            `history` is what was computed before.

        Notes
        -----
        A tension that varies is followed in chains, at points whose motion their modes tell: not
        internal forces, moved ends, or forces on coordinates without inertia. A law of a
        `NodeForce` that raises ends the run; its exception says for which part and when.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile(elements=64)
        >>> start = {("z", 0.5): 0.4}
        >>> history = model.transient([0.0, 0.1], start=start, response=("z", 0.5))
        >>> print(history.value[0].round(3) + 0.0)
        [ 0.01 -0.01]
        """
        asked: Any = {"drive": drive, "force": force, "response": response, "quantity": quantity}
        asked |= {"start": start, "velocity": velocity, "snapshots": snapshots}
        asked |= {"method": method, "modes": modes, "tolerance": tolerance}
        asked |= {"partial": partial, "progress": progress}
        refuse_rubbing(self, "over time it is a hysteresis along the whole rope; its steady motion")
        run = Run.of(self, time, STRAIGHT, **asked)
        return turned(run, follow_motion)

    @waited
    def floquet(self, modes: int | None = 4) -> Floquet:
        """Find how free motion grows or decays under the tension that pulsates.

        The lowest modes at the mean tension are coupled by the tension, and motion over one period
        is computed to rounding; without damping it is exactly symplectic.

        Parameters
        ----------
        modes : int, optional
            With transverse motion, the lowest ones, at most 200. None: all of a chain.

        Returns
        -------
        Floquet

        Raises
        ------
        TypeError
            If the number is not a whole one.
        SceneError
            If the tension does not pulsate, the scene has gravity or what is not linear, a damping
            is not in proportion to velocity, or the number has no meaning.
        SolveError
            If there are fewer modes, or the numbers overflow.

        References
        ----------
        V. V. Bolotin, The Dynamic Stability of Elastic Systems (1964); A. H. Nayfeh, D. T. Mook,
        Nonlinear Oscillations (1979), chapter 5.

        Examples
        --------
        >>> import ropedyn as rd
        >>> tension = rd.Tension(1000.0, amplitude=20.0, frequency=100.0)
        >>> floquet = rd.Scene(rd.Rope(1.0, 0.1), tension=tension).compile().floquet(modes=1)
        >>> floquet.stable, floquet.growth.round(2)
        (False, array([ 1.57, -1.57]))
        """
        refuse_nonlinear(self)
        return solve_floquet(self, modes)

    @waited
    def stability_map(
        self,
        frequency: ArrayLike,
        amplitude: ArrayLike,
        *,
        modes: int | None = 4,
        progress: Progress = None,
    ) -> StabilityMap:
        """Find at which frequencies and amplitudes of the tension motion grows.

        Parameters
        ----------
        frequency, amplitude : array_like, shape (f,) and (a,)
            Of the tension [Hz; N about the scene's mean], increasing.
        modes, progress : optional
            As in `floquet` and `transient`.

        Returns
        -------
        StabilityMap

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            As `floquet` does, and if frequencies or amplitudes do not increase.
        SolveError
            As `floquet` does, and if a frequency is so low that a period takes too many steps.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
        >>> stability = model.stability_map([80.0, 100.0, 120.0], [0.0, 100.0], modes=1)
        >>> stability.stable
        array([[ True,  True,  True],
               [ True, False,  True]])
        >>> [tongue.label for tongue in stability.tongues]
        ['2 f1']
        """
        refuse_nonlinear(self)
        return solve_stability(self, frequency, amplitude, modes=modes, progress=progress)

    @overload
    def stepped_sine(
        self, frequency: ArrayLike, *, branches: Literal[False] = False, **asked: Any
    ) -> FRF: ...

    @overload
    def stepped_sine(
        self, frequency: ArrayLike, *, branches: Literal[True], **asked: Any
    ) -> Branches: ...

    @waited  # type: ignore[misc]  # which names asked may have is said here alone
    def stepped_sine(
        self,
        frequency: ArrayLike,
        *,
        drive: Any,
        amplitude: float,
        response: Point | Sequence[Point] | None = None,
        branches: bool = False,
        quantity: str = "receptance",
        tolerance: float | None = None,
        progress: Progress = None,
    ) -> FRF | Branches:
        """Find the steady motion under a sine whose frequency is stepped.

        What has the frequency of the drive: of linear scenes and with `WireFriction` as `frf`, of
        others by harmonic balance.
        The first state is reached from rest as the amplitude is raised, each other one along the
        branch from the one before, and where that ends on the next stable one it leads to.
        Friction that can hold does so where the rope rests: beside stops and smooth laws a sudden
        start may end in another state, in which it holds elsewhere.

        Parameters
        ----------
        frequency : array_like, shape (f,)
            [Hz], each > 0, in any order.
        drive : point, such as ``("z", 0.5)`` or ``("end", 0, "z")``
        amplitude : float
            Of a sine, from 1e-100 to 1e100 [N, N m; m, rad of an end].
        response : point or list of points, optional
        branches : bool
            Whether all branches between the lowest and the highest frequency are followed.
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration, per amplitude.
        tolerance : float, optional
            By which part of the motion more harmonics change it, 1e-5; 1e-3 where friction slips.
        progress : None, True or callable, as in `transient`

        Returns
        -------
        FRF, or Branches if `branches`
            `rounding_error` is the estimated error; `stable` tells what disturbances leave.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a value has no meaning; a `LossFactor`; continuous spans whose tension pulsates or
            is stretching, or where dry friction slips; branches where it does.
        SolveError
            If there is no steady state, or 256 harmonics do not tell it.

        Examples
        --------
        >>> import ropedyn as rd
        >>> how = {"damping": rd.RayleighDamping(6.0, 0.0), "parts": [rd.Stop(0.5, 1e3, gap=2e-3)]}
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, **how)
        >>> stepped = scene.compile().stepped_sine([12.0, 15.0], drive=("z", 0.5), amplitude=1.0)
        >>> abs(stepped.value).round(5), stepped.stable
        (array([[0.00343, 0.00516]]), array([ True,  True]))
        """
        check.instance(branches, "branches", bool, "True or False")
        ask: Any = {"drive": drive, "amplitude": amplitude, "response": response}
        ask |= {"quantity": quantity, "tolerance": tolerance}
        if rubbing(self):
            return solve_rubbing(self, frequency, branches=branches, **ask)
        asked = SteppedSine.of(self, frequency, progress=progress, **ask)
        refuse_steady(asked)
        return solve_branches(asked) if branches else solve_stepped(asked)


class HangingModel(Hanging, Model):  # type: ignore[misc]  # `Hanging` takes what `Model` names
    """A model of a rope that sags; see `Hanging`."""


def compile_model(scene: Scene, **how: Any) -> Any:
    """Compile a scene; see `Scene.compile`."""
    if scene.is_spatial or (scene.sags and scene.is_graded):
        return compile_space(scene, **how)
    model = object.__new__(HangingModel if scene.sags else Model)
    vars(model).update(vars(compile_within(scene, **how)))
    return model
