"""A clamped tensed beam of Hermite elements: consistent mass, geometric stiffness, damping.

Parts stand at nodes.
"""

import numpy as np
from scipy.sparse import coo_array, csc_array

import ropedyn as rd


def matrices(scene: rd.Scene, elements: int) -> tuple[csc_array, csc_array, csc_array]:
    """Return stiffness, damping and mass over (z, beta) of the inner nodes.

    The scene has bending and tension, perhaps `StiffnessDamping`, point masses, springs and
    dashpots; other damping is left out.
    """
    length = scene.rope.length / elements
    elastic = _assembled(scene.rope.bending_stiffness / length**3 * _bending(length), elements)
    string = _assembled(scene.tension / (30 * length) * _tension(length), elements)
    mass = _assembled(scene.rope.linear_density * length / 420 * _mass(length), elements)
    damping = getattr(scene.damping, "gamma", 0.0) * elastic
    for part in scene.parts:
        at = unknown(part.x, length)
        if isinstance(part, rd.PointMass):
            mass[at, at] += part.mass
        elif isinstance(part, rd.Dashpot):
            damping[at, at] += part.damping
        else:
            elastic[at, at] += part.stiffness
    return elastic + string, damping, mass


def unknown(x: float, length: float) -> int:
    """Return which unknown is z of the node at x [m], for elements of a length [m]."""
    return 2 * (round(x / length) - 1)


def _assembled(element: np.ndarray, elements: int) -> csc_array:
    own = 2 * np.arange(elements)[:, None] + np.arange(4)
    row, column = np.repeat(own, 4, axis=1).ravel(), np.tile(own, 4).ravel()
    size = 2 * elements + 2
    whole = coo_array((np.tile(element.ravel(), elements), (row, column)), shape=(size, size))
    return whole.tocsc()[2:-2, 2:-2]


def _bending(l: float) -> np.ndarray:  # noqa: E741
    left, right = [[12, 6 * l], [6 * l, 4 * l * l]], [[-12, 6 * l], [-6 * l, 2 * l * l]]
    return _whole(left, right)


def _tension(l: float) -> np.ndarray:  # noqa: E741
    left, right = [[36, 3 * l], [3 * l, 4 * l * l]], [[-36, 3 * l], [-3 * l, -l * l]]
    return _whole(left, right)


def _mass(l: float) -> np.ndarray:  # noqa: E741
    left, right = [[156, 22 * l], [22 * l, 4 * l * l]], [[54, -13 * l], [13 * l, -3 * l * l]]
    return _whole(left, right)


def _whole(left: list, across: list) -> np.ndarray:
    """Return the element from its left node's block and the coupling: symmetric, reversible."""
    turn = np.diag([1.0, -1.0])
    right = turn @ left @ turn
    return np.block([[np.array(left), np.array(across)], [np.array(across).T, right]])
