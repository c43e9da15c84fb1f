"""Records of motion over time: what they are made of, what is wrong with them, their files."""

import numpy as np
import pytest
from dirty_record import dirty_record
from scipy.signal import welch

import ropedyn as rd

RATE, COUNT = 64.0, 1000
TIME = np.arange(COUNT) / RATE
POINTS = [("z", 3.5), ("z", 6.0)]


def motion(seed=0, channels=2, count=COUNT):
    return np.random.default_rng(seed).standard_normal((channels, count))


def record(value=None, **more):
    value = motion() if value is None else value
    return rd.Record(TIME, value, **{"response": POINTS} | more)


# what it is made of


def test_a_rate_stands_for_times_from_0():
    by_rate = rd.Record(None, motion(), rate=RATE, response=POINTS)
    by_time = record()
    assert by_rate.time.tobytes() == by_time.time.tobytes() == TIME.tobytes()
    assert by_rate.rate == by_time.rate == RATE
    assert by_rate.value.tobytes() == motion().tobytes()


def test_one_channel_may_be_given_as_a_row():
    alone = rd.Record(TIME, motion()[0], response=POINTS[0])
    assert alone.value.shape == (1, COUNT)
    assert alone.response == (POINTS[0],)


def test_a_force_and_what_it_acts_on_are_kept():
    force = motion(1)[0]
    found = record(force=force, drive=("z", 9.0))
    assert found.force.tobytes() == force.tobytes()
    assert found.drive == ("z", 9.0)


def test_a_quantity_of_pint_comes_in_its_unit():
    pint = pytest.importorskip("pint")
    given = motion() * pint.UnitRegistry()("mm/s^2")
    np.testing.assert_allclose(record(given).value, motion() / 1000, rtol=1e-15)


@pytest.mark.parametrize(
    ("given", "error", "message"),
    [
        ({"rate": 0.0}, rd.SceneError, r"rate must be a finite number > 0 \[Hz\], got 0.0"),
        ({"rate": "64"}, TypeError, "rate must be a finite number > 0"),
        ({"rate": 65.0}, rd.SceneError, "rate must be that of time, 64 Hz, or time left out"),
        ({"time": None}, rd.SceneError, r"time must be given, or rate \[Hz\] in its place"),
        ({"time": TIME[:-1]}, rd.SceneError, "time must be as long as each row of value, 1000"),
        ({"time": TIME[::-1]}, rd.SceneError, r"time must increase, got time\[1\]"),
        ({"time": ["a"] * COUNT}, TypeError, "time must be a one-dimensional array"),
        ({"value": motion()[:, :1]}, rd.SceneError, "value must have at least 16 samples, got 1"),
        ({"value": motion()[:1]}, rd.SceneError, "a row for each of 2 points of response"),
        ({"value": motion().T}, rd.SceneError, "transpose it"),
        ({"value": [[1.0, 2.0], [1.0]]}, rd.SceneError, "value must be .* rows of equal length"),
        ({"value": [["a"] * COUNT] * 2}, TypeError, "value must be an array of numbers"),
        ({"value": np.zeros((2, 0))}, rd.SceneError, "value must be an array of numbers .* none"),
        ({"response": []}, rd.SceneError, "response must be a point"),
        ({"response": 3.5}, TypeError, "response must be a point"),
        ({"response": [("q", 3.5), ("z", 6.0)]}, rd.SceneError, r"response\[0\]\[0\]"),
        (
            {"response": [("z", 3.5), ("z", -6.0)]},
            rd.SceneError,
            r"response\[1\]\[1\] .* >= 0 \[m\]",
        ),
        ({"quantity": "receptance"}, rd.SceneError, "quantity must be one of"),
        ({"missing": "zero"}, rd.SceneError, "missing must be one of"),
        ({"force": motion()[0]}, rd.SceneError, "force and drive must be given together"),
        ({"drive": ("z", 9.0)}, rd.SceneError, "force and drive must be given together"),
        (
            {"force": motion()[0][:-1], "drive": ("z", 9.0)},
            rd.SceneError,
            "force must be one row as long as each of value, 1000",
        ),
    ],
)
def test_bad_input_is_named(given, error, message):
    whole = {"time": TIME, "value": motion(), "response": POINTS} | given
    with pytest.raises(error, match=message):
        rd.Record(whole.pop("time"), whole.pop("value"), **whole)


def test_a_value_that_is_no_number_is_named_and_no_gap_unless_said():
    value = motion()
    value[1, 523] = np.nan
    with pytest.raises(rd.SceneError, match=r'value\[1\]\[523\] .* nan: missing="gap"'):
        record(value)
    found = record(value, missing="gap")
    assert found.notes == ("1 gap of 1 sample bridged",)
    assert np.isfinite(found.value).all()
    value[1, 523] = np.inf
    with pytest.raises(rd.SceneError, match=r"value\[1\]\[523\] must be a finite number, got inf$"):
        record(value, missing="gap")


# what is wrong with it


def test_a_short_gap_is_bridged_by_what_is_around_it():
    # 2 Hz at 64 Hz: a cubic over 4 steps is off by some (2 pi 2/64)^4 of the amplitude
    smooth = np.sin(2 * np.pi * 2.0 * TIME)
    kept = np.ones(COUNT, bool)
    kept[500:502] = False
    found = rd.Record(TIME[kept], np.stack([smooth, smooth])[:, kept], response=POINTS)
    assert found.notes == ("1 gap of 2 samples bridged",)
    assert found.pieces == ((0, COUNT),)
    assert np.abs(found.value - smooth).max() < (2 * np.pi * 2 / 64) ** 4
    assert found.time.tobytes() == TIME.tobytes()


def test_a_long_gap_splits_the_record_at_equal_steps():
    kept = np.ones(COUNT, bool)
    kept[500:532] = False
    found = rd.Record(TIME[kept], motion()[:, kept], response=POINTS)
    assert found.pieces == ((0, 500), (532, COUNT))
    assert found.notes == ("0.5 s are missing at 7.8125 s after the start: split",)
    assert np.isnan(found.value[:, 500:532]).all()
    assert found.value[:, kept].tobytes() == motion()[:, kept].tobytes()
    assert found.time.tobytes() == TIME.tobytes()


def test_records_far_apart_are_no_record():
    time = TIME + 1e5 * (TIME > 8)
    with pytest.raises(rd.SceneError, match=r"make a Record of each part"):
        rd.Record(time, motion(), response=POINTS)


def test_times_that_jitter_are_resampled_and_named():
    rng = np.random.default_rng(1)
    moved = TIME + rng.uniform(-0.2, 0.2, COUNT) / RATE

    def wave(t):
        return np.stack([np.sin(2 * np.pi * 2.0 * t), np.cos(2 * np.pi * 2.0 * t)])

    found = rd.Record(moved, wave(moved), response=POINTS)
    assert "resampled by cubic splines" in found.notes[0]
    inside = slice(5, -5)
    # the mean of the jitter moves the whole record, by 0.2/sqrt(3 n) of a step, and its ends the
    # step; without resampling the values are off by up to 0.2 (2 pi 2/64) = 0.04
    exact = wave(found.time + (moved - found.time).mean())
    assert np.abs(found.value - exact)[:, inside].max() < 5e-3
    with pytest.raises(rd.SceneError, match="resample the values first"):
        rd.Record(TIME + rng.uniform(-0.45, 0.45, COUNT) / RATE, motion(), response=POINTS)


def test_times_of_few_digits_are_at_equal_steps():
    found = rd.Record(np.round(TIME, 5), motion(), response=POINTS)
    assert found.notes == ()
    assert found.rate == pytest.approx(RATE, rel=1e-6)


def test_a_dead_channel_is_named_and_not_used():
    value = motion()
    value[0] = 1e3
    found = record(value)
    assert found.used == (1,)
    assert found.notes == ("channel 0 (z at 3.500 m) is dead: not used",)
    value[1] = 0.0
    with pytest.raises(rd.SolveError, match="a channel that is not dead"):
        record(value).peaks()


def test_a_clipped_channel_is_named_and_not_used_where_another_is_whole():
    value = motion()
    value[0] = np.clip(value[0], -1.5, 1.5)
    found = record(value)
    assert found.used == (1,)
    assert "channel 0 (z at 3.500 m) is clipped" in found.notes[0]
    assert found.notes[0].endswith("not used")
    both = record(np.clip(motion(), -1.5, 1.5))
    assert both.used == (0, 1)
    assert all(note.endswith("used all the same") for note in both.notes)


def test_a_drift_is_named():
    value = motion() + [[0.0], [1.0]] * (TIME - TIME.mean())
    assert "channel 1 (z at 6.000 m) drifts by" in record(value).notes[0]
    assert len(record(value).notes) == 1


# files


def assert_same(found, of):
    for name in ("rate", "response", "quantity", "drive", "pieces", "used", "notes", "missing"):
        assert getattr(found, name) == getattr(of, name)
    for name in ("time", "value"):
        assert getattr(found, name).tobytes() == getattr(of, name).tobytes()
    assert (found.force is None) == (of.force is None)
    assert of.force is None or found.force.tobytes() == of.force.tobytes()


def hammered():
    time = 1e3 + np.arange(COUNT) / 51.2
    points = [("z", 1 / 3), ("beta", 0.0)]
    more = {"force": motion(3)[0], "drive": ("z", 9.0), "quantity": "velocity"}
    return rd.Record(time, motion() / 3, response=points, **more)


def test_text_keeps_every_bit(tmp_path):
    hammered().write(tmp_path / "a.csv")
    assert_same(rd.Record.read(tmp_path / "a.csv"), hammered())


def test_text_keeps_gaps_and_notes(tmp_path):
    of, _ = dirty_record(24, duration=60.0)
    kept = np.ones(len(of.time), bool)
    kept[2000:2300] = False
    of = rd.Record(of.time[kept], of.value[:, kept], response=of.response, notes=["windy"])
    assert len(of.pieces) == 2 and of.notes[0] == "windy"
    of.write(tmp_path / "a.csv")
    assert_same(rd.Record.read(tmp_path / "a.csv"), of)


@pytest.mark.parametrize("binary", [False, True])
def test_universal_files_keep_the_record(tmp_path, binary):
    pytest.importorskip("pyuff")
    of = hammered()
    of.write(tmp_path / "a.uff", binary=binary)
    found = rd.Record.read(tmp_path / "a.uff")
    if binary:
        assert_same(found, of)
    else:
        # 12 digits
        np.testing.assert_allclose(found.value, of.value, rtol=1e-11)
        np.testing.assert_allclose(found.force, of.force, rtol=1e-11)
        assert found.time.tobytes() == of.time.tobytes()


def test_netcdf_keeps_the_record(tmp_path):
    of, _ = dirty_record(24, duration=60.0)
    of.save(tmp_path / "a.nc")
    assert_same(rd.load(tmp_path / "a.nc"), of)


def test_datasets_of_others_are_named_by_number_or_first_line(tmp_path):
    pytest.importorskip("pyuff")
    of = hammered()
    of.write(tmp_path / "a.uff", binary=True)
    file = tmp_path / "a.uff"
    content = file.read_bytes().replace(b"ropedyn motion", b"another motion")
    file.write_bytes(content)
    with pytest.raises(rd.SceneError, match=r"1: 'z at 0.333 m \[m/s\]'"):
        rd.Record.read(file)
    found = rd.Record.read(
        file,
        response={1: ("z", 2.0), "beta at 0.000 m [rad/s]": ("beta", 3.0)},
        force={3: ("z", 1)},
    )
    assert found.quantity == "velocity"
    assert found.response == (("z", 2.0), ("beta", 3.0))
    # beta turns against Y: its direction is -RY, so that the dataset is turned round
    assert found.value.tobytes() == (of.value * [[1.0], [-1.0]]).tobytes()
    assert found.force.tobytes() == of.force.tobytes()
    with pytest.raises(rd.SceneError, match="quantity must be that of channel 1, velocity"):
        rd.Record.read(file, response={1: ("z", 2.0)}, quantity="acceleration")


def written(tmp_path, text):
    file = tmp_path / "a.csv"
    file.write_text(text)
    return file


ROWS = "".join(f"{k / 64},{np.sin(k)!r},{np.cos(k)!r}\n" for k in range(50)).replace(
    "np.float64", ""
)
TEXT = "t,a1,hammer\n" + ROWS.replace("(", "").replace(")", "")


def test_columns_are_named_or_numbered(tmp_path):
    file = written(tmp_path, TEXT)
    by_name = rd.Record.read(file, time="t", response={"a1": POINTS[0]})
    by_number = rd.Record.read(file, rate=64.0, response={1: POINTS[0]}, force={2: ("z", 9.0)})
    assert by_name.value.tobytes() == by_number.value.tobytes()
    np.testing.assert_array_equal(by_number.force, np.cos(np.arange(50)))
    in_g = rd.Record.read(file, time="t", response={"a1": POINTS[0]}, unit={"a1": "g"})
    np.testing.assert_allclose(in_g.value, 9.80665 * by_name.value, rtol=1e-15)
    assert rd.Record.read(file, time=0, response={1: POINTS[0]}, unit="mm/s").quantity == "velocity"


@pytest.mark.parametrize(
    ("text", "given", "message"),
    [
        (TEXT, {"time": "t", "response": {"a2": POINTS[0]}}, "response must be names out of"),
        (TEXT, {"response": {"a1": POINTS[0]}}, r"time must be the column .* or rate stated in Hz"),
        (
            TEXT,
            {"time": "t", "response": {"a1": POINTS[0]}, "unit": "N"},
            "unit of 'a1' in .* must be",
        ),
        (TEXT, {"time": "t", "response": {}}, "response must say which channels"),
        (
            TEXT.replace("\n1/", "\n"),
            {"time": 9, "response": {1: POINTS[0]}},
            "time of .* must be a whole",
        ),
        (TEXT + "0.9,loud,1\n", {"time": 0, "response": {1: POINTS[0]}}, "'loud' in line 52"),
        (TEXT + "0.9,nan,1\n", {"time": 0, "response": {1: POINTS[0]}}, r"value\[0\]\[50\]"),
        (TEXT + "0.9,1\n", {"time": 0, "response": {1: POINTS[0]}}, "2 of 3 columns in line 52"),
        (
            "t;a1\n0,0;1,5\n0,1;1,6\n",
            {"time": "t", "response": {"a1": POINTS[0]}},
            'decimal=","',
        ),
        ("# ropedyn record {}\n", {}, "nobody changed"),
        ('# ropedyn {"drive": 1}\n', {}, "Measured.read reads it"),
    ],
)
def test_bad_text_is_named(tmp_path, text, given, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.Record.read(written(tmp_path, text), **given)


def test_what_a_file_says_is_not_said_again(tmp_path):
    hammered().write(tmp_path / "a.csv")
    with pytest.raises(rd.SceneError, match="rate must be left out for"):
        rd.Record.read(tmp_path / "a.csv", rate=51.2)


def test_a_universal_file_without_motion_is_named(tmp_path):
    pytest.importorskip("pyuff")
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
    model.frf([10.0, 11.0], drive=("z", 0.5)).write(tmp_path / "a.uff")
    with pytest.raises(rd.SceneError, match="function type 1"):
        rd.Record.read(tmp_path / "a.uff")


@pytest.mark.parametrize("rate", ["0.0", "-0.0", "nan", "-64.0", "1e-308"])
def test_a_universal_file_of_no_rate_is_named(rate, tmp_path):
    pytest.importorskip("pyuff")
    time = np.arange(20) / 64
    rd.Record(time, np.cos(time)[None], rate=64.0, response=[("z", 0.5)]).write(tmp_path / "a.uff")
    text = (tmp_path / "a.uff").read_text()
    assert "rate 64.0" in text
    (tmp_path / "a.uff").write_text(text.replace("rate 64.0", f"rate {rate}"))
    with pytest.raises(rd.SceneError, match=r"nobody changed, got .*a.uff"):
        rd.Record.read(tmp_path / "a.uff")


def test_gaps_are_no_part_of_a_universal_file(tmp_path):
    kept = (TIME < 7) | (TIME > 8)
    of = rd.Record(TIME[kept], motion()[:, kept], response=POINTS)
    with pytest.raises(rd.SceneError, match=r"write \.csv"):
        of.write(tmp_path / "a.uff")


# spectra


def test_density_is_that_of_scipy():
    found = record().spectrum(4.0)
    # drift below a third of the lowest frequency of a peak, 40 cycles in the record, is taken away:
    # a Butterworth filter forth and back leaves 1/(1 + (f_c/f)^4)
    frequency, psd = welch(motion(), RATE, "hann", 256)
    assert found.averages == 6
    cut = 40 * RATE / COUNT / 3
    kept = frequency > 8 * cut
    np.testing.assert_allclose(found.frequency, frequency, rtol=1e-15)
    np.testing.assert_allclose(found.psd[:, kept], psd[:, kept], rtol=2e-2)
    assert found.labels[0] == "z at 3.500 m [(m/s^2)^2/Hz]"


def test_segments_that_do_not_fit_are_named():
    for given in (0.1, 100.0):
        with pytest.raises(rd.SceneError, match=r"segment must last from 0\.25 s, 16 samples, to"):
            record().spectrum(given)


def test_figures_of_records_say_what_they_show():
    value = motion()
    value[1] = 0.0
    one = record(value)
    assert one.plot().get_legend().get_texts()[1].get_text().endswith("not used")
    assert one.spectrum().plot().get_xlabel() == "frequency [Hz]"
    assert one.plot_spectrogram(channel=0, segment=1.0).get_title() == "z at 3.500 m [m/s^2]"
    with pytest.raises(rd.SceneError, match="channel must be"):
        one.plot_spectrogram(channel=2)
