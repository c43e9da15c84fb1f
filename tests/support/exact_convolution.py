"""Motion of one mode under forces in closed form, with as many digits as it takes."""

import mpmath as mp

DIGITS = 120
SHIFT = mp.mpf(10) ** -25
"""Of poles that meet: the motion changes by as much, and 3 * 25 digits are lost."""
NODES = 40


def rates(sigma, square):
    """Of a mode, apart by a little where they meet."""
    sigma, square = mp.mpf(sigma), mp.mpf(square)
    split = mp.sqrt(sigma**2 - square)
    return [-sigma + split + SHIFT, -sigma - split + 2 * SHIFT]


def free(sigma, square, q, v, t):
    """State at a time after a state."""
    with mp.workdps(DIGITS):
        one, other = rates(sigma, square)
        first, second = (v - other * q) / (one - other), (one * q - v) / (one - other)
        parts = first * mp.exp(one * t), second * mp.exp(other * t)
        return mp.re(parts[0] + parts[1]), mp.re(one * parts[0] + other * parts[1])


def forced(sigma, square, w, cosine, sine, t):
    """State after cosine cos(w t) + sine sin(w t) has acted from rest, by residues."""
    with mp.workdps(DIGITS):
        w, t = mp.mpf(w), mp.mpf(t)
        poles = [*rates(sigma, square), mp.j * w + 3 * SHIFT, -mp.j * w + 4 * SHIFT]
        q = v = 0
        for i, pole in enumerate(poles):
            others = mp.fprod(pole - other for j, other in enumerate(poles) if j != i)
            term = (cosine * pole + sine * w) / others * mp.exp(pole * t)
            q, v = q + term, v + pole * term
        return mp.re(q), mp.re(v)


def by_gauss(sigma, square, force, t, panels):
    """State after a smooth force has acted from rest, by a rule of Gauss over each panel."""
    with mp.workdps(50):
        one, other = rates(sigma, square)
        q = v = mp.mpf(0)
        for k in range(panels):
            for x, weight in gauss():
                s = t * (k + (x + 1) / 2) / panels
                f = force(s) * weight * t / panels / 2 / (one - other)
                a, b = mp.exp(one * (t - s)), mp.exp(other * (t - s))
                q, v = q + f * (a - b), v + f * (one * a - other * b)
        return mp.re(q), mp.re(v)


_GAUSS = []


def gauss():
    """Nodes and weights of Gauss' rule on -1 ... 1."""
    if not _GAUSS:
        with mp.workdps(50):
            for k in range(NODES):
                x = mp.cos(mp.pi * (k + mp.mpf(3) / 4) / (NODES + mp.mpf(1) / 2))
                for _ in range(8):
                    value, slope = _legendre(x)
                    x -= value / slope
                value, slope = _legendre(x)
                _GAUSS.append((x, 2 / ((1 - x * x) * slope**2)))
    return _GAUSS


def _legendre(x):
    before, value = mp.mpf(1), x
    for k in range(2, NODES + 1):
        before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
    return value, NODES * (x * value - before) / (x * x - 1)
