"""Transmissibility: the response to the motion of an end, against closed forms."""

import mpmath as mp
import numpy as np
import pytest

import ropedyn as rd

DENSITY, TENSION, LENGTH = 0.1, 100.0, 1.3
ROPE = rd.Rope(LENGTH, DENSITY)
FREQUENCY = np.array([0.0, 1.0, 13.3, 100.0, 777.0])


def test_string_passes_on_the_motion_of_either_end_as_waves_say():
    model = rd.Scene(ROPE, tension=TENSION).compile()
    frf = model.frf(FREQUENCY, drive=[("end", 0, "z"), ("end", 1, "z")], response=("z", 0.5))
    k = 2 * np.pi * FREQUENCY[1:] / np.sqrt(TENSION / DENSITY)
    left = np.append(1 - 0.5 / LENGTH, np.sin(k * (LENGTH - 0.5)) / np.sin(k * LENGTH))
    right = np.append(0.5 / LENGTH, np.sin(k * 0.5) / np.sin(k * LENGTH))
    error = np.abs(frf.value[:, 0] / [left, right] - 1)
    assert (error <= frf.rounding_error[:, 0] + 1e-15).all()
    assert frf.rounding_error.max() < 1e-10  # at 777 Hz near the 64th resonance
    assert (frf.value.imag == 0).all()


def cantilever(at, turned):
    """Transmissibility of a clamped-free beam with EI = 2 N m^2 at 40 Hz, in 40 digits."""
    with mp.workdps(40):
        q = (mp.mpf(DENSITY) * (80 * mp.pi) ** 2 / 2) ** mp.mpf("0.25")
        L, x = mp.mpf(LENGTH), mp.mpf(at)
        base = [
            [1, 0, 1, 0],
            [0, q, 0, q],
            [-mp.cos(q * L), -mp.sin(q * L), mp.cosh(q * L), mp.sinh(q * L)],
            [mp.sin(q * L), -mp.cos(q * L), mp.sinh(q * L), mp.cosh(q * L)],
        ]
        c = mp.lu_solve(mp.matrix(base), mp.matrix([1 - turned, turned, 0, 0]))
        basis = (mp.cos(q * x), mp.sin(q * x), mp.cosh(q * x), mp.sinh(q * x))
        return float(sum(a * b for a, b in zip(c, basis)))


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
def test_clamp_moves_and_turns_a_beam_as_paper_says(solver):
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=2.0)
    scene = rd.Scene(rope, ends=("clamped", "free"))
    drive, response = [("end", 0, "z"), ("end", 0, "beta")], [("z", 0.5), ("z", LENGTH)]
    # beta = -dz/dx: only sizes are compared
    exact = [[cantilever(at, turned) for at in (0.5, LENGTH)] for turned in (0, 1)]
    continuous = scene.compile().frf(40.0, drive=drive, response=response)
    np.testing.assert_allclose(np.abs(continuous.value[..., 0]), np.abs(exact), rtol=1e-12)
    chain = scene.compile(elements=32).frf(40.0, drive=drive, response=response, solver=solver)
    apart = np.abs(chain.value[..., 0] / continuous.value[..., 0] - 1)
    # over the chain's own value, not that of the spans
    np.testing.assert_allclose(chain.mesh_error[..., 0], apart, rtol=2e-4, atol=1e-9)
    assert apart.max() < 1e-4  # 32 elements


def test_motion_of_an_end_is_the_force_there_by_reciprocity():
    ends = ("pinned", rd.End(beta="free"))
    parts = [
        rd.Dashpot(0.9, 0.5),
        rd.PointMass(0.4, 0.05),
        rd.BrokenWire(0.6, 0.05, 3e-4, radius=2e-3),
    ]
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=0.5)
    model = rd.Scene(rope, tension=TENSION, ends=ends, parts=parts).compile()
    moved = model.frf(FREQUENCY, drive=("end", 0, "z"), response=[("z", 0.7), ("wire", 0)])
    pushed = model.frf(FREQUENCY, drive=("z", 0.7), response=("F_z", 0.0))
    np.testing.assert_allclose(moved.value[0], pushed.value[0], rtol=1e-9)
    assert np.abs(moved.value[1]).min() > 0


def test_string_of_a_free_body_carries_it_along_at_rest():
    ends = (rd.End(beta="free"), rd.End(z="free", beta="free", mass={"z": 0.5}))
    model = rd.Scene(ROPE, ends=ends, tension=TENSION).compile()
    frf = model.frf([0.0, 3.0], drive=("end", 0, "z"), response=("z", LENGTH))
    w = 6 * np.pi
    kL, Z = w / np.sqrt(TENSION / DENSITY) * LENGTH, np.sqrt(TENSION * DENSITY)
    exact = 1 / (np.cos(kL) - 0.5 * w / Z * np.sin(kL))
    np.testing.assert_allclose(frf.value[0], [1.0, exact], rtol=1e-12)


def test_rigid_bar_on_a_pin_turns_about_it():
    """A bar of no stiffness against turning, moved at its pin: its center of percussion rests."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=1e9)
    model = rd.Scene(rope, ends=("pinned", "free")).compile()
    frf = model.frf([5.0], drive=("end", 0, "z"), response=[("z", LENGTH / 3 * 2), ("z", LENGTH)])
    # to the square of the frequency over that of bending, 1e-9
    np.testing.assert_allclose(frf.value[:, 0], [0.0, -0.5], atol=1e-6)


def test_forces_and_motions_are_driven_in_one_question():
    model = rd.Scene(ROPE, tension=TENSION).compile(elements=16)
    drive = [("z", 0.5), ("end", 1, "z"), ("z", 0.3)]
    both = model.frf(FREQUENCY, drive=drive, response=[("z", 0.5), ("F_z", 0.65)])
    for k, one in enumerate(drive):
        alone = model.frf(FREQUENCY, drive=one, response=[("z", 0.5), ("F_z", 0.65)])
        np.testing.assert_allclose(both.value[k], alone.value, rtol=1e-13)
    assert both.labels[0] == "z at 0.500 m [m/N]"
    assert "z at 0.500 m [m/m] driven in z of end 1" in "".join(both.table().columns)
    alone = model.frf(FREQUENCY, drive=drive[1], response=("F_z", 0.65), quantity="mobility")
    assert alone.labels == ("F_z at 0.650 m [N/s/m]",)
    question = rd.ask.frf([1.0, 2.0], drive=("end", 0, "z"), response=("z", 0.5))
    assert str(question) == "receptance of 2 lines, 1 to 2 Hz, driven in z of end 0"
    assert question.of(model).drive == (("end", 0, "z"),)


@pytest.mark.parametrize(
    ("drive", "response", "message"),
    [
        (("end", 2, "z"), ("z", 0.5), "from 0 to 1"),
        (("end", 0), ("z", 0.5), "an end and a coordinate"),
        (("end", 0, "alpha"), ("z", 0.5), 'one of "z"'),
        (("end", 1, "z"), ("z", 0.5), "that the end holds"),
        (("end", 0, "z"), None, "response must be given where an end is moved"),
        (("end", 0, "z"), ("end", 0, "z"), "a coordinate and a position"),
    ],
)
def test_ends_without_meaning_are_refused(drive, response, message):
    ends = ("pinned", rd.End(z="free", beta="free"))
    model = rd.Scene(ROPE, ends=ends, tension=TENSION).compile()
    with pytest.raises(rd.SceneError, match=message):
        model.frf([1.0], drive=drive, response=response)


def test_modal_damping_does_not_say_what_a_moved_end_does():
    scene = rd.Scene(ROPE, tension=TENSION, damping=rd.ModalDamping(0.01))
    with pytest.raises(rd.SceneError, match="past the ground"):
        scene.compile().frf([1.0], drive=("end", 0, "z"), response=("z", 0.5))
