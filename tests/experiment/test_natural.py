"""Natural frequencies of damped modes beside the undamped ones that peaks are fitted by."""

import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd
from ropedyn.experiment.fitting.natural import natural_of, shift_by_damping

BEAM = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0))
STIFF = rd.Scene(rd.Rope(10.0, 2.0, bending_stiffness=400.0), tension=1e4)
DAMPINGS = [None, rd.RayleighDamping(2.0, 1e-4), rd.ModalDamping(0.02), rd.ViscousDamping(3.0)]


@pytest.mark.parametrize("damping", DAMPINGS)
def test_proportional_damping_moves_no_natural_frequency(damping):
    # |s| is the root of the eigenvalue: rounding of some products
    shift = shift_by_damping(STIFF.replace(damping=damping), 8)
    np.testing.assert_allclose(shift, 0.0, atol=100 * EPS)


def test_a_loss_factor_moves_all_modes_of_a_beam_alike():
    # s^2 = -omega^2 (1 + i eta)
    shift = shift_by_damping(BEAM.replace(damping=rd.LossFactor(0.1)), 6)
    np.testing.assert_allclose(shift, math.log1p(0.1**2) / 4, rtol=1e-10)


def test_a_dashpot_that_damps_modes_away_leaves_the_others_in_their_order():
    # one in the middle, far above the impedance Z = 10 N s/m, holds the string there
    stiff = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[rd.Dashpot(0.5, 1e4)])
    model = stiff.compile()
    natural = natural_of(model, model.modes(4)).frequency
    halves = math.sqrt(100.0 / 0.1) * np.array([1, 1, 2, 2])
    # but for a part 2 Z/c = 2e-3, by whose square frequencies shift
    np.testing.assert_allclose(natural, halves, rtol=1e-5)


def test_peaks_less_the_shift_are_undamped_modes():
    scene = STIFF.replace(damping=rd.LossFactor(0.05))
    model = scene.compile()
    lines = np.linspace(0.0, 40.0, 2001)[1:]
    frf = model.frf(lines, drive=("z", 1.3), response=[("z", 1.3), ("z", 2.9)])
    peaks = rd.Peaks.of(frf)
    undamped = model.modes(len(peaks.frequency)).frequency
    natural = undamped * np.exp(shift_by_damping(scene, len(undamped)))
    # what neighbours leave of the fit of one mode; damping moves them by a thousand times that
    np.testing.assert_allclose(peaks.frequency, natural, rtol=1e-8)
    assert np.abs(natural / undamped - 1).max() > 1e-5
