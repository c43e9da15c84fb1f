"""Identify one rope: which modes its peaks are, unless that is said, then its numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...base.answer import Cost
from ...base.array import Integer, Real
from ...base.computed import computed, waited
from ...base.errors import RopedynError, SceneError
from ...base.named import Named
from ...curves.peaks import Peaks
from ...scene.bench.prior import Prior
from ...scene.path import value_at, with_values
from ...scene.scene import Scene
from ..compare.unit_slips import slip_of_tension, slips_of_peaks
from ..fitting.natural import is_moved, shift_by_damping
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.unknown import TIE, Unknowns
from ..orders.numbering import Numbering, decided, numberings
from ..orders.orders import given_orders
from ..orders.sensed import refuse_outside
from ..orders.standardised import SPREAD
from ..posterior.space import TENSION
from .candidates import Candidates
from .cross_checks import cross_checks
from .fit import Fit
from .fit_peaks import Options
from .known import LEVELS, METHODS, TOLD, Known, kept_bounds, without_end
from .notes import sag_note
from .other_ends import Remarks, other_ends
from .peak_damping import PeakDamping, beside, damping_of_peaks
from .report import changed_by_prior, shown
from .told import Told

MOST = 6
"""Numberings are named up to so many."""
NAMEABLE = 1e-6
"""Less likely ones are not named."""

PASSES, SETTLED = 12, 1e-9
"""Damping and frequencies take turns so often at most, until they move by no more of themselves."""
FAR = 5.0
"""A tension so many times its guess is named: the guess took part in the choice of orders."""

NO_MODES = (
    "no numbering explains the peaks better than that all are strays, or fewer than two are modes: "
    "give orders, a prior of the tension, or a record with more modes"
)

UNSETTLED = "numbers by frequencies and damping by widths did not settle: they still change"

UNDAMPED = (
    "damping that is not proportional moves natural frequencies, which is left out: complex modes "
    "are not carried on an axis"
)

AMBIGUOUS = (
    "ambiguous: the peaks do not tell which modes they are, see the candidates; a prior of the "
    "tension, sensors that tell shapes (one at 0.15 of the length) or more modes would decide"
)

UNLIMITED = "not trusted: no limit of 95 % of {}"


@dataclass(frozen=True, eq=False)
class Hull:
    """Numbers whose intervals hold those of all rival numberings."""

    first: Known
    candidates: Candidates

    @property
    def scene(self) -> Scene:
        """Return the scene of the likeliest."""
        return self.first.scene

    def interval(self, level: float, method: str) -> Real:
        """Return their intervals, shape (p, 2)."""
        return self.candidates.hull(level, method)


@dataclass(frozen=True, eq=False)
class WithDamping:
    """Numbers by the frequencies of peaks, then those of damping by their widths."""

    first: Known
    damping: PeakDamping

    @property
    def scene(self) -> Scene:
        """Return the scene with them."""
        return self.damping.scene

    def interval(self, level: float, method: str) -> Real:
        """Return their intervals, shape (p, 2)."""
        by_width = self.damping.interval(level, method=method)
        return np.concatenate([self.first.interval(level, method), by_width])


class Decision(NamedTuple):
    """What the peaks decide."""

    status: str
    candidates: Any  # or what computes them
    known: Known
    unlimited: tuple[str, ...] = ()  # numbers of an interval without end, of the one numbering


@dataclass(frozen=True, eq=False)
class RopeTask:
    """One rope, and how it is identified."""

    scene: Scene
    how: Options
    peaks: Peaks
    tell: Callable[[Options, Peaks, Integer, Scene], Told]  # what peaks of given orders tell
    record: dict[str, Any] | None = None  # what the peaks are of

    @computed
    def said(self) -> Integer | None:
        """Which mode each peak is, where somebody says it."""
        return given_orders(self.how.orders, self.peaks)

    @waited
    def fit(self) -> Fit:
        """Find its orders and its numbers."""
        refuse_outside(self.scene, self.peaks.sensors or ())
        found, status = self._numbered()
        if status == "refused":
            return self._refused()
        orders = np.array(found[0].orders, dtype=np.int64)
        told, damped = self._both(orders)
        told = replace(told, notes=(*told.notes, *self._slipped()))
        return self._fit(told, damped, orders, self._decision(status, found, told, damped))

    def _slipped(self) -> tuple[str, ...]:
        """Name a slip of units in peaks whose orders nobody gave."""
        if self.said is not None:
            return ()
        return slips_of_peaks(np.asarray(self.peaks.frequency), self.scene.compile())

    def _both(self, orders: Integer) -> tuple[Told, PeakDamping | None]:
        """Return what frequencies and widths tell, each with what the other has told."""
        told = self._told(orders)
        if not self.how.damping:
            return told, None
        damped = self._damping(told, orders)
        if not is_moved(self.scene):
            return told, damped
        for _ in range(PASSES):
            before = np.concatenate([told.value, damped.value])
            found = with_values(self.scene, dict(zip(damped.unknown, damped.value.tolist())))
            told = replace(self, scene=found)._told(orders)
            damped = self._damping(told, orders)
            if np.allclose(before, [*told.value, *damped.value], rtol=SETTLED, atol=0):
                return told, damped
        return replace(told, notes=(*told.notes, UNSETTLED)), damped

    def _told(self, orders: Integer) -> Told:
        """Return what peaks tell whose natural frequencies damping has moved."""
        told = self.tell(self.how, self.peaks, orders, self.scene)
        if not is_moved(self.scene):
            return told
        if self.scene.is_spatial:
            return replace(told, notes=(*told.notes, UNDAMPED))
        frequency, used = np.asarray(self.peaks.frequency), orders > 0
        shift = np.zeros(len(frequency))
        for _ in range(PASSES):
            moved = shift_by_damping(told.known.scene, int(orders.max()))
            before, shift = shift, np.where(used, moved[np.maximum(orders - 1, 0)], 0.0)
            if np.abs(shift - before).max() < SETTLED:
                return told
            undamped = replace(self.peaks, frequency=frequency * np.exp(-shift))
            told = self.tell(self.how, undamped, orders, self.scene)
        left = float(np.abs(shift - before).max())
        note = f"frequencies that damping moves did not settle: they still change by {left:.1g}"
        return replace(told, notes=(*told.notes, note))

    def _decision(
        self, status: str, found: Sequence[Numbering], told: Told, damped: PeakDamping | None
    ) -> Decision:
        """Return what else the peaks may be, and how well numbers are known for it."""
        candidates: Any = partial(self._candidates, found, told)
        known = told.known
        if status == "ambiguous":
            candidates = candidates()
            known = Hull(known, candidates)
        known = known if damped is None else WithDamping(known, damped)
        if status == "ambiguous":
            return Decision(status, candidates, known)
        paths = self.how.paths if damped is None else (*self.how.paths, *damped.unknown)
        endless = without_end(known.interval(TOLD, METHODS[0]))
        unlimited = tuple(path for path, one in zip(paths, endless) if one)
        return Decision("ambiguous" if unlimited else status, candidates, known, unlimited)

    def _damping(self, told: Told, orders: Integer) -> PeakDamping:
        """Return what the damping ratios of the peaks tell."""
        peaks, how = self.peaks, self.how
        std = None if peaks.damping_ratio_std is None else np.asarray(peaks.damping_ratio_std)
        return damping_of_peaks(
            told.known.scene,
            how.damping,
            orders,
            np.asarray(peaks.damping_ratio),
            std,
            elements=how.elements,
            element=how.element,
        )

    def _numbered(self) -> tuple[Sequence[Numbering], str]:
        """Return the numberings worth naming, the likeliest first, and what they decide."""
        if self.said is not None:
            return [Numbering(tuple(self.said.tolist()), 1.0, 0.0, ())], "trusted"
        peaks, how = self.peaks, self.how
        self._refuse_unseen()
        found = numberings(
            self.scene,
            [place for path in how.paths for place in path.split(TIE)],
            np.asarray(peaks.frequency),
            None if peaks.std is None else np.asarray(peaks.std),
            prior=how.prior,
            ends=how.ends,
            sensors=peaks.sensors,
            shape=peaks.shape,
            kind=peaks.kind,
            model_std=how.model_std,
            elements=how.elements,
            element=how.element,
        )
        status = decided(found)
        named = [one for one in found[:MOST] if one.probability > NAMEABLE]
        return named or found[:1], status

    def _refuse_unseen(self) -> None:
        """Refuse numbers that natural frequencies do not depend on, and more of them than peaks."""
        how, k = self.how, len(np.asarray(self.peaks.frequency))
        if k + len(how.prior) < how.numbers:
            raise SceneError(
                f"measured must have at least {how.numbers - len(how.prior)} peaks for "
                f"{how.numbers} unknown and {len(how.prior)} prior values, got {k}"
            )
        unknowns = Unknowns.of(self.scene, how.paths)
        calculated = NaturalFrequencies.of(unknowns, how.elements, how.element)
        _, slope = calculated.lowest(np.zeros(len(unknowns)), k)
        for i in np.flatnonzero(~slope.any(axis=0)).tolist():
            if how.paths[i] not in how.prior:
                raise SceneError(
                    f"unknown[{i}] must change the natural frequencies, got {how.paths[i]!r}, "
                    "which does not"
                )

    def _candidates(self, found: Sequence[Numbering], first: Told) -> Candidates:
        """Return what each numbering tells; one that has no numbers is not named."""
        each = []
        for i, one in enumerate(found):
            orders = np.array(one.orders, dtype=np.int64)
            try:
                told = self._told(orders) if i else first
            except RopedynError:
                continue
            each.append((one.probability, orders, told.value, told.known))
        return Candidates.of(self.how.paths, each)

    def _fit(
        self, told: Told, damped: PeakDamping | None, orders: Integer, decision: Decision
    ) -> Fit:
        """Gather what was found."""
        how, k, p = self.how, len(orders), len(told.value)
        alone = decision.status == "trusted" or bool(decision.unlimited)
        std = told.std if alone else np.full(p, np.nan)
        paths, value, correlation, notes = how.paths, told.value, told.correlation, told.notes
        status, sagging = decision.status, self._sagging(decision.known.scene, told, orders)
        if sagging:
            notes, status = (*notes, sagging), status.replace("trusted", "ambiguous")
        if damped is not None:
            paths, value = (*paths, *damped.unknown), np.append(value, damped.value)
            std, notes = np.append(std, damped.std), (*notes, *damped.notes)
            correlation = beside(correlation, damped.correlation)
        return Fit(
            unknown=paths,
            value=Named(value, paths),
            std=Named(std, paths),
            correlation=correlation,
            orders=orders,
            measured=np.asarray(self.peaks.frequency),
            measured_std=told.measured_std,
            calculated=told.calculated,
            freedom=told.freedom,
            chi_square=told.chi_square,
            probability=told.probability,
            status=status,
            budget=told.budget,
            ends=how.ends,
            assumed=(*told.assumed, *self._assumed()),
            notes=(*_why(decision, paths, std), *notes, *(self._far(told) if alone else ())),
            seed=how.seed,
            cost=Cost(told.method, how.elements or 0, k, factorisations=told.evaluations),
            candidates=decision.candidates,
            bounds=partial(kept_bounds, decision.known.interval),
            scene=partial(getattr, decision.known, "scene"),
            known=decision.known,
            remarks=partial(self._remarks, told, orders, decision),
            details=details_of(self.peaks),
            record=self.record,
        )

    def _sagging(self, scene: Scene, told: Told, orders: Integer) -> str:
        """Say where the parabola of sag is off by more than the peaks."""
        relative = told.measured_std / np.asarray(self.peaks.frequency)
        return sag_note(scene, orders, np.hypot(relative, self.how.model_std))

    def _weighs_guess(self) -> bool:
        """Whether the guess of the tension took part in the choice of orders."""
        how = self.how
        sought = TENSION in how.paths and TENSION not in how.prior
        return sought and self.said is None

    def _assumed(self) -> tuple[str, ...]:
        """Say what the search of orders took the guess of the tension for."""
        if not self._weighs_guess():
            return ()
        guess, factor = value_at(self.scene, TENSION), np.exp(SPREAD)
        return (
            f"of orders: tension {guess:.4g} N within a factor of {factor:.2g} in two of three",
        )

    def _far(self, told: Told) -> tuple[str, ...]:
        """Name a tension that is far from its guess, or as far as a slip of units is."""
        if TENSION not in self.how.paths:
            return ()
        found = float(told.value[self.how.paths.index(TENSION)])
        guess = value_at(self.scene, TENSION)
        times = found / guess if guess else math.nan
        slip = slip_of_tension(guess, found)
        if slip is not None:
            return (f"tension is {times:.3g} times its guess, {slip.name}: {slip.asked}",)
        if not self._weighs_guess() or math.isnan(times) or 1 / FAR < times < FAR:
            return ()
        return (
            f"tension is {times:.3g} times its guess: if the guess is nearer than that the orders "
            "are others, say so by a prior; frequencies in rad/s would be such a slip",
        )

    def _remarks(self, told: Told, orders: Integer, decision: Decision) -> Remarks:
        """Return what costs something to say."""
        ends = told.ends
        if self.how.ends == "given":
            tell = partial(self.tell, self.how, self.peaks, orders)
            ends = tuple(other_ends(self.scene, self.how.paths, tell))
        prior = self._said_of_prior(orders, decision)
        return Remarks(ends, self._cross_checks(orders), prior, *told.fixity)

    def _said_of_prior(self, orders: Integer, decision: Decision) -> tuple[str, ...]:
        """Say what the same peaks tell where the prior says nothing of what is unknown."""
        prior, paths = self.how.prior, self.how.paths
        known = [path for path in paths if path in prior]
        if not known:
            return ()
        rest: Any = [path for path in prior if path not in paths]
        rest = prior.marginal(rest) if rest and isinstance(prior, Prior) else {}
        said = f"without the prior of {' and '.join(known)}: "
        try:
            fit = replace(self, how=self.how._replace(prior=rest)).fit()
        except RopedynError as error:
            return (f"{said}{error}",)
        same = (one.probability for one in fit.candidates if (one.orders == orders).all())
        probability = next(same, 0.0)
        bounds = decision.known.interval(TOLD, METHODS[0])
        return (said + changed_by_prior(fit, probability, bounds),)

    def _cross_checks(self, orders: Integer) -> tuple[str, ...]:
        """Say what closed formulas give, of one rope alone."""
        scene = self.scene
        bent = scene.parts or scene.gravity is not None or scene.is_spatial
        if bent or "tension" not in self.how.paths:
            return ()
        found = cross_checks(scene.rope, np.asarray(self.peaks.frequency), orders)
        return tuple(
            f"{one.name} {shown(one.tension, 'N')}" + ("" if one.applies else " (out of its range)")
            for one in found
            if one.tension is not None
        )

    def _refused(self) -> Fit:
        """Return a fit without numbers."""
        how, frequency = self.how, np.asarray(self.peaks.frequency)
        p, k = len(how.paths), len(frequency)
        nan = np.full(k, np.nan)
        blank = np.full((p, 2), np.nan)
        empty = Candidates(
            how.paths,
            np.zeros(0),
            np.zeros((0, k), dtype=np.int64),
            np.zeros((0, p)),
            np.zeros((0, len(LEVELS), p, 2)),
        )
        return Fit(
            unknown=how.paths,
            value=Named(np.full(p, np.nan), how.paths),
            std=Named(np.full(p, np.nan), how.paths),
            correlation=np.full((p, p), np.nan),
            orders=np.zeros(k, dtype=np.int64),
            measured=frequency,
            measured_std=nan if self.peaks.std is None else np.asarray(self.peaks.std),
            calculated=nan,
            freedom=None,
            chi_square=float("nan"),
            probability=float("nan"),
            status="refused",
            budget={},
            ends=how.ends,
            assumed=(),
            notes=(NO_MODES, *self._slipped()),
            seed=how.seed,
            cost=Cost("evidence", how.elements or 0, k),
            candidates=empty,
            scene=_no_scene,
            bounds=np.broadcast_to(blank, (len(LEVELS), p, 2)).copy(),
            remarks=Remarks(),
            details=details_of(self.peaks),
            record=self.record,
        )


def _no_scene() -> Scene:
    raise SceneError("a fit that is refused has no scene: its notes say why")


def _why(decision: Decision, paths: Sequence[str], std: Real) -> tuple[str, ...]:
    """Say why a fit is not trusted; what has no finite std has a note of its own."""
    if not decision.unlimited:
        return (AMBIGUOUS,) * (decision.status == "ambiguous")
    silent = [p for p, one in zip(paths, std) if p in decision.unlimited and np.isfinite(one)]
    return (UNLIMITED.format(", ".join(silent)),) if silent else ()


def details_of(peaks: Peaks) -> tuple[dict[str, Any], ...]:
    """Return what a record says of each peak beside its frequency, as JSON knows it."""
    columns = {
        "damping": peaks.damping_ratio,
        "snr": peaks.snr,
        "band": peaks.band,
        "kind": peaks.kind,
        "shape": None if peaks.shape is None else np.real(peaks.shape),
    }
    there = {name: np.asarray(each).tolist() for name, each in columns.items() if each is not None}
    return tuple(dict(zip(there, row)) for row in zip(*there.values()))
