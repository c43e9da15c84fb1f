"""Figures of constructions: every wire at its place, the layers from the side."""

import numpy as np
import pytest

import ropedyn as rd


def test_every_wire_is_drawn_inside_the_diameter_and_none_overlaps():
    made = rd.Construction.standard("6x36WS", diameter=20e-3, scaled=False)
    circles = made.plot().patches
    assert len(circles) == 6 * 36 + 1
    centre = np.array([circle.center for circle in circles])
    radius = np.array([circle.radius for circle in circles])
    assert np.hypot(*centre.T).max() + radius[-1] < 10.0 + 1e-9
    apart = np.hypot(*(centre[:, None] - centre[None]).T)
    np.fill_diagonal(apart, np.inf)
    assert (apart - radius - radius[:, None]).min() > -1e-9


def test_the_lay_is_seen_from_the_side():
    made = rd.Construction.standard("1x19", diameter=4e-3, lay="Z")
    ax = made.plot(lay=True)
    assert len(ax.lines) == 18
    assert ax.get_xlabel() == "position along the rope [mm]"


def test_a_section_draws_its_construction(tmp_path):
    section = rd.Construction.standard("1x7", diameter=3e-3).section()
    assert len(section.plot().patches) == 7
    section.save(tmp_path / "section.nc")
    with pytest.raises(rd.SceneError, match="got one from a file"):
        rd.load(tmp_path / "section.nc").plot()


def test_a_spread_draws_the_middle_of_the_draws_of_each_number():
    spread = rd.Construction.standard("7x7", diameter=4e-3).section().spread(n=200)
    ax = spread.plot()
    ends = np.array([ax.lines[0].get_xdata(), ax.lines[1].get_xdata()]) / 100.0
    EA = spread.axial_stiffness
    assert ends.ravel().tolist() == pytest.approx(
        np.quantile(EA, [0.025, 0.975, 0.25, 0.75]) / np.median(EA), rel=1e-14
    )
    names = [label.get_text() for label in ax.get_yticklabels()]
    assert names[0] == f"axial stiffness\n{np.median(EA):.4g} N"
    assert (ax.get_xlabel(), ax.get_xscale()) == ("share of the median [%]", "log")


def test_a_number_that_is_zero_has_no_share():
    straight = rd.Construction(rd.Wire(4e-3), [])
    ax = straight.section().spread(n=200).plot()
    assert {float(line.get_ydata()[0]) for line in ax.lines} == {0.0, 2.0, 3.0, 5.0}
