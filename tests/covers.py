"""Which files a row of VALIDATION.md was measured with, and one hash of them.

They are the test's module, the modules of tests/support that it imports, directly or by others of
them, and the folders of the library whose numbers it measures: those of the folder it lies in.
What else they import is left out, or every row would expire with every change.
"""

import ast
import functools
import hashlib
from pathlib import Path

ROOT = Path(__file__).parent.parent
SUPPORT = ROOT / "tests" / "support"
ROPE = ["ropedyn/chain", "csrc/base", "csrc/element", "csrc/chain", "csrc/span", "csrc/graded"]
"""What every answer of a scene rests on."""
FOLDERS = {
    "chain": [*ROPE, "csrc/closed", "csrc/sweep", "csrc/modes", "csrc/assembled"],
    "curves": ["ropedyn/curves", "ropedyn/signal"],
    "eigen": [
        *ROPE,
        *("ropedyn/eigen", "csrc/closed", "csrc/sweep", "csrc/damped", "csrc/modes"),
        *("csrc/energy", "csrc/assembled"),
    ],
    "experiment": ["ropedyn/experiment", "ropedyn/family", "csrc/closed"],
    "motion": [*ROPE, "ropedyn/motion", "csrc/volterra", "csrc/law", "csrc/collocation"],
    "parametric": [*ROPE, "ropedyn/parametric"],
    "response": [
        *ROPE,
        *("ropedyn/response", "csrc/sweep", "csrc/energy", "csrc/assembled", "csrc/mixed"),
    ],
    "scene": ["ropedyn/scene"],
    "space": ["ropedyn/axis", "ropedyn/space", "csrc/base", "csrc/space"],
    "study": ["ropedyn/study", "ropedyn/study2015.py"],
}
"""By folder of tests: what of the library its claims measure."""


def files(test):
    """Return the files that a test, tests/folder/test_x.py::name, covers."""
    module = ROOT / test.partition("::")[0]
    found = {module, *_support(module)}
    for name in FOLDERS[module.parent.name]:
        found |= _sources(ROOT / name)
    return sorted(found)


def state(test):
    """Return the hash of names and bytes of the files that a test covers."""
    text = "".join(f"{path.relative_to(ROOT).as_posix()} {_digest(path)}\n" for path in files(test))
    return hashlib.sha256(text.encode()).hexdigest()[:8]


@functools.cache
def _digest(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


@functools.cache
def _sources(path):
    if path.is_file():
        return {path}
    return {one for one in path.rglob("*") if one.suffix in (".py", ".c", ".h")}


@functools.cache
def _imports(path):
    """Names of the modules that a file imports, anywhere in it."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names.add(node.module)
    return names


def _support(module):
    found, new = set(), {module}
    while new:
        named = {SUPPORT / f"{name}.py" for path in new for name in _imports(path)}
        new = {path for path in named if path.exists()} - found
        found |= new
    return found
