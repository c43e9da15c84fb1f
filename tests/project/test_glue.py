"""The glue: the core called with what no model holds; memory, threads, signals, symbols."""

import json
import math
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import ropedyn as rd
from ropedyn import _core
from ropedyn.base.answer import leaves

ROPE = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.4, lay_slope=0.1)
SCENE = rd.Scene(
    ROPE.replace(rotary_inertia=1e-5, polar_inertia=1e-6),
    tension=100.0,
    ends=("clamped", "free"),
    parts=[
        rd.PointMass(0.3, 0.05),
        rd.Spring(0.6, 100.0),
        rd.Hinge(0.6, stiffness=2.0),
        rd.Resonator(0.3, 0.01, 20.0, damping_ratio=0.1),
        rd.BrokenWire(0.6, 0.05, 3e-4, radius=2e-3, damping_ratio=0.01),
    ],
)
MODEL = SCENE.compile(elements=8, element="rigid")
LINEAR = SCENE.without("resonator", "broken wire").compile(elements=8, element="rigid")
CHAIN = MODEL.chain  # 9 nodes, width 3
SPAN = SCENE.compile().chain  # continuous, 4 nodes, width 3
FIELDS = tuple(f for f in CHAIN._fields[1:] if getattr(CHAIN, f) is not None)
NODES, WIDTH = 9, 3
FACTOR = np.array([[1, 1, 1, -1.0 + 0j, 1j], [1, 1, 1, -400.0, 20j]])
CONSTANT = np.array([1, 1, 1, 0, 0], complex)
SLOPE = np.array([1e-5, 0, 0, 0, 1], complex)
PORT = (np.array([2], dtype=np.int32), np.ones((1, 2, WIDTH)))
FORCE = np.ones((NODES, WIDTH))
SHAPES = np.ones((2, NODES, WIDTH))
MOTIONS = np.ones((2, 2))
MATRIX = np.array([[2.0, 1.0], [1.0, 3.0]])
GUARDS = (  # cos(3 t) and 2 + t e^(3 i t)
    np.array([3j]),
    np.array([[1.0], [0.0]], dtype=complex),
    np.array([[0.0], [1.0]], dtype=complex),
    np.array([[0.0], [2.0]]),
    np.ones(2),
)
# two groups of modes through three blocks of two samples, of two kinds, seen by one response
STEPPED = (
    np.full((2, 2, 4, 4), 0.1),
    np.ones((2, 2, 3, 2, 4)),
    np.ones((2, 2, 1, 2, 4)),
    np.ones((2, 1, 2)),
    np.array([0, 1, 0], np.int32),
    np.arange(7.0),
    np.ones((2, 2, 4)),
)
# two motions of one point and its drive, harmonics up to 1, spare coefficients
BALANCED = (
    np.full((2, 2, 1, 2), 0.5 + 0.1j),
    np.full((2, 1, 1, 4), 0.2 + 0j),
    np.full((2, 1, 1, 4), 0.1 + 0j),
    np.array([1.0, 2.0]),
)
# two motions between two samples
STRUCK = (2.0, 0.1, 1.0, np.array([0.1, 0.2]), np.full((2, 2), 0.3), np.full((2, 2), 0.4))
# a step of two stages of one law in Python and one in the core, three modes, no forces before it
COLLOCATED = (
    (
        0.1,
        np.array([1 / 3, 1.0]),
        np.full((2, 2, 3), 0.1),
        np.full((2, 2, 3), 0.1),
        np.full((2, 2, 3, 2, 2, 2), 0.1),
        np.full((2, 2, 2, 2, 2), 0.01),
        np.eye(2),
    ),
    (
        np.array([1, 0], np.int32),
        np.array([[0.0, 1.0], [0.1, 2.0]]),
        (lambda t, u, v: 1.0 - u, None),
        np.array([1, 0], np.uint8),
    ),
    np.array([0.0, 0.1]),
    np.zeros((2, 2, 2, 2)),
    np.zeros((2, 2)),
    np.zeros((2, 2, 3)),
    np.ones((3, 2)),
)
# two steps of a law in the core and one in Python
VOLTERRA = (
    (np.array([0, 2], np.int32), np.array([[2.0, 0.0, 0.0, 0.0]] * 2), (None, lambda t, u, v: -u)),
    0.0,
    0.1,
    np.full((2, 2, 2), 0.01),
    np.full((2, 3), 0.1),
)
# stations, elements, ropes and rounding of three spans, two of them alike
DIVIDED = (
    np.array([0.0, 1.0, 1.5, 2.5]),
    np.array([2, 1, 2]),
    np.array([0, 0, 0]),
    1e-15,
)

# two strings of other tension, held
STRINGS = (
    "plain",
    np.array([[1.0, 0.1, 10.0, math.inf, math.inf], [1.0, 0.1, 40.0, math.inf, math.inf]]),
)

# a string of two spans, held at its ends, with a mass between them
CUT_STRING = (
    "plain",
    np.array([[0.4, 0.1, 10.0, 0.6, 0.1, 10.0, 0.0, math.inf, 0.01, 0.0, 0.0, math.inf]]),
    np.zeros(3, np.uint8),
)

LAW_NUMBERS = (
    np.array([0, 1], dtype=np.int32),
    np.array([[0.1, 0.5, 0.0, 0.0], [10.0, 1e-4, 1.0, 0.1]]),
)


def coupled(**given):
    """Two steps of three modes under two laws, with some arguments replaced."""
    modes, laws, steps = 3, 2, 2
    usual = {
        "step": (0.0, 1e-3, np.ones((2, 2, modes)), np.full((2, modes), 1e-6)),
        "laws": (*LAW_NUMBERS, (None, None)),
        "row": np.ones((laws, modes)),
        "form": np.eye(modes),
        "drag": np.eye(modes),
        "tension": np.ones(steps),
        "known": np.full((steps + 1, modes), 1e-3),
        "state": np.zeros((steps + 1, 2, modes)),
        "pushed": np.zeros((steps + 1, modes)),
        "force": np.zeros((steps + 1, laws)),
        "largest": np.zeros(1),
        "size": np.zeros(laws),
    }
    one = usual | given
    coupling = one["row"], one["form"], one["drag"], one["tension"], 1.0
    return _core.modal_steps(
        one["step"],
        one["laws"],
        coupling,
        one["known"],
        one["state"],
        one["pushed"],
        one["force"],
        one["largest"],
        one["size"],
    )


def still(array):
    array.setflags(write=False)
    return array


PAIR = np.array([[0, 1], [1, 1]], dtype=np.int32)
SLIP = np.array([[-1, 0, 0], [1, 1, 0]], dtype=np.int32)


FIELD = np.random.default_rng(1).normal(size=(2, SHAPES[0].size, len(FACTOR), 2)) @ [1, 1j]
PAIRED = (FACTOR.T.copy(), FIELD, PAIR, SLIP)
SPANNED = (PAIRED[0], FIELD[:, : 2 * SHAPES[0, :4].size].copy(), PAIR, SLIP)


ARC = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.1, bending_stiffness=1.0, torsional_stiffness=0.4)
PLANE = np.array([0, 1], dtype=np.int32)
SPACE, SCALE = rd.Scene(ARC, planes="both").compile().rope.core(PLANE, np.array([1e4, 1e6]))
RATES, SERIES = SPACE[3][:, 0] + 0j, SPACE[4]
BLOCKS = [np.tile(np.eye(6), (2, n, 1, 1)) for n in (1, 1, 1, 2)]
FIXED = np.zeros((2, 18), dtype=np.uint8)
SOLVED = np.ones((2, 3, 18))
FACTORED = _core.space_factor(*BLOCKS, FIXED, False)[:2]

NODES = np.tile(FACTOR, (8, 1)).T.copy()

# every entry point that takes a chain
ENTRIES = {
    "triples": _core.triples,
    "assemble": _core.assemble,
    "shape": lambda chain: _core.shape(chain, 0, 0.01),
    "local": lambda chain: _core.local(chain, 0, 0.01, 0.02),
    "deflection": lambda chain: _core.deflection(chain, FORCE),
    "modes": lambda chain: _core.modes(chain, 3, 0.0, 1e4),
    "frf": lambda chain: _core.frf(chain, FACTOR, PORT, PORT),
    "count": lambda chain: _core.count(chain, np.array([1e4, 1e6])),
    "certify": lambda chain: _core.certify(chain, 3, np.inf, True),
    "sweep": lambda chain: _core.sweep(chain, FACTOR.T.copy(), PORT, PORT),
    "sweep_between": lambda chain: _core.sweep_between(chain, NODES),
    "steps": lambda chain: _core.steps(chain, FACTOR.T.copy()),
    "scales": lambda chain: _core.scales(chain, FACTOR.T.copy()),
    "damped": lambda chain: _core.damped(
        chain, CONSTANT, SLOPE, 0.0, 30.0, np.inf, np.inf, np.array([20j, -20j])
    ),
    "mixed": lambda chain: _core.mixed(chain, FACTOR.T.copy(), PORT, PORT),
    "mixed_deflection": lambda chain: _core.mixed_deflection(chain, FORCE),
    "triple": lambda chain: _core.triple(chain, 0, FACTOR.T.copy()),
    "energy": lambda chain: _core.energy(chain, SHAPES, np.array([1e4, 1e6])),
    "carried": lambda chain: _core.carried(chain, SHAPES, MOTIONS, np.array([1e4, 1e6])),
    "carried_slopes": lambda chain: _core.carried_slopes(
        chain, SHAPES, MOTIONS, np.array([1e4, 1e6])
    ),
    "tip": lambda chain: _core.tip(chain, 1, FACTOR.T.copy()),
    "sensitivity": lambda chain: _core.sensitivity(chain, SHAPES, MOTIONS, np.array([1e4, 1e6])),
    "pair_slopes": lambda chain: _core.pair_slopes(chain, *PAIRED),
    "carried_pair_slopes": lambda chain: _core.carried_pair_slopes(chain, *PAIRED),
}
# those that have a meaning for continuous chains
SPANS = {
    "count": ENTRIES["count"],
    "certify": ENTRIES["certify"],
    "sweep": ENTRIES["sweep"],
    "sweep_between": ENTRIES["sweep_between"],
    "steps": ENTRIES["steps"],
    "scales": ENTRIES["scales"],
    "damped": ENTRIES["damped"],
    "triple": ENTRIES["triple"],
    "tip": ENTRIES["tip"],
    "carried": lambda chain: _core.carried(chain, SHAPES[:, :4], MOTIONS, np.array([1e4, 1e6])),
    "carried_slopes": lambda chain: _core.carried_slopes(
        chain, SHAPES[:, :4], MOTIONS, np.array([1e4, 1e6])
    ),
    # below the first resonance of each element as a cantilever
    "energy": lambda chain: _core.energy(chain, SHAPES[:, :4], np.array([10.0, 100.0])),
    "sensitivity": lambda chain: _core.sensitivity(
        chain, SHAPES[:, :4], MOTIONS, np.array([10.0, 100.0])
    ),
    "pair_slopes": lambda chain: _core.pair_slopes(chain, *SPANNED),
    "carried_pair_slopes": lambda chain: _core.carried_pair_slopes(chain, *SPANNED),
}
OTHERS = {
    "section": lambda _: _core.section(1.0, 1.0, 1.0, 0.1, 0.1),
    "invert": lambda _: _core.invert(MATRIX),
    "modal_steps": lambda _: coupled()[:-1],
    "recurrence": lambda _: _core.recurrence(*STEPPED),
    "balance": lambda _: _core.balance(*BALANCED),
    "stopped": lambda _: _core.stopped(*STRUCK),
    "first_crossing": lambda _: _core.first_crossing(*GUARDS, 1.0),
    "volterra": lambda _: _core.volterra(
        *VOLTERRA, np.zeros((2, 2)), np.zeros((2, 3)), np.zeros(2), 0, 2
    )[:-1],
    "collocate": lambda _: _core.collocate(*COLLOCATED)[:-1],
    "closed_modes": lambda _: _core.closed_modes(*STRINGS, np.eye(5), 2),
    "closed_count": lambda _: _core.closed_count(*STRINGS, 30.0),
    "closed_chain_modes": lambda _: _core.closed_chain_modes(*CUT_STRING, np.eye(12), 2),
    "closed_chain_count": lambda _: _core.closed_chain_count(*CUT_STRING, 30.0),
    "closed_response": lambda _: _core.closed_response(
        np.array([[1.0, 0.1, 10.0, 1.0, math.inf, math.inf, math.inf, 0.0]]),
        np.array([[1], [1], [1], [-1e4], [1e2j]], dtype=complex),
        0.1,
        np.array([0.4]),
        np.array([0.6]),
    ),
    "divide": lambda _: _core.divide(*DIVIDED),
    "space_triples": lambda _: _core.space_triples(RATES, SERIES, 2.0, 1, 6, 6, 1e4),
    "space_factor": lambda _: _core.space_factor(*BLOCKS, FIXED, False),
    "space_solve": lambda _: _core.space_solve(*FACTORED, SOLVED),
    "space_respond": lambda _: _core.space_respond(*BLOCKS, FIXED, False, SOLVED),
    "space_apply": lambda _: _core.space_apply(*BLOCKS, FIXED, False, SOLVED),
    "space_iterate": lambda _: _core.space_iterate(*BLOCKS, FIXED, False, *FACTORED, SOLVED, 2),
    "space_count": lambda _: _core.space_count(SPACE, PLANE, np.array([1e4, 1e6]), SCALE),
    "eliminate": lambda _: eliminated(np.longdouble),
    "substitute": lambda _: substituted(np.clongdouble),
}


def eliminated(kind):
    """Two systems of two rows, beside a right side."""
    matrix = np.array([[[2, 1, 3], [4, 1, 5]], [[0, 1, 2], [1, 0, 4]]], dtype=kind)
    _core.eliminate(matrix, 2)
    return matrix


def substituted(kind):
    matrix = eliminated(kind)
    x = matrix[:, :, 2:].copy()
    _core.substitute(matrix, x)
    return x


# entry points and the chains that they are tried with
TRIED = [(name, CHAIN) for name in ENTRIES] + [(name, SPAN) for name in SPANS]
TRIED_IDS = [f"{name}-{'continuous' if chain is SPAN else 'lumped'}" for name, chain in TRIED]


def call_of(entry, chain):
    return (SPANS if chain is SPAN else ENTRIES | OTHERS)[entry]


def flat(answer):
    """Bytes of every array and number in nested tuples."""
    if isinstance(answer, tuple):
        return [b for one in answer for b in flat(one)]
    return [np.asarray(answer).tobytes()]


def swapped(name, change, chain=CHAIN):
    return chain._replace(**{name: change(getattr(chain, name))})


def put(name, value, at=0, chain=CHAIN):
    array = np.array(getattr(chain, name))
    array.flat[at] = value
    return chain._replace(**{name: array})


def test_entries_are_all_of_the_module():
    names = {n for n in dir(_core) if not n.startswith("_")}
    assert names == set(ENTRIES) | set(OTHERS)


# malformed chains: (chain, error, words of the message)
MALFORMED = {
    "none": (None, TypeError, "chain must be a tuple"),
    "list": (list(CHAIN), TypeError, "chain must be a tuple"),
    "model": (MODEL, TypeError, "chain must be a tuple"),
    "empty": ((), TypeError, "21 arguments"),
    "one less": (tuple(CHAIN)[:-1], TypeError, "21 arguments"),
    "one more": ((*CHAIN, 1), TypeError, "21 arguments"),
    "kind of text": (CHAIN._replace(kind="rigid"), TypeError, ""),
    "kind of a float": (CHAIN._replace(kind=1.0), TypeError, ""),
    "kind too large": (CHAIN._replace(kind=2**40), OverflowError, ""),
    "kind unknown": (CHAIN._replace(kind=4), ValueError, "kind"),
    "kind negative": (CHAIN._replace(kind=-1), ValueError, "kind"),
    "no coordinate": (
        CHAIN._replace(coordinate=np.zeros(0, np.int32)),
        ValueError,
        "mass must have 0 entries along axis 1, got 3",
    ),
    "coordinate twice": (put("coordinate", 1, at=1), ValueError, "coordinate must increase"),
    "coordinates turned": (swapped("coordinate", lambda a: a[::-1]), ValueError, "increase"),
    "coordinate 4": (put("coordinate", 4, at=-1), ValueError, r"coordinate\[2\] must lie in 0"),
    "coordinate -1": (put("coordinate", -1), ValueError, r"coordinate\[0\] must lie in 0 ... 3"),
    "element -1": (put("element", -1), ValueError, r"element\[0\] must lie in 0"),
    "element beyond": (
        put("element", len(CHAIN.length), at=-1),
        ValueError,
        rf"element\[{len(CHAIN.element) - 1}\] must lie in 0 ... {len(CHAIN.length) - 1}, got",
    ),
    "element far beyond": (put("element", 2**31 - 1), ValueError, "element"),
    "term -1": (put("term", -(2**31)), ValueError, r"term\[0\] must lie in 0"),
    "term beyond": (put("term", len(CHAIN.mass), at=-1), ValueError, r"term\[\d\] must lie"),
    "no first node": (put("first", 1), ValueError, "first must increase from 0"),
    "a node twice": (put("first", 0, at=1), ValueError, "first must increase from 0"),
    "last node negative": (put("first", -1, at=-1), ValueError, "at least one element"),
    "too many nodes": (put("first", 2**31 - 1, at=-1), ValueError, "at least one element"),
    "one node": (
        CHAIN._replace(first=CHAIN.first[:1], element=CHAIN.element[:0], term=CHAIN.term[:1]),
        ValueError,
        "at least one element",
    ),
    "no node": (
        CHAIN._replace(first=CHAIN.first[:0], element=CHAIN.element[:0], term=CHAIN.term[:0]),
        ValueError,
        "at least one element",
    ),
    "a term too many": (
        swapped("term", lambda a: np.append(a, a[-1:])),
        ValueError,
        f"term must have {len(CHAIN.term)} entries along axis 0",
    ),
    "an element too many": (
        swapped("element", lambda a: np.append(a, a[-1:])),
        ValueError,
        f"element must have {len(CHAIN.element)} entries along axis 0",
    ),
    "no elements": (
        CHAIN._replace(
            length=CHAIN.length[:0], tension=CHAIN.tension[:0], flexibility=CHAIN.flexibility[:0]
        ),
        ValueError,
        "element",
    ),
    "no terms": (
        CHAIN._replace(
            mass=CHAIN.mass[:0],
            stiffness=CHAIN.stiffness[:0],
            held=CHAIN.held[:0],
            hinge=CHAIN.hinge[:0],
        ),
        ValueError,
        "term",
    ),
    "five coordinates": (
        CHAIN._replace(
            coordinate=np.arange(5, dtype=np.int32),
            mass=np.zeros((len(CHAIN.mass), 5, 5)),
            stiffness=np.zeros((len(CHAIN.mass), 5, 5)),
            held=np.zeros((len(CHAIN.mass), 5), np.uint8),
            hinge=None,
            **dict.fromkeys(("attached_kind", "attached_term", "attached_row", "attached_value")),
        ),
        ValueError,
        "1 to 4 coordinates",
    ),
}
for field in FIELDS:
    MALFORMED |= {
        f"{field} missing": (CHAIN._replace(**{field: None}), (TypeError, ValueError), ""),
        f"{field} of text": (CHAIN._replace(**{field: "abc"}), (TypeError, ValueError), ""),
        f"{field} a number": (CHAIN._replace(**{field: 1}), (TypeError, ValueError), ""),
        f"{field} complex": (swapped(field, lambda a: a + 0j), TypeError, "cast"),
        f"{field} of objects": (swapped(field, lambda a: a.astype(object)), TypeError, "cast"),
        f"{field} with an axis more": (swapped(field, lambda a: a[..., None]), ValueError, ""),
        f"{field} with an axis less": (swapped(field, lambda a: a.ravel()[0]), ValueError, ""),
    }
    if getattr(CHAIN, field).dtype.kind != "f":
        MALFORMED[f"{field} of floats"] = (
            swapped(field, lambda a: a.astype(float)),
            TypeError,
            "cast",
        )
del MALFORMED["hinge missing"]  # None: nothing is hinged
MALFORMED["hinge negative"] = (
    put("hinge", -1.0, at=7),
    ValueError,
    r"hinge\[2, 1\] must be >= 0",
)
SAG = np.full(len(CHAIN.length), 0.1)
LAID = rd.Scene(ROPE.replace(axial_stiffness=1e3), tension=100.0).compile(elements=8).chain
MALFORMED |= {
    "sag without x": (CHAIN._replace(sag=SAG), ValueError, "sag needs the coordinates x and z"),
    "sag too long": (
        CHAIN._replace(sag=np.append(SAG, 0.1)),
        ValueError,
        f"sag must have {len(SAG)} entries along axis 0",
    ),
    "sag under compression": (
        LAID._replace(sag=np.full(1, 0.1), tension=np.full(1, -1.0)),
        ValueError,
        r"tension\[0\] must be > 0 with sag",
    ),
}
BARE = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile().chain
MALFORMED |= {
    "rise of a chain": (
        CHAIN._replace(rise=np.full(len(CHAIN.length), 1.0)),
        ValueError,
        "rise needs continuous elements",
    ),
    "rise of nan": (BARE._replace(rise=np.array([math.nan])), ValueError, r"rise\[0\]"),
}
MALFORMED["hinge of nan"] = (put("hinge", math.nan, at=0), ValueError, r"hinge\[0, 0\]")
MALFORMED |= {
    "attached of a kind there is not": (put("attached_kind", 2), ValueError, r"attached_kind\[0\]"),
    "attached to no term": (put("attached_term", 99, at=1), ValueError, r"attached_term\[1\] must"),
    "attached out of order": (
        swapped("attached_term", lambda a: a[::-1].copy()),
        ValueError,
        "attached_term must not decrease",
    ),
    "attached inside a stretch": (
        put("attached_term", int(CHAIN.term[np.diff(CHAIN.first).argmax()]), at=1),
        ValueError,
        r"attached_term\[1\] must be the term of a single node",
    ),
}
# arrays whose length another one decides
for field in ("tension", "flexibility", "stiffness", "held", "hinge"):
    MALFORMED[f"{field} too short"] = (swapped(field, lambda a: a[1:]), ValueError, field)
    MALFORMED[f"{field} too long"] = (
        swapped(field, lambda a: np.concatenate([a, a])),
        ValueError,
        f"{field} must have {len(getattr(CHAIN, field))} entries along axis 0",
    )
for field in ("flexibility", "mass", "stiffness", "held", "hinge"):
    MALFORMED[f"{field} too narrow"] = (
        swapped(field, lambda a: a[:, 1:]),
        ValueError,
        f"{field} must have 3 entries along axis 1, got 2",
    )


# malformed arguments beside the chain
NODE, ROW = PORT
REFUSED = {
    "double numbers to eliminate": (
        lambda: _core.eliminate(np.ones((1, 2, 2)), 1),
        TypeError,
        "A must be a contiguous array of longdouble or clongdouble with three axes",
    ),
    "more columns to eliminate than there are": (
        lambda: _core.eliminate(np.ones((1, 2, 3), np.longdouble), 3),
        ValueError,
        "columns must be from 0 to 2, got 3",
    ),
    "a real right side of complex rows": (
        lambda: _core.substitute(eliminated(np.clongdouble), np.ones((2, 2, 1), np.longdouble)),
        ValueError,
        "x must have 2 lines of at most 2 rows and numbers as A",
    ),
    "no arguments": (_core.frf, TypeError, "4 arguments"),
    "one argument less": (lambda: _core.frf(CHAIN, FACTOR, PORT), TypeError, "4 arguments"),
    "one argument more": (lambda: _core.triples(CHAIN, 1), TypeError, "1 argument"),
    "by name": (lambda: _core.triples(chain=CHAIN), TypeError, "keyword"),
    "force of a number": (lambda: _core.deflection(CHAIN, 1.0), ValueError, ""),
    "force for too few nodes": (
        lambda: _core.deflection(CHAIN, FORCE[1:]),
        ValueError,
        "force must have 9 entries along axis 0, got 8",
    ),
    "force too narrow": (
        lambda: _core.deflection(CHAIN, FORCE[:, 1:]),
        ValueError,
        "force must have 3 entries along axis 1, got 2",
    ),
    "force complex": (lambda: _core.deflection(CHAIN, FORCE + 0j), TypeError, "cast"),
    "factor with too few parts": (
        lambda: _core.frf(CHAIN, FACTOR[:, 1:], PORT, PORT),
        ValueError,
        "factor must have 5 entries along axis 1, got 4",
    ),
    "factor of one axis": (lambda: _core.frf(CHAIN, FACTOR[0], PORT, PORT), ValueError, ""),
    "factor of text": (
        lambda: _core.frf(CHAIN, [["a"] * 4], PORT, PORT),
        (TypeError, ValueError),
        "",
    ),
    "drives of a list": (
        lambda: _core.frf(CHAIN, FACTOR, list(PORT), PORT),
        TypeError,
        "drives must be a tuple",
    ),
    "responses of nothing": (
        lambda: _core.frf(CHAIN, FACTOR, PORT, None),
        TypeError,
        "responses must be a tuple",
    ),
    "drives of one": (lambda: _core.frf(CHAIN, FACTOR, (NODE,), PORT), TypeError, "2 arguments"),
    "node -1": (lambda: _core.frf(CHAIN, FACTOR, (NODE - 3, ROW), PORT), ValueError, "drives"),
    "node of the last element and one": (
        lambda: _core.frf(CHAIN, FACTOR, PORT, (NODE + 6, ROW)),
        ValueError,
        r"responses\[0\] must lie in 0 ... 7, got 8",
    ),
    "node of floats": (
        lambda: _core.frf(CHAIN, FACTOR, (NODE * 1.0, ROW), PORT),
        TypeError,
        "cast",
    ),
    "rows for too few ports": (
        lambda: _core.frf(CHAIN, FACTOR, (np.repeat(NODE, 2), ROW), PORT),
        ValueError,
        "drives must have 2 entries along axis 0, got 1",
    ),
    "rows too narrow": (
        lambda: _core.frf(CHAIN, FACTOR, (NODE, ROW[:, :, 1:]), PORT),
        ValueError,
        "drives must have 3 entries along axis 2, got 2",
    ),
    "rows of one node": (
        lambda: _core.frf(CHAIN, FACTOR, (NODE, ROW[:, 1:]), PORT),
        ValueError,
        "drives must have 2 entries along axis 1, got 1",
    ),
    "wanted below zero": (
        lambda: _core.modes(CHAIN, -1, 0.0, 1.0),
        ValueError,
        "wanted must be >= 0",
    ),
    "wanted beyond an index": (lambda: _core.modes(CHAIN, 2**70, 0.0, 1.0), OverflowError, ""),
    "wanted of a float": (lambda: _core.modes(CHAIN, 1.0, 0.0, 1.0), TypeError, ""),
    "scale of text": (lambda: _core.modes(CHAIN, 1, 0.0, "1"), TypeError, ""),
    "shapes of one axis less": (lambda: _core.energy(CHAIN, SHAPES[0], np.ones(2)), ValueError, ""),
    "shapes for too few nodes": (
        lambda: _core.energy(CHAIN, SHAPES[:, 1:], np.ones(2)),
        ValueError,
        "shape must have 9 entries along axis 1, got 8",
    ),
    "motions of too few": (
        lambda: _core.carried(CHAIN, SHAPES, MOTIONS[:, 1:], np.ones(2)),
        ValueError,
        "motion must have 2 entries along axis 1, got 1",
    ),
    "pair of no load": (
        lambda: _core.pair_slopes(CHAIN, *PAIRED[:2], PAIR + 1, SLIP),
        ValueError,
        "pair and slip must name loads and elements of the chain",
    ),
    "slip of no element": (
        lambda: _core.pair_slopes(CHAIN, *PAIRED[:2], PAIR, SLIP + 8),
        ValueError,
        "pair and slip must name loads and elements of the chain",
    ),
    "tip -1": (
        lambda: _core.tip(CHAIN, -1, FACTOR.T.copy()),
        ValueError,
        "k must lie in 0 ... 1, got -1",
    ),
    "tip beyond": (lambda: _core.tip(CHAIN, 2, FACTOR.T.copy()), ValueError, "got 2"),
    "span -1": (
        lambda: _core.shape(CHAIN, -1, 0.0),
        ValueError,
        r"node must lie in 0 ... 7, got -1",
    ),
    "span of the last node": (lambda: _core.local(CHAIN, 8, 0.0, 0.0), ValueError, "got 8"),
    "rates of another shape": (
        lambda: _core.space_triples(RATES[:, :, :2], SERIES, 2.0, 1, 6, 6, 1e4),
        ValueError,
        "rates must have 3 entries along axis 2, got 2",
    ),
    "halvings beyond": (
        lambda: _core.space_triples(RATES, SERIES, 2.0, 1, 61, 6, 1e4),
        ValueError,
        "halvings must be from 0 to 60, got 61",
    ),
    "nodes that no lanes hold": (
        lambda: _core.sweep_between(CHAIN, FACTOR[:1].repeat(7, axis=0).T.copy()),
        ValueError,
        "nodes must be a multiple of 8 up to 64, got 7",
    ),
    "values of another chain": (
        lambda: _core.sweep(
            CHAIN,
            FACTOR.T.copy(),
            PORT,
            PORT,
            (np.tile(FACTOR, (8, 1)).T.copy(), np.ones((3, 2, 8 * len(FACTOR))), np.ones((1, 1))),
        ),
        ValueError,
        "values must have 0 entries along axis 0, got 3",
    ),
    "no equal parts": (
        lambda: _core.space_triples(RATES, SERIES, 2.0, 0, 6, 6, 1e4),
        ValueError,
        "equal must be from 1 to 131072, got 0",
    ),
    "doublings below 0": (
        lambda: _core.space_triples(RATES, SERIES, 2.0, 1, 6, -1, 1e4),
        ValueError,
        "doublings must be from 0 to 60, got -1",
    ),
    "halvings of a piece below 0": (
        lambda: _core.space_count(
            (SPACE[0], SPACE[1] - 100, *SPACE[2:]), PLANE[:1], np.ones(1), SCALE[:1]
        ),
        ValueError,
        "halvings must be from 0 to 60, got -",
    ),
    "nodes of a piece beyond its halvings": (
        lambda: _core.space_count(
            (*SPACE[:2], SPACE[2] + 24, *SPACE[3:]), PLANE[:1], np.ones(1), SCALE[:1]
        ),
        ValueError,
        r"nodes must be from 1 to 24 and at most the parts of all halvings, got 25",
    ),
    "series of more nodes than parts": (
        lambda: _core.space_triples(RATES, np.tile(SERIES, (3, 1, 1)), 2.0, 1, 1, 1, 1e4),
        ValueError,
        r"series must be from 1 to 24 and at most the parts of all halvings, got 3",
    ),
    "pieces without inertia": (
        lambda: _core.space_count(
            (*SPACE[:5], SPACE[5][:, 1:], *SPACE[6:]), PLANE[:1], np.ones(1), SCALE[:1]
        ),
        ValueError,
        "inertia must have 1 entries along axis 1, got 0",
    ),
    "nodes without masses": (
        lambda: _core.space_count(
            (*SPACE[:8], SPACE[8][:, 1:], *SPACE[9:]), PLANE[:1], np.ones(1), SCALE[:1]
        ),
        ValueError,
        "mass must have 2 entries along axis 1, got 1",
    ),
    "a scale for each eigenvalue": (
        lambda: _core.space_count(SPACE, PLANE[:1], np.ones(1), SCALE),
        ValueError,
        "scale must have 1 entries along axis 0, got 2",
    ),
    "a component beyond": (
        lambda: _core.space_count(SPACE, PLANE + 1, np.ones(2), SCALE),
        ValueError,
        r"component must lie in 0 ... 1, got 2",
    ),
    "matrices of four coordinates": (
        lambda: _core.space_factor(*(one[..., :4, :4] for one in BLOCKS), FIXED, False),
        ValueError,
        "D must be matrices of 3 or 6 rows, got 4",
    ),
    "factors of other bands": (
        lambda: _core.space_solve(FACTORED[0][:, :, 1:], FACTORED[1], SOLVED),
        ValueError,
        "factors must be those of 3 or 6 coordinates",
    ),
    "responses of fewer rows": (
        lambda: _core.space_respond(*BLOCKS, FIXED, False, SOLVED[:, :, :5]),
        ValueError,
        "right must have 18 entries along axis 2, got 5",
    ),
    "vectors of fewer rows": (
        lambda: _core.space_apply(*BLOCKS, FIXED, False, SOLVED[:, :, :5]),
        ValueError,
        "vectors must have 18 entries along axis 2, got 5",
    ),
    "iterated vectors of fewer rows": (
        lambda: _core.space_iterate(*BLOCKS, FIXED, False, *FACTORED, SOLVED[:, :, :5], 2),
        ValueError,
        "vectors must have 18 entries along axis 2, got 5",
    ),
    "iterations of other factors": (
        lambda: _core.space_iterate(
            *BLOCKS, FIXED, False, FACTORED[0][:, :5], FACTORED[1], SOLVED, 2
        ),
        ValueError,
        "factors must have 18 entries along axis 1, got 5",
    ),
    "fewer than no iterations": (
        lambda: _core.space_iterate(*BLOCKS, FIXED, False, *FACTORED, SOLVED, -1),
        ValueError,
        "times must be from 0 to 60, got -1",
    ),
    "a rope of nine arrays": (
        lambda: _core.space_count(SPACE[:9], PLANE[:1], np.ones(1), SCALE[:1]),
        TypeError,
        "11 arguments",
    ),
    "nodes of other parts": (
        lambda: _core.space_factor(*BLOCKS[:3], BLOCKS[0], FIXED, False),
        ValueError,
        "N must have 2 entries along axis 1, got 1",
    ),
    "fixed rows of other parts": (
        lambda: _core.space_factor(*BLOCKS, FIXED[:, 1:], False),
        ValueError,
        "fixed must have 18 entries along axis 1, got 17",
    ),
    "right sides of fewer rows": (
        lambda: _core.space_solve(*FACTORED, SOLVED[:, :, :5]),
        ValueError,
        "right must have 18 entries along axis 2, got 5",
    ),
    "element -1": (
        lambda: _core.triple(CHAIN, -1, FACTOR.T[:2].copy()),
        ValueError,
        r"element must lie in 0 ... \d, got -1",
    ),
    "element beyond": (
        lambda: _core.triple(CHAIN, len(CHAIN.length), FACTOR.T[:2].copy()),
        ValueError,
        f"got {len(CHAIN.length)}",
    ),
    "a law that is neither called nor a power": (
        lambda: _core.collocate(
            COLLOCATED[0], (np.array([2, 0], np.int32), *COLLOCATED[1][1:]), *COLLOCATED[2:]
        ),
        ValueError,
        r"kind\[0\] must be 0, or 1 of what is called, got 2",
    ),
    "stages too many": (
        lambda: _core.collocate(
            (0.1, np.ones(65), *COLLOCATED[0][2:]), COLLOCATED[1], *COLLOCATED[2:]
        ),
        ValueError,
        "node must hold 1 to 64 stages, got 65",
    ),
    "known motion of other steps": (
        lambda: _core.collocate(*COLLOCATED[:3], COLLOCATED[3][1:], *COLLOCATED[4:]),
        ValueError,
        "known must have 2 entries along axis 0, got 1",
    ),
    "a law of the core that there is not": (
        lambda: _core.volterra(
            (np.array([0, 3], np.int32), *VOLTERRA[0][1:]),
            *VOLTERRA[1:],
            np.zeros((2, 2)),
            np.zeros((2, 3)),
            np.zeros(2),
            0,
            2,
        ),
        ValueError,
        r"kind\[1\] must be 0, 1, or 2 of what is called, got 3",
    ),
    "forces that cannot go on in place": (
        lambda: _core.volterra(
            *VOLTERRA, np.zeros((2, 2), np.float32), np.zeros((2, 3)), np.zeros(2), 0, 2
        ),
        ValueError,
        "force must be a writable array of float64 in C order",
    ),
    "more steps than there are": (
        lambda: _core.volterra(*VOLTERRA, np.zeros((2, 2)), np.zeros((2, 3)), np.zeros(2), 0, 3),
        ValueError,
        r"steps must lie in 0 \.\.\. 2, got 0 to 3",
    ),
    "harmonics of no point": (
        lambda: _core.balance(BALANCED[0][:, :, :0], *BALANCED[1:]),
        ValueError,
        "transfer must hold harmonics of points by points and more, got 2 of 0 by 2",
    ),
    "too few coefficients": (
        lambda: _core.balance(BALANCED[0], BALANCED[1][..., :2], *BALANCED[2:]),
        ValueError,
        "by_u must hold 3 coefficients at least, got 2",
    ),
    "slopes of other motions": (
        lambda: _core.balance(*BALANCED[:2], BALANCED[2][:1], BALANCED[3]),
        ValueError,
        "by_v must have 2 entries along axis 0, got 1",
    ),
    "frequencies of other motions": (
        lambda: _core.balance(*BALANCED[:3], BALANCED[3][1:]),
        ValueError,
        "omega must have 2 entries along axis 0, got 1",
    ),
    "a period of no sample": (
        lambda: _core.stopped(*STRUCK[:4], STRUCK[4][:, :0], STRUCK[5]),
        ValueError,
        "u must hold a sample at least, got none",
    ),
    "velocities of other samples": (
        lambda: _core.stopped(*STRUCK[:5], STRUCK[5][:, :1]),
        ValueError,
        "v must have 2 entries along axis 1, got 1",
    ),
    "guards of other rates": (
        lambda: _core.first_crossing(GUARDS[0][:0], *GUARDS[1:], 1.0),
        ValueError,
        "c must have 0 entries along axis 1, got 1",
    ),
    "more rates that grow than rates": (
        lambda: _core.first_crossing(
            *GUARDS[:2], np.zeros((2, 3), dtype=complex), *GUARDS[3:], 1.0
        ),
        ValueError,
        "d must have as many rates as rate at most, 1, and a one power at least, got 3 and 1",
    ),
    "guards without a power": (
        lambda: _core.first_crossing(*GUARDS[:3], GUARDS[3][:, :0], GUARDS[4], 1.0),
        ValueError,
        "a one power at least, got 1 and 0",
    ),
    "scales of other guards": (
        lambda: _core.first_crossing(*GUARDS[:4], GUARDS[4][:1], 1.0),
        ValueError,
        "scale must have 2 entries along axis 0, got 1",
    ),
    "guards that overflow": (
        lambda: _core.first_crossing(*GUARDS[:4], np.full(2, np.inf), 1.0),
        rd.SolveError,
        "the numbers overflow: check the units and the times",
    ),
    "a block of a kind there is not": (
        lambda: _core.recurrence(*STEPPED[:4], STEPPED[4] + 1, *STEPPED[5:]),
        ValueError,
        r"kind\[1\] must be from 0 to 1, got 2",
    ),
    "a block of a kind below 0": (
        lambda: _core.recurrence(*STEPPED[:4], STEPPED[4] - 1, *STEPPED[5:]),
        ValueError,
        r"kind\[0\] must be from 0 to 1, got -1",
    ),
    "samples too few": (
        lambda: _core.recurrence(*STEPPED[:5], STEPPED[5][1:], STEPPED[6]),
        ValueError,
        "sample must have 7 entries along axis 0, got 6",
    ),
    "state of other modes": (
        lambda: _core.recurrence(*STEPPED[:6], STEPPED[6][1:]),
        ValueError,
        "state must have 2 entries along axis 0, got 1",
    ),
    "changes of three parts": (
        lambda: _core.recurrence(STEPPED[0][:, :, 1:], *STEPPED[1:]),
        ValueError,
        "change must have 4 entries along axis 2, got 3",
    ),
    "pushes too few": (
        lambda: _core.recurrence(STEPPED[0], STEPPED[1][:, :, 1:], *STEPPED[2:]),
        ValueError,
        "gain must have 3 entries along axis 2, got 2",
    ),
    "blocks without samples": (
        lambda: _core.recurrence(*STEPPED[:2], STEPPED[2][:, :0], *STEPPED[3:]),
        ValueError,
        "read must have from 1 to 64 samples of a block, got 0",
    ),
    "spans of no length": (
        lambda: _core.divide(DIVIDED[0][::-1], *DIVIDED[1:]),
        ValueError,
        "station and elements must make elements of span 0",
    ),
    "a span without elements": (
        lambda: _core.divide(DIVIDED[0], DIVIDED[1] - 1, *DIVIDED[2:]),
        ValueError,
        "station and elements must make elements of span 1",
    ),
    "stations too few": (
        lambda: _core.divide(DIVIDED[0][1:], *DIVIDED[1:]),
        ValueError,
        "station must have 4 entries along axis 0, got 3",
    ),
    "ropes too few": (
        lambda: _core.divide(*DIVIDED[:2], DIVIDED[2][1:], DIVIDED[3]),
        ValueError,
        "rope must have 3 entries along axis 0, got 2",
    ),
    "more nodes than are numbered": (
        lambda: _core.divide(DIVIDED[0], DIVIDED[1] << 30, *DIVIDED[2:]),
        MemoryError,
        "",
    ),
    "matrix that is not square": (lambda: _core.invert(np.ones((2, 3))), ValueError, "square"),
    "matrix of three axes": (lambda: _core.invert(np.ones((2, 2, 2))), ValueError, ""),
    "matrix of one axis": (lambda: _core.invert(np.ones(4)), ValueError, ""),
    "matrix complex": (lambda: _core.invert(MATRIX * 1j), TypeError, "cast"),
    "matrix indefinite": (lambda: _core.invert(-MATRIX), rd.SceneError, "not positive definite"),
    "matrix of nan": (lambda: _core.invert(MATRIX * math.nan), rd.SceneError, "not positive"),
    "section of none": (lambda: _core.section(None, 1.0, 1.0, 0.0, 0.0), TypeError, ""),
    "section indefinite": (
        lambda: _core.section(1.0, 1.0, 1.0, 2.0, 0.0),
        rd.SceneError,
        "not positive definite",
    ),
}
# positions inside an element are promised to the core, which asserts them
LENGTHS = {"-1": -1.0, "beyond": 2.0, "nan": math.nan, "inf": math.inf}
for name, s in LENGTHS.items():
    REFUSED |= {
        f"shape at {name}": (lambda s=s: _core.shape(CHAIN, 0, s), ValueError, "s must"),
        f"local at {name}": (lambda s=s: _core.local(CHAIN, 0, s, 0.0), ValueError, "s must"),
        f"local from {name}": (lambda s=s: _core.local(CHAIN, 0, 0.0, s), ValueError, "p must"),
    }
REFUSED |= {
    "coupled modes under laws of a kind there is not": (
        lambda: coupled(laws=(LAW_NUMBERS[0] + 2, LAW_NUMBERS[1], (None, None))),
        ValueError,
        r"kind\[0\] must be 0, 1, or 2 of what is called, got 2",
    ),
    "coupled modes under laws of a list": (
        lambda: coupled(laws=[*LAW_NUMBERS, (None, None)]),
        TypeError,
        "must be",
    ),
    "coupled modes with a form of fewer": (
        lambda: coupled(form=np.eye(2)),
        ValueError,
        "form must have 3 entries",
    ),
    "coupled modes with a drag of fewer": (
        lambda: coupled(drag=np.eye(2)),
        ValueError,
        "drag must have 3 entries",
    ),
    "coupled modes that are known at fewer times": (
        lambda: coupled(known=np.ones((2, 3))),
        ValueError,
        "known must have 3 entries",
    ),
    "coupled modes of a state of integers": (
        lambda: coupled(state=np.zeros((3, 2, 3), dtype=int)),
        ValueError,
        "state must be a writable array",
    ),
    "coupled modes of a state that cannot be written": (
        lambda: coupled(state=still(np.zeros((3, 2, 3)))),
        ValueError,
        "state must be a writable array",
    ),
}
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0).compile(elements=2, element="rigid").chain
REFUSED |= {
    f"string with tension {tension}": (
        lambda tension=tension: _core.triples(STRING._replace(tension=np.array([tension]))),
        (ValueError, rd.SolveError),
        "tension",
    )
    for tension in (0.0, -1.0)
}


for what, (chain, error, message) in MALFORMED.items():
    given = tuple(chain) if isinstance(chain, type(CHAIN)) else chain
    for entry, call in ENTRIES.items():
        REFUSED[f"{what}-{entry}"] = (lambda c=call, g=given: c(g), error, message)

# malformed continuous chains
SPOILT = {
    "inertia missing": (
        SPAN._replace(inertia=None),
        ValueError,
        "continuous elements and no others",
    ),
    "inertia of others": (SPAN._replace(kind=2), ValueError, "continuous elements and no others"),
    "inertia of text": (SPAN._replace(inertia="abc"), (TypeError, ValueError), ""),
    "inertia a number": (SPAN._replace(inertia=1.0), (TypeError, ValueError), ""),
    "inertia complex": (swapped("inertia", lambda a: a + 0j, SPAN), TypeError, "cast"),
    "inertia of objects": (swapped("inertia", lambda a: a.astype(object), SPAN), TypeError, "cast"),
    "inertia with an axis more": (swapped("inertia", lambda a: a[..., None], SPAN), ValueError, ""),
    "inertia with an axis less": (swapped("inertia", lambda a: a[0], SPAN), ValueError, ""),
    "inertia too short": (
        swapped("inertia", lambda a: a[1:], SPAN),
        ValueError,
        "inertia must have 2 entries along axis 0, got 1",
    ),
    "inertia too narrow": (
        swapped("inertia", lambda a: a[:, 1:], SPAN),
        ValueError,
        "inertia must have 3 entries along axis 1, got 2",
    ),
    "inertia negative": (
        put("inertia", -1e-300, at=4, chain=SPAN),
        ValueError,
        r"inertia\[1, 1\] must be >= 0",
    ),
    "inertia of nan": (put("inertia", math.nan, chain=SPAN), ValueError, r"inertia\[0, 0\] must"),
    # nodes 1 and 2 with the mass of node 1, with the spring, and with the hinge of node 2
    **{
        f"{what} inside a stretch": (
            SPAN._replace(
                first=np.array([0, 1, 3], np.int32),
                element=np.array([0, 1], np.int32),
                term=np.array([0, term, 3], np.int32),
                **bare,
            ),
            ValueError,
            "nothing may stand inside continuous stretches",
        )
        for what, term, bare in (
            ("mass", 1, {}),
            ("spring", 2, {"hinge": None}),
            ("hinge", 2, {"stiffness": SPAN.stiffness * 0}),
            ("support", 0, {}),
        )
    },
}
for what, (chain, error, message) in SPOILT.items():
    for entry, call in SPANS.items():
        REFUSED[f"continuous: {what}-{entry}"] = (
            lambda c=call, g=tuple(chain): c(g),
            error,
            message,
        )
# what reads massless elements
REFUSED |= {
    f"continuous-{entry}": (
        lambda c=call: c(SPAN),
        ValueError,
        f"{entry} needs inertia lumped at the nodes",
    )
    for entry, call in ENTRIES.items()
    if entry not in SPANS
}

# arrays of the right form with numbers that no rope has: answered or refused
MEANINGLESS = {
    f"{field} {value}-{entry}": lambda c=call, f=field, v=value: c(
        swapped(f, lambda a: np.full_like(a, v))
    )
    for field in ("length", "tension", "flexibility", "mass", "stiffness")
    for value in (math.nan, math.inf, -math.inf, 0.0, -1.0, 1e308, 5e-324)
    for entry, call in ENTRIES.items()
}
# and the same of continuous chains, where waves may be without number
MEANINGLESS |= {
    f"continuous {field} {value}-{entry}": lambda c=call, f=field, v=value: c(
        swapped(f, lambda a: np.full_like(a, v), SPAN)
    )
    for field in ("length", "tension", "flexibility", "inertia", "mass", "stiffness", "hinge")
    for value in (math.nan, math.inf, -math.inf, 0.0, -1.0, 1e50, 1e308, 1e-300, 5e-324)
    for entry, call in SPANS.items()
}
MEANINGLESS |= {
    f"continuous lambda {value}": lambda v=value: _core.count(SPAN, np.array([v]))
    for value in (math.nan, math.inf, -math.inf, 1e308, -1e308)
}
MEANINGLESS |= {
    f"continuous factor {value}-{entry}": lambda v=value, e=entry: (
        _core.sweep(SPAN, np.full((5, 3), v, complex), PORT, PORT)
        if e == "sweep"
        else _core.triple(SPAN, 0, np.full((5, 3), v, complex))
        if e == "triple"
        else _core.steps(SPAN, np.full((5, 3), v, complex))
    )
    for value in (math.nan, math.inf, complex(0, math.nan), 0.0, 1e200)
    for entry in ("sweep", "steps", "triple")
}
MEANINGLESS |= {
    f"modes below {below} with scale {scale}": lambda b=below, s=scale: _core.modes(CHAIN, 0, b, s)
    for below in (math.nan, math.inf, -1.0, 1e308)
    for scale in (math.nan, math.inf, 0.0, -1.0)
}
MEANINGLESS |= {
    f"factor {value}": lambda v=value: _core.frf(CHAIN, np.full((3, 5), v, complex), PORT, PORT)
    for value in (math.nan, math.inf, complex(0, math.nan), 0.0)
}
CALLS = {name: call for name, (call, _, _) in REFUSED.items()} | MEANINGLESS


def python(code, *, check=True):
    command = [sys.executable, "-W", "error", "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=check, timeout=120)


# one line of JSON for each call: its name, the names of the error's classes, the message
EACH = """
import json, sys
sys.path.insert(0, {tests!r})
import test_glue as glue

for name in list(glue.CALLS)[{start}:]:
    kinds, message = [], ""
    try:
        glue.CALLS[name]()
    except BaseException as error:
        kinds, message = [kind.__name__ for kind in type(error).__mro__], str(error)
    print(json.dumps([name, kinds, message]), flush=True)
"""


@pytest.fixture(scope="module")
def outcomes():
    """Errors of every call, made in another process: a crash ends one call, not the tests."""
    found, printed = {}, []
    while len(found) < len(CALLS):
        done = python(EACH.format(tests=str(Path(__file__).parent), start=len(found)), check=False)
        lines = done.stdout.splitlines()
        answers = [json.loads(line) for line in lines if line.startswith("[")]
        printed += [line for line in lines if not line.startswith("[")] + done.stderr.splitlines()
        found |= {name: (kinds, message) for name, kinds, message in answers}
        if len(found) < len(CALLS):
            found[list(CALLS)[len(found)]] = (["crash"], f"{done.returncode} {done.stderr}")
    return found, printed


def by_entry(calls):
    """Names of calls by the entry point that they end in; the others are of arguments."""
    found = {}
    for name in calls:
        entry = name.rpartition("-")[2]
        found.setdefault(entry if entry in ENTRIES else "arguments", []).append(name)
    return [pytest.param(names, id=entry) for entry, names in found.items()]


@pytest.mark.parametrize("names", by_entry(REFUSED))
def test_malformed_input_is_refused_and_never_a_crash(names, outcomes):
    wrong = {}
    for name in names:
        _, errors, message = REFUSED[name]
        kinds, text = outcomes[0][name]
        expected = errors if isinstance(errors, tuple) else (errors,)
        if not {error.__name__ for error in expected} & set(kinds) or not re.search(message, text):
            wrong[name] = kinds[:1], text
    assert not wrong


@pytest.mark.parametrize("names", by_entry(MEANINGLESS))
def test_numbers_without_meaning_end_in_numbers_or_a_refusal(names, outcomes):
    ended = {name: outcomes[0][name] for name in names}
    refused = {"RopedynError", "ValueError"}
    assert not {name: end for name, end in ended.items() if end[0] and not refused & set(end[0])}


def test_nothing_is_printed_on_errors(outcomes):
    assert outcomes[1] == []


@pytest.mark.parametrize("drives", [0, 1, 3])
@pytest.mark.parametrize("responses", [0, 1, 3])
@pytest.mark.parametrize("frequencies", [0, 1, 2])
def test_frf_answers_as_many_as_it_was_asked(frequencies, drives, responses):
    ports = [(np.repeat(NODE, n), np.repeat(ROW, n, axis=0)) for n in (drives, responses)]
    value, rounding, motion, solved = _core.frf(CHAIN, FACTOR[:frequencies], *ports)
    assert value.shape == rounding.shape == (frequencies, drives, responses)
    assert motion.shape == (frequencies, drives)
    assert solved == frequencies


def test_no_shapes_have_no_energies():
    strain, kinetic, dragged = _core.energy(CHAIN, SHAPES[:0], np.ones(0))
    assert (len(strain), len(kinetic), len(dragged)) == (0, 0, 0)


def other_order(array):
    return np.asfortranarray(array)


def with_gaps(array):
    wide = np.zeros((*array.shape, 2), dtype=array.dtype)
    wide[..., 0] = array
    return wide[..., 0]


def other_bytes(array):
    return array.astype(array.dtype.newbyteorder())


def unaligned(array):
    raw = np.zeros(array.nbytes + 1, dtype=np.uint8)
    view = raw[1:].view(array.dtype).reshape(array.shape)
    view[...] = array
    return view


LAYOUTS = [other_order, with_gaps, other_bytes, unaligned]


@pytest.mark.parametrize(("entry", "chain"), TRIED, ids=TRIED_IDS)
@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.__name__)
def test_layout_of_arrays_in_memory_does_not_matter(layout, entry, chain):
    fields = FIELDS if chain is CHAIN else (*FIELDS, "inertia")
    laid_out = chain._replace(**{f: layout(getattr(chain, f)) for f in fields})
    call = call_of(entry, chain)
    assert flat(call(laid_out)) == flat(call(chain))


def test_the_core_leaves_its_arguments_alone():
    def given():
        return [np.array(a) for a in (*CHAIN, *SPAN, FACTOR, *PORT, FORCE, SHAPES, MATRIX)]

    before = given()
    for call in (*ENTRIES.values(), *OTHERS.values()):
        call(CHAIN)
    for call in SPANS.values():
        call(SPAN)
    assert flat(tuple(before)) == flat(tuple(given()))


# memory

# one line of JSON for each entry point: how many calls failed, whether the last did, bytes grown
OUT_OF_MEMORY = """
import gc, json, sys, tracemalloc
import _testcapi
sys.path.insert(0, {tests!r})
import test_glue as glue

chain = glue.{chain}

def failed(call, expected, start, stop):
    # the allocations from start to stop fail; from start on where stop is 0
    _testcapi.set_nomemory(start, stop)
    try:
        answer = call(chain)
    except MemoryError:
        answer = None
    finally:
        _testcapi.remove_mem_hooks()
    if answer is not None:
        assert glue.flat(answer) == expected
    return answer is None

def sweep(call, expected, allocations):
    once = [failed(call, expected, start, start + 1) for start in range(allocations)]
    on = [failed(call, expected, start, 0) for start in range(allocations)]
    return once, on

def counts():
    return [sys.getrefcount(a) for a in (*chain[1:], *glue.PORT, glue.FACTOR, glue.FORCE)]

for entry in {entries!r}:
    print(entry, flush=True)  # so that a crash says where
    call = glue.call_of(entry, chain)
    expected = glue.flat(call(chain))
    tracemalloc.start()
    once, on = sweep(call, expected, 80)  # and warm up
    # none fails after the last that failed now
    allocations = 1 + max(k for k in range(80) if once[k] or on[k])
    sweep(call, expected, allocations)
    gc.collect()
    references, used = counts(), tracemalloc.get_traced_memory()[0]
    for _ in range(10):
        sweep(call, expected, allocations)
    gc.collect()
    # a reference leaked by each failure would be hundreds; Python itself takes a None and gives it
    extra = [now - before for now, before in zip(counts(), references)]
    assert all(abs(more) < 10 for more in extra), (entry, extra)
    grown = tracemalloc.get_traced_memory()[0] - used
    tracemalloc.stop()
    print(json.dumps([sum(once), sum(on), once[-1], on[-1], grown]))
"""


@pytest.mark.parametrize(
    ("chain", "entries"),
    [("CHAIN", [*ENTRIES, *OTHERS]), ("SPAN", [*SPANS])],
    ids=["lumped", "continuous"],
)
def test_a_failing_allocation_is_a_memory_error_and_leaks_nothing(chain, entries):
    pytest.importorskip("_testcapi")
    tests = str(Path(__file__).parent)
    done = python(OUT_OF_MEMORY.format(tests=tests, chain=chain, entries=entries), check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    lines = done.stdout.splitlines()
    assert lines[::2] == entries
    for entry, line in zip(entries, lines[1::2]):
        once, on, last_once, last_on, grown = json.loads(line)
        assert once > 0, entry
        assert on > 0, entry
        # the range covers every allocation of the entry point: past the last, nothing fails
        assert not (last_once or last_on), entry
        # ten sweeps with some ten failures each: a leaked array object a failure, at some 100
        # bytes, would be 10 kB; what is left is that of the measurement itself
        assert grown < 1000, entry


def test_a_matrix_larger_than_memory_is_a_memory_error():
    # (4 million unknowns)^2 in one block: 128 TB, which is more than an address space has
    nodes = 4_000_001
    chain = STRING._replace(
        first=np.array([0, nodes - 1], np.int32),
        element=np.zeros(1, np.int32),
        term=np.ones(2, np.int32),
    )
    with pytest.raises(MemoryError):
        _core.modes(chain, 1, 0.0, 1.0)


# signals and threads


def long_model():
    return rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0)).compile(elements=500, element="rigid")


@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(), reason="signals need it"
)
def test_ctrl_c_stops_a_long_frf():
    model = long_model()
    start = time.process_time()
    model.frf(np.linspace(1, 50, 2000), drive=("z", 0.5))
    each = (time.process_time() - start) / 2000
    count = int(20 / each)  # some 20 s of the processor if nothing stops it

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        start = time.process_time()
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            model.frf(np.linspace(1, 50, count), drive=("z", 0.5))
        used = time.process_time() - start
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    # what others use of the machine does not count: 0.2 s of two threads until the alarm, and
    # measured, 0.6 s for the arrays of so many frequencies
    assert used < 2


@pytest.mark.skipif(
    threading.current_thread() is not threading.main_thread(), reason="signals need it"
)
def test_ctrl_c_stops_a_long_search_for_damped_modes():
    # every element another, so that each walk takes some 10 ms, and hundreds of rates
    chain = long_model().chain
    count = 20_000
    chain = chain._replace(
        length=np.full(count, 1e-4),
        tension=np.full(count, chain.tension[0]),
        flexibility=np.repeat(chain.flexibility[:1], count, axis=0),
        element=np.arange(count, dtype=np.int32),
        first=np.arange(count + 1, dtype=np.int32),
        term=np.full(count + 1, chain.term[1], dtype=np.int32),
    )

    def interrupt(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        start = time.perf_counter()
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        with pytest.raises(KeyboardInterrupt):
            _core.damped(chain, CONSTANT, SLOPE, 0.0, 1e4, np.inf, np.inf, np.zeros(0, complex))
        waited = time.perf_counter() - start - 0.2
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    # a look each 50 ms or walk; twenty times as long on a busy machine
    assert waited < 1


def test_an_exception_from_a_signal_handler_is_passed_on():
    class Alarm(Exception):
        pass

    def alarm(*_):
        raise Alarm

    before = signal.signal(signal.SIGALRM, alarm)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(Alarm):
            long_model().frf(np.linspace(1, 50, 100_000), drive=("z", 0.5), solver="lapack")
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


BIG = long_model().chain
BUSY = {
    # each works for some tenth of a second or more without a look at Python
    "frf": lambda: _core.frf(
        BIG,
        np.tile(FACTOR[:1], (500, 1)),
        (np.zeros(1, np.int32), np.ones((1, 2, 2))),
        (np.zeros(1, np.int32), np.ones((1, 2, 2))),
    ),
    "modes": lambda: _core.modes(BIG, 3, 0.0, 1.0),
}


@pytest.mark.parametrize("entry", BUSY)
def test_other_threads_run_while_the_core_works(entry):
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(1e-4)

    clock = threading.Thread(target=tick)
    clock.start()
    try:
        start = time.perf_counter()
        BUSY[entry]()
        stop = time.perf_counter()
    finally:
        done.set()
        clock.join()
    # with the GIL held no tick could fall into the call; at its ends a switch may
    quarter = (stop - start) / 4
    assert quarter > 5e-3  # longer than Python's switch interval: otherwise this shows nothing
    assert any(start + quarter < t < stop - quarter for t in ticks)


QUESTIONS = {
    "modes": lambda model: model.modes(5),
    "frf": lambda model: model.frf(np.linspace(0, 80, 200), drive=("z", 0.33)),
    "static": lambda model: model.static({("z", 0.33): 1.0}),
    "stiffness": lambda _: LINEAR.stiffness_matrix().data,
    "triples": lambda model: tuple(model.triples),
}


def bits(answer):
    """Bytes of every array of an answer but its cost."""
    if not isinstance(answer, rd.Answer):
        return flat(answer)
    values = [v for item, v in leaves(answer, {}) if item.name != "cost"]
    return flat(tuple(x for v in values for x in (v.values() if isinstance(v, dict) else (v,))))


@pytest.mark.parametrize("question", QUESTIONS)
def test_the_same_question_has_the_same_bits(question):
    ask = QUESTIONS[question]
    assert (
        bits(ask(MODEL))
        == bits(ask(MODEL))
        == bits(ask(SCENE.compile(elements=8, element="rigid")))
    )


@pytest.mark.parametrize("question", QUESTIONS)
def test_eight_threads_share_a_model_and_get_the_same_bits(question):
    ask = QUESTIONS[question]
    alone = bits(ask(MODEL))
    start = threading.Barrier(8)

    def together(_):
        start.wait()
        return [bits(ask(MODEL)) for _ in range(4)]

    with ThreadPoolExecutor(8) as threads:
        for answers in threads.map(together, range(8)):
            assert answers == [alone] * 4


# the shared object


def test_one_symbol_is_exported():
    nm = shutil.which("nm")
    if nm is None:
        pytest.skip("nm is not installed")
    command = [nm, "-D", "--defined-only", _core.__file__]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert [line.split()[-1] for line in listed.splitlines()] == ["PyInit__core"]


def test_the_module_can_be_imported_again():
    code = """
import sys, importlib
import ropedyn, ropedyn._core
first = sys.modules.pop("ropedyn._core")
second = importlib.import_module("ropedyn._core")
try:
    second.section(1.0, 1.0, 1.0, 2.0, 0.0)
except ropedyn.SceneError as error:
    print(second is not first, error)
"""
    assert python(code).stdout.startswith("True a section flexibility")
