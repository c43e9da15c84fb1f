"""Order of convergence towards the continuous tensed beam: four if tensed, two if rigid."""

import math

import mpmath
import numpy as np
import pytest
from conftest import BENDING, LENGTH, MASS
from exact_waves import beam_eigenvalue

import ropedyn as rd

ROPE = rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING)
MODES = 3
SCENES = {
    "clamped": rd.Scene(ROPE, tension=300.0),
    "pinned": rd.Scene(ROPE, tension=300.0, ends=("pinned", "pinned")),
    "free": rd.Scene(ROPE, tension=300.0, ends=("free", "free")),
    "clamped and free": rd.Scene(ROPE, tension=300.0, ends=("clamped", "free")),
    "pulled ten times as much": rd.Scene(ROPE, tension=3000.0, ends=("clamped", "pinned")),
    "pushed": rd.Scene(ROPE, tension=-200.0),
    "point mass": rd.Scene(ROPE, tension=300.0, parts=[rd.PointMass(LENGTH / 4, 0.1)]),
    "point mass at a free end": rd.Scene(
        ROPE, tension=300.0, ends=("clamped", "free"), parts=[rd.PointMass(LENGTH, 0.5)]
    ),
    "unequal spans": rd.Scene(
        ROPE, tension=300.0, ends=("pinned", "free"), parts=[rd.Support(0.36 * LENGTH)]
    ),
    "point mass between unequal elements": rd.Scene(
        ROPE, tension=300.0, parts=[rd.PointMass(0.36 * LENGTH, 0.1)]
    ),
}


@pytest.fixture(scope="module")
def continuum():
    """Eigenvalues of each scene, in 50 digits, next to those of a fine chain."""
    known = {}

    def look_up(name):
        if name not in known:
            fine = SCENES[name].compile(elements=1024, element="tensed")
            near = fine.modes(MODES + 1, solver="sweep").eigenvalue
            with mpmath.workdps(50):
                exact = [beam_eigenvalue(SCENES[name], x) for x in near[near > 0][:MODES]]
            known[name] = np.array([float(x) for x in exact])
        return known[name]

    return look_up


def errors(scene, element, n, exact):
    model = scene.compile(elements=n, element=element)
    modes = model.modes(MODES + 1, solver="sweep")
    assert modes.certified
    assert math.sqrt(abs(scene.tension) / BENDING) * model.chain.length.max() < 0.3
    return modes.eigenvalue[modes.eigenvalue > 0][:MODES] / exact - 1


@pytest.mark.parametrize("name", SCENES)
def test_tensed_chain_converges_with_fourth_order(name, continuum):
    # 0.36 of 64 and of 128 are 23 and 46 elements: every element is halved
    coarse, fine = (errors(SCENES[name], "tensed", n, continuum(name)) for n in (64, 128))
    order = np.log2(np.abs(coarse) / np.abs(fine))
    # the next term is (k pi/64)^2 of this one, 0.02 for the third mode, and changes by 3/4 of it
    np.testing.assert_allclose(order, 4, atol=0.1)


@pytest.mark.parametrize("name", SCENES)
def test_rigid_chain_with_tension_converges_with_second_order(name, continuum):
    coarse, fine = (errors(SCENES[name], "rigid", n, continuum(name)) for n in (256, 512))
    order = np.log2(np.abs(coarse) / np.abs(fine))
    np.testing.assert_allclose(order, 2, atol=0.1)


def test_tensed_chain_without_end_correction_converges_with_second_order_at_a_free_end():
    # what the correction is for: without M_z,beta lumps are the trapezoidal rule of a cantilever
    scene = rd.Scene(ROPE, ends=("clamped", "free"))
    with mpmath.workdps(50):
        near = scene.compile(elements=512, element="tensed").modes(1, solver="sweep").eigenvalue[0]
        exact = float(beam_eigenvalue(scene, near))
    # without tension rigid and tensed elements are the same but for the correction
    tensed, rigid = (
        [
            scene.compile(elements=n, element=element).modes(1, solver="sweep").eigenvalue[0]
            / exact
            - 1
            for n in (32, 64)
        ]
        for element in ("tensed", "rigid")
    )
    assert math.log2(abs(tensed[0] / tensed[1])) == pytest.approx(4, abs=0.1)
    assert math.log2(abs(rigid[0] / rigid[1])) == pytest.approx(2, abs=0.1)
    # design.md, section 2: 5e-10 and 1.1e-4 of the frequency at 64 elements
    assert abs(tensed[1]) / 2 == pytest.approx(5e-10, rel=0.2)
    assert abs(rigid[1]) / 2 == pytest.approx(1.1e-4, rel=0.1)


def test_continuum_is_that_of_the_stored_frequencies():
    # clamped beam without tension: 4.73004074486270402602404810^2
    scene = rd.Scene(ROPE)
    with mpmath.workdps(40):
        unit = mpmath.mpf(BENDING) / (mpmath.mpf(MASS / LENGTH) * mpmath.mpf(LENGTH) ** 4)
        value = beam_eigenvalue(scene, 500.56 * float(unit))
        assert float(abs(mpmath.root(value / unit, 4) - mpmath.mpf("4.730040744862704026"))) < 1e-17
