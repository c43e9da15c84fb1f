"""How the elements are shared out over the spans."""

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import ropedyn as rd
from ropedyn.scene import stations


def every_distribution(elements, spans):
    """All ways to give each span at least one element."""
    for cut in itertools.combinations(range(1, elements), spans - 1):
        yield np.diff((0, *cut, elements))


@given(
    st.lists(st.integers(1, 30), min_size=1, max_size=4),
    st.integers(0, 9),
)
def test_longest_element_is_as_short_as_any_distribution_makes_it(lengths, more):
    elements = len(lengths) + more
    counts = stations.shares(np.array(lengths, dtype=float), elements)

    def longest(shares):
        return max(Fraction(length, int(n)) for length, n in zip(lengths, shares))

    best = min(longest(shares) for shares in every_distribution(elements, len(lengths)))
    assert counts.sum() == elements
    assert counts.min() >= 1
    # whole lengths: compared without rounding
    assert longest(counts) == best


@given(st.lists(st.floats(1e-6, 1.0), min_size=1, max_size=12), st.integers(0, 5000))
def test_taking_an_element_from_a_span_never_helps_another(lengths, more):
    # the longest element could only be shortened by an element from a span whose own would then
    # stay below it
    lengths = np.array(lengths)
    counts = stations.shares(lengths, len(lengths) + more)
    longest = (lengths / counts).max()
    spare = counts > 1
    assert (lengths[spare] / (counts[spare] - 1) >= longest * (1 - 1e-15)).all()
    assert counts.sum() == len(lengths) + more


@pytest.mark.parametrize("spans", [1, 2, 3, 7])
def test_equal_spans_get_equal_shares(spans):
    assert (stations.shares(np.full(spans, 0.3), 5 * spans) == 5).all()


@pytest.mark.parametrize(
    ("lengths", "elements", "expected"),
    [
        ([1.0, 3.0], 4, [1, 3]),
        ([1.0, 3.0], 8, [2, 6]),
        ([1e-6, 1.0], 5, [1, 4]),
        ([0.3, 0.4, 0.3], 10, [3, 4, 3]),
        ([1.0, 1.0, 1e-9], 3, [1, 1, 1]),
    ],
)
def test_shares_are_proportional_where_they_can_be(lengths, elements, expected):
    np.testing.assert_array_equal(stations.shares(np.array(lengths), elements), expected)


def test_fewer_elements_than_spans_are_refused():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=[rd.PointMass(0.3, 1.0)])
    with pytest.raises(rd.SceneError, match=r"elements must be at least 2.*got 1"):
        scene.compile(elements=1)


def test_nodes_stand_at_every_station_and_evenly_between():
    parts = [rd.Spring(0.3, 1.0), rd.PointMass(0.8, 0.1), rd.Support(0.3, coordinate="z")]
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=parts).compile(elements=10)
    expected = [0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    np.testing.assert_allclose(model.x, expected, rtol=2.3e-16, atol=0)
    assert model.x[3] == 0.3
    assert model.x[8] == 0.8
    assert model.x[0] == 0.0
    assert model.x[-1] == 1.0


@pytest.mark.parametrize("away", [0.9e-9, -0.9e-9, 0.0])
def test_stations_within_a_billionth_of_the_length_are_one(away):
    parts = [rd.PointMass(0.5, 0.1), rd.PointMass(0.5 + away, 0.2), rd.PointMass(abs(away), 7.0)]
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=parts).compile(elements=2)
    assert len(model.x) == 3
    # both masses and half of each element stand there
    assert model.mass_matrix().toarray()[0, 0] == pytest.approx(0.3 + 0.05, rel=1e-15)


@given(st.lists(st.floats(0.01, 0.99), max_size=5), st.integers(6, 40))
def test_lumping_keeps_the_mass_of_the_rope(positions, elements):
    parts = [rd.PointMass(x, 0) for x in positions]
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, rotary_inertia=0.003)
    scene = rd.Scene(rope, ends=("free", "free"), parts=parts)
    mass = scene.compile(elements=elements).mass_matrix().diagonal()
    # sums of up to 40 numbers
    assert mass[0::2].sum() == pytest.approx(0.1, rel=1e-14)
    assert mass[1::2].sum() == pytest.approx(0.003, rel=1e-14)
    assert (mass > 0).all()


def test_lengths_that_differ_by_the_rounding_of_positions_are_one_element():
    n, length = 1000, 1.35
    parts = [rd.PointMass(length * k / n, 0.1) for k in range(1, n)]
    chain = rd.Scene(rd.Rope(length, 0.1), tension=1.0, parts=parts).compile(elements=n).chain
    # differences of neighbouring positions: several numbers, one length
    assert len(np.unique(np.diff([0.0, *(p.x for p in parts), length]))) > 1
    assert len(chain.length) == 1
    assert chain.length[0] == pytest.approx(length / n, rel=1e-15)


def test_different_lengths_stay_different():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=[rd.PointMass(0.5 + 1e-8, 1.0)])
    chain = scene.compile(elements=2).chain
    np.testing.assert_allclose(chain.length, [0.5 + 1e-8, 0.5 - 1e-8], rtol=2.3e-16)


def test_uniform_rope_is_three_stretches_however_long():
    chain = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0).compile(elements=1_000_000).chain
    assert chain.first.tolist() == [0, 1, 1_000_000]
    assert chain.nodes == 1_000_001
    assert chain.element.tolist() == [0, 0]
    assert [chain.stretch(node) for node in (0, 1, 999_999, 1_000_000)] == [0, 1, 1, 2]


@given(st.lists(st.floats(0.01, 0.99), max_size=6), st.integers(7, 60))
def test_stretches_say_what_stands_at_every_node(positions, elements):
    parts = [rd.PointMass(x, 0.1 + x) for x in positions]
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=parts).compile(elements=elements)
    chain = model.chain
    # positions are the sums of lengths, each known to the rounding of a position
    x = np.concatenate([[0.0], np.cumsum(chain.length[chain.element_of])])
    np.testing.assert_allclose(x, model.x, rtol=0, atol=4e-16 * elements)
    for node in range(chain.nodes):
        assert chain.term_of[node] == chain.term[chain.stretch(node)]
    total = chain.mass[chain.term_of, 0, 0].sum()
    assert total == pytest.approx(0.1 + sum(p.mass for p in parts), rel=1e-14)
