"""What the uncertainty of a number comes from."""

from __future__ import annotations

import numpy as np

from ...base.array import Real
from .mixture import variance_of
from .ridge import Cloud, Ridge
from .space import SPRINGS, STIFFNESS

CAUSES = {"linear_density": "mass"}
"""Names of numbers as causes; others are called by their paths."""


def budget_of(
    ridge: Ridge, cloud: Cloud, path: str, *, half: float, model: float
) -> dict[str, float]:
    """Return shares of a relative half-width of a number by their causes, squares that add up.

    Of a cause X the square is the share of the variance of E[ln p | X] in that of ln p: what the
    interval would be narrower by, on average, if X were known. Of the peaks it is what is left
    where all else is known, `model` the part of it that the model has. Causes that the peaks tell
    together, such as ends and stiffness, share what they explain, and their squares may add up to
    more or less than that of the whole.
    """
    space, log = ridge.space, _logarithms(ridge, cloud)
    within = _within(ridge, cloud, path)
    found = {}
    if space.springs:
        found["ends"] = _told(log[path], _of_ends(cloud.u[:, list(space.springs)]))
    for other in (STIFFNESS, *space.belief.paths):
        if other in log and other != path:
            name = "ends" if other in SPRINGS else CAUSES.get(other, other)
            found[name] = found.get(name, 0.0) + _told(log[path], _powers(log[other]))
    found["peaks"] = within * (1 - model)
    if model > 0:
        found["model"] = within * model
    whole = float(np.var(log[path])) + within
    return {cause: half * float(np.sqrt(min(one / whole, 1.0))) for cause, one in found.items()}


def _logarithms(ridge: Ridge, cloud: Cloud) -> dict[str, Real]:
    """Return ln of numbers, or the numbers of places and angles, at the best tension, (n,) each."""
    space = ridge.space
    v = cloud.u @ space.matrix.T + cloud.log_tension[:, None] * space.of_tension + space.constant
    return dict(zip(space.paths, v.T))


def _within(ridge: Ridge, cloud: Cloud, path: str) -> float:
    """Return the variance of ln p that is left where the variables are known."""
    space, nu = ridge.space, ridge.freedom
    share = float(space.of_tension[space.paths.index(path)])
    if space.about_tension is not None:
        return float(np.var(share * cloud.scale * cloud.u[:, -1]))
    return variance_of(share * cloud.scale, nu)


def _powers(x: Real) -> Real:
    """Return features of one variable, shape (n, 2)."""
    off = x - x.mean()
    return np.column_stack([off, off**2])


def _of_ends(log_c: Real) -> Real:
    """Return features of springs, functions of their fixities c/(1 + c), shape (n, m)."""
    fixity = 1 / (1 + np.exp(-log_c))
    total = fixity.sum(axis=1)
    features = [total, total**2, total**3]
    if fixity.shape[1] == 2:
        features += [fixity[:, 0] * fixity[:, 1], fixity[:, 0] - fixity[:, 1]]
    return np.column_stack(features)


def _told(number: Real, features: Real) -> float:
    """Return the variance of a number that features explain, by linear regression."""
    n, m = features.shape
    design = np.column_stack([np.ones(n), features])
    coefficient, *_ = np.linalg.lstsq(design, number, rcond=1e-10)
    left, whole = float(np.var(number - design @ coefficient)), float(np.var(number))
    # so many features explain something of any number
    return max(whole - left * (n - 1) / max(n - 1 - m, 1), 0.0)
