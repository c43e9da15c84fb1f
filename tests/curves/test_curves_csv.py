"""Frequency responses as text in columns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import ropedyn as rd

FINITE = st.floats(allow_nan=False, allow_infinity=False)
POINT = ("z", 0.5)
SAID = {"drive": POINT, "response": ("z", 0.2), "unit": "m/s^2/N"}
PARTS = {"frequency": "f", "real": "re", "imag": "im"}


def read(tmp_path, text, **options):
    file = tmp_path / "a.csv"
    file.write_text(text, newline="")
    return rd.Measured.read(file, **{"columns": PARTS} | SAID | options)


@settings(max_examples=30)
@given(
    parts=arrays.arrays(float, (2, 2, 3), elements=FINITE),
    coherence=st.none() | arrays.arrays(float, (2, 3), elements=st.floats(0, 1)),
    x=st.floats(-1e9, 1e9),
)
def test_text_keeps_every_bit(tmp_path_factory, parts, coherence, x):
    file = tmp_path_factory.mktemp("bits") / "a.csv"
    value = np.empty((2, 3), complex)
    value.real, value.imag = parts
    of = rd.Measured(
        [0.1, 0.2, 1 / 3],
        value,
        drive=("end", 1, "beta"),
        response=[("F_z", x), ("wire", 3)],
        quantity="mobility",
        coherence=coherence,
        averages=1 / 3,
    )
    of.write(file)
    found = rd.Measured.read(file)
    for name in ("drive", "response", "quantity", "averages"):
        assert getattr(found, name) == getattr(of, name)
    for name in ("frequency", "value"):
        assert getattr(found, name).tobytes() == getattr(of, name).tobytes()
    assert (found.coherence is None) == (coherence is None)
    assert coherence is None or found.coherence.tobytes() == coherence.tobytes()


def test_a_calculated_response_to_several_drives_is_read_drive_by_drive(tmp_path):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
    points = [("z", 0.5), ("z", 0.25)]
    frf = model.frf([10.0, 11.0, 13.0], drive=points, response=points)
    frf.write(tmp_path / "a.csv")
    for d, drive in enumerate(points):
        found = rd.Measured.read(tmp_path / "a.csv", drive=drive)
        np.testing.assert_array_equal(found.value, frf.value[d])
        assert found.labels == frf.labels
    for drive in (None, ("z", 0.3)):
        with pytest.raises(rd.SceneError, match=r"drive must be one of those of .*0.25"):
            rd.Measured.read(tmp_path / "a.csv", drive=drive)


TEXTS = {
    "commas": "f,re,im\n1,3,-4\n2,0.5,6e3\n",
    "quoted": '"f","re","im"\n1,3,-4\n2,0.5,6e3\n',
    "semicolons": "f;re;im\n1;3;-4\n2;0.5;6e3\n",
    "tabs": "f\tre\tim\n1\t3\t-4\n2\t0.5\t6e3\n",
    "blanks": "  f  re im\n 1.0  3   -4\n 2 .5  6e3\n",
    "comments": "# made by hand\n\nf, re, im\n# and more\n1, 3, -4\n\n2, 0.5, 6e3\n",
    "line ends": "f,re,im\r\n1,3,-4\r\n2,0.5,6e3\r\n",
    "byte order mark": "\ufefff,re,im\n1,3,-4\n2,0.5,6e3\n",
    "another order": "im,other,re,f\n-4,9,3,1\n6e3,9,0.5,2\n",
}


@pytest.mark.parametrize("what", TEXTS)
def test_text_in_named_columns_is_read(tmp_path, what):
    found = read(tmp_path, TEXTS[what])
    assert found.frequency.tolist() == [1.0, 2.0]
    assert found.value.tolist() == [[3 - 4j, 0.5 + 6000j]]
    assert (found.drive, found.response, found.quantity) == (
        (POINT,),
        (("z", 0.2),),
        "accelerance",
    )


def test_columns_are_numbers_where_there_are_no_names(tmp_path):
    columns = {"frequency": 0, "real": [1, 3], "imag": [2, 4], "coherence": [5, 5]}
    found = read(
        tmp_path,
        "lines of\nsomething else\n1 3 4 5 6 0.5\n2 3 4 5 6 0.75\n",
        columns=columns,
        skip=2,
        response=[POINT, ("beta", 0.2)],
        unit=["mm/N", "mrad/N"],
    )
    np.testing.assert_allclose(found.value[:, 0], [3e-3 + 4e-3j, 5e-3 + 6e-3j], rtol=1e-15)
    assert found.coherence.tolist() == 2 * [[0.5, 0.75]]
    assert found.quantity == "receptance"


def test_amplitude_and_phase_make_a_response(tmp_path):
    columns = {"frequency": 0, "amplitude": 1, "phase": 2}
    found = read(tmp_path, "1,2,90\n2,3,-60\n", columns=columns, unit="g/N")
    exact = 9.80665 * np.array([[2j, 3 * (0.5 - np.sqrt(0.75) * 1j)]])
    np.testing.assert_allclose(found.value, exact, rtol=1e-15, atol=1e-15)


def test_decimal_commas_are_read(tmp_path):
    found = read(tmp_path, "f;re;im\n1,5;3,25;-4\n2;0,5;6e3\n", decimal=",")
    assert found.frequency.tolist() == [1.5, 2.0]
    assert found.value[0, 0] == 3.25 - 4j


REFUSED = {
    "empty": ("", {}, "without a line"),
    "comments": ("# nothing\n", {}, "without a line"),
    "names alone": ("f,re,im\n", {}, "with one line and no numbers"),
    "no columns": (
        "f,re,im\n1,2,3\n",
        {"columns": None},
        r"columns must say .*\('f', 're', 'im'\)",
    ),
    "no frequency": ("f,re\n1,2\n", {"columns": {"real": "f", "imag": "re"}}, "columns must have"),
    "half": ("f,re\n1,2\n", {"columns": {"frequency": "f", "real": "re"}}, "columns must have"),
    "no such name": ("f,re,image\n1,2,3\n", {}, r"columns\['imag'\] must be names out of .*image"),
    "no names": ("1,2,3\n", {}, "columns.* must be names out of none"),
    "no such number": (
        "1,2,3\n",
        {"columns": {"frequency": 0, "real": 1, "imag": 3}},
        r"columns\['imag'\] of '.*' must be a whole number from 0 to 2",
    ),
    "no such key": ("1,2,3\n", {"columns": {"freq": 0}}, "each key of columns must be one of"),
    "uneven": (
        "1,2,3\n",
        {"columns": {"frequency": 0, "real": [1, 2], "imag": 2}},
        "as many of each other kind",
    ),
    "no drive": ("f,re,im\n1,2,3\n", {"drive": None}, "drive must be stated"),
    "no response": ("f,re,im\n1,2,3\n", {"response": None}, "response must be stated"),
    "no unit": ("f,re,im\n1,2,3\n", {"unit": None}, "unit must be stated"),
    "units": ("f,re,im\n1,2,3\n", {"unit": ["m/N", "m/N"]}, "unit must be one, or 1"),
    "another quantity": ("f,re,im\n1,2,3\n", {"quantity": "mobility"}, "must agree"),
    "word": ("f,re,im\n1,2,3\n2,x,3\n", {}, "with 'x' in line 3"),
    "blank cell": ("f,re,im\n1,2,3\n2,,3\n", {}, "with '' in line 3"),
    "short line": ("f,re,im\n1,2,3\n2,3\n", {}, "with 2 of 3 columns in line 3"),
    "not finite": ("f,re,im\n1,2,3\n2,nan,3\n", {}, "value must be finite"),
    "falling": ("f,re,im\n2,2,3\n1,2,3\n", {}, "frequency must increase"),
    "delimiter": ("f,re,im\n1,2,3\n", {"delimiter": ";;"}, "delimiter must be a character"),
    "falling and why": ("f,re,im\n2,2,3\n1,2,3\n", {}, "reverse it and the values"),
    "commas": ("f;re;im\n1,5;3,25;-4,0\n", {}, 'decimal commas; say decimal=","'),
    "commas alone": ("1,5;3,25;-4,0\n2,5;3,5;1,0\n", {}, "in line 1: its numbers have decimal"),
    "commas and blanks": ("1,5 3,25 -4,0\n2,5 3,5 1,0\n", {}, "its numbers have decimal commas"),
    "commas and commas": ("f,re,im\n1,5,3,25,-4,0\n", {}, "its numbers have decimal commas"),
    "quoted commas": ('f,re,im\n"1,5","3,25","-4,0"\n', {}, "its numbers have decimal commas"),
    "decimal": ("f,re,im\n1,2,3\n", {"decimal": "-"}, "decimal must be one of"),
    "universal": ("f,re,im\n1,2,3\n", {"positions": {1: 0.5}}, "positions is for a universal file"),
    "two drives": ("f,re,im\n1,2,3\n", {"drive": [POINT, POINT]}, "drive must be one point"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_text_that_says_too_little_is_refused(tmp_path, what):
    text, options, words = REFUSED[what]
    with pytest.raises(rd.SceneError, match=words):
        read(tmp_path, text, **options)


def test_what_is_no_text_is_refused(tmp_path):
    for content, words in ((b"\xff\xfe\x00", "must be a text file"), (b"1,\0\n", "bytes 0")):
        (tmp_path / "a.csv").write_bytes(content)
        with pytest.raises(rd.SceneError, match=words):
            rd.Measured.read(tmp_path / "a.csv")


def test_paths_without_a_meaning_are_refused(tmp_path):
    of = rd.Measured([1.0, 2.0], [1, 2], drive=POINT, response=POINT)
    for call in (rd.Measured.read, of.write):
        with pytest.raises(rd.SceneError, match=r"path must end with .uff"):
            call(tmp_path / "a.xyz")
        with pytest.raises(TypeError, match="path must be"):
            call(3)
    for name in ("a.csv", "a.uff"):
        with pytest.raises(FileNotFoundError, match="path must be a file"):
            rd.Measured.read(tmp_path / name)
        with pytest.raises(OSError, match="nowhere"):
            of.write(tmp_path / "nowhere" / name)
    with pytest.raises(rd.SceneError, match="binary is for a universal file"):
        of.write(tmp_path / "a.csv", binary=True)


def test_an_infinite_response_is_not_written(tmp_path):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=2)
    frf = model.frf([2.0, 1.0], drive=POINT)
    for name in ("a.csv", "a.uff"):
        with pytest.raises(rd.SceneError, match="frequency must increase to be written"):
            frf.write(tmp_path / name)
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    file = tmp_path_factory.mktemp("fuzz") / "a.csv"
    of = rd.Measured([1.0, 2.0], [1j, 2], drive=POINT, response=POINT, coherence=[0.5, 1])
    of.write(file)
    return file, file.read_bytes()


@settings(max_examples=150)
@given(st.floats(0, 1, exclude_max=True), st.binary(max_size=6), st.integers(0, 60))
def test_text_with_changed_bytes_is_read_or_refused(written, part, new, old):
    file, content = written
    at = int(part * len(content))
    file.write_bytes(content[:at] + new + content[at + old :])
    for options in ({}, {"columns": {"frequency": 0, "real": 1, "imag": 2}} | SAID):
        try:
            rd.Measured.read(file, **options)
        except rd.SceneError as error:
            assert "must" in str(error)
