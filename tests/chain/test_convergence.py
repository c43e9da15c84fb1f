"""Second order of the rigid chain towards the continuous beam, string and shaft."""

import math

import numpy as np
import pytest
from conftest import BENDING, LENGTH, MASS, reference

import ropedyn as rd

BEAMS = reference("beam_frequencies")["cases"]
RESPONSES = reference("frf_tensed_beam")["continuum"]


def rigid(scene, elements):
    return scene.compile(elements=elements, element="rigid")


def order(coarse, fine):
    """Observed order of convergence when the elements are doubled."""
    return np.log2(np.abs(coarse) / np.abs(fine))


def plain_beam(tension, **more):
    return rd.Scene(
        rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING), tension=tension, **more
    )


@pytest.mark.parametrize("case", BEAMS, ids=lambda c: f"{c['ends']} T={c['tension']:.0f}")
@pytest.mark.parametrize("k", range(3))
def test_beam_frequencies_converge_quadratically_or_better(case, k):
    scene = plain_beam(case["tension"], ends=(case["ends"],) * 2)
    # coarser where the error is so small that rounding would show
    chains = (64, 128) if case["tension"] > 0 else (32, 64)
    error = [rigid(scene, n).modes(3).frequency[k] / case["f"][k] - 1 for n in chains]
    # without tension lumps on exact beams make no error of second order at held ends; with it the
    # fourth-order part is (k pi/64)^2 of the other but for the ratio B k^2 pi^2/(T L^2), at most
    # 100 here: 0.15 of the order
    expected = 2 if case["tension"] > 0 else 4
    assert order(*error) == pytest.approx(expected, abs=0.15)


@pytest.mark.parametrize("k", range(1, 5))
def test_string_frequencies_converge_quadratically(k):
    # f = k/2L sqrt(T/mu); the chain is low by (k pi/2n)^2/6
    T, mu = 300.0, 0.1
    exact = k / 2 * math.sqrt(T / mu)
    error = [
        rd.Scene(rd.Rope(1.0, mu), tension=T)
        .compile(elements=n, element="rigid")
        .modes(4)
        .frequency[k - 1]
        / exact
        - 1
        for n in (32, 64)
    ]
    assert order(*error) == pytest.approx(2, abs=0.01)
    assert error[1] == pytest.approx(-((k * math.pi / 128) ** 2) / 6, rel=1e-2)


@pytest.mark.parametrize("family", ["torsional", "axial"])
@pytest.mark.parametrize("k", [1, 3])
def test_shaft_and_rod_frequencies_converge_quadratically(family, k):
    rope = {
        "torsional": rd.Rope(1.0, 0.1, torsional_stiffness=2.0, polar_inertia=1e-5),
        "axial": rd.Rope(1.0, 0.1, axial_stiffness=2e4),
    }[family]
    # clamped-free: (2 k - 1)/4L c
    exact = (2 * k - 1) / 4 * math.sqrt(2e5)
    scene = rd.Scene(rope, ends=("clamped", "free"))
    error = [rigid(scene, n).modes(k).frequency[k - 1] / exact - 1 for n in (32, 64)]
    assert order(*error) == pytest.approx(2, abs=0.02)


@pytest.mark.parametrize("coordinate", ["z", "beta"])
@pytest.mark.parametrize("case", RESPONSES, ids=lambda case: f"{case['f']:g} Hz")
@pytest.mark.parametrize("at", range(5))
def test_response_of_a_tensed_beam_converges_quadratically(case, coordinate, at):
    # two of the five responses stand between nodes; the drive is on one
    exact = complex(*case[coordinate][at])
    scene = plain_beam(300.0, damping=rd.RayleighDamping(0, 1e-4))
    error = []
    for n in (64, 256):
        frf = rigid(scene, n).frf(
            case["f"], drive=("z", case["drive"]), response=(coordinate, case["x"][at])
        )
        error.append(abs(frf.value[0, 0] - exact) / abs(exact))
    # between nodes the place in the element changes with n, and with it a part of the error that
    # tension leaves, itself of second order: the mean order over two doublings
    assert order(*error) / 2 == pytest.approx(2, abs=0.25)
    assert error[1] < 5e-4


def test_drive_between_nodes_converges_quadratically():
    # simply supported beam, closed form by its modes' sum in sines; static tension neglected: T = 0
    f, at = 70.0, 0.4
    omega2, mu = (2 * math.pi * f) ** 2, MASS / LENGTH
    k = np.arange(1, 20001)
    wave = k * math.pi / LENGTH
    terms = 2 / (mu * LENGTH) * np.sin(wave * at) ** 2 / (BENDING / mu * wave**4 - omega2)
    exact = math.fsum(terms)
    scene = plain_beam(0.0, ends=("pinned", "pinned"))
    error = [
        rigid(scene, n).frf(f, drive=("z", at)).value[0, 0].real / exact - 1
        for n in (8, 16, 32, 64)
    ]
    assert abs(error[3]) < 1e-3
    # at least: pinned and untensed much of the error is of fourth order
    assert math.log2(abs(error[0] / error[3])) / 3 >= 1.9


@pytest.mark.parametrize("n", [16, 64])
def test_tensed_cantilever_deflects_as_the_catenary_of_bending(n):
    # B w'' = T w.. : tip force F on a cantilever with tension, w = F (L - tanh(kL)/k)/T
    T = 500.0
    k = math.sqrt(T / BENDING)
    exact = (LENGTH - math.tanh(k * LENGTH) / k) / T
    scene = plain_beam(T, ends=("clamped", "free"))
    error = [
        rigid(scene, m).static({("z", LENGTH): 1.0}).displacement[-1, 0] / exact - 1
        for m in (n, 2 * n)
    ]
    assert order(*error) == pytest.approx(2, abs=0.1)
