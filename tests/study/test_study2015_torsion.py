"""The study's third peak: what constructions of its diameter say of torsion."""

import pytest
from conftest import reference

from ropedyn import study2015

CASES = reference("rope_constructions")["friction_states_and_torsion_4mm_1.35m"]
# without the lay 398 to 636 Hz, with it as in the analysis of 4 mm ropes, to 1 Hz
KNOWN = {
    "1x19, layers crossed": (443, 443),
    "1x19, layers alike": (299, 299),
    "7x7": (247, 322),
    "7x19": (223, 315),
    "6x7 FC": (132, 243),
    "6x19 FC": (94, 239),
}
MASS = {"1x19, layers alike": 0.077, "7x7": 0.064, "7x19": 0.062, "6x19 FC": 0.053}


def test_torsional_frequencies_are_those_of_the_reference():
    rows = {row[0]: row for row in study2015.torsion().rows}
    for name, case in ("7x7", "7x7 regular"), ("6x7 FC", "6x7 FC regular"):
        expected = [float(f) for f in CASES[case]["f1_coupled_slip_bonded_Hz"]]
        assert rows[name][-2:] == pytest.approx(expected, rel=1e-12)


def test_the_lay_lowers_torsion_to_what_is_known():
    table = study2015.torsion()
    rows = {row[0]: row for row in table.rows}
    for name, known in KNOWN.items():
        assert rows[name][-2:] == pytest.approx(known, abs=1.0)
    alone = table.column("no lay coupling [Hz]")
    assert round(min(alone)) == 398 and max(alone) < 636
    ratio = [f / low for f, low in zip(alone, table.column("slip [Hz]"))]
    assert min(ratio) > 1.15 and 4.25 < max(ratio) < 4.35


def test_no_rope_of_four_millimetres_has_the_mass_of_the_study():
    rows = {row[0]: row for row in study2015.torsion().rows}
    for name, mass in MASS.items():
        assert rows[name][1] == pytest.approx(mass, abs=6e-4)
    assert max(row[1] for row in rows.values()) < study2015.MASS / study2015.LENGTH


def test_the_diameter_does_not_matter():
    made = study2015.constructions()["7x7"]
    big = type(made).standard("7x7", diameter=10 * study2015.DIAMETER)
    found = [one.section().torsional_frequency(1.35, 3) for one in (made, big)]
    assert found[0] == pytest.approx(found[1], rel=1e-12)
