"""Ropes on an axis in numbers of 64 binary digits, eleven more than those of the core.

The same equations by other arithmetic, of pieces along which nothing changes: parts short
enough for their series, joined while that costs nothing, and one band by Gauss with exchanges.
"""

import numpy as np

from ropedyn.space.rope import MATRICES, SIX, Factors, SpaceRope

DIGITS = np.finfo(np.longdouble).nmant
"""Of a wide number; 52 where there are none, on machines of other kinds."""
SHORT, LONG, TERMS = 0.5, 2.0, 28  # of sums of entries, twice what a wave turns by


def rates_of(rope: SpaceRope, k: int, factors: Factors, z):
    """Phi, S and q of component k, scaled, shape (n, pieces, 3, w, w)."""
    own = {name: getattr(rope.blocks, name)[k].astype(np.clongdouble) for name in MATRICES}
    section, tension, _, inertia, drag = (
        np.asarray(one, dtype=np.clongdouble)[:, None, None, None] for one in factors[:5]
    )
    S = own["soft"][:, 0] / section + own["string"][:, 0] / tension
    initial = tension * own["initial"][:, 0]
    q = tension * own["stress"][:, 0] - initial.swapaxes(2, 3) @ S @ initial
    q = q + inertia * own["inertia"] + drag * own["drag"]
    up, across = z[:, None, :, None], z[:, None, None, :]
    phi = (own["bend"][:, 0] + S @ initial) * (across / up)
    return np.stack([phi, S / (up * across), q * (up * across)], axis=2)


def divided(A, X):
    """A^-1 X of many small matrices, by Gauss and Jordan with exchanges."""
    A, X, size = A.copy(), X.copy(), A.shape[1]
    lines = np.arange(len(A))
    for k in range(size):
        at = k + np.abs(A[:, k:, k]).argmax(axis=1)
        for M in (A, X):
            M[lines, k], M[lines, at] = M[lines, at], M[lines, k].copy()
        by = 1 / A[:, k, k][:, None]
        A[:, k], X[:, k] = A[:, k] * by, X[:, k] * by
        for i in range(size):
            if i != k:
                by = A[:, i, k][:, None].copy()
                A[:, i], X[:, i] = A[:, i] - by * A[:, k], X[:, i] - by * X[:, k]
    return X


def first(rates, length):
    """F, G and Q of a short part."""
    phi, S, q = (rates[:, i] * length for i in range(3))
    w = phi.shape[1]
    E = np.concatenate(
        [np.concatenate([phi, S], 2), np.concatenate([q, -phi.swapaxes(1, 2)], 2)], 1
    )
    term = np.broadcast_to(np.eye(2 * w, dtype=np.clongdouble), E.shape).copy()
    total = term.copy()
    for m in range(1, TERMS):
        term = E @ term / m
        total = total + term
    back = divided(total[:, w:, w:], np.broadcast_to(np.eye(w, dtype=np.clongdouble), phi.shape))
    return back.swapaxes(1, 2), total[:, :w, w:] @ back, back @ total[:, w:, :w]


def twice(F, G, Q):
    """Of two equal parts."""
    w = F.shape[1]
    X = divided(np.eye(w, dtype=np.clongdouble) + G @ Q, np.concatenate([G, F], axis=2))
    XG, XF = X[:, :, :w], X[:, :, w:]
    Ft = F.swapaxes(1, 2)
    return F @ XF, G + F @ XG @ Ft, Q + Ft @ Q @ XF


def assembled(rope: SpaceRope, k: int, factors: Factors, z):
    """F, G, Q of all parts, N of nodes, and which node is at which part."""
    z = z.astype(np.longdouble)
    rates = rates_of(rope, k, factors, z)
    parts, node = [], [0]
    for p, length in enumerate(rope.length):
        radians = float(np.abs(rates[:, p]).sum(3).max() * length) * 2
        long = max(0, int(np.ceil(np.log2(radians / LONG))))
        short = max(long, int(np.ceil(np.log2(radians / SHORT))))
        part = first(rates[:, p], np.longdouble(length) / 2**short)
        for _ in range(short - long):
            part = twice(*part)
        turn = rope.blocks.turn[k, p] * (z[:, None, :] / z[:, :, None])
        F, G, Q = part
        parts += [(F @ turn, G, turn.swapaxes(1, 2) @ Q @ turn)] + [part] * (2**long - 1)
        node.append(len(parts))
    F, G, Q = (np.stack(one, axis=1) for one in zip(*parts))
    _, _, springs, inertia, drag = (
        np.asarray(one, dtype=np.clongdouble)[:, None, None, None] for one in factors[:5]
    )
    own = rope.blocks
    N = np.zeros((len(z), len(parts) + 1, *F.shape[2:]), dtype=np.clongdouble)
    N[:, node] = springs * own.springs[k] + inertia * own.masses[k] + drag * own.dashpots[k]
    held = np.tile(own.absent[k], (len(parts) + 1, 1))
    held[node] |= own.held[k]
    return F, G, Q, N * (z[:, None, :, None] * z[:, None, None, :]), held, np.array(node)


def solved(F, G, Q, N, held, absent, right, slip=None):
    """Motion and force of right sides of nodes (n, parts + 1, w, columns), and of parts."""
    n, parts, w = F.shape[:3]
    size, beside = (2 * parts + 1) * w, 2 * w - 1
    A = np.zeros((n, size + 3 * beside, 3 * beside + 1), dtype=np.clongdouble)
    x = np.zeros((n, size + beside, right.shape[3]), dtype=np.clongdouble)
    fixed = np.zeros((2 * parts + 1, w), dtype=bool)
    fixed[::2], fixed[1::2] = held, absent
    fixed = fixed.ravel()

    def put(row, column, block):
        for i in range(w):
            for j in range(w):
                if not (fixed[row + i] or fixed[column + j]):
                    A[:, row + i, column + j - row - i + beside] += block[:, i, j]

    unit = np.broadcast_to(np.eye(w, dtype=np.clongdouble), (n, w, w))
    for p in range(parts + 1):
        u, f = 2 * p * w, (2 * p + 1) * w
        put(u, u, N[:, p])
        x[:, u : u + w] = np.where(held[p][:, None], 0, right[:, p])
        if p < parts:
            if slip is not None:
                x[:, f : f + w] = np.where(absent[:, None], 0, slip[:, p])
            put(u, u, Q[:, p])
            put(f, u, -F[:, p])
            put(u, f, -F[:, p].swapaxes(1, 2))
            put(f, f, -G[:, p])
            put(f, f + w, unit)
            put(f + w, f, unit)
    A[:, :size, beside] += fixed
    lines = np.arange(n)
    for k in range(size):
        rows = np.arange(k, min(k + beside + 1, size))
        column = np.abs(A[:, rows, k - rows + beside])
        at = rows[column.argmax(axis=1)]
        wide = np.arange(2 * beside + 1)
        own = A[:, k, beside + wide].copy()
        other = A[lines[:, None], at[:, None], (k - at)[:, None] + beside + wide]
        A[lines[:, None], at[:, None], (k - at)[:, None] + beside + wide] = own
        A[:, k, beside + wide] = other
        x[lines, at], x[:, k] = x[:, k].copy(), x[lines, at]
        below = rows[1:]
        columns = (k - below)[:, None] + beside + wide
        by = (A[:, below, k - below + beside] / other[:, :1])[:, :, None]
        A[:, below[:, None], columns] -= by * other[:, None]
        x[:, below] -= by * x[:, k][:, None]
    for k in range(size - 1, -1, -1):
        wide = np.arange(1, min(2 * beside, size - 1 - k) + 1)
        x[:, k] -= (A[:, k, beside + wide][:, :, None] * x[:, k + wide]).sum(axis=1)
        x[:, k] /= A[:, k, beside][:, None]
    both = x[:, :size].reshape(n, 2 * parts + 1, w, -1)
    return both[:, ::2], both[:, 1::2]


def wide_factors(factors: Factors, frequency) -> Factors:
    """The same, where nothing damps the inertia of frequencies that are meant to the last digit."""
    omega = 2 * np.longdouble("3.14159265358979323846") * frequency.astype(np.longdouble)
    plain = factors.inertia.imag == 0
    return factors._replace(inertia=np.where(plain, -(omega**2), factors.inertia))


def receptance(request):
    """Of a request of `ropedyn.space.response`, shape (drives, responses, f), in wide numbers."""
    shape = len(request.node[0]), len(request.node[1]), len(request.frequency)
    value = np.zeros(shape, dtype=np.clongdouble)
    factors = wide_factors(request.factors, request.frequency)
    for one in request.components:
        k = int(one.which[0])
        z = request.rope.scale(one.which, np.abs(request.factors.inertia))
        F, G, Q, N, held, node = assembled(request.rope, k, factors, z)
        drives, responses = (node[at] for at in one.node)
        driven, seen = ([one.own.index(c) for c, _ in points] for points in one.point)
        right = np.zeros((len(z), F.shape[1] + 1, F.shape[2], len(drives)), dtype=np.clongdouble)
        right[:, drives, driven, np.arange(len(drives))] = z[:, driven]
        u, _ = solved(F, G, Q, N, held, request.rope.blocks.absent[k], right)
        value[one.pairs] = (u[:, responses, seen] * z[:, seen, None]).transpose(2, 1, 0)
    return value


def deflection(rope: SpaceRope, loads):
    """Displacement and force at the nodes (nodes, 6) under loads there, in wide numbers."""
    displacement, force = np.zeros((2, len(rope.x), 6), dtype=np.longdouble)
    for k, own in enumerate(rope.own):
        factors = Factors(*np.ones((3, 1)), *np.zeros((3, 1)))
        z = rope.scale(np.array([k]), np.zeros(1))
        F, G, Q, N, held, node = assembled(rope, k, factors, z)
        p = np.zeros((1, F.shape[1] + 1, F.shape[2], 1), dtype=np.clongdouble)
        for (coordinate, at), amount in loads.items():
            along = np.flatnonzero(own == SIX.index(coordinate))
            p[0, node[np.abs(rope.x - at).argmin()], along, 0] += amount * z[0, along]
        u, f = solved(F, G, Q, N, held, rope.blocks.absent[k], p)
        sums = np.zeros(u.shape, dtype=np.clongdouble)
        sums[:, 1:] += f
        sums[:, :-1] += Q @ u[:, :-1] - F.swapaxes(2, 3) @ f
        sums = np.where(held[None, :, :, None], sums, p - N @ u)
        displacement[:, own] = (u[0, node, :, 0] * z[0]).real
        force[:, own] = (sums[0, node, :, 0] / z[0]).real
    return displacement, force


def applied(F, G, Q, N, held, u, f):
    """What a matrix makes of motion and force, as `solved` orders them."""
    p = N @ u
    p[:, :-1] += Q @ u[:, :-1] - F.swapaxes(2, 3) @ f
    p[:, 1:] += f
    p[:, held] = 0
    return p, u[:, 1:] - F @ u[:, :-1] - G @ f


BESIDE, STEP = 1e-9, 1e-200


def eigenvalues(rope: SpaceRope, k: int, near):
    """Those of component k, each alone, that lie next to some numbers (n,)."""
    at = near.astype(np.longdouble) * (1 + BESIDE)
    which = np.full(len(near), k)
    factors = Factors(*np.ones((3, len(at))), -(at + 1j * STEP), *np.zeros((2, len(at))))
    z = rope.scale(which, near)
    F, G, Q, N, held, _ = assembled(rope, k, factors, z)
    absent = rope.blocks.absent[k]
    real = [m.real.astype(np.clongdouble) for m in (F, G, Q, N)]
    imag = [m.imag.astype(np.clongdouble) / -STEP for m in (F, G, Q, N)]
    right, slip = np.random.default_rng(0).standard_normal((*N.shape[:3], 1)), None
    for _ in range(2):
        u, f = solved(*real, held, absent, right, slip)
        size = np.abs(u).max(axis=(1, 2, 3), keepdims=True)
        u, f = u / size, f / size
        right, slip = derivative(*imag, held, u, f)
    top = both(u, f, *applied(*real, held, u, f))
    return at + (top / both(u, f, right, slip)).real


def derivative(F, G, Q, N, held, u, f):
    """As `applied`, of what only F, G, Q and N are the derivatives of."""
    p = N @ u
    p[:, :-1] += Q @ u[:, :-1] - F.swapaxes(2, 3) @ f
    p[:, held] = 0
    return p, -(F @ u[:, :-1]) - G @ f


def both(u, f, p, d):
    """u . p + f . d of each line."""
    return (u * p).sum(axis=(1, 2, 3)) + (f * d).sum(axis=(1, 2, 3))
