"""`mesh_error` is the distance to the continuous spans, computed when it is asked for."""

import dataclasses
import math
import pickle

import numpy as np
import pytest
from conftest import EPS
from exact_scene import places
from general_path import general_path
from random_scene import WIDTHS, random_line, taut_scene

import ropedyn as rd
from ropedyn import _core
from ropedyn.chain.chain import KINDS as ELEMENTS
from ropedyn.chain.chain import PLANE
from ropedyn.response.harmonic import mesh_of_frf, solve_harmonic

STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
ROPE = rd.Rope(1.2, 0.1, bending_stiffness=1.5, torsional_stiffness=0.4, polar_inertia=1e-6)
SCENE = rd.Scene(ROPE, tension=200.0, parts=[rd.PointMass(0.4, 0.02)])
DAMPED = SCENE.replace(damping=rd.StiffnessDamping(1e-4))
GRID = np.linspace(0.0, 150.0, 31)
AT = {
    "drive": [("z", 0.31), ("alpha", 0.4)],
    "response": [("z", 0.31), ("alpha", 0.9), ("M_beta", 0.0), ("F_z", 0.4), ("z", 0.0)],
}
KINDS = ("difference", "rigid", "tensed")

FEW, MANY = 60, 10_000
MOST = 5
"""Modes of each component."""


# modes


@pytest.mark.parametrize("n", [4, 32, 1000])
def test_mesh_error_of_a_string_is_that_of_the_closed_form(n):
    # lumped string: (2 n/pi) f_1 sin(k pi/2n), the continuous one k f_1
    modes, continuous = STRING.compile(elements=n).modes(3), STRING.compile().modes(3)
    first = math.sqrt(1000) / 2
    k = np.arange(1, 4)
    exact = first * (k - 2 * n / math.pi * np.sin(k * math.pi / (2 * n)))
    # the rounding of the continuous frequency is in the error, and moves it, as that of the chain
    rounding = modes.rounding_error + 2 * continuous.rounding_bound
    assert (np.abs(modes.mesh_error - exact) <= rounding).all()
    assert (rounding < 1e-5 * exact).all()
    np.testing.assert_allclose(modes.limit, k * first, rtol=8 * EPS)


@pytest.mark.parametrize("solver", ["sweep", "lapack"])
def test_mesh_error_does_not_depend_on_the_solver(solver):
    modes = DAMPED.compile(elements=12).modes(6, solver=solver)
    continuous = DAMPED.compile().modes(6)
    np.testing.assert_array_equal(modes.limit, continuous.frequency)
    difference = np.abs(modes.frequency - continuous.frequency)
    np.testing.assert_array_equal(modes.mesh_error, difference + continuous.rounding_bound)


def test_modes_are_compared_within_their_component_where_orders_differ():
    # twist at 74 Hz, between the third transverse frequency of five elements and the true one
    stiffness = (2 * ROPE.length * 74.0) ** 2 * ROPE.polar_inertia
    scene = SCENE.replace(rope=ROPE.replace(torsional_stiffness=stiffness))
    modes = scene.compile(elements=5).modes(4)
    continuous = scene.compile().modes(8)
    assert modes.family.tolist() != continuous.family[:4].tolist()
    for family in ("transverse", "torsional"):
        mine, true = modes.family == family, continuous.family == family
        exact, rounding = (
            a[true][: mine.sum()] for a in (continuous.frequency, continuous.rounding_bound)
        )
        assert (np.abs(modes.limit[mine] - exact) <= 2 * rounding).all()


def test_mesh_error_of_growing_motion_is_that_of_its_rate():
    scene = SCENE.replace(tension=-300.0)
    modes, continuous = scene.compile(elements=20).modes(3), scene.compile().modes(3)
    grows = modes.growth > 0
    assert grows.any()
    difference = np.abs(modes.growth - continuous.growth)[grows] / (2 * math.pi)
    np.testing.assert_allclose(modes.mesh_error[grows], difference, rtol=1e-6)
    np.testing.assert_array_equal(modes.limit[grows], 0.0)


def test_rigid_motion_has_no_mesh_error():
    modes = SCENE.replace(ends=("free", "free")).compile(elements=20).modes(4)
    rigid = modes.eigenvalue == 0
    # z and twist: tension leaves bending rotation its stiffness
    assert rigid.sum() == 2
    np.testing.assert_array_equal(modes.limit[rigid], 0.0)
    # sqrt(eps) of the first frequency: what the rounding of omega^2 leaves of 0
    assert (modes.mesh_error[rigid] <= 1e-6 * modes.frequency[2]).all()


def test_refined_difference_elements_stay_far_from_the_continuous_spans():
    scene = SCENE.replace(tension=0.0, rope=ROPE.replace(rotary_inertia=1e-4))
    errors = [
        (modes.mesh_error / modes.limit)[0]
        for modes in (scene.compile(elements=n, element="difference").modes(1) for n in (16, 512))
    ]
    assert min(errors) > 0.1


# frequency response


@pytest.mark.parametrize("quantity", ["receptance", "mobility"])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_mesh_error_of_a_response_is_its_distance_to_the_continuous_spans(element, quantity):
    where = AT if element == "tensed" else AT | {"response": AT["response"][:2]}
    frf = DAMPED.compile(elements=12, element=element).frf(GRID, quantity=quantity, **where)
    # the rounding of the continuous response is bounded, which is soon done
    continuous = solve_harmonic(DAMPED.compile(), GRID, quantity=quantity, tight=False, **where)
    assert frf.mesh_error.shape == frf.value.shape
    distance = np.abs(frf.value - continuous.value)
    distance += continuous.rounding_error * np.abs(continuous.value)
    relative = np.divide(distance, np.abs(frf.value), out=0 * distance, where=frf.value != 0)
    np.testing.assert_array_equal(frf.mesh_error, relative)
    # twist is not driven by z, the clamped end does not move
    assert (frf.value[0, 1] == 0).all()
    assert (frf.mesh_error[0, 1] == 0).all()


def test_mesh_error_of_one_drive_has_no_axis_of_drives():
    frf = DAMPED.compile(elements=12).frf(GRID, drive=("z", 0.4))
    assert frf.mesh_error.shape == frf.value.shape == (1, len(GRID))
    assert 1e-6 < frf.mesh_error.max() < 1


def test_mesh_error_is_infinite_on_an_undamped_resonance_of_the_continuous_spans():
    # 1 and 2 Hz exactly; the chain of seven has its resonances elsewhere
    scene = rd.Scene(rd.Rope(1.0, 1.0), tension=4.0)
    with pytest.raises(rd.SolveError, match="resonance"):
        scene.compile().frf([1.0], drive=("z", 0.2))
    frf = scene.compile(elements=7).frf([0.5, 1.0, 1.5, 2.0, 2.5], drive=("z", 0.2))
    assert np.isinf(frf.mesh_error[0]).tolist() == [False, True, False, True, False]


def test_mesh_error_is_infinite_where_only_the_value_is_zero():
    moves = (("z", 0.5), ("z", 0.0))
    zero = np.zeros((2, 1), dtype=complex)
    mesh = mesh_of_frf(
        STRING, np.array([20.0]), moves[:1], moves, quantity="receptance", value=zero
    )
    # the held end moves in neither
    assert mesh.mesh_error[:, 0].tolist() == [math.inf, 0.0]


@pytest.mark.filterwarnings("error")
def test_noise_where_nothing_moves_is_wrong_by_all_of_itself():
    # z at rest under a torque that the lay does not pass on: rounding at most is there, in one or
    # both, with a relative error that is infinite
    line = random_line(115)
    x, (c, i), (d, j) = line.model.x, line.drive, line.response
    where = {"drive": (c, float(x[i])), "response": (d, float(x[j]))}
    frf = line.model.frf([line.frequency], **where)
    assert frf.value[0, 0] == 0 or frf.rounding_error[0, 0] > 1
    assert frf.mesh_error[0, 0] == 0 or frf.mesh_error[0, 0] >= 1


def test_mesh_error_of_another_quantity_is_the_same():
    frf = DAMPED.compile(elements=12).frf(GRID[1:], **AT)
    # the phase turned, products rounded
    np.testing.assert_allclose(
        frf.to("mobility").mesh_error, frf.mesh_error, rtol=1e-9, atol=8 * EPS
    )


# where there is none


def test_continuous_spans_have_no_mesh_error():
    model = DAMPED.compile()
    modes, frf = model.modes(4), model.frf(GRID, **AT)
    np.testing.assert_array_equal(modes.mesh_error, np.zeros(4))
    np.testing.assert_array_equal(modes.limit, modes.frequency)
    np.testing.assert_array_equal(frf.mesh_error, np.zeros(frf.value.shape))


def test_what_continuous_spans_refuse_has_an_infinite_mesh_error():
    # L sqrt(T/B) = 1e12
    scene = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1e-22), tension=100.0)
    with pytest.raises(rd.SceneError, match="continuous"):
        scene.compile()
    model = scene.compile(elements=8)
    modes, frf = model.modes(2), model.frf([3.0], drive=("z", 0.5))
    assert np.isinf(modes.mesh_error).all()
    assert np.isnan(modes.limit).all()
    assert np.isinf(frf.mesh_error).all()


@pytest.mark.parametrize("refusal", [rd.SolveError, MemoryError])
def test_modes_that_continuous_spans_do_not_find_have_an_infinite_mesh_error(refusal, monkeypatch):
    certify = _core.certify

    def refuse(chain, *arguments):
        if chain.inertia is not None and "alpha" in chain_names(chain):
            raise refusal
        return certify(chain, *arguments)

    monkeypatch.setattr(_core, "certify", refuse)
    modes = SCENE.compile(elements=12).modes(12)
    twist = modes.family == "torsional"
    assert 0 < twist.sum() < 12
    with general_path():
        np.testing.assert_array_equal(np.isinf(modes.mesh_error), twist)
    np.testing.assert_array_equal(np.isnan(modes.limit), twist)
    assert "inf" in str(modes.table())


def chain_names(chain):
    """Coordinates of a chain."""
    return [PLANE[k] for k in chain.coordinate]


# when it is computed, and what becomes of it


@pytest.fixture
def walks(monkeypatch):
    """Kinds of the chains that the core was asked about."""
    kinds = []

    def watched(call):
        def ask(chain, *arguments):
            kinds.append(ELEMENTS[chain.kind])
            return call(chain, *arguments)

        return ask

    for name in ("certify", "sweep", "count"):
        monkeypatch.setattr(_core, name, watched(getattr(_core, name)))
    return kinds


def test_continuous_spans_are_solved_when_the_mesh_error_is_read_and_once(walks):
    model = DAMPED.compile(elements=12)
    modes, frf = model.modes(4), model.frf(GRID, **AT)
    mobility = frf.to("mobility")
    str(frf.table())
    assert set(walks) == {"tensed"}
    walks.clear()
    first = modes.mesh_error, modes.limit, frf.mesh_error, mobility.mesh_error
    assert set(walks) == {"continuous"}
    walks.clear()
    again = modes.mesh_error, modes.limit, frf.mesh_error, mobility.mesh_error
    assert all(a is b for a, b in zip(first, again))
    assert walks == []


def test_table_of_modes_shows_the_mesh_error():
    modes = SCENE.compile(elements=12).modes(4)
    assert modes.table().column("mesh error [Hz]") == tuple(modes.mesh_error.tolist())


@pytest.mark.parametrize("read", [False, True])
def test_mesh_error_survives_pickle_and_file(read, tmp_path, walks):
    model = DAMPED.compile(elements=12)
    for answer in (model.modes(4), model.frf(GRID, **AT)):
        if read:
            assert answer.mesh_error.size > 0
        again = pickle.loads(pickle.dumps(answer))
        np.testing.assert_array_equal(again.mesh_error, answer.mesh_error)
        answer.save(tmp_path / "answer.nc")
        walks.clear()
        loaded = rd.load(tmp_path / "answer.nc")
        np.testing.assert_array_equal(loaded.mesh_error, answer.mesh_error)
        assert walks == []
        dataset = answer.to_xarray()["mesh_error"]
        np.testing.assert_array_equal(dataset.values, answer.mesh_error)
        assert not again.mesh_error.flags.writeable


# random scenes: the true frequency lies where counts of the continuous spans put it


@dataclasses.dataclass
class Sample:
    """What the mesh errors of random scenes showed."""

    modes: int = 0
    outside: list = dataclasses.field(default_factory=list)
    """(seed, component, mode)."""
    overestimate: list = dataclasses.field(default_factory=list)
    refused: list = dataclasses.field(default_factory=list)


def random_chain(seed):
    """Any kind, 1 to 200 elements, ends and parts, T L^2/B from 0 to 10^6."""
    random = np.random.default_rng(seed)
    scene = taut_scene(random, int(random.choice(list(WIDTHS), p=[0.15, 0.5, 0.2, 0.15])))
    n = int(math.exp(random.uniform(0, math.log(201))))
    kinds = KINDS if scene.tension == 0 else KINDS[1:]
    least = len(set(places(scene))) + 1
    return scene.compile(elements=max(n, least), element=str(random.choice(kinds)))


def alone(model, component):
    """The model of one of the components."""
    unknowns = model.unknowns[model.components.index(component)]
    return dataclasses.replace(model, components=(component,), unknowns=(unknowns,))


def lowest(model):
    """As many of the lowest modes as exist, None where there are none or they are refused."""
    for number in range(min(MOST, model.size), 0, -1):
        try:
            return model.modes(number)
        except rd.SolveError as refusal:
            if "must be at most" not in str(refusal):
                return None
    return None


def is_within(continuous, k, modes, true):
    """Whether mode k of the continuous spans lies within both errors of that of the chain."""
    error = modes.mesh_error[k] + modes.rounding_error[k]
    f = modes.frequency[k] - modes.growth[k] / (2 * math.pi)
    if f - error > 0 and continuous.count(below=f - error) > k:
        return False
    # a count no higher than need be: there may be any number of modes below a useless bound
    high = min(f + error, true.frequency[k] * (1 + 1e-6) + error * 1e-6)
    return high <= 0 or continuous.count(below=high) > k


def take(seeds):
    sample = Sample()
    for seed in seeds:
        model = random_chain(seed)
        for component in model.components:
            continuous = alone(model.scene.compile(), component)
            modes = lowest(alone(model, component))
            if modes is None:
                continue
            try:
                bound, true = modes.mesh_error, continuous.modes(len(modes.frequency))
            except (rd.SolveError, MemoryError):
                sample.refused.append(seed)
                continue
            sample.modes += len(bound)
            within = [is_within(continuous, k, modes, true) for k in range(len(bound))]
            sample.outside += [(seed, component, k) for k, one in enumerate(within) if not one]
            signed = [m.frequency - m.growth / (2 * math.pi) for m in (modes, true)]
            error, moves = np.abs(signed[0] - signed[1]), true.eigenvalue != 0
            # an error below half an ulp is luck
            least = EPS / 2 * np.abs(signed[1][moves])
            total = (bound + modes.rounding_error)[moves]
            sample.overestimate += (total / np.maximum(error[moves], least)).tolist()
    print(
        f"{sample.modes} modes: {len(sample.outside)} outside, median overestimate "
        f"{np.median(sample.overestimate):.3g}, refused scenes {sample.refused}"
    )
    return sample


@pytest.fixture(scope="module")
def few():
    return take(range(FEW))


@pytest.fixture(scope="module")
def many():
    return take(range(MANY))


WHAT = "mesh_error + rounding_error of a mode {} {} random scenes"
REFERENCE = "counts of the continuous spans"


@pytest.mark.claim(
    WHAT.format("bounds the distance to the continuum: share of modes beyond it,", FEW),
    reference=REFERENCE,
    accepted=0.01,
)
def test_mesh_error_bounds_the_true_error_of_random_modes(few, claim):
    assert few.modes > 3 * FEW
    assert len(few.refused) <= 0.03 * FEW
    claim(len(few.outside) / few.modes)


@pytest.mark.claim(
    WHAT.format("over the distance to the continuum: median,", FEW),
    reference="modes of the continuous spans",
    accepted=30.0,
)
def test_mesh_error_is_no_useless_bound(few, claim):
    claim(np.median(few.overestimate))


@pytest.mark.slow
@pytest.mark.claim(
    WHAT.format("bounds the distance to the continuum: share of modes beyond it,", MANY),
    reference=REFERENCE,
    accepted=0.01,
)
def test_mesh_error_bounds_the_true_error_of_very_many_modes(many, claim):
    assert len(many.refused) <= 0.03 * MANY
    claim(len(many.outside) / many.modes)


@pytest.mark.slow
@pytest.mark.claim(
    WHAT.format("over the distance to the continuum: median,", MANY),
    reference="modes of the continuous spans",
    accepted=30.0,
)
def test_mesh_error_of_very_many_modes_is_no_useless_bound(many, claim):
    claim(np.median(many.overestimate))
