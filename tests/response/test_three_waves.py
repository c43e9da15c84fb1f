"""Spans of three waves in closed form: laid ropes, ropes that hang, and where waves are alike."""

import numpy as np
import pytest
from spans import BOUND, TWISTING, errors

import ropedyn as rd

EXACT = "mpmath, 60 digits: tests/support/exact_span.py"
ACCEPTED = 8e-14
"""Of the error over the condition, as of other spans: tests/response/test_continuous_frf.py."""
TENSION = 60.0
DAMPINGS = {"rayleigh": rd.RayleighDamping(2.0, 1e-5)}


def twisting(ratio, slope):
    """A laid rope whose twist is so many times as slow as its waves as a string."""
    rope = TWISTING.rope
    slowness = rope.linear_density / TENSION
    polar = ratio**2 * slowness * rope.torsional_stiffness
    return TWISTING.replace(rope=rope.replace(polar_inertia=polar, lay_slope=slope))


def hanging(tension, stiffness):
    """A cable of 100 m that sags."""
    rope = rd.Rope(100.0, 1.0, bending_stiffness=100.0, axial_stiffness=stiffness)
    return rd.Scene(rope, tension=tension, gravity=rd.Gravity())


# equal, nearly, far
@pytest.mark.parametrize("ratio", [1.0, 1.15, 4.0])
@pytest.mark.parametrize("slope", [0.01, 1.5])
@pytest.mark.claim(
    "FRF of continuous laid ropes whose twist is as fast as their bending, nearly and not, slopes "
    "of the lay from 0.01 to 1.5: error / condition",
    reference=EXACT,
    accepted=ACCEPTED,
)
def test_laid_rope_responds_as_the_continuum(ratio, slope, claim):
    scene = twisting(ratio, slope)
    for f in (2.0, 400.0):
        claim(max(errors(scene, f, ("z", 0.4), [("z", 0.9), ("alpha", 0.4)])))


@pytest.mark.parametrize("tension", [0.0, 6e3])
@pytest.mark.parametrize("damping", [None, "rayleigh"])
@pytest.mark.claim(
    "FRF of continuous laid ropes, damped and not, T L^2/B 0 and 4e3: error / condition",
    reference=EXACT,
    accepted=ACCEPTED,
)
def test_damped_laid_rope_responds_as_the_continuum(tension, damping, claim):
    scene = TWISTING.replace(tension=tension, damping=DAMPINGS.get(damping))
    for f in (0.3, 600.0):
        claim(max(errors(scene, f, ("z", 0.4), [("z", 0.9), ("alpha", 0.4)])))


@pytest.mark.parametrize("bending", [None, 0.2])
def test_waves_across_a_rope_whose_lay_only_twists_it_are_those_without_lay(bending):
    """Bit for bit: they were walked in thousands of pieces as if the lay coupled them."""
    rope = rd.Rope(10.4, 0.118, bending_stiffness=bending, torsional_stiffness=15.0)
    laid = rope.replace(axial_stiffness=1.2e5, lay_coupling=1.9, polar_inertia=1.3e-3)
    f, place = np.array([1.0, 40.0, 3e3, 1e5]), ("z", 2.1)
    lines = [
        rd.Scene(one, tension=142.0, damping=rd.RayleighDamping(0.9, 2.4e-7)).compile()
        for one in (laid, rope.replace(torsional_stiffness=None))
    ]
    across, plain = (one.frf(f, drive=place, response=place).value for one in lines)
    assert np.array_equal(across, plain)


@pytest.mark.parametrize("kl", [0.2, 1.8, 90.0])
@pytest.mark.parametrize(("tension", "stiffness"), [(2e3, 1e7), (1e5, 1e5)])
@pytest.mark.claim(
    "FRF of continuous cables that hang, 0.2 to 90 radians long: error / condition",
    reference=EXACT,
    accepted=BOUND,
)
def test_hanging_rope_responds_as_the_continuum(kl, tension, stiffness, claim):
    """All are within 2e-15 but x at the driven place, of EA = T and 0.2 radians: 2.8e-13.

    x(s) = N s/EA - kappa int_0^s z with N of x(L) = 0 is a difference of equal terms there: they
    cancel of a string at rest, and 1800 times here (41 times one metre beside, 3 times at 75 m).
    The error is 3 eps of either, as of all others; a condition that changes T, EA and inertia
    as wholes changes both alike and sees none of it.
    """
    scene = hanging(tension, stiffness)
    f = kl / 100.0 * tension**0.5 / (2 * np.pi)
    claim(max(errors(scene, f, ("z", 40.0), [("z", 75.0), ("x", 40.0)])))


def test_lines_beside_others_that_are_not_closed_keep_their_bits():
    model = hanging(1e4, 1e5).compile()
    # the first two are not; on the catenary, as higher up, all would be others
    f = np.array([0.01, 0.02, 0.1, 0.2, 0.5, 0.7])
    assert f.max() < model.highest
    together = model.frf(f, drive=("z", 40.0)).value
    alone = [model.frf(one, drive=("z", 40.0)).value[..., 0] for one in f]
    assert np.array_equal(together[0], np.array(alone).T[0])
