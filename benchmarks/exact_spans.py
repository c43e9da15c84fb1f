"""Clamped ropes of uniform spans in 100 digits: transfer matrices over (z, z', z'', z''')."""

import mpmath as mp

import ropedyn as rd

DIGITS = 100


@mp.workdps(DIGITS)
def receptance(scene: rd.Scene, x: float, frequency: float) -> complex:
    """Return z at x per force there [m/N]."""
    omega = 2 * mp.pi * mp.mpf(frequency)
    section = 1 + 1j * omega * mp.mpf(scene.damping.gamma)
    # a column more for the force, which makes b z''' jump by one
    at, state = _carried(scene, omega, section, x)
    amplitude = mp.lu_solve(state[:2, :2], -state[:2, 2])
    return complex(at[0] * amplitude[0] + at[1] * amplitude[1])


@mp.workdps(DIGITS)
def frequency_near(scene: rd.Scene, frequency: float) -> float:
    """Return the undamped natural frequency [Hz] next to a good one."""

    def mismatch(f: mp.mpf) -> mp.mpf:
        _, state = _carried(scene, 2 * mp.pi * f, mp.mpf(1), scene.rope.length)
        return state[0, 0] * state[1, 1] - state[0, 1] * state[1, 0]

    near = mp.mpf(frequency)
    size = mismatch(near * (1 + mp.mpf("1e-6")))
    return float(
        mp.findroot(
            lambda f: mismatch(f) / size,
            (near, near * (1 + mp.mpf("1e-9"))),
            solver="secant",
            tol=mp.mpf("1e-60"),
        )
    )


def _carried(
    scene: rd.Scene, omega: mp.mpf, section: mp.mpc, x: float
) -> tuple[mp.matrix, mp.matrix]:
    """Return z at x of the two motions the left clamp allows, and the state at the right clamp.

    Columns of the state are these motions and that of a unit force at x.
    """
    bending = mp.mpf(scene.rope.bending_stiffness) * section
    state = mp.zeros(4, 3)
    state[2, 0] = state[3, 1] = 1
    here, at = mp.mpf(0), None
    for place in sorted({x, scene.rope.length, *(part.x for part in scene.parts)}):
        state = _transfer(scene, omega, bending, mp.mpf(place) - here) * state
        here = mp.mpf(place)
        if place == x:
            at = state[0, :].copy()
            state[3, 2] += 1 / bending
        for part in scene.parts:
            if part.x == place:
                state[3, :] += _force(part, omega, section) / bending * state[0, :]
    return at, state


def _force(part: rd.PointMass | rd.Spring, omega: mp.mpf, section: mp.mpc) -> mp.mpc:
    """Return the force of a part on the rope per displacement [N/m]."""
    if isinstance(part, rd.PointMass):
        return omega**2 * mp.mpf(part.mass)
    return -mp.mpf(part.stiffness) * section


def _transfer(scene: rd.Scene, omega: mp.mpf, bending: mp.mpc, length: mp.mpf) -> mp.matrix:
    """Return exp(A length), A z = (z', z'', z''', (T z'' + mu omega^2 z)/b), a cubic in A.

    The cubic is the exponential at the eigenvalues a, -a, i k, -i k of A.
    """
    p = mp.mpf(scene.rope.linear_density) * omega**2 / bending
    t = mp.mpf(scene.tension) / bending
    root = mp.sqrt(t * t / 4 + p)
    a, k = mp.sqrt(t / 2 + root), mp.sqrt(root - t / 2)
    A = mp.matrix([[0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [p, 0, t, 0]])
    ch, c = mp.cosh(a * length), mp.cos(k * length)
    sh, s = mp.sinh(a * length) / a, mp.sin(k * length) / k
    square = A * A
    even = (a * a * c + k * k * ch) * mp.eye(4) + (ch - c) * square
    odd = (a * a * s + k * k * sh) * A + (sh - s) * square * A
    return (even + odd) / (a * a + k * k)
