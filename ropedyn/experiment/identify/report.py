"""What a fit says: as text, and as JSON."""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.array import Real
from ...scene.path import unit_of
from .candidates import Candidate

if TYPE_CHECKING:
    from .fit import Fit

SCHEMA = "ropedyn.tension/1"
PREFIXES = {-9: "n", -6: "u", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
CAUSES = {"ends": "ends unknown"}
"""Words for causes that are none themselves."""


def report_of(fit: Fit) -> str:
    """Return the report of a fit."""
    if fit.status == "refused":
        return "\n".join(["refused", *fit.notes, "", str(fit.peaks())])
    lines = [*_given_ends(fit), *_numbers(fit), *_budget(fit)]
    lines += [f"  ends {one}" for one in fit.said_of_ends if fit.ends == "unknown"]
    lines += [*_orders(fit), *(f"  {one}" for one in fit.said_of_prior)]
    lines.append(f"  fit: {_goodness(fit)}; rms residual {100 * fit.rms:.3g} %")
    if fit.cross_checks:
        lines.append(f"  cross-checks: {', '.join(fit.cross_checks)}")
    lines += ["", str(fit.table()), "", str(fit.peaks())]
    lines += [f"assumed: {'; '.join(fit.assumed)}"] if fit.assumed else []
    notes = (*fit.left_out, *fit.notes[fit.status == "ambiguous" :])
    return "\n".join([*lines, *(f"note: {note}" for note in notes)])


def _given_ends(fit: Fit) -> list[str]:
    """Say first that the ends were taken as given, and what others would give."""
    if fit.ends == "unknown" or not fit.said_of_ends:
        return []
    return [f"ends taken as given: {'; '.join(fit.said_of_ends)}"]


def _numbers(fit: Fit) -> list[str]:
    """Return a line for each number; of an ambiguous fit one for each candidate."""
    if fit.status == "ambiguous":
        rivals = fit.candidates.rivals
        named = (f"  p = {_share(one.probability)}: {_candidate(one)}" for one in rivals)
        return [fit.notes[0], *named]
    bounds = fit.interval()
    return [_number(path, fit.value[path], *bounds[path]) for path in fit.unknown]


def _number(path: str, value: float, low: float, high: float) -> str:
    """Return a number with its interval, in one unit."""
    unit = unit_of(path)
    sizes = [abs(x) for x in (value, high, low) if math.isfinite(x) and x != 0]
    scale, unit = _scaled(sizes[0] if sizes else 0.0, unit)
    shown = [f"{x / scale:.4g}" for x in (value, low, high)]
    return f"{path}  {shown[0]} {unit}   95 %: {shown[1]} to {shown[2]} {unit}"


def shown(value: float, unit: str) -> str:
    """Return a number in few digits with its unit."""
    scale, scaled = _scaled(abs(value), unit)
    return f"{value / scale:.4g} {scaled}"


def _scaled(size: float, unit: str) -> tuple[float, str]:
    """Return a factor of thousands and its unit, of forces and what is made of them."""
    if not unit.startswith("N") or not 0 < size < math.inf:
        return 1.0, unit
    power = min(max(3 * math.floor(math.log10(size) / 3), -9), 9)
    return 10.0**power, PREFIXES[power] + unit


def _candidate(one: Candidate) -> str:
    bounds = one.interval()
    each = [
        _number(path, one.value[path], *bounds[path]).replace("   95", ", 95")
        for path in one.value.paths or ()
    ]
    return f"{'; '.join(each)}; modes {_modes(one.orders.tolist())}"


def _modes(orders: list[int]) -> str:
    """Return orders as they are read: a run of them by its ends."""
    modes = sorted(n for n in orders if n)
    if len(modes) > 2 and modes == list(range(modes[0], modes[-1] + 1)):
        return f"{modes[0]}..{modes[-1]}"
    return ", ".join(map(str, modes))


def _share(probability: float) -> str:
    return f"{probability:.3f}" if probability >= 0.001 else f"{probability:.0e}"


def _budget(fit: Fit) -> list[str]:
    parts = sorted(((size, cause) for cause, size in fit.budget.items() if size > 0), reverse=True)
    if not parts:
        return []
    said = [f"{CAUSES.get(cause, cause)} {100 * size:.2g} %" for size, cause in parts]
    return [f"  of which  {', '.join(said)}"]


def changed_by_prior(without: Fit, probability: float, bounds: Real) -> str:
    """Say what a fit without a prior tells of the same orders, and how wide its intervals are.

    `bounds` are those of 95 % with the prior.
    """
    if without.status == "refused":
        return "the peaks show no modes"
    said = f"orders {without.status}, these with p = {_share(probability)}"
    wide = np.diff(without.interval(0.95))[:, 0] / np.diff(bounds)[: len(without.unknown), 0]
    each = [
        f"of {path} {times:.3g} times as wide" if np.isfinite(times) else f"of {path} without end"
        for path, times in zip(without.unknown, wide.tolist())
    ]
    return f"{said}; 95 % {', '.join(each)}"


def _orders(fit: Fit) -> list[str]:
    """Say which modes the peaks are, and what else they may be."""
    used, k = int((fit.orders > 0).sum()), len(fit.orders)
    first, *others = fit.candidates
    said = f"  orders: {used} of {k} peaks are modes {_modes(fit.orders.tolist())}"
    said += f", p = {_share(first.probability)}"
    if others and fit.status == "trusted":
        path = fit.unknown[0]
        ratio = float(others[0].value[0] / fit.value[0])
        said += f"; next: {path} times {ratio:.3g} (p = {_share(others[0].probability)})"
    return [said]


def _goodness(fit: Fit) -> str:
    used, p = int((fit.orders > 0).sum()), len(fit.unknown)
    if math.isnan(fit.probability) and fit.freedom is not None:
        return f"noise estimated with {fit.freedom:.3g} degrees of freedom"
    said = f"chi-square {fit.chi_square:.3g} of {used} peaks less {p} unknown"
    return said if math.isnan(fit.probability) else f"{said}, p = {fit.probability:.2g}"


# --- JSON -------------------------------------------------------------------------------------


def sheet_of(fit: Fit) -> str:
    """Return a fit as JSON of `SCHEMA`."""
    refused = fit.status == "refused"
    clusters = [] if refused else [_cluster(one, fit.value[0]) for one in fit.candidates]
    sheet = {
        "schema": SCHEMA,
        "status": fit.status,
        "tension": _tension(fit),
        "values": {path: _quantity(fit, path) for path in fit.unknown},
        "clusters": clusters,
        "peaks": [_peak(fit, i) for i in range(len(fit.orders))],
        "fit": {
            "chi_square": _finite(fit.chi_square),
            "peaks": int((fit.orders > 0).sum()),
            "unknown": len(fit.unknown),
            "probability": _finite(fit.probability),
            "freedom": fit.freedom,
            "rms_relative": _finite(fit.rms),
        },
        "ends": {"taken": fit.ends, "said": list(fit.said_of_ends)},
        "prior": {"said": list(fit.said_of_prior)},
        "cross_checks": list(fit.cross_checks),
        "record": fit.record,
        "assumed": list(fit.assumed),
        "notes": [*fit.left_out, *fit.notes],
        "seed": fit.seed,
    }
    return json.dumps(sheet, indent=1, allow_nan=False)


def _tension(fit: Fit) -> dict[str, Any] | None:
    """Return the tension with what makes its interval, where it was sought."""
    if "tension" not in fit.unknown:
        return None
    budget = {cause: _finite(size) for cause, size in fit.budget.items()}
    return {**_quantity(fit, "tension"), "budget": budget}


def _quantity(fit: Fit, path: str) -> dict[str, Any]:
    low, high = (None, None) if fit.status == "refused" else fit.interval()[path].tolist()
    return {
        "median": _finite(fit.value[path]),
        "std": _finite(fit.std[path]),
        "interval95": [_finite(low), _finite(high)],
        "unit": unit_of(path),
    }


def _cluster(one: Candidate, first: float) -> dict[str, Any]:
    bounds = one.interval()
    paths = one.value.paths or ()
    return {
        "probability": one.probability,
        "values": {p: _finite(one.value[p]) for p in paths},
        "interval95": {p: [_finite(x) for x in bounds[p].tolist()] for p in paths},
        "orders": one.orders.tolist(),
        "times": _finite(one.value[0] / first),
    }


def _peak(fit: Fit, i: int) -> dict[str, Any]:
    std, order = float(fit.measured_std[i]), int(fit.orders[i])
    alike = [one.probability for one in fit.candidates if one.orders[i] == order]
    return {
        "frequency": float(fit.measured[i]),
        "std": _finite(std),
        **(fit.details[i] if fit.details else {}),
        "order": order or None,
        "p_order": min(sum(alike), 1.0) if fit.candidates else None,
        "calculated": _finite(fit.calculated[i]),
        "residual": _finite(fit.residual[i]),
        "residual_std": _finite(fit.residual[i] / std) if std > 0 else None,
    }


def _finite(value: Any) -> float | None:
    """Return a number, None for what JSON has no number for."""
    return float(value) if value is not None and np.isfinite(value) else None
