"""Families of ropes: closed forms against the general path, rows that do not know each other."""

import itertools
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from conftest import long
from exact_span_count import exact_span_count
from general_path import general_path

import ropedyn as rd
from ropedyn import _core

EPS = np.finfo(float).eps
INF = float("inf")
SPRINGS = [f"ends[{end}].spring.{c}" for end in (0, 1) for c in ("z", "beta")]
PATHS = ["length", "linear_density", "tension", "bending_stiffness", *SPRINGS]
BEAM = rd.Scene(rd.Rope(1.0, 1.0, bending_stiffness=1.0), tension=1.0)


def random_spans(rng, count, spread=4):
    """Spans that bend, on springs of both signs, in tension and beyond buckling."""
    length, density, bending = (10 ** rng.uniform(-1, 1, count) for _ in range(3))
    p = np.where(
        rng.random(count) < 0.6,
        10 ** rng.uniform(-3, 6, count),
        -(10 ** rng.uniform(-2, 2.5, count)),
    )
    p[rng.random(count) < 0.1] = 0.0
    columns = [length, density, p * bending / length**2, bending]
    for unit in (bending / length**3, bending / length) * 2:
        kind = rng.random(count)
        spring = (
            np.where(rng.random(count) < 0.4, -1, 1)
            * 10 ** rng.uniform(-spread, spread, count)
            * unit
        )
        columns.append(np.where(kind < 0.25, INF, np.where(kind < 0.4, 0.0, spring)))
    return np.stack(columns, axis=1)


def compare_with_general_path(seed, count, number=4, below=None):
    """Each certified row of the core's closed form is what the compiled scene gives."""
    values = random_spans(np.random.default_rng(seed), count)
    family = BEAM.family(PATHS)
    found = family.modes(values, number, derivative=True, threads=1)
    closed = int(found.cost.method.split()[0])
    limit = float(np.nanmedian(found.frequency))
    counted = family.count(values, below=limit, threads=1)
    assert not found.failed
    assert found.certified.all()
    for k, row in enumerate(values):
        model = family.scene_of(row).compile()
        with general_path():
            modes, count = model.modes(number), model.count(below=limit)
        allowed = 4 * (modes.rounding_error + found.rounding_error[k])
        assert (np.abs(modes.frequency - found.frequency[k]) <= allowed).all(), row
        assert counted[k] == count, row
        # the model of one rope answers as the family does
        assert model.count(below=limit) == count, row
        np.testing.assert_array_equal(model.modes(number).frequency, found.frequency[k])
    return closed


def test_random_spans_are_those_of_the_general_path():
    assert compare_with_general_path(seed=20151, count=60) > 15


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
def test_many_random_spans_are_those_of_the_general_path(seed):
    fresh = int(os.environ.get("ROPEDYN_SEED", "0")) + seed
    assert compare_with_general_path(seed=fresh, count=1000) > 300


def check_index_and_error(seed, count, spread):
    """Certified modes lie within their errors, at their index, and counts are right: 70 digits."""
    rng = np.random.default_rng(seed)
    values = random_spans(rng, count, spread)
    number = 4
    omega, error, _, certified = closed_modes(values, number)
    scale = np.sqrt(values[:, 3] / values[:, 1]) / values[:, 0] ** 2
    limits = scale * 10 ** rng.uniform(-2, 3, count)
    for k, span in enumerate(values):
        for n in range(number if certified[k] else 0):
            off = 1.5 * error[k, n]
            assert exact_span_count(omega[k, n] * (1 - off), span) <= n, span
            assert exact_span_count(omega[k, n] * (1 + off), span) > n, span
        counted = _core.closed_count("bent", span[None], float(limits[k]))[0]
        assert counted in (-1, exact_span_count(float(limits[k]), span)), span
    return int(certified.sum())


def closed_modes(values, number):
    return _core.closed_modes("bent", values, None, number)


def test_index_and_error_of_random_spans_are_right():
    assert check_index_and_error(seed=7, count=150, spread=4) > 40


@pytest.mark.slow
@pytest.mark.parametrize("spread", [3, 6, 12, 25])
def test_index_and_error_of_many_random_spans_are_right(spread):
    fresh = int(os.environ.get("ROPEDYN_SEED", "0")) + spread
    assert check_index_and_error(seed=fresh, count=5000, spread=spread) > 1000


def test_derivatives_are_those_of_the_general_path():
    values = random_spans(np.random.default_rng(4), 40)
    family = BEAM.family(PATHS)
    found = family.modes(values, 3, derivative=True)
    seen = 0
    for k in np.flatnonzero((found.eigenvalue > 0).all(axis=1)):
        modes = family.scene_of(values[k]).compile().modes(3)
        for column, path in enumerate(PATHS):
            x = values[k, column]
            if not np.isfinite(x) or x == 0:
                continue
            ours, theirs = found.derivative[k, :, column], modes.derivative(path)
            # both in parts of the frequency; 1e-10 is what the general path has left of soft modes
            assert np.abs((ours - theirs) * x / modes.frequency).max() < 1e-9
            seen += 1
    assert seen > 100


def test_the_slope_by_a_spring_that_is_not_there_is_that_of_a_small_one():
    scene = rd.Scene(rd.Rope(1.0, 1.0, bending_stiffness=1.0), tension=5.0)
    massy = scene.replace(parts=[rd.PointMass(0.4, 1e-9)])
    values = [[0.0, INF], [1e-6, INF]]
    for each in (scene, massy):
        family = each.family(["ends[0].spring.beta", "ends[1].spring.beta"])
        found = family.modes(values, 2, derivative=True)
        rise = np.diff(found.frequency, axis=0)[0] / 1e-6
        np.testing.assert_allclose(found.derivative[0, :, 0], rise, rtol=1e-5)
        assert (found.derivative[..., 1] == 0).all()


def test_a_row_keeps_its_bits_in_any_company_and_on_any_threads():
    values = random_spans(np.random.default_rng(1), 70)
    family = BEAM.family(PATHS)
    whole = family.modes(values, 3, derivative=True, threads=1)
    order = np.random.default_rng(2).permutation(len(values))
    for found in (
        family.modes(values[order], 3, derivative=True, threads=3),
        family.modes(values[order], 3, derivative=True, executor=ThreadPoolExecutor(2)),
    ):
        for name in ("frequency", "eigenvalue", "growth", "rounding_error", "derivative"):
            np.testing.assert_array_equal(getattr(found, name), getattr(whole, name)[order])
    alone = family.modes(values[5:6], 3, derivative=True)
    np.testing.assert_array_equal(alone.derivative, whole.derivative[5:6])


@pytest.mark.parametrize("end", [0, 1])
def test_all_components_of_a_rope_take_part(end):
    rope = rd.Rope(
        2.0,
        0.3,
        bending_stiffness=4.0,
        torsional_stiffness=0.02,
        polar_inertia=1e-5,
        axial_stiffness=1e4,
    )
    sprung = rd.End(alpha="free", x="free", spring={"x": 300.0, "alpha": 0.1})
    scene = rd.Scene(rope, tension=50.0, ends=("pinned", sprung)[:: 1 if end else -1])
    paths = ["torsional_stiffness", "axial_stiffness", f"ends[{end}].spring.alpha", "polar_inertia"]
    family = scene.family(paths)
    values = np.array([[0.02, 1e4, 0.1, 1e-5], [0.4, 50.0, INF, 1e-4]])
    found = family.modes(values, 12, derivative=True)
    assert found.cost.method.startswith("2 of 2")
    for k, row in enumerate(values):
        with general_path():
            model = family.scene_of(row).compile()
            modes, count = model.modes(12), model.count(below=40.0)
        np.testing.assert_allclose(found.frequency[k], modes.frequency, rtol=1e-13)
        assert family.count(values, below=40.0)[k] == count
    modes = scene.compile().modes(12)
    for column, path in enumerate(paths):
        slope = modes.derivative(path)
        np.testing.assert_allclose(found.derivative[0, :, column], slope, rtol=1e-9, atol=1e-9)


def test_strings_are_those_of_the_general_path():
    family = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).family(
        ["tension", "ends[0].spring.z", "ends[1].spring.z"]
    )
    values = list(itertools.product([500.0, 2000.0], [INF, 0.0, 300.0, -100.0], [INF, 80.0]))
    found = family.modes(values, 3)
    for k, row in enumerate(values):
        with general_path():
            modes = family.scene_of(row).compile().modes(3)
        np.testing.assert_allclose(found.frequency[k], modes.frequency, rtol=1e-12, atol=1e-9)
        np.testing.assert_allclose(found.growth[k], modes.growth, rtol=1e-9)


def test_chains_with_supports_hinges_and_masses_are_those_of_the_general_path():
    rope = rd.Rope(2.0, 0.5, bending_stiffness=3.0, torsional_stiffness=0.4, polar_inertia=1e-3)
    both = [rd.Support(1.2), rd.Support(1.2, coordinate="beta")]
    parts = {
        "masses": [rd.PointMass(0.3, 0.2), rd.PointMass(1.1, 0.7), rd.Spring(0.8, 40.0)],
        "a support": [rd.PointMass(0.3, 0.2), rd.Support(0.9)],
        "a clamp": [rd.PointMass(0.3, 0.2), *both, rd.Spring(1.6, 20.0)],
        "a hinge": [rd.Hinge(0.1), rd.PointMass(1.5, 0.1)],
        "stretches": [rd.AddedMass(0.4, 0.9, linear_density=0.3), rd.PointMass(0.3, 0.1)],
    }
    string = rope.replace(bending_stiffness=None)
    seen = 0
    for name, own in parts.items():
        for each in (rope, string):
            if each is string and name in {"a clamp", "a hinge"}:
                continue
            scene = rd.Scene(each, tension=30.0, parts=own)
            mass = next(f"parts[{k}].mass" for k, p in enumerate(own) if hasattr(p, "mass"))
            paths = ["tension", "linear_density", mass, mass.replace("mass", "x")]
            family = scene.family(paths)
            values = [[30.0, 0.5, 0.2, 0.35], [55.0, 0.4, 0.3, 0.25]]
            found = family.modes(values, 6, derivative=True)
            assert found.cost.method.startswith("2 of 2"), name
            for k, row in enumerate(values):
                model = family.scene_of(row).compile()
                limit = float(found.frequency[k, 4] + found.frequency[k, 5]) / 2
                assert family.count([row], below=limit)[0] == 5
                with general_path():
                    modes = model.modes(6)
                    assert model.count(below=limit) == 5
                    slope = np.stack([modes.derivative(path) for path in paths], axis=1)
                allowed = 4 * (modes.rounding_error + found.rounding_error[k])
                assert (np.abs(modes.frequency - found.frequency[k]) <= allowed).all(), name
                # 1e-9 of the frequency is what shapes of the general path have left
                off = np.abs(found.derivative[k] - slope) * np.abs(row)
                assert (off <= 1e-9 * modes.frequency[:, None] + 1e-9 * np.abs(slope)).all(), name
                seen += 1
    assert seen == 16


def test_a_rope_that_buckles_grows():
    family = BEAM.replace(ends=("pinned", "pinned")).family(["tension"])
    found = family.modes([[-(np.pi**2) / 2], [-(np.pi**2) - 3.0]], 2, derivative=True)
    np.testing.assert_allclose(found.eigenvalue[:, 0], [np.pi**4 / 2, -3 * np.pi**2], rtol=1e-12)
    assert found.frequency[1, 0] == found.derivative[1, 0, 0] == found.growth[0, 0] == 0
    np.testing.assert_allclose(found.growth[1, 0], np.sqrt(3) * np.pi, rtol=1e-12)
    assert found.certified.all()
    assert family.count([[-(np.pi**2) - 3.0]], below=1e-3).tolist() == [1]


SCENES = {
    "mass": BEAM.replace(parts=[rd.PointMass(0.3, 0.2)]),
    "hinge": BEAM.replace(parts=[rd.Hinge(0.4, stiffness=2.0)]),
    "rotary inertia": BEAM.replace(rope=BEAM.rope.replace(rotary_inertia=1e-3)),
    "lay": BEAM.replace(rope=BEAM.rope.replace(torsional_stiffness=0.5, lay_slope=0.1)),
    "end mass": BEAM.replace(ends=("clamped", rd.End(z="free", beta="free", mass={"z": 0.4}))),
    "two tensions": BEAM.replace(tension=rd.Tension(5.0, amplitude=1.0, frequency=3.0)),
    "damped": BEAM.replace(damping=rd.ViscousDamping(0.1)),
}


@pytest.mark.parametrize("name", SCENES)
def test_any_scene_has_families(name):
    scene = SCENES[name]
    paths = ["tension", "length", "ends[0].spring.beta"]
    family = scene.family(paths)
    values = [[5.0, 1.0, INF], [7.0, 1.2, 3.0]]
    found = family.modes(values, 3, derivative=True)
    for k, row in enumerate(values):
        modes = family.scene_of(row).compile().modes(3)
        np.testing.assert_allclose(found.frequency[k], modes.frequency, rtol=1e-11)
        for column, path in enumerate(paths if row[2] < INF else paths[:2]):
            slope = modes.derivative(path)
            np.testing.assert_allclose(found.derivative[k, :, column], slope, rtol=1e-8, atol=1e-9)
    assert found.certified.all()
    limit = float(found.frequency[0, 1]) * 1.01
    assert family.count(values[:1], below=limit).tolist() == [2]


def test_parts_have_paths():
    scene = SCENES["mass"]
    found = scene.family(["parts[0].mass", "parts[0].x"]).modes([[0.2, 0.3], [0.5, 0.6]], 2)
    moved = scene.replace(parts=[rd.PointMass(0.6, 0.5)]).compile().modes(2)
    np.testing.assert_array_equal(found.frequency[1], moved.frequency)


def test_a_row_without_meaning_is_named_and_the_others_are_kept():
    values = np.ones((6, 8)) * [1, 1, 10, 1, INF, INF, INF, 0.0]
    values[0, 0] = -1.0
    values[2, 3] = 0.0
    values[3, 6] = -INF
    values[4, 2] = INF
    family = BEAM.family(PATHS)
    found = family.modes(values, 2, derivative=True)
    assert sorted(found.failed) == [0, 2, 3, 4]
    assert all(isinstance(error, rd.SceneError) for error in found.failed.values())
    assert "length" in str(found.failed[0]) and "ends[1].spring.z" in str(found.failed[3])
    assert np.isnan(found.frequency[[0, 2, 3, 4]]).all() and np.isnan(found.derivative[0]).all()
    assert found.certified.tolist() == [False, True, False, False, False, True]
    assert (found.frequency[1] == found.frequency[5]).all()
    assert family.count(values, below=1e3).tolist()[:2] == [-1, 24]
    text = str(found)
    assert "length must be" in text


def test_no_rows_are_no_answers():
    family = BEAM.family(["tension", "length"])
    for values in ([], np.empty((0, 2))):
        found = family.modes(values, 3, derivative=True)
        assert found.frequency.shape == (0, 3) and found.derivative.shape == (0, 3, 2)
        assert found.failed == {} and family.count(values, below=3.0).shape == (0,)
        assert family.frf(values, [1.0], drive=("z", 0.5)).value.shape == (0, 1, 1)


@pytest.mark.parametrize(
    ("paths", "error", "says"),
    [
        ("tension", TypeError, "list"),
        ([3], TypeError, "path"),
        ([], rd.SceneError, "at least one"),
        (["tensions"], rd.SceneError, "'tensions'"),
        (["tension", "tension"], rd.SceneError, "twice"),
        (["tension", "tension.mean"], rd.SceneError, "twice"),
        (["ends[0].spring.alpha"], rd.SceneError, "alpha"),
        (["ends[2].spring.z"], rd.SceneError, "ends\\[2\\]"),
        (["torsional_stiffness"], rd.SceneError, "torsional_stiffness"),
    ],
)
def test_paths_must_lead_to_numbers(paths, error, says):
    with pytest.raises(error, match=says):
        BEAM.family(paths)


@pytest.mark.parametrize(
    ("values", "error", "says"),
    [
        ([[1.0]], rd.SceneError, r"shape \(1, 1\)"),
        ([1.0, 2.0], rd.SceneError, r"shape \(2,\)"),
        ([[1.0, float("nan")]], rd.SceneError, r"values\[0, 1\] \(length\)"),
        ([[1.0, 2.0], [1.0]], rd.SceneError, "column for each path"),
        ([["1", "2"]], TypeError, "column for each path"),
        ([[True, False]], TypeError, "column for each path"),
    ],
)
def test_values_must_be_numbers_for_each_path(values, error, says):
    family = BEAM.family(["tension", "length"])
    for ask in (
        lambda: family.modes(values, 1),
        lambda: family.count(values, below=1.0),
        lambda: family.frf(values, [1.0], drive=("z", 0.5)),
    ):
        with pytest.raises(error, match=says):
            ask()


@pytest.mark.parametrize(
    ("changes", "error"),
    [
        ({"number": 0}, rd.SceneError),
        ({"number": 2.5}, TypeError),
        ({"derivative": 1}, TypeError),
        ({"threads": 0}, rd.SceneError),
        ({"executor": 3}, TypeError),
        ({"progress": 3}, TypeError),
    ],
)
def test_what_is_asked_must_have_a_meaning(changes, error):
    with pytest.raises(error):
        BEAM.family(["tension"]).modes([[1.0]], **({"number": 1} | changes))


def test_responses_are_those_of_the_general_path():
    scene = BEAM.replace(damping=rd.ViscousDamping(0.5))
    family = scene.family(["tension", "ends[0].spring.beta"])
    f = [0.5, 3.0]
    found = family.frf(
        [[4.0, 2.0], [4.0, -INF]], f, drive=("z", 0.5), response=[("z", 0.2), ("beta", 0.0)]
    )
    model = family.scene_of([4.0, 2.0]).compile()
    frf = model.frf(f, drive=("z", 0.5), response=[("z", 0.2), ("beta", 0.0)])
    np.testing.assert_array_equal(found.value[0], frf.value)
    assert list(found.failed) == [1] and np.isnan(found.value[1]).all()
    assert found.table().column("row") == (0, 1)
    both = family.frf([[4.0, 2.0]], f, drive=[("z", 0.5), ("z", 0.1)])
    assert both.value.shape == (1, 2, 2, 2)
    with pytest.raises(rd.SceneError, match="drive"):
        family.frf([[4.0, 2.0]], f, drive=("z", 7.0))


DAMPED = {
    "nothing": (),
    "drag": rd.ViscousDamping(0.3),
    "strain": (rd.StiffnessDamping(1e-4), rd.LossFactor(0.01)),
    "both": (rd.RayleighDamping(mass=0.2, stiffness=1e-5), rd.LossFactor(0.02)),
}


@pytest.mark.parametrize("damping", DAMPED.values(), ids=DAMPED)
def test_responses_of_rows_are_those_of_their_models(damping):
    rope = rd.Rope(1.0, 1.0, bending_stiffness=1.0, torsional_stiffness=0.5, polar_inertia=1e-3)
    scene = rd.Scene(rope, tension=20.0, damping=damping)
    family = scene.family(["length", "tension", "ends[0].spring.beta", "ends[1].spring.z"])
    rng = np.random.default_rng(8)
    values = np.column_stack(
        [
            rng.choice([0.4, 0.6, 1.0, 3.0], 24),
            rng.uniform(-2.0, 60.0, 24),
            rng.choice([0.0, 3.0, INF], 24),
            rng.choice([0.0, 50.0, INF], 24),
        ]
    )
    f = np.linspace(0.0, 9.0, 23)
    asked = {
        "drive": [("z", 0.35), ("beta", 0.6), ("alpha", 0.1)],
        "response": [("z", 0.6), ("z", 0.0), ("alpha", 0.35), ("beta", 0.4)],
        "quantity": "mobility",
    }
    values[:2, 0] = 0.6  # a point at the end, which is held or not
    found = family.frf(values, f, **asked)
    assert set(found.failed) == set(np.flatnonzero(values[:, 0] < 0.6))
    closed = int(found.cost.method.split()[0])
    assert closed > 10
    for k in np.flatnonzero(values[:, 0] >= 0.6):
        frf = family.scene_of(values[k]).compile().frf(f, **asked)
        scale = np.abs(frf.value).max(axis=-1, keepdims=True)
        # both within their own errors, of roundings of where nodes stand
        off = np.abs(found.value[k] - frf.value)
        assert (off <= 4e-13 * scale + 4 * frf.rounding_error * np.abs(frf.value)).all()


class Losing(Executor):
    """Loses every second chunk."""

    def __init__(self):
        self.sent = 0

    def submit(self, call, *arguments):
        self.sent += 1
        future = Future()
        if self.sent % 2:
            future.set_result(call(*arguments))
        else:
            future.set_exception(OSError("no such worker"))
        return future


def test_rows_that_an_executor_loses_have_failed():
    family = BEAM.family(["tension"])
    values = np.linspace(1.0, 2.0, 3000)[:, None]
    found = family.modes(values, 1, executor=Losing())
    lost = np.isnan(found.frequency[:, 0])
    assert lost.any() and not lost.all()
    assert sorted(found.failed) == np.flatnonzero(lost).tolist()
    assert all("no such worker" in str(error) for error in found.failed.values())


def test_other_processes_share_rows():
    family = BEAM.replace(parts=[rd.PointMass(0.3, 0.2)]).family(["tension"])
    values = np.linspace(1.0, 2.0, 20)[:, None]
    with ProcessPoolExecutor(2) as executor:
        found = family.modes(values, 2, executor=executor)
    np.testing.assert_array_equal(found.frequency, family.modes(values, 2).frequency)


def test_progress_is_told_and_may_stop_it():
    family = BEAM.family(["tension"])
    values = np.linspace(1.0, 2.0, 3000)[:, None]
    told = []
    family.modes(values, 1, progress=told.append, threads=2)
    assert told == sorted(told) and told[-1] == 1.0

    def enough(fraction):
        raise TimeoutError

    with pytest.raises(TimeoutError):
        family.modes(values, 1, progress=enough)


@pytest.mark.parametrize("elements", [None, 64], ids=["closed form", "row by row"])
@pytest.mark.parametrize("threads", [2, *long(1)])
def test_it_stops_for_control_c(threads, elements):
    code = f"""
import ropedyn as rd, numpy as np
rope = rd.Rope(1.0, 1.0, bending_stiffness=1.0)
scene = rd.Scene(rope, tension=1.0, parts=[rd.PointMass(0.3, 0.2)])
print("begin", flush=True)
family = scene.family(["tension"], elements={elements})
family.modes(np.linspace(1.0, 2.0, 100_000)[:, None], 60, threads={threads})
"""
    child = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    child.stdout.readline()
    time.sleep(1.0)
    child.send_signal(signal.SIGINT)
    start = time.perf_counter()
    _, said = child.communicate(timeout=60)
    assert b"KeyboardInterrupt" in said
    assert time.perf_counter() - start < 5.0  # one second on a machine that has nothing else to do


def test_chains_have_as_many_modes_as_they_have():
    """Beads on a string: f_k = sqrt(T/(mu a^2)) sin(k pi/2n)/pi."""
    string = rd.Scene(rd.Rope(2.0, 0.5), tension=1.0)
    family = string.family(["tension"], elements=4, element="rigid")
    found = family.modes([[1000.0], [4000.0]], 5, derivative=True)
    true = np.sqrt(1000.0 / 0.5) * 2 * np.sin(np.arange(1, 4) * np.pi / 8) / np.pi
    np.testing.assert_allclose(found.frequency[:, :3], [true, 2 * true], rtol=100 * EPS)
    np.testing.assert_allclose(found.derivative[0, :3, 0], true / 2000.0, rtol=100 * EPS)
    assert np.isnan(found.frequency[:, 3:]).all() and np.isnan(found.derivative[:, 3:]).all()
    assert not found.failed
    with pytest.raises(rd.SceneError, match="elements must be given"):
        string.family(["tension"], element="rigid")


def test_the_answer_is_kept_in_files(tmp_path):
    family = BEAM.family(["tension", "length"])
    found = family.modes([[1.0, 1.0], [2.0, -1.0]], 2, derivative=True)
    found.save(tmp_path / "family.nc")
    back = rd.load(tmp_path / "family.nc")
    for name in ("frequency", "eigenvalue", "growth", "rounding_error", "derivative", "certified"):
        np.testing.assert_array_equal(getattr(back, name), getattr(found, name))
    assert back.paths == found.paths
    assert {k: str(e) for k, e in back.failed.items()} == {
        k: str(e) for k, e in found.failed.items()
    }
    assert found.plot().get_ylabel() == "frequency [Hz]"
    frf = family.frf([[1.0, 1.0]], [1.0, 2.0], drive=("z", 0.5))
    frf.save(tmp_path / "frf.nc")
    np.testing.assert_array_equal(rd.load(tmp_path / "frf.nc").value, frf.value)
    assert frf.plot().get_ylabel() == "receptance, amplitude"


# --- the glue -------------------------------------------------------------------------------------


def closed(kind="plain", number=((1, 1, 1, INF, INF),), jacobian=((1,), (0,), (0,), (0,), (0,))):
    return kind, np.array(number, dtype=float), np.array(jacobian, dtype=float)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"kind": "wavy"}, "kind"),
        ({"number": ((1.0,),)}, "number must have 5 entries along axis 1, got 1"),
        ({"number": (1.0,)}, "depth"),
        ({"jacobian": ((1.0,),)}, "jacobian must have 5 entries along axis 0, got 1"),
    ],
)
def test_the_core_names_what_it_is_not_given(changes, says):
    given = closed(**changes)
    with pytest.raises((ValueError, TypeError), match=says):
        _core.closed_modes(*given, 1)
    if "jacobian" not in changes:
        with pytest.raises((ValueError, TypeError), match=says):
            _core.closed_count(*given[:2], 1.0)
    with pytest.raises(ValueError, match="modes must be at least 1, got 0"):
        _core.closed_modes(*closed(), 0)
