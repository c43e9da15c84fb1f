"""Ropes that hang, in fixed axes: their catenary, and small motion about it by collocation."""

import math

import catenary_elements
import numpy as np
import scipy.optimize
import scipy.sparse
import scipy.sparse.linalg

SHARE = {"start": 0.0, "middle": 0.5, "end": 1.0}
INSIDE, ACROSS = (0, 2, 4, 6, 8, 10), (1, 3, 5, 7, 9, 11)
"""Of u, theta, F and M along X, Y, Z: what moves in the plane of the curve, and out of it."""


def curve(scene):
    """Level tension and arc lengths of both ends from the lowest point."""
    rope, gravity = scene.rope, scene.gravity
    w, psi = rope.linear_density * gravity.g, gravity.inclination
    tension = getattr(scene.tension, "mean", scene.tension)
    share = SHARE[getattr(scene.tension, "at", "middle")]
    span, rise = rope.length * math.cos(psi), rope.length * math.sin(psi)

    def ends(unknown):
        c, middle = math.exp(unknown[0]), unknown[1]
        return c, *(c * math.sinh(middle + side * span / (2 * c)) for side in (-1, 1))

    def missed(unknown):
        c, first, last = ends(unknown)
        up = math.hypot(c, last) - math.hypot(c, first)
        along = w * (c * math.cos(psi) + (first + share * (last - first)) * math.sin(psi))
        return [(up - rise) / rope.length, along / tension - 1]

    taut = (tension - w * rise * (share - 0.5)) / w * math.cos(psi)
    found = scipy.optimize.fsolve(missed, [math.log(taut), math.tan(psi)], xtol=1e-12)
    assert np.abs(missed(found)).max() < 1e-10
    c, first, last = ends(found)
    return w * c, first, last


def string(scene, *, number, solve=catenary_elements.elements, count=6):
    """Frequencies of a string [Hz], by elements on its curve."""
    level, first, last = curve(scene)
    rope = scene.rope
    w = rope.linear_density * scene.gravity.g

    def rest(s):
        slope = np.arctan(w * s / level)
        return np.hypot(level, w * s), slope, rope.linear_density, rope.axial_stiffness

    # equal steps of the slope's angle, and so of the curvature
    steps = (
        level / w * np.sinh(np.linspace(*np.arcsinh(np.array([first, last]) * w / level), count))
    )
    return solve(steps, rest, number=number)


def cross(v):
    """Matrices of cross products, shape (s, 3, 3)."""
    x, y, z = np.moveaxis(v, -1, 0)
    o = 0 * x
    return np.stack([o, -z, y, z, o, -x, -y, x, o], axis=-1).reshape(*x.shape, 3, 3)


def rates(scene, level, s):
    """d(u, theta, F, M)/ds at rest in fixed axes, of a rod whose rest has no moment, (s, 12, 12).

    u' = theta x t + t (t.F)/EA, theta' = S M, F' = -lambda mu u, M' = T t x u' - t x F.
    """
    rope = scene.rope
    slope = np.arctan(rope.linear_density * scene.gravity.g * s / level)
    cos, sin, o = np.cos(slope), np.sin(slope), 0 * s
    t = np.stack([cos, o, sin], axis=-1)
    frame = np.stack([t, np.stack([o, 1 + o, o], -1), np.stack([-sin, o, cos], -1)], axis=-1)
    bend = np.broadcast_to(rope.bending_stiffness, 2)
    soft = np.diag([1 / (rope.torsional_stiffness or bend[0]), *(1 / bend)])
    E = np.zeros((len(s), 12, 12))
    E[:, :3, 3:6] = -cross(t)
    E[:, :3, 6:9] = t[:, :, None] * t[:, None, :] / rope.axial_stiffness
    E[:, 3:6, 9:] = frame @ soft @ frame.swapaxes(1, 2)
    T = np.hypot(level, rope.linear_density * scene.gravity.g * s)[:, None, None]
    E[:, 9:, 3:6] = -T * cross(t) @ cross(t)
    E[:, 9:, 6:9] = -cross(t)
    return E


def rod(scene, own, *, number, ends=("clamped", "clamped"), degree=12, panels=20):
    """Frequencies of a rope that bends [Hz], in its plane or out of it, by collocation."""
    level, first, last = curve(scene)
    layer = np.array([0.003, 0.01, 0.025])
    share = np.unique(np.concatenate([[0], layer, np.linspace(0.05, 0.95, panels), 1 - layer, [1]]))
    edge = first + (last - first) * share
    at, _ = np.polynomial.legendre.leggauss(degree)
    node = -np.cos(np.pi * np.arange(degree + 1) / degree)
    bary = (-1.0) ** np.arange(degree + 1)
    bary[[0, -1]] /= 2
    apart = bary / (at[:, None] - node)
    value = apart / apart.sum(1, keepdims=True)
    between = node[:, None] - node + np.eye(degree + 1)
    D = bary / bary[:, None] / between
    np.fill_diagonal(D, 0.0)
    np.fill_diagonal(D, -D.sum(1))
    slope = value @ D
    own, w = np.array(own), len(own)
    size = w * (degree * (len(edge) - 1) + 1)
    L, R = scipy.sparse.lil_array((size, size)), scipy.sparse.lil_array((size, size))
    inertia = np.zeros((12, 12))
    inertia[6:9, :3] = scene.rope.linear_density * np.eye(3)
    for k in range(len(edge) - 1):
        half = (edge[k + 1] - edge[k]) / 2
        E = rates(scene, level, edge[k] + half * (1 + at))[:, own[:, None], own]
        rows = slice(3 + w * degree * k, 3 + w * degree * (k + 1))
        columns = slice(w * degree * k, w * (degree * (k + 1) + 1))
        block = np.einsum("ij,ab->iajb", slope / half, np.eye(w))
        block -= np.einsum("ij,iab->iajb", value, E)
        L[rows, columns] = block.reshape(w * degree, -1)
        mass = np.einsum("ij,ab->iajb", value, inertia[own[:, None], own])
        R[rows, columns] = -mass.reshape(w * degree, -1)
    for row, base, end in ((0, 0, ends[0]), (size - 3, size - w, ends[1])):
        for k in range(3):
            turns = own[k] >= 3 and end == "pinned" and own[k] != 3
            L[row + k, base + k + (3 if turns else 0)] = 1.0
    # unknowns of such different sizes: columns, then rows, of size 1
    lu = scipy.sparse.linalg.splu(L.tocsc())
    R = R.tocsr()
    inverse = scipy.sparse.linalg.LinearOperator(
        (size, size), lambda x: lu.solve(R @ x), dtype=float
    )
    found = scipy.sparse.linalg.eigs(inverse, number + 2, v0=np.ones(size))[0]
    found = np.sort(1 / found.real)[:number]
    return np.sqrt(found) / (2 * math.pi)
