"""Questions kept apart from models: the same answers, bit for bit, wherever they are asked."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

import ropedyn as rd

ROPE = rd.Rope(1.2, 0.1, bending_stiffness=1.5, torsional_stiffness=0.4, polar_inertia=1e-6)
SCENE = rd.Scene(
    ROPE, tension=200.0, damping=rd.StiffnessDamping(1e-4), parts=[rd.PointMass(0.4, 0.02)]
)
GRID = np.linspace(5.0, 150.0, 40)
POINTS = {"drive": ("z", 0.3), "response": [("z", 0.5), ("beta", 0.7), ("M_beta", 0.4)]}
TIMES = np.linspace(0.0, 0.05, 41)
PUSHED = {
    "drive": [("z", 0.3), ("alpha", 0.3)],
    "force": [(rd.Sine(1.0, 40.0), np.sin(TIMES)), rd.Step(0.01)],
    "response": [("z", 0.5), ("alpha", 0.9)],
}

MODELS = {
    "continuous": SCENE.compile(),
    "tensed": SCENE.compile(elements=12),
    "rigid": SCENE.compile(elements=12, element="rigid"),
}
PAIRS = {
    "number": (rd.ask.modes(4), lambda model, **how: model.modes(4, **how)),
    "below": (rd.ask.modes(below=150.0), lambda model, **how: model.modes(below=150.0, **how)),
    "frf": (
        rd.ask.frf(GRID, drive=("z", 0.3)),
        lambda m, **how: m.frf(GRID, drive=("z", 0.3), **how),
    ),
    "points": (
        rd.ask.frf(GRID, quantity="mobility", **POINTS),
        lambda model, **how: model.frf(GRID, quantity="mobility", **POINTS, **how),
    ),
    "motion": (
        rd.ask.motion(TIMES, **PUSHED, quantity="velocity"),
        lambda m, **how: m.transient(TIMES, **PUSHED, quantity="velocity", **how),
    ),
    "free motion": (
        rd.ask.motion(TIMES, start={("z", 0.3): 1.0}, response=("z", 0.7)),
        lambda m, **how: m.transient(TIMES, start={("z", 0.3): 1.0}, response=("z", 0.7), **how),
    ),
    "drives": (
        rd.ask.frf([20.0], drive=[("z", 0.3), ("alpha", 0.3)]),
        lambda model, **how: model.frf([20.0], drive=[("z", 0.3), ("alpha", 0.3)], **how),
    ),
}
PEAKS = rd.Peaks([25.1, 49.9, 75.0], std=0.1)
STRING = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
PULSES = SCENE.replace(tension=rd.Tension(200.0, amplitude=20.0, frequency=36.0), damping=None)
OTHERS = {
    "damped": (rd.ask.modes(3, damped=True), lambda m: m.modes(3, damped=True), SCENE),
    "count": (rd.ask.count(below=90.0), lambda m: m.count(below=90.0), SCENE),
    "static": (rd.ask.static({("z", 0.4): 2.0}), lambda m: m.static({("z", 0.4): 2.0}), SCENE),
    "stepped sine": (
        rd.ask.stepped_sine([10.0, 12.0], drive=("z", 0.3), amplitude=2.0, quantity="mobility"),
        lambda m: m.stepped_sine(
            [10.0, 12.0], drive=("z", 0.3), amplitude=2.0, quantity="mobility"
        ),
        SCENE,
    ),
    "floquet": (rd.ask.floquet(2), lambda m: m.floquet(2), PULSES),
    "identify": (
        rd.ask.identify(PEAKS, "tension", ends="given"),
        lambda m: rd.identify(m.scene, PEAKS, "tension", ends="given", **cut(m)),
        STRING,
    ),
    "family": (
        rd.ask.family(["tension"], [[150.0], [250.0]], 3),
        lambda m: m.scene.family(["tension"], **cut(m)).modes([[150.0], [250.0]], 3),
        SCENE,
    ),
}


def cut(model):
    chain = {"elements": len(model.x) - 1, "element": model.element}
    return {} if len(model.x) == 2 + len(model.scene.parts) else chain


def bits(answer):
    value = answer.frequency if isinstance(answer, rd.Modes) else answer.value
    error = answer.error if isinstance(answer, rd.History) else answer.rounding_error
    return value.shape, value.tobytes(), error.tobytes()


NUMBERS = {
    int: lambda answer: answer,
    rd.DampedModes: lambda answer: answer.eigenvalue.tobytes(),
    rd.Deflection: lambda answer: answer.displacement.tobytes(),
    rd.Floquet: lambda answer: answer.multiplier.tobytes(),
    rd.Fit: lambda answer: answer.value.tobytes(),
    rd.FRF: lambda answer: answer.value.tobytes(),
    rd.FamilyModes: lambda answer: answer.frequency.tobytes(),
}


CUTS = [{}, *({"elements": 12, "element": kind} for kind in ("tensed", "rigid", "continuous"))]


@pytest.mark.filterwarnings("ignore::ropedyn.IdentifyWarning")
@pytest.mark.parametrize("how", CUTS)
@pytest.mark.parametrize("name", OTHERS)
def test_every_kind_of_question_has_the_answer_of_the_model(name, how):
    question, call, scene = OTHERS[name]
    model = scene.compile(**how)
    found, asked = question.of(pickle.loads(pickle.dumps(model))), call(model)
    assert NUMBERS[type(found)](found) == NUMBERS[type(asked)](asked)
    # and it is compared: an answer with itself is not apart, errors have the shape of the values
    values = question.values(found)
    assert (question.apart(values, values) == 0).all()
    assert question.mesh(found).shape == question.rounding(found).shape == values.shape
    assert question.like(found) is question


@pytest.mark.parametrize("name", OTHERS)
def test_what_an_effect_changes_is_told_of_every_kind_of_question(name):
    question, _, scene = OTHERS[name]
    whole = scene.compile()
    answer = question.of(whole)
    same = question.change(answer, whole)
    assert (same.beyond_error, same.lost) == (False, 0)
    heavier = scene.replace(rope=scene.rope.replace(linear_density=0.2)).compile()
    change = question.change(answer, heavier)
    assert tuple(change.size) == question.measures
    found, apart = question.values(question.of(heavier)), question.values(answer)
    if name not in ("static", "stepped sine"):
        largest = np.abs(question.apart(found, apart)).max()
        assert change.size[question.measures[0]] == pytest.approx(100 * largest, rel=1e-12)
    if name != "static":  # mass is nothing to it
        assert all(size > 0 for size in change.size.values() if size == size)


@pytest.mark.parametrize("name", ["damped", "count", "static", "family"])
def test_effects_are_priced_for_every_kind_of_question(name):
    question, _, _ = OTHERS[name]
    price = rd.effect_cost(SCENE, question, repeat=1)
    assert tuple(price.change) == question.measures
    mass = price.effect.tolist().index("point mass")
    assert price.beyond_error[mass] == (name not in ("static", "count"))


def test_a_load_beside_the_nodes_of_a_chain_is_not_compared_unless_there_is_one():
    question = rd.ask.static({("z", 0.7): 2.0})
    exact = question.values(question.of(SCENE.compile()))
    with pytest.raises(rd.SceneError, match="load must stand on a node"):
        question.values(question.of(SCENE.compile(elements=7)))
    placed = question.placed(SCENE).compile(elements=256)
    # the deflection of a chain of tensed elements is exact: condition n^2 of the sums
    assert question.values(question.of(placed)) == pytest.approx(exact, rel=1e-11)


def test_rates_and_multipliers_are_paired_with_the_nearest():
    right = np.array([1.0 + 1.0j, 2.0, 3.0])
    for question in (rd.ask.modes(3, damped=True), rd.ask.floquet(2)):
        assert question.apart(right[[2, 0, 1]] * 1.01, right) == pytest.approx(0.01, rel=1e-12)


def test_modes_beyond_what_is_left_are_lost():
    question = rd.ask.family(["tension"], [[100.0], [200.0]], 3)
    answer = question.of(SCENE.compile())
    fewer = rd.ask.family(["tension"], [[100.0], [200.0]], 2)
    change = dataclasses.replace(question, number=2).change(answer, SCENE.compile())
    assert fewer.values(fewer.of(SCENE.compile())).shape == (2, 2)
    assert (change.lost, change.beyond_error) == (2, True)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", PAIRS)
def test_a_question_has_the_answer_of_the_model(name, model):
    question, call = PAIRS[name]
    assert bits(question.of(MODELS[model])) == bits(call(MODELS[model]))


@pytest.mark.parametrize("name", ["number", "below", "frf", "drives"])
def test_the_solver_is_passed_on(name):
    question, call = PAIRS[name]
    answer = question.of(MODELS["tensed"], solver="lapack", threads=1)
    assert answer.cost.method == "lapack"
    assert bits(answer) == bits(call(MODELS["tensed"], solver="lapack"))


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda q: pickle.loads(pickle.dumps(q))])
@pytest.mark.parametrize("name", PAIRS)
def test_a_copy_asks_the_same(name, copied):
    question, _ = PAIRS[name]
    twin = copied(question)
    assert str(twin) == str(question)
    assert bits(twin.of(MODELS["tensed"])) == bits(question.of(MODELS["tensed"]))
    for array in (v for v in vars(twin).values() if isinstance(v, np.ndarray)):
        assert not array.flags.writeable


@pytest.mark.parametrize("name", PAIRS)
def test_a_question_cannot_be_changed(name):
    question, _ = PAIRS[name]
    for field in dataclasses.fields(question):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(question, field.name, None)


def test_a_question_keeps_no_hold_of_what_it_was_given():
    grid, drive, response = np.array([10.0, 20.0]), ["z", 0.3], [["z", 0.5]]
    question = rd.ask.frf(grid, drive=drive, response=response)
    grid[0], drive[1], response[0][1] = 99.0, 99.0, 99.0
    assert question.frequency.tolist() == [10.0, 20.0]
    assert (question.drive, question.response) == (("z", 0.3), (("z", 0.5),))


def test_growing_motion_counts_as_a_frequency_below_zero():
    # beyond the first critical load of the clamped rope, 4 pi^2 B/L^2 = 41 N, not the second
    modes = SCENE.replace(tension=-60.0).compile().modes(2)
    value = rd.ask.modes(2).values(modes)
    assert value[0] == -modes.growth[0] / (2 * np.pi) < 0
    assert value[1] == modes.frequency[1] > 0


def test_rigid_motion_has_no_relative_rounding_error():
    modes = SCENE.replace(ends=("free", "free"), tension=0.0).compile().modes(4)
    rounding = rd.ask.modes(4).rounding(modes)
    assert (rounding[modes.frequency == 0] == 0).all()
    moving = modes.frequency > 0
    relative = modes.rounding_bound[moving] / modes.frequency[moving]
    assert rounding[moving].tolist() == relative.tolist()


def test_the_same_question_for_an_answer_asks_for_as_many_modes():
    question = rd.ask.modes(below=150.0)
    modes = question.of(MODELS["continuous"])
    assert question.like(modes) == rd.ask.modes(len(modes.frequency))
    for other in (rd.ask.modes(3), rd.ask.frf([1.0], drive=("z", 0.3))):
        assert other.like(other.of(MODELS["continuous"])) is other


@pytest.mark.parametrize(
    ("question", "text"),
    [
        (rd.ask.modes(10), "10 modes"),
        (rd.ask.modes(below=400), "modes below 400 Hz"),
        (rd.ask.frf(5.0, drive=("z", 0.5)), "receptance of 5 Hz, driven in z at 0.500 m"),
        (
            rd.ask.frf([9.0, 1.0], drive=[("z", 0.5), ("alpha", 1)], quantity="mobility"),
            "mobility of 2 lines, 1 to 9 Hz, driven in z at 0.500 m and alpha at 1.000 m",
        ),
        (rd.ask.modes(3, damped=True), "3 damped modes"),
    ],
)
def test_a_question_says_what_is_asked(question, text):
    assert str(question) == text


@pytest.mark.parametrize("question", [PAIRS["frf"][0], PAIRS["points"][0]])
def test_points_that_a_rope_does_not_have_are_refused_when_it_is_asked(question):
    short = SCENE.replace(rope=ROPE.replace(length=0.2), parts=()).compile()
    with pytest.raises(rd.SceneError, match=r"drive\[1\] must lie on the rope"):
        question.of(short)


def test_samples_of_a_force_are_kept_as_they_were():
    force = np.sin(TIMES)
    question = rd.ask.motion(TIMES, drive=("z", 0.3), force=force)
    before = bits(question.of(MODELS["tensed"]))
    force[:] = 0.0
    assert bits(question.of(MODELS["tensed"])) == before


def test_a_question_of_motion_is_asked_by_the_method_that_is_named():
    scene = SCENE.replace(damping=rd.RayleighDamping(1.0, 1e-5))
    question = rd.ask.motion(TIMES, drive=("z", 0.3), force=rd.Sine(1.0, 40.0))
    model = scene.compile(elements=12, element="rigid")
    for method in ("modal", "line"):
        assert question.of(model, solver=method).cost.method == method


AT = ("z", 0.3)
REFUSED = {
    "number": (rd.ask.modes, [1.5, "3"], [0, -1]),
    "damped": (lambda v: rd.ask.modes(1, damped=v), [1, "yes", None], []),
    "below": (rd.ask.count, ["1", None], [0.0, -1.0, float("nan")]),
    "modes": (rd.ask.floquet, [1.5, None], [0, 10**6]),
    "load": (rd.ask.static, [None, 1.0, [AT]], [{}, {AT: float("inf")}]),
    "amplitude": (
        lambda v: rd.ask.stepped_sine([1.0], drive=AT, amplitude=v),
        ["1", None],
        [0.0, -1.0],
    ),
    "unknown": (lambda v: rd.ask.identify([1.0], v), [None, 5], []),
    "ends": (lambda v: rd.ask.identify([1.0], "tension", ends=v), [5], ["free"]),
    "paths": (lambda v: rd.ask.family(v, [[1.0]], 1), [None, "tension"], []),
    "rows": (lambda v: rd.ask.family(["tension"], v, 1), [None, "1"], [[1.0], [], [[1.0, 2.0]]]),
}
CASES = [
    (name, call, value, kind)
    for name, (call, types, values) in REFUSED.items()
    for kind, given in ((TypeError, types), (rd.SceneError, values))
    for value in given
]


@pytest.mark.parametrize(("name", "call", "value", "kind"), CASES)
def test_what_has_no_meaning_is_refused_when_a_question_is_made(name, call, value, kind):
    with pytest.raises(kind, match=name):
        call(value)
