"""The command that computes a section: what it prints, draws and refuses."""

import json

import pytest

import ropedyn as rd
from ropedyn.cli.command import main

LINE = ["section", "6x19S", "--diameter", "16e-3"]


def test_section_prints_what_the_construction_says(capsys):
    assert main([*LINE, "--core", "FC", "--lay", "zZ", "--torsion", "stick", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    made = rd.Construction.standard("6x19S", diameter=16e-3, core="FC", lay="zZ")
    assert [tuple(row.values()) for row in rows] == list(made.section("stick").table().rows)


def test_section_takes_lays_and_leaves_tables_aside(capsys):
    more = [
        "--lay-length",
        "0.1",
        "--strand-lay",
        "0.04",
        "--unscaled",
        "--radial-stiffness",
        "4e5",
    ]
    assert main([*LINE, *more, "--radial-stiffness", "4e5"]) == 0
    made = rd.Construction.standard(
        "6x19S", diameter=16e-3, lay_length=0.1, strand_lay=0.04, scaled=False
    )
    assert capsys.readouterr().out.strip() == str(made.section(radial_stiffness=4e5))


def test_section_draws_its_wires(tmp_path, capsys):
    assert main([*LINE, "--plot", str(tmp_path / "wires.png")]) == 0
    assert (tmp_path / "wires.png").stat().st_size > 10_000


def test_a_bad_line_is_refused(capsys):
    assert main([*LINE, "--lay", "Z"]) == 2
    assert "lay must be one of" in capsys.readouterr().err
    with pytest.raises(SystemExit):
        main(["section", "6x18", "--diameter", "16e-3"])
