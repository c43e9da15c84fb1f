"""What is computed when it is read: once, by no lock, in threads, forks, copies and pickles."""

import copy
import dataclasses
import os
import pickle
import select
import threading
import time
from dataclasses import dataclass, field

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.base.answer import Answer, Frozen, axes
from ropedyn.base.computed import Lazy, Read, changed, computed, lazy, waited

TIMEOUT = 60.0
"""What takes longer hangs [s]; it takes milliseconds."""


@dataclass(frozen=True, eq=False)
class Inner(Frozen):
    """A part."""

    value: np.ndarray = field(metadata=axes("row"))


@dataclass(frozen=True, eq=False)
class Outer(Answer):
    """What has one, and what follows from it."""

    number: float
    inner: Lazy[Inner] = lazy(Inner)
    text: str = ""

    value = Read[np.ndarray]("inner", "Of the part.")

    @computed
    def twice(self):
        """Return what is kept."""
        return 2 * self.value


class Counted:
    """What computes a part, and counts how often; it can be told to wait in between."""

    def __init__(self, wait=None):
        self.times, self.began, self.wait = 0, threading.Event(), wait

    def __call__(self):
        self.times += 1
        if self.wait is not None:
            self.began.set()
            assert self.wait.wait(TIMEOUT)
        return Inner(np.array([1.0, self.times]))


def made_inner():
    return Inner(np.array([3.0]))


def test_a_part_is_computed_once_and_only_when_it_is_read():
    count = Counted()
    outer = Outer(1.0, inner=count)
    assert count.times == 0
    assert outer.value.tolist() == [1.0, 1.0]
    assert outer.inner is outer.inner
    assert outer.twice is outer.twice
    assert count.times == 1


def test_an_array_that_is_computed_cannot_be_changed():
    # nor can another who reads it see what one reader has made of it
    outer = Outer(1.0, inner=Counted())
    with pytest.raises(ValueError, match="read-only"):
        outer.twice[0] = 7.0


def test_a_part_that_is_given_is_not_computed():
    inner = made_inner()
    assert Outer(1.0, inner=inner).inner is inner


def test_a_part_must_be_given_and_cannot_be_changed():
    with pytest.raises(TypeError, match="Outer needs inner"):
        Outer(1.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        Outer(1.0, inner=made_inner).inner = made_inner()


def test_a_part_that_fails_is_asked_again():
    answers = [made_inner()]

    def once_not():
        if len(answers) == 1:
            answers.append(None)
            raise rd.SolveError("no answer")
        return answers[0]

    outer = Outer(1.0, inner=once_not)
    with pytest.raises(rd.SolveError, match="no answer"):
        outer.inner  # noqa: B018
    assert outer.inner is answers[0]


@pytest.mark.parametrize("read", [False, True])
@pytest.mark.parametrize("way", [copy.copy, copy.deepcopy, lambda o: pickle.loads(pickle.dumps(o))])
def test_copies_have_the_part_or_what_computes_it(way, read):
    outer = Outer(1.0, inner=made_inner)
    if read:
        assert outer.twice.tolist() == [6.0]
    other = way(outer)
    assert (other.number, other.value.tolist(), other.twice.tolist()) == (1.0, [3.0], [6.0])
    assert not other.value.flags.writeable


def test_other_fields_leave_a_part_unread():
    count = Counted()
    outer = changed(Outer(1.0, inner=count), number=2.0)
    assert (outer.number, count.times) == (2.0, 0)
    assert changed(outer, text="read").value is not None
    assert outer.value is changed(outer, number=3.0).value


@pytest.mark.parametrize("name", ["inner", "twice"])
def test_threads_that_compute_together_read_the_same_part(name):
    together = threading.Barrier(8)

    def slow():
        together.wait(TIMEOUT)  # all of them are in here before one is through
        return made_inner()

    outer = Outer(1.0, inner=slow)
    read = [None] * 8
    threads = [
        threading.Thread(target=lambda k=k: read.__setitem__(k, getattr(outer, name)))
        for k in range(8)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(TIMEOUT)
    assert all(one is read[0] for one in read)
    assert read[0] is getattr(outer, name)


def read_in_a_fork(answer, name):
    """Return what a forked child reads, None if it hangs."""
    out, into = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(into, pickle.dumps(np.asarray(getattr(answer, name)).tolist()))
        finally:
            os._exit(0)
    os.close(into)
    try:
        if not select.select([out], [], [], TIMEOUT)[0]:
            os.kill(child, 9)
            return None
        return pickle.loads(os.read(out, 1 << 16))
    finally:
        os.close(out)
        os.waitpid(child, 0)


# Python 3.12 warns of what is tested here
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
@pytest.mark.parametrize("name", ["value", "twice"])
def test_a_fork_reads_what_a_thread_computes_at_that_moment(name):
    go_on = threading.Event()
    count = Counted(go_on)
    outer = Outer(1.0, inner=count)
    thread = threading.Thread(target=lambda: getattr(outer, name))
    thread.start()
    assert count.began.wait(TIMEOUT)
    # the child, which has no such thread, computes by itself
    count.wait = Alone(os.getpid(), go_on)
    second = [1.0, 2.0]  # the count goes on in the child
    assert read_in_a_fork(outer, name) == [x * (1 + (name == "twice")) for x in second]
    go_on.set()
    thread.join(TIMEOUT)
    assert outer.value.tolist() == [1.0, 1.0]


class Alone:
    """An event that holds in one process only."""

    def __init__(self, process, event):
        self.process, self.event = process, event

    def wait(self, timeout):
        return os.getpid() != self.process or self.event.wait(timeout)


@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_a_fork_reads_modes_whose_shapes_a_thread_computes():
    modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=8).modes(2)
    began, go_on = threading.Event(), threading.Event()
    compute = vars(modes)["_mesh"]

    def slow():
        began.set()
        assert Alone(parent, go_on).wait(TIMEOUT)
        return compute()

    parent = os.getpid()
    slowed = changed(modes, mesh=slow)
    thread = threading.Thread(target=lambda: slowed.mesh)
    thread.start()
    assert began.wait(TIMEOUT)
    assert read_in_a_fork(slowed, "mesh_error") == modes.mesh_error.tolist()
    go_on.set()
    thread.join(TIMEOUT)
    assert slowed.mesh_error.tolist() == modes.mesh_error.tolist()


# what it costs


@dataclass(frozen=True, eq=False)
class Priced(Answer):
    """What has a cost, two parts and what follows from them."""

    cost: rd.Cost
    inner: Lazy[Inner] = lazy(Inner)
    outer: Lazy[Inner] = lazy(Inner)

    @computed
    def both(self):
        """Read both parts and take 4 s."""
        tick(4.0)
        return self.outer.value + self.inner.value


NOW = [0.0]


def tick(seconds):
    NOW[0] += seconds


def test_what_is_read_on_the_way_is_paid_once(monkeypatch):
    monkeypatch.setattr("ropedyn.base.computed.time.perf_counter", lambda: NOW[0])

    def made(seconds, *parts):
        tick(seconds)
        return Inner(np.array([float(len(parts))]))

    inner = lambda: made(1.0)  # noqa: E731 - as fields are given
    answer = Priced(
        rd.Cost("by hand", 0, 0, seconds=8.0), inner=inner, outer=lambda: made(2.0, answer.inner)
    )
    assert answer.both.tolist() == [1.0]
    # 8 of the solution, 4 of its own, 2 of the outer part and 1 of the inner one that this read
    assert answer.cost.seconds == 15.0
    assert answer.both is answer.both
    assert answer.cost.seconds == 15.0


def test_what_an_exception_carries_costs_what_its_caller_waited(monkeypatch):
    monkeypatch.setattr("ropedyn.base.computed.time.perf_counter", lambda: NOW[0])

    @waited
    def end():
        tick(3.0)
        stop = KeyboardInterrupt()
        stop.history = Priced(rd.Cost("by hand", 0, 0), inner=None, outer=None)
        raise stop

    with pytest.raises(KeyboardInterrupt) as stopped:
        end()
    assert stopped.value.history.cost.seconds == 3.0


BEAM = rd.Scene(rd.Rope(2.0, 0.1, bending_stiffness=1.0), tension=1000.0)
VERBS = {
    "modes": lambda model: model.modes(8),
    "damped modes": lambda model: model.modes(3, damped=True),
    "frf": lambda model: model.frf(np.linspace(5.0, 200.0, 100), drive=("z", 0.5)),
    "static": lambda model: model.static({("z", 0.5): 1.0}),
    "transient": lambda model: model.transient(
        [0.0, 0.01], start={("z", 1.0): 1.0}, response=("z", 1.0)
    ),
}
WAITED = 1e-3  # A busy machine takes less in the best of five calls, where all is counted [s].


@pytest.mark.parametrize("elements", [None, 16])
@pytest.mark.parametrize("verb", VERBS)
def test_cost_adds_up_to_what_a_caller_waits(verb, elements):
    model = BEAM.compile(elements=elements)
    VERBS[verb](model)
    left = []
    for _ in range(5):
        start = time.perf_counter()
        answer = VERBS[verb](model)
        answer.table()
        for name in ("shape", "mesh_error", "rounding_error", "sensitivity", "energy"):
            getattr(answer, name, None)
        left.append(time.perf_counter() - start - answer.cost.seconds)
    assert 0 < min(left) < WAITED
