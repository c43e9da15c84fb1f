"""Files are written whole or not at all, whatever stands in their place and however full a disk."""

import errno
import os
import socket
import stat
import subprocess
import sys

import pytest

import ropedyn as rd
from ropedyn.base.atomic import write_bytes

PEAKS = rd.Peaks([20.0, 50.0])


def made_socket(path):
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(path))


def made_loop(path):
    other = path.with_name("other")
    path.symlink_to(other)
    other.symlink_to(path)


OTHERS = {
    "directory": (lambda path: path.mkdir(), "a directory"),
    "device": (lambda path: path.symlink_to("/dev/full"), "a device"),
    "pipe": (os.mkfifo, "a pipe"),
    "socket": (made_socket, "a socket"),
    "loop of links": (made_loop, "a link that leads to itself"),
}


def told(folder):
    """What stands in a folder; links are read, which changes when they were read last."""
    found = {one: one.lstat() for one in folder.iterdir()}
    return {one: (s.st_ino, s.st_mode, s.st_size, s.st_mtime_ns) for one, s in found.items()}


@pytest.mark.parametrize("kind", OTHERS)
def test_what_is_no_file_is_refused_by_name_and_left_alone(kind, tmp_path):
    make, said = OTHERS[kind]
    path = tmp_path / "target"
    make(path)
    before = told(tmp_path)
    with pytest.raises(OSError, match=f"path must be a file or a new name, not {said}.*target"):
        write_bytes(path, b"new")
    assert told(tmp_path) == before


def test_a_device_itself_is_refused_and_stays():
    with pytest.raises(OSError, match="not a device: '/dev/full'"):
        PEAKS.save("/dev/full")
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


@pytest.mark.parametrize("suffix", ["", ".nc", "." + 200 * "s"])
def test_names_up_to_the_longest_of_the_file_system_are_written(suffix, tmp_path):
    longest = os.pathconf(tmp_path, "PC_NAME_MAX")
    path = tmp_path / ((longest - len(suffix)) * "n" + suffix)
    write_bytes(path, b"whole")
    assert path.read_bytes() == b"whole"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_name_that_is_too_long_is_an_error_of_that_name(tmp_path):
    path = tmp_path / ((os.pathconf(tmp_path, "PC_NAME_MAX") + 1) * "n")
    with pytest.raises(OSError, match="nnn") as refusal:
        write_bytes(path, b"whole")
    assert (refusal.value.errno, refusal.value.filename) == (errno.ENAMETOOLONG, str(path))


def test_of_a_file_with_two_names_one_gets_the_new_content(tmp_path):
    path, other = tmp_path / "one", tmp_path / "other"
    path.write_bytes(b"old")
    os.link(path, other)
    write_bytes(path, b"new")
    assert (path.read_bytes(), other.read_bytes()) == (b"new", b"old")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write what is read-only")
def test_what_is_read_only_is_refused(tmp_path):
    path = tmp_path / "kept"
    path.write_bytes(b"old")
    path.chmod(0o444)
    with pytest.raises(PermissionError, match="kept"):
        write_bytes(path, b"new")
    assert path.read_bytes() == b"old"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files away")
def test_who_owned_a_file_owns_it_after(tmp_path):
    path = tmp_path / "kept"
    path.write_bytes(b"old")
    os.chown(path, 12345, 23456)
    write_bytes(path, b"new")
    assert (path.stat().st_uid, path.stat().st_gid) == (12345, 23456)


FULL = """
import contextlib, errno, io, resource
import matplotlib
matplotlib.use("Agg")
import numpy as np
import ropedyn as rd
from ropedyn.cli import main

scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
modes = scene.compile(elements=8).modes(2)
frf = scene.compile(elements=8).frf(np.linspace(1, 60, 300), drive=("z", 0.5))
scene.save("scene.toml")



def drawn(path):
    with contextlib.redirect_stdout(None), contextlib.redirect_stderr(io.StringIO()) as said:
        status = main(["modes", "scene.toml", "--plot", path])
    if status == 2:
        raise OSError(errno.EFBIG, said.getvalue())


ways = {
    "old.nc": modes.save,
    "old.toml": scene.save,
    "old.csv": frf.write,
    "old.uff": frf.write,
    "old.unv": lambda path: frf.write(path, binary=True),
    "old.gif": lambda path: modes.animate(0, frames=2).write(path),
    "old.html": lambda path: modes.animate(0, frames=2).write(path),
    "old.png": lambda path: drawn(path),
}
for path in ways:
    open(path, "w").write("old")
resource.setrlimit(resource.RLIMIT_FSIZE, (64, resource.RLIM_INFINITY))
for path, write in ways.items():
    try:
        print(path, "wrote", write(path))
    except OSError as error:
        print(path, error.errno, path in str(error))
print("alive")
"""


def test_a_full_disk_is_an_error_that_leaves_the_old_file(tmp_path):
    """No file grows beyond 64 bytes, as on a disk that has no more; Python ignores SIGXFSZ."""
    done = subprocess.run(
        [sys.executable, "-B", "-c", FULL],  # no cut files of byte code
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
    )
    lines = done.stdout.splitlines()
    assert (done.returncode, lines[-1]) == (0, "alive"), done.stderr
    names = [line.split()[0] for line in lines[:-1]]
    assert lines[:-1] == [f"{name} {errno.EFBIG} True" for name in names]
    assert len(names) == 8
    assert {name: (tmp_path / name).read_text() for name in names} == dict.fromkeys(names, "old")
    assert {path.name for path in tmp_path.iterdir()} == {*names, "scene.toml"}
