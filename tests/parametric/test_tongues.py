"""Edges of tongues: Mathieu's numbers, scans by brute force, and what a count can prove."""

import numpy as np
import pytest
from conftest import slow
from scipy.special import mathieu_a, mathieu_b

import ropedyn as rd
from ropedyn.motion.modal_system import ModalSystem
from ropedyn.parametric import decay, hill, krein
from ropedyn.parametric.monodromy import Propagator, exponent
from ropedyn.parametric.tongues import boundary, threshold

ONE = ModalSystem(np.array([1.0]), np.array([[1.0]]), np.zeros((1, 1)))
"""q'' + (1 + a cos(2 pi f t)) q = 0."""
NO_GROWTH = 1e-8
"""A scan cannot tell growth below this over a period from none, beside its threshold."""


def random_system(rng):
    """One to four coupled modes: undamped, with ratios, or with damping that couples them."""
    k = int(rng.integers(1, 5))
    omega = np.sort(rng.uniform(1.0, 4.0, k))
    slopes = rng.normal(size=(k, k + 1))
    slopes *= (omega / np.linalg.norm(slopes, axis=1))[:, None]
    kind = rng.integers(3)
    damping = np.zeros((k, k))
    if kind == 1:
        damping = np.diag(2 * omega * 10 ** rng.uniform(-3.5, -1.3, k))
    if kind == 2:
        dashpots = rng.normal(size=(k, k))
        damping = dashpots @ dashpots.T * 10 ** rng.uniform(-3.5, -1.5)
    return ModalSystem(omega**2, slopes @ slopes.T, damping)


def wrong_points(rng, points):
    """How many points of a scan find another stability than the edges tell; whether proved."""
    system, amplitude = random_system(rng), rng.uniform(0.05, 0.6)
    top = 2 * system.omega.max() / (2 * np.pi)
    low, high = top / rng.uniform(1.5, 9.5), 1.15 * top
    found = boundary(system, low, high, amplitude)
    scan = np.linspace(low, high, points)
    motion = Propagator.of(system, 1 / high, 1 / low, amplitude)
    growth = np.log(np.abs(np.linalg.eigvals(motion(1 / scan))).max(axis=1))
    some = scan[:: points // 5]
    exact = exponent(system, some, np.full((len(some), 1), amplitude), angle=0.4)[:, 0]
    assert growth[:: points // 5] == pytest.approx(exact, abs=1e-6)
    least = threshold(system, scan)
    # one state of the scan is given, where it is clear
    inside = np.searchsorted(found.frequency, scan) % 2 == 1
    clear = np.abs(growth - least).argmax()
    expected = inside ^ inside[clear] ^ (growth[clear] > least[clear])
    off = np.where(expected, least - growth, growth - least)
    # tongues without damping may grow by less than is seen, and only they
    hidden = expected & (growth > -NO_GROWTH) & (least > 0)
    return int(((off > NO_GROWTH) & ~hidden).sum()), found


@pytest.mark.parametrize("number", [*range(4), *slow(*range(4, 12))])
def test_edges_are_those_of_a_scan(number):
    """Of modes up to the ninth order; none missed, none invented."""
    wrong, found = wrong_points(np.random.default_rng([2, number]), 4000)
    assert wrong == 0
    assert found.proved


@pytest.mark.slow
@pytest.mark.claim(
    "points of scans of 20 000 where tongues of 100 random systems are missed or invented",
    reference="multipliers at every point",
    accepted=0.0,
)
def test_edges_are_those_of_scans(claim):
    claim(sum(wrong_points(np.random.default_rng([7, n]), 20_000)[0] for n in range(100)))


@pytest.mark.claim(
    "relative error of both edges of nine tongues of a string",
    reference="Mathieu's characteristic values (SciPy)",
    accepted=5e-14,
)
@pytest.mark.parametrize("amplitude", [0.2, 0.9])
def test_tongues_of_one_mode_are_those_of_mathieu(amplitude, claim):
    """Down to a width of 1e-8: alpha(Omega) = 4/Omega^2 is a_n or b_n of q = a alpha/2."""
    found = boundary(ONE, 0.21 / (2 * np.pi), 2.5 / (2 * np.pi), amplitude)
    assert found.proved
    assert found.highest_order == 9
    for order in range(1, found.order.max() + 1):
        edge = 2 * np.pi * found.frequency[found.order == order]
        assert len(edge) == 2
        alpha = 4 / edge**2
        known = np.array(
            [[one(order, amplitude * x / 2) for one in (mathieu_a, mathieu_b)] for x in alpha]
        )
        off = np.abs(known / alpha[:, None] - 1)
        claim(off.min(axis=1).max())
        assert sorted(off.argmin(axis=1)) == [0, 1]


@pytest.mark.parametrize("amplitude", [1.0, 1.2, 2.0])
def test_orders_where_the_tension_changes_sign_are_those_of_mathieu(amplitude):
    found = boundary(ONE, 0.2 / (2 * np.pi), 2.6 / (2 * np.pi), amplitude)
    assert found.proved
    alpha = 4 / (2 * np.pi * found.frequency) ** 2
    numbers = range(1, 12)
    known = [
        [one(n, amplitude * x / 2) for n in numbers for one in (mathieu_a, mathieu_b)]
        for x in alpha
    ]
    nearest = np.abs(np.array(known) / alpha[:, None] - 1).argmin(axis=1)
    assert found.order.tolist() == (nearest // 2 + 1).tolist()
    assert found.highest_order >= max(found.order)


def test_orders_are_even_where_motion_returns_after_a_period_and_odd_after_two():
    seen = []
    for number in range(12):
        system = random_system(np.random.default_rng([31, number]))
        top = 2 * system.omega.max() / (2 * np.pi)
        low, high, amplitude = top / 6, 1.15 * top, 0.9
        found = boundary(system, low, high, amplitude)
        motion = Propagator.of(system, 1 / high, 1 / low, amplitude)
        for value, order in zip(np.linalg.eigvals(motion(1 / found.frequency)), found.order):
            # the two that meet are the root of rounding off each other, what damping leaves is real
            count = 1 if system.damping.any() else 2
            after = [np.sort(np.abs(value - one))[count - 1] < 1e-5 for one in (1.0, -1.0)]
            if after[0] != after[1]:
                seen.append(order)
                assert order % 2 == int(after[1])
    assert len(seen) >= 40


def test_the_order_of_modes_that_mix_is_that_of_the_tongue_it_began_as():
    """Followed to a tenth of the amplitude 2 f3/f is 4.00002."""
    rope, part = rd.Rope(1.0, 0.1, bending_stiffness=10.4677), rd.PointMass(0.32864, 0.028736)
    scene = rd.Scene(rope, tension=1000.0, parts=[part], ends=("clamped", "pinned"))
    found = scene.compile().stability_map([110.0, 112.0], [0.0], modes=3).boundary(354.0)
    nearest = np.abs(found.frequency - 111.3353).argmin()
    assert found.frequency[nearest] == pytest.approx(111.3353, abs=2e-4)
    assert found.order[nearest] == 4


def test_a_tongue_as_narrow_as_rounding_has_its_edges():
    """Of order 9 at a tenth of the mean tension: 3e-11 of its frequency wide."""
    found = boundary(ONE, 0.2220 / (2 * np.pi), 0.2222 / (2 * np.pi), 0.1)
    assert found.order.tolist() == [9, 9]
    assert 1e-11 < np.ptp(found.frequency) / found.frequency[0] < 1e-10


ALIKE = ModalSystem(
    np.array([37.206435551991575, 37.20792313357203, 37.20792313357203]),
    np.array(
        [
            [37.14545708033866, 0.03211764993092806, 1.5043806432142193],
            [0.03211764993092806, 0.0034804000379310956, 0.005643700832649287],
            [1.5043806432142193, 0.005643700832649287, 0.07669824786348248],
        ]
    ),
    np.zeros((3, 3)),
)
"""Three modes whose bands lie within 1e-6 of each other."""


def modes_alike(rng):
    """Two to four modes as far apart as 1e-8 to 1e-2, of which slopes of any size couple some."""
    k = int(rng.integers(2, 5))
    omega = 2 * np.pi * (1 + np.append(0.0, np.cumsum(10 ** rng.uniform(-8, -2, k - 1))))
    slopes = rng.normal(size=(k, k)) * 10 ** rng.uniform(-2, 0, (k, 1))
    size = np.linalg.eigvalsh(slopes @ slopes.T / np.multiply.outer(omega, omega)).max()
    return ModalSystem(omega**2, slopes @ slopes.T / size, np.zeros((k, k)))


def growth_between(system, amplitude, low, high):
    """Widths of tongues and gaps between edges, and growth beside, in and beside each, (n, 5)."""
    edge = boundary(system, low, high, amplitude).frequency
    part = np.array([-0.05, 0.1, 0.5, 0.9, 1.05])
    width = np.diff(edge)
    motion = Propagator.of(system, 1 / high, 1 / low, amplitude)
    at = edge[:-1, None] + np.multiply.outer(width, part)
    value = np.linalg.eigvals(motion(1 / at.ravel()))
    return width, np.log(np.abs(value)).max(axis=1).reshape(at.shape)


def test_tongues_of_modes_alike_are_as_wide_as_they_grow():
    """Growth is half an ellipse between the edges of a narrow tongue, and none beside it."""
    rng, tongues = np.random.default_rng(11), []
    asked = [(ALIKE, 0.9540519257800963, 0.45, 1.5)]
    for _ in range(40):
        alone = 2 / rng.integers(2, 5)
        asked.append((modes_alike(rng), rng.uniform(0.3, 0.9), 0.9 * alone, 1.03 * alone))
    for one in asked:
        width, growth = growth_between(*one)
        seen = width > 1e-11
        grows = seen & (growth[:, 2] > 1e-12)
        # every second one is a tongue
        assert ((grows[1:] != grows[:-1]) | ~seen[1:] | ~seen[:-1]).all()
        tongues.append(growth[grows & (width < 1e-6)])
    found = np.concatenate(tongues)
    assert len(found) > 20
    # rounding leaves 1e-13 of what keeps its size
    assert found[:, [1, 3]] == pytest.approx(0.6 * found[:, [2, 2]], rel=0.05, abs=1e-12)
    assert np.abs(found[:, [0, 4]]).max() < 1e-12


@pytest.mark.parametrize("beyond", [0.0, 1e-12, 1e-9, 1e-7])
@pytest.mark.parametrize("amplitude", [1e-3, 0.1])
def test_a_tongue_that_ends_where_the_range_does_is_found(amplitude, beyond):
    """It was missed, and proved to be none."""
    low, high = 0.9 / np.pi, 1.1 / np.pi
    whole = boundary(ONE, low, high, amplitude)
    begin, end = whole.frequency
    above = boundary(ONE, low, end * (1 + beyond), amplitude)
    below = boundary(ONE, begin * (1 - beyond), high, amplitude)
    assert above.proved
    assert below.proved
    # edges lie between the ends, to rounding
    least = 1 if beyond == 0 else 2
    assert least <= len(above.frequency) <= 2
    assert least <= len(below.frequency) <= 2
    assert above.frequency[0] == pytest.approx(begin, rel=1e-14)
    assert below.frequency[-1] == pytest.approx(end, rel=1e-14)


def test_modes_that_do_not_couple_pass_without_a_tongue():
    """f1 + f2 of a system without Gamma_12 is counted, and has no width."""
    coupled = ModalSystem(
        np.array([1.0, 2.25]), np.array([[1.0, 1e-3], [1e-3, 2.0]]), np.zeros((2, 2))
    )
    apart = ModalSystem(coupled.eigenvalue, np.diag([1.0, 2.0]), coupled.damping)
    near = (2.49 / (2 * np.pi), 2.51 / (2 * np.pi))
    wide = boundary(coupled, *near, 0.01)
    assert wide.order.tolist() == [1, 1]
    assert wide.resonances == 1
    assert len(boundary(apart, *near, 0.01).frequency) == 0


def test_unlike_damping_opens_a_combination():
    """Half width (c1 + c2)/2 sqrt((a Gamma_12)^2/(4 w1 w2 c1 c2) - 1), to first order."""
    c = np.array([0.002, 0.02])
    w, coupling, amplitude = np.array([1.0, 1.6]), 1.0, 0.04
    gamma = np.array([[1.0, coupling], [coupling, 2.0]])
    expected = c.sum() / 2 * np.sqrt((amplitude * coupling) ** 2 / (4 * w.prod() * c.prod()) - 1)
    near = (2.45 / (2 * np.pi), 2.75 / (2 * np.pi))
    damped = boundary(ModalSystem(w**2, gamma, np.diag(c)), *near, amplitude)
    still = boundary(ModalSystem(w**2, gamma, np.zeros((2, 2))), *near, amplitude)
    width = np.pi * np.array([np.ptp(damped.frequency), np.ptp(still.frequency)])
    assert width[0] == pytest.approx(expected, rel=0.02)
    assert width[0] > 1.5 * width[1]


@pytest.mark.parametrize(
    ("bending", "dashpot", "modes", "amplitude", "between", "gap"),
    [
        (0.85, rd.Dashpot(0.15, 0.086), 3, 290.0, (39.0, 83.0), 51.87),
        (0.44, rd.Dashpot(0.12, 0.034), 4, 380.0, (31.0, 59.0), 51.496),
    ],
    ids=["of three modes", "of four"],
)
def test_a_gap_between_tongues_is_seen_from_afar(bending, dashpot, modes, amplitude, between, gap):
    """Two edges 1e-3 of their frequency apart were one double root: proved, without the gap."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=bending)
    scene = rd.Scene(rope, tension=1000.0, ends=("pinned", "clamped"), parts=[dashpot])
    grid = np.sort([*between, gap, gap - 0.05, gap + 0.05])
    found = scene.compile().stability_map(grid, [0.0, amplitude], modes=modes)
    edges = found.boundary(amplitude)
    assert edges.proved
    inside = np.searchsorted(edges.frequency, grid) % 2 == 1
    np.testing.assert_array_equal(inside, ~found.stable[1])
    assert found.stable[1, 2]


def test_growth_lost_in_rounding_is_not_proved():
    weak = ModalSystem(ONE.eigenvalue, ONE.geometric, np.array([[1e-9]]))
    found = boundary(weak, 0.2, 0.5, 0.1)
    assert not found.proved
    assert len(found.frequency) == 2
    assert "some may be missed" in str(found.table())


def test_what_polynomials_cannot_resolve_is_not_proved(monkeypatch):
    system = ModalSystem(ONE.eigenvalue, ONE.geometric, np.array([[0.01]]))
    monkeypatch.setattr(decay, "RESOLVED", 0.0)
    assert not boundary(system, 0.2, 0.5, 0.1).proved


def test_what_nothing_damps_beside_what_is_damped_is_not_proved_in_few_pieces(monkeypatch):
    pieces, product = [], decay._product
    monkeypatch.setattr(decay, "_product", lambda *of: pieces.append(len(of[1])) or product(*of))
    scene = rd.Scene(
        rd.Rope(1.0, 0.1, bending_stiffness=1.0),
        tension=1000.0,
        ends=("pinned", "clamped"),
        damping=rd.ModalDamping((0.0, 0.01, 0.0)),
    )
    stability = scene.compile().stability_map([30.0, 220.0], [0.0], modes=3)
    edges = [stability.boundary(amplitude) for amplitude in (0.1, 0.01)]
    assert not any(one.proved for one in edges)
    assert max(pieces) <= decay.MOST
    # the first tongue is as wide as the amplitude is large
    wide, narrow = (np.ptp(one.frequency[:2]) for one in edges)
    assert narrow == pytest.approx(wide / 10, rel=0.02)


def test_a_turn_too_many_is_not_proved(monkeypatch):
    """The count of Hill's matrix holds the phases to account."""
    monkeypatch.setattr(krein, "turns", lambda *given: 2 * hill.turns(*given) + 1)
    assert not boundary(ONE, 0.1, 0.5, 0.1).proved


@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_where_a_tension_that_changes_sign_lets_it_stand(damping):
    """Beyond the mean tension tongues cover nearly everything; what is left is found."""
    system = ModalSystem(ONE.eigenvalue, ONE.geometric, np.array([[damping]]))
    found = boundary(system, 0.05, 0.6, 2.0)
    assert found.proved
    scan = np.linspace(0.05, 0.6, 3001)
    growth = exponent(system, scan, np.full((len(scan), 1), 2.0), angle=0.5)[:, 0]
    grows = growth > threshold(system, scan)
    at = np.flatnonzero(grows[1:] != grows[:-1])
    for begin, end in zip(scan[at], scan[at + 1]):
        assert ((begin <= found.frequency) & (found.frequency <= end)).sum() % 2 == 1
