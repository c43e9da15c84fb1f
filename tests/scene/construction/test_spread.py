"""What a catalogue line leaves open: draws, intervals, priors, and their use."""

import time

import numpy as np
import pytest
from test_section import stiffnesses

import ropedyn as rd
from ropedyn.scene.construction.catalogue import NAMES
from ropedyn.scene.construction.draws import Scatter, sections

SURE = {"modulus": (1.0, 1.0), "lay": 0.0, "diameter": (1.0, 1.0), "core": (1e15, 1e15)}
NAME = {"diameter": 4e-3, "lay": "zZ"}
SEVEN = rd.Construction.standard("7x7", **NAME)


def test_without_doubt_draws_lie_between_slip_and_stick():
    spread = SEVEN.section().spread(200, **SURE)
    slip, stick = (np.array(stiffnesses(SEVEN.section(state))) for state in ("slip", "stick"))
    found = [spread.axial_stiffness, spread.lay_coupling, spread.torsional_stiffness]
    share = (np.array(found).T - slip) / (stick - slip)
    assert (share > -1e-6).all() and (share < 1 + 1e-6).all()
    # of one state: the share of EA, whose change is small, has the rounding of EA
    assert np.abs(share[:, 2] - share[:, 1]).max() < 1e-9
    assert 0.95 < np.ptp(share[:, 2]) <= 1
    B = spread.bending_stiffness
    section = SEVEN.section()
    assert section.bending_slip * (1 - 1e-12) < B.min() < 1.1 * section.bending_slip
    assert section.bending_stick * (1 + 1e-12) > B.max() > 0.9 * section.bending_stick


@pytest.mark.parametrize("core", ["FC", "IWRC"])
def test_each_draw_is_the_section_of_its_numbers(core):
    E, size, lay, inner, k_r = 0.97, 1.03, 1.12, 0.91, 0.05
    how = {"diameter": 16e-3, "core": core, "scaled": False}
    plain = rd.Construction.standard("6x36WS", **how)

    def changed(thing, level):
        if isinstance(thing, rd.Wire):
            return rd.Wire(thing.diameter * size, youngs_modulus=E * thing.youngs_modulus)
        if isinstance(thing, rd.Fibre):
            return rd.Fibre(thing.diameter * size)
        layers = [
            rd.Layer(
                one.count,
                changed(one.element, 1),
                lay=one.lay * (inner if level else lay),
                sense=one.sense,
                radius=radius * size,
            )
            for one, radius in zip(thing.layers, thing.radii)
        ]
        return rd.Construction(changed(thing.core, level), layers)

    one = changed(plain, 0)
    for stick, state in ((0.0, "slip"), (1.0, "stick")):
        numbers = [E, size, lay, inner, k_r, stick, stick]
        e, d, p, q, k, s, t = (np.full(3, number) for number in numbers)
        found = sections(plain.strand, Scatter(e, d, (p, q), k, s, t))
        rigid = one.section(state).axial_stiffness
        section = one.section(state, radial_stiffness=k_r * rigid)
        B = section.bending_stick if stick else section.bending_slip
        assert np.abs(found / [*stiffnesses(section), B] - 1).max() < 1e-13


def test_ten_thousand_draws_take_two_seconds_at_most():
    section = rd.Construction.standard("6x36WS", diameter=16e-3, core="IWRC").section()
    start = time.process_time()
    section.spread(10_000)
    assert time.process_time() - start < 2.0


def test_a_section_takes_five_milliseconds_at_most():
    made = rd.Construction.standard("6x36WS", diameter=16e-3, core="IWRC")
    seconds = []
    for _ in range(20):
        start = time.process_time()
        made.section()
        seconds.append(time.process_time() - start)
    assert sorted(seconds)[10] < 5e-3


def test_the_prior_has_the_variables_of_the_draws():
    spread = rd.Construction.standard("6x19S", diameter=16e-3, core="FC").section().spread(4000)
    prior = spread.prior()
    rows = [np.log(spread.axial_stiffness), spread.twist_per_stretch]
    rows += [np.log(spread.free_torsional_stiffness), np.log(spread.bending_stiffness)]
    law = prior.law
    assert law.by_log.tolist() == [True, False, True, True]
    assert list(prior.distribution.values()) == ["laid"] * 3 + ["log-normal"]
    assert np.abs(law.centre / np.mean(rows, axis=1) - 1).max() < 1e-12
    S, spread_of_z = np.cov(rows), law.spread
    size = np.sqrt(np.diag(S))
    assert np.abs((spread_of_z @ spread_of_z.T - S) / np.outer(size, size)).max() < 1e-9


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("sense", [0, 1])
def test_no_rope_of_a_prior_is_one_that_cannot_be(name, sense):
    word = "ZS"[sense] if name[0] == "1" else ("sZ", "zS")[sense]
    made = rd.Construction.standard(name, diameter=16e-3, lay=word)
    prior = made.section().priors(n=500)
    EA, D, C, _ = prior.draw(np.random.default_rng(1), 2000).T
    assert (EA * C > D**2).all()
    # standard errors of 2000 draws, whose tails are heavy: 5 of them
    off = np.array([EA.mean(), D.mean(), C.mean()]) - prior.mean[:3]
    assert (np.abs(off) < 5 * prior.std[:3] / np.sqrt(2000)).all()
    assert np.sign(prior["lay_coupling"][0]) == (1, -1)[sense]


def test_intervals_hold_the_moduli_of_practice():
    # ropes of fibre core have 90 to 120 GPa, of steel core 100 to 130, strands 150 to 190
    for name, core, low, high in (
        ("6x19S", "FC", 90, 120),
        ("6x19S", "IWRC", 110, 130),
        ("1x19", None, 175, 190),
    ):
        section = rd.Construction.standard(name, diameter=16e-3, core=core).section()
        least, most = section.spread(2000).interval()["axial_stiffness"]
        assert least < low * 1e9 * section.area < high * 1e9 * section.area < most


def test_twist_per_stretch_and_free_torsion_are_of_each_draw():
    spread = SEVEN.section().spread(100, seed=3)
    again = SEVEN.section().spread(100, seed=3)
    assert spread.lay_coupling.tolist() == again.lay_coupling.tolist()
    D, EA, C = spread.lay_coupling, spread.axial_stiffness, spread.torsional_stiffness
    assert np.allclose(spread.twist_per_stretch, D / EA, rtol=1e-15)
    assert np.allclose(spread.free_torsional_stiffness, C - D * D / EA, rtol=1e-12)
    low, high = spread.interval(0.5)["lay_coupling"]
    assert np.mean((low <= D) & (high >= D)) == 0.5
    assert spread.table().rows[0][0] == "axial stiffness [N]"


def test_a_prior_of_its_construction_narrows_what_is_identified():
    rope = rd.Rope.from_construction(3.0, SEVEN, bending="slip")
    scene = rd.Scene(rope.replace(axial_stiffness=None, lay_coupling=None), tension=400.0)
    truth = scene.replace(rope=scene.rope.replace(bending_stiffness=0.3))
    peaks = rd.Peaks(truth.compile().modes(8).frequency, std=0.5, order=range(1, 9))
    prior = SEVEN.section().priors().marginal(["bending_stiffness"])
    unknown = ["tension", "bending_stiffness"]
    fits = [rd.identify(scene, peaks, unknown, ends="given", prior=one) for one in (None, prior)]
    for fit in fits:
        low, high = fit.interval(0.95)[1]
        assert low < 0.3 < high
    widths = [np.diff(fit.interval(0.95)[1])[0] for fit in fits]
    assert widths[1] < widths[0]


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"n": 10}, rd.SceneError, "n must be a whole number from 100"),
        ({"lay": 1.0}, rd.SceneError, "lay must be below 1"),
        ({"modulus": (1.1, 0.9)}, rd.SceneError, "the smaller first"),
        ({"diameter": 1.05}, TypeError, "diameter must be two factors"),
        ({"core": (0.0, 1.0)}, rd.SceneError, r"core\[0\] must be a finite number > 0"),
        ({"seed": -1}, rd.SceneError, "seed must be"),
    ],
)
def test_ranges_without_meaning_are_refused(how, error, message):
    with pytest.raises(error, match=message):
        SEVEN.section().spread(**how)


def test_a_level_beyond_one_is_refused():
    with pytest.raises(rd.SceneError, match="level must be below 1"):
        SEVEN.section().spread(100).interval(1.0)
