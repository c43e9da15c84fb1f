"""The study's Eq. 3 to 6: the flexibility of an element on any axis by the integral along r(s)."""

import numpy as np
import pytest

import ropedyn as rd

HELIX = """
 0.00099434435257854609783 -0.00010913156871336667354  0.00015149227064210157428
-0.00048469019760928194603  0.0085220255429829363485   0.0047865213237963347391
-0.00010913156871336667354  0.00083344590865415635109 -0.00035653199974898688501
 0.007603978983798760314   -0.00056886846222769382195  0.0023200220757123608222
 0.00015149227064210157428 -0.00035653199974898688501  0.00041808742843605249338
-0.0041861555120992629228   0.0024870087959220758635  -0.000084178264618411875914
-0.00048469019760928194603  0.007603978983798760314   -0.0041861555120992629228
 0.12656568591807573717     0.00038069870163069926668 -0.0077113100246883291579
 0.0085220255429829363485  -0.00056886846222769382195  0.0024870087959220758635
 0.00038069870163069926668  0.13597461684641525148     0.00060417029341385423298
 0.0047865213237963347391   0.0023200220757123608222  -0.000084178264618411875914
-0.0077113100246883291579   0.00060417029341385423298  0.13207575421855704021
"""
"""Of a helix of radius 0.05 m, pitch angle 0.3, 0.8 turns; A, B, C = 3, 2, 1.5 N m^2, computed with
32 digits from the closed form of r(s)."""


def relative(G, wanted):
    """The largest difference, each in units of the geometric mean of its diagonal entries."""
    size = np.sqrt(np.diag(wanted))
    return np.abs((G - wanted) / np.outer(size, size)).max()


def test_the_study_s_integral_along_a_helix_a_unlike_b():
    G = rd.study2015.axis_flexibility(rd.Axis.helix(0.05, 0.3, 0.8), A=3.0, B=2.0, C=1.5)
    wanted = np.array(HELIX.split(), dtype=float).reshape(6, 6)
    assert relative(G, wanted) < 1e-14  # 2e-15


def test_a_cranked_lever_is_bent_and_twisted_by_hand():
    # arms a along X and b along Y, held at the start; a force f along Z at the end bends b by
    # b^3/3B, twists a by f b and bends it by f and the rotation of its own end
    a, b, A, B, C = 0.7, 0.4, 3.0, 2.0, 1.5
    axis = rd.Axis.points([[0, 0, 0], [a, 0, 0], [a, b, 0]])
    G = rd.study2015.axis_flexibility(axis, A=A, B=B, C=C)
    # the plane of the frame is that of x and z, so that it bends across by A, with y along Z
    bent = b**3 / (3 * A) + b**2 * a / C + a**3 / (3 * A)
    assert G[1, 1] == pytest.approx(bent, rel=1e-14)
    assert G[4, 4] == pytest.approx((a + b) / B, rel=1e-14)


def test_the_study_s_own_element_is_a_straight_one_across_its_slope():
    # Eq. 7 to 11: eta = H s, whose matrix of cosines the study leaves without 1/sqrt(1 + H^2)
    length, H, B, C = 0.16875, 0.01, 54.626, 0.1485
    G = rd.study2015.axis_flexibility(rd.Axis.line(length), A=1.0, B=B, C=C)
    c, s = np.array([1, H]) / np.hypot(1, H)
    # about axes turned by the slope: alpha and beta of the study's xi and eta
    turn = np.array([[1, 0, 0], [0, c, s], [0, -s, c]])
    own = turn.T @ G[np.ix_([2, 3, 4], [2, 3, 4])] @ turn
    assert own[1, 2] == pytest.approx(H / (1 + H**2) * (1 / C - 1 / B) * length, rel=1e-12)
    assert own[1, 1] == pytest.approx((1 / C + H**2 / B) * length / (1 + H**2), rel=1e-12)


def test_stiffnesses_and_axis_are_checked():
    with pytest.raises(rd.SceneError, match="A must be a finite number > 0"):
        rd.study2015.axis_flexibility(rd.Axis.line(1.0), A=0.0, B=1.0, C=1.0)
    with pytest.raises(TypeError, match="axis must be an Axis, got 1"):
        rd.study2015.axis_flexibility(1.0, A=1.0, B=1.0, C=1.0)
