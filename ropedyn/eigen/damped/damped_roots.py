"""The rates s of damped motion e^(s t) of one chain: in closed form or by search."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ... import _core
from ...base.array import Complex, Index, Real
from ...base.errors import SolveError
from ...chain.chain import Chain
from ..spectrum import ComponentModes, lowest
from .proportional import Proportional, proportional
from .rates import Rates, elastic, horizon

MARGIN = 0.98  # Motion is told apart up to this part of the horizon.
DEPTHS = 2.0 ** (-np.arange(4) / 2)
"""How far circles reach to the left of the imaginary axis, over what they take in on it. With less
they are so much wider than where roots lie that these are not found."""
NO_MIRROR, CONJUGATE, OPPOSITE = range(3)  # Where roots have another one, in the core's order.


class Undamped:
    """The lowest modes of a chain without its damping, kept for who asks for fewer."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain  # as it is damped
        self.asked = 0
        self.found: ComponentModes | None = None

    def lowest(self, number: int) -> ComponentModes:
        """Return so many at least, as far as there are."""
        if self.found is None or self.asked < number:
            self.asked = number
            self.found = lowest(self.chain.undamped, number, math.inf, shaped=False)
        return self.found

    def below(self, limit: float) -> ComponentModes:
        """Return all eigenvalues below a limit [rad^2/s^2]."""
        known = self.found
        if known is None or not (known.eigenvalue[-1:] > limit).any():
            return lowest(self.chain.undamped, None, limit, shaped=False)
        inside = known.eigenvalue < limit
        return replace(known, eigenvalue=known.eigenvalue[inside], error=known.error[inside])


@dataclass(frozen=True, eq=False)
class Damped:
    """Rates of one chain, in the order of their modulus."""

    rates: Rates  # factors of the chain's parts
    value: Complex  # (k,) one of each conjugate pair, that above the real axis [rad/s]
    error: Real  # (k,) estimated absolute error [rad/s]
    certified: bool  # whether none is missing below the radius that was asked for
    # none of a modulus below this is missing [rad/s]; infinite where there are no more
    radius: float
    sweeps: int  # what it took
    nearby: Complex  # what was found besides: the others of the pairs [rad/s]
    circle: tuple[float, float]  # its real middle and radius: nothing is missing inside [rad/s]
    closed: Proportional | None = None  # how the damping is proportional
    # (k,) the undamped mode that each is of, where it is proportional
    mode: Index | None = None


def untold(radius: float) -> SolveError:
    """Return what says that rounding decides which modes there are within some radius."""
    return SolveError(
        f"damped modes below {radius / (2 * math.pi):.6g} Hz cannot be told from rounding: motion "
        "decays there within a small part of a period, as before a dashpot that matches the rope's "
        "impedance; ask for fewer modes or a lower frequency"
    )


def damped_roots(
    undamped: Undamped, rates: Rates, radius: float, *, told: float | None = None
) -> Damped:
    """Find all rates of a chain of a modulus below some radius.

    With `told`, beyond that [rad/s], or less, only what decays slower, if else rounding decides.
    """
    chain = undamped.chain
    edge = MARGIN * horizon(chain, rates)
    closed = proportional(chain, rates)
    if closed is not None and (radius < edge or chain.finite is not None):
        return _closed(undamped, rates, closed, radius, edge)
    if not radius < edge:
        raise SolveError(
            f"damped modes can be told apart below {edge / (2 * math.pi):.6g} Hz: at the decay "
            f"rate {edge / MARGIN:.6g} 1/s, where damping cancels stiffness, infinitely many "
            "overdamped modes accumulate; ask for fewer modes or a lower frequency"
        )
    return _searched(undamped, rates, radius, edge, told)


def _closed(
    undamped: Undamped, rates: Rates, closed: Proportional, radius: float, edge: float
) -> Damped:
    """Two rates of each undamped mode; beyond the edge the highest modes may have the lowest."""
    chain = undamped.chain
    if radius < edge:
        # solved by itself, so that they are the modes without damping to the last bit
        inside = undamped.below(closed.highest(radius))
        found = lowest(chain.undamped, len(inside.eigenvalue), math.inf, shaped=False)
    else:
        assert chain.finite is not None
        found = undamped.lowest(chain.finite)
    eigenvalue = np.where(np.abs(found.eigenvalue) <= found.error, 0.0, found.eigenvalue)
    whole = 2 * len(eigenvalue) == most_roots(chain.undamped, Rates.of(()))
    s = closed.rates(eigenvalue)
    uncertain = np.broadcast_to(found.error[:, None], s.shape)
    # at critical damping both rates are one, sqrt(stiff dlambda) wide
    most = np.sqrt(abs(closed.stiff) * uncertain)
    moved = closed.sensitivity(s, eigenvalue[:, None])
    error = np.minimum(np.multiply(moved, uncertain, out=most.copy(), where=most > 0), most)
    error += 2 * np.finfo(float).eps * np.abs(s)
    # of a pair the one above the axis, of rigid motion, 0 twice, one
    kept = (s.imag >= 0) & (np.abs(s) < radius)
    kept[:, 1] &= (s != 0).any(axis=1)
    mode, _ = np.nonzero(kept)
    value, error = s[kept], error[kept]
    order = np.argsort(np.abs(value), kind="stable")
    return Damped(
        rates,
        value[order],
        error[order],
        found.certified,
        math.inf if whole and (np.abs(s) < radius).all() else radius,
        found.work.sweeps,
        np.zeros(0, dtype=np.complex128),
        (0.0, radius),
        closed,
        mode[order],
    )


def _searched(
    undamped: Undamped, rates: Rates, radius: float, edge: float, told: float | None = None
) -> Damped:
    """Search the plane; see csrc/damped/search.h."""
    chain = undamped.chain
    known = undamped.below((1.1 * radius) ** 2)
    omega = np.sqrt(np.abs(known.eigenvalue))
    guess = np.stack([1j * omega, -1j * omega], axis=1).ravel()
    sweeps, certified = known.work.sweeps, False
    depths = [radius] if told is None else [d for d in (radius * DEPTHS).tolist() if d <= told]
    # circles through +-i radius and -least; the first is the one about 0
    for least in depths:
        middle = (radius**2 - least**2) / (2 * least)
        if not 2 * middle + least < edge:
            break
        value, error, count, wide, mirror, certified, steps = _core.damped(
            chain, rates.constant, rates.linear, middle, middle + least, edge, edge / MARGIN, guess
        )
        sweeps += steps
        if certified or mirror != CONJUGATE:
            break
    if not certified:
        raise untold(radius)
    still = int((np.abs(known.eigenvalue) <= known.error).sum())
    value, error, nearby = _sorted(value, error, mirror, still)
    told = middle == 0
    all_of_it = told and count == most_roots(chain, rates)
    least = math.inf if all_of_it else wide - middle
    return Damped(rates, value, error, told, least, sweeps, nearby, (middle, wide))


def _sorted(value: Complex, error: Real, mirror: int, still: int) -> tuple[Complex, Real, Complex]:
    """Return rates in order with their errors, and what lies beside; `still` meet no resistance."""
    # what rounding cannot tell from an axis is on it
    value = np.where(np.abs(value.real) <= error, 1j * value.imag, value)
    value = np.where(np.abs(value.imag) <= error, value.real + 0j, value)
    kept = value.imag >= 0 if mirror == CONJUGATE else (value.imag > 0) | (value == 0)
    above = value[value.imag > 0]
    images = {NO_MIRROR: above[:0], CONJUGATE: above.conj(), OPPOSITE: -above}
    nearby = np.concatenate([images[mirror], value[~kept]])
    # a motion that nothing resists has the rate 0 twice where nothing damps it either
    kept[np.flatnonzero(value == 0)[still:]] = False
    index = np.flatnonzero(kept)
    order = index[np.argsort(np.abs(value[index]), kind="stable")]
    return value[order], error[order], nearby


def most_roots(chain: Chain, rates: Rates) -> int | None:
    """Return how many rates a chain has in all; None where elements do not say."""
    # the determinant of s^2 M + s C + K has the power 2 rank M + rank of C where M is nothing;
    # masses and dashpots stand at nodes, on masses of resonators and between those and their nodes
    if chain.finite is None or rates.linear[elastic(chain)].any():
        return None
    count = 0
    each = np.bincount(chain.term_of, minlength=len(chain.mass))
    dashpots = _dashpots(chain)
    for term in np.flatnonzero(each):
        free = chain.held[term] == 0
        mass = chain.mass[term][free][:, free]
        size, axis = mass.diagonal(), np.eye(len(mass))
        if np.count_nonzero(mass) > np.count_nonzero(size):
            size, axis = np.linalg.eigh(mass)
        massless = axis[:, size == 0]
        count += 2 * int((size != 0).sum()) * int(each[term])
        rest = massless.T @ dashpots[term][free][:, free] @ massless
        count += int(np.linalg.matrix_rank(rest)) * int(each[term]) if rest.any() else 0
    return count + 2 * int((chain.feet >= 0).sum())


def _dashpots(chain: Chain) -> Real:
    """Return those of node terms with those of resonators, shape (terms, width, width)."""
    total = np.zeros_like(chain.mass) if chain.damping is None else chain.damping.copy()
    if chain.attached_row is not None:
        assert chain.attached_term is not None
        assert chain.attached_value is not None
        foot = chain.attached_row[:, 0]
        each = chain.attached_value[:, -1, None, None] * foot[:, :, None] * foot[:, None, :]
        np.add.at(total, chain.attached_term, each)
    return total
