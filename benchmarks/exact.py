"""Short chains of rigid elements in 40 digits, from the model's own numbers."""

import mpmath as mp
import numpy as np

import ropedyn as rd
from ropedyn.chain.chain import Chain

DIGITS = 40


@mp.workdps(DIGITS)
def receptance(model: rd.Model, frequency: float, gamma: float, at: int) -> complex:
    """Return the response of unknown `at` to a unit force there; gamma is stiffness damping [s]."""
    omega = 2 * mp.pi * mp.mpf(frequency)
    stiffness, mass = matrices(model.chain, 1 + 1j * omega * mp.mpf(gamma))
    force = mp.zeros(len(mass), 1)
    force[at] = 1
    return complex(mp.lu_solve(stiffness - omega**2 * mp.diag(mass), force)[at])


@mp.workdps(DIGITS)
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


@mp.workdps(60)
def clamped_frequencies(chain: Chain, number: int) -> list[mp.mpf]:
    """Return the lowest natural frequencies [Hz] of a uniform clamped chain of rigid bodies.

    The dispersion equation and its boundary conditions are those of
    ../shared/reference/rigid_chain_exact.json: one wave k n in (k pi, (k + 1) pi) for each mode.
    """
    n = chain.nodes - 1
    a, tension = (mp.mpf(float(x[0])) for x in (chain.length, chain.tension))
    bending = 1 / mp.mpf(float(chain.flexibility[0][2][2]))
    m, J = (2 * mp.mpf(float(chain.mass[0][i][i])) for i in range(2))
    stiff, kappa = 2 * (12 + tension * a**2 / bending), J / (m * a**2)

    def eigenvalue(c: mp.mpf) -> mp.mpf:
        # the lower one in (stiff (1 - c) - lambda)(8 + 4 c - kappa lambda) = 144 (1 - c^2)
        p, q = stiff * (1 - c), (8 + 4 * c) / kappa
        product = p * q - 144 * (1 - c * c) / kappa
        return 2 * product / (p + q + mp.sqrt((p + q) ** 2 - 4 * product))

    def mismatch(phi: mp.mpf, odd: bool) -> mp.mpf:
        c = mp.cos(phi)
        lam = eigenvalue(c)
        square, middle = 144 - 4 * stiff, 4 * (stiff - lam) - stiff * (8 - kappa * lam)
        d = -middle / square - c
        psi = mp.acosh(d)
        r1 = 12 * mp.sin(phi) / (8 + 4 * c - kappa * lam)
        r2 = 12 * mp.sinh(psi) / (8 + 4 * d - kappa * lam)
        sine, cosine, tanh = mp.sin(phi * n / 2), mp.cos(phi * n / 2), mp.tanh(psi * n / 2)
        return mp.re(r2 * sine - r1 * cosine * tanh if odd else r2 * cosine * tanh + r1 * sine)

    found = []
    for k in range(1, number + 1):
        ends = (mp.pi * (k + mp.mpf("1e-6")) / n, mp.pi * (k + 1 - mp.mpf("1e-6")) / n)
        phi = mp.findroot(
            lambda x, odd=k % 2 == 0: mismatch(x, odd), ends, solver="anderson", tol=1e-60
        )
        lam = eigenvalue(mp.cos(phi)) * bending / (m * a**3)
        found.append(mp.sqrt(lam) / (2 * mp.pi))
    return found


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
