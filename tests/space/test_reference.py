"""Ropes on an axis against closed forms and determinants of 32 digits."""

import math

import numpy as np
import pytest

import ropedyn as rd

REFERENCE = 1e-13
"""Relative: 2e-15 was measured, and the references have 17 digits at least."""

E, G = 2e11, 2e11 / 2.6
AREA, J = math.pi * 0.1**2 / 4, math.pi * 0.1**4 / 64


def rod(axis, **more):
    """Round steel of 0.1 m, inextensible, without shear and inertia of rotation."""
    how = {"bending_stiffness": E * J, "torsional_stiffness": 2 * G * J}
    return rd.Rope(axis, 8000 * AREA, **how | more)


def model(rope, ends=("clamped", "clamped"), **more):
    return rd.Scene(rope, ends=ends, planes="both", **more).compile()


def agrees(modes, plane, wanted, tolerance=REFERENCE):
    found = modes.frequency[(modes.plane == plane) & (modes.frequency > 0)]
    wanted = np.array(wanted, dtype=float)
    assert found[: len(wanted)] == pytest.approx(wanted, rel=tolerance)
    assert modes.certified
    elastic = modes.frequency > 0
    assert (modes.rounding_error < 1e-12 * modes.frequency.max())[elastic].all()


IN_PLANE = ["53.3821907562882793857572", "150.9876363134611051086826", "289.5055770031113002103898"]
OUT_OF_PLANE = ["51.84936718324143801010891", "148.7725387004754471054768"]


def test_a_ring_by_its_halves():
    # where a mode of the ring is even x, beta and gamma, alpha ... stand still; a half has it once
    even = rd.End(x="held", y="free", z="free", alpha="free", beta="held", gamma="held")
    modes = model(rod(rd.Axis.arc(1.0, math.pi)), (even, even)).modes(below=300.0)
    agrees(modes, "z", IN_PLANE)
    agrees(modes, "y", OUT_OF_PLANE)
    # along z, along y and about the diameter
    assert (modes.frequency == 0).sum() == 3


ARCS = {
    "clamped": (
        ["262.1311784744393543054", "518.2521839582016505676", "941.3313048055739968253"],
        [
            "98.59033401363111390917",
            "284.3665370976245701841",
            "575.5411298589563710013",
            "966.468266838358906659",
        ],
    ),
    "pinned": (
        [
            "154.4974613535892431895",
            "384.8625446723407174958",
            "740.7419957236536495905",
            "1170.03878679395527576",
        ],
        [
            "23.62533263531255916356",
            "165.8690554179372948596",
            "410.0601100218762782146",
            "753.2029844409327365906",
        ],
    ),
}


@pytest.mark.parametrize("end", ARCS)
def test_arcs_of_two_radians(end):
    modes = model(rod(rd.Axis.arc(1.0, 2.0)), (end, end)).modes(9)
    agrees(modes, "z", ARCS[end][0])
    agrees(modes, "y", ARCS[end][1])


def test_an_arc_that_slides_along_its_tangent():
    slides = rd.End(x="free", beta="free", gamma="free")
    modes = model(rod(rd.Axis.arc(1.0, 2.0)), (slides, slides)).modes(below=800.0)
    wanted = [
        "24.62616702581113972702756",
        "168.1424604605568394200713",
        "412.7020945341080900591639",
        "755.9889600765185884311301",
    ]
    agrees(modes, "z", wanted)


def test_arms_at_a_right_angle():
    axis = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]])
    rope = rd.Rope(axis, 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
    wanted = [
        "24.53883653465096982015722",
        "35.60818972264930047965502",
        "79.52154773265566708272552",
        "98.15534613860387928062889",
        "165.9153619737125373243253",
    ]
    agrees(model(rope).modes(11), "z", wanted)


def spring(turns, **more):
    d, E, nu = 1e-3, 2.06e11, 0.3
    A, J, G = math.pi * d**2 / 4, math.pi * d**4 / 64, E / (2 * (1 + nu))
    return rd.Rope(
        rd.Axis.helix(5e-3, math.radians(8.5744), turns),
        7900 * A,
        bending_stiffness=E * J,
        torsional_stiffness=2 * G * J,
        axial_stiffness=E * A,
        shear_stiffness=0.9 * G * A,
        rotary_inertia=7900 * J,
        polar_inertia=2 * 7900 * J,
        **more,
    )


def test_a_helical_spring_with_shear():
    wanted = [
        "393.40559384335632657",
        "395.98510859398944111",
        "462.73687983349123926",
        "525.56818820448378656",
        "863.58508476311534236",
        "876.75934031069760063",
    ]
    agrees(model(spring(7.6)).modes(6), "space", wanted)


BENT = [
    "8.211445326241969890271612",
    "20.15364792519245501226913",
    "37.19995595133895515195868",
    "59.62830938172517602142832",
    "87.53058622788183333184746",
]


def bent(torsion, natural):
    axis = rd.Axis.arc(2.0, 1.0)
    return rd.Rope(axis, 0.8, bending_stiffness=40.0, torsional_stiffness=torsion, natural=natural)


@pytest.mark.parametrize("torsion", [25.0, 400.0])
def test_a_rope_bent_from_straight_is_a_straight_beam_across_its_plane(torsion):
    modes = model(bent(torsion, "straight"), tension=300.0).modes(below=100.0)
    agrees(modes, "y", BENT)


def test_a_rope_that_is_naturally_bent_is_not():
    modes = model(bent(25.0, "axis"), tension=300.0).modes(below=100.0)
    first = modes.frequency[modes.plane == "y"][0]
    assert 0.005 < abs(first / float(BENT[0]) - 1) < 0.02  # 1.5 % off


def test_the_study_s_integral_is_the_core_s_flexibility():
    helix, A, B, C = rd.Axis.helix(0.05, 0.3, 0.8), 3.0, 2.0, 1.5
    lever = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0.5, 0], [1.2, 0.5, 0.7]])
    for axis in helix, lever, rd.Axis.arc(0.3, 2.0):
        rope = rd.Rope(axis, 1.0, bending_stiffness=(B, A), torsional_stiffness=C)
        free = model(rope, ("clamped", "free"))
        drive = [(c, axis.length) for c in free.coordinates]
        found = free.frf([0.0], drive=drive).value[:, :, 0].real
        wanted = rd.study2015.axis_flexibility(axis, A=A, B=B, C=C)
        size = np.sqrt(np.diag(wanted))
        assert np.abs((found - wanted) / np.outer(size, size)).max() < 1e-13  # 3e-15
