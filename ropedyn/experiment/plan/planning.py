"""Planning of a measurement: wanted modes, places, the record, and what damage changes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...chain.place import points
from ...chain.port import Point
from ...model import Model
from ...scene.agree import refuse_axis
from ...scene.parts.part import Hinge, PointMass
from ...scene.parts.stretch import AddedMass, LocalChange
from ...scene.scene import Scene
from .placement import CandidatePlaces, best_placement
from .plan import Plan
from .target_modes import TargetModes, target_modes

DamageKind = LocalChange | AddedMass | PointMass | Hinge

LINES = 4  # A half-power bandwidth and the distance of two modes must hold so many lines.
ROOM = 1.1  # The top of the band is so many times the highest wanted frequency.
UNSEEN = 1e-4  # Less of the highest peak of a mode is what straight lines leave of its node.
MOST_SENSORS = 64  # At most so many sensors are placed.
SHARE = 0.01  # A damage that is given as a place has this share of the rope.


def plan_measurement(
    scene: Scene,
    modes: int | Sequence[int] = 5,
    *,
    drive: str | Point | None = None,
    response: str | Point | Sequence[Point] | None = None,
    sensors: int = 1,
    between: tuple[float, float] | None = None,
    places: Sequence[float] | None = None,
    apart: float = 0.0,
    damage: float | tuple[float, float] | DamageKind | None = None,
    loss: float = 0.1,
    std: float | None = None,
) -> Plan:
    """Choose where to drive and where to listen so that all wanted modes are seen.

    The peak of mode n is |phi_n(x_d) phi_n(x_r)|/(2 zeta_n m_n omega_n^2) (Ewins, Modal Testing,
    2nd ed., chapter 2), so that |phi_n(x_d) phi_n(x_r)| over its largest along the rope is what
    places decide about it. The least of that over the modes is maximised; of several sensors the
    best counts for each mode.

    The record is as long as the most demanding of these needs, T = 1/df:

    * the half-power bandwidth 2 zeta f of each mode holds 4 lines: the mean of the peak's power
      over one line is (b/df) arctan(df/b) of its top, 2 % too low;
    * the distance of each mode to the next holds 4 lines, the main lobe of a Hann window (Harris,
      Proc. IEEE 66, 1978, p. 51), where that is more than the bandwidth: nearer ones show one peak;
    * a frequency read to the nearest line has the standard uncertainty df/sqrt(12) (GUM, JCGM
      100:2008, 4.3.7), which must not be more than `std`.

    The rate is 2.56 times the top of the band, which leaves room for the anti-alias filter.

    Parameters
    ----------
    scene : Scene
        What will be measured, as far as it is known. Bandwidths need its damping.
    modes : int or sequence of int
        The lowest so many of those that drive and response can see; or the numbers of modes, from
        1, as `Model.modes` has them.
    drive : str or point, optional
        Coordinate whose best place is looked for, or a point such as ``("z", 0.4)`` that is fixed;
        z, or the first coordinate of a scene without it, where left out.
    response : str or point or list of points, optional
        The same for the sensors; the coordinate of the drive where left out.
    sensors : int
        How many to place.
    between : pair of float, optional
        Where drive and sensors can be [m]; anywhere where left out.
    places : sequence of float, optional
        The only places where they can be [m].
    apart : float
        Least distance between any two of them [m]; 0 lets a sensor be at the drive.
    damage : float or pair of float or LocalChange, AddedMass, PointMass, Hinge, optional
        What else should be seen: a part that a damaged rope has, or where it begins and ends [m];
        a place means the hundredth part of the rope about it.
    loss : float
        Share of bending and torsional stiffness that is lost where the damage is no part.
    std : float, optional
        Wanted standard uncertainty of each frequency [Hz].

    Returns
    -------
    Plan

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If an argument is out of range, a mode cannot be seen from anywhere that is allowed, or
        nothing moves the response when the drive does.
    SolveError
        If the rope has not so many modes, or two wanted ones have one frequency and no damping.

    Examples
    --------
    The third mode of a string has nodes at a third and two thirds, the second in the middle:

    >>> import ropedyn as rd
    >>> string = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, damping=rd.ModalDamping(0.01))
    >>> plan = rd.plan_measurement(string, modes=3, places=[0.12, 0.24, 0.333, 0.5], std=0.2)
    >>> plan.drive, plan.response, plan.seen.round(2)
    (('z', 0.24), (('z', 0.24),), array([0.47, 1.  , 0.59]))
    >>> print(plan.report())
    Drive z at 0.240 m, listen to z at 0.240 m.
    Every mode has at least 47 % of the highest peak it can have; mode 1 has least.
    Record 4 s, lines 0.25 Hz apart: 4 lines in the half-power bandwidth of mode 1, 1 Hz.
    Sample at 422.4 Hz or faster, band up to 165 Hz.
    """
    check.instance(scene, "scene", Scene, "a Scene")
    refuse_axis(scene, "planning")
    model = scene.compile()
    where = _where(model, drive, response, sensors)
    target = target_modes(model, modes, where.coordinates)
    allowed = _allowed(scene.rope.length, target.x, between, places)
    driver = _candidates(target.x, target.driven, where.drive, allowed)
    listeners = [_candidates(target.x, target.heard, one, allowed) for one in where.sensors]
    least = check.number(apart, "apart", "m", sign="nonnegative")
    found = best_placement(driver, listeners, least)
    if found is None:
        raise SceneError(
            f"apart must leave room for a drive and {len(listeners)} sensors, got {apart!r} m"
        )
    pairs = [(one, at) for one, at in zip(listeners, found.sensors)]
    visibility = driver.share[:, found.drive] * np.array([one.share[:, at] for one, at in pairs])
    _refuse_unseen(target, visibility)
    # peaks are 0 where a mode is not seen at all, whatever its damping
    amplitude = np.zeros_like(visibility)
    np.multiply(visibility, target.highest_peak, out=amplitude, where=visibility > 0)
    need = _needs(target, check.optional(std, "std", "Hz", sign="positive"))
    reason = min(need, key=need.__getitem__)
    part = _damage(scene, damage, check.number(loss, "loss", sign="positive"))
    return Plan(
        drive=(where.coordinates[0], float(driver.x[found.drive])),
        response=tuple((where.coordinates[1], float(one.x[at])) for one, at in pairs),
        mode=target.mode,
        frequency=target.frequency,
        damping_ratio=target.damping_ratio,
        visibility=visibility,
        amplitude=amplitude,
        separation=target.separation,
        line_spacing=need[reason],
        reason=reason,
        highest=ROOM * float(target.frequency.max()),
        x=target.x,
        driven=target.driven,
        heard=target.heard,
        damage="" if part is None else _described(part),
        shift=None if part is None else _shift(scene, part, target, where.coordinates),
    )


class _Where(NamedTuple):
    """What was asked for: coordinates of drive and response, and what is fixed."""

    coordinates: tuple[str, str]
    drive: float | None
    sensors: list[float | None]


def _where(model: Model, drive: Any, response: Any, sensors: Any) -> _Where:
    """Check where the user wants to drive and to listen."""
    default = "z" if "z" in model.coordinates else model.coordinates[0]
    driver, drives = _asked(model, default if drive is None else drive, "drive")
    if len(drives) > 1:
        raise SceneError(f"drive must be one coordinate or one point, got {check.shown(drive)}")
    listener, listeners = _asked(model, driver if response is None else response, "response")
    count = check.count(sensors, "sensors", most=MOST_SENSORS)
    if listeners and count not in (1, len(listeners)):
        raise SceneError(f"sensors must be left out where response is points, got {count}")
    if not any({driver, listener} <= set(component) for component in model.components):
        raise SceneError(
            f"response must be a coordinate that moves with {driver} in this scene, "
            f"got {listener!r}"
        )
    fixed: list[float | None] = [*listeners] or [None] * count
    return _Where((driver, listener), drives[0] if drives else None, fixed)


def _asked(model: Model, given: Any, name: str) -> tuple[str, list[float]]:
    """Return a coordinate and the positions that are fixed, none where it is looked for."""
    if isinstance(given, str):
        return check.one_of(given, name, model.coordinates), []
    found, _ = points(model, given, name, forces=False)
    if not found or len({coordinate for coordinate, _ in found}) > 1:
        raise SceneError(
            f"{name} must be a coordinate or points of one coordinate, got {check.shown(given)}"
        )
    return found[0][0], [x for _, x in found]


def _allowed(length: float, x: Real, between: Any, places: Any) -> Real:
    """Return positions where somebody can drive and listen."""
    start, stop = 0.0, length
    if between is not None:
        check.instance(between, "between", (tuple, list), "two positions [m]")
        if len(between) != 2:
            raise SceneError(f"between must be two positions [m], got {check.shown(between)}")
        start, stop = (check.position(b, f"between[{i}]", length) for i, b in enumerate(between))
        if not start < stop:
            raise SceneError(f"between must be two positions that increase, got {between!r}")
    if places is None:
        inside = x[(x > start) & (x < stop)]
        return np.concatenate([[start], inside, [stop]])
    given = check.numbers(places, "places", "m")
    at = np.array([check.position(p, f"places[{i}]", length) for i, p in enumerate(given.tolist())])
    at = at[(at >= start) & (at <= stop)]
    if len(at) == 0:
        raise SceneError(f"places must have one within between, got {check.shown(places)}")
    return at


def _candidates(x: Real, motion: Real, fixed: float | None, allowed: Real) -> CandidatePlaces:
    """Return where one may be, and what is seen there, (pi/32)^2/8 of the largest off at most."""
    at = allowed if fixed is None else np.array([fixed])
    return CandidatePlaces(at, np.abs([np.interp(at, x, row) for row in motion]))


def _refuse_unseen(target: TargetModes, visibility: Real) -> None:
    unseen = target.mode[visibility.max(axis=0) <= UNSEEN].tolist()
    if unseen:
        raise SceneError(
            f"drive and response must be able to see mode {unseen[0]}: no place that is allowed or "
            "fixed shows it together with the other modes"
        )


def _needs(target: TargetModes, std: float | None) -> dict[str, float]:
    """Return the widest line spacing [Hz] that serves each need, by its name."""
    need = {}
    bandwidth = 2 * target.damping_ratio * target.frequency
    if (bandwidth > 0).any():
        k = int(np.where(bandwidth > 0, bandwidth, np.inf).argmin())
        reason = f"{LINES} lines in the half-power bandwidth of mode {target.mode[k]}"
        need[f"{reason}, {bandwidth[k]:.4g} Hz"] = float(bandwidth[k]) / LINES
    apart = np.where(target.separation > bandwidth, target.separation, np.inf)
    k = int(apart.argmin())
    if np.isfinite(apart[k]):
        reason = f"{LINES} lines between mode {target.mode[k]} and the next"
        need[f"{reason}, {apart[k]:.4g} Hz apart"] = float(apart[k]) / LINES
    if std is not None:
        need[f"a line read to {std:.4g} Hz"] = std * math.sqrt(12)
    if not need:
        raise SolveError(
            "the wanted modes have equal frequencies and no damping: no record is long enough"
        )
    return need


def _damage(scene: Scene, given: Any, loss: float) -> DamageKind | None:
    """Return the part that a damaged rope has."""
    if given is None or isinstance(given, (LocalChange, AddedMass, PointMass, Hinge)):
        return given
    length = scene.rope.length
    if isinstance(given, (tuple, list)):
        if len(given) != 2:
            raise SceneError(f"damage must be two positions [m], got {check.shown(given)}")
        start, stop = (check.position(x, f"damage[{i}]", length) for i, x in enumerate(given))
    else:
        x = check.position(given, "damage", length)
        start, stop = max(x - SHARE / 2 * length, 0.0), min(x + SHARE / 2 * length, length)
    if not loss < 1:
        raise SceneError(f"loss must be a number between 0 and 1, got {loss!r}")
    worn = {name: LocalChange.acts_on[name] for name in ("bending", "torsion")}
    lost = {name: 1 - loss for name, c in worn.items() if c in scene.coordinates}
    if not lost:
        raise SceneError(
            "damage must be a LocalChange with a density where the scene has no bending or "
            f"torsional stiffness, got {check.shown(given)}"
        )
    return LocalChange(start, stop, **lost)


def _described(part: DamageKind) -> str:
    """Say what a part is, without its defaults and with few digits."""
    said = [
        f"{each.name}={getattr(part, each.name):.4g}"
        for each in dataclasses.fields(part)
        if getattr(part, each.name) != each.default
    ]
    return f"{type(part).__name__}({', '.join(said)})"


def _shift(
    scene: Scene, part: DamageKind, target: TargetModes, coordinates: tuple[str, str]
) -> Real:
    """Return what a part changes of the frequencies: modes that are seen keep their order."""
    # 0 where that is less than rounding
    model = scene.replace(parts=(*scene.parts, part)).compile()
    damaged = target_modes(model, int(target.rank.max()) + 1, coordinates)
    shift = damaged.frequency[target.rank] - target.frequency
    rounding = damaged.rounding[target.rank] + target.rounding
    return np.where(np.abs(shift) > rounding, shift, 0.0)
