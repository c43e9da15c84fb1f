"""The house: folders that know those below them, rooms that a newcomer can live in."""

import ast
import statistics
import subprocess
import sys
from pathlib import Path

import grimp
import numpy as np
import pytest
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

ROOT = Path(__file__).parent.parent.parent
MODULES = sorted((ROOT / "ropedyn").rglob("*.py"))
MOST_IN_A_CIRCLE, MOST_IN_A_FOLDER, MOST_LINES, MOST_IN_ALL = 3, 18, 600, 68_150


def circles(graph):
    """Return the modules that know each other in a circle, imports of any kind counted."""
    names = sorted(graph.modules)
    place = {name: k for k, name in enumerate(names)}
    pairs = [
        (place[one], place[other])
        for one in names
        for other in graph.find_modules_directly_imported_by(one)
    ]
    rows, columns = zip(*pairs)
    knows = csr_array((np.ones(len(rows)), (rows, columns)), shape=(len(names), len(names)))
    count, group = connected_components(knows, connection="strong")
    found = [[names[k] for k in np.flatnonzero(group == g)] for g in range(count)]
    return [circle for circle in found if len(circle) > 1]


def lines(path):
    return path.read_text(encoding="utf-8").count("\n")


def test_modules_know_each_other_in_no_large_circle():
    graph = grimp.build_graph("ropedyn", exclude_type_checking_imports=False, cache_dir=None)
    # Scene.compile and Scene.family, the listed exceptions of the floors
    for facade in ("ropedyn.model", "ropedyn.family.family", "ropedyn.study.needed"):
        graph.remove_import(importer="ropedyn.scene.scene", imported=facade)
    assert [circle for circle in circles(graph) if len(circle) > MOST_IN_A_CIRCLE] == []


def test_a_circle_is_seen(tmp_path, monkeypatch):
    package = tmp_path / "roundabout"
    package.mkdir()
    texts = {"__init__": "", "a": "from . import b", "b": "def f():\n    from . import a"}
    for name, text in texts.items():
        (package / f"{name}.py").write_text(text + "\n", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    graph = grimp.build_graph("roundabout", cache_dir=None)
    assert circles(graph) == [["roundabout.a", "roundabout.b"]]


def test_floors_hold():
    command = [str(Path(sys.executable).with_name("lint-imports")), "--no-cache"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("root", ["ropedyn", "csrc"])
def test_no_folder_is_a_warehouse(root):
    folders = {path.parent for path in (ROOT / root).rglob("*.[pch]*") if path.suffix != ".pyc"}
    count = {
        str(folder.relative_to(ROOT)): len([*folder.glob("*.py"), *folder.glob("*.[ch]")])
        for folder in folders
    }
    assert {name: n for name, n in count.items() if n > MOST_IN_A_FOLDER} == {}


def test_modules_fit_a_reader():
    length = {str(path.relative_to(ROOT)): lines(path) for path in MODULES}
    assert {name: n for name, n in length.items() if n > MOST_LINES} == {}
    rooms = [n for name, n in length.items() if not name.endswith(("__init__.py", "__main__.py"))]
    assert 120 <= statistics.median(rooms) <= 250
    assert sum(length.values()) <= MOST_IN_ALL


def test_what_is_computed_when_read_has_one_mechanism():
    """That of the standard library takes a lock before Python 3.12, which a fork can freeze."""
    found = [path for path in MODULES if "cached_property" in path.read_text(encoding="utf-8")]
    assert found == [ROOT / "ropedyn" / "base" / "computed.py"]


def test_a_class_name_stands_for_one_thing():
    places = {}
    for path in MODULES:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                places.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    assert {name: found for name, found in places.items() if len(found) > 1} == {}
