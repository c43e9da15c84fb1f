"""What a model of a rope on an axis answers, and what it refuses by name."""

import math
import pickle

import numpy as np
import pytest

import ropedyn as rd

HELIX = rd.Axis.helix(0.5, 0.4, 0.9)
ROPE = rd.Rope(
    HELIX,
    0.8,
    bending_stiffness=(40.0, 30.0),
    torsional_stiffness=25.0,
    axial_stiffness=1e5,
    rotary_inertia=(1e-3, 2e-3),
    polar_inertia=3e-3,
    shear_stiffness=1e5,
)
SCENE = rd.Scene(
    ROPE,
    planes="both",
    tension=100.0,
    ends=("clamped", rd.End(y="free", beta="free", spring={"y": 500.0}, mass={"y": 0.1})),
)
MODEL = SCENE.compile()


def test_the_model_is_one_of_six_coordinates():
    assert isinstance(MODEL, rd.SpaceModel)
    assert MODEL.coordinates == SCENE.coordinates == ("x", "y", "z", "alpha", "beta", "gamma")
    assert "pieces" in repr(MODEL) and "<table>" in MODEL._repr_html_()
    assert MODEL.x == pytest.approx([0, HELIX.length], rel=1e-15)


def test_a_pickled_model_answers_the_same():
    again = pickle.loads(pickle.dumps(MODEL))
    assert (again.modes(4).frequency == MODEL.modes(4).frequency).all()


def test_strain_and_kinetic_energies_are_the_same():
    modes = MODEL.modes(6)
    strain = [k for k in modes.energy if k not in MODEL.coordinates]
    assert strain == ["bending", "twist", "stretch", "shear", "tension", "spring"]
    assert sum(modes.energy[k] for k in strain) == pytest.approx(np.ones(6), rel=1e-14)
    assert sum(modes.energy[k] for k in MODEL.coordinates) == pytest.approx(np.ones(6), rel=1e-14)
    # the sum of strain is lambda times the modal mass before both are made shares: the derivative
    # of a frequency by all stiffnesses together is half of it
    stiffer = rd.Rope(
        HELIX,
        0.8,
        bending_stiffness=(40.0, 30.0),
        torsional_stiffness=25.0 * (1 + 1e-6),
        axial_stiffness=1e5,
        rotary_inertia=(1e-3, 2e-3),
        polar_inertia=3e-3,
        shear_stiffness=1e5,
    )
    more = SCENE.replace(rope=stiffer).compile().modes(6).frequency
    assert (more / modes.frequency - 1) * 2e6 == pytest.approx(modes.energy["twist"], abs=1e-5)


def test_shapes_are_those_between_which_no_work_is_done():
    # M-orthogonal: by the trapezium rule over 512 parts, whose error goes as their square
    modes = MODEL.modes(4, points=512)
    assert modes.x.shape == (513,) and modes.shape.shape == (4, 513, 6)
    inertia = np.array([0.8, 0.8, 0.8, 3e-3, 1e-3, 2e-3])
    weight = np.full(513, HELIX.length / 512)
    weight[[0, -1]] /= 2
    gram = np.einsum("ksc,s,c,lsc->kl", modes.shape, weight, inertia, modes.shape)
    gram += 0.1 * np.outer(modes.shape[:, -1, 1], modes.shape[:, -1, 1])
    assert np.diag(gram) == pytest.approx(modes.modal_mass, rel=1e-4)
    size = np.sqrt(np.diag(gram))
    assert np.abs(gram / np.outer(size, size) - np.eye(4)).max() < 1e-4
    held = modes.shape[:, [0, -1]][:, [0] * 6 + [1] * 4, [0, 1, 2, 3, 4, 5, 0, 2, 3, 5]]
    assert (held == 0).all()


def test_a_response_is_the_sum_over_modes():
    damped = SCENE.replace(damping=rd.RayleighDamping(3.0, 1e-5)).compile()
    points = [("y", 1.3), ("gamma", 0.4)]
    modes = damped.modes(100, points=64)
    at = [int(np.abs(modes.x - s).argmin()) for _, s in points]
    places = [(c, modes.x[k]) for (c, _), k in zip(points, at)]
    f = np.linspace(0.5, 3 * modes.frequency[0], 7)
    frf = damped.frf(f, drive=places[0], response=places)
    own = np.stack([modes.shape[:, k, MODEL.coordinates.index(c)] for (c, _), k in zip(places, at)])
    s = 2j * math.pi * f[:, None]
    C = 3.0 + 1e-5 * modes.eigenvalue
    summed = np.einsum(
        "k,rk,fk->rf", own[0], own, 1 / (modes.modal_mass * (s**2 + s * C + modes.eigenvalue))
    )
    # what 100 modes leave out
    assert np.abs(frf.value / summed - 1).max() < 5e-3
    # Rayleigh's damping ratio a/2w + b w/2, of what is not damped by it but by the end: nothing
    omega = 2 * math.pi * modes.frequency
    assert modes.damping_ratio == pytest.approx(1.5 / omega + 5e-6 * omega, rel=1e-9)


def test_responses_are_reciprocal_and_bounded():
    points = [("x", 0.7), ("y", 1.3), ("z", 0.7), ("alpha", 1.1), ("beta", 1.3), ("gamma", 2.0)]
    frf = MODEL.frf([0.0, 10.0, 33.3], drive=points)
    swapped = frf.value.swapaxes(0, 1)
    assert (
        np.abs(frf.value - swapped) <= frf.rounding_limit + frf.rounding_limit.swapaxes(0, 1)
    ).all()
    assert frf.rounding_error.max() < 1e-9
    assert (frf.mesh_error == 0).all()
    one = MODEL.frf([10.0], drive=points[1], quantity="accelerance")
    assert one.value[0] == pytest.approx(-((20 * math.pi) ** 2) * frf.value[1, 1, 1:2], rel=1e-12)


def test_a_static_deflection_is_the_response_at_rest():
    load = {("y", 1.3): 2.0, ("alpha", 1.1): 0.5}
    static = MODEL.static(load, points=8)
    k = int(np.abs(static.x - 1.3).argmin())
    frf = MODEL.frf([0.0], drive=list(load), response=("z", 1.3)).value[:, 0, 0].real
    assert static.displacement[k, 2] == pytest.approx(frf @ [2.0, 0.5], rel=1e-12)
    assert static.critical_loads == 0
    assert (static.rounding_error < 1e-10 * np.abs(static.displacement).max()).all()


def test_forces_on_a_rope_without_tension_balance():
    rope = ROPE.replace(lay_slope=0.1)
    ends = ("clamped", rd.End(y="free", beta="free", spring={"y": 500.0}))
    static = rd.Scene(rope, planes="both", ends=ends).compile().static({("y", 1.3): 2.0}, points=8)
    sign = [1.0, 1.0, 1.0, 1.0, -1.0, 1.0]  # beta and M_beta turn the other way round
    # just left of a joint the frame is that of the piece before; a helix is one
    place, frame = HELIX.position(static.x), HELIX.frame(static.x)
    force = np.einsum("nij,nj->ni", frame, static.force[:, :3])
    moment = np.einsum("nij,nj->ni", frame, (static.force * sign)[:, 3:])
    assert np.abs(force.sum(axis=0)).max() < 1e-12
    assert np.abs((moment + np.cross(place, force)).sum(axis=0)).max() < 1e-12


def test_a_free_rope_is_not_at_rest_under_a_force():
    model = rd.Scene(ROPE, planes="both", ends=("free", "free")).compile()
    with pytest.raises(rd.SolveError, match="a rigid motion is free"):
        model.static({("z", 0.0): 1.0})
    with pytest.raises(rd.SolveError, match="Hz has no correct digit"):
        model.frf([0.0], drive=("z", 0.0))
    modes = model.modes(7)
    assert (modes.frequency == 0).sum() == 6
    # independent of each other
    shape = modes.shape[:6].reshape(6, -1)
    assert np.linalg.matrix_rank(shape, tol=1e-6) == 6


def test_beyond_a_critical_load_is_said():
    model = SCENE.replace(tension=-400.0).compile()
    with pytest.raises(rd.SolveError, match="critical load"):
        model.static({("z", 1.0): 1.0})
    assert (
        model.static({("z", 1.0): 1.0}, unstable=True).critical_loads
        == (model.modes(6).growth > 0).sum()
    )


def test_effects_come_and_go():
    bent = rd.Rope(
        rd.Axis.arc(1.0, 2.0),
        0.8,
        bending_stiffness=40.0,
        torsional_stiffness=25.0,
        natural="straight",
        shear_stiffness=1e5,
    )
    scene = rd.Scene(bent, planes="both", tension=10.0)
    assert scene.effects == (
        *("tension", "bending", "twist", "second plane", "axis", "initial moment", "shear"),
    )
    assert scene.without("initial moment").rope.natural == "axis"
    assert scene.without("shear").rope.shear_stiffness is None
    straight = scene.without("axis")
    assert straight.rope == rd.Rope(2.0, 0.8, bending_stiffness=40.0, torsional_stiffness=25.0)
    assert type(straight.compile()) is rd.Model


def test_what_curvature_changes_is_priced():
    rope = rd.Rope(
        rd.Axis.arc(4.0, 0.5),
        0.8,
        bending_stiffness=40.0,
        torsional_stiffness=25.0,
        natural="straight",
        axial_stiffness=1e5,
    )
    scene = rd.Scene(rope, planes="both", tension=300.0)
    cost = rd.effect_cost(scene, rd.ask.modes(3), repeat=1)
    modes, straight = (s.compile().modes(3) for s in (scene, scene.without("axis")))
    change = np.abs(modes.frequency - straight.frequency).max()
    column = cost.table().column("largest [Hz]")
    assert column[cost.table().column("left out").index("axis")] > 0.9 * change
    assert "axis" in scene.needed(rd.ask.modes(2), 1e-2)
    assert "initial moment" not in scene.needed(rd.ask.modes(2), 1e-2)


def test_other_verbs_are_refused_by_name():
    for name in ("floquet", "stability_map", "stiffness_matrix"):
        with pytest.raises(rd.SceneError, match=f"{name} is not carried for a rope on an axis"):
            getattr(MODEL, name)
        with pytest.raises(rd.SceneError, match=f"{name} is not carried for a rope with torque"):
            getattr(rd.Scene(TWISTED, torque=1.0, planes="both").compile(), name)
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        _ = MODEL.nonsense
    with pytest.raises(rd.SceneError, match="damage is not carried for a rope on an axis"):
        MODEL.modes(2).damage()
    with pytest.raises(rd.SceneError, match="derivatives are not carried"):
        MODEL.frf([1.0], drive=("z", 1.0)).derivative("tension")


TWISTED = rd.Rope(1.0, 0.8, bending_stiffness=40.0, torsional_stiffness=25.0)
CATENARY = rd.Axis.catenary(10.0, parameter=9.0)
CORNER = rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]])
STIFF = {"bending_stiffness": 40.0, "torsional_stiffness": 25.0}
REFUSED = {
    'planes must be "both"': lambda: rd.Scene(ROPE),
    "parts[0] must be one of point mass": lambda: SCENE.replace(parts=[rd.Hinge(0.5)]),
    "parts[0].lay_length must be given": lambda: SCENE.replace(
        parts=[rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)]
    ),
    "parts[1].exponent must be 1": lambda: SCENE.replace(
        parts=[rd.Spring(0.5, 1.0), rd.Dashpot(0.5, 1.0, exponent=2)]
    ),
    "must not ask for a wire": lambda: MODEL.frf([1.0], drive=("z", 1.0), response=("wire", 0)),
    "gravity must be left out": lambda: SCENE.replace(gravity=rd.Gravity()),
    "damping must be left out": lambda: SCENE.replace(damping=rd.ModalDamping(0.01)),
    "tension must be one number": lambda: SCENE.replace(
        tension=rd.Tension(100.0, amplitude=1.0, frequency=2.0)
    ),
    "tension must be 0 on an axis with corners": lambda: rd.Scene(
        rd.Rope(CORNER, 0.8, **STIFF), planes="both", tension=1.0
    ),
    "elements must be left out": lambda: SCENE.compile(elements=8),
    "bending_stiffness must be given": lambda: rd.Rope(CORNER, 0.8, torsional_stiffness=1.0),
    "torsional_stiffness must be given": lambda: rd.Rope(CORNER, 0.8, bending_stiffness=1.0),
    "length must be that of the axis": lambda: ROPE.replace(length=1.0),
    'natural must be "axis" where curvature': lambda: rd.Rope(
        rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]], fillet=0.2),
        0.8,
        natural="straight",
        **STIFF,
    ),
    "shear_stiffness must be None": lambda: rd.Rope(1.0, 0.8, shear_stiffness=1.0),
    "damped must be False": lambda: MODEL.modes(2, damped=True),
    'solver must be "sweep"': lambda: MODEL.modes(2, solver="lapack"),
    "give either number or below": MODEL.modes,
    "points must be a whole number": lambda: MODEL.modes(2, points=0),
    "drive[1] must lie on the rope": lambda: MODEL.frf([1.0], drive=("z", 9.0)),
    "below must be a finite number > 0": lambda: MODEL.count(below=0.0),
    "load must be a mapping": lambda: MODEL.static({}),
    "axis.kind must be one of": lambda: rd.Axis.from_words({"kind": "circle"}),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_not_carried_is_refused_by_name(message):
    with pytest.raises(rd.SceneError) as error:
        REFUSED[message]()
    assert message in str(error.value)


@pytest.mark.parametrize("angle", [0.5, 0.7, 1.3, 2.0, 3.0])
def test_counts_where_a_half_of_a_string_resonates(angle):
    """Across its plane a string of n half waves has parts of quarters, each at its resonance."""
    rope = rd.Rope(rd.Axis.arc(1.0, angle), 0.5, axial_stiffness=1e3)
    model = rd.Scene(rope, planes="both", tension=100.0).compile()
    wanted = np.arange(1, 9) / (2 * angle) * math.sqrt(100.0 / 0.5)
    every = model.modes(30)
    across, inside = (every.frequency[every.plane == plane] for plane in "yz")
    assert across[:8] == pytest.approx(wanted, rel=1e-13)
    for n, frequency in enumerate(wanted, 1):
        # exactly there rounding decides about one mode, and about no other
        more = model.count(below=frequency) - (inside < frequency).sum()
        assert more in (n - 1, n)
        assert model.modes(n).frequency == pytest.approx(every.frequency[:n], rel=1e-12)
