"""Bending and torsion tests: the stiffness, its error, the rope and the prior they give."""

import math
import pickle

import numpy as np
import pytest
from conftest import EPS
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from scipy.optimize import curve_fit

import ropedyn as rd

L, B, C = 0.5, 54.626, 0.1485
"""Length of the piece [m]; stiffnesses of ../shared/study-2015.txt, below eq. (11) [N m^2]."""
FORCE = np.array([0.0, 5.0, 10.0, 20.0, 40.0])
TORQUE = np.array([-0.1, -0.05, 0.0, 0.05, 0.1])
HELD = {
    "cantilever": ("clamped", "free"),
    "simply-supported": ("pinned", "pinned"),
    "clamped": ("clamped", "clamped"),
}
ROPE = rd.Rope(L, 0.1, bending_stiffness=B, torsional_stiffness=C)
MODEL = {name: rd.Scene(ROPE, ends=ends).compile() for name, ends in HELD.items()}
PLACES = st.floats(0.01, 0.99).map(lambda share: share * L)


def bent(*, reading_std=None, zero=None, noise=0.0, ends="cantilever"):
    """A test of B whose gauge starts at 3 mm."""
    g = {"cantilever": L**3 / 3, "simply-supported": L**3 / 48, "clamped": L**3 / 192}[ends]
    w = 3e-3 + FORCE * g / B + noise
    return rd.BendingTest(L, FORCE, w, ends=ends, reading_std=reading_std, zero=zero)


def twisted(noise=0.0):
    return rd.TorsionTest(L, TORQUE, TORQUE * L / C + noise)


@pytest.mark.claim(
    "A bending test is read as the static deflection of the same piece, at any two places",
    reference="Model.static of one continuous span, without tension",
    accepted=7e-13,
)
@pytest.mark.parametrize("ends", HELD)
def test_a_bending_test_returns_the_stiffness_of_the_model_that_was_bent(ends, claim):
    worst = []

    @given(PLACES, PLACES)
    def bend(x, read_at):
        static = MODEL[ends].static({("z", read_at): 0.0} | {("z", x): 1.0})
        at = int(np.abs(static.x - read_at).argmin())
        assert abs(static.x[at] - read_at) <= 1e-9 * L
        w = FORCE * static.displacement[at, static.coordinates.index("z")]
        test = rd.BendingTest(L, FORCE, w, ends=ends, x=x, read_at=read_at)
        worst.append(abs(test.stiffness / B - 1))

    bend()
    claim(max(worst))


@pytest.mark.parametrize("ends", HELD)
def test_force_and_reading_stand_where_a_piece_deflects_most(ends):
    assert bent(ends=ends).stiffness == pytest.approx(B, rel=20 * EPS)
    here = L if ends == "cantilever" else L / 2
    assert (bent(ends=ends).x, bent(ends=ends).read_at) == (here, here)


def test_a_torsion_test_returns_the_stiffness_of_the_model_that_was_twisted():
    scene = rd.Scene(ROPE, ends=("clamped", rd.End(alpha="free")))
    static = scene.compile().static({("alpha", L): 0.1})
    angle = static.displacement[-1, static.coordinates.index("alpha")]
    test = rd.TorsionTest(L, [0.0, 0.1], [0.0, angle])
    assert test.stiffness == pytest.approx(C, rel=1e-12)


def test_the_flexibility_of_the_study_is_that_of_a_cantilever_and_of_a_twisted_piece():
    # ../shared/study-2015.txt, eq. (11) with H = 0: zeta per force l^3/3B, alpha per torque l/C
    a, F = 0.16875, np.array([0.0, 10.0, 20.0])
    assert rd.BendingTest(a, F, F * a**3 / (3 * B)).stiffness == pytest.approx(B, rel=20 * EPS)
    assert rd.TorsionTest(a, F, F * a / C).stiffness == pytest.approx(C, rel=20 * EPS)


# errors


def scatter(seed, size=1e-5):
    return size * np.random.default_rng(seed).standard_normal(len(FORCE))


@pytest.mark.parametrize("seed", range(3))
def test_the_line_is_that_of_linear_regression(seed):
    test = bent(noise=scatter(seed))
    line = stats.linregress(FORCE, test.deflection)
    assert test.stiffness == pytest.approx(L**3 / 3 / line.slope, rel=1e-12)
    assert test.std == pytest.approx(test.stiffness * line.stderr / line.slope, rel=1e-9)
    assert test.offset == pytest.approx(line.intercept, rel=1e-12)
    expected = test.deflection - line.intercept - line.slope * FORCE
    np.testing.assert_allclose(test.residual, expected, atol=1e-16)


@pytest.mark.parametrize("reading_std", [None, 2e-5])
def test_a_known_zero_puts_the_line_through_it(reading_std):
    test = bent(noise=scatter(4), zero=3e-3, reading_std=reading_std)
    sigma = None if reading_std is None else np.full(len(FORCE), reading_std)
    (slope,), ((variance,),) = curve_fit(
        lambda force, slope: 3e-3 + slope * force,
        FORCE,
        test.deflection,
        sigma=sigma,
        absolute_sigma=sigma is not None,
    )
    # curve_fit stops at a relative change of 1e-8
    assert test.stiffness == pytest.approx(L**3 / 3 / slope, rel=1e-7)
    assert test.std / test.stiffness == pytest.approx(math.sqrt(variance) / slope, rel=1e-7)
    assert test.offset == 3e-3


def test_an_unknown_zero_changes_nothing_but_the_offset():
    moved = rd.BendingTest(L, FORCE, bent(noise=scatter(1)).deflection + 0.1)
    assert moved.stiffness == pytest.approx(bent(noise=scatter(1)).stiffness, rel=1e-11)
    assert moved.offset - bent(noise=scatter(1)).offset == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize("load", [1e-200, 1e200])
def test_the_unit_of_the_loads_does_not_matter(load):
    """Sums of squares of such loads are no numbers."""
    test = rd.TorsionTest(L, [0.0, 1.0, 2.0], [0.0, 0.034, 0.067])
    other = rd.TorsionTest(L, [0.0, load, 2 * load], [0.0, 0.034, 0.067])
    assert other.stiffness == pytest.approx(test.stiffness * load, rel=1e-12)
    assert other.std == pytest.approx(test.std * load, rel=1e-12)


@pytest.mark.parametrize("zero", [None, 3e-3])
@pytest.mark.parametrize("reading_std", [None, 1e-4])
def test_the_interval_covers_the_truth_as_often_as_it_says(zero, reading_std):
    random = np.random.default_rng(8)
    inside = 0
    for _ in range(2000):
        noise = 1e-4 * random.standard_normal(len(FORCE))
        low, high = bent(noise=noise, zero=zero, reading_std=reading_std).interval(0.95)
        inside += low <= B <= high
    # 95 % of 2000, four standard deviations of a binomial count, 9.7 each
    assert abs(inside - 1900) <= 39


def test_as_many_readings_as_numbers_fitted_tell_no_error():
    test = rd.BendingTest(L, [0.0, 10.0], [0.0, 1e-3])
    assert test.std == math.inf
    assert test.interval() == (0.0, math.inf)
    known = rd.BendingTest(L, [0.0, 10.0], [0.0, 1e-3], reading_std=1e-5)
    assert 0 < known.std < math.inf
    one = rd.BendingTest(L, 10.0, 1e-3, zero=0.0)
    assert (one.stiffness, one.std) == (pytest.approx(known.stiffness), math.inf)


def test_an_interval_is_open_where_readings_may_not_depend_on_the_load():
    test = rd.TorsionTest(L, [0.0, 1.0, 2.0, 3.0], [0.0, 0.3, -0.2, 0.2])
    low, high = test.interval()
    assert 0 < low < test.stiffness
    assert high == math.inf


# as answers


@pytest.mark.parametrize("test", [bent(noise=scatter(2)), twisted(1e-3)], ids=["bent", "twisted"])
def test_tests_can_be_shown_kept_and_read_again(test, tmp_path):
    test.save(tmp_path / "test.nc")
    for again in (rd.load(tmp_path / "test.nc"), pickle.loads(pickle.dumps(test))):
        assert (again.stiffness, again.std) == (test.stiffness, test.std)
    assert test.table().rows[0][0] == test.load[0]
    assert f"{test.stiffness:.6g}" in str(test)
    ax = test.plot()
    np.testing.assert_array_equal(ax.lines[0].get_ydata(), test.reading)
    x, y = ax.lines[1].get_data()
    np.testing.assert_allclose(y, test.offset + x * test.factor / test.stiffness, rtol=1e-12)
    assert not test.reading.flags.writeable


# rope and prior


def test_a_rope_from_tests_has_their_stiffnesses():
    rope = rd.Rope.from_tests(1.35, 0.1, bending=bent(), torsion=twisted(), axial_stiffness=1e5)
    assert rope.bending_stiffness == pytest.approx(B, rel=20 * EPS)
    assert rope.torsional_stiffness == pytest.approx(C, rel=20 * EPS)
    assert (rope.length, rope.linear_density, rope.axial_stiffness) == (1.35, 0.1, 1e5)
    assert rd.Rope.from_tests(1.35, 0.1, torsion=twisted()).bending_stiffness is None


def test_a_prior_is_a_mapping_from_paths_to_value_and_error():
    bending = bent(noise=scatter(2))
    prior = rd.Prior.of(bending=bending, torsion=twisted(scatter(3)))
    assert list(prior) == ["bending_stiffness", "torsional_stiffness"]
    assert prior["bending_stiffness"] == (bending.stiffness, bending.std)
    assert dict(prior) == prior
    assert pickle.loads(pickle.dumps(prior)) == prior
    more = prior | {"tension": (300, 10), "bending_stiffness": (1.0, 0.1)}
    assert (more["tension"], more["bending_stiffness"], len(more)) == ((300.0, 10.0), (1.0, 0.1), 3)
    assert "bending_stiffness" in str(prior)
    assert "<table>" in prior._repr_html_()


def test_a_test_tells_as_much_beside_peaks_as_alone():
    """Information adds: 1/std^2 of both is the sum of the two."""
    rope = rd.Rope(1.35, 0.1017, bending_stiffness=B, torsional_stiffness=C)
    scene = rd.Scene(rope, tension=3000.0)
    peaks = rd.Peaks(scene.compile().modes(3).frequency, std=0.2, order=[1, 2, 3])
    test = bent(noise=scatter(2, 2e-4))
    alone = rd.identify(scene, peaks, ["tension", "bending_stiffness"], ends="given")
    both = rd.identify(
        scene,
        peaks,
        ["tension", "bending_stiffness"],
        ends="given",
        prior=rd.Prior.of(bending=test),
    )
    stds = np.array([alone.std["bending_stiffness"], test.std])
    assert 0.2 < stds[0] / stds[1] < 5  # both matter
    # B moved by a part of its error, and slopes with it
    expected = (stds**-2.0).sum() ** -0.5
    assert both.std["bending_stiffness"] == pytest.approx(expected, rel=0.02)
    weighted = (B / stds[0] ** 2 + test.stiffness / stds[1] ** 2) * expected**2
    assert both.value["bending_stiffness"] == pytest.approx(weighted, abs=0.02 * expected)


# what has no meaning

REFUSED = {
    "span": lambda: rd.BendingTest(0.0, [0.0, 1.0], [0.0, 1.0]),
    "force": lambda: rd.BendingTest(L, [1.0, 1.0], [0.0, 1.0]),
    "force all": lambda: rd.BendingTest(L, [0.0, 0.0], [0.0, 1.0], zero=0.0),
    "deflection must have": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0]),
    "deflection must grow": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, -1.0]),
    "deflection[1]": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, math.nan]),
    "ends": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0], ends="free"),
    "x must not": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0], x=0.0),
    "x must lie": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0], x=0.6),
    "read_at": lambda: rd.BendingTest(L, [0, 1], [0, 1], read_at=L, ends="clamped"),
    "zero": lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0], zero=math.inf),
    "reading_std must be a": lambda: rd.TorsionTest(L, [0.0, 1.0], [0.0, 1.0], reading_std=0.0),
    "angle": lambda: rd.TorsionTest(L, [0.0, 1.0], [0.0, 0.0]),
    "length": lambda: rd.TorsionTest(-1.0, [0.0, 1.0], [0.0, 1.0]),
    "confidence": lambda: twisted(scatter(1)).interval(1.0),
    "bending or torsion": lambda: rd.Rope.from_tests(1.0, 0.1),
    "bending_stiffness": lambda: rd.Rope.from_tests(
        1.0, 0.1, bending=bent(), bending_stiffness=1.0
    ),
    "known": lambda: rd.Prior({}),
    "['tension'] must": lambda: rd.Prior({"tension": (1.0, 2.0, 3.0)}),
    "['tension'][1]": lambda: rd.Prior({"tension": (1.0, 0.0)}),
    "reading_std must be given": lambda: rd.Prior.of(
        bending=rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0])
    ),
}


@pytest.mark.parametrize("what", REFUSED)
@pytest.mark.filterwarnings("ignore:deflection is up to:ropedyn.UnitWarning")
def test_what_no_test_can_tell_is_refused(what):
    with pytest.raises(rd.SceneError) as caught:
        REFUSED[what]()
    name, *rest = what.split(" ", 1)
    message = str(caught.value)
    assert name in message
    assert " must " in message
    assert all(words in message for words in rest)


@pytest.mark.parametrize(
    ("what", "call"),
    [
        ("bending", lambda: rd.Rope.from_tests(1.0, 0.1, bending=twisted())),
        ("torsion", lambda: rd.Prior.of(torsion=3.0)),
        ("force", lambda: rd.BendingTest(L, None, [1.0])),
        ("ends", lambda: rd.BendingTest(L, [0.0, 1.0], [0.0, 1.0], ends=None)),
        ("known", lambda: rd.Prior([("tension", (1.0, 1.0))])),
        ("path", lambda: rd.Prior({3: (1.0, 1.0)})),
        ("prior['tension']", lambda: rd.Prior({"tension": 1.0})),
    ],
)
def test_wrong_types_are_said(what, call):
    with pytest.raises(TypeError) as caught:
        call()
    assert what in str(caught.value)
