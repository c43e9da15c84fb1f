"""Whatever damage makes of a file: it is read, or refused by its name, and nothing else is said."""

import functools
import gc

import numpy as np
import pytest
from damaged_files import mutants

import ropedyn as rd

SCENE = rd.Scene(
    rd.Rope(2.0, 0.1, bending_stiffness=1.5, torsional_stiffness=0.4, lay_slope=0.1),
    tension=rd.Tension(100.0, amplitude=5.0, frequency=3.0),
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    damping=[rd.StiffnessDamping(1e-4), rd.ViscousDamping(0.5)],
    parts=[rd.PointMass(0.4, 0.02), rd.Spring(0.5, 1e4), rd.Resonator(0.7, 0.01, 16.0)],
)
PLAIN = rd.Scene(rd.Rope(2.0, 0.1, bending_stiffness=1.0), tension=1000.0)
TIME = np.arange(20) / 64
POINT = ("z", 0.5)


@functools.cache
def measured():
    frequency = np.linspace(20.0, 30.0, 7)
    value = np.cos(frequency) + 1j * np.sin(frequency)
    known = {"coherence": np.full((1, 7), 0.9), "averages": 4.0}
    return rd.Measured(frequency, value[None], drive=POINT, response=[POINT], **known)


@functools.cache
def record():
    points = {"response": [POINT, ("beta", 0.7)], "quantity": "acceleration"}
    pushed = {"force": np.sin(40 * TIME), "drive": ("z", 1.0)}
    return rd.Record(TIME, np.cos([40 * TIME, 30 * TIME]), rate=64.0, **points, **pushed)


def scenes(folder):
    for scene in (SCENE, PLAIN):
        scene.save(folder / "a.toml")
        yield (folder / "a.toml").read_bytes()


def texts(folder):
    for one in (measured(), record()):
        one.write(folder / "a.csv")
        yield (folder / "a.csv").read_bytes()
        # as another program would have written it
        yield (folder / "a.csv").read_bytes().partition(b"\n")[2]
    yield b"t;a;b\n" + b"".join(b"%d;%d,5;%de-3\n" % (k, k, 7 * k) for k in range(9))


def universal(folder):
    for one in (measured(), record()):
        for binary in (False, True):
            one.write(folder / "a.uff", binary=binary)
            content = (folder / "a.uff").read_bytes()
            yield content
            yield content.replace(b"ropedyn", b"else", 2)


def answers(folder):
    model = PLAIN.compile(elements=6)
    push = {"drive": ("end", 0, "z"), "force": rd.Sine(1e-3, 20.0), "response": POINT}
    for one in (
        model.modes(2),
        model.frf([10.0, 20.0], drive=POINT),
        model.transient(np.linspace(0.0, 0.1, 21), **push, method="line"),
        rd.Peaks([20.0, 50.0], std=0.1),
    ):
        one.save(folder / "a.nc")
        yield (folder / "a.nc").read_bytes()


MEANING = {"drive": POINT, "response": POINT, "unit": "m/N"}
COLUMNS = {"frequency": 0, "real": 1, "imag": 2}
FORMATS = {
    "toml": (scenes, (rd.Scene.load,)),
    "csv": (
        texts,
        (
            rd.Measured.read,
            functools.partial(rd.Measured.read, columns=COLUMNS, **MEANING),
            functools.partial(rd.Measured.read, columns=COLUMNS, decimal=",", **MEANING),
            rd.Record.read,
            functools.partial(rd.Record.read, time=0, response={1: POINT}),
        ),
    ),
    "uff": (
        universal,
        (
            rd.Measured.read,
            functools.partial(rd.Measured.read, positions={1: 0.5}, coordinate={"Z": "z"}),
            functools.partial(rd.Measured.read, positions="X", coordinate="z"),
            rd.Record.read,
            functools.partial(rd.Record.read, response={1: POINT}),
        ),
    ),
    "nc": (answers, (rd.load,)),
}


def tried(path, readers):
    """Return how many ways read a file; what they refuse names it."""
    read = 0
    for reader in readers:
        try:
            reader(path)
            read += 1
        except (rd.SceneError, OSError) as error:
            assert path.name in str(error), (reader, error)
    return read


def read_all(kind, count, seed, folder, capfd):
    """Read mutants; return how many were read and how many refused."""
    make, readers = FORMATS[kind]
    whole = list(make(folder))
    capfd.readouterr()
    path, read = folder / f"mutant.{kind}", 0
    for k, content in enumerate(mutants(whole, count, seed)):
        path.write_bytes(content)
        try:
            read += tried(path, readers)
        except BaseException as error:
            error.add_note(f"mutant {k} of seed {seed}, kept in {path}")
            raise
        if k % 1000 == 999:
            gc.collect()  # what is left to the collector is said by it
    gc.collect()
    assert "".join(capfd.readouterr()) == ""
    return read, count * len(readers) - read


@pytest.mark.parametrize("kind", FORMATS)
def test_what_is_whole_is_read(kind, tmp_path):
    make, readers = FORMATS[kind]
    for content in list(make(tmp_path)):
        path = tmp_path / f"whole.{kind}"
        path.write_bytes(content)
        assert tried(path, readers) >= 1


DOUBTED = pytest.mark.filterwarnings("ignore::ropedyn.UnitWarning")  # of damaged numbers


@DOUBTED
@pytest.mark.long
@pytest.mark.parametrize("kind", FORMATS)
def test_a_damaged_file_is_read_or_refused_by_name(kind, tmp_path, capfd):
    read, refused = read_all(kind, 1000, 1, tmp_path, capfd)
    # the damage is neither nothing nor all, but of answers a checksum sees all of it
    assert refused > 100 and (read > 20) == (kind != "nc")


@DOUBTED
@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2, 12))  # ten times, which several processes share
@pytest.mark.parametrize("kind", FORMATS)
def test_many_damaged_files_are_read_or_refused_by_name(kind, seed, tmp_path, capfd):
    read_all(kind, 10_000, seed, tmp_path, capfd)


def test_a_scene_with_a_byte_order_mark_is_read(tmp_path):
    path = tmp_path / "marked.toml"
    SCENE.save(path)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert rd.Scene.load(path) == SCENE
