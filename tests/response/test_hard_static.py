"""Static deflections by the sweep against the exact discrete system, widths 1 to 4."""

import itertools

import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import DIGITS, Exact, condition
from mpmath import mpf

import ropedyn as rd

LENGTH = 1.0
STRING = rd.Rope(LENGTH, 0.1)
BEAM = STRING.replace(bending_stiffness=2.0)
TWISTING = BEAM.replace(torsional_stiffness=0.7, lay_slope=1.0)
STRETCHING = TWISTING.replace(axial_stiffness=9e4, lay_coupling=-150.0)
ROPES = {"string": STRING, "beam": BEAM, "lay slope 1": TWISTING, "every coupling": STRETCHING}
SPRINGS = rd.End(z="free", spring={"z": 50.0})


ENDS = [("clamped", "free"), ("pinned", "pinned"), (SPRINGS, "clamped")]
ELEMENTS, TENSIONS = ("rigid", "tensed"), (2e-6, 40.0, 2e8)
N, NODE = 8, 3


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("ends", ENDS, ids=["cantilever", "pinned", "spring"])
@pytest.mark.parametrize("tension", TENSIONS)
@pytest.mark.parametrize("rope", ROPES)
@pytest.mark.claim(
    "Static deflection of strings, beams and laid ropes, T L^2/B from 1e-6 to 1e8: error over the "
    "largest of its coordinate / condition",
    reference="mpmath, 60 digits: tests/support/exact_chain.py",
    accepted=1e-13,
)
def test_static_deflection_is_that_of_the_exact_discrete_chain(rope, tension, ends, element, claim):
    n, node = N, NODE
    model = rd.Scene(ROPES[rope], tension=tension, ends=ends).compile(elements=n, element=element)
    moved = model.static({("z", model.x[node]): 1.0}, solver="sweep").displacement
    with mpmath.workdps(DIGITS):
        exact = Exact(model, model.component_of("z"))
        sensitive = condition(exact, mpf(0), ("z", node), ("z", node))
        for c in exact.coordinates:
            at = [(c, k) for k in range(n + 1)]
            u = exact.receptance(mpf(0), ("z", node), at)
            own = moved[:, model.coordinates.index(c)].tolist()
            largest = max(map(abs, u))
            error = max(abs(a - b) for a, b in zip(own, u))
            claim(float(error / largest / sensitive) if largest else float(error))


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
@pytest.mark.claim(
    "rounding_error of a static deflection over the true error, median over the nodes of 72 "
    "chains, none of which is beyond it",
    reference="mpmath, 60 digits: tests/support/exact_chain.py",
    accepted=10.0,
)
def test_rounding_error_bounds_deflections_and_is_no_useless_bound(solver, claim):
    ratios = []
    for rope, tension, ends, element in itertools.product(ROPES.values(), TENSIONS, ENDS, ELEMENTS):
        scene = rd.Scene(rope, tension=tension, ends=ends)
        model = scene.compile(elements=N, element=element)
        static = model.static({("z", model.x[NODE]): 1.0}, solver=solver)
        with mpmath.workdps(DIGITS):
            exact = Exact(model, model.component_of("z"))
            for c in exact.coordinates:
                u = exact.receptance(mpf(0), ("z", NODE), [(c, k) for k in range(N + 1)])
                k = model.coordinates.index(c)
                for mine, true, bound in zip(
                    static.displacement[:, k], u, static.rounding_error[:, k]
                ):
                    # what 60 digits leave of 0 is 0
                    error = float(abs(mine - mpmath.chop(true, 1e-50)))
                    assert error <= bound
                    if mine != 0:
                        ratios.append(bound / max(error, EPS / 2 * abs(mine)))
    claim(np.median(ratios))
