"""What is computed when it is first read, and kept: without a lock, which a fork could freeze."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial, wraps
from typing import Any, Generic, ParamSpec, Self, TypeVar, cast, overload

import numpy as np

Value = TypeVar("Value")
Given = ParamSpec("Given")


class Reader(Generic[Value]):
    """What is read of a thing as its attribute."""

    @overload
    def __get__(self, thing: None, owner: type[Any] | None = None) -> Self: ...
    @overload
    def __get__(self, thing: object, owner: type[Any] | None = None) -> Value: ...
    def __get__(self, thing: object | None, owner: type[Any] | None = None) -> Self | Value:
        return self if thing is None else self.read(thing)

    def read(self, thing: object) -> Value:
        """Return what it is."""
        raise NotImplementedError


class computed(Reader[Value], cached_property[Value]):
    """A property that is computed once; of two threads that both compute it one value is kept."""

    def read(self, thing: object) -> Value:
        """Compute it, since it is not kept yet."""
        assert self.attrname is not None
        with paid(thing):
            return vars(thing).setdefault(self.attrname, _shown(self.func(thing)))


@contextmanager
def paid(thing: object) -> Iterator[None]:
    """Count what is computed meanwhile as part of what a thing cost, where it has a cost."""
    kept, start = vars(thing), time.perf_counter()
    before = kept["cost"].seconds if "cost" in kept else 0.0
    yield
    if "cost" in kept:
        # what has been read on the way counted itself, and is part of the time
        seconds = before + time.perf_counter() - start
        kept["cost"] = replace(kept["cost"], seconds=seconds)


def paid_for(method: Callable[[Any], Value]) -> Callable[[Any], Value]:
    """Count each call of a method as part of what its thing cost."""

    @wraps(method)
    def counted(thing: Any) -> Value:
        with paid(thing):
            return method(thing)

    return counted


def waited(call: Callable[Given, Value]) -> Callable[Given, Value]:
    """Let what a call returns, or its exception carries, cost what the caller has waited for it."""

    @wraps(call)
    def answered(*given: Given.args, **options: Given.kwargs) -> Value:
        start = time.perf_counter()
        try:
            answer = call(*given, **options)
        except BaseException as stop:
            for carried in vars(stop).values():
                _costs(carried, start)
            raise
        _costs(answer, start)
        return answer

    return answered


def _costs(answer: object, start: float) -> None:
    kept = getattr(answer, "__dict__", {})
    if "cost" in kept:
        kept["cost"] = replace(kept["cost"], seconds=time.perf_counter() - start)


class Lazy(Reader[Value]):
    """A field of a dataclass that is given as it is, or as what computes it when it is read.

    What the dataclass has cost, `Cost.seconds`, counts that from then on.
    """

    def __init__(self, kind: type[Any], *, optional: bool = False) -> None:
        self.kind = (kind, type(None)) if optional else (kind,)
        self.optional = optional

    def __set_name__(self, owner: type[Any], name: str) -> None:
        self.name, self.unread = name, f"_{name}"

    def __set__(self, thing: object, value: Value | Callable[[], Value]) -> None:
        given = None if self.optional and isinstance(value, Lazy) else value
        if isinstance(given, Lazy):
            raise TypeError(f"{type(thing).__name__} needs {self.name}")
        vars(thing)[self.name if isinstance(given, self.kind) else self.unread] = given

    def read(self, thing: object) -> Value:
        """Compute it, unless it is kept."""
        kept = vars(thing)
        # taken before the look at the part: a thread that has computed it takes this away after
        compute = kept.get(self.unread)
        if self.name not in kept:
            assert compute is not None
            with paid(thing):
                kept.setdefault(self.name, _shown(compute()))
                kept.pop(self.unread, None)
        return kept[self.name]


@dataclass(frozen=True, eq=False)
class Late:
    """What computes a lazy field, by any function; it is pickled as a call that has the answer."""

    compute: Callable[[], Any]

    def __call__(self) -> Any:
        """Return it."""
        return self.compute()

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how a call with that answer is made."""
        return partial, (_same, self.compute())


def _same(answer: Any) -> Any:
    return answer


def _shown(value: Value) -> Value:
    """Make an array that is kept read-only."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    return value


def lazy(kind: type[Any], axes: dict[str, Any] | None = None, *, optional: bool = False) -> Any:
    """Declare a field that holds a dataclass of this kind: ``mesh: Lazy[Mesh] = lazy(Mesh)``.

    With `axes` it holds an array, as a field of an answer with this metadata does; if it is
    `optional` it is None where nothing is given.
    """
    metadata = {"nested": kind} if axes is None else axes
    default = Lazy[Any](kind, optional=optional)
    return field(default=default, repr=axes is not None, kw_only=True, metadata=metadata)


class Read(Reader[Value]):
    """A property that is read from a part: ``limit = Read[Real]("mesh", "What it is.")``."""

    def __init__(self, where: str, text: str) -> None:
        self.where, self.__doc__ = where, text

    def __set_name__(self, owner: type[Any], name: str) -> None:
        self.name = name

    def read(self, thing: object) -> Value:
        """Return what the part has."""
        return getattr(getattr(thing, self.where), self.name)


def changed(thing: Value, **changes: Any) -> Value:
    """Return a dataclass with other fields; parts that nobody has read stay unread."""
    kept, kind = vars(thing), cast("Any", type(thing))
    given = {item.name: kept.get(item.name, kept.get(f"_{item.name}")) for item in fields(kind)}
    return kind(**given | changes)
