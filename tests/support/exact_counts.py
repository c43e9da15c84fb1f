"""Eigenvalues of a compiled chain by counting in many digits, with nothing of the core.

The triple of each distinct element follows the formulas of csrc/element/triple.h in mpmath;
K - lambda M is eliminated node by node and the negative pivots are counted (Sylvester). The numbers
of the compiled chain are taken as exact.
"""

from decimal import Context, Decimal, localcontext

import mpmath
import numpy as np
from mpmath import mpf

from ropedyn.chain.wide import wide_of

DIGITS = 60
DIFFERENCE, RIGID, TENSED = range(3)
X, Z, ALPHA, BETA = range(4)
AXIAL, TORSION, BENDING = range(3)
CHANNEL = {X: AXIAL, Z: BENDING, ALPHA: TORSION, BETA: BENDING}


# elements ---------------------------------------------------------------------------------------


def shape_functions(kind, theta):
    """Return tau, P0, P1, P2 of csrc/element/triple.h for theta = T S_bb l^2."""
    if kind == DIFFERENCE:
        return mpf(0), mpf(1), mpf(1) / 2, mpf(1) / 3
    if theta == 0:
        return mpf(1), mpf(1), mpf(1) / 2, mpf(1) / 3
    if kind == RIGID:
        p = 1 + theta / 3
        return 1 / p, (1 + theta / 12) / p, 1 / (2 * p), 1 / (3 * p)
    t = mpmath.sqrt(theta)
    tau = mpmath.re(mpmath.tanh(t) / t)
    return tau, tau, mpmath.re((1 - 1 / mpmath.cosh(t)) / theta), (1 - tau) / theta


def triple(chain, e):
    """Return F, G, Q of distinct element `e` as mpmath matrices (width, width)."""
    w = len(chain.coordinate)
    length, tension = _exact(chain.length[e]), _exact(chain.tension[e])
    S = [[_exact(s) for s in row] for row in chain.flexibility[e]]
    coordinate = [int(c) for c in chain.coordinate]
    F, G, Q = mpmath.eye(w), mpmath.zeros(w), mpmath.zeros(w)
    if BETA not in coordinate:
        for i, a in enumerate(coordinate):
            for j, b in enumerate(coordinate):
                if Z not in (a, b):
                    G[i, j] = length * S[CHANNEL[a]][CHANNEL[b]]
                elif a == b:
                    G[i, j] = length / tension
        return F, G, Q
    bb = S[BENDING][BENDING]
    theta = mpf(0) if chain.kind == DIFFERENCE else tension * bb * length**2
    tau, *P = shape_functions(chain.kind, theta)
    # how much of the curvature goes into each coordinate
    r = [S[CHANNEL[c]][BENDING] / bb if CHANNEL[c] != BENDING else mpf(1) for c in coordinate]
    for i, a in enumerate(coordinate):
        for j, b in enumerate(coordinate):
            power = (a == Z) + (b == Z)
            G[i, j] = r[i] * r[j] * bb * length ** (1 + power) * P[power]
            c, d = CHANNEL[a], CHANNEL[b]
            if BENDING not in (c, d):
                G[i, j] += length * (S[c][d] - S[c][BENDING] * S[d][BENDING] / bb)
    for i, a in enumerate(coordinate):
        F[i, w - 1] = length * tau if a == Z else (a == BETA) - r[i] * theta * P[1]
    Q[w - 1, w - 1] = tension * length * tau
    return F, G, Q


def element_matrix(chain, e):
    """Return K_e = [[Q + F^T G^-1 F, -F^T G^-1], [-G^-1 F, G^-1]] as rows (2 width, 2 width)."""
    w = len(chain.coordinate)
    F, G, Q = triple(chain, e)
    inverse = G**-1
    between = -inverse * F
    here = Q - F.T * between
    upper = [[here[i, j] for j in range(w)] + [between[j, i] for j in range(w)] for i in range(w)]
    lower = [
        [between[i, j] for j in range(w)] + [inverse[i, j] for j in range(w)] for i in range(w)
    ]
    return upper + lower


# the chain --------------------------------------------------------------------------------------


class ExactChain:
    """Counts of a compiled chain.

    Parameters
    ----------
    chain : Chain
        Of any of its coordinates.
    digits : int
        Of the arithmetic.

    Notes
    -----
    A count is the number of modes below lambda where lambda is above all eigenvalues of negative
    mass, which an indefinite mass matrix has far below zero.
    """

    def __init__(self, chain, digits=DIGITS):
        self.digits = digits
        self.width = len(chain.coordinate)
        with mpmath.workdps(digits + 10):
            elements = [
                _decimals(element_matrix(chain, e), digits) for e in range(len(chain.length))
            ]
        self.element_of = [elements[e] for e in chain.element_of.tolist()]
        hinges = np.zeros(chain.held.shape) if chain.hinge is None else chain.hinge
        terms = [
            (
                _decimals(mass),
                _decimals(stiffness),
                [k for k, h in enumerate(held) if not h],
                {k: Decimal(1) / _decimal(c) for k, c in enumerate(hinge) if c > 0},
            )
            for mass, stiffness, held, hinge in zip(chain.mass, chain.stiffness, chain.held, hinges)
        ]
        self.term_of = [terms[t] for t in chain.term_of.tolist()]

    def count(self, eigenvalue):
        """Return the number of negative eigenvalues of K - lambda M.

        Raises
        ------
        ZeroDivisionError
            If a leading part is singular at exactly this lambda.
        """
        with self._arithmetic():
            return self._count(Decimal(eigenvalue))

    def holds(self, index, low, high):
        """Whether eigenvalue number `index`, from 0, is in [low, high)."""
        with self._arithmetic():
            return self._count(Decimal(low)) <= index < self._count(Decimal(high))

    def error(self, index, value):
        """Return how far eigenvalue number `index`, from 0, is from `value`, to one per cent.

        At least 2^-60 of the value, or 1e-30 [rad^2/s^2], is returned.

        Raises
        ------
        ValueError
            If there is no such eigenvalue within 1e30.
        """
        with self._arithmetic():
            value = Decimal(float(value))
            least = abs(value) * Decimal(2) ** -60 + Decimal("1e-30")
            far = least
            while not self._count(value - far) <= index < self._count(value + far):
                far *= 16
                if far > Decimal("1e30"):
                    raise ValueError(f"there is no eigenvalue number {index} near {value}")
            if far == least:
                return float(far)
            above = self._count(value) <= index
            near = far / 16
            while far - near > far / 100:
                middle = (near + far) / 2
                count = self._count(value + middle if above else value - middle)
                if (count > index) == above:
                    far = middle
                else:
                    near = middle
            return float(far)

    def eigenvalue(self, index, low, high, digits=25):
        """Return eigenvalue number `index` between two bounds, by bisection, as an mpf."""
        with self._arithmetic():
            low, high = Decimal(low), Decimal(high)
            if not self._count(low) <= index < self._count(high):
                raise ValueError(f"eigenvalue number {index} is not between {low} and {high}")
            while high - low > abs(high + low) * Decimal(10) ** -digits:
                middle = (low + high) / 2
                if self._count(middle) <= index:
                    low = middle
                else:
                    high = middle
            return mpf(str((low + high) / 2))

    def _arithmetic(self):
        return localcontext(Context(prec=self.digits, Emin=-(10**9), Emax=10**9))

    def _count(self, eigenvalue):
        w, count, last = self.width, 0, len(self.term_of) - 1
        left = [[Decimal(0)] * w for _ in range(w)]
        for n, (mass, stiffness, free, hinges) in enumerate(self.term_of):
            A = [[Decimal(0)] * w for _ in range(w)]
            if n < last:
                A = [row[:] for row in self.element_of[n]]
                for k, spring in hinges.items():
                    count += _hinge(A, k, spring)
            for i in range(w):
                for j in range(w):
                    A[i][j] += left[i][j] + stiffness[i][j] - eigenvalue * mass[i][j]
            count += _eliminate(A, free, range(w, len(A)))
            left = [row[w:] for row in A[w:]]
        return count


def _hinge(A, k, spring):
    """Put a spring between coordinate k of the node and of the element on its right, in place.

    The element's own coordinate, which has no mass, is eliminated; whether its pivot is negative is
    returned.
    """
    pivot = A[k][k] + spring
    source = list(A[k])
    others = [j for j in range(len(A)) if j != k]
    for i in others:
        for j in others:
            A[i][j] -= source[i] * source[j] / pivot
        A[i][k] = A[k][i] = spring * source[i] / pivot
    A[k][k] = spring * source[k] / pivot
    return pivot < 0


def _eliminate(A, unknowns, others):
    """Reduce A to `others` in place and return how many of the pivots are negative."""
    count, rest = 0, list(unknowns)
    while rest:
        p = max(rest, key=lambda i: abs(A[i][i]))
        rest.remove(p)
        pivot = A[p][p]
        if pivot == 0:
            raise ZeroDivisionError("a leading part is exactly singular")
        count += pivot < 0
        kept = [*rest, *others]
        for i in kept:
            if A[i][p] != 0:
                share = A[i][p] / pivot
                row, source = A[i], A[p]
                for j in kept:
                    row[j] -= share * source[j]
    return count


def _parts(x):
    """A number as doubles that add up to it: one of a double, two of a wider one."""
    return [float(x), float(x - type(x)(float(x)))] if np.isfinite(x) else [float(x)]


def _exact(x):
    return mpmath.fsum(map(mpf, _parts(x)))


def _decimal(x):
    return sum(map(Decimal, _parts(x)))


def _decimals(matrix, digits=None):
    """Return rows as Decimal: floats exactly, mpf to so many digits."""
    if digits is None:
        return [[_decimal(x) for x in row] for row in matrix]
    return [[Decimal(mpmath.nstr(x, digits + 5)) for x in row] for row in matrix]


# modes ------------------------------------------------------------------------------------------


def exact_chain(model, digits=DIGITS):
    """The chain of a model in the wider numbers that its scene says, as far as there are any."""
    wide = wide_of(model)
    return ExactChain(model.chain if wide is None else wide.chain, digits)


def eigenvalue_bound(modes):
    """Return `rounding_error` as an error of the eigenvalues [rad^2/s^2], shape (k,).

    |lambda| = (2 pi f)^2 with f the frequency, or growth/2 pi: (2 pi)^2 (2 f e + e^2).
    """
    f = np.sqrt(np.abs(modes.eigenvalue)) / (2 * np.pi)
    e = modes.rounding_error
    return (2 * np.pi) ** 2 * (2 * f + e) * e


def certified_modes(model, number, relative=2e-12):
    """Return modes by sweep: certified, near the exact ones as they say, and near enough.

    `rounding_error` must bound the error by counts in 80 digits. It must itself be below `relative`
    of the eigenvalue, which is twice that of a frequency, and half an eps of the largest one asked
    for: nearly free motion next to stiff waves.
    """
    modes = model.modes(number, solver="sweep")
    assert modes.certified
    assert is_bounded(exact_chain(model, 80), modes).all()
    size = np.abs(modes.eigenvalue)
    assert (eigenvalue_bound(modes) <= relative * size + 2.0**-53 * size.max()).all()
    return modes


def is_bounded(exact, modes):
    """Whether each eigenvalue is as near to the exact one as `rounding_error` says, shape (k,).

    A rigid-body motion, whose error is 0, must be within 1e-25 [rad^2/s^2] of zero.
    """
    bound = eigenvalue_bound(modes)
    return np.array(
        [
            exact.holds(k, Decimal(v) - Decimal(b) - least, Decimal(v) + Decimal(b) + least)
            for k, (v, b) in enumerate(zip(modes.eigenvalue.tolist(), bound.tolist()))
            for least in [Decimal("1e-25")]
        ]
    )
