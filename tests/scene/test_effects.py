"""Only the effects a scene calls for: what is not asked for is not there and not computed."""

import re
import shutil

import numpy as np
import pytest
from executed import build, counts_of

import ropedyn as rd

ROPE = {"length": 1.2, "linear_density": 0.1, "bending_stiffness": 0.8}
BARE = rd.Scene(rd.Rope(**ROPE), tension=250.0)
"""Bending and tension, nothing else."""

ALONE = {
    "twist": {"torsional_stiffness": 0.4},
    "stretch": {"axial_stiffness": 4e3},
    "lay": {"lay_slope": 0.2},
    "rotary inertia": {"rotary_inertia": 2e-5},
    "polar inertia": {"polar_inertia": 1e-6},
    "hinge": rd.Hinge(0.7, stiffness=2.0),
    "point mass": rd.PointMass(0.3, 0.02),
    "spring": rd.Spring(0.5, 700.0),
    "support": rd.Support(0.8),
    "dashpot": rd.Dashpot(0.45, 2.0),
    "added mass": rd.AddedMass(0.1, 0.25, 0.03),
    "local change": rd.LocalChange(0.9, 1.0, bending=0.6),
    "resonator": rd.Resonator(0.55, 0.01, 40.0, damping_ratio=0.05),
    "broken wire": rd.BrokenWire(0.65, 0.05, 3e-4, radius=2e-3),
    "stiffness damping": rd.StiffnessDamping(1e-4),
    "rayleigh damping": rd.RayleighDamping(0.3, 2e-5),
    "loss factor": rd.LossFactor(0.02),
    "viscous damping": rd.ViscousDamping(0.4),
    "sag": rd.Gravity(9.81),
}
"""What gives a scene each effect, alone or with what it needs."""

NEEDED = {"sag": ("stretch",), "lay": ("twist",), "polar inertia": ("twist",)}


def with_only(*effects):
    """Return the bare scene with these effects and what they need."""
    given = dict.fromkeys([need for e in effects for need in NEEDED.get(e, ())] + list(effects))
    rope, parts, dampings, gravity = {}, [], [], None
    for effect in given:
        thing = ALONE[effect]
        if isinstance(thing, dict):
            rope |= thing
        elif isinstance(thing, rd.Gravity):
            gravity = thing
        elif hasattr(thing, "x") or hasattr(thing, "start"):
            parts.append(thing)
        else:
            dampings.append(thing)
    return BARE.replace(
        rope=rd.Rope(**ROPE, **rope), damping=tuple(dampings), parts=parts, gravity=gravity
    )


def full():
    """Return the scene with every effect."""
    return with_only(*ALONE)


def ask(scene):
    """Ask everything of a scene, as spans and as a chain."""
    for model in (scene.compile(), scene.compile(elements=12)):
        model.modes(4)
        model.count(below=90.0)
        model.frf([7.0, 90.0], drive=("z", 0.33), response=[("z", 0.33), ("M_beta", 0.6)])
        model.static({("z", 0.33): 1.0})


def ask_of_lines(scene):
    """Ask spans what needs no shapes."""
    model = scene.compile()
    model.modes(4)
    model.count(below=90.0)
    model.frf([7.0, 90.0], drive=("z", 0.33))


def arrays(chain):
    """The arrays of a chain that only some effects need."""
    names = ("hinge", "damping", "drag", "sag", "attached_kind", "attached_term", "attached_row")
    return {name for name in names if getattr(chain, name) is not None}


# --- what is compiled ---------------------------------------------------------------------------

BRINGS = {
    "hinge": {"hinge"},
    "dashpot": {"damping"},
    "sag": {"sag"},
    "resonator": {"attached_kind", "attached_term", "attached_row"},
    "broken wire": {"attached_kind", "attached_term", "attached_row"},
}
"""Arrays of the chain that an effect brings; viscous damping is drag, or dashpots of a chain."""


@pytest.mark.parametrize("elements", [None, 12])
def test_bare_scene_has_no_array_coordinate_or_station_of_an_effect(elements):
    chain = BARE.compile(elements=elements).chain
    assert arrays(chain) == set()
    assert BARE.coordinates == ("z", "beta")
    assert not chain.stiffness.any()
    assert len(chain.first) == (2 if elements is None else 3)
    assert not (chain.mass.any() and elements is None)


@pytest.mark.parametrize("elements", [None, 12])
@pytest.mark.parametrize("effect", ALONE)
def test_an_effect_brings_its_own_arrays_and_no_other(effect, elements):
    scene = with_only(effect)
    assert set(scene.effects) == {"tension", "bending", effect, *NEEDED.get(effect, ())}
    found = arrays(scene.compile(elements=elements).chain)
    viscous = {"drag"} if elements is None else {"damping"}
    assert found == BRINGS.get(effect, viscous if effect == "viscous damping" else set())


@pytest.mark.parametrize("effect", ALONE)
def test_only_stiffnesses_bring_coordinates(effect):
    given = {effect, *NEEDED.get(effect, ())}
    more = {c for need, c in (("twist", "alpha"), ("stretch", "x")) if need in given}
    assert set(with_only(effect).coordinates) == {"z", "beta"} | more


@pytest.mark.parametrize("elements", [None, 12])
@pytest.mark.parametrize("effect", ALONE)
def test_without_an_effect_is_the_scene_never_given_it_bit_for_bit(effect, elements):
    never = with_only(*(e for e in ALONE if e != effect and effect not in NEEDED.get(e, ())))
    left = full().without(effect)
    assert left == never
    for mine, other in zip(
        left.compile(elements=elements).chain, never.compile(elements=elements).chain
    ):
        np.testing.assert_array_equal(mine, other)


# --- what is executed ---------------------------------------------------------------------------

MECHANISMS = {
    "rods": ("twist", "stretch"),
    "hinges": ("hinge",),
    "supports": ("support",),
    "what is in proportion to velocity": ("dashpot", "viscous damping"),
    "drag": ("viscous damping",),
    "structures that nodes carry": ("resonator", "broken wire"),
    "wires": ("broken wire",),
    "sag": ("sag",),
}
"""Effects that code of the core serves. All others are numbers of what every scene has: inertia of
spans and nodes, springs at nodes, sections, complex factors."""
COUPLES = ("lay", "resonator")


def with_gcov(test):
    """Mark a test that counts lines."""
    return pytest.mark.long(pytest.mark.skipif(not shutil.which("gcov"), reason="needs gcov")(test))


@pytest.fixture(scope="module")
def counted(tmp_path_factory):
    """What counts the lines of the core that scenes execute."""
    folder = tmp_path_factory.mktemp("counted")
    objects = build(folder)
    return lambda scenes, ask="ask": counts_of(scenes, folder, objects, ask)


@with_gcov
def test_code_of_an_effect_runs_only_where_a_scene_has_it(counted):
    scenes = {"BARE": "BARE"} | {e: f"with_only({e!r})" for e in ALONE}
    # what stands at nodes goes another way where coordinates are coupled or held
    scenes |= {f"coupled {e}": f"with_only({e!r}, *COUPLES)" for e in ALONE}
    scenes |= {f"held {e}": f"with_only({e!r}, 'support')" for e in ALONE}
    scenes |= {f"no {name}": f"full().without{e!r}" for name, e in MECHANISMS.items()}
    lines = {name: set(of) for name, of in zip(scenes, counted(scenes.values()))}
    for name, served in MECHANISMS.items():
        # what no scene runs that has another effect alone
        needed = {need for effect in served for need in NEEDED.get(effect, ())}
        others = {e for e in ALONE if e not in served and not set(served) & set(NEEDED.get(e, ()))}
        own = set().union(*(lines[e] for e in served)) - lines["BARE"]
        own -= set().union(*(lines[e] for e in others | needed))
        if "support" not in served:
            own -= set().union(*(lines[f"held {e}"] for e in others))
        if not {*served} & {"twist", *COUPLES}:
            own -= set().union(*(lines[f"coupled {e}"] for e in others))
        assert own, name
        # nor may one run it that has all other effects
        assert not own & lines[f"no {name}"], name


IDLE = "parts=[*BARE.parts, rd.PointMass(0.37, 0.0), rd.LocalChange(0.7, 0.8)]"
COMPILING = ("chain/division.c", "element/section.c", "glue/")
"""Where stations are counted and arrays taken over, which stay."""


UNEVEN = re.compile(r"watch|glue/module\.c")
"""How often a Ctrl-C is looked for depends on the time, and the module is visited by the garbage
collector."""


@with_gcov
def test_what_an_effect_left_behind_is_executed_as_often_as_without_it(counted):
    # every effect alone, given and what is left of all, and what stands there and does nothing
    never = {effect: f"with_only({effect!r})" for effect in ALONE}
    gone = {
        effect: f"full().without(*set(ALONE) - { {effect, *NEEDED.get(effect, ())}!r})"
        for effect in ALONE
    }
    scenes = [*never.values(), *gone.values()]
    found = counted(scenes)
    for k, effect in enumerate(ALONE):
        one, other = (
            {line: n for line, n in found[at].items() if not UNEVEN.search(line[0])}
            for at in (k, len(ALONE) + k)
        )
        assert one == other, effect


SPACE = {
    **ROPE, "torsional_stiffness": 0.4, "axial_stiffness": 4e3, "polar_inertia": 1e-6,
}  # fmt: skip
IN_SPACE = rd.Scene(rd.Rope(**SPACE), tension=250.0, planes="both")
BENT = SPACE | {"length": rd.Axis.arc(2.0, 0.6), "natural": "axis"}
ARC = IN_SPACE.replace(rope=rd.Rope(**BENT))
UNEQUAL = BENT | {"bending_stiffness": (0.8, 0.6)}
FLAT = ARC.replace(rope=rd.Rope(**UNEQUAL))
STRETCHES = with_only("stretch")


def hardens(t, u, v):
    return -1e5 * u**3


APART = {
    "second plane": (BARE, BARE.replace(planes="both")),
    "own weight": (BARE, BARE.replace(gravity=rd.Gravity(9.81, inclination=0.5))),
    "pulsating tension": (
        BARE,
        BARE.replace(tension=rd.Tension(250.0, amplitude=10.0, frequency=30.0)),
    ),
    "stop": (BARE, BARE.replace(parts=[rd.Stop(0.5, 1e3, gap=1e-3)])),
    "mean stretching": (
        STRETCHES,
        STRETCHES.replace(tension=rd.Tension(250.0, stretching=True)),
    ),
    "node force": (BARE, BARE.replace(parts=[rd.NodeForce(0.5, hardens)])),
    "modal damping": (BARE, BARE.replace(damping=rd.ModalDamping(0.01))),
    "wire friction": (BARE, BARE.replace(damping=rd.WireFriction((0.2, 0.1), (0.1, 0.2)))),
    "axis": (IN_SPACE, IN_SPACE.replace(rope=rd.Rope(**SPACE | {"length": rd.Axis.arc(2.0, 0.6)}))),
    "initial moment": (ARC, ARC.replace(rope=rd.Rope(**BENT | {"natural": "straight"}))),
    "shear": (ARC, ARC.replace(rope=rd.Rope(**BENT, shear_stiffness=1e4))),
    "turned section": (FLAT, FLAT.replace(rope=rd.Rope(**UNEQUAL, principal_angle=0.3))),
}
"""Effects that not every scene can have beside the others: the scene without and with each."""


@pytest.mark.parametrize("effect", APART)
def test_an_effect_apart_leaves_the_scene_that_was_never_given_it(effect):
    never, given = APART[effect]
    assert set(given.effects) == {*never.effects, effect}
    left = given.without(effect)
    assert left == never
    assert left.coordinates == never.coordinates


def ask_of_motion(scene):
    """Ask a scene in the plane or in space what both answer."""
    model = scene.compile()
    model.modes(4)
    model.frf([7.0, 90.0], drive=("z", 0.33))
    model.static({("z", 0.33): 1.0})


@with_gcov
def test_what_an_effect_apart_left_behind_is_executed_as_often_as_without_it(counted):
    scenes = [f"APART[{e!r}][0]" for e in APART]
    scenes += [f"APART[{e!r}][1].without({e!r})" for e in APART]
    found = counted(scenes, "ask_of_motion")
    for k, effect in enumerate(APART):
        one, other = (
            {line: n for line, n in found[at].items() if not UNEVEN.search(line[0])}
            for at in (k, len(APART) + k)
        )
        assert one == other, effect


@with_gcov
def test_what_does_nothing_is_solved_as_often_as_what_is_not_there(counted):
    bare, idle = counted(["BARE", f"BARE.replace({IDLE})"], "ask_of_lines")
    assert len(bare) > 500
    for line in bare.keys() | idle.keys():
        if not any(name in line[0] for name in COMPILING):
            assert bare[line] == idle[line], line


@pytest.mark.parametrize("effect", ALONE)
def test_coordinates_are_those_without_what_is_absent(effect):
    left = full().without(*set(ALONE) - {effect, *NEEDED.get(effect, ())})
    assert left.coordinates == with_only(effect).coordinates
    idle = left.replace(parts=[*left.parts, rd.PointMass(0.37, 0.0), rd.LocalChange(0.7, 0.8)])
    assert idle.coordinates == left.coordinates
    assert idle.compile().components == left.compile().components
