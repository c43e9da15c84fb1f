"""Stored references: what is kept comes back, what does not fit is an error, all can be remade."""

import os
import subprocess
import sys
from pathlib import Path

import mpmath
import pytest
import stored
from mpmath import mpc, mpf

import ropedyn as rd

ROOT = Path(__file__).parent.parent.parent
ASKED = []


@stored.stored
def third(number, scene=None):
    ASKED.append(number)
    return mpf(1) / number


@pytest.fixture
def session(monkeypatch, tmp_path):
    """Start a run that keeps its references in a folder of its own."""
    monkeypatch.setattr(stored, "FOLDER", tmp_path)
    ASKED.clear()

    def start(how):
        stored.contents.cache_clear()
        monkeypatch.setattr(stored, "SESSION", stored.Session(how=how))

    yield start
    stored.contents.cache_clear()


@pytest.fixture
def kept(session):
    """What a run has computed and written, and another one reads."""
    session("compute")
    with mpmath.workdps(60):
        value = third(3)
    stored.write(whole=True)
    session("")
    ASKED.clear()
    return value


def test_what_is_kept_is_not_computed(kept):
    with mpmath.workdps(60):
        assert third(3) == kept
        assert abs(kept - mpf(1) / 3) < mpf(10) ** -50
    assert ASKED == []


@pytest.mark.parametrize("arguments", [(4,), (3.0,), (3, rd.Scene(rd.Rope(1.0, 0.1), tension=1.0))])
def test_what_is_not_kept_is_an_error_that_says_how_to_compute_it(kept, arguments):
    with mpmath.workdps(60), pytest.raises(stored.StoredError, match=stored.COMMAND):
        third(*arguments)
    assert ASKED == []


def test_what_other_source_has_made_is_an_error(kept, session):
    (path,) = stored.FOLDER.glob("*.json")
    source = stored.source_of("test_stored", "third")
    path.write_text(path.read_text().replace(source, "0" * 16))
    session("")
    with mpmath.workdps(60), pytest.raises(stored.StoredError, match="is not what its values were"):
        third(3)


def test_a_check_finds_what_is_not_what_is_computed(kept, session):
    (path,) = stored.FOLDER.glob("*.json")
    path.write_text(path.read_text().replace("0.33333", "0.33334"))
    session("check")
    with mpmath.workdps(60), pytest.raises(stored.StoredError, match="another value"):
        third(3)


def test_a_tenth_is_computed_again_and_always_the_same(session):
    session("compute")
    for number in range(1, 200):
        third(number)
    stored.write(whole=True)
    again = []
    for _ in range(2):
        session("tenth")
        ASKED.clear()
        for number in range(1, 200):
            third(number)
        again.append(list(ASKED))
    assert again[0] == again[1]
    assert 5 < len(again[0]) < 40


def test_large_samples_are_computed(kept):
    stored.SESSION.large = True
    assert third(5) == mpf(1) / 5


def test_a_run_of_some_tests_keeps_what_others_ask_for(kept, session):
    session("compute")
    third(7)
    stored.write(whole=False)
    session("")
    assert third(7) == stored.read(stored.written(mpf(1) / 7))
    with mpmath.workdps(60):
        assert third(3) == kept


@pytest.mark.parametrize(
    "value",
    [1.1, 0, True, None, mpf("0.75"), mpc(1, -2), [1.5, [mpf(3)]], {"tension": 0.25}],
    ids=str,
)
def test_values_are_read_as_they_were_written(value):
    assert stored.read(stored.written(value)) == value


def test_errors_are_kept_too():
    made = stored.computed(third.__wrapped__, (0,), {})
    with pytest.raises(ZeroDivisionError):
        stored.read(made)


def test_an_argument_is_known_by_its_numbers():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=3.0)
    same = rd.Scene(rd.Rope(1.0, 0.1), tension=3, ends=("clamped", "clamped"))
    assert stored.text_of(scene) == stored.text_of(same)
    assert stored.text_of(scene) != stored.text_of(scene.replace(tension=3.1))
    with pytest.raises(TypeError, match="takes no object"):
        stored.text_of(object())


def test_source_is_that_of_all_that_is_used():
    """Not that of what stands beside it in the module, nor its words."""
    found = {}
    stored.gather("exact_roots", "sensitivity", found)
    assert {("exact_roots", "sensitivity"), ("exact_chain", "DIGITS")} <= set(found)
    assert ("exact_roots", "cluster") not in found
    assert "first order" not in "".join(found.values())


def test_no_file_is_of_other_source_than_there_is():
    for path in stored.FOLDER.glob("*.json"):
        for name, one in stored.contents(path).items():
            module, _, thing = name.partition(".")
            assert one["source"] == stored.source_of(module, thing.partition(".")[0]), name


@pytest.mark.slow
def test_every_stored_reference_is_what_is_computed():
    tests = {
        test
        for path in stored.FOLDER.glob("*.json")
        for one in stored.contents(path).values()
        for test in one["tests"]
    }
    run = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", *sorted(tests)],
        cwd=ROOT,
        env=os.environ | {"ROPEDYN_REFERENCES": "check"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, run.stdout
