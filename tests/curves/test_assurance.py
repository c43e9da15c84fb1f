"""Likeness of responses (FRAC) and of shapes (MAC), and the shapes that responses show."""

import math

import numpy as np
import pytest
from conftest import EPS

import ropedyn as rd
from ropedyn.eigen.vectors import shapes_at
from ropedyn.signal.likeness import frac, frac_over, mac, residues

RANDOM = np.random.default_rng(7)
CURVES = RANDOM.normal(size=(2, 40)) + 1j * RANDOM.normal(size=(2, 40))
OTHER = RANDOM.normal(size=(2, 40)) + 1j * RANDOM.normal(size=(2, 40))


# FRAC


@pytest.mark.parametrize("factor", [1.0, -3.0, 2j, 1e-200, 1e200])
def test_frac_of_a_multiple_is_1(factor):
    np.testing.assert_allclose(frac(CURVES, factor * CURVES), 1.0, rtol=10 * EPS)
    np.testing.assert_allclose(frac(factor * CURVES, CURVES), 1.0, rtol=10 * EPS)


def test_frac_of_two_lines_by_hand():
    # |1*3 + (-i)(2 i) 2|^2/((1 + 1)(9 + 16)) with Hm = (1, i), Hc = (3, 4 i)
    found = frac(np.array([[1.0, 1j]]), np.array([[3.0, 4j]]))
    assert found == pytest.approx([49 / 50], rel=4 * EPS)
    # orthogonal
    assert frac(np.array([[1.0, 1j]]), np.array([[1.0, -1j]])) == pytest.approx([0.0], abs=EPS)


def test_frac_where_nothing_moves_is_nan():
    assert np.isnan(frac(CURVES, 0 * CURVES)).all()
    f = np.arange(40.0)
    assert np.isnan(frac_over(CURVES, 0 * CURVES, f, 3.0)).all()


def test_frac_in_bands_is_frac_of_the_lines_in_them():
    f = np.cumsum(RANDOM.uniform(0.1, 2.0, 40))
    found = frac_over(CURVES, OTHER, f, 5.0)
    for k in range(40):
        near = np.abs(f - f[k]) <= 2.5
        expected = frac(CURVES[:, near], OTHER[:, near])
        np.testing.assert_allclose(found[:, k], expected, rtol=100 * EPS, atol=EPS)


def test_frac_in_the_widest_band_is_that_of_all_lines():
    f = np.arange(40.0)
    found = frac_over(CURVES, OTHER, f, 1e3)
    np.testing.assert_allclose(found, np.tile(frac(CURVES, OTHER)[:, None], 40), rtol=100 * EPS)


def test_frac_of_one_line_is_1():
    np.testing.assert_allclose(frac_over(CURVES, OTHER, np.arange(40.0), 0.5), 1.0, rtol=10 * EPS)


def test_frac_in_bands_keeps_its_digits_beside_a_high_peak():
    # a running sum over the peak would leave 1e-16 of its square, as large as the rest
    lines = np.concatenate([[1e9], np.ones(10)]) * (1 + 0j)
    wrong = lines * np.tile([1, -1], 6)[:11]
    found = frac_over(lines[None], wrong[None], np.arange(11.0), 2.0)[0]
    # three lines, one of them with the other sign: (1/3)^2
    np.testing.assert_allclose(found[2:-1], 1 / 9, rtol=10 * EPS)


# MAC


def test_mac_of_a_multiple_is_1_and_of_orthogonal_shapes_0():
    n = 8
    x = np.arange(1, n) / n
    sines = np.sin(np.pi * np.outer(np.arange(1, n), x))
    # sums of products of sines over equal parts vanish exactly
    np.testing.assert_allclose(mac(sines, -2j * sines), np.eye(n - 1), atol=20 * EPS)
    assert mac(sines[:2], sines).shape == (2, n - 1)


def test_mac_does_not_depend_on_size_or_phase():
    found = mac(CURVES, OTHER)
    np.testing.assert_allclose(mac(1e-200j * CURVES, 1e200 * OTHER), found, rtol=20 * EPS)
    a, b = CURVES[0], OTHER[1]
    by_hand = abs(np.vdot(a, b)) ** 2 / (np.vdot(a, a) * np.vdot(b, b)).real
    assert found[0, 1] == pytest.approx(by_hand, rel=20 * EPS)


def test_mac_of_a_shape_that_does_not_move_is_nan():
    assert np.isnan(mac(np.zeros((1, 3)), np.ones((2, 3)))).all()


# shapes at points

STRING = rd.Scene(rd.Rope(2.0, 0.1), tension=100.0)
AT = [0.1, 0.25, 0.3, 1.0, 1.9]
POINTS = tuple(("z", x) for x in AT)


def assert_alike(found, shapes, tolerance):
    """Shapes are multiples of each other."""
    shapes = np.asarray(shapes)
    size = (found * shapes).sum(axis=1) / (shapes**2).sum(axis=1)
    np.testing.assert_allclose(found / size[:, None], shapes, atol=tolerance)


@pytest.mark.parametrize("count", [1, 5])
def test_shapes_of_continuous_spans_are_exact_everywhere(count):
    found = shapes_at(STRING.compile().modes(count), POINTS)
    sines = np.sin(np.pi * np.outer(np.arange(1, count + 1), AT) / 2.0)
    # the largest of them at the nodes that were put in is 1, but for its sign; of a sine the nodes
    # miss the top by less than 2 % of its height
    assert_alike(found, sines, 1e-12)
    np.testing.assert_allclose(np.abs(found / sines)[:, 0], 1.0, rtol=0.02)


def test_shapes_of_a_chain_are_straight_between_its_beads():
    modes = STRING.compile(elements=8, element="rigid").modes(3)
    found = shapes_at(modes, POINTS)
    assert_alike(found, [np.interp(AT, modes.x, shape[:, 0]) for shape in modes.shape], 1e-14)


def test_shapes_at_nodes_are_those_of_the_modes():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=2.0, polar_inertia=1e-3)
    modes = rd.Scene(rope).compile(elements=4).modes(4)
    points = [("z", 0.25), ("beta", 0.25), ("alpha", 0.5), ("z", 0.0), ("z", 1.0)]
    found = shapes_at(modes, points)
    where = [modes.coordinates.index(c) for c, _ in points]
    assert_alike(found, modes.shape[:, [1, 1, 2, 0, 4], where], 1e-13)


@pytest.mark.parametrize("tension", [2000.0, 50.0, -5.0])
def test_shapes_inside_tensed_elements_are_those_of_the_response_at_a_resonance(tension):
    """They were those without tension: 0.4 % of z, 2.7 % of beta off at 2 kN."""
    rope = rd.Rope(1.3, 0.25, bending_stiffness=5.0)
    model = rd.Scene(rope, tension=tension).compile(elements=8)
    modes, points = model.modes(3), [("z", 0.325), ("z", 0.437), ("beta", 0.437), ("beta", 1.25)]
    for k, shape in enumerate(shapes_at(modes, points)):
        near = [modes.frequency[k] * (1 + 1e-9)]  # other modes have 4e-7 of it there
        response = model.frf(near, drive=("z", 0.325), response=points).value.ravel()
        ratio = (response / response[0]).real
        np.testing.assert_allclose(shape / shape[0], ratio, rtol=1e-6)  # measured: 4e-7


# shapes that responses show


def one_mode(f, f0, ratio):
    w, w0 = 2 * np.pi * f, 2 * np.pi * f0
    return 1 / (w0 * w0 - w * w + 2j * ratio * w0 * w)


@pytest.mark.parametrize("quantity", ["receptance", "mobility", "accelerance"])
@pytest.mark.parametrize(("ratio", "lines"), [(1e-2, 500), (1e-4, 100), (0.0, 100)])
def test_residues_of_one_mode_and_a_rest_are_exact(quantity, ratio, lines):
    f = np.linspace(5.0, 35.0, lines)
    shape, rest = np.array([1.0, -2.0, 0.5j]), np.array([1e-4, 0.0, 2e-4j])
    value = shape[:, None] * one_mode(f, 20.0, ratio) + rest[:, None]
    times = ("receptance", "mobility", "accelerance").index(quantity)
    value = value * (2j * np.pi * f) ** times
    (found,) = residues(f, value, quantity, np.array([20.0]), np.array([ratio]))
    np.testing.assert_allclose(found / found[0], shape, rtol=1e-10)


def test_residues_of_modes_close_to_each_other_are_taken_on_their_own_sides():
    f = np.linspace(5.0, 35.0, 3001)
    shapes = np.array([[1.0, 1.0], [1.0, -1.0]])
    peaks, ratio = np.array([19.0, 21.0]), np.array([2e-3, 2e-3])
    value = sum(s[:, None] * one_mode(f, f0, 2e-3) for s, f0 in zip(shapes, peaks))
    found = residues(f, value, "receptance", peaks, ratio)
    # what the other mode adds is even in each window to (half widths/distance)^2 = (0.12/2)^2
    np.testing.assert_allclose(mac(found, shapes), np.eye(2), atol=5e-3)


def test_residues_with_few_lines_take_those_there_are():
    for lines in (1, 2, 3):
        f = np.linspace(19.0, 21.0, lines)
        value = np.array([[1.0], [2.0]]) * one_mode(f, 20.0, 0.01)
        (found,) = residues(f, value, "receptance", np.array([20.0]), np.array([0.01]))
        assert found[1] / found[0] == pytest.approx(2.0, rel=1e-12)


# in a comparison

BEADS = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.RayleighDamping(2.0, 0.0)).compile(
    elements=8, element="rigid"
)
INNER = tuple(("z", k / 8) for k in range(1, 8))


@pytest.fixture(scope="module")
def measured():
    f = np.arange(2.0, 62.0, 0.1)
    frf = BEADS.frf(f, drive=("z", 0.125), response=list(INNER), quantity="accelerance")
    return rd.Measured(f, frf.value, drive=("z", 0.125), response=INNER, quantity="accelerance")


@pytest.mark.claim(
    "Shapes that measured responses of a string of beads show: largest difference of MAC from 1 of "
    "the same mode, from 0 of others",
    reference="sines, orthogonal over equal parts",
    accepted=3e-5,
)
def test_measured_shapes_of_a_string_of_beads_are_its_sines(measured, claim):
    comparison = rd.compare(BEADS, measured)
    assert comparison.order.tolist() == [1, 2, 3, 4]
    claim(np.abs(comparison.mac - np.eye(4, 7)).max())


def test_mac_is_that_of_modes_and_of_another_response_too(measured):
    frf = BEADS.frf(measured.frequency, drive=("z", 0.125), response=list(INNER))
    model = rd.compare(BEADS, measured).mac
    np.testing.assert_allclose(rd.compare(BEADS.modes(4), measured).mac, model[:, :4], atol=1e-12)
    # the same one-mode fit on both sides
    np.testing.assert_allclose(np.diag(rd.compare(frf, measured).mac), 1.0, atol=1e-9)


def test_one_response_shows_no_shape():
    f = np.arange(2.0, 62.0, 0.1)
    value = BEADS.frf(f, drive=("z", 0.125)).value
    alone = rd.Measured(f, value, drive=("z", 0.125), response=("z", 0.125))
    comparison = rd.compare(BEADS, alone)
    assert comparison.mac is None
    with pytest.raises(rd.SceneError, match=r"of must be something that was compared, got 'mac'"):
        comparison.plot(of="mac")


def test_shapes_may_be_given_with_their_points():
    x = np.array([0.1, 0.35, 0.8])
    shapes = np.sin(np.pi * np.outer([1, 3], x))
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
    peaks = rd.Peaks([16.0, 47.0], order=[1, 3])
    comparison = rd.compare(model, peaks, shapes=shapes, points=[("z", at) for at in x])
    assert comparison.mac.shape == (2, len(comparison.all_calculated))
    np.testing.assert_allclose(comparison.mac[[0, 1], [0, 2]], 1.0, rtol=1e-12)
    sines = np.sin(math.pi * np.outer(np.arange(1, 4), x))
    np.testing.assert_allclose(comparison.mac[:, :3], mac(shapes, sines), rtol=1e-9)


def test_modes_from_a_file_have_no_shapes(tmp_path, measured):
    modes = BEADS.modes(3)
    modes.save(tmp_path / "modes.nc")
    again = rd.load(tmp_path / "modes.nc")
    assert rd.compare(again, [16.0]).order.tolist() == [1]
    whole = rd.compare(again, measured)
    assert whole.order.tolist() == [1, 2, 3, 0]
    assert whole.mac is None
    with pytest.raises(rd.SceneError, match="modes from a file have no model"):
        rd.compare(again, [16.0], shapes=[[1.0, 2.0]], points=[("z", 0.2), ("z", 0.5)])


@pytest.mark.claim(
    "Measured residues of a free beam in three points, six modes: largest 1 - MAC with the shapes "
    "of a free beam",
    reference="accelerances of github.com/ladisk/pyuff, data/meas_point_1.txt to 3 (MIT licence), "
    "one-mode fits; positions fitted to them, geometry not stated",
    accepted=1e-3,
)
def test_measured_shapes_of_a_free_beam_are_those_of_a_beam(claim):
    frequency = [51.52, 142.18, 278.67, 460.40, 687.17, 958.54]  # Hz
    residues = np.array(
        [
            [0.1551, -0.1169, 0.098, -0.0784, 0.058, -0.0432],
            [0.1136, -0.055, 0.0229, 0.0059, -0.025, 0.0364],
            [0.0717, -0.0046, -0.0389, 0.0629, -0.0664, 0.0584],
        ]
    )
    # sqrt(B/mu)/L^2 from the first frequency alone, 4.7300^2 = 22.373 of a free beam
    rope = rd.Rope(1.0, 1.0, bending_stiffness=(51.52 * 2 * math.pi / 22.37329) ** 2)
    model = rd.Scene(rope, ends=("free", "free")).compile()
    points = [("z", 0.974), ("z", 0.922), ("z", 0.873)]
    comparison = rd.compare(model, frequency, shapes=residues.T, points=points)
    assert comparison.order.tolist() == [1, 2, 3, 4, 5, 6]
    claim(1 - comparison.mac[np.arange(6), np.arange(6)].min())
