"""Eigenvalues of one tensed span below a frequency, with 70 digits by Wittrick and Williams.

Those of the span with its ends held, from the one root of its equation between each two multiples
of pi, and the negative pivots of its dynamic stiffness with the springs. It shares no formula with
the phases of csrc/closed.
"""

from mpmath import atan, cos, exp, floor, inf, matrix, mp, mpf, pi, sin, sqrt, tanh

DIGITS = 70


def exact_span_count(omega, span):
    """Count below omega [rad/s]; the span is length, density, tension, bending and four springs."""
    with mp.workdps(DIGITS):
        L, mu, T, B, *springs = (mpf(float(x)) for x in span)
        h, inertia = T / (2 * B), mu * mpf(omega) ** 2 / B
        larger = abs(h) + sqrt(h * h + inertia)
        k2, a2 = (inertia / larger, larger) if h >= 0 else (larger, inertia / larger)
        k, a = sqrt(k2), sqrt(a2)
        stiffness = _dynamic_stiffness(L, T, B, k, a)
        free = [i for i in range(4) if springs[i] != inf]
        rest = matrix(len(free), len(free))
        for p, i in enumerate(free):
            for q, j in enumerate(free):
                rest[p, q] = (stiffness[i, j] + stiffness[j, i]) / 2 + (springs[i] if i == j else 0)
        return _held(k * L, a * L) + _negative_pivots(rest)


def _held(K, A):
    j = int(floor(K / pi))
    if j == 0:
        return 0
    t = tanh(A / 2)
    return j - 1 + int(K / 2 - j * pi / 2 - atan(K / A * (1 / t if j % 2 else t)) > 0)


def _dynamic_stiffness(L, T, B, k, a):
    """Return forces (F_z, M_beta) at both ends per motion of both, from four waves."""
    K, e = k * L, exp(-a * L)
    c, s = cos(K), sin(K)
    # w', w'' and w''' of cos kx, sin kx, e^-ax and e^-a(L - x) at both ends
    first = [[0, k, -a, a * e], [-k * s, k * c, -a * e, a]]
    value = [[1, 0, 1, e], [c, s, e, 1]]
    sign = [-k * k, -k * k, a * a, a * a]
    moved, force = [], []
    for end, way in ((0, -1), (1, 1)):
        moved += [value[end], first[end]]
        force.append([way * (T - B * q) * w for q, w in zip(sign, first[end])])
        force.append([way * B * q * w for q, w in zip(sign, value[end])])
    return matrix(force) * matrix(moved) ** -1


def _negative_pivots(M):
    count = 0
    for p in range(M.rows):
        count += M[p, p] < 0
        for r in range(p + 1, M.rows):
            f = M[r, p] / M[p, p]
            for q in range(p, M.rows):
                M[r, q] -= f * M[p, q]
    return count
