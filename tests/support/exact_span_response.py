"""Responses of one tensed span that bends, by eight waves and 60 digits."""

import mpmath as mp
import numpy as np

DIGITS = 60


def exact_span_response(number, factor, drag, x0, x1):
    """Return z at x1 per force in z at x0; numbers as `enum rd_bent`, factors as the core's."""
    with mp.workdps(DIGITS):
        L, mu, T, B, *springs = (mp.mpf(float(x)) for x in number)
        section, tension, spring, inertia, dashpot = (mp.mpc(complex(c)) for c in factor)
        x0, x1 = mp.mpf(float(x0)), mp.mpf(float(x1))
        B, T = B * section, T * tension
        moved = -(inertia * mu + dashpot * mp.mpf(float(drag)))
        half, root = T / (2 * B), mp.sqrt((T / (2 * B)) ** 2 + moved / B)
        a, k = mp.sqrt(root + half), mp.sqrt(root - half)
        exponent = (1j * k, -1j * k, -a, a)

        def waves(x, n, side):
            """Return the nth derivatives of the waves on one side of x0, each at most 1."""
            low, high = ((mp.mpf(0), x0), (x0, L))[side]
            return [e**n * mp.exp(e * (x - (high if e == a else low))) for e in exponent]

        def held(x, side, way, springs):
            z, beta = springs
            w, d, c, t = (waves(x, n, side) for n in range(4))
            force = [T * q - B * s for q, s in zip(d, t)]
            across = [spring * z * p - way * q for p, q in zip(w, force)]
            turned = [spring * beta * q - way * B * r for q, r in zip(d, c)]
            return [w if z == np.inf else across, d if beta == np.inf else turned]

        rows = [[*row, 0, 0, 0, 0] for row in held(mp.mpf(0), 0, 1, springs[:2])]
        rows += [[0, 0, 0, 0, *row] for row in held(L, 1, -1, springs[2:])]
        for n in range(4):
            rows.append([*(-w for w in waves(x0, n, 0)), *waves(x0, n, 1)])
        right = [mp.mpf(0)] * 7 + [1 / B]
        size = [max(map(abs, row)) for row in rows]
        scaled = mp.matrix([[entry / s for entry in row] for row, s in zip(rows, size)])
        found = mp.lu_solve(scaled, mp.matrix([r / s for r, s in zip(right, size)]))
        side = int(x1 >= x0)
        return mp.fsum(found[4 * side + j] * w for j, w in enumerate(waves(x1, 0, side)))
