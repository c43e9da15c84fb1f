"""Helpers of the tests: reference numbers and matrices for reading."""

# isort: off
import os

# a worker has one core: more threads of BLAS would wait for each other's (read when it is loaded)
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# isort: on

import gc
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest
import stored
from claims import claim  # noqa: F401 - a fixture
from hypothesis import settings
from validation import Recorder

import ropedyn as rd

# the tests start Python some sixty times: let it compile once what each of them imports
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)

# the same examples in every run; a slow machine is no failure
settings.register_profile("ropedyn", max_examples=40, deadline=None, derandomize=True)
settings.register_profile("search", max_examples=1500, deadline=None)
settings.load_profile("ropedyn")

LONGEST = (
    "test_c_tests_pass",
    "test_code_of_an_effect_runs_only",
    *(f"test_notebook_runs[{name}]" for name in ("accuracy", "time", "effects")),
    "test_notebook_runs",
    "test_figures_are_drawn",
)
"""Names of tests of seconds, the longest first."""
KNOWN_LONG = frozenset(
    (Path(__file__).parent / "long.txt").read_text(encoding="utf-8").splitlines()
)
"""Tests that tests/long_tests.py has found to take more than 0.02 s."""
EPS = float(np.finfo(float).eps)
LENGTH, BENDING, MASS = 1.35, 54.626, 0.13725
"""Of the beam in the reference files [m, N m^2, kg]."""
LAID = rd.Rope(
    1.0,
    0.1,
    bending_stiffness=5.0,
    torsional_stiffness=1.0,
    axial_stiffness=900.0,
    lay_coupling=-12.0,
    lay_slope=0.3,
    rotary_inertia=1e-5,
    polar_inertia=1e-6,
)
"""A rope with every coordinate, all of them coupled, with stiffness and inertia in each."""
EVERYTHING = rd.Scene(
    LAID.replace(length=1.3),
    tension=300.0,
    ends=(rd.End(beta="free", spring={"beta": 5.0}), rd.End(z="free", spring={"z": 2e3})),
    parts=[
        rd.PointMass(0.4, 0.02, rotary_inertia=1e-5, polar_inertia=1e-7),
        rd.Spring(0.7, 500.0),
        rd.Hinge(0.9, stiffness=20.0),
        rd.Hinge(0.9, stiffness=30.0),
        rd.Support(1.1),
    ],
)
"""Every coordinate moves, and what stands on the rope is held, springs back, weighs and bends."""


class KnownLong:
    """Leaves what is known to take long to the tests that do, doctests of the package too."""

    def pytest_itemcollected(self, item):
        if item.nodeid in KNOWN_LONG:
            item.add_marker(pytest.mark.long)


def pytest_configure(config):
    config.pluginmanager.register(Recorder(), "claims")
    config.pluginmanager.register(KnownLong())  # hooks of this file see what is beside it alone


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config, items):
    """Let every worker begin with its share of the longest tests: it is given an even part."""
    workers = getattr(config, "workerinput", {"workercount": 1})["workercount"]
    long = sorted((item for item in items if rank(item) is not None), key=rank)
    rest = [item for item in items if rank(item) is None]
    dealt, left = [], len(items)
    for k in range(workers):
        part = left // (workers - k)
        left -= part
        own = long[k::workers]
        dealt += own + rest[: part - len(own)]
        del rest[: part - len(own)]
    if len(dealt) == len(items):
        items[:] = dealt


def rank(item):
    """Place among the longest tests, or None."""
    return next((k for k, name in enumerate(LONGEST) if name in item.name), None)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Tell stored references whether the test is of a large sample."""
    stored.SESSION.large = item.get_closest_marker("slow") is not None


def pytest_sessionfinish(session):
    """Write the references that were computed, or hand them to the process that does."""
    if hasattr(session.config, "workeroutput"):
        session.config.workeroutput["references"] = stored.SESSION.used
    elif stored.SESSION.used:
        stored.write(whole=list(session.config.invocation_params.args) == stored.WHOLE)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node):
    """Take the references of a worker."""
    stored.merge(getattr(node, "workeroutput", {}).get("references", {}))


def slow(*values):
    """Return parameters that are part of the large sample alone."""
    return [pytest.param(value, marks=pytest.mark.slow) for value in values]


def samples(few, many):
    """Return the seeds of a small sample, and of the large one that is slow."""
    large = pytest.param(range(many), id="many", marks=pytest.mark.slow)
    return [pytest.param(range(few), id="few"), large]


def long(*values):
    """Return parameters that are left to the tests that take long."""
    return [pytest.param(value, marks=pytest.mark.long) for value in values]


def reference(name):
    """Read tests/reference/<name>.json; each file names its source."""
    return json.loads((Path(__file__).parent / "reference" / f"{name}.json").read_text())


def beam(elements, *, tension=0.0, ends=("clamped", "clamped"), rotary=True, **more):
    """Return the beam of the reference files, rotary inertia mu (L/n)^2/12 as there."""
    density = MASS / LENGTH
    turning = density * (LENGTH / elements) ** 2 / 12 if rotary else None
    rope = rd.Rope(LENGTH, density, bending_stiffness=BENDING, rotary_inertia=turning)
    return rd.Scene(rope, tension=tension, ends=ends, **more)


def pinned_rigid_chain(elements, wave, tension=0.0):
    """Return the two eigenvalues of k half waves on the pinned chain of `beam` [rad^2/s^2].

    With c = cos(k pi/n), tau = T a^2/B the amplitudes of z/a and beta obey
    [[24 (1 - c) + 2 tau (1 - c) - lambda, 12 s], [12 s, 8 + 4 c - lambda/12]], s = sin(k pi/n),
    whose determinant vanishes: ../shared/reference/rigid_chain_exact.json, pinned ends.
    """
    a = LENGTH / elements
    angle = wave * math.pi / elements
    versed = 2 * math.sin(angle / 2) ** 2
    tau = tension * a * a / BENDING
    p, q = (24 + 2 * tau) * versed, 12 * (12 - 4 * versed)
    # p q - 12 (12 s)^2 without cancellation: s^2 = versed (2 - versed)
    product = versed * versed * 576 + 2 * tau * versed * q
    half = (p + q) / 2
    large = half + math.sqrt(half * half - product)
    unit = BENDING / (MASS / LENGTH * a**4)
    return np.array([product / large, large]) * unit


def dense(model):
    """Return stiffness, mass and damping matrix as arrays."""
    return (
        model.stiffness_matrix().toarray(),
        model.mass_matrix().toarray(),
        model.damping_matrix().toarray(),
    )


def free(model):
    """Return which coordinates can move, shape (nodes, coordinates)."""
    return model.chain.held[model.chain.term_of] == 0


def pytest_collection_finish(session):
    """Spare the garbage collector what was collected, which lives as long as the run."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 20)
