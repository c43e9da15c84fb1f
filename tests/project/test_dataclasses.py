"""How dataclasses compare and which of them may be changed."""

import ast
from pathlib import Path

import ropedyn as rd

ARRAYS = {"Real", "Complex", "Index", "Flags", "Integer", "NDArray"}
CHANGED = {"_Walk", "Cloud", "_Descent", "Shared", "Branch", "Path", "Agreed", "Regions"}
CHANGED |= {"_Motions"}
"""What holds the state of an iteration, and is changed by it."""


def dataclasses():
    """Name, options and names in the annotations of each dataclass of the package."""
    for file in sorted(Path(rd.__file__).parent.rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if not isinstance(node, ast.ClassDef):
                continue
            for one in node.decorator_list:
                called = isinstance(one, ast.Call)
                if ast.unparse(one.func if called else one) != "dataclass":
                    continue
                options = {k.arg: k.value.value for k in one.keywords} if called else {}
                fields = [n.annotation for n in node.body if isinstance(n, ast.AnnAssign)]
                words = {w.id for f in fields for w in ast.walk(f) if isinstance(w, ast.Name)}
                yield node.name, options, words


def test_what_holds_arrays_is_equal_to_itself_alone():
    """== of arrays is an array, which is neither true nor false."""
    compared = [n for n, how, words in dataclasses() if how.get("eq", True) and words & ARRAYS]
    assert compared == []


def test_only_what_is_named_here_may_be_changed():
    assert {name for name, how, _ in dataclasses() if not how.get("frozen")} == CHANGED
