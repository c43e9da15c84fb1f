"""Lines are taken together as far as the same parts of the rope are crossed by them."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.response.bands import FEW, REACH, bands


@pytest.mark.parametrize("slow", [FEW - 1, FEW])
def test_lines_far_below_others_are_a_band_of_their_own_unless_they_are_few(slow):
    low, high = np.linspace(1.0, 2.0, slow), np.linspace(3.0 * REACH, 4.0 * REACH, 2 * FEW)
    found = list(bands(np.concatenate([high, low])))
    sizes = [2 * FEW, slow] if slow == FEW else [2 * FEW + slow]
    assert [len(band) for band in found] == sizes
    assert np.array_equal(np.sort(np.concatenate(found)), np.arange(2 * FEW + slow))


def test_what_is_held_is_known_to_stand_still():
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
    frf = model.frf([7.0], drive=("z", 0.5), response=[("z", 0.0), ("z", 0.5)])
    assert frf.value[0, 0] == 0
    assert frf.rounding_limit[0, 0] == 0
    assert 0 < frf.rounding_limit[1, 0] < 1e-14 * abs(frf.value[1, 0])
    assert frf.rounding_measured.all()
