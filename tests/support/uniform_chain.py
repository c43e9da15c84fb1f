"""Chains of uniform spans, as rows of numbers and as the general path takes them."""

import numpy as np

from ropedyn.chain.chain import CONTINUOUS, Chain

Z, BETA = 1, 3


def chain_of(row, hinge):
    """The chain of a row of "bent" numbers, of continuous elements."""
    spans = len(hinge) - 1
    span, station = row[: 4 * spans].reshape(spans, 4), row[4 * spans :].reshape(-1, 4)
    flexibility, inertia = np.zeros((spans, 3, 3)), np.zeros((spans, 2))
    flexibility[:, 2, 2], inertia[:, 0] = 1 / span[:, 3], span[:, 1]
    held = np.isinf(station[:, 2:])
    mass, stiffness = np.zeros((2, spans + 1, 2, 2))
    for k in range(2):
        mass[:, k, k] = station[:, k]
        stiffness[:, k, k] = np.where(held[:, k], 0.0, station[:, 2 + k])
    compliance = np.zeros((spans + 1, 2))
    compliance[:, 1] = np.where(hinge, np.inf, 0.0)
    node = np.arange(spans + 1, dtype=np.int32)
    return Chain(
        kind=CONTINUOUS,
        coordinate=np.array([Z, BETA], np.int32),
        length=span[:, 0].copy(),
        tension=span[:, 2].copy(),
        flexibility=flexibility,
        first=node,
        element=node[:-1].copy(),
        mass=mass,
        stiffness=stiffness,
        held=held.astype(np.uint8),
        term=node,
        hinge=compliance if hinge.any() else None,
        inertia=inertia,
    )


def row_of(model):
    """The "bent" numbers of a compiled scene of continuous spans in {z, beta}, and its hinges."""
    chain = model.chain.only(("z", "beta"))
    element, term = chain.element_of, chain.term_of
    span = np.column_stack(
        [
            chain.length[element],
            chain.inertia[element, 0],
            chain.tension[element],
            1 / chain.flexibility[element, 2, 2],
        ]
    )
    held = chain.held[term].astype(bool)
    diagonal = np.einsum("nii->ni", chain.stiffness[term])
    spring = np.where(held, np.inf, diagonal)
    station = np.column_stack([np.einsum("nii->ni", chain.mass[term]), spring])
    hinge = np.zeros(len(term)) if chain.hinge is None else chain.hinge[term, 1]
    return np.concatenate([span.ravel(), station.ravel()]), np.isinf(hinge).astype(np.uint8)


def random_chain(random, spans):
    """Unlike spans up to 1e4 apart, under tension and beyond buckling, springs of both signs.

    Returns
    -------
    (numbers,), (spans + 1,), float
        The row, its hinges, and an angular frequency of waves of its length [rad/s].
    """

    def scale(decades):
        return 10.0 ** random.uniform(-decades, decades)

    contrast = random.choice([0.0, 0.5, 1.0, 2.0])
    L, mu, B = scale(1), scale(1), scale(1)
    T = scale(2) * B / L**2 * random.choice([1.0, 1e2, 1e4, 1e6], p=[0.5, 0.3, 0.1, 0.1])
    pressed = random.random() < 0.35
    span, station = np.zeros((spans, 4)), np.zeros((spans + 1, 4))
    for e in range(spans):
        tension = 0.0 if random.random() < 0.1 else T * scale(contrast)
        if pressed and random.random() < 0.6:
            tension = -random.uniform(0, 60) * B / L**2
        span[e] = (
            L / spans * scale(0.7 * min(contrast, 1.0)),
            mu * scale(contrast),
            tension,
            B * scale(contrast),
        )
    for s in range(spans + 1):
        if random.random() < 0.4:
            station[s, 0] = 0.3 * mu * L * scale(1 + contrast)
        if random.random() < 0.2:
            station[s, 1] = 1e-3 * mu * L**3 * scale(1 + contrast)
        for j, unit in ((2, 100 * B / L**3), (3, 3 * B / L)):
            inside, kind = 0 < s < spans, random.random()
            held, free = (0.06, 0.7) if inside else (0.5, 0.65)
            sign = 1 if kind < 0.9 else -1
            station[s, j] = (
                np.inf if kind < held else 0.0 if kind < free else sign * unit * scale(2)
            )
    hinge = np.zeros(spans + 1, np.uint8)
    if random.random() < 0.3:
        hinge[:-1] = random.random(spans) < 0.25
    omega = np.pi / L * np.sqrt((abs(T) + B * np.pi**2 / L**2) / mu)
    return np.concatenate([span.ravel(), station.ravel()]), hinge, omega
