"""Natural frequencies of a rope of continuous spans: zeros of its determinant, in many digits.

The determinant of exact_span.py is entire in lambda = omega^2 and, with nothing damped, real
on the real axis; its zeros are the eigenvalues, as often as they are repeated.
"""

import dataclasses
from math import log10

import mpmath
from exact_chain import DIGITS
from exact_span import Continuum, coupled
from mpmath import mpf
from stored import stored

KNOWN = mpf(10) ** -30
"""Relative: what an eigenvalue is known to."""


def continuum(scene, coordinate="z"):
    """The coordinates that move together with this one."""
    return Continuum(scene, coupled(scene, coordinate))


def eigenvalue(exact, near, within=1e-6):
    """Return the simple eigenvalue next to a good one [rad^2/s^2], to 30 digits.

    Raises
    ------
    ValueError
        If the secant method leads further away than `within`, relatively, or the determinant does
        not change its sign within 1e-30 of where it leads.
    """
    with mpmath.workdps(DIGITS):
        value = _zero(exact, rounded(near, within))
        if abs(value / mpf(near) - 1) > within:
            raise ValueError(f"the eigenvalue next to {float(near)!r} is at {float(value)!r}")
        return value


def rounded(near, within):
    """Return a double to a tenth of what it is right to: the same on any machine."""
    return near if isinstance(near, mpf) else mpf(mpmath.nstr(mpf(near), 1 + round(-log10(within))))


@stored
def _zero(exact, near):
    value = _secant(exact.determinant, near, near * (1 + mpf(10) ** -12))
    low, high = (exact.determinant(value * (1 + side * KNOWN)) for side in (-1, 1))
    if not low * high < 0:
        raise ValueError(f"there is no simple eigenvalue within 1e-30 of {float(value)!r}")
    return value


def _secant(function, a, b, steps=40):
    fa, fb = function(a), function(b)
    for _ in range(steps):
        if fb in (0, fa) or abs(b / a - 1) < KNOWN**1.2:
            return b
        a, b = b, b - fb * (b - a) / (fb - fa)
        fa, fb = fb, function(b)
    raise ValueError(f"the secant method does not end, at {complex(b)!r}")


def frequency(exact, near, within=1e-6):
    """Return the natural frequency next to a good one [Hz], as `eigenvalue` does."""
    with mpmath.workdps(DIGITS):
        square = (2 * mpmath.pi * rounded(near, within)) ** 2
        return mpmath.sqrt(eigenvalue(exact, square, within)) / (2 * mpmath.pi)


def pole(exact, port, near, within=1e-9):
    """Return the pole of a point's own receptance next to a good one [rad/s], to 30 digits.

    Raises
    ------
    ValueError, ZeroDivisionError
        If the secant method of the receptance's inverse does not end.
    """
    with mpmath.workdps(DIGITS):
        digit = mpf(10) ** round(log10(within * abs(near)))
        return _pole(
            exact, port, mpmath.mpc(*(mpmath.nint(x / digit) * digit for x in parts(near)))
        )


def parts(number):
    """Real and imaginary part."""
    return mpmath.re(number), mpmath.im(number)


@stored
def _pole(exact, port, near):
    with mpmath.workdps(DIGITS):
        return _secant(
            lambda omega: 1 / exact.receptance(omega, port, [port])[0],
            near,
            near * (1 + mpf(10) ** -12),
        )


@stored
def sensitivity(exact, value):
    """Return |lambda| + the sum of |d lambda/d ln p| over p = section, tension, springs.

    How far a relative change of 1 in each part of the dynamic stiffness moves an eigenvalue, to
    first order: D_p/D_lambda by differences of 1e-20.
    """
    step = mpf(10) ** -20
    with mpmath.workdps(DIGITS):
        here = exact.determinant(value)
        slope = (exact.determinant(value * (1 + step)) - here) / value
        total = abs(value)
        for part in range(3):
            nudge = tuple(1 + step * (k == part) for k in range(5))
            near = dataclasses.replace(exact, nudge=nudge).determinant(value)
            total += abs((near - here) / slope)
        return total


def cluster(exact, near, within=1e-3, points=32):
    """Return all eigenvalues within a relative distance of a number, repeated ones repeatedly.

    With p_k = 1/(2 pi i) of the integral of (s - c)^k D'/D over the circle about c, integrated by
    parts: p_k = -k/(2 pi i) times that of (s - c)^(k-1) log D. The trapezoidal rule is wrong by
    the distance of zeros over the radius to the power of `points`. Newton's identities turn the
    sums of powers into the polynomial that has the eigenvalues as zeros.
    """
    with mpmath.workdps(DIGITS):
        return _cluster(exact, rounded(near, within / 10), within, points)


@stored
def _cluster(exact, near, within, points):
    with mpmath.workdps(DIGITS):
        radius = abs(near) * within
        angle = [2 * mpmath.pi * j / points for j in range(points)]
        value = [exact.determinant(near + radius * mpmath.expj(a)) for a in angle]
        turns, logarithm = _continued(value)
        # log D less the winding: periodic
        smooth = [v - 1j * turns * a for v, a in zip(logarithm, angle)]
        sums = [mpf(turns)]
        for k in range(1, turns + 1):
            # i turns a contributes nothing to the sum for zeros at the centre
            mean = sum(v * mpmath.expj(k * a) for v, a in zip(smooth, angle)) / points
            sums.append(-k * mean)
        zeros = _zeros_of(sums)
        return sorted(near + radius * mpmath.re(z) for z in zeros)


def _continued(values):
    """Return how often values along a closed curve turn about zero, and their logarithm."""
    logarithm = [mpmath.log(values[0])]
    for a, b in zip(values, [*values[1:], values[0]]):
        step = mpmath.log(b / a)
        if abs(step.imag) > 2:
            raise ValueError("more points are needed to follow the determinant")
        logarithm.append(logarithm[-1] + step)
    turns = (logarithm.pop() - logarithm[0]).imag / (2 * mpmath.pi)
    return round(turns), logarithm


def _zeros_of(sums):
    """Return the zeros whose powers have these sums, k = 0, 1, ..."""
    count = int(sums[0])
    elementary = [mpf(1)]
    for k in range(1, count + 1):
        total = sum((-1) ** (j - 1) * elementary[k - j] * sums[j] for j in range(1, k + 1))
        elementary.append(total / k)
    # companion matrix of s^n - e_1 s^(n-1) + e_2 s^(n-2) ...
    companion = mpmath.matrix(count, count)
    for k in range(count):
        companion[0, k] = (-1) ** k * elementary[k + 1]
        if k:
            companion[k, k - 1] = mpf(1)
    return mpmath.eig(companion, left=False, right=False) if count else []


def count(exact, low, high, arcs=16):
    """Return the number of eigenvalues between two numbers, by the argument principle.

    Both must keep away from eigenvalues by some share of the largest: -high is a good `low`.

    Along the upper half of the circle over them the determinant turns by pi for each zero. It is
    followed with a few digits, arc by arc, each halved until neither half turns it by a radian.
    """
    return _count(exact, rounded(low, 1e-3), rounded(high, 1e-3), arcs)


@stored
def _count(exact, low, high, arcs):
    with mpmath.workdps(15):
        centre, radius = (low + high) / 2, (high - low) / 2

        def value(at):
            return exact.determinant(centre + radius * mpmath.expjpi(at))

        def turned(a, b, start, end):
            middle = (a + b) / 2
            between = value(middle)
            halves = mpmath.arg(between / start), mpmath.arg(end / between)
            if max(map(abs, halves)) < 1:
                return sum(halves)
            return turned(a, middle, start, between) + turned(middle, b, between, end)

        at = [mpf(j) / arcs for j in range(arcs + 1)]
        ends = [value(a) for a in at]
        steps = zip(at, at[1:], ends, ends[1:])
        return round(sum(turned(*step) for step in steps) / mpmath.pi)
