"""Bending with friction: references, a measured conductor, limits, loops, what is refused."""

import numpy as np
import pytest
from conftest import EPS
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from test_section import REFERENCE, assert_near, built, ropes, strands

import ropedyn as rd
from ropedyn.scene.construction.catalogue import NAMES
from ropedyn.scene.construction.friction import grip, slip_angle

CARDINAL = built(REFERENCE["constructions"]["ACSR Cardinal, lay ratios 21 13 13 12"]["description"])
EXTRA = REFERENCE["extras"]["Cardinal M(kappa), T=40 kN, mu=0.7, chi=1.5"]
HOW = {"tension": 40e3, "friction": 0.7}
CONSTRUCTIONS = st.one_of(strands(), ropes())


def test_moments_are_those_of_the_reference():
    kappa = [float(curvature) for curvature in EXTRA["M_Nm"]]
    assert_near(CARDINAL.section().moment(kappa, **HOW), list(EXTRA["M_Nm"].values()))
    found = grip(CARDINAL.strand, 40e3, 0.7, 1.5)
    assert_near(found.first, EXTRA["kappa_first_slip"])


def test_moments_are_those_of_the_cardinal_conductor():
    # 18 points of a measurement, or of a model with this friction; at small curvatures they lie
    # lower, as wires in contact give way before they slip
    points = REFERENCE["Cardinal_conductor_points"]
    measured = np.array(points["moment_Nm"])
    kappa = points["curvature_1_per_m"]
    off = CARDINAL.section().moment(kappa, tension=points["tension_N"], friction=0.7) / measured - 1
    assert (np.abs(off) < 0.05).sum() == 15
    assert (np.abs(off[3:]) < 0.032).all()
    assert (off[:3] > 0.09).all() and (off[:3] < 0.23).all()


@given(CONSTRUCTIONS, st.floats(1.0, 1e5), st.floats(0.05, 1.0))
def test_moments_grow_from_sticking_to_slipping(construction, tension, friction):
    section = construction.section()
    first = grip(construction.strand, tension, friction, 1.5).first
    kappa = np.geomspace(first.min() / 10, 10 * first.max(), 60)
    how = {"tension": tension, "friction": friction}
    B, eta = section.bending(kappa, **how), section.loss(kappa, **how)
    assert abs(B[0] / section.bending_stick - 1) < 64 * EPS
    assert eta[0] == 0 and (eta >= 0).all()
    assert (np.diff(B) <= 8 * EPS * B[:-1]).all()
    slope = np.diff(section.moment(kappa, **how)) / np.diff(kappa)
    rounding = 64 * EPS * B[:-1] * kappa[:-1] / np.diff(kappa)
    assert (slope >= section.bending_slip - rounding).all()
    assert (np.diff(slope) <= rounding[1:] + rounding[:-1]).all()
    assert section.moment(-kappa, **how).tolist() == (-section.moment(kappa, **how)).tolist()


def test_wires_all_stick_at_first_and_all_slip_at_last():
    for name in NAMES:
        section = rd.Construction.standard(name, diameter=0.02).section()
        how = {"tension": 10e3, "friction": 0.2}
        assert_near(section.bending(1e-9, **how), section.bending_stick, rounding=64)
        # beyond all slip the moment grows by bending_slip alone
        far = np.array([100.0, 200.0])
        slope = np.diff(section.moment(far, **how))[0] / 100.0
        assert abs(slope / section.bending_slip - 1) < 1e-12
        assert section.loss(1e-9, **how) == 0


def test_without_tension_or_friction_wires_slide():
    section = rd.Construction.standard("1x19", diameter=0.02).section()
    for how in {"tension": 0.0, "friction": 0.3}, {"tension": 1e4, "friction": 0.0}:
        assert_near(section.bending([1e-6, 1.0], **how), [section.bending_slip] * 2)
        assert section.loss([1e-6, 1.0], **how).tolist() == [0.0, 0.0]


def test_a_cycle_loses_the_loop_of_the_first_curve_doubled():
    section = CARDINAL.section()
    first = grip(CARDINAL.strand, 40e3, 0.7, 1.5).first
    for a in (0.02, 0.1, 0.5):
        breaks = [kappa for kappa in (*first, *(np.pi / 2 * first)) if kappa < a]
        curve = lambda kappa: float(section.moment(kappa, **HOW))  # noqa: E731
        whole, _ = quad(curve, 0, a, points=breaks, limit=400, epsrel=1e-11)
        lost = 8 * (whole - curve(a) * a / 2)
        # the quadrature's own tolerance, of a difference of halves
        assert abs(section.loss(a, **HOW) * np.pi * curve(a) * a / lost - 1) < 1e-9


def test_the_angle_of_slip_solves_its_equation_to_the_last_digits():
    share = np.concatenate([1 - np.geomspace(1e-16, 0.36, 200), [1.0]])
    theta = slip_angle(share)
    assert np.abs(np.sinc(theta / np.pi) - share).max() < 2 * EPS
    assert (slip_angle(np.array([0.6, 0.0])) == np.pi / 2).all()


def test_curvatures_keep_their_shape():
    section = CARDINAL.section()
    assert section.moment(0.1, **HOW).shape == ()
    assert section.loss(np.full((2, 3), 0.1), **HOW).shape == (2, 3)
    assert section.moment(0.0, **HOW) == 0


def test_bad_input_is_refused_by_name(tmp_path):
    section = CARDINAL.section()
    with pytest.raises(rd.SceneError, match=r"tension must be a finite number >= 0 \[N\]"):
        section.moment(0.1, tension=-1.0, friction=0.3)
    with pytest.raises(rd.SceneError, match="friction must be"):
        section.bending(0.1, tension=1.0, friction=-0.3)
    with pytest.raises(rd.SceneError, match="amplitude"):
        section.loss([0.1, 0.0], **HOW)
    section.save(tmp_path / "section.nc")
    with pytest.raises(rd.SceneError, match="got one from a file"):
        rd.load(tmp_path / "section.nc").moment(0.1, **HOW)
