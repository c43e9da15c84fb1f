"""Chains and spans as modes that tension and damping couple."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.array import Index, Real
from ..base.check import NEAR
from ..base.computed import computed
from ..base.errors import SceneError, SolveError
from ..chain.chain import ATTACHED, Chain, roles
from ..chain.compile import divided
from ..chain.compiled import Compiled, with_plain_lumps
from ..eigen.sensitivity import by_tension
from ..eigen.spectrum import SOLVERS, ComponentModes, pieces_of, spectrum
from ..response.modal_sum import numbered_ratios
from ..scene.damping import INERTIA, SECTION, TENSION, factors, having
from ..signal.contour import clusters

GAUSS = 12
"""So many points in each piece of a span shorter than its waves integrate products of two shapes to
rounding."""
ROUNDING = 1e-12  # Couplings below this part of the largest that two modes can have are rounding.
RESONATOR = ATTACHED.index("resonator")


@dataclass(frozen=True, eq=False)
class ModalSystem:
    """Amplitudes q of modes of unit modal mass.

    While the tension is mean + a(t)

        q'' + C q' + (Lambda + a(t) Gamma) q = 0.
    """

    eigenvalue: Real  # (k,) Lambda, of the mean tension [rad^2/s^2]
    geometric: Real  # (k, k) Gamma, the integral of the products of slopes [rad^2/(N s^2)]
    damping: Real  # (k, k) c [1/s]

    @computed
    def omega(self) -> Real:
        """Angular frequencies [rad/s], 0 where motion grows, shape (k,)."""
        return np.sqrt(np.maximum(self.eigenvalue, 0.0))

    @computed
    def blocks(self) -> tuple[Index, ...]:
        """Modes that tension or damping couple, those of each block in order."""
        return tuple(clusters((self.geometric != 0) | (self.damping != 0)))

    @computed
    def coupling(self) -> Real | None:
        """What dampers couple, their own share left out; None where they couple none."""
        beside = self.damping - np.diag(np.diag(self.damping))
        return beside if beside.any() else None

    def only(self, modes: Index) -> ModalSystem:
        """Return that of some modes."""
        square = np.ix_(modes, modes)
        return ModalSystem(self.eigenvalue[modes], self.geometric[square], self.damping[square])


class ChainModes(NamedTuple):
    """All modes of a component of a chain."""

    system: ModalSystem
    shape: Real  # (k, nodes, width) of unit modal mass


def chain_modes(model: Compiled, component: tuple[str, ...]) -> ChainModes:
    """Return all modes of a component."""
    model = with_plain_lumps(model, component)
    basis = _Basis.of(model, component, None)
    half = np.linalg.inv(np.linalg.cholesky(basis.mass))
    return ChainModes(_reduced(model, component, basis), np.tensordot(half, basis.shape, 1))


def modal_system(model: Compiled, number: int | None) -> ModalSystem:
    """Reduce a model to its lowest modes with transverse motion."""
    # exact for what the modes span. Of tensed elements Gamma is the derivative of their stiffness,
    # which is not quite a straight line of the tension; the rest vanishes with the mesh.
    _refuse(model)
    parts = [_reduced(model, c, _Basis.of(model, c, number)) for c in transverse(model)]
    there = sum(len(part.eigenvalue) for part in parts)
    if number is not None and there < number:
        raise SolveError(
            f"modes must be at most {there}, the transverse ones this model has, got {number}"
        )
    if len(parts) == 1:
        return parts[0]
    whole = together(parts)
    return whole.only(np.argsort(whole.eigenvalue, kind="stable")[:number])


def transverse(model: Compiled) -> list[tuple[str, ...]]:
    """Return the components that a tension that pulsates acts on: those of each plane."""
    return [c for c in model.components if "z" in roles(c)]


def together(parts: Sequence[ModalSystem]) -> ModalSystem:
    """Return systems that nothing ties to each other, one after another."""
    from scipy.linalg import block_diag

    value = np.concatenate([part.eigenvalue for part in parts])
    both = (block_diag(*each) for each in zip(*((one.geometric, one.damping) for one in parts)))
    return ModalSystem(value, *both)


def _reduced(model: Compiled, component: tuple[str, ...], basis: _Basis) -> ModalSystem:
    """Return the modes of one component."""
    half = np.linalg.inv(np.linalg.cholesky(basis.mass))
    geometric = _cut(half @ basis.geometric @ half.T)
    damping = half @ _damping(model, basis) @ half.T + _modal(model, component, basis.eigenvalue)
    return ModalSystem(basis.eigenvalue, geometric, _cut(damping))


def _refuse(model: Compiled) -> None:
    scene = model.scene
    if "z" not in model.coordinates:
        raise SceneError("rope must move transversely for a tension that pulsates to act on it")
    if scene.gravity is not None:
        raise SceneError(
            "gravity must be None where the tension pulsates: the sag would pulsate with it, and "
            "tension that grows along the rope is not all of it, got "
            f"{scene.gravity}"
        )
    if model.element == "difference" and "beta" in model.coordinates:
        raise SceneError(
            'element must not be "difference" where there is bending and tension: the kinematics '
            "of the 2015 study has no geometric stiffness"
        )
    for one in having(scene.dampings, "loss"):
        raise SceneError(f"damping must be in proportion to velocity, got {one}")
    chain = model.chain.only(model.component_of("z"))
    if "broken wire" not in chain.carried:
        return
    if chain.is_hysteretic or having(scene.dampings, "rate"):
        raise SceneError(
            "a broken wire must be without damping where the tension pulsates, and so must be "
            "stiffness and inertia beside it: the form of its own motion is not known"
        )
    if model.element == "continuous" and "beta" not in model.coordinates:
        raise SceneError("elements must be given where a string with a broken wire pulsates")


def _cut(matrix: Real) -> Real:
    """Return a symmetric matrix without couplings that are rounding."""
    size = np.sqrt(np.abs(np.diag(matrix)))
    even = (matrix + matrix.T) / 2
    return np.where(np.abs(even) <= ROUNDING * np.outer(size, size), 0.0, even)


@dataclass(frozen=True, eq=False)
class _Basis:
    """Forms of shapes of any size."""

    eigenvalue: Real  # (k,)
    shape: Real  # (k, nodes, width)
    mass: Real  # (k, k) of inertia
    geometric: Real  # (k, k) of slopes
    string: Real  # (k, k) of tension
    dragged: Real  # (k, k) of drag and dashpots
    carried: Real  # (k, k) of the stiffness of the structures that nodes carry
    resisted: Real  # (k, k) of their damping

    @classmethod
    def of(cls, model: Compiled, component: tuple[str, ...], number: int | None) -> _Basis:
        """Solve for the shapes."""
        weight = None
        if model.element == "continuous":
            model, weight = _at_gauss_points(model, component, number)
        chain = model.chain.only(component)
        wanted = chain.finite if number is None else number
        found = SOLVERS["sweep"](model, component, wanted, math.inf, shaped=True)
        shape = found.shape
        assert shape is not None
        of_structures, stiffness, resisted = _structures(chain, found)
        own = _form(shape, chain.mass[chain.term_of])
        dragged = np.zeros_like(own)
        if chain.damping is not None:
            dragged = _form(shape, chain.damping[chain.term_of])
        if weight is not None:
            own += _integral(chain, chain.inertia, weight, shape)
            dragged += _integral(chain, chain.drag, weight, shape)
        mass = own + of_structures
        if "broken wire" in chain.carried:
            mass = np.diag(np.diag(mass))  # what is not known of wires makes modes orthogonal
        if weight is None:
            geometric = by_tension(chain, shape)
        elif "beta" in roles(component):
            slope = shape[:, :, roles(component).index("beta")]
            geometric = (slope * weight) @ slope.T
        else:
            # in tension is stored what springs and structures do not store
            total = np.diag(found.eigenvalue * np.sqrt(np.diag(mass)) ** 2)
            springs = _form(shape, chain.stiffness[chain.term_of])
            geometric = (total - springs - stiffness) / chain.tension[0]
        # what rounding cannot tell from 0 is 0
        eigenvalue = np.where(np.abs(found.eigenvalue) <= found.error, 0.0, found.eigenvalue)
        string = chain.tension[0] * geometric
        if np.ptp(chain.tension) > 0:  # own weight along a chain
            string = by_tension(chain, shape, chain.tension)
        return cls(eigenvalue, shape, mass, geometric, string, dragged, stiffness, resisted)


def _at_gauss_points(
    model: Compiled, component: tuple[str, ...], number: int | None
) -> tuple[Compiled, Real]:
    """Return continuous spans with nodes at the points of Gauss, and these points' weights [m]."""
    eigenvalue, _ = spectrum(model, component, number)
    highest = float(np.abs(eigenvalue).max(initial=0.0))
    chain = model.chain.undamped.only(component)
    place, share = np.polynomial.legendre.leggauss(GAUSS)
    x: list[Real] = [model.x[:1]]
    weight: list[Real] = [np.zeros(1)]
    for k, (begin, end) in enumerate(zip(model.x, model.x[1:])):
        span = chain.between(k, k + 1)
        equal = np.linspace(begin, end, pieces_of(span, highest) + 1)
        layer = _layers(span, end - begin)
        edge = np.unique(np.concatenate([equal, begin + layer, end - layer]))
        least = NEAR * (end - begin)  # of layers that end where pieces do, but for rounding
        apart = (np.diff(edge)[:-1] > least) & (end - edge[1:-1] > least)
        edge = edge[np.concatenate([[True], apart, [True]])]
        half = np.diff(edge)[:, None] / 2
        x += [((edge[:-1] + edge[1:])[:, None] / 2 + half * place).ravel(), np.array([end])]
        weight += [(half * share).ravel(), np.zeros(1)]
    stations = np.concatenate(x)
    counts = np.ones(len(stations) - 1, dtype=np.intp)
    return divided(model.scene, model.element, stations, counts), np.concatenate(weight)


def _layers(span: Chain, length: float) -> Real:
    """Return distances from the ends that grade layers sqrt(B/T) where a string bends [m]."""
    tension, flexibility = float(span.tension[0]), span.flexibility[span.element[0], 2, 2]
    if tension <= 0 or flexibility == 0:
        return np.zeros(0)
    layer = 1 / math.sqrt(tension * flexibility)
    return np.asarray(layer * 2.0 ** np.arange(max(math.ceil(math.log2(length / (2 * layer))), 0)))


def _form(shape: Real, block: Real) -> Real:
    """Return shape^T blocks shape, of blocks (nodes, width, width) on the diagonal."""
    count = len(shape)
    moved = np.einsum("nab,knb->kna", block, shape)
    return np.asarray(shape.reshape(count, -1) @ moved.reshape(count, -1).T)


def _integral(chain: Chain, along: Real | None, weight: Real, shape: Real) -> Real:
    """Return the integral of products of shapes times what is along the rope."""
    if along is None:
        return np.zeros((len(shape), len(shape)))
    beside = along[np.append(chain.element_of, chain.element_of[-1])] * weight[:, None]
    count = len(shape)
    return np.asarray((shape * beside).reshape(count, -1) @ shape.reshape(count, -1).T)


def _structures(chain: Chain, found: ComponentModes) -> Real:
    """Return mass, stiffness and damping of what nodes carry, (3, k, k); of wires the mass."""
    shape, motion = found.shape, found.motion
    assert shape is not None
    assert motion is not None
    count = len(shape)
    form = np.zeros((3, count, count))
    if chain.attached_kind is None:
        return form
    assert chain.attached_row is not None
    assert chain.attached_value is not None
    for k, kind in enumerate(chain.attached_kind):
        if kind != RESONATOR:
            continue
        mass, stiffness, _, damping = chain.attached_value[k]
        y = motion[:, k]
        stretched = y - shape[:, chain.feet[k]] @ chain.attached_row[k, 0]
        form[0] += mass * np.outer(y, y)
        form[1] += stiffness * np.outer(stretched, stretched)
        form[2] += damping * np.outer(stretched, stretched)
    wires = chain.attached_kind != RESONATOR
    if wires.any():
        part = np.ascontiguousarray(motion[:, wires])
        energy = _core.carried(chain.carrying(wires), shape, part, found.eigenvalue)
        form[0][np.diag_indices(count)] += energy[:, 1]
    return form


def _damping(model: Compiled, basis: _Basis) -> Real:
    """Return shape^T C shape; of what bends, all stiffness but that of tension and structures."""
    share = factors(model.scene.dampings, np.array(1.0)).imag
    root = np.sqrt(np.diag(basis.mass))
    elastic = np.diag(basis.eigenvalue * root**2) - basis.string - basis.carried
    return np.asarray(
        share[SECTION] * elastic
        + share[TENSION] * basis.string
        + share[INERTIA] * basis.mass
        + basis.dragged
        + basis.resisted
    )


def _modal(model: Compiled, component: tuple[str, ...], eigenvalue: Real) -> Real:
    """Return 2 zeta omega of damping ratios, in the order of all modes of the model."""
    number, ratio = numbered_ratios(model, component, eigenvalue)
    if np.isnan(ratio).any():
        raise SceneError(
            "damping ratio must be one number or one for each mode, got none for mode "
            f"{int(number[np.isnan(ratio).argmax()]) + 1}"
        )
    return np.diag(2 * ratio * np.sqrt(np.maximum(eigenvalue, 0.0)))
