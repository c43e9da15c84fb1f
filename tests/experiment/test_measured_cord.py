"""A cord of known tension, whose stiffness nobody measured: both identified from five peaks."""

import numpy as np
import pytest
from given_ends import fitted
from measured_ropes import CORD_FREQUENCY, CORD_TENSION, cord

import ropedyn as rd

SOURCE = "M. Ali, D. Broggi, G. Cantarini, laboratory report: tests/support/measured_ropes.py"
UNKNOWN = ["tension", "bending_stiffness"]


def identified(ends):
    return fitted(cord(ends), CORD_FREQUENCY, UNKNOWN)


@pytest.mark.claim(
    "Tension of a cord between pinned ends, identified with its stiffness from 5 frequencies: "
    "relative difference from the hanging mass",
    reference=SOURCE,
    accepted=0.005,
)
def test_tension_of_a_cord_is_identified(claim):
    fit = identified("pinned")
    low, high = fit.interval(0.95)["tension"]
    assert low < CORD_TENSION < high
    claim(abs(fit.value["tension"] / CORD_TENSION - 1))


def test_missing_mode_of_the_cord_is_seen():
    without_second = [CORD_FREQUENCY[k] for k in (0, 2, 3, 4)]
    fit = rd.identify(
        cord("pinned"), without_second, UNKNOWN, ends="given", prior={"tension": (2.0, 0.5)}
    )
    assert (fit.status, fit.orders.tolist()) == ("trusted", [1, 3, 4, 5])
    assert abs(fit.value["tension"] / CORD_TENSION - 1) < 0.005


@pytest.mark.claim(
    "The same between clamped ends, which fit as well: how far below the hanging mass",
    reference=SOURCE,
    accepted=0.072,
    limit=True,
)
def test_clamped_ends_fit_the_cord_as_well_and_give_seven_per_cent_less(claim):
    pinned, clamped = identified("pinned"), identified("clamped")
    rms = [np.sqrt(np.mean((fit.residual / fit.measured) ** 2)) for fit in (pinned, clamped)]
    assert abs(rms[1] / rms[0] - 1) < 0.05
    assert "clamped ends fit as well" in pinned.report()
    assert "tension -6.9 %" in pinned.report()
    claim(1 - clamped.value["tension"] / CORD_TENSION)
