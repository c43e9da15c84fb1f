"""Space frames of straight beam elements along an axis: textbook matrices, dense, in fixed axes."""

import numpy as np
import scipy.linalg

from ropedyn.scene.end import end_of


def element(length, rope):
    """Stiffness and mass (12, 12) in the element's axes: u, theta of its left end, of its right."""
    B, C, EA = rope.bending_stiffness, rope.torsional_stiffness, rope.axial_stiffness
    mu, j, p = rope.linear_density, rope.rotary_inertia or 0.0, rope.polar_inertia or 0.0
    K, M = np.zeros((2, 12, 12))
    for one, stiff, heavy in ((0, EA, mu), (3, C, p)):
        at = np.ix_([one, one + 6], [one, one + 6])
        K[at] = stiff / length * np.array([[1, -1], [-1, 1]])
        M[at] = heavy * length / 6 * np.array([[2, 1], [1, 2]])
    own = np.diag([1, length, 1, length])
    bent = own @ [[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]] @ own
    moved = own @ [[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]] @ own
    turned = own @ [[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]] @ own
    # v' = theta_z, w' = -theta_y
    for at, sign in (([1, 5, 7, 11], 1), ([2, 4, 8, 10], -1)):
        S = np.diag([1, sign, 1, sign])
        here = np.ix_(at, at)
        K[here] = S @ bent @ S * B / length**3
        M[here] = S @ (mu * length / 420 * moved + j / (30 * length) * turned) @ S
    return K, M


def frame_of(chord):
    """Rows: axes of an element along a chord, the others anywhere."""
    x = chord / np.linalg.norm(chord)
    y = np.cross(x, np.eye(3)[np.abs(x).argmin()])
    y /= np.linalg.norm(y)
    return np.stack([x, y, np.cross(x, y)])


def eigenvalues(scene, each):
    """Those of a frame with so many elements in each piece; the rope is round, nothing loads it."""
    axis, rope = scene.rope.axis, scene.rope
    joints = axis.joints
    inside = joints[:-1, None] + np.diff(joints)[:, None] * np.arange(each) / each
    place = axis.position(np.append(inside.ravel(), axis.length))
    K, M = np.zeros((2, 6 * len(place), 6 * len(place)))
    for k, chord in enumerate(np.diff(place, axis=0)):
        turn = np.kron(np.eye(4), frame_of(chord))
        here = slice(6 * k, 6 * k + 12)
        for whole, own in zip((K, M), element(np.linalg.norm(chord), rope)):
            whole[here, here] += turn.T @ own @ turn
    moves = np.ones(len(K), dtype=bool)
    for end, first, s in zip(scene.ends, (0, len(K) - 6), (0.0, axis.length)):
        turn = np.kron(np.eye(2), axis.frame(s))
        here = slice(first, first + 6)
        for whole in (K, M):
            whole[:, here] = whole[:, here] @ turn
            whole[here] = turn.T @ whole[here]
        moves[here] = [not end_of(end).holds(c) for c in ("x", "y", "z", "alpha", "beta", "gamma")]
    free = np.ix_(moves, moves)
    return scipy.linalg.eigh(K[free], M[free], eigvals_only=True)
