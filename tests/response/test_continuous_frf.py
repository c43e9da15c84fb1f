"""Responses of continuous spans, without mesh, against the exact reference in many digits."""

import itertools
import math

import exact_roots
import mpmath
import numpy as np
import pytest
from conftest import BENDING, EPS, LENGTH, MASS, reference
from exact_chain import DIGITS, condition, omega_of, relative
from exact_roots import continuum
from exact_span import Law
from random_scene import random_spans
from spans import BOUND, SCENES, UNIT, WHOLE, errors

import ropedyn as rd

EXACT = "mpmath, 60 digits: tests/support/exact_span.py"
BEAM = rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING)
ENDS = list(itertools.product(("clamped", "pinned", "free"), repeat=2))
DAMPINGS = {
    "stiffness": rd.StiffnessDamping(1e-4),
    "rayleigh": rd.RayleighDamping(2.0, 1e-5),
    "sum": (rd.RayleighDamping(2.0, 1e-5), rd.StiffnessDamping(1e-5)),
}


# beams -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "line", reference("frf_beam_exact")["lines"], ids=lambda line: f"{float(line['f']):.4g} Hz"
)
@pytest.mark.claim(
    "Damped FRF of a clamped tensed beam of continuous spans, 1 to 1000 Hz: error over the largest "
    "response of the coordinate",
    reference="stored, mpmath 60 digits: frf_tensioned_beam.json",
    # at a resonance of 1.6 % damping: the numbers of the scene, rounded, move it by 60 eps
    accepted=BOUND,
)
def test_beam_responds_as_stored(line, claim):
    damping = rd.RayleighDamping(0.0, 1e-4)
    model = rd.Scene(BEAM, tension=300.0, damping=damping).compile()
    for coordinate in ("z", "beta"):
        points = [(coordinate, float(x)) for x in line["x"]]
        value = model.frf(float(line["f"]), drive=("z", 0.50625), response=points).value[:, 0]
        exact = np.array([complex(*map(float, pair)) for pair in line[coordinate]])
        claim(np.abs(value - exact).max() / np.abs(exact).max())


@pytest.mark.parametrize("xi2", [0.0, 10.0, 1e4, 1e8])
@pytest.mark.parametrize("ends", ENDS, ids="-".join)
@pytest.mark.claim(
    "FRF of continuous beams, every pair of ends, T L^2/B from 0 to 1e8, 0.001 (free-free and "
    "pinned too) to 1111 Hz: error / condition",
    reference=EXACT,
    accepted=5e-14,
)
def test_beam_responds_as_the_continuum(ends, xi2, claim):
    scene = rd.Scene(BEAM, tension=xi2 * UNIT, ends=ends)
    drive = ("z", 0.4)
    for f in (0.001, 1.0, 111.0, 1111.0):
        # the stiffest ropes cost the reference most
        others = [("beta", 0.4), ("z", 1.0)] if xi2 < 1e8 else []
        claim(max(errors(scene, f, drive, [drive, *others])))


@pytest.mark.parametrize("xi2", [-5.0, 0.0, 1e4])
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.claim(
    "FRF of damped continuous beams, compressed and tensed: error / condition",
    reference=EXACT,
    accepted=5e-14,
)
def test_damped_beam_responds_as_the_continuum(damping, xi2, claim):
    scene = rd.Scene(
        BEAM, tension=xi2 * UNIT, ends=("clamped", "pinned"), damping=DAMPINGS[damping]
    )
    for f in (0.001, 50.0, 1111.0):
        claim(max(errors(scene, f, ("z", 0.4), [("z", 0.4), ("z", 1.0), ("beta", LENGTH)])))


# everything else ---------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.claim(
    "FRF of continuous ropes with lay coupling, lay slope, masses, springs, supports, hinges, "
    "0.01 Hz undamped and 700 Hz damped: error / condition",
    reference=EXACT,
    accepted=9e-14,
)
def test_rope_with_what_stands_on_it_responds_as_the_continuum(name, claim):
    scene = SCENES[name]
    c = scene.coordinates[-1]
    claim(max(errors(scene, 0.01, (c, 0.31))))
    others = [("beta", 0.45), ("z", 0.95)] if c == "beta" else [("x", 0.95)]
    damped = scene.replace(damping=DAMPINGS["sum"])
    drive = ("z", 0.31) if c == "beta" else (c, 0.31)
    claim(max(errors(damped, 700.0, drive, [drive, *others])))


@pytest.mark.parametrize("f", [0.01, 33.0, 700.0])
@pytest.mark.claim(
    "Internal forces of continuous ropes between and at masses, springs and ends, per unit force: "
    "error / condition",
    reference=EXACT,
    accepted=1e-13,
)
def test_internal_forces_are_those_of_the_continuum(f, claim):
    scene = SCENES["mass and springs"].replace(damping=DAMPINGS["stiffness"])
    # at the clamp, between, at the load, at the mass (left of it), at springs
    points = [(force, x) for force in ("F_z", "M_beta") for x in (0.0, 0.2, 0.3, 0.4, 0.6, 0.9)]
    claim(max(errors(scene, f, ("z", 0.3), points)))


@pytest.mark.claim(
    "Force 0.1 m from the free end of a continuous rope at 0.01 Hz, 5e-9 of the force that drives "
    "it: error over that force. Its own digits are lost, the sweep carries forces of all the rope",
    reference=EXACT,
    accepted=4 * EPS,
    wide="the rounding of the large forces, which the small one need not reach",
    limit=True,
)
def test_small_force_near_a_free_end_is_right_to_the_rounding_of_large_ones(claim):
    scene = SCENES["mass and springs"].replace(damping=DAMPINGS["stiffness"])
    drive, point = ("z", 0.3), ("F_z", 1.1)
    with mpmath.workdps(DIGITS):
        (exact,) = continuum(scene, "z").receptance(omega_of(0.01), drive, [point])
        frf = scene.compile().frf(0.01, drive=drive, response=point)
        error = abs(mpmath.mpmathify(complex(frf.value[0, 0])) - exact)
        assert error <= frf.rounding_error[0, 0] * abs(exact)
        claim(float(error))


@pytest.mark.parametrize("drive", ["x", "alpha", "z", "beta"])
@pytest.mark.claim(
    "All four internal forces of a continuous laid rope, lay slope -1 and lay coupling: "
    "error / condition",
    reference=EXACT,
    accepted=1e-13,
)
def test_internal_forces_of_a_laid_rope_are_those_of_the_continuum(drive, claim):
    points = [(force, x) for force in ("F_x", "F_z", "M_alpha", "M_beta") for x in (0.0, 0.7, 1.2)]
    claim(max(errors(WHOLE, 77.0, (drive, 0.5), points)))


@pytest.mark.parametrize("f", [5.0, 250.0])
def test_shear_jumps_by_load_inertia_and_spring(f):
    # F right of a node less F left of it + load + omega^2 m z - k z = 0: beside nodes by 1e-6 of
    # the length, where F changes by omega^2 mu z dx
    scene = rd.Scene(BEAM, tension=300.0, parts=[rd.PointMass(0.5, 0.03), rd.Spring(0.9, 4e3)])
    model = scene.compile()
    dx, omega2 = 1e-6 * LENGTH, (2 * math.pi * f) ** 2
    for x, load, mass, spring in ((0.3, 1.0, 0, 0), (0.5, 0, 0.03, 0), (0.9, 0, 0, 4e3)):
        points = [("F_z", x), ("F_z", x + dx), ("z", x), ("z", x + dx / 2)]
        left, right, z, beside = model.frf(f, drive=("z", 0.3), response=points).value[:, 0]
        left -= omega2 * MASS / LENGTH * dx * beside
        terms = np.array([right, -left, load, (omega2 * mass - spring) * z])
        # 20 eps of the forces; the middle of dx stands for all of it to (k dx)^2/24 of 1e-4
        assert abs(terms.sum()) <= 1e-13 * np.abs(terms).max() * 10


# resonances of parts -----------------------------------------------------------------------------

SHARES = [(1, 1), *((j, 2**k) for k in range(1, 7) for j in {1, 3, 2**k - 1} if 0 < j < 2**k)]
"""Parts of the rope: what is joined by doubling, and what has been joined so far."""


@pytest.mark.parametrize("tension", [0.0, 300.0])
@pytest.mark.parametrize(("j", "n"), SHARES)
@pytest.mark.claim(
    "Undamped FRF of continuous spans within an ulp of clamped-free resonances of j/2^k of the "
    "rope: error / condition",
    reference=f"frequencies: tests/support/exact_roots.py; {EXACT}",
    accepted=7e-14,
)
def test_response_is_exact_where_a_part_of_a_span_resonates(j, n, tension, claim):
    part = rd.Scene(BEAM.replace(length=LENGTH * j / n), tension=tension, ends=("clamped", "free"))
    near = part.compile(elements=32).modes(2).frequency.tolist()
    whole = rd.Scene(BEAM, tension=tension)
    for f in near:
        double = float(exact_roots.frequency(continuum(part), f, 1e-2))
        for at in (double, math.nextafter(double, 0), math.nextafter(double, math.inf)):
            # halves of the rope are spans of their own here
            claim(max(errors(whole, at, ("z", LENGTH / 2))))


# statics -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("xi2", [-5.0, 0.0, 1.0, 1e4, 1e8])
@pytest.mark.claim(
    "Response of continuous beams at 0 Hz, T L^2/B from -5 to 1e8: error / condition",
    reference=EXACT,
    accepted=4e-14,
)
def test_response_at_rest_is_the_static_deflection(xi2, claim):
    scene = rd.Scene(BEAM, tension=xi2 * UNIT, ends=("clamped", "pinned"))
    claim(max(errors(scene, 0.0, ("z", 0.4), [("z", 0.4), ("z", 1.0), ("F_z", 0.0)])))
    claim(max(errors(scene, 0.0, ("beta", LENGTH), [("beta", LENGTH), ("z", 1.0)])))


@pytest.mark.parametrize("name", [name for name in SCENES if "compressed" not in name])
@pytest.mark.claim(
    "Static deflection of continuous ropes with all that stands on them: error over the largest of "
    "its coordinate",
    reference=EXACT,
    accepted=BOUND,
)
def test_static_deflection_is_that_of_the_continuum(name, claim):
    scene = SCENES[name]
    c = scene.coordinates[-1]
    load = {(c, 0.31): 2.0, (c, 1.1): -0.7}
    static = scene.compile().static(load)
    exact = continuum(scene, c)
    points = list(itertools.product(exact.coordinates, static.x.tolist()))
    with mpmath.workdps(DIGITS):
        sums = [
            sum(float(force * v) for force, v in zip(load.values(), values))
            for values in zip(*(exact.receptance(mpmath.mpf(0), at, points) for at in load))
        ]
    own = [scene.coordinates.index(k) for k in exact.coordinates]
    expected = np.array(sums).reshape(len(own), -1).T
    error = np.abs(static.displacement[:, own] - expected).max(axis=0)
    size = np.abs(expected).max(axis=0)
    # a coordinate that nothing moves must not move
    claim((error / np.where(size > 0, size, 1)).max())


# random ------------------------------------------------------------------------------------------

LINES = 40
MOST_WAVES = 2000
RESONANT = 1e11
"""Condition of an answer that may be refused: times 2^10 eps it has no digit."""


def shortened(scene, f, drive):
    """The frequency, less by decades where the rope would be longer than so many waves."""
    exact = continuum(scene, drive[0])
    while f > 1e-6:
        law = Law(scene, exact.coordinates, 1, 1, -(omega_of(f) ** 2))
        if law.wavenumber * scene.rope.length < MOST_WAVES:
            break
        f /= 10
    return exact, f


@pytest.fixture(scope="module")
def sample():
    """Error, `rounding_error`, condition of random lines; none where one was refused rightly."""
    found = []
    for seed in range(LINES):
        scene, f, drive, response = random_spans(seed)
        exact, f = shortened(scene, f, drive)
        with mpmath.workdps(DIGITS):
            try:
                frf = scene.compile().frf(f, drive=drive, response=response)
            except rd.SolveError:
                hard = condition(exact, omega_of(f), drive, drive)
                assert hard > RESONANT, f"refused without need: {seed}"
                continue
            (h,) = exact.receptance(omega_of(f), drive, [response])
            error = relative(frf.value[0, 0], h)
            hard = condition(exact, omega_of(f), drive, response)
        found.append((seed, error, frf.rounding_error[0, 0], hard, drive == response))
    return found


@pytest.mark.claim(
    f"rounding_error of the FRF of {LINES} random ropes of continuous spans bounds the true error: "
    "share beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_error_bounds_the_true_error_of_random_spans(sample, claim):
    claim(np.mean([error > estimate for _, error, estimate, _, _ in sample]))


@pytest.mark.claim(
    f"FRF at the drive point of {LINES} random ropes of continuous spans: error / condition",
    reference=EXACT,
    accepted=1e-13,
)
def test_random_spans_respond_at_the_drive_as_the_continuum(sample, claim):
    claim(max(error / hard for _, error, _, hard, at_drive in sample if at_drive))


def test_most_random_lines_have_an_answer(sample):
    # seven of eight at least: the sample is one of answers, not of refusals
    assert len(sample) >= LINES * 7 / 8
    assert sum(at_drive for *_, at_drive in sample) >= LINES / 4


@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("free", "free")])
def test_cost_counts_the_lines_of_a_rope_without_nodes_that_move(ends):
    model = rd.Scene(BEAM, tension=100.0, ends=ends).compile()
    cost = model.frf([10.0, 20.0, 30.0], drive=("z", 0.4)).cost
    assert (cost.elements, cost.sweeps) == (1, 6)
