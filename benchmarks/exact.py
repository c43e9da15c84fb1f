"""Short chains of rigid elements in 40 digits, from the model's own numbers."""

import mpmath as mp
import numpy as np

import ropedyn as rd
from ropedyn.chain import Chain

mp.mp.dps = 40


def receptance(model: rd.Model, frequency: float, gamma: float, at: int) -> complex:
    """Return the response of unknown `at` to a unit force there; gamma is stiffness damping [s]."""
    omega = 2 * mp.pi * mp.mpf(frequency)
    stiffness, mass = matrices(model.chain, 1 + 1j * omega * mp.mpf(gamma))
    force = mp.zeros(len(mass), 1)
    force[at] = 1
    return complex(mp.lu_solve(stiffness - omega**2 * mp.diag(mass), force)[at])


def frequency_near(model: rd.Model, frequency: float) -> mp.mpf:
    """Return the natural frequency [Hz] nearest to a good one, by inverse iteration."""
    stiffness, mass = matrices(model.chain, mp.mpf(1))
    shift = (2 * mp.pi * mp.mpf(frequency)) ** 2 * (1 + mp.mpf("1e-9"))
    shape = mp.matrix([mp.mpf(k % 3 + 1) for k in range(len(mass))])
    for _ in range(3):
        shape = mp.lu_solve(stiffness - shift * mp.diag(mass), mp.diag(mass) * shape)
        shape /= mp.norm(shape)
    energy = (shape.T * stiffness * shape)[0] / (shape.T * mp.diag(mass) * shape)[0]
    return mp.sqrt(energy) / (2 * mp.pi)


def matrices(chain: Chain, section: mp.mpc) -> tuple[mp.matrix, list[mp.mpf]]:
    """Assemble stiffness and diagonal mass over the free coordinates.

    An element is u_b = F u_a + G f_b with the section flexibility S / `section` summed over its
    length, and the string T/l on the difference of its deflections.
    """
    w = len(chain.coordinate)
    stiffness = mp.zeros(w * chain.nodes)
    for k, which in enumerate(chain.element_of):
        element = _element(chain, int(which), section)
        for i in range(2 * w):
            for j in range(2 * w):
                stiffness[w * k + i, w * k + j] += element[i, j]
    free = np.flatnonzero((chain.held[chain.term_of] == 0).ravel()).tolist()
    diagonal = chain.mass[chain.term_of].diagonal(axis1=1, axis2=2).ravel()
    kept = mp.matrix([[stiffness[i, j] for j in free] for i in free])
    return kept, [mp.mpf(float(diagonal[i])) for i in free]


def _element(chain: Chain, which: int, section: mp.mpc) -> mp.matrix:
    length, names = mp.mpf(float(chain.length[which])), chain.coordinate.tolist()
    w, z, beta = len(names), names.index(1), names.index(3)
    S = chain.flexibility[which]
    # moments of the section's turns about the right end: beta and alpha by 1, z by its distance
    order = [1 if c == 1 else 0 for c in names]
    channel = [1 if c == 2 else 2 for c in names]
    F, G = mp.eye(w), mp.zeros(w)
    F[z, beta] = length
    for i in range(w):
        for j in range(w):
            power = order[i] + order[j] + 1
            G[i, j] = float(S[channel[i], channel[j]]) / section * length**power / power
    stiff = G**-1
    blocks = [[F.T * stiff * F, -F.T * stiff], [-stiff * F, stiff]]
    element = mp.zeros(2 * w)
    for a in range(2):
        for b in range(2):
            for i in range(w):
                for j in range(w):
                    element[a * w + i, b * w + j] = blocks[a][b][i, j]
            element[a * w + z, b * w + z] += (
                (1 if a == b else -1) * mp.mpf(float(chain.tension[which])) / length
            )
    return element
