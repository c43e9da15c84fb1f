"""Static deflections by the sweep against the exact discrete system, widths 1 to 4."""

import mpmath
import pytest
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


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize(
    "ends",
    [("clamped", "free"), ("pinned", "pinned"), (SPRINGS, "clamped")],
    ids=["cantilever", "pinned", "spring"],
)
@pytest.mark.parametrize("tension", [2e-6, 40.0, 2e8])
@pytest.mark.parametrize("rope", ROPES)
@pytest.mark.claim(
    "Static deflection of strings, beams and laid ropes, T L^2/B from 1e-6 to 1e8: error over the "
    "largest of its coordinate / condition",
    reference="mpmath, 60 digits: tests/support/exact_chain.py",
    accepted=1e-13,
)
def test_static_deflection_is_that_of_the_exact_discrete_chain(rope, tension, ends, element, claim):
    n, node = 8, 3
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
