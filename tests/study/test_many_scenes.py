"""Sweeps over many scenes: the same results in the same order on every executor, none lost."""

import pickle
import threading
from concurrent.futures import BrokenExecutor, Executor, Future, ProcessPoolExecutor
from concurrent.futures import ThreadPoolExecutor as Threads
from contextlib import contextmanager
from multiprocessing import get_context

import numpy as np
import pytest
from scene_tasks import ROPE, frequencies, interrupted, itself, reciprocal, strange

import ropedyn as rd
from ropedyn.study import outcome

SCENES = [rd.Scene(ROPE, tension=tension) for tension in np.linspace(50.0, 500.0, 24)]


def processes(workers=1):
    return ProcessPoolExecutor(workers, mp_context=get_context("spawn"))


@pytest.fixture(scope="module")
def pool():
    with processes(2) as executor:
        yield executor


@contextmanager
def dask(**how):
    from distributed import Client, LocalCluster

    options = {"n_workers": 1, "dashboard_address": "127.0.0.1:0", **how}
    with LocalCluster(**options) as cluster, Client(cluster) as client:
        yield client.get_executor()


@pytest.fixture(scope="module")
def dask_executor():
    with dask(threads_per_worker=2, processes=False) as executor:
        yield executor


class AtOnce(Executor):
    """Runs what is submitted where it is submitted."""

    submitted = 0

    def submit(self, function, /, *arguments):
        self.submitted += 1
        future = Future()
        future.set_result(function(*arguments))
        return future


class Never(Executor):
    """Begins the first and nothing else."""

    def __init__(self):
        self.futures = []

    def submit(self, function, /, *arguments):
        self.futures.append(Future())
        if len(self.futures) == 1:
            self.futures[0].set_result(function(*arguments))
        return self.futures[-1]


# --- every executor -------------------------------------------------------------------------------


def hold(executor):
    """Hold results and failures of an executor against calls one after the other."""
    found = rd.sweep(frequencies, SCENES, executor=executor)
    assert [row.tolist() for row in found] == [frequencies(scene).tolist() for scene in SCENES]
    assert found.failed == {}
    assert found.seconds.min() > 0
    found = rd.sweep(reciprocal, range(6), executor=executor)
    assert list(found) == [None, 1.0, 0.5, None, 0.25, 0.2]
    assert list(found.failed) == [0, 3]
    assert isinstance(found.failed[0], ZeroDivisionError)
    assert "number 3 has bad luck" in str(found.failed[3])


def test_scenes_one_after_the_other_keep_their_order_and_their_failures():
    hold(None)


def test_threads_keep_order_and_failures():
    with Threads(2) as executor:
        hold(executor)


def test_processes_keep_order_and_failures(pool):
    hold(pool)


def test_dask_keeps_order_and_failures(dask_executor):
    hold(dask_executor)


def test_dask_processes_keep_order_and_failures():
    with dask(threads_per_worker=1) as executor:
        hold(executor)


def test_a_failure_in_another_process_says_where_it_was(pool):
    failed = rd.sweep(reciprocal, [0], executor=pool).failed
    assert "return 1 / number" in failed[0].__notes__[0]


def test_a_function_may_return_none():
    found = rd.sweep(itself, [None, 1])
    assert (list(found), found.failed) == ([None, 1], {})


def test_equal_scenes_are_each_asked(dask_executor):
    found = rd.sweep(lambda scene: object(), 200 * [None], executor=dask_executor)
    assert len(set(found)) == 200


def test_answers_models_and_scenes_travel(pool):
    model = SCENES[0].compile(elements=8)
    damped = SCENES[0].replace(damping=rd.StiffnessDamping(1e-4)).compile()
    time = np.linspace(0.0, 0.1, 20)
    frf = damped.frf(np.linspace(1.0, 100.0, 200), drive=("z", 0.5))
    answers = [
        SCENES[0],
        model,
        model.modes(2),
        model.modes(2).damage(),
        damped.modes(2, damped=True),
        frf,
        frf.peaks()[0],
        model.static({("z", 0.5): 1.0}),
        damped.transient(time, drive=("z", 0.5), force=rd.Sine(1.0, 20.0)),
        rd.Peaks([20.0]),
        rd.compare(model, rd.Peaks([20.0])),
        rd.accuracy_cost(SCENES[0], rd.ask.modes(1), elements=8, repeat=1),
        rd.effect_cost(SCENES[0], rd.ask.modes(1), repeat=1),
        rd.identify(SCENES[0], rd.Peaks([20.0], std=0.1, order=[1]), "tension"),
        rd.plan_measurement(SCENES[0], modes=1),
        rd.TorsionTest(0.5, [0.0, 1.0], [0.0, 1.0]),
        rd.sweep(itself, range(3)),
    ]
    found = rd.sweep(itself, answers, executor=pool)
    assert found.failed == {}
    assert [type(one) for one in found] == [type(one) for one in answers]
    assert found[2].shape.tolist() == answers[2].shape.tolist()
    assert found[2].derivative("tension").tolist() == answers[2].derivative("tension").tolist()
    assert found[5].value.tolist() == answers[5].value.tolist()


# --- chunks ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [0, 1, 128, 129, 10_000])
def test_many_small_calls_are_sent_in_few_chunks(count, monkeypatch):
    monkeypatch.setattr("ropedyn.study.outcome.SLICE", float("inf"))  # however busy the machine is
    executor = AtOnce()
    assert list(rd.sweep(itself, range(count), executor=executor)) == list(range(count))
    assert min(count, 65) <= executor.submitted <= 128


def test_long_chunks_hand_back_what_they_have_not_begun(monkeypatch):
    monkeypatch.setattr(outcome, "SLICE", 0.0)
    executor = AtOnce()
    assert list(rd.sweep(itself, range(1000), executor=executor)) == list(range(1000))
    assert executor.submitted == 1000


def test_a_result_that_cannot_be_sent_fails_alone(pool):
    numbers = [k % 7 for k in range(300)]  # two in a chunk
    found = rd.sweep(strange, numbers, executor=pool)
    assert list(found) == [None if number == 5 else number for number in numbers]
    assert list(found.failed) == list(range(5, 300, 7))
    assert "<lambda>" in str(found.failed[5])


def test_a_scene_that_cannot_be_sent_fails_alone(pool):
    scenes = [*range(150), lambda: None, *range(150)]
    found = rd.sweep(itself, scenes, executor=pool)
    assert list(found) == [*range(150), None, *range(150)]
    assert list(found.failed) == [150]
    assert "lambda" in str(found.failed[150])


# --- what ends it ---------------------------------------------------------------------------------


def test_a_worker_that_dies_leaves_what_is_finished():
    with processes() as executor:
        found = rd.sweep(strange, [0, 1, 7, 3], executor=executor)
        again = rd.sweep(strange, [0], executor=executor)
    assert found[:2] == (0, 1)
    assert 2 in found.failed
    assert all(isinstance(error, BrokenExecutor) for error in found.failed.values())
    assert isinstance(again.failed[0], BrokenExecutor)


def test_an_executor_that_is_shut_down_fails_every_scene():
    executor = Threads(1)
    executor.shutdown()
    found = rd.sweep(itself, range(300), executor=executor)
    assert len(found.failed) == 300
    assert "cannot schedule new futures after shutdown" in str(found.failed[299])


def test_an_interrupt_cancels_what_is_pending_and_keeps_what_is_finished():
    def interrupt(fraction):
        raise KeyboardInterrupt

    executor = Never()
    with pytest.raises(KeyboardInterrupt) as stopped:
        rd.sweep(itself, [4, 5, 6], executor=executor, progress=interrupt)
    assert list(stopped.value.sweep) == [4, None, None]
    assert [future.cancelled() for future in executor.futures] == [False, True, True]


@pytest.mark.parametrize("executor", [None, Threads], ids=["here", "threads"])
def test_an_interrupt_of_a_scene_ends_the_sweep(executor):
    with (executor or threading.Lock)() as given, pytest.raises(KeyboardInterrupt) as stopped:
        rd.sweep(interrupted, [0, 1, 2], executor=executor and given)
    assert list(stopped.value.sweep)[2] is None


def test_progress_takes_growing_fractions_up_to_one():
    told = []
    with Threads(2) as executor:
        rd.sweep(itself, range(1000), executor=executor, progress=told.append)
    assert told == [(k + 1) / 1000 for k in range(1000)]


# --- the answer -----------------------------------------------------------------------------------


def test_a_sweep_is_a_sequence():
    found = rd.sweep(itself, (k * k for k in range(4)))
    assert (len(found), found[3], found[-1], found[1:3], 4 in found) == (4, 9, 9, (1, 4), True)
    assert list(rd.sweep(itself, [])) == []
    assert repr(found) == "<Sweep of 4 scenes, 0 failed>"


def test_the_cost_of_a_sweep_is_the_sum_over_its_results():
    found = rd.sweep(lambda scene: scene.compile(elements=8).modes(2), SCENES[:3])
    each = [one.cost for one in found]
    assert found.cost.elements == 24
    assert found.cost.sweeps == sum(one.sweeps for one in each)
    assert found.cost.method == "one after the other"
    assert found.cost.seconds >= found.seconds.sum() >= sum(one.seconds for one in each)


def test_the_table_shows_numbers_rows_and_mappings():
    results = [2.5, np.array([1.0, 2.0]), {"tension": np.float64(3.0)}, rd.Peaks([1.0]), [1, "a"]]
    table = rd.sweep(itself, results).table()
    names = ("result", "result[0]", "result[1]", "tension")
    assert table.columns == ("scene", "time [s]", *names)
    none = None
    assert [row[2:] for row in table.rows] == [
        (2.5, none, none, none),
        (none, 1.0, 2.0, none),
        (none, none, none, 3.0),
        ("Peaks", none, none, none),
        ("list", none, none, none),
    ]


def test_the_table_shows_what_was_identified():
    def identified(f):
        return rd.identify(SCENES[0], rd.Peaks([f], std=0.1, order=[1]), "tension")

    fits = rd.sweep(identified, [20, 30])
    assert fits.table().column("tension") == tuple(fit.value["tension"] for fit in fits)


def test_the_table_shows_why_scenes_failed():
    found = rd.sweep(reciprocal, [0, 2])
    assert found.table().column("failed") == ("division by zero", None)
    assert found.to_dataframe()["scene"].tolist() == [0, 1]


def test_results_are_the_users_own():
    array = np.zeros(3)
    found = rd.sweep(itself, [array])
    assert found[0] is array
    assert array.flags.writeable
    assert not found.seconds.flags.writeable
    assert pickle.loads(pickle.dumps(found)).seconds.tolist() == found.seconds.tolist()


# --- bad input ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "more", "words"),
    [
        ((3, []), {}, "function must be callable, got 3"),
        ((itself, SCENES[0]), {}, "scenes must be an iterable of scenes, got Scene"),
        ((itself, []), {"executor": 2}, "executor must be an executor such as"),
        ((itself, []), {"progress": "yes"}, "progress must be None, True or callable"),
    ],
)
def test_what_is_no_function_scene_or_executor_is_refused(arguments, more, words):
    with pytest.raises(TypeError, match=words):
        rd.sweep(*arguments, **more)


def test_a_function_that_cannot_be_sent_is_refused_before_anything_runs(pool, dask_executor):
    with pytest.raises(TypeError, match="function must be one that can be pickled"):
        rd.sweep(lambda scene: scene, SCENES, executor=pool)
    assert list(rd.sweep(lambda number: -number, [1, 2], executor=dask_executor)) == [-1, -2]
    lock = threading.Lock()
    with pytest.raises(TypeError, match="function must be one that can be pickled"):
        rd.sweep(lambda scene: lock, SCENES, executor=dask_executor)


def test_a_notebook_shows_a_sweep_as_its_table():
    sweep = rd.sweep(abs, [-1, 2])
    assert "<table>" in sweep._repr_html_() == sweep.table()._repr_html_()
