"""Peaks of a rope that hangs on its catenary, told by the parabola."""

import numpy as np
import pytest

import ropedyn as rd

TRUE = 20e3
SAGS = rd.Scene(rd.Rope(100.0, 2.0, axial_stiffness=2e7), tension=TRUE, gravity=rd.Gravity())
PEAKS = SAGS.compile().modes(6).catenary


def identified(std, **how):
    peaks = rd.Peaks(PEAKS, std=std, order=[1, 2, 3, 4, 5, 6])
    return rd.identify(SAGS.replace(tension=1.25 * TRUE), peaks, ["tension"], **how)


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
@pytest.mark.parametrize("std", [1e-4, 1e-5])
def test_peaks_that_are_known_better_than_the_parabola_are_not_trusted(std):
    fit = identified(std)
    assert fit.status == "ambiguous"
    assert any("the parabola of sag is off by" in note for note in fit.notes)


@pytest.mark.parametrize("how", [{"std": 1e-2}, {"std": 1e-4, "model_std": 1e-3}])
def test_intervals_as_wide_as_the_parabola_is_off_are_trusted(how):
    fit = identified(**how)
    assert fit.status == "trusted"
    low, high = fit.interval()["tension"]
    assert low < TRUE < high
    assert not any("parabola" in note for note in fit.notes)


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
def test_of_many_fits_each_says_so():
    peaks = [rd.Peaks(PEAKS, std=std, order=[1, 2, 3, 4, 5, 6]) for std in (1e-2, 1e-4)]
    fits = rd.identify(SAGS, peaks, ["tension"])
    assert tuple(fits.status) == ("trusted", "ambiguous")
    np.testing.assert_allclose(fits.value[:, 0], TRUE, rtol=1e-3)
