"""The command that goes from a record, or peaks, to a tension; its JSON keeps to its schema."""

import json
import warnings
from importlib import resources

import jsonschema
import numpy as np
import pytest
from dirty_record import SENSORS, dirty_record

import ropedyn as rd
from ropedyn.cli.command import main

SCHEMA = json.loads((resources.files(rd) / "tension-1.schema.json").read_text(encoding="utf-8"))
TRUE = rd.Scene(
    rd.Rope(2.0, 0.5, bending_stiffness=2.0), tension=1000.0, ends=("pinned", "clamped")
)
PEAKS = TRUE.compile().modes(7).frequency
KNOWN = ["--std", "0.02", "--prior", "tension=900:100"]
"""What decides which modes the peaks are."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Hold a guess of the scene, and a record of a cable with another."""
    folder = tmp_path_factory.mktemp("tension")
    TRUE.replace(tension=900.0, ends=("pinned", "pinned")).save(folder / "rope.toml")
    TRUE.save(folder / "true.toml")
    record, truth = dirty_record(901, duration=300.0)
    truth.scene.replace(tension=0.8 * truth.tension).save(folder / "cable.toml")
    rows = np.column_stack([record.time, *record.value])
    names = ",".join(["t", *(f"a{i}" for i in range(len(SENSORS)))])
    np.savetxt(folder / "run.csv", rows, delimiter=",", header=names, comments="", fmt="%.10g")
    record.write(folder / "run.uff")
    (folder / "truth.txt").write_text(repr(truth.tension))
    return folder


def run(folder, scene, *arguments):
    return main(["tension", str(folder / scene), *map(str, arguments)])


def listed(peaks=PEAKS):
    return ["--peaks", ",".join(f"{f:.6f}" for f in peaks)]


def sheet_of(capsys):
    """Return the printed JSON, which must keep to the schema."""
    sheet = json.loads(capsys.readouterr().out)
    jsonschema.Draft202012Validator(SCHEMA).validate(sheet)
    return sheet


def identified(folder, peaks, **given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rd.IdentifyWarning)
        scene = rd.Scene.load(folder / "rope.toml")
        return rd.identify(scene, peaks, ["tension", "bending_stiffness"], **given)


def test_the_schema_is_one():
    jsonschema.Draft202012Validator.check_schema(SCHEMA)


def test_peaks_that_decide_exit_0_with_what_identify_says(folder, capsys):
    assert run(folder, "rope.toml", *listed(), *KNOWN, "--json") == 0
    sheet = sheet_of(capsys)
    peaks = rd.Peaks([float(f"{f:.6f}") for f in PEAKS], std=0.02)
    fit = identified(folder, peaks, prior={"tension": (900.0, 100.0)})
    assert sheet == json.loads(fit.to_json())
    low, high = sheet["tension"]["interval95"]
    assert low < TRUE.mean_tension < high
    assert run(folder, "rope.toml", *listed(), *KNOWN) == 0
    assert capsys.readouterr().out == fit.report() + "\n"


def test_peaks_that_leave_several_exit_3_and_name_them(folder, capsys):
    assert run(folder, "rope.toml", *listed(PEAKS[1::2]), "--std", 0.02, "--json") == 3
    sheet = sheet_of(capsys)
    assert sheet["status"] == "ambiguous"
    assert len(sheet["clusters"]) > 1
    assert run(folder, "rope.toml", *listed(PEAKS[1::2]), "--std", 0.02) == 3
    assert capsys.readouterr().out.startswith("ambiguous")


def test_peaks_of_no_rope_exit_1_without_numbers(folder, capsys):
    few = ["--peaks", "16,23.7", "--unknown", "tension"]
    assert run(folder, "rope.toml", *few, "--std", 0.02, "--json") == 1
    sheet = sheet_of(capsys)
    assert sheet["status"] == "refused"
    assert sheet["tension"] is None or sheet["tension"]["median"] is None


def test_ends_that_are_given_come_first_in_the_report(folder, capsys):
    given = [*listed(), "--std", "0.02", "--orders", "1,2,3,4,5,6,7", "--ends", "given"]
    assert run(folder, "true.toml", *given) == 0
    first = capsys.readouterr().out.splitlines()[0]
    assert first.startswith("ends taken as given: pinned and clamped")
    assert run(folder, "true.toml", *given, "--json") == 0
    assert sheet_of(capsys)["tension"]["median"] == pytest.approx(1000.0, rel=1e-5)


@pytest.mark.parametrize(
    ("file", "says"),
    [
        ("run.csv", ["--sensors", ",".join(map(str, SENSORS)), "--time", "t"]),
        ("run.csv", [f"--channel=a{i}=z@{x}" for i, x in enumerate(SENSORS)] + ["--time=t"]),
        ("run.uff", []),
    ],
    ids=["sensors", "channels", "universal"],
)
def test_a_record_tells_the_tension_of_its_cable(folder, capsys, file, says):
    assert run(folder, "cable.toml", folder / file, *says, "--json") == 0
    sheet = sheet_of(capsys)
    low, high = sheet["tension"]["interval95"]
    assert low < float((folder / "truth.txt").read_text()) < high
    assert sheet["record"]["quantity"] == "acceleration"
    assert len(sheet["record"]["channels"]) == len(SENSORS)
    assert all(peak["kind"] in {"mode", "line", "weak", "double"} for peak in sheet["peaks"])


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ([], "either RECORD or --peaks must be given"),
        (["run.csv", "--peaks", "16,32"], "either RECORD or --peaks must be given"),
        (["--peaks", "16,32", "--rate", "100"], "RECORD must be given with --rate"),
        (["run.csv", "--std", "0.1"], "--peaks must be given with --std"),
        (["run.csv", "--time=t", "--sensors", "3.5,6"], "must have"),
        (["run.csv", "--time=t", "--sensors", "3.5,6,900"], "900"),
        (["run.csv", "--rate=0", "--sensors", "0,3.5,6,9"], "rate must be a finite number > 0"),
        (["run.csv", "--time=t", "--sensors=3,6", "--channel=a0=z@3"], "--sensors must be left"),
        (["nowhere.csv", "--rate=100", "--sensors", "3.5,6,9"], "nowhere.csv"),
        (["--peaks", "16,-3"], "must be a finite number > 0"),
        (["--peaks", "16,33,49", "--ends", "perhaps"], "--ends"),
    ],
)
def test_bad_input_exits_2_by_name(folder, capsys, monkeypatch, arguments, says):
    monkeypatch.chdir(folder)
    try:
        status = run(folder, "cable.toml", *arguments)
    except SystemExit as left:  # of argparse
        status = left.code
    assert status == 2
    assert says in capsys.readouterr().err


def test_the_figure_is_written(folder, tmp_path, capsys):
    assert run(folder, "rope.toml", *listed(), *KNOWN, "--plot", tmp_path / "fit.png") == 0
    assert (tmp_path / "fit.png").stat().st_size > 1000
