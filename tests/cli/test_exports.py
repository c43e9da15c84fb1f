"""What a text says, its JSON says too: every number to its digits, every sentence."""

import json
import re
from importlib import resources

import jsonschema
import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main

SCENE = rd.Scene(
    rd.Rope(2.0, 0.1, bending_stiffness=1.5), tension=900.0, damping=rd.ViscousDamping(0.3)
)
PEAKS = "24.1,48.6,73.6,99.2,125.6"
LINES = np.linspace(5.0, 120.0, 200)
MADE = SCENE.replace(tension=930.0).compile().frf(LINES, drive=("z", 0.31), response=("z", 0.7))

COMMANDS = {
    "modes": ["--modes", "3"],
    "modes damped": ["--modes", "2", "--damped"],
    "frf": ["--frequency", "10:40:4", "--drive", "z@0.3"],
    "compare": ["--peaks", PEAKS, "--std", "0.1"],
    "compare responses": ["--measured", "run.uff"],
    "identify": ["--peaks", PEAKS, "--std", "0.1", "--unknown", "tension,bending_stiffness"],
    "identify given": ["--peaks", PEAKS, "--std", "0.1", "--ends", "given"],
    "identify ambiguous": ["--peaks", "24.2,72.5", "--std", "0.1"],
    "identify responses": ["--measured", "run.uff"],
    "tension": ["--peaks", PEAKS, "--std", "0.1"],
    "effects": ["--modes", "2"],
    "accuracy": ["--modes", "2", "--elements", "4,8"],
    "section": ["--diameter", "16e-3", "--core", "FC", "--lay", "sZ"],
    "inspect": [],
    "transient": ["--time", "0:0.1:4", "--drive", "z@0.3", "--force", "step:3"],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("exports")
    SCENE.save(folder / "rope.toml")
    noise = 0.01 * np.random.default_rng(1).normal(size=(2, len(LINES)))
    value = MADE.value * (1.0 + noise[0] + 1j * noise[1])
    measured = rd.Measured(LINES, value, drive=("z", 0.31), response=("z", 0.7))
    measured.write(folder / "run.uff")
    return folder


def inside(sheet):
    """Yield every key, number and text of a sheet, and how many each list holds."""
    if isinstance(sheet, dict):
        for key, value in sheet.items():
            yield key
            yield from inside(value)
    elif isinstance(sheet, list):
        yield len(sheet)
        for value in sheet:
            yield from inside(value)
    else:
        yield sheet


NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?(?!\w)")
SCALES = (1.0, 100.0, *(10.0**k for k in (-9, -6, -3, 3, 6, 9)))


def is_among(token, numbers):
    """Whether a number is one of these in its digits, per cent or thousands of a unit."""
    mantissa = token.lstrip("-").partition("e")[0]
    digits = max(1, len(mantissa.replace(".", "").lstrip("0")))
    scaled = np.outer(numbers, SCALES).ravel()
    return any(np.isclose(scaled, float(token), rtol=0.51 * 10.0 ** (1 - digits), atol=0))


@pytest.mark.parametrize("command", COMMANDS)
def test_json_says_what_the_text_says(command, folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    about = {"section": "6x19S", "inspect": "run.uff"}.get(command, "rope.toml")
    line = [command.split()[0], about, *COMMANDS[command]]
    status = main(line)
    text = capsys.readouterr().out
    assert main([*line, "--json"]) == status
    sheet = json.loads(capsys.readouterr().out)
    name = sheet["schema"].partition(".")[2].replace("/", "-")
    schema = (resources.files(rd) / f"{name}.schema.json").read_text(encoding="utf-8")
    jsonschema.validate(sheet, json.loads(schema))
    found = list(inside(sheet))
    numbers = np.array([v for v in found if isinstance(v, (int, float)) and v is not None], float)
    words = " ".join(v for v in found if isinstance(v, str))
    if command not in ("effects", "accuracy"):  # whose times are measured anew
        missing = [t for t in NUMBER.findall(text) if t not in words and not is_among(t, numbers)]
        assert missing == []
    notes = [line.removeprefix("note: ") for line in text.splitlines() if line.startswith("note: ")]
    assert [note for note in notes if note not in words] == []


def test_csv_has_the_names_of_the_json(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    line = ["compare", "rope.toml", "--peaks", PEAKS]
    main([*line, "--csv"])
    head = capsys.readouterr().out.splitlines()[0].split(",")
    main([*line, "--json"])
    assert head == [one["key"] for one in json.loads(capsys.readouterr().out)["columns"]]
