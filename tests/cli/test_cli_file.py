"""Commands about files: what a measured one holds, and the schemas of what is printed."""

import json
from importlib import resources

import jsonschema
import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main

TIME = np.arange(100) / 1000
RECORD = rd.Record(
    TIME,
    np.sin([40 * TIME, 30 * TIME]),
    rate=1000.0,
    response=[("z", 0.4), ("z", 0.6)],
    quantity="acceleration",
    force=np.cos(40 * TIME),
    drive=("z", 1.0),
)


def printed(capsys, *arguments):
    assert main([*map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)["rows"]


@pytest.mark.parametrize("binary", [True, False])
def test_functions_of_a_universal_file_are_listed(tmp_path, capsys, binary):
    RECORD.write(tmp_path / "a.uff", binary=binary)
    rows = printed(capsys, "inspect", tmp_path / "a.uff")
    assert [row["function"] for row in rows] == ["time response"] * 3
    assert [row["response"] for row in rows] == ["1 Z", "2 Z", "3 Z"]
    assert [row["unit"] for row in rows] == ["m/s2", "m/s2", "N"]
    assert {(row["values"], row["over"], row["first"]) for row in rows} == {(100, "s", 0.0)}
    # a universal file keeps the step in six digits
    assert rows[0]["last"] == pytest.approx(0.099, rel=1e-6)


def test_responses_of_a_universal_file_are_listed(tmp_path, capsys):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(0.1)).compile()
    frf = model.frf(np.linspace(10.0, 20.0, 11), drive=("z", 0.3), response=[("z", 0.5)])
    frf.write(tmp_path / "a.uff")
    (row,) = printed(capsys, "inspect", tmp_path / "a.uff")
    assert (row["function"], row["over"]) == ("frequency response", "Hz")
    assert (row["first"], row["last"], row["values"]) == (10.0, 20.0, 11)


def test_columns_of_text_are_listed_with_what_rises_evenly(tmp_path, capsys):
    lines = [f"{0.5 * k};{(-1) ** k * k},5" for k in range(1, 5)]
    (tmp_path / "a.csv").write_text("t;a\n" + "\n".join(line.replace(".", ",") for line in lines))
    first, second = printed(capsys, "inspect", tmp_path / "a.csv", "--decimal", ",")
    assert (first["name"], first["first"], first["last"]) == ("t", 0.5, 2.0)
    assert (first["increases"], first["mean_step"]) == ("yes", 0.5)
    assert (second["name"], second["least"], second["largest"]) == ("a", -3.5, 4.5)
    assert (second["increases"], second["mean_step"]) == ("no", None)


@pytest.mark.parametrize("name", ["nothing.csv", "a.png"])
def test_what_is_no_measured_file_is_refused(tmp_path, capsys, name):
    (tmp_path / "a.png").write_bytes(b"")
    assert main(["inspect", str(tmp_path / name)]) == 2
    assert name in capsys.readouterr().err


@pytest.mark.parametrize("name", ["table", "tension"])
def test_schemas_are_those_of_the_package(capsys, name):
    assert main(["schema", name]) == 0
    text = capsys.readouterr().out
    assert text == (resources.files(rd) / f"{name}-1.schema.json").read_text(encoding="utf-8")
    jsonschema.Draft202012Validator.check_schema(json.loads(text))


def test_example_is_a_scene_that_says_what_it_is(tmp_path, capsys):
    assert main(["scene", "--example"]) == 0
    path = tmp_path / "rope.toml"
    path.write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(["scene", str(path)]) == 0
    assert capsys.readouterr().out.strip() == str(rd.Scene.load(path))


@pytest.mark.parametrize("arguments", [[], ["rope.toml", "--example"]])
def test_a_scene_or_its_example_is_asked_for(arguments, capsys):
    assert main(["scene", *arguments]) == 2
    assert "either SCENE.toml or --example" in capsys.readouterr().err


def test_nothing_is_written_of_a_tension_that_is_refused(tmp_path):
    rd.Scene(rd.Rope(2.0, 0.1), tension=900.0).save(tmp_path / "rope.toml")
    peaks = ["--peaks", "25.1,31.7,36.9,41.2,44.4,47.3", "--std", "0.01"]
    found = tmp_path / "found.toml"
    assert main(["tension", str(tmp_path / "rope.toml"), *peaks, "--save", str(found)]) == 1
    assert not found.exists()


@pytest.mark.filterwarnings("default::ropedyn.UnitWarning")
def test_a_slip_of_units_in_a_scene_is_said_beside_the_answer(tmp_path, capsys):
    rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54e6)
    rd.Scene(rope, tension=2830.0).save(tmp_path / "rope.toml")
    assert main(["modes", str(tmp_path / "rope.toml"), "--modes", "1", "--csv"]) == 0
    said = capsys.readouterr()
    assert said.err.startswith("ropedyn: warning: 0.1017 kg/m of steel is some 5.24 mm thick: ")
    assert len(said.out.splitlines()) == 2
