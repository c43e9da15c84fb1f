"""What every answer can do: tables, frames, files that come back exact; nothing can be changed."""

import copy
import csv
import dataclasses
import functools
import hashlib
import io
import json
import math
import pickle
import re
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from importlib import resources
from pathlib import Path

import jsonschema
import numpy as np
import pandas as pd
import pytest
import xarray as xr
from made_history import decaying, made

import ropedyn as rd
from ropedyn.base.answer import SEAL

ROPE = rd.Rope(
    1.2,
    0.1,
    bending_stiffness=1.5,
    torsional_stiffness=0.4,
    lay_slope=0.1,
    rotary_inertia=1e-5,
    polar_inertia=1e-6,
)
SCENE = rd.Scene(
    ROPE,
    tension=200.0,
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    damping=rd.StiffnessDamping(1e-4),
    parts=[rd.PointMass(0.4, 0.02)],
)
MODEL = SCENE.compile(elements=10, element="rigid")
ARC = rd.Scene(
    rd.Rope(rd.Axis.arc(2.0, 0.6), 0.4, bending_stiffness=1.5, torsional_stiffness=1.0),
    planes="both",
).compile()
GRID = np.linspace(5.0, 150.0, 300)
FREE = SCENE.replace(ends=("free", "free")).compile(elements=10, element="rigid")
BUCKLED = SCENE.replace(tension=-300.0).compile(elements=10, element="rigid")
TIME = np.linspace(0.0, 1.0, 200)
HISTORY = made(TIME, decaying(TIME, (20.0, 0.01, 1.0)), force=rd.Sine(3.0, 20.0).value(TIME))

ANSWERS = {
    "modes": MODEL.modes(5),
    "no modes": MODEL.modes(below=1e-3),
    "free modes": FREE.modes(4),
    "growing modes": BUCKLED.modes(2),
    "frf": MODEL.frf(GRID, drive=("z", 0.31), response=[("z", 0.31), ("alpha", 0.9)]),
    "one frequency": MODEL.frf(33.0, drive=("beta", 1.2)),
    "frf on an axis": ARC.frf([5.0, 50.0], drive=("z", 0.31)),
    "mobility": MODEL.frf(GRID, drive=("z", 0.31), quantity="mobility"),
    "several drives": MODEL.frf(
        GRID, drive=[("z", 0.31), ("alpha", 0.4)], response=[("z", 0.5), ("z", 0.7), ("beta", 0.7)]
    ),
    "list of one drive": MODEL.frf(GRID, drive=[("z", 0.31)]),
    "deflection": MODEL.static({("z", 0.31): 10.0, ("alpha", 0.9): -0.1}),
    "comparison": rd.compare(MODEL, rd.Peaks([20.0, 50.0])),
    "unpaired": rd.compare(MODEL.modes(2), rd.Peaks([20.0, 50.0, 90.0])),
    "comparison with std": rd.compare(MODEL, rd.Peaks([20.0, 50.0], std=0.1)),
    "comparison of responses": rd.compare(MODEL, HISTORY.frf()),
    "peaks": rd.Peaks([20.0, 50.0]),
    "peaks with std": rd.Peaks([20.0, 50.0], std=0.1),
    "peaks with order": rd.Peaks([20.0, 50.0], std=[0.1, 0.2], order=[3, 1]),
    "bending test": rd.BendingTest(0.5, [0.0, 2.0, 4.0], [1.0e-3, 2.5e-3, 4.1e-3]),
    "torsion test": rd.TorsionTest(0.5, [0.0, 0.1], [0.0, 0.3], zero=0.0),
    "plan": rd.plan_measurement(SCENE, 2, sensors=2),
    "plan with damage": rd.plan_measurement(SCENE, [1, 3], drive=("z", 0.2), damage=0.7, std=0.1),
    "resonances": MODEL.frf(GRID, drive=("z", 0.31)).peaks()[0],
    "accuracy": rd.accuracy_cost(SCENE, rd.ask.modes(3), elements=[2, 16], repeat=2),
    "effects": rd.effect_cost(SCENE, rd.ask.modes(3), repeat=1),
    "effects and refusals": rd.effect_cost(
        SCENE, rd.ask.frf(GRID[:3], drive=("z", 0.31)), elements=8, repeat=1
    ),
    "history": HISTORY,
    "spectrum": HISTORY.spectrum(),
    "ring-down": HISTORY.ring_down([20.0], since=0.0),
    "measured": HISTORY.frf(),
    "measured with coherence": HISTORY.frf(segments=3),
    "no resonances": MODEL.frf([1.0, 2.0], drive=("z", 0.31)).peaks()[0],
}
PAIR = {name: ANSWERS[name] for name in ("modes", "frf", "deflection", "comparison", "peaks")}


def arrays(answer):
    """Every array of an answer by its name."""
    found = {}
    for name, value in vars(answer).items():
        inside = value if isinstance(value, dict) else {"": value}
        found |= {f"{name}.{k}": v for k, v in inside.items() if isinstance(v, np.ndarray)}
    return found


def assert_same(first, second):
    """The same kind, fields, types and bits."""
    assert type(first) is type(second)
    # the cost first: it grows by what reading the others takes
    for field in sorted(dataclasses.fields(first), key=lambda field: field.name != "cost"):
        if "transient" in field.metadata:
            continue
        a, b = (
            getattr(answer, field.metadata.get("through", field.name)) for answer in (first, second)
        )
        if "nested" in field.metadata:
            assert_same(a, b)
            continue
        assert type(a) is type(b), field.name
        if isinstance(a, rd.Cost):  # tables that are read since cost more
            assert a.seconds <= b.seconds
            a = dataclasses.replace(a, seconds=b.seconds)
        if not isinstance(a, (np.ndarray, dict)):
            assert a == b, field.name
    # what is computed when it is read stands in the order in which it was
    assert arrays(first).keys() == arrays(second).keys()
    for name, array in arrays(first).items():
        other = arrays(second)[name]
        assert array.shape == other.shape, name
        assert array.dtype.kind == other.dtype.kind, name
        if array.dtype.kind == "U":
            assert array.tolist() == other.tolist(), name
        else:
            assert (array.dtype, array.tobytes()) == (other.dtype, other.tobytes()), name


@functools.cache
def loaded(name):
    """An answer that was saved and loaded."""
    with tempfile.TemporaryDirectory() as folder:
        ANSWERS[name].save(Path(folder) / "answer.nc")
        return rd.load(Path(folder) / "answer.nc")


@pytest.mark.parametrize("name", ANSWERS)
def test_save_and_load_return_the_same_bits(name):
    assert_same(loaded(name), ANSWERS[name])


@pytest.mark.parametrize("name", ANSWERS)
def test_saving_what_was_loaded_loses_nothing(name, tmp_path):
    loaded(name).save(tmp_path / "second.nc")
    assert_same(rd.load(tmp_path / "second.nc"), ANSWERS[name])


@pytest.mark.parametrize("name", ANSWERS)
def test_pickle_and_copy_return_the_same_bits(name):
    answer = ANSWERS[name]
    assert_same(pickle.loads(pickle.dumps(answer)), answer)
    assert_same(copy.deepcopy(answer), answer)


WAYS = {
    "made": lambda name: ANSWERS[name],
    "loaded": loaded,
    "unpickled": lambda name: pickle.loads(pickle.dumps(ANSWERS[name])),
    "copied": lambda name: copy.deepcopy(ANSWERS[name]),
}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", ANSWERS)
def test_no_number_of_an_answer_can_be_changed(name, way):
    writeable = [key for key, array in arrays(WAYS[way](name)).items() if array.flags.writeable]
    assert writeable == []


@pytest.mark.parametrize("name", ANSWERS)
def test_no_field_of_an_answer_can_be_changed(name):
    field = dataclasses.fields(ANSWERS[name])[0].name
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(ANSWERS[name], field, None)


def test_an_answer_does_not_follow_the_array_it_was_asked_with():
    grid, measured = np.array([10.0, 20.0]), np.array([20.0, 50.0])
    frf, peaks = MODEL.frf(grid, drive=("z", 0.31)), rd.Peaks(measured)
    grid[:] = measured[:] = 1.0
    assert frf.frequency.tolist() == [10.0, 20.0]
    assert peaks.frequency.tolist() == [20.0, 50.0]


@pytest.mark.parametrize("way", ["made", "unpickled", "copied"])
def test_no_number_of_a_model_can_be_changed(way):
    model = {"made": MODEL, "unpickled": pickle.loads(pickle.dumps(MODEL))}.get(
        way, copy.deepcopy(MODEL)
    )
    every = [model.x, *(a for a in model.chain if isinstance(a, np.ndarray))]
    assert [a.flags.writeable for a in every] == [False] * 11


QUESTIONS = {
    "modes": lambda model: model.modes(5),
    "frf": lambda model: model.frf(GRID, drive=("z", 0.31), response=("alpha", 0.9)),
    "static": lambda model: model.static({("z", 0.31): 1.0}),
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_a_pickled_model_answers_the_same_bits(question):
    model = pickle.loads(pickle.dumps(MODEL))
    first, second = arrays(QUESTIONS[question](MODEL)), arrays(QUESTIONS[question](model))
    assert {k: v.tobytes() for k, v in first.items()} == {k: v.tobytes() for k, v in second.items()}


# tables


@pytest.mark.parametrize("name", ANSWERS)
def test_text_has_a_title_a_head_and_a_line_for_each_row(name):
    table = ANSWERS[name].table()
    lines = table.to_text().removeprefix(f"{table.title}\n").splitlines()
    assert re.split(r"\s{2,}", lines[0].strip()) == list(table.columns)
    assert set(lines[1]) <= {"-", " "}
    assert len(lines) == 2 + len(table.rows)


@pytest.mark.parametrize("lines", range(1, 10))
def test_a_title_of_many_lines_leaves_a_screen(lines):
    title = "\n".join(["of many words"] * lines)
    shown = repr(rd.Table.of(title, {"n": range(100)})).splitlines()
    assert len(shown) == 12 and shown[lines - 1] == "of many words, 100 rows"


@pytest.mark.parametrize("name", ANSWERS)
def test_a_prompt_shows_a_screen_and_print_a_page(name):
    answer = ANSWERS[name]
    kind, _, shown = repr(answer).partition(": ")
    assert kind == type(answer).__name__
    lines, heading = shown.splitlines(), answer.table().title.count("\n") + 1
    assert len(lines) <= 12
    assert max(map(len, repr(answer).splitlines())) <= 80
    assert len(str(answer).splitlines()) <= 62 + heading
    assert ("..." in shown) == (len(answer.table().rows) > 10 - heading)


def test_a_long_table_shows_its_first_and_last_rows():
    table = rd.Table.of("squares", {"n": range(100), "n n": [n * n for n in range(100)]})
    shown = [line.split() for line in repr(table).splitlines()]
    assert shown[0] == ["squares,", "100", "rows"]
    assert [row[0] for row in shown[3:]] == ["0", "1", "2", "3", "...", "96", "97", "98", "99"]
    assert [row[0] for row in map(str.split, table.to_text().splitlines()[3:])] == [
        str(n) for n in range(100)
    ]


def test_columns_that_do_not_fit_are_counted():
    wide = rd.Table.of("words", {f"column {k}": ["x" * 30] for k in range(4)})
    heading, head, _, row = repr(wide).splitlines()
    assert heading == "words, 2 of 4 columns"
    assert head.split("  ")[0] == "column 0"
    assert row == f"{'x' * 30}  {'x' * 30}"


class Cells(HTMLParser):
    """Collects the texts of table cells."""

    def __init__(self):
        super().__init__()
        self.cells, self.tag = {"th": [], "td": [], "caption": []}, None

    def handle_starttag(self, tag, attrs):
        self.tag = tag
        if tag in self.cells:
            self.cells[tag].append("")

    def handle_endtag(self, tag):
        self.tag = None

    def handle_data(self, data):
        if self.tag in self.cells:
            self.cells[self.tag][-1] += data


@pytest.mark.parametrize("name", ANSWERS)
def test_html_shows_what_the_text_shows(name):
    table = ANSWERS[name].table()
    cells = Cells()
    cells.feed(ANSWERS[name]._repr_html_())
    heading = ", ".join([table.title, *([f"{len(table.rows)} rows"] * (len(table.rows) > 60))])
    assert cells.cells["caption"] == [heading]
    assert cells.cells["th"] == list(table.columns)
    words = " ".join(cells.cells["td"]).split()
    below = str(ANSWERS[name]).removeprefix(f"{heading}\n").splitlines()[2:]
    assert words == " ".join(below).split()


def test_html_of_a_table_escapes_what_is_not_text():
    table = rd.Table.of("a < b & c", {"<script>": ["<b>"]})
    assert table._repr_html_() == (
        "<table><caption>a &lt; b &amp; c</caption><thead><tr><th>&lt;script&gt;</th></tr></thead>"
        "<tbody><tr><td>&lt;b&gt;</td></tr></tbody></table>"
    )


SCHEMA = json.loads((resources.files(rd) / "table-1.schema.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize("name", ANSWERS)
def test_json_is_of_its_schema_and_keeps_every_number(name):
    table = ANSWERS[name].table()
    sheet = json.loads(table.to_json())
    jsonschema.validate(sheet, SCHEMA)
    keys = [column["key"] for column in sheet["columns"]]
    assert len(set(keys)) == len(keys) == len(table.columns)
    for row, own in zip(sheet["rows"], table.rows, strict=True):
        assert list(row) == keys
        for value, number in zip(row.values(), own, strict=True):
            finite = not isinstance(number, float) or math.isfinite(number)
            assert value == (number if finite else None)


@pytest.mark.parametrize("name", ANSWERS)
def test_json_of_an_answer_has_its_plain_fields_beside_the_table(name):
    answer = ANSWERS[name]
    sheet = json.loads(answer.to_json())
    jsonschema.validate(sheet, SCHEMA)
    assert sheet["rows"] == json.loads(answer.table().to_json())["rows"]
    for key, value in sheet.get("details", {}).items():
        if isinstance(value, str):
            assert value == getattr(answer, key)


def test_columns_that_are_called_alike_are_parted_by_their_units_or_numbers():
    table = rd.Table.of("t", {"off [Hz]": [1.0], "off [%]": [2.0], "off": [3.0], "off []": [4.0]})
    assert [one.key for one in table.keys] == ["off_hz", "off_percent", "off_2", "off_3"]


@pytest.mark.parametrize("name", ANSWERS)
def test_csv_keeps_every_digit(name):
    table = ANSWERS[name].table()
    read = list(csv.reader(io.StringIO(table.to_csv())))
    assert read[0] == [one.key for one in table.keys]
    for line, row in zip(read[1:], table.rows, strict=True):
        assert line == ["" if v is None else v if isinstance(v, str) else repr(v) for v in row]


@pytest.mark.parametrize("name", ANSWERS)
def test_records_are_the_rows_and_plain_enough_for_json(name):
    table = ANSWERS[name].table()
    records = json.loads(json.dumps(table.to_records()))
    assert [tuple(record.values()) for record in records] == list(table.rows)
    assert all(tuple(record) == table.columns for record in records)


@pytest.mark.parametrize("name", ANSWERS)
def test_data_frame_has_the_columns_and_every_digit(name):
    table, frame = ANSWERS[name].table(), ANSWERS[name].to_dataframe()
    assert isinstance(frame, pd.DataFrame)
    assert tuple(frame.columns) == table.columns
    assert len(frame) == len(table.rows)
    for column in table.columns:
        kept = [None if pd.isna(v) else v for v in frame[column].tolist()]
        assert kept == list(table.column(column))


@pytest.mark.parametrize("name", ANSWERS)
def test_columns_of_a_table_are_all_there(name):
    # as many names as cells: no column has taken the place of another of the same name
    table = ANSWERS[name].table()
    assert len(set(table.columns)) == len(table.columns)
    assert {len(row) for row in table.rows} <= {len(table.columns)}


def test_table_of_several_drives_has_a_curve_for_each_pair():
    frf = ANSWERS["several drives"]
    table = frf.table()
    assert len(table.columns) == 1 + 2 * 2 * 3
    amplitudes = np.array(table.rows)[:, 1::2].T.reshape(2, 3, -1)
    np.testing.assert_array_equal(amplitudes, np.abs(frf.value))


def test_table_of_modes_counts_from_one_in_per_cent():
    modes, table = ANSWERS["modes"], ANSWERS["modes"].table()
    assert table.column("mode") == (1, 2, 3, 4, 5)
    assert table.column("frequency [Hz]") == tuple(modes.frequency.tolist())
    shares = [c for c in table.columns if c.startswith("kinetic")]
    assert shares == ["kinetic z [%]", "kinetic alpha [%]", "kinetic beta [%]"]
    # three fractions of one sum and their sum: a few eps of 100
    total = np.sum([table.column(c) for c in shares], axis=0)
    np.testing.assert_allclose(total, 100.0, rtol=8 * np.finfo(float).eps)


def test_table_of_growing_modes_shows_the_growth():
    assert "growth [1/s]" in ANSWERS["growing modes"].table().columns
    assert "growth [1/s]" not in ANSWERS["modes"].table().columns


def test_table_of_a_deflection_names_units():
    assert ANSWERS["deflection"].table().columns == (
        "x [m]",
        "z [m]",
        "alpha [rad]",
        "beta [rad]",
        "F_z [N]",
        "M_alpha [N m]",
        "M_beta [N m]",
    )


def test_table_of_a_comparison_leaves_what_has_no_partner_empty():
    table = ANSWERS["unpaired"].table()
    order = table.column("mode")
    assert order.count(None) == 1
    gap = order.index(None)
    assert table.rows[gap][1:] == (None,) * (len(table.columns) - 1)
    line = str(ANSWERS["unpaired"]).splitlines()[3 + gap]
    assert line.split()[1:] == ["-"] * (len(table.columns) - 1)


# xarray and netCDF


@pytest.mark.parametrize("name", ANSWERS)
def test_xarray_holds_every_array(name):
    dataset = ANSWERS[name].to_xarray()
    assert isinstance(dataset, xr.Dataset)
    for key, array in arrays(ANSWERS[name]).items():
        variable = dataset[key.rstrip(".")]
        np.testing.assert_array_equal(variable.values, array)
        assert "units" in variable.attrs


@pytest.mark.parametrize(
    ("name", "variable", "axes", "unit"),
    [
        ("modes", "frequency", ("mode",), "Hz"),
        ("modes", "shape", ("mode", "node", "coordinate"), "m or rad"),
        ("modes", "energy.bending", ("mode",), ""),
        ("modes", "mesh_error", ("mode",), "Hz"),
        ("modes", "limit", ("mode",), "Hz"),
        ("frf", "value", ("response", "frequency"), ""),
        ("frf", "mesh_error", ("response", "frequency"), ""),
        ("several drives", "mesh_error", ("drive", "response", "frequency"), ""),
        ("several drives", "value", ("drive", "response", "frequency"), ""),
        ("several drives", "rounding_error", ("drive", "response", "frequency"), ""),
        ("deflection", "force", ("node", "coordinate"), "N or N m"),
        ("comparison", "difference", ("peak",), "%"),
        ("comparison", "all_calculated", ("calculated",), "Hz"),
        ("peaks", "frequency", ("peak",), "Hz"),
        ("resonances", "damping_ratio", ("peak",), ""),
        ("accuracy", "seconds", ("row",), "s"),
        ("accuracy", "element", ("row",), ""),
        ("effects", "seconds_without", ("row",), "s"),
        ("effects", "change.largest [Hz]", ("row",), ""),
        ("history", "value", ("response", "time"), ""),
        ("history", "energy.kinetic", ("time",), "J"),
        ("history", "snapshot", ("snapshot", "node", "coordinate"), "m or rad"),
        ("spectrum", "value", ("response", "frequency"), ""),
        ("ring-down", "frequency_std", ("mode",), "Hz"),
        ("measured with coherence", "coherence", ("response", "frequency"), ""),
    ],
)
def test_xarray_names_axes_and_units(name, variable, axes, unit):
    found = ANSWERS[name].to_xarray()[variable]
    assert (found.dims, found.attrs["units"]) == (axes, unit)


def test_a_file_can_be_read_without_ropedyn(tmp_path):
    ANSWERS["frf"].save(tmp_path / "frf.nc")
    with xr.open_dataset(tmp_path / "frf.nc", engine="h5netcdf") as dataset:
        parts = dataset["value"].values
        assert "FRF" in dataset.attrs.values()
        assert dataset["value"].dims == ("response", "frequency", "re_im")
    np.testing.assert_array_equal(parts[..., 0] + 1j * parts[..., 1], ANSWERS["frf"].value)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"path must be a file .*nowhere\.nc"):
        rd.load(tmp_path / "nowhere.nc")


def test_a_folder_holds_no_answer(tmp_path):
    with pytest.raises(OSError, match="path must be a file"):
        rd.load(tmp_path)


GARBAGE = {
    "empty": b"",
    "text": b"frequency, value\n1, 2\n",
    "zeros": bytes(4096),
    "head of HDF5": b"\x89HDF\r\n\x1a\n" + bytes(100),
    "netCDF 3": b"CDF\x01" + bytes(28),
}


@pytest.mark.parametrize("name", GARBAGE)
def test_garbage_is_refused_by_path(name, tmp_path):
    path = tmp_path / "garbage.nc"
    path.write_bytes(GARBAGE[name])
    with pytest.raises(rd.SceneError, match=r"path must be .*garbage\.nc"):
        rd.load(path)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_truncated_file_is_refused_by_path(share, tmp_path):
    path = tmp_path / "cut.nc"
    ANSWERS["modes"].save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])
    with pytest.raises(rd.SceneError, match=r"cut\.nc"):
        rd.load(path)


def marked(answer, field):
    """Name of the attribute that holds the kind of the answer, or a field."""
    attributes = answer.to_xarray().attrs
    (name,) = [k for k, v in attributes.items() if v == field or k == f"ropedyn_{field}"]
    return name


def foreign(frequency=(1.0,), drop=(), **changes):
    """Return the file of a peak with attributes changed."""
    peaks = ANSWERS["peaks"]
    dataset = xr.Dataset({"frequency": ("peak", list(frequency))}, attrs=peaks.to_xarray().attrs)
    for field, value in changes.items():
        dataset.attrs[marked(peaks, field)] = value
    for field in drop:
        del dataset.attrs[marked(peaks, field)]
    return dataset


FOREIGN = {
    "nothing of ropedyn": xr.Dataset({"frequency": ("peak", [1.0])}),
    "no mark": foreign(drop=["Peaks"]),
    "unknown kind": foreign(Peaks="Waterfall"),
    "the base": foreign(Peaks="Answer"),
    "a number as kind": foreign(Peaks=3),
    "numbers as kind": foreign(Peaks=[1, 2]),
    "no variable": foreign().drop_vars("frequency"),
    "no attribute": foreign(drop=["order"]),
    "attribute without meaning": foreign(std="{"),
    "attribute of numbers": foreign(std=3.0),
    "uncertainty of text": foreign(std='"large"'),
    "frequency below 0": foreign([-1.0]),
    "frequency of text": foreign(["a"]),
}


def put(dataset, path):
    """Write a file as answers are, with its checksum."""
    dataset.to_netcdf(path, engine="h5netcdf")
    content = path.read_bytes()
    path.write_bytes(content + SEAL + hashlib.sha256(content).digest())


def test_a_file_without_its_checksum_is_refused_by_path(tmp_path):
    foreign().to_netcdf(tmp_path / "peaks.nc", engine="h5netcdf")
    with pytest.raises(rd.SceneError, match=r"peaks\.nc.* checksum is missing or wrong"):
        rd.load(tmp_path / "peaks.nc")


def test_the_file_that_is_made_foreign_is_an_answer(tmp_path):
    put(foreign(), tmp_path / "peaks.nc")
    assert_same(rd.load(tmp_path / "peaks.nc"), rd.Peaks([1.0]))


@pytest.mark.parametrize("name", FOREIGN)
def test_a_foreign_file_is_refused_by_path(name, tmp_path):
    path = tmp_path / "foreign.nc"
    put(FOREIGN[name], path)
    with pytest.raises(rd.SceneError, match=r"foreign\.nc"):
        rd.load(path)


def test_a_damaged_cost_is_refused_by_path(tmp_path):
    dataset = ANSWERS["deflection"].to_xarray()
    dataset.attrs["ropedyn_cost"] = '{"minutes": 3}'
    put(dataset, tmp_path / "damaged.nc")
    with pytest.raises(rd.SceneError, match=r"damaged\.nc"):
        rd.load(tmp_path / "damaged.nc")


@pytest.mark.parametrize("name", PAIR)
def test_a_failing_save_leaves_the_old_file_and_no_other(name, tmp_path, monkeypatch):
    path = tmp_path / "answer.nc"
    path.write_text("old")

    def full(self, content):
        with self.open("wb") as file:
            file.write(content[: len(content) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space left"):
        PAIR[name].save(path)
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("answer.nc", "old")]


@pytest.mark.parametrize("method", ["modal", "line", "events"])
def test_what_cannot_be_computed_is_absent_in_the_file_too(method, tmp_path):
    """No method but steps tells the energy of motion that an end drives."""
    asked = {"drive": ("end", 0, "z"), "force": rd.Sine(1e-3, 20.0), "response": ("z", 0.3)}
    model = rd.Scene(rd.Rope(2.0, 0.1, bending_stiffness=1.0), tension=1000.0).compile(elements=16)
    history = model.transient(np.linspace(0.0, 0.1, 101), **asked, method=method)
    with pytest.raises(rd.SceneError, match="energy") as refused:
        history.energy  # noqa: B018
    for k in range(2):  # what was loaded can be saved too
        history.save(tmp_path / f"{k}.nc")
        history = rd.load(tmp_path / f"{k}.nc")
        with pytest.raises(rd.SceneError, match=re.escape(str(refused.value))):
            history.energy  # noqa: B018
        assert history.mesh_error.shape == (1, 101)
        assert pickle.loads(pickle.dumps(history)).value.tolist() == history.value.tolist()


def test_saving_replaces_the_file_and_leaves_nothing_else(tmp_path):
    path = tmp_path / "answer.nc"
    path.write_text("old")
    ANSWERS["modes"].save(path)
    assert_same(rd.load(path), ANSWERS["modes"])
    assert list(tmp_path.iterdir()) == [path]


def test_a_missing_folder_is_an_error_and_is_not_made(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        ANSWERS["modes"].save(tmp_path / "nowhere" / "answer.nc")
    assert list(tmp_path.iterdir()) == []


# what the extra `io` brings

WITHOUT = """
import sys
sys.modules[{missing!r}] = None  # as if it were not installed
import ropedyn as rd
from ropedyn.base.answer import SEAL
peaks = rd.Peaks([20.0])
print(peaks.table())
for call in {calls!r}:
    try:
        print("answer:", eval(call))
    except ImportError as error:
        print("answer:", error)
"""
CALLS = {
    "pandas": ["peaks.to_dataframe()"],
    "xarray": ["peaks.to_xarray()", "peaks.save('answer.nc')", "rd.load(__file__)"],
    "h5netcdf": ["peaks.save('answer.nc')", "rd.load(__file__)"],
    "h5py": ["peaks.save('answer.nc')", "rd.load(__file__)"],  # optional to h5netcdf since its 1.8
}
SIZES = "dict(peaks.to_xarray().sizes)"
"""What needs xarray but no library of netCDF."""


@pytest.mark.parametrize("missing", CALLS)
def test_a_missing_library_says_which_extra_brings_it(missing, tmp_path):
    calls = [*CALLS[missing], *[SIZES] * (missing == "h5netcdf")]
    script = tmp_path / "script.py"
    script.write_text(WITHOUT.format(missing=missing, calls=calls))
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    answers = [
        line.removeprefix("answer: ")
        for line in done.stdout.splitlines()
        if line.startswith("answer: ")
    ]
    refusal = f"{missing} is needed for this and is not installed: pip install 'ropedyn[io]'"
    assert answers[: len(CALLS[missing])] == [refusal] * len(CALLS[missing])
    if missing == "h5netcdf":
        assert "'peak': 1" in answers[-1]
    assert [p.name for p in tmp_path.iterdir()] == ["script.py"]


def test_load_opens_scenes_too(tmp_path):
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    scene.save(tmp_path / "rope.toml")
    assert rd.load(tmp_path / "rope.toml") == scene
