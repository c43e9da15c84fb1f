"""Sections of constructions: references to 40 digits, the exact energy, limits, mirrors, shapes."""

import math

import numpy as np
import pytest
from conftest import EPS, reference
from hypothesis import given
from hypothesis import strategies as st

import ropedyn as rd
from ropedyn.scene.construction.catalogue import NAMES, rows

REFERENCE = reference("rope_constructions")
SENSE, WORD = {"Z": 1, "S": -1}, {1: "Z", -1: "S"}


def built(description):
    """Build a construction, or a wire or fibre, of the description of a reference."""
    if "wire_m" in description:
        return rd.Wire(
            float(description["wire_m"]),
            youngs_modulus=float(description["E"]),
            poissons_ratio=float(description["nu"]),
            density=float(description["rho"]),
        )
    if "fibre" in description:
        return rd.Fibre(float(description["diameter_m"]))
    layers = [
        rd.Layer(
            layer["n"],
            built(layer["element"]),
            lay=float(layer["lay_m"]),
            sense=WORD[layer["sense"]],
            radius=float(layer["radius_m"]),
        )
        for layer in description["layers"]
    ]
    return rd.Construction(core=built(description["core"]), layers=layers)


def stiffnesses(section):
    return [section.axial_stiffness, section.lay_coupling, section.torsional_stiffness]


def assert_near(found, expected, *, rounding=16.0):
    expected = np.array([float(number) for number in np.atleast_1d(expected)])
    assert np.abs(found / expected - 1).max() < rounding * EPS


@pytest.mark.parametrize("name", REFERENCE["constructions"])
def test_sections_are_those_of_the_reference(name):
    case = REFERENCE["constructions"][name]
    construction = built(case["description"])
    straight, section = construction.section("straight"), construction.section()
    assert_near(stiffnesses(straight), [case[key] for key in ("EA_N", "D_Nm", "C_Nm2")])
    assert_near(stiffnesses(section), case["EA_D_C_with_exact_double_helix_lengths"])
    keys = {
        "metal_area_wires_m2": "area",
        "mass_per_m": "mass",
        "mass_per_m_exact_double_helix": "double_helix_mass",
        "polar_inertia_kg_m": "polar_inertia",
        "rotary_inertia_kg_m": "rotary_inertia",
        "B_min_Nm2": "bending_slip",
        "B_max_Nm2": "bending_stick",
    }
    for key, attribute in keys.items():
        assert_near(getattr(section, attribute), case[key])


TORSION = REFERENCE["friction_states_and_torsion_4mm_1.35m"]


@pytest.mark.parametrize("name", TORSION)
def test_friction_states_are_those_of_the_reference(name):
    case = TORSION[name]
    construction = built(case["description"])
    for state, key in ("slip", "slip_EA_D_C"), ("stick", "bonded_EA_D_C"):
        assert_near(stiffnesses(construction.section(state)), case[key])


@pytest.mark.parametrize("name", TORSION)
def test_torsional_frequencies_are_those_of_the_reference(name):
    # both ends held: the closed spans solve the same coupled waves
    case = TORSION[name]
    for state, expected in zip(("slip", "stick"), case["f1_coupled_slip_bonded_Hz"]):
        rope = rd.Rope.from_construction(
            1.35, built(case["description"]), torsion=state, bending_stiffness=None
        )
        found = rd.Scene(rope).compile().modes(1).frequency[0]
        assert abs(found / float(expected) - 1) < 1e-12


def test_a_soft_core_lets_the_radii_give_way():
    case = REFERENCE["constructions"]["6x19 Seale FC, 16 mm, regular lay"]
    section = built(case["description"]).section("straight", radial_stiffness=4e5)
    assert_near(stiffnesses(section), REFERENCE["extras"]["radial k_r=4e5"])


def test_a_soft_core_changes_neither_the_twist_per_stretch_nor_the_twist_of_a_free_end():
    construction = rd.Construction.standard("6x19S", diameter=16e-3, core="FC", scaled=False)
    sections = [construction.section(radial_stiffness=k) for k in (None, 4e5, 1e5)]
    E = [s.axial_stiffness / s.area / 1e9 for s in sections]
    assert E[0] > 150 and E[1] < 110 and E[2] < 80
    free = [s.torsional_stiffness - s.lay_coupling**2 / s.axial_stiffness for s in sections]
    per_stretch = [s.lay_coupling / s.axial_stiffness for s in sections]
    assert max(free) < 1.03 * min(free)
    assert max(per_stretch) < 1.01 * min(per_stretch)


# --- the exact energy, by complex steps over the geometry ---------------------------------------

STEP = 1e-30  # A complex step: nothing is subtracted.
PHASES = 2 * np.pi * np.arange(48) / 48


class Deformed:
    """A helix of rope length 1 after extension and twist of the rope, its radius kept."""

    def __init__(self, r, lay, sense, eps, phi):
        self.r, q = r, 2 * math.pi * sense / lay
        self.l0 = math.hypot(1, r * q)  # [per length of rope]
        self.rise, self.turn = (1 + eps) / self.l0, (q + phi) / self.l0  # per length of itself
        self.size = (self.rise**2 + (r * self.turn) ** 2) ** 0.5
        S, c = 1 / self.l0, r * q / self.l0
        self.stretch = self.size - 1
        # angles by which the tangent and the frame turn, per length of the undeformed helix
        self.bend = r * self.turn**2 / self.size - c * c / r
        self.twist = self.rise * self.turn / self.size - S * c / r
        self.torsion = S * c / r


def leaves(element, stretch, twist, weight):
    """Yield stiffness and strain of every bar of an element that stays straight."""
    if isinstance(element, rd.Fibre):
        return
    if isinstance(element, rd.Wire):
        yield weight * element.bar.EA, stretch
        yield weight * element.bar.C, twist
        return
    yield from leaves(element.core, stretch, twist, weight)
    for layer, r in zip(element.layers, element.radii):
        on = Deformed(r, layer.lay, SENSE[layer.sense], stretch, twist)
        more = weight * layer.count * on.l0
        yield more * bending(layer.element), on.bend
        yield from leaves(layer.element, on.stretch, on.twist, more)


def bending(element):
    if isinstance(element, rd.Wire):
        return element.bar.B
    return element.section().bending_slip


def hessian(rows):
    """Return K of the energy sum k strain^2/2 of strains that are 0 at rest."""
    K = np.zeros((2, 2))
    for k, strain in rows:
        step = np.imag(np.stack(strain)).reshape(2, -1) / STEP
        K += (np.ravel(k) * step) @ step.T
    return K


def both_steps(rows_of):
    """Pair the strains of a step of extension with those of one of twist."""
    steps = (1j * STEP, 0.0), (0.0, 1j * STEP)
    for (k, one), (_, other) in zip(*(rows_of(*step) for step in steps)):
        yield k, (one, other)


def in_space(on, rho, q):
    """Return |dP/ds| of a wire around the deformed helix by its points in space."""
    # the centre line and its frame at the angle 0, and their rates per undeformed length
    rise, turn, r = on.rise, on.turn, on.r
    tangent = np.array([0 * rise, r * turn, rise]) / on.size
    normal, d_normal = np.array([-1, 0, 0]), np.array([0 * turn, -turn, 0 * turn])
    binormal = np.cross(tangent, normal)
    d_tangent = np.array([-r * turn**2, 0 * turn, 0 * turn]) / on.size
    d_binormal = np.cross(d_tangent, normal) + np.cross(tangent, d_normal)
    d_psi = q - on.torsion  # the wire keeps its place in the frame of the strand
    cos, sin = np.cos(PHASES)[:, None], np.sin(PHASES)[:, None]
    dP = tangent * on.size + rho * (
        cos * d_normal + sin * d_binormal + d_psi * (cos * binormal - sin * normal)
    )
    return (dP**2).sum(axis=1) ** 0.5


def exact_torsion(construction, state):
    """Return K with wires in double helices that slip or stick, from points in space."""
    return hessian(both_steps(lambda *strain: rows_around(construction, *strain, state)))


def rows_around(construction, eps, phi, state):
    """Yield stiffness and strain of all that lies around a straight axis."""
    core = construction.core
    if isinstance(core, rd.Construction):
        yield from rows_around(core, eps, phi, state)
    else:
        yield from leaves(core, eps, phi, 1.0)
    for layer, r in zip(construction.layers, construction.radii):
        on = Deformed(r, layer.lay, SENSE[layer.sense], eps, phi)
        weight, element = layer.count * on.l0, layer.element
        yield weight * bending(element), on.bend
        if isinstance(element, rd.Wire):
            yield from leaves(element, on.stretch, on.twist, weight)
            continue
        yield from leaves(element.core, on.stretch, on.twist, weight)
        for inner, rho in zip(element.layers, element.radii):
            bar, sense, many = inner.element.bar, SENSE[inner.sense], weight * inner.count
            straight = Deformed(rho, inner.lay, sense, on.stretch, on.twist)
            yield many * straight.l0 * bar.B, straight.bend
            yield many * straight.l0 * bar.C, straight.twist
            length = in_space(on, rho, 2 * math.pi * sense / inner.lay)
            l0, change = length.real, 1j * length.imag
            if state == "slip":
                yield many * bar.EA * l0.mean(), change.mean() / l0.mean()
            else:
                yield many * bar.EA / l0 / len(l0), change


STANDARD = [
    (name, core, lay)
    for name in NAMES
    for core in ((None,) if name[0] in "17" else ("FC", "IWRC", "WSC"))
    for lay in (("Z",) if name[0] == "1" else ("sZ", "zZ"))
]


@pytest.mark.parametrize(("name", "core", "lay"), STANDARD)
def test_stiffnesses_are_the_hessian_of_the_exact_energy(name, core, lay):
    construction = rd.Construction.standard(name, diameter=16e-3, core=core, lay=lay)
    straight = hessian(both_steps(lambda *strain: leaves(construction, *strain, 1.0)))
    K = {state: exact_torsion(construction, state) for state in ("slip", "stick")}
    for state, expected in (K | {"straight": straight}).items():
        (EA, D), (_, C) = expected
        scale = np.array([EA, math.sqrt(EA * C), C])
        found = np.array(stiffnesses(construction.section(state)))
        assert (np.abs(found - [EA, D, C]) / scale).max() < 32 * EPS


# --- random strands and ropes -------------------------------------------------------------------

LAYS, WORDS = st.floats(4.0, 30.0), st.sampled_from("ZS")


@st.composite
def strands(draw, size=1e-3, material=None):
    """Draw a strand of one to three layers, of wires of a material each."""
    moduli = st.sampled_from([200e9, 69e9])
    layers, around = [], size
    for _ in range(draw(st.integers(1, 3))):
        d = size * draw(st.floats(0.5, 1.5))
        r = (around + d) / 2
        most = int(math.pi / math.asin(min(1.0, d / (2 * r))))
        layers.append(
            rd.Layer(
                draw(st.integers(1, most)),
                rd.Wire(d, youngs_modulus=draw(moduli)),
                lay=draw(LAYS) * (around + 2 * d),
                sense=draw(WORDS),
            )
        )
        around += 2 * d
    return rd.Construction(core=rd.Wire(size), layers=layers)


@st.composite
def ropes(draw):
    """Draw a rope of a ring of strands around fibre, a wire or a strand."""
    strand = draw(strands())
    n, d = draw(st.integers(3, 8)), strand.diameter
    room = d / math.sin(math.pi / n) - d
    core = draw(st.sampled_from([rd.Fibre(room), rd.Wire(room), strand]))
    r = max(d / 2 / math.sin(math.pi / n), d if core is strand else 0.0)
    layer = rd.Layer(n, strand, lay=draw(LAYS) * (2 * r + d), sense=draw(WORDS), radius=r)
    return rd.Construction(core=core, layers=[layer])


def mirrored(thing):
    if not isinstance(thing, rd.Construction):
        return thing
    layers = [
        rd.Layer(
            layer.count,
            mirrored(layer.element),
            lay=layer.lay,
            sense="S" if layer.sense == "Z" else "Z",
            radius=layer.radius,
        )
        for layer in thing.layers
    ]
    return rd.Construction(core=mirrored(thing.core), layers=layers, filling=thing.filling)


@given(st.one_of(strands(), ropes()), st.sampled_from(["slip", "stick", "straight"]))
def test_random_constructions_are_the_hessian_of_the_exact_energy(construction, state):
    if state == "straight":
        K = hessian(both_steps(lambda *strain: leaves(construction, *strain, 1.0)))
    else:
        K = exact_torsion(construction, state)
    size = np.sqrt(np.diag(K))
    (EA, D), (_, C) = K
    section = construction.section(state)
    found = np.array(stiffnesses(section))
    assert (np.abs(found - [EA, D, C]) / [EA, size.prod(), C]).max() < 64 * EPS
    assert EA * C > D * D
    assert section.bending_slip < section.bending_stick


@given(st.one_of(strands(), ropes()), st.sampled_from(["slip", "stick", "straight"]))
def test_a_mirrored_rope_untwists_the_other_way(construction, state):
    section, other = (one.section(state) for one in (construction, mirrored(construction)))
    assert other.lay_coupling == -section.lay_coupling
    for name in ("axial_stiffness", "torsional_stiffness", "bending_slip", "bending_stick"):
        assert getattr(other, name) == getattr(section, name)
    for name in ("mass", "double_helix_mass", "polar_inertia", "rotary_inertia", "area"):
        assert getattr(other, name) == getattr(section, name)


@given(st.one_of(strands(), ropes()))
def test_wires_that_stick_are_stiffer(construction):
    slip, stick = construction.section("slip"), construction.section("stick")
    more = np.array(stiffnesses(stick)) - stiffnesses(slip)
    K = np.array([[more[0], more[1]], [more[1], more[2]]])
    size = np.sqrt([slip.axial_stiffness, slip.torsional_stiffness])
    assert np.linalg.eigvalsh(K / np.outer(size, size)).min() > -64 * EPS


# --- limits -------------------------------------------------------------------------------------


def test_one_wire_is_a_bar():
    wire = rd.Wire(3e-3, poissons_ratio=0.29)
    section = rd.Construction(core=wire).section()
    A, I = math.pi * 3e-3**2 / 4, math.pi * 3e-3**4 / 64  # noqa: E741
    assert_near(section.axial_stiffness, 200e9 * A)
    assert_near(section.torsional_stiffness, 200e9 / (2 * 1.29) * 2 * I)
    assert section.lay_coupling == 0
    assert section.bending_slip == section.bending_stick
    assert_near(section.bending_slip, 200e9 * I)
    assert_near(section.mass, 7850 * A)
    assert_near([section.polar_inertia, section.rotary_inertia], [7850 * 2 * I, 7850 * I])


def test_long_lays_make_parallel_wires():
    wire, r = rd.Wire(1e-3), 1e-3
    section = rd.Construction(core=wire, layers=[rd.Layer(6, wire, lay=1e6)]).section()
    bar = rd.Construction(core=wire).section()
    assert_near(section.axial_stiffness, 7 * bar.axial_stiffness)
    assert_near(section.torsional_stiffness, 7 * bar.torsional_stiffness)
    assert_near(section.lay_coupling, 6 * bar.axial_stiffness * r * 2 * math.pi * r / 1e6)
    assert_near(section.bending_slip, 7 * bar.bending_slip)
    # wires at the angles 0, 60, .. 300 degrees: sum y^2 = 3 r^2
    stuck = 7 * bar.bending_slip + 3 * r**2 * bar.axial_stiffness
    assert_near(section.bending_stick, stuck)
    assert_near(section.polar_inertia, 7 * bar.polar_inertia + 6 * r**2 * bar.mass)


def test_a_helical_wire_alone_is_a_spring():
    # of a close spring: force per stretch G J/(r^2 l), l the length of wire, and B as of Costello
    wire, r, lay = rd.Wire(1e-4), 5e-3, 5e-4
    section = rd.Construction(core=rd.Fibre(1e-5), layers=[rd.Layer(1, wire, lay=lay, radius=r)])
    section = section.section()
    along = math.hypot(lay, 2 * math.pi * r) / lay
    flexible = section.torsional_stiffness / (
        section.axial_stiffness * section.torsional_stiffness - section.lay_coupling**2
    )
    # of first order in the small angle, whose square is 2.5e-4
    assert abs(flexible * wire.bar.C / (r**2 * along) - 1) < 1e-3
    S, c2 = 1 / along, 1 - 1 / along**2
    assert_near(section.bending_slip, wire.bar.B * 2 * S / (2 + 0.3 * c2))


def test_a_construction_on_the_axis_is_what_it_holds():
    wire = rd.Wire(1e-3)
    inner = rd.Layer(6, wire, lay=0.03, sense="S")
    around = rd.Layer(12, wire, lay=0.05, radius=2e-3)
    nested = rd.Construction(core=rd.Construction(wire, [inner]), layers=[around])
    flat = rd.Construction(core=wire, layers=[inner, around])
    assert stiffnesses(nested.section()) == stiffnesses(flat.section())
    assert nested.section().bending_stick == flat.section().bending_stick
    assert nested.diameter == flat.diameter == 5e-3


def test_a_shaped_wire_counts_by_its_numbers():
    d = 2e-3
    bar = rd.Wire(d).bar
    shaped = rd.Wire(area=bar.area, bending_stiffness=bar.B, torsional_stiffness=bar.C)
    assert shaped.bar[:-1] == pytest.approx(bar[:-1], rel=4 * EPS)
    assert shaped.bar.diameter == pytest.approx(d, rel=4 * EPS)
    tall = rd.Wire(
        3e-3, area=bar.area, bending_stiffness=bar.B, torsional_stiffness=bar.C, density=1e4
    )
    assert tall.bar.diameter == 3e-3
    assert tall.bar.mass == 1e4 * bar.area


# --- the catalogue ------------------------------------------------------------------------------

FILL = {"19S": 0.825, "19W": 0.844, "25F": 0.847, "36WS": 0.853}


@pytest.mark.parametrize("name", FILL)
def test_strands_of_touching_circles_fill_as_known(name):
    # to the digits that are known
    found = sum(row.n * row.diameter**2 for row in rows(name)) / 4
    assert abs(found - FILL[name]) < 5.1e-4


TABLES = {
    ("6x7", "FC"): (0.369, 0.345),
    ("6x19S", "FC"): (0.384, 0.359),
    ("6x19S", "IWRC"): (0.449, 0.400),
    ("6x36WS", "FC"): (0.393, 0.367),
    ("6x36WS", "IWRC"): (0.460, 0.409),
    ("8x19S", "FC"): (0.349, 0.340),
}
"""Area of metal per diameter^2 and mass [kg/m per cm^2] of catalogues, Feyrer, Wire Ropes."""


@pytest.mark.parametrize(("name", "core"), TABLES)
def test_tables_of_practice_are_met(name, core):
    area, mass = TABLES[name, core]
    d = 16e-3
    plain = rd.Construction.standard(name, diameter=d, core=core, scaled=False).section()
    assert 1.005 < plain.area / d**2 / area < 1.037  # touching circles are a little too full
    assert 0.935 < plain.mass / d**2 / mass / 1e4 < 0.985  # and have no grease
    scaled = rd.Construction.standard(name, diameter=d, core=core)
    section = scaled.section()
    assert_near(section.area, area * d**2)
    assert_near(section.mass, mass * 1e4 * d**2)
    assert 0.98 * d < scaled.diameter < d
    # what is missing lies inside the strands
    bare = mirrored(mirrored(scaled))
    assert bare == scaled
    room = 2 * scaled.radii[0] - scaled.layers[0].element.diameter
    without = rd.Construction(core=scaled.core, layers=scaled.layers).section()
    more = section.polar_inertia - without.polar_inertia
    assert more == pytest.approx(scaled.filling * room**2 / 8, rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_standards_have_their_wires_diameter_and_senses(name):
    rope, counts = name[0] != "1", {"7": 7, "19": 19, "37": 37, "36": 36, "25": 25}
    made = rd.Construction.standard(name, diameter=0.02, lay="zS" if rope else "S", scaled=False)
    assert_near(made.diameter, 0.02, rounding=64)
    outer = made.layers[-1]
    assert outer.sense == "S"
    strand = outer.element if rope else made
    if rope:
        assert outer.count == (6 if name[0] == "7" else int(name[0]))
        assert {layer.sense for layer in strand.layers} == {"Z"}
        assert outer.lay == pytest.approx(6.5 * 0.02, rel=1e-15)
        lays = {round(layer.lay / strand.diameter, 9) for layer in strand.layers}
        assert lays == {9.0 if name[0] == "7" else 8.0}
    wires = counts["".join(filter(str.isdigit, name.split("x")[1]))]
    assert 1 + sum(layer.count for layer in strand.layers) == wires


def test_strands_leave_the_gap_that_is_asked():
    for gap in (0.0, 0.03, 0.2):
        made = rd.Construction.standard("6x7", diameter=0.02, gap=gap, scaled=False)
        (R,), layer = made.radii, made.layers[0]
        S2 = 1 / (1 + (2 * math.pi * R / layer.lay) ** 2)
        touching = math.sqrt(1 + math.tan(math.pi / 2 - math.pi / 6) ** 2 / S2) / 2
        assert_near(R / layer.element.diameter, (1 + gap) * touching, rounding=64)


def test_a_standard_is_the_reference_with_its_lays():
    name = "7x7, 4 mm, regular lay"
    made = rd.Construction.standard("7x7", diameter=4e-3, lay="sZ")
    assert_near(made.section().bending_stick, REFERENCE["constructions"][name]["B_max_Nm2"])
    spiral = rd.Construction.standard("1x19", diameter=4e-3, lay="Z").section()
    assert_near(
        stiffnesses(spiral),
        REFERENCE["constructions"]["1x19, 4 mm, layers crossed, lay 9 d"][
            "EA_D_C_with_exact_double_helix_lengths"
        ],
    )
    seale = rd.Construction.standard("6x19S", diameter=16e-3, core="FC", lay="sZ", scaled=False)
    case = REFERENCE["constructions"]["6x19 Seale FC, 16 mm, regular lay"]
    assert_near(seale.section().bending_stick, case["B_max_Nm2"], rounding=128)
    assert_near(seale.section().mass, case["mass_per_m"], rounding=64)


# --- a rope of it -------------------------------------------------------------------------------


def test_a_rope_has_what_its_construction_implies():
    made = rd.Construction.standard("7x7", diameter=4e-3)
    rope = rd.Rope.from_construction(1.35, made, bending="slip", torsion="stick")
    section = made.section("stick")
    assert rope.section == section
    assert rope.bending_stiffness == section.bending_slip
    assert rope.torsional_stiffness == section.torsional_stiffness
    assert rope.linear_density == section.mass
    assert rope.replace(length=2.0).section is None
    assert rd.Rope.from_construction(1.35, section, rotary_inertia=None).rotary_inertia is None


def test_a_section_is_saved_without_its_wires(tmp_path):
    section = rd.Construction.standard("7x7", diameter=4e-3).section()
    section.save(tmp_path / "section.nc")
    assert rd.load(tmp_path / "section.nc").table() == section.table()


# --- bad input ----------------------------------------------------------------------------------

STRAND = rd.Construction.standard("1x7", diameter=3e-3)
BAD = {
    "diameter must be": lambda: rd.Wire(0.0),
    "diameter of a round wire": rd.Wire,
    "a shaped wire needs bending_stiffness and torsional_stiffness": lambda: rd.Wire(area=1e-6),
    "poissons_ratio must be above -1 and at most 0.5, got 0.6": lambda: rd.Wire(
        1e-3, poissons_ratio=0.6
    ),
    "lay must be a finite number > 0": lambda: rd.Layer(6, rd.Wire(1e-3), lay=-1.0),
    "sense must be one of": lambda: rd.Layer(6, rd.Wire(1e-3), lay=0.1, sense="X"),
    "count must be a whole number": lambda: rd.Layer(0, rd.Wire(1e-3), lay=0.1),
    "count must leave room for neighbours": lambda: rd.Construction(
        rd.Wire(1e-3), [rd.Layer(9, rd.Wire(1e-3), lay=0.1)]
    ),
    "layers must hold wires": lambda: rd.Construction(rd.Fibre(1e-3)),
    "no formula knows helices in helices in helices": lambda: rd.Layer(
        6, rd.Construction.standard("7x7", diameter=9e-3), lay=0.1
    ),
    "name must be one of": lambda: rd.Construction.standard("6x9", diameter=0.01),
    "core must be one of": lambda: rd.Construction.standard("7x7", diameter=0.01, core="FC"),
    "core must not be given of a 1x7": lambda: rd.Construction.standard(
        "1x7", diameter=0.01, core="FC"
    ),
    "lay must be one of": lambda: rd.Construction.standard("6x7", diameter=0.01, lay="Z"),
    "gap must be": lambda: rd.Construction.standard("6x7", diameter=0.01, gap=-0.1),
    "lay_length and density must leave the mass": lambda: rd.Construction.standard(
        "6x7", diameter=0.01, density=9000.0
    ),
    "torsion must be one of": lambda: STRAND.section("glued"),
    "radial_stiffness must be": lambda: STRAND.section(radial_stiffness=0.0),
    "bending must be one of": lambda: rd.Rope.from_construction(1.0, STRAND, bending="both"),
    "torsion must not be given of a Section": lambda: rd.Rope.from_construction(
        1.0, STRAND.section(), torsion="slip"
    ),
    "diameter must leave mass and stiffnesses numbers": lambda: rd.Wire(1e200),
    "diameter must leave its mass a number": lambda: rd.Fibre(1e-200),
    "must leave the stiffnesses numbers": lambda: rd.Construction(
        rd.Wire(1e-3), [rd.Layer(1, rd.Wire(1e-3), lay=1e-3, radius=1e120)]
    ).section(),
}


@pytest.mark.parametrize("message", BAD)
def test_bad_input_is_refused_by_name(message):
    with pytest.raises(rd.SceneError, match=message):
        BAD[message]()


def test_wrong_types_are_refused():
    for make in (
        lambda: rd.Wire("thick"),
        lambda: rd.Layer(6, rd.Fibre(1e-3), lay=0.1),
        lambda: rd.Construction(core=1e-3),
        lambda: rd.Construction(rd.Wire(1e-3), [rd.Wire(1e-3)]),
        lambda: rd.Rope.from_construction(1.0, rd.Wire(1e-3)),
        lambda: rd.Construction.standard("6x7", diameter=0.01, scaled="yes"),
    ):
        with pytest.raises(TypeError, match="must be"):
            make()
