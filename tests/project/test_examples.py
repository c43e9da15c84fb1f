"""Every public name has an example in the documentation; `pytest --doctest-modules` runs them."""

import ast
import doctest
import inspect
import types

import pytest

import ropedyn as rd
from ropedyn.scene import damping, force
from ropedyn.scene.parts import part

PROTOCOLS = (part.Part, damping.Damping, force.Force)
"""What the kinds of parts, dampings and forces have in common is shown there once."""


def public(names):
    return [name for name in names if not name.startswith("_")]


def things(package):
    """Return what users see by name: of the package and of the modules among its names."""
    found = {name: getattr(package, name) for name in package.__all__}
    for name, module in list(found.items()):
        if isinstance(module, types.ModuleType):
            inner = {key: value for key, value in vars(module).items() if public([key])}
            own = {
                k: v
                for k, v in inner.items()
                if f"{getattr(v, '__module__', '')}.".startswith(f"{module.__name__}.")
            }
            found |= {f"{name}.{key}": value for key, value in own.items()}
    return found


def family(kind):
    """Return the classes whose documentation is that of a class: itself, its bases, protocols."""
    ours = ("ropedyn", __name__)
    bases = [base for base in kind.__mro__ if base.__module__.partition(".")[0] in ours]
    has = {*dir(kind), *getattr(kind, "__annotations__", {})}
    fits = [one for one in PROTOCOLS if set(public(vars(one))) <= has]
    return dict.fromkeys([*bases, *fits])


def function_of(value):
    """Return the function of a method or a property, None of anything else."""
    for wrapped in ("__func__", "fget", "func"):
        value = getattr(value, wrapped, value)
    return value if inspect.isfunction(value) else None


def members(kind):
    """Return methods and properties of a class by name, each with those it takes the place of."""
    found = {}
    for base in family(kind):
        for name in public(vars(base)):
            if function_of(vars(base)[name]) is not None:
                found.setdefault(name, []).append(vars(base)[name])
    return found


def examples(thing):
    """Return the examples in the documentation of a class, a function or a property."""
    return doctest.DocTestParser().get_examples(inspect.getdoc(function_of(thing) or thing) or "")


def of_class(kind):
    """Return the examples of a class and of its members."""
    texts = [*family(kind), *(each for values in members(kind).values() for each in values)]
    return [one for thing in texts for one in examples(thing)]


def read_by(sources):
    """Return the attributes that examples read."""
    nodes = (node for one in sources for node in ast.walk(ast.parse(one.source)))
    return {node.attr for node in nodes if isinstance(node, ast.Attribute)}


def without_example(named):
    """Return the names that no example shows.

    A function or method has one of its own, or that of a method it takes the place of, or its class
    has one that calls it; a property is read in the examples of any class; a class has some.
    """
    classes = {name: kind for name, kind in named.items() if inspect.isclass(kind)}
    functions = {name: one for name, one in named.items() if inspect.isfunction(one)}
    anywhere = [one for thing in functions.values() for one in examples(thing)]
    anywhere += [one for kind in classes.values() for one in of_class(kind)]
    shown, found = read_by(anywhere), []
    found += [name for name, one in functions.items() if not examples(one)]
    for name, kind in classes.items():
        here = of_class(kind)
        called = read_by(here)
        found += [] if here else [name]
        for member, values in members(kind).items():
            is_method = not isinstance(values[0], property) and not hasattr(values[0], "func")
            own = any(examples(value) for value in values)
            if not own and member not in (called if is_method else shown):
                found.append(f"{name}.{member}")
    return found


def test_every_public_name_has_an_example():
    assert without_example(things(rd)) == []


def test_the_names_of_modules_are_walked_too():
    assert {"ask.modes", "study2015.scene", "ask.ModesQuestion"} < set(things(rd))


class Shown:
    """A class with an example.

    >>> Shown().called()
    """

    def called(self):
        """Its class shows it."""

    def silent(self):
        """Nothing shows it."""

    @property
    def unread(self):
        """Nothing reads it."""


class Below(Shown):
    """Nothing of its own."""

    def silent(self):
        """
        >>> Below().silent()
        """


class Bare:
    """No example."""


def alone():
    """No example."""


@pytest.mark.parametrize(
    ("thing", "missing"),
    [
        (Shown, ["it.silent", "it.unread"]),
        (Below, ["it.unread"]),
        (Bare, ["it"]),
        (alone, ["it"]),
        (rd.sweep, []),
    ],
)
def test_what_no_example_shows_is_found(thing, missing):
    assert without_example({"it": thing}) == missing


def test_what_tab_offers_fits_a_screen():
    assert len([name for name in dir(rd) if not name.startswith("_")]) <= 90


def silent(thing):
    """Return the examples of a docstring none of which shows its output."""
    found = examples(thing)
    return bool(found) and not any(one.want for one in found)


def test_every_example_shows_its_output():
    named = things(rd)
    kinds = [kind for kind in named.values() if inspect.isclass(kind)]
    each = [*named.values(), *(one for kind in kinds for m in members(kind).values() for one in m)]
    assert [
        getattr(function_of(one) or one, "__qualname__", one) for one in each if silent(one)
    ] == []
