"""The sweep gives the same bits whatever stands beside a frequency and whoever computes it."""

import threading

import numpy as np
import pytest

import ropedyn as rd

LAID = rd.Rope(
    1.35,
    0.1017,
    bending_stiffness=1.54,
    torsional_stiffness=0.15,
    lay_slope=0.01,
    polar_inertia=1.4e-7,
)
DAMPING = rd.StiffnessDamping(1e-4)
PARTS = [rd.PointMass(0.41, 0.02), rd.Spring(0.83, 500.0)]
SCENES = {
    "string": rd.Scene(rd.Rope(1.35, 0.1017), tension=2830.0),
    "beam": rd.Scene(rd.Rope(1.35, 0.1017, bending_stiffness=1.54), tension=2830.0, parts=PARTS),
    "damped": rd.Scene(
        rd.Rope(1.35, 0.1017, bending_stiffness=1.54),
        tension=2830.0,
        damping=DAMPING,
        ends=("clamped", "free"),
    ),
    "laid": rd.Scene(LAID, tension=2830.0, damping=DAMPING, parts=PARTS),
}
FREQUENCY = np.concatenate([[0.0, 0.01], np.geomspace(0.1, 5000.0, 101)])
"""Not a multiple of any number of lanes; pieces of runs of many different lengths."""


def ask(model, frequency=FREQUENCY, **more):
    return model.frf(
        frequency,
        drive=[("z", 0.5), ("z", 0.9)],
        response=[("z", 0.41), ("z", 1.2), ("F_z", 0.0)],
        solver="sweep",
        **more,
    )


def same(one, other):
    """Equal to the last bit, signs of zeros included."""
    return all(
        a.tobytes() == b.tobytes()
        for a, b in (
            (one.value, other.value),
            (one.rounding_bound, other.rounding_bound),
        )
    )


@pytest.fixture(params=SCENES)
def model(request):
    return SCENES[request.param].compile(elements=300, element="tensed")


@pytest.mark.parametrize("threads", [2, 3, 8])
def test_response_does_not_depend_on_the_number_of_threads(model, threads):
    assert same(ask(model, threads=1), ask(model, threads=threads))


def test_response_of_many_slices_does_not_depend_on_the_number_of_threads():
    # 4001 nodes x 603 frequencies are more than two slices of 2^20
    long = SCENES["damped"].compile(elements=4000, element="tensed")
    frequency = np.geomspace(0.1, 5000.0, 603)
    one = ask(long, frequency, threads=1)
    assert same(one, ask(long, frequency, threads=2))
    assert same(one, ask(long, frequency, threads=8))


def test_environment_variable_changes_no_bit(model, monkeypatch):
    one = ask(model, threads=1)
    monkeypatch.setenv("ROPEDYN_THREADS", "3")
    assert same(one, ask(model))


def test_order_of_frequencies_changes_no_bit(model):
    one = ask(model, threads=1)
    order = np.random.default_rng(7).permutation(len(FREQUENCY))
    other = ask(model, FREQUENCY[order], threads=1)
    assert other.value.tobytes() == one.value[:, :, order].tobytes()
    assert other.rounding_bound.tobytes() == one.rounding_bound[:, :, order].tobytes()


@pytest.mark.parametrize("part", [slice(0, 1), slice(5, 6), slice(3, 20), slice(40, 73, 3)])
def test_frequency_alone_or_among_others_has_the_same_bits(model, part):
    one, other = ask(model, threads=1), ask(model, FREQUENCY[part], threads=1)
    assert other.value.tobytes() == one.value[:, :, part].tobytes()
    assert other.rounding_bound.tobytes() == one.rounding_bound[:, :, part].tobytes()


def test_repeated_frequencies_have_the_same_bits(model):
    value = ask(model, np.full(37, 111.0), threads=2).value
    assert (value == value[:, :, :1]).all()


def test_repeated_runs_have_the_same_bits(model):
    one = ask(model)
    for _ in range(5):
        assert same(one, ask(model))


def test_compiling_again_has_the_same_bits(model):
    assert same(ask(model), ask(model.scene.compile(elements=300, element="tensed")))


def test_repeated_modes_have_the_same_bits(model):
    one, other = model.modes(6), model.modes(6)
    for name in ("frequency", "rounding_error", "shape", "modal_mass"):
        assert getattr(one, name).tobytes() == getattr(other, name).tobytes()


def in_threads(number, call):
    """Call at once in so many threads; return what each returned."""
    answers, start = [None] * number, threading.Barrier(number)

    def work(k):
        start.wait()
        answers[k] = call(k)

    workers = [threading.Thread(target=work, args=(k,)) for k in range(number)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    return answers


def test_eight_threads_on_one_model_have_the_bits_of_one(model):
    one, modes, deflection = ask(model, threads=1), model.modes(4), model.static({("z", 0.5): 1.0})

    def work(k):
        # different calls beside each other
        for turn in range(3):
            if not same(one, ask(model, threads=1 + (k + turn) % 3)):
                return "frf"
            if model.modes(4).frequency.tobytes() != modes.frequency.tobytes():
                return "modes"
            again = model.static({("z", 0.5): 1.0})
            if again.displacement.tobytes() != deflection.displacement.tobytes():
                return "static"
        return "the same"

    assert in_threads(8, work) == 8 * ["the same"]


@pytest.mark.parametrize("name", SCENES)
def test_a_frequency_of_continuous_spans_alone_gives_its_bits_in_a_grid(name):
    # short pieces of a series for 0 Hz have no digits at 0.6 Hz
    model = SCENES[name].compile()
    frequency, points = FREQUENCY[:60:3], [("z", 0.5), ("z", 1.2)]
    grid = model.frf(frequency, drive=points)
    for k, f in enumerate(frequency):
        alone = model.frf(f, drive=points)
        assert alone.value.tobytes() == np.ascontiguousarray(grid.value[..., k : k + 1]).tobytes()
