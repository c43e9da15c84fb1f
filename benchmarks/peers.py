"""How SciPy answers the questions of accuracy.py, from so many finite elements.

Ropes that bend are cubic elements (finite_elements.py), strings lumped masses.
"""

import numpy as np
from finite_elements import matrices, unknown
from frf import Assembled
from scipy import sparse
from scipy.integrate import solve_ivp
from scipy.linalg import eigh_tridiagonal, eigvals_banded
from scipy.optimize import curve_fit
from scipy.sparse.linalg import eigs, eigsh, spsolve

import ropedyn as rd

MODES = 8
"""In which a pulsating rope is solved over time."""


# --- ropes that bend --------------------------------------------------------------------------


def modes_by_eigsh(scene: rd.Scene, elements: int, number: int) -> np.ndarray:
    K, _, M = matrices(scene, elements)
    value = eigsh(K, number, M, sigma=0.0, return_eigenvectors=False)
    return np.sqrt(np.sort(value)) / (2 * np.pi)


def sagging_modes_by_eigsh(scene: rd.Scene, elements: int, number: int) -> np.ndarray:
    """The force that sag adds, alike along the rope, is one unknown more; it has no mass."""
    K, _, M = matrices(scene, elements)
    length = scene.rope.length
    curvature = scene.rope.linear_density * scene.gravity.g / scene.tension
    softness = length * (1 + (curvature * length) ** 2 / 8) / scene.rope.axial_stiffness
    area = np.zeros((K.shape[0], 1))
    area[::2] = curvature * length / elements
    border = sparse.csc_array([[-softness]])
    K = sparse.block_array([[K, area], [area.T, border]], format="csc")
    M = sparse.block_diag([M, 0 * border], format="csc")
    value = eigsh(K, number, M, sigma=0.0, return_eigenvectors=False)
    return np.sqrt(np.sort(value)) / (2 * np.pi)


def lines_by_solve_banded(
    scene: rd.Scene, elements: int, x: float, lines: np.ndarray
) -> np.ndarray:
    at = unknown(x, scene.rope.length / elements)
    return Assembled(*matrices(scene, elements), at).solve_banded(lines)


def deflection_by_spsolve(scene: rd.Scene, elements: int, x: float, force: float) -> np.ndarray:
    K, _, _ = matrices(scene, elements)
    at = unknown(x, scene.rope.length / elements)
    load = np.zeros(K.shape[0])
    load[at] = force
    return spsolve(K, load)[[at]]


def count_by_eigvals_banded(scene: rd.Scene, elements: int, below: float) -> np.ndarray:
    """Count the negative eigenvalues of the dynamic stiffness."""
    K, _, M = matrices(scene, elements)
    rest = (K - (2 * np.pi * below) ** 2 * M).tocoo()
    band = np.zeros((4, rest.shape[0]))
    lower = rest.row >= rest.col
    band[(rest.row - rest.col)[lower], rest.col[lower]] = rest.data[lower]
    least = -4 * np.abs(band).max() * len(band)
    negative = eigvals_banded(band, lower=True, select="v", select_range=(least, 0.0))
    return np.array([negative.size])


def rates_by_eigs(scene: rd.Scene, elements: int, number: int) -> np.ndarray:
    """The lowest rates over 2 pi, of the companion pencil in units of the first frequency."""
    K, C, M = matrices(scene, elements)
    unit = 2 * np.pi * modes_by_eigsh(scene, elements, 1)[0]
    one, none = sparse.eye_array(K.shape[0]), sparse.csc_array(K.shape)
    A = sparse.block_array([[none, one], [-K, -unit * C]], format="csc")
    B = sparse.block_array([[one, none], [none, unit**2 * M]], format="csc")
    rate = unit * eigs(A, 2 * number + 2, B, sigma=0.0, return_eigenvectors=False)
    rate = rate[rate.imag >= 0]
    return rate[np.argsort(np.abs(rate))][:number] / (2 * np.pi)


def multipliers_by_solve_ivp(scene: rd.Scene, elements: int) -> np.ndarray:
    """The monodromy matrix of the lowest modes, whose rows are solved over one period."""
    T = scene.tension
    still = scene.replace(tension=T.mean)
    K, C, M = matrices(still, elements)
    pull = matrices(scene.replace(tension=T.mean + T.amplitude), elements)[0] - K
    value, shape = eigsh(K, MODES, M, sigma=0.0)
    shape = shape[:, np.argsort(value)]
    k, c, p = (shape.T @ (part @ shape) for part in (K, C, pull))

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        u, v = y.reshape(2, MODES, -1)
        swing = np.sin(2 * np.pi * T.frequency * t + T.phase)
        return np.concatenate([v, -(k + swing * p) @ u - c @ v]).ravel()

    start = np.eye(2 * MODES).ravel()
    found = solve_ivp(rate, (0, 1 / T.frequency), start, "DOP853", rtol=1e-8, atol=1e-8)
    return np.linalg.eigvals(found.y[:, -1].reshape(2 * MODES, 2 * MODES))


def ropes_by_eigsh(scene: rd.Scene, elements: int, rows: np.ndarray, number: int) -> np.ndarray:
    one_by_one = []
    for tension, bending in rows:
        own = scene.rope.replace(bending_stiffness=bending)
        one_by_one.append(
            modes_by_eigsh(scene.replace(tension=tension, rope=own), elements, number)
        )
    return np.array(one_by_one)


# --- strings ----------------------------------------------------------------------------------


def _string_over_time(
    scene: rd.Scene, elements: int, time: np.ndarray, force: rd.Sine, x: float
) -> np.ndarray:
    """Motion where the force acts, where a stop may stand as well."""
    h, c = scene.rope.length / elements, scene.damping.mass
    stiff = scene.tension / (h * h * scene.rope.linear_density)
    mass, at = scene.rope.linear_density * h, round(x / h) - 1
    stops = [(part.stiffness, part.gap) for part in scene.parts]

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        u, v = y.reshape(2, -1)
        push = -2 * stiff * u - c * v
        push[1:] += stiff * u[:-1]
        push[:-1] += stiff * u[1:]
        push[at] += force.amplitude * np.sin(2 * np.pi * force.frequency * t) / mass
        for stiffness, gap in stops:
            push[at] -= stiffness * max(u[at] - gap, 0.0) / mass
        return np.concatenate([v, push])

    still = np.zeros(2 * elements - 2)
    span = (0.0, time[-1])
    return solve_ivp(rate, span, still, "DOP853", time, rtol=1e-7, atol=1e-10).y[at]


def motion_by_solve_ivp(
    scene: rd.Scene, elements: int, time: np.ndarray, force: rd.Sine, x: float
) -> np.ndarray:
    return _string_over_time(scene, elements, time, force, x)[None]


def steady_by_solve_ivp(scene: rd.Scene, elements: int, frequency: float, x: float) -> np.ndarray:
    """The first harmonic of the last of sixty periods."""
    time = (59 + np.arange(64) / 64) / frequency
    motion = _string_over_time(scene, elements, time, rd.Sine(1.0, frequency), x)
    turned = np.exp(-1j * (2 * np.pi * frequency * time - np.pi / 2))
    return np.array([[2 * np.mean(motion * turned)]])


def tension_by_curve_fit(scene: rd.Scene, elements: int, peaks: rd.Peaks) -> np.ndarray:
    h = scene.rope.length / elements
    per = 1 / (scene.rope.linear_density * h * h)
    off, on = np.full(elements - 2, -per), np.full(elements - 1, 2 * per)
    count = len(peaks.frequency)

    def frequencies(_: np.ndarray, tension: float) -> np.ndarray:
        value = eigh_tridiagonal(
            tension * on, tension * off, True, select="i", select_range=(0, count - 1)
        )
        return np.sqrt(value) / (2 * np.pi)

    x = np.arange(count)
    return curve_fit(frequencies, x, peaks.frequency, [scene.tension], sigma=peaks.std)[0]
