"""Ropes of continuous spans, and how far their modes and responses are from the continuum."""

import exact_roots
import mpmath
import numpy as np
from conftest import BENDING, LENGTH
from exact_chain import DIGITS, condition, omega_of, relative
from exact_roots import continuum
from mpmath import mpf
from parabolas import parabola

import ropedyn as rd

RELATIVE = 1e-13
"""Of an eigenvalue, over its sensitivity: some hundred eps, for sums over half waves and their
stations."""
BOUND = 1e-12
"""Of the error over the condition of the answer."""
UNIT = BENDING / LENGTH**2
LAID = rd.Rope(
    1.2,
    0.09,
    bending_stiffness=2.0,
    torsional_stiffness=0.6,
    axial_stiffness=8e4,
    polar_inertia=2e-6,
    rotary_inertia=1e-6,
)
TWISTING = rd.Scene(LAID.replace(axial_stiffness=None, lay_slope=0.3), tension=60.0)
STRETCHING = rd.Scene(LAID.replace(bending_stiffness=None, lay_coupling=-150.0))
WHOLE = rd.Scene(
    LAID.replace(lay_slope=-1.0, lay_coupling=100.0), tension=60.0, ends=("clamped", "pinned")
)
SOFT = rd.End(alpha="free", beta="free", spring={"alpha": 0.2})
PARTS = [
    rd.PointMass(0.4, 0.05, rotary_inertia=1e-4, polar_inertia=2e-5),
    rd.Spring(0.9, 2e3),
    rd.Spring(0.6, -3.0, coordinate="beta"),
]
SCENES = {
    "lay slope 0.3": TWISTING,
    "lay slope 0.01, sprung": TWISTING.replace(
        rope=TWISTING.rope.replace(lay_slope=0.01), ends=(SOFT, "clamped")
    ),
    "lay slope -1, compressed": TWISTING.replace(
        rope=TWISTING.rope.replace(lay_slope=-1.0), tension=-3.0
    ),
    "lay coupling": STRETCHING,
    "lay coupling, disc at the end": STRETCHING.replace(
        ends=("clamped", "free"), parts=[rd.PointMass(1.2, 0.3, polar_inertia=1e-5)]
    ),
    "both, clamped and pinned": WHOLE,
    "mass and springs": rd.Scene(
        rd.Rope(1.2, 0.09, bending_stiffness=2.0),
        tension=60.0,
        parts=PARTS,
        ends=("clamped", "free"),
    ),
    "mass and springs, lay slope": TWISTING.replace(parts=PARTS),
    "supports": rd.Scene(
        rd.Rope(1.2, 0.09, bending_stiffness=2.0, rotary_inertia=1e-5),
        parts=[rd.Support(0.5), rd.Support(0.8, coordinate="beta")],
        ends=("pinned", "free"),
    ),
    "free hinge": rd.Scene(
        rd.Rope(1.2, 0.09, bending_stiffness=2.0, rotary_inertia=1e-5),
        tension=20.0,
        parts=[rd.Hinge(0.45), rd.PointMass(0.45, 0.0, rotary_inertia=1e-4)],
    ),
    "elastic hinge": rd.Scene(
        rd.Rope(1.2, 0.09, bending_stiffness=2.0),
        tension=-4.0,
        parts=[rd.Hinge(0.45, stiffness=3.0), rd.Support(0.7)],
    ),
}


def solved(scene, number=10, **more):
    """Certified modes without mesh error."""
    model = parabola(scene)
    assert model.element == "continuous"
    modes = model.modes(number, **more)
    assert modes.certified
    assert len(modes.frequency) == number
    assert (modes.mesh_error == 0).all()
    assert (np.diff(modes.eigenvalue) >= 0).all()
    return modes


def worst_error(scene, modes, which, coordinate="z"):
    """Largest error of eigenvalues over their sensitivity; `rounding_error` must bound each.

    A frequency is as wrong as half its eigenvalue, relatively: that of sqrt(lambda)/2 pi.
    """
    exact, worst = continuum(scene, coordinate), 0.0
    for k in which:
        near, bound = float(modes.eigenvalue[k]), float(modes.rounding_error[k])
        root = exact_roots.eigenvalue(exact, near, 1e-3)
        sensitivity = exact_roots.sensitivity(exact, root)
        with mpmath.workdps(40):
            rate = [mpmath.sqrt(abs(v)) / (2 * mpmath.pi) for v in (root, mpf(near))]
            assert abs(rate[0] - rate[1]) <= bound
            # no useless bound: d f = d lambda/(8 pi^2 f)
            assert bound <= 10 * RELATIVE * sensitivity / (8 * mpmath.pi**2 * rate[0])
            worst = max(worst, float(abs(root - near) / sensitivity))
    return worst


def is_counted(scene, modes, coordinate="z"):
    """Whether there are exactly as many eigenvalues below the last as were found."""
    exact, found = continuum(scene, coordinate), modes.eigenvalue
    high = found[-2:].mean()
    low = -max(abs(high), -2 * found[0])
    return exact_roots.count(exact, low, high) == len(found) - 1


def errors(scene, f, drive, responses=None):
    """Errors of responses over their condition; `rounding_error` must bound each."""
    responses = responses or [drive]
    frf = parabola(scene).frf(f, drive=drive, response=responses)
    assert (frf.mesh_error == 0).all()
    exact = continuum(scene, drive[0])
    with mpmath.workdps(DIGITS):
        values = exact.receptance(omega_of(f), drive, responses)
        found = []
        for k, (response, h) in enumerate(zip(responses, values)):
            error = relative(frf.value[k, 0], h)
            assert error <= frf.rounding_error[k, 0]
            found.append(error / condition(exact, omega_of(f), drive, response))
    return found
