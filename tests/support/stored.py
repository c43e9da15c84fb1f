"""References of many digits, kept with a hash of what computes them: tests/reference/stored.

A function marked `stored` answers from the file of its module there. What is missing, or was made
by other source than there is now, is an error; ROPEDYN_REFERENCES says when to compute instead:

    compute    what is missing or was made by other source, and write the files
    check      everything, and hold it against the files
    tenth      one in ten, chosen by the hash of its arguments, held against the files

Large samples (pytest -m slow) are not kept, and computed.
"""

import ast
import dataclasses
import functools
import hashlib
import inspect
import json
import os
import sys
import types
from collections.abc import Mapping
from pathlib import Path

import mpmath
import numpy as np

import ropedyn as rd

FOLDER = Path(__file__).parent.parent / "reference" / "stored"
WHOLE = ["-m", "not slow"]
"""Arguments of a run of all tests that ask, after which no value is left that none asks for."""
COMMAND = "ROPEDYN_REFERENCES=compute .venv/bin/pytest -m 'not slow'"
DIGITS = 50
"""Of what is kept, beyond what any comparison asks for."""
SAME = {str: 1e-25, float: 1e-9}
"""How far what is computed again may be from what is kept, over the largest of an answer: an
eigenvalue is known to 1e-30, a condition to its differences of 1e-20."""
RAISED = {error.__name__: error for error in (ValueError, ZeroDivisionError)}
SUPPORT = Path(__file__).parent


class StoredError(Exception):
    """A reference is not kept, or is not what is computed."""


@dataclasses.dataclass
class Session:
    """What a run of the tests has asked for."""

    how: str = os.environ.get("ROPEDYN_REFERENCES", "")
    large: bool = False
    """A test of a large sample runs."""
    inside: bool = False
    """A stored function is being computed, with all that it calls."""
    used: dict = dataclasses.field(default_factory=dict)
    """By file and function: source, tests that ask, values by key."""


SESSION = Session()


def stored(function):
    """Mark a function of numbers, texts and descriptions whose value is kept."""
    name = f"{Path(inspect.getfile(function)).stem}.{function.__qualname__}"

    @functools.wraps(function)
    def answer(*arguments, **named):
        if SESSION.inside or SESSION.large:
            return function(*arguments, **named)
        key = digest(text_of((arguments, named, mpmath.mp.dps)))
        source = source_of(function.__module__, function.__qualname__.partition(".")[0])
        again = SESSION.how == "check" or (SESSION.how == "tenth" and int(key, 16) % 10 == 0)
        kept = kept_value(name, source, key)
        if (kept is None and SESSION.how == "compute") or again:
            made = computed(function, arguments, named)
            if kept is not None and not is_same(made, kept["is"]):
                raise StoredError(f"{name} has another value than the one kept at {key}: {made}")
            kept = kept or {"is": made}
        if kept is None:
            raise StoredError(f"no value of {name} is kept for what it is asked: run {COMMAND}")
        note(name, source, key, kept)
        return read(kept["is"])

    return answer


def computed(function, arguments, named):
    """The value of a function as it is written, or what it raises."""
    SESSION.inside = True
    try:
        return written(function(*arguments, **named))
    except tuple(RAISED.values()) as error:
        return {"raises": [type(error).__name__, str(error)]}
    finally:
        SESSION.inside = False


# --- files ------------------------------------------------------------------------------------


def path_of(name):
    """The file of a function's module."""
    return FOLDER / f"{name.partition('.')[0]}.json"


@functools.cache
def contents(path):
    """What a file keeps, by function."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def kept_value(name, source, key):
    """What is kept, as {"is": value}, or None."""
    found = contents(path_of(name)).get(name, {"source": None, "values": {}})
    fresh = SESSION.used.get(name, {"values": {}})["values"]
    if key in fresh:
        return {"is": fresh[key]}
    if found["source"] != source:
        if SESSION.how != "compute":
            raise StoredError(f"{name} is not what its values were made by: run {COMMAND}")
        return None
    return {"is": found["values"][key]} if key in found["values"] else None


def note(name, source, key, kept):
    """Remember who asked for what, where files are to be written."""
    if SESSION.how == "compute":
        used = SESSION.used.setdefault(name, {"source": source, "tests": [], "values": {}})
        used["values"][key] = kept["is"]
        test = os.environ.get("PYTEST_CURRENT_TEST", "").partition("::")[0]
        if test not in used["tests"]:
            used["tests"].append(test)


def merge(used):
    """Add what another process has asked for."""
    for name, one in used.items():
        mine = SESSION.used.setdefault(name, one)
        mine["values"] |= one["values"]
        mine["tests"] = sorted({*mine["tests"], *one["tests"]})


def write(whole):
    """Write the files; after a whole run what no test has asked for is left out."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    paths = {path_of(name) for name in SESSION.used} | set(FOLDER.glob("*.json") if whole else ())
    for path in paths:
        own = {name: one for name, one in SESSION.used.items() if path_of(name) == path}
        if not whole:
            for name, old in contents(path).items():
                mine = own.setdefault(name, old)
                if mine["source"] == old["source"]:
                    mine["values"] = old["values"] | mine["values"]
                    mine["tests"] = sorted({*old["tests"], *mine["tests"]})
        if own:
            path.write_text(text_of_file(own), encoding="utf-8")
        else:
            path.unlink()


def text_of_file(functions):
    """JSON with a line for each value."""
    blocks = []
    for name, one in sorted(functions.items()):
        values = ",\n".join(
            f"   {json.dumps(k)}: {json.dumps(v)}" for k, v in sorted(one["values"].items())
        )
        tests = json.dumps(sorted(one["tests"]))
        blocks.append(
            f" {json.dumps(name)}: {{\n"
            f'  "source": {json.dumps(one["source"])},\n'
            f'  "tests": {tests},\n'
            f'  "values": {{\n{values}\n  }}\n }}'
        )
    return "{\n" + ",\n".join(blocks) + "\n}\n"


# --- values -----------------------------------------------------------------------------------


def written(value):
    """A value as JSON has it: numbers of many digits are texts, complex ones pairs in a list."""
    if isinstance(value, np.generic):
        return written(value.item())
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, mpmath.mpf):
        return mpmath.nstr(value, DIGITS)
    if isinstance(value, mpmath.mpc):
        return {"complex": [written(value.real), written(value.imag)]}
    if isinstance(value, dict):
        return {key: written(one) for key, one in value.items()}
    return [written(one) for one in value]


def read(value):
    """What `written` was given; sequences are lists."""
    if isinstance(value, str):
        with mpmath.workdps(DIGITS + 5):
            return mpmath.mpf(value)
    if isinstance(value, list):
        return [read(one) for one in value]
    if isinstance(value, dict) and "complex" in value:
        return mpmath.mpc(*map(read, value["complex"]))
    if isinstance(value, dict) and "raises" in value:
        name, message = value["raises"]
        raise RAISED[name](message)
    if isinstance(value, dict):
        return {key: read(one) for key, one in value.items()}
    return value


def leaves(value):
    """The texts and numbers of a written value."""
    if isinstance(value, dict):
        value = list(value.values())
    return [leaf for one in value for leaf in leaves(one)] if isinstance(value, list) else [value]


def is_same(one, other):
    """Whether two written values are the same but for what rounding may do."""
    if isinstance(one, dict) and "raises" in one:
        return one == other
    pairs = list(zip(leaves(one), leaves(other), strict=True))
    if any(type(a) is not type(b) for a, b in pairs):
        return False
    for kind, allowed in SAME.items():
        with mpmath.workdps(DIGITS + 5):
            numbers = [[mpmath.mpf(x) for x in pair] for pair in pairs if type(pair[0]) is kind]
            largest = max((abs(b) for _, b in numbers if mpmath.isfinite(b)), default=0)
            if not all(a == b or abs(a - b) <= allowed * largest for a, b in numbers):
                return False
    return all(a == b for a, b in pairs if type(a) not in SAME)


# --- arguments --------------------------------------------------------------------------------


def digest(text):
    """Name a text by sixteen digits."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def text_of(value):
    """All that an argument says, the same on every machine."""
    if isinstance(value, np.generic):
        return text_of(value.item())
    if value is None or isinstance(value, bool | int | float | str):
        return repr(value)
    if isinstance(value, mpmath.mpf | mpmath.mpc):
        return mpmath.nstr(value, DIGITS)
    if isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        return f"[{', '.join(map(text_of, value))}]"
    if isinstance(value, Mapping):
        return f"{{{', '.join(f'{k}: {text_of(v)}' for k, v in value.items())}}}"
    if isinstance(value, rd.Model):
        # where its nodes are follows from these
        value = value.scene, value.element, len(value.x)
        return f"Model{text_of(value)}"
    if isinstance(value, types.SimpleNamespace):
        return f"Names{text_of(vars(value))}"
    if dataclasses.is_dataclass(value):
        return f"{name_of(type(value))}{text_of(numbers_of(value))}"
    raise TypeError(f"a stored function takes no {type(value).__name__}")


def numbers_of(value):
    """Fields of a description that are not what they are when nobody gives them."""
    found = {}
    for field in dataclasses.fields(value):
        one = getattr(value, field.name)
        default = field.default
        if field.default_factory is not dataclasses.MISSING:
            default = field.default_factory()
        if default is dataclasses.MISSING or (one is not default and one != default):
            found[field.name] = one
    return found


def name_of(kind):
    """The name of a class, with its source where that is of the tests."""
    module = inspect.getmodule(kind)
    of_tests = Path(module.__file__).parent == SUPPORT
    return kind.__name__ + (source_of(module.__name__, kind.__name__) if of_tests else "")


# --- source -----------------------------------------------------------------------------------


@functools.cache
def source_of(module, name):
    """Name the source of a thing and of all of the tests' modules that it uses."""
    found = {}
    gather(module, name, found)
    return digest("\n".join(found[key] for key in sorted(found)))


def gather(module, name, found):
    """Add the statements of a module that bind a name, and those that they use."""
    statements, imported = parsed(module)
    if name in imported:
        other, own = imported[name]
        for each in [own] if own else parsed(other)[0]:
            gather(other, each, found)
    elif name in statements and (module, name) not in found:
        found[module, name] = dumped(statements[name])
        for node in ast.walk(statements[name]):
            if isinstance(node, ast.Name):
                gather(module, node.id, found)


def dumped(node):
    """A statement as Python 3.11 dumps it; later ones leave lists out, or have more fields."""
    shown = {"show_empty": True} if sys.version_info >= (3, 13) else {}
    return ast.dump(node, **shown).replace(", type_params=[]", "")


@functools.cache
def parsed(module):
    """Top statements of a module by the names they bind, and names from modules of the tests."""
    path = SUPPORT / f"{module}.py"
    if not path.exists():
        path = next(SUPPORT.parent.glob(f"*/{module}.py"))
    statements, imported = {}, {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            for alias in node.names:
                of = node.module if isinstance(node, ast.ImportFrom) else alias.name
                if (SUPPORT / f"{of}.py").exists():
                    own = alias.name if isinstance(node, ast.ImportFrom) else None
                    imported[alias.asname or alias.name] = of, own
        for name in bound(node):
            statements[name] = without_words(node)
    imported.pop("stored", None)  # how a value is kept does not change it
    return statements, imported


def bound(node):
    """Names that a top statement binds."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return [node.name]
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    return [
        each.id for one in targets if one for each in ast.walk(one) if isinstance(each, ast.Name)
    ]


def without_words(node):
    """A statement without its docstrings."""
    for each in ast.walk(node):
        if isinstance(each, ast.FunctionDef | ast.ClassDef) and ast.get_docstring(each) is not None:
            each.body = each.body[1:]
    return node
