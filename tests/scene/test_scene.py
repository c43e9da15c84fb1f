"""The scene: effects in order, what `without` leaves, coordinates, ends; frozen and hashable."""

import copy
import dataclasses
import itertools
import pickle
import re

import numpy as np
import pytest
from parabolas import parabola

import ropedyn as rd

ORDER = (
    "tension",
    "bending",
    "twist",
    "stretch",
    "lay",
    "rotary inertia",
    "polar inertia",
    "point mass",
    "spring",
    "dashpot",
    "support",
    "stiffness damping",
    "rayleigh damping",
    "loss factor",
    "viscous damping",
    "modal damping",
    "sag",
)
ROPE = {
    "length": 1.2,
    "linear_density": 0.1,
    "bending_stiffness": 1.5,
    "torsional_stiffness": 0.4,
    "axial_stiffness": 9e3,
    "lay_coupling": 3.0,
    "lay_slope": 0.2,
    "rotary_inertia": 1e-5,
    "polar_inertia": 1e-6,
}
MASS = rd.PointMass(0.3, 0.05, rotary_inertia=1e-6, polar_inertia=1e-7)
SPRINGS = {c: rd.Spring(0.5, 700.0, coordinate=c) for c in ("x", "z", "alpha", "beta")}
DASHPOTS = {c: rd.Dashpot(0.5, 2.0, coordinate=c) for c in ("x", "z", "alpha", "beta")}
SUPPORTS = {c: rd.Support(0.8, coordinate=c) for c in ("x", "z", "alpha", "beta")}
STANDING = {
    "spring": {"x": 4e3, "z": 900.0, "alpha": 0.7, "beta": 3.0},
    "dashpot": {"x": 2.0, "z": 0.4, "alpha": 1e-3, "beta": 2e-3},
    "mass": {"x": 0.2, "z": 0.3, "alpha": 1e-6, "beta": 2e-6},
}
DAMPINGS = {
    damping.kind: damping
    for damping in (
        rd.StiffnessDamping(1e-4),
        rd.RayleighDamping(0.3, 2e-5),
        rd.LossFactor(0.02),
        rd.ViscousDamping(0.4),
        rd.ModalDamping((0.01, 0.02, 0.03, 0.04)),
    )
}
STIFFNESS, RAYLEIGH = DAMPINGS["stiffness damping"], DAMPINGS["rayleigh damping"]
GRAVITY = rd.Gravity(9.81, inclination=0.1, own_weight=False)


def end(gone=(), **changes):
    """Return a free end where everything stands, but not on the coordinates that are gone."""
    standing = {
        name: {c: v for c, v in values.items() if c not in gone}
        for name, values in (STANDING | changes).items()
    }
    return rd.End(x="free", z="free", alpha="free", beta="free", **standing)


def full():
    """Return a scene with every effect."""
    return rd.Scene(
        rd.Rope(**ROPE),
        tension=250.0,
        ends=(end(), "pinned"),
        damping=tuple(DAMPINGS.values()),
        parts=[MASS, *SPRINGS.values(), *DASHPOTS.values(), *SUPPORTS.values()],
        gravity=GRAVITY,
    )


def never(*properties, gone=(), **changes):
    """Return the scene that was never given these properties and what stood on `gone`."""
    given = {
        "tension": 250.0,
        "ends": (end(gone), "pinned"),
        "damping": tuple(DAMPINGS.values()),
        "parts": [
            MASS,
            *(s for c, s in SPRINGS.items() if c not in gone),
            *(d for c, d in DASHPOTS.items() if c not in gone),
            *(s for c, s in SUPPORTS.items() if c not in gone),
        ],
        "gravity": GRAVITY,
    }
    rope = rd.Rope(**{name: v for name, v in ROPE.items() if name not in properties})
    return rd.Scene(rope, **given | changes)


# the scene written down again without the effect, by hand
NEVER_GIVEN = {
    "tension": never(tension=0.0, gravity=None),
    "bending": never("bending_stiffness", "lay_slope", "rotary_inertia", gone=["beta"]),
    "twist": never(
        "torsional_stiffness", "lay_coupling", "lay_slope", "polar_inertia", gone=["alpha"]
    ),
    "stretch": never("axial_stiffness", "lay_coupling", gone=["x"], gravity=None),
    "lay": never("lay_coupling", "lay_slope"),
    "rotary inertia": never("rotary_inertia"),
    "polar inertia": never("polar_inertia"),
    "point mass": never(
        parts=[*SPRINGS.values(), *DASHPOTS.values(), *SUPPORTS.values()],
        ends=(end(mass={}), "pinned"),
    ),
    "spring": never(
        parts=[MASS, *DASHPOTS.values(), *SUPPORTS.values()], ends=(end(spring={}), "pinned")
    ),
    "dashpot": never(
        parts=[MASS, *SPRINGS.values(), *SUPPORTS.values()], ends=(end(dashpot={}), "pinned")
    ),
    "support": never(parts=[MASS, *SPRINGS.values(), *DASHPOTS.values()]),
    **{
        gone: never(damping=tuple(d for kind, d in DAMPINGS.items() if kind != gone))
        for gone in DAMPINGS
    },
    "sag": never(gravity=None),
}


def bits(model):
    """Every number of a model, as bytes with type and shape."""
    arrays = [model.x, *(a for a in model.chain if isinstance(a, np.ndarray))]
    return [(a.dtype.str, a.shape, a.tobytes()) for a in arrays]


def test_full_scene_has_every_effect_in_the_documented_order():
    assert full().effects == ORDER


@pytest.mark.parametrize("effect", ORDER)
def test_without_equals_the_scene_never_given_the_effect(effect):
    assert full().without(effect) == NEVER_GIVEN[effect]
    assert hash(full().without(effect)) == hash(NEVER_GIVEN[effect])


@pytest.mark.parametrize("effect", ORDER)
def test_without_compiles_to_the_bits_of_the_scene_never_given_the_effect(effect):
    thinned = full().without(effect).compile(elements=12, element="rigid")
    bare = NEVER_GIVEN[effect].compile(elements=12, element="rigid")
    assert thinned.coordinates == bare.coordinates
    assert thinned.components == bare.components
    assert bits(thinned) == bits(bare)


@pytest.mark.parametrize("effect", ORDER)
def test_without_answers_the_bits_of_the_scene_never_given_the_effect(effect):
    first, second = (
        parabola(scene, elements=12, element="rigid").modes(4)
        for scene in (full().without(effect), NEVER_GIVEN[effect])
    )
    np.testing.assert_array_equal(first.frequency, second.frequency)
    np.testing.assert_array_equal(first.shape, second.shape)
    np.testing.assert_array_equal(first.damping_ratio, second.damping_ratio)


@pytest.mark.parametrize("effect", ORDER)
def test_without_removes_the_effect_and_what_cannot_be_without_it(effect):
    dragged = {
        "bending": {"bending", "rotary inertia"},  # the lay coupling of stretch and twist stays
        "twist": {"twist", "lay", "polar inertia"},
        "tension": {"tension", "sag"},
        "stretch": {"stretch", "sag"},
    }.get(effect, {effect})
    assert full().without(effect).effects == tuple(e for e in ORDER if e not in dragged)


@pytest.mark.parametrize(("first", "second"), list(itertools.combinations(ORDER, 2)))
def test_effects_are_removed_in_any_order(first, second):
    together = full().without(first, second)
    assert full().without(first).without(second) == together
    assert full().without(second, first) == together


@pytest.mark.parametrize("effect", ORDER)
def test_removing_an_effect_twice_changes_nothing_more(effect):
    once = full().without(effect)
    assert once.without(effect) == once


def test_without_nothing_is_the_scene():
    assert full().without() == full()


def test_without_leaves_the_scene_itself_alone():
    scene = full()
    scene.without(*ORDER[3:])
    assert scene == full()


def test_without_keeps_words_that_name_ends():
    assert full().replace(ends=("free", "pinned")).without("spring").ends == ("free", "pinned")


@pytest.mark.parametrize("effects", [("bending", "twist", "stretch", "tension"), ORDER])
def test_without_all_that_could_vibrate_is_refused(effects):
    with pytest.raises(rd.SceneError, match="must have a stiffness or the scene a tension"):
        full().without(*effects)


def test_replace_changes_what_it_names_alone():
    changed = full().replace(tension=10.0)
    for field in dataclasses.fields(rd.Scene):
        expected = 10.0 if field.name == "tension" else getattr(full(), field.name)
        assert getattr(changed, field.name) == expected


def test_replace_checks_like_the_scene():
    # the parts stand at up to 0.8 m
    with pytest.raises(rd.SceneError, match=r"parts\[9\].x must lie on the rope, .* got 0.8"):
        full().replace(rope=rd.Rope(**ROPE | {"length": 0.7}))


THINGS = {
    "rope": rd.Rope(**ROPE),
    "end": end(),
    "point mass": MASS,
    "spring": SPRINGS["z"],
    "dashpot": DASHPOTS["z"],
    "support": SUPPORTS["z"],
    **DAMPINGS,
    "gravity": GRAVITY,
    "scene": full(),
}


@pytest.mark.parametrize("name", THINGS)
def test_descriptions_are_frozen(name):
    thing = THINGS[name]
    field = dataclasses.fields(thing)[0].name
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(thing, field, getattr(thing, field))
    with pytest.raises(dataclasses.FrozenInstanceError):
        delattr(thing, field)


@pytest.mark.parametrize("name", THINGS)
def test_descriptions_travel_by_pickle_and_copy_and_stay_equal(name):
    thing = THINGS[name]
    for twin in (pickle.loads(pickle.dumps(thing)), copy.deepcopy(thing), copy.copy(thing)):
        assert twin == thing
        assert hash(twin) == hash(thing)


@pytest.mark.parametrize("name", sorted(THINGS.keys() - {"scene"}))
def test_descriptions_can_be_read_back_from_their_repr(name):
    text = repr(THINGS[name])
    names = {each: getattr(rd, each) for each in rd.__all__}
    assert eval(text, names) == THINGS[name]


def test_springs_of_an_end_cannot_be_changed():
    spring = end().spring
    with pytest.raises(TypeError):
        spring["z"] = 1.0
    with pytest.raises(TypeError):
        del spring["z"]


def test_springs_of_an_end_do_not_follow_the_dictionary_they_came_from():
    given = dict(STANDING["spring"])
    made = end(spring=given)
    given["z"] = -1.0
    assert made.spring["z"] == STANDING["spring"]["z"]


def test_springs_of_an_end_do_not_depend_on_the_order_they_were_given_in():
    turned = end(spring=dict(reversed(STANDING["spring"].items())))
    assert (turned, hash(turned)) == (end(), hash(end()))


def test_parts_do_not_follow_the_list_they_came_from():
    parts = [MASS]
    scene = rd.Scene(rd.Rope(**ROPE), parts=parts)
    parts.clear()
    assert scene.parts == (MASS,)


@pytest.mark.parametrize("kind", [int, np.float64, np.float32, np.int16])
def test_numbers_of_any_kind_make_the_same_scene(kind):
    # 2, 1 and 8 are exact in each
    scene = rd.Scene(rd.Rope(kind(2), kind(1)), tension=kind(8), parts=[rd.Support(kind(1))])
    assert scene == rd.Scene(rd.Rope(2.0, 1.0), tension=8.0, parts=[rd.Support(1.0)])
    assert type(scene.tension) is type(scene.rope.length) is type(scene.parts[0].x) is float


def test_lists_make_the_same_scene_as_tuples():
    rope = rd.Rope(**ROPE)
    lists = rd.Scene(rope, ends=["free", "pinned"], damping=[STIFFNESS], parts=[MASS])
    tuples = rd.Scene(rope, ends=("free", "pinned"), damping=(STIFFNESS,), parts=(MASS,))
    assert (lists, hash(lists)) == (tuples, hash(tuples))


def test_an_empty_sum_of_dampings_is_no_damping():
    assert rd.Scene(rd.Rope(**ROPE), damping=()).damping is None


# coordinates exist with what moves them: x stretch, z bending or tension, alpha twist, beta bending
@pytest.mark.parametrize(
    ("given", "tension", "coordinates"),
    [
        ((), 100.0, ("z",)),
        (("bending",), 0.0, ("z", "beta")),
        (("bending",), 100.0, ("z", "beta")),
        (("bending",), -1.0, ("z", "beta")),
        (("torsional",), 0.0, ("alpha",)),
        (("torsional",), 100.0, ("z", "alpha")),
        (("axial",), 0.0, ("x",)),
        (("axial",), 100.0, ("x", "z")),
        (("axial", "torsional"), 0.0, ("x", "alpha")),
        (("bending", "torsional"), 0.0, ("z", "alpha", "beta")),
        (("bending", "torsional", "axial"), 100.0, ("x", "z", "alpha", "beta")),
    ],
)
def test_coordinates_follow_from_stiffnesses_and_tension(given, tension, coordinates):
    rope = rd.Rope(1.0, 0.1, **{f"{name}_stiffness": 5.0 for name in given})
    scene = rd.Scene(rope, tension=tension)
    assert scene.coordinates == coordinates
    assert scene.compile(elements=3, element="rigid").coordinates == coordinates
    assert (
        scene.compile(elements=3, element="rigid").chain.mass.shape[1:] == (len(coordinates),) * 2
    )


@pytest.mark.parametrize("kind", ["difference", "rigid"])
def test_a_bare_string_has_no_entry_of_what_it_was_not_given(kind):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=5, element=kind)
    assert rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).effects == ("tension",)
    assert model.components == (("z",),)
    assert not model.chain.flexibility.any()
    assert not model.chain.stiffness.any()
    assert model.damping_matrix().nnz == 0
    assert set(model.modes(1).energy) == {"tension", "z"}


@pytest.mark.parametrize("effect", ["rotary inertia", "polar inertia"])
def test_absent_inertia_has_no_entry_in_the_mass_matrix(effect):
    coordinate = {"rotary inertia": "beta", "polar inertia": "alpha"}[effect]
    model = full().without(effect, "point mass").compile(elements=9, element="rigid")
    at = model.coordinates.index(coordinate)
    assert not model.chain.mass[:, at].any()
    assert not model.chain.mass[:, :, at].any()


@pytest.mark.parametrize("effect", ["stiffness damping", "rayleigh damping", "viscous damping"])
def test_absent_damping_has_no_entry_in_the_damping_matrix(effect):
    bare = full().without("dashpot", *DAMPINGS)
    assert bare.compile(elements=9, element="rigid").damping_matrix().nnz == 0
    damped = bare.replace(damping=DAMPINGS[effect])
    assert damped.compile(elements=9, element="rigid").damping_matrix().nnz > 0
    assert damped.without(effect) == bare


def test_without_lay_bending_and_twist_are_not_coupled():
    laid, straight = full(), full().without("lay", "sag")
    assert laid.compile(elements=9, element="rigid").components == (("x", "z", "alpha", "beta"),)
    assert straight.compile(elements=9, element="rigid").components == (
        ("x",),
        ("z", "beta"),
        ("alpha",),
    )


@pytest.mark.parametrize(
    ("property_", "value"),
    [("lay_coupling", 0.0), ("lay_slope", 0.0), ("rotary_inertia", 0.0), ("polar_inertia", 0.0)],
)
def test_a_property_of_zero_is_no_effect_and_compiles_to_the_same_bits(property_, value):
    others = {k: v for k, v in ROPE.items() if k not in (property_, "lay_coupling", "lay_slope")}
    without = rd.Scene(rd.Rope(**others), tension=50.0)
    zero = rd.Scene(rd.Rope(**others, **{property_: value}), tension=50.0)
    assert zero.effects == without.effects
    assert bits(zero.compile(elements=4, element="rigid")) == bits(
        without.compile(elements=4, element="rigid")
    )


def test_inertia_on_an_absent_coordinate_is_ignored():
    plain = rd.Scene(rd.Rope(1.0, 0.1), tension=50.0, parts=[rd.PointMass(0.5, 0.2)])
    rope = rd.Rope(1.0, 0.1, rotary_inertia=1e-5, polar_inertia=1e-6)
    heavy = rd.PointMass(0.5, 0.2, rotary_inertia=1e-3, polar_inertia=1e-4)
    turning = rd.Scene(rope, tension=50.0, parts=[heavy])
    assert turning.effects == plain.effects == ("tension", "point mass")
    assert bits(turning.compile(elements=4, element="rigid")) == bits(
        plain.compile(elements=4, element="rigid")
    )


NAMED = {
    "clamped": rd.End(x="held", z="held", alpha="held", beta="held"),
    "pinned": rd.End(x="held", z="held", alpha="held", beta="free"),
    "free": rd.End(x="free", z="free", alpha="free", beta="free"),
}


@pytest.mark.parametrize("left", NAMED)
@pytest.mark.parametrize("right", NAMED)
def test_words_for_ends_compile_to_the_ends_they_stand_for(left, right):
    rope = rd.Rope(**ROPE)
    words = rd.Scene(rope, ends=(left, right)).compile(elements=3, element="rigid")
    spelled = rd.Scene(rope, ends=(NAMED[left], NAMED[right])).compile(elements=3, element="rigid")
    assert bits(words) == bits(spelled)


@pytest.mark.parametrize(("word", "free"), [("clamped", 0), ("pinned", 1), ("free", 4)])
def test_words_for_ends_hold_what_they_say(word, free):
    # two inner nodes with 4 coordinates each, and what the left end leaves free
    model = rd.Scene(rd.Rope(**ROPE), ends=(word, "clamped")).compile(elements=3, element="rigid")
    assert model.size == 2 * 4 + free


def test_ends_of_coordinates_that_the_scene_lacks_are_ignored():
    string = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0)
    other = string.replace(ends=(rd.End(x="free", alpha="free", beta="free"), "pinned"))
    assert bits(other.compile(elements=3, element="rigid")) == bits(
        string.compile(elements=3, element="rigid")
    )


def test_model_shows_what_stands_at_its_nodes():
    rope = rd.Rope(1.0, 0.1)
    parts = [rd.PointMass(0.5, 0.2), rd.Spring(0.25, 30.0)]
    model = rd.Scene(rope, tension=10.0, parts=parts).compile(elements=4)
    terms = model.node_terms
    at = terms.term
    assert len(at) == 5
    # a quarter of 0.1 kg at each inner node, half of that at the ends
    np.testing.assert_allclose(terms.mass[at, 0, 0], [0.0125, 0.025, 0.225, 0.025, 0.0125])
    np.testing.assert_array_equal(terms.stiffness[at, 0, 0], [0, 30, 0, 0, 0])
    np.testing.assert_array_equal(terms.held[at, 0], [1, 0, 0, 0, 1])


def test_a_scene_and_its_model_are_cards_in_which_a_slip_of_units_shows():
    rope = rd.Rope(2.0, 0.1, bending_stiffness=4.0, torsional_stiffness=1.0)
    ends = ("clamped", rd.End(beta="free", spring={"beta": 2.0}))
    masses = [rd.PointMass(0.5, 0.1), rd.PointMass(1.0, 0.1)]
    scene = rd.Scene(rope, tension=1000.0, ends=ends, parts=masses, damping=rd.ViscousDamping(0.1))
    lines = map(str.strip, repr(scene).splitlines()[1:])
    told = dict(re.split(r"\s{2,}", line, maxsplit=1) for line in lines)
    assert told == {
        "length": "2 m",
        "mass": "0.2 kg (0.1 kg/m)",
        "tension": "1000 N",
        "string": "waves of 100 m/s, first frequency 25 Hz",
        "T L^2/B": "1000",
        "ends": "clamped and held but for beta with spring",
        "parts": "2 PointMass",
        "damping": "ViscousDamping",
        "effects": "tension, bending, twist, point mass, spring, viscous damping",
    }
    for model, cut in (
        (scene.compile(), "continuous spans, 4 stations"),
        (scene.compile(elements=8), "8 tensed elements, 22 unknowns"),
    ):
        lines = repr(model).splitlines()
        assert len(lines) <= 12
        assert max(map(len, lines)) <= 80
        assert lines[-1].split(maxsplit=1) == ["model", cut]
        assert "<td>0.2 kg (0.1 kg/m)</td>" in model._repr_html_()
