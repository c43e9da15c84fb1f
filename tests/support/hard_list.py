"""The hard cases that ship with ropedyn, and what makes their values: closed forms and mpmath.

    python tests/support/hard_list.py        # writes ropedyn/study/hard/cases.json

A value is what the numbers of the scene, doubles as they stand, lead to: no digit of it comes from
the library, which says where to look for a root at most.
"""

import dataclasses
import functools
import itertools
import json
import math
import sys
import time
from collections.abc import Callable
from pathlib import Path

import exact_roots
import mpmath
import stored
from exact_span import Continuum, coupled
from mpmath import mpf

import ropedyn as rd
from ropedyn.scene.toml import document

FILE = Path(rd.__file__).parent / "study" / "hard" / "cases.json"
WORK, KEPT = 60, 40
"""Digits that are computed with, and that are kept."""
B, MU, T = 2.5, 0.1, 100.0
BEAM = rd.Rope(1.0, MU, bending_stiffness=B)
STRING = rd.Rope(1.0, MU)
EULER = math.pi**2 * B
"""Of the pinned beam [N]."""
PINNED = ("pinned", "pinned")
FREE = ("free", "free")
ROOTS = "zeros of the determinant of the exact transfer matrices, mpmath"
WAVES = "closed form in waves, mpmath"


@dataclasses.dataclass(frozen=True)
class Listed:
    """A case: what is asked, and how its value is found."""

    name: str
    hard: str
    decades: float
    digits: float | None
    test: str
    scene: rd.Scene
    ask: dict
    value: Callable | None
    how: str
    compile: dict = dataclasses.field(default_factory=dict)
    peer: bool = True
    refusal: str = ""


LIST = []


def case(name, hard, *, decades, digits, test, scene, ask, how, **more):
    """Enter a case; what is decorated computes its value from the scene."""

    def enter(value):
        one = Listed(name, hard, decades, digits, f"tests/{test}", scene, ask, value, how, **more)
        LIST.append(one)
        return value

    return enter


def modes(number, **more):
    return {"kind": "modes", "number": number, **more}


def rates(number):
    return {"kind": "rates", "number": number}


def frf(frequency, drive, response=None):
    lines = frequency if isinstance(frequency, list) else [frequency]
    return {"kind": "frf", "frequency": lines, "drive": drive, "response": response or drive}


def static(load, **more):
    return {"kind": "static", "load": load, **more}


def short(number):
    """A power of ten as it is said: 1e-6."""
    return f"{number:.0e}".replace("e-0", "e-")


# --- references ---------------------------------------------------------------------------------


def roots(scene, coordinate="z", groups=()):
    """Signed frequencies next to those of the library [Hz]; of groups all within a circle."""
    exact = Continuum(scene, coupled(scene, coordinate))
    number = next(one for one in LIST if one.scene is scene).ask["number"]
    found, near = [], scene.compile().modes(number).eigenvalue.tolist()
    k = 0
    while k < number:
        size = next((n for first, n in groups if first == k), 1)
        if size > 1:
            found += exact_roots.cluster(exact, mpf(near[k]), 1e-3)
        else:
            found.append(mpf(0) if near[k] == 0 else exact_roots.eigenvalue(exact, near[k], 1e-3))
        k += size
    assert len(found) == number
    return [hertz(one) for one in found]


def hertz(eigenvalue):
    return mpmath.sign(eigenvalue) * mpmath.sqrt(abs(eigenvalue)) / (2 * mpmath.pi)


def receptance(scene, ask):
    """Response by the exact transfer matrices."""
    exact = Continuum(scene, coupled(scene, "z"))
    return [
        exact.receptance(2 * mpmath.pi * mpf(f), tuple(ask["drive"]), [tuple(ask["response"])])[0]
        for f in ask["frequency"]
    ]


def unit_frequency(scene, kappa):
    """Frequency of a beam without tension whose wavenumber times length is kappa [Hz]."""
    rope = scene.rope
    square = kappa / mpf(rope.length)
    return (
        square**2
        * mpmath.sqrt(mpf(rope.bending_stiffness) / mpf(rope.linear_density))
        / (2 * mpmath.pi)
    )


def between_beams(number):
    """Roots of cos k cosh k = 1."""
    return [
        mpmath.findroot(lambda k: mpmath.cos(k) - 1 / mpmath.cosh(k), (j + 0.5) * mpmath.pi)
        for j in range(1, number + 1)
    ]


def pinned_eigenvalue(scene, wave):
    """Of so many half waves of a pinned beam [rad^2/s^2]."""
    rope, q = scene.rope, wave * mpmath.pi / mpf(scene.rope.length)
    return (
        q**2 * (mpf(scene.tension) + mpf(rope.bending_stiffness) * q**2) / mpf(rope.linear_density)
    )


def pinned_lowest(scene, number):
    return [hertz(x) for x in sorted(pinned_eigenvalue(scene, k) for k in range(1, 400))[:number]]


def wavenumbers(scene, f):
    """Of waves that fade and of those that travel along a tensed beam, a and b [1/m]."""
    rope, omega = scene.rope, 2 * mpmath.pi * mpf(f)
    bend = mpf(rope.bending_stiffness)
    half = mpf(scene.tension) / (2 * bend)
    square = mpf(rope.linear_density) * omega**2 / bend
    far = half + mpmath.sqrt(half**2 + square)
    return mpmath.sqrt(far), mpmath.sqrt(square / far)


def between_clamps(scene, number):
    """Roots of the tensed beam of length 1 next to those of the library [Hz]."""

    def zero(f):
        a, b = wavenumbers(scene, f)
        rest = 2 * a * b * (1 / mpmath.cosh(a) - mpmath.cos(b))
        return rest + (a**2 - b**2) * mpmath.tanh(a) * mpmath.sin(b)

    near = scene.compile().modes(number).frequency.tolist()
    return [mpmath.findroot(zero, (f, f * (1 + 1e-12)), tol=1e-55, verify=False) for f in near]


def pinned_middle(scene, f):
    """Compliance of a pinned beam in its middle: (tan(b/2)/b - tanh(a/2)/a)/(2 B (a^2 + b^2))."""
    a, b = wavenumbers(scene, f)
    of_waves = 2 * mpf(scene.rope.bending_stiffness) * (a**2 + b**2)
    return (mpmath.tan(b / 2) / b - mpmath.tanh(a / 2) / a) / of_waves


def rigid_eigenvalue(scene, elements, wave):
    """Of so many half waves of a pinned rigid chain without rotary inertia: massless rotations."""
    a, rope = mpf(scene.rope.length) / elements, scene.rope
    c = mpmath.cos(wave * mpmath.pi / elements)
    lam = 24 * (1 - c) - 144 * (1 - c * c) / (8 + 4 * c)
    return lam * mpf(rope.bending_stiffness) / (mpf(rope.linear_density) * a**4)


# --- stiffness against tension ------------------------------------------------------------------

CLAMPED = rd.Scene(BEAM)


@case(
    "beam without tension",
    "the easy end of the scale: T L^2/B = 0",
    decades=0,
    digits=14,
    test="eigen/test_continuous_modes.py::test_beam_has_its_stored_frequencies",
    scene=CLAMPED,
    ask=modes(10),
    how="roots of cos k cosh k = 1, mpmath",
)
def _(one):
    return [unit_frequency(one.scene, k) for k in between_beams(10)]


for power in (4, 8, 12):

    @case(
        f"T L^2/B = 1e{power}",
        "bending lives in layers at the ends, as thin as the square root of that is large",
        decades=power,
        digits=14,
        test="eigen/test_modes_ratios.py::test_any_tension_over_bending",
        scene=rd.Scene(rd.Rope(1.0, MU, bending_stiffness=T / 10.0**power), tension=T),
        ask=modes(10),
        how="roots of 2 a b (1/cosh a - cos b) + (a^2 - b^2) tanh a sin b, mpmath",
    )
    def _(one):
        return between_clamps(one.scene, 10)


# --- many elements ------------------------------------------------------------------------------

RIGID_BEAM = rd.Scene(BEAM, ends=PINNED)
for count in (1000, 10_000, 1_000_000):

    @case(
        f"10^{round(math.log10(count))} elements",
        "stiffness of an element over that of the rope is n^4",
        decades=4 * math.log10(count),
        digits=14,
        test="eigen/test_modes_reference.py::test_error_is_the_distance_from_the_closed_form",
        scene=RIGID_BEAM.replace(),
        ask=modes(5),
        how="dispersion relation of the rigid chain, mpmath",
        compile={"elements": count, "element": "rigid"},
        peer=count <= 10_000,
    )
    def _(one, count=count):
        return [hertz(rigid_eigenvalue(one.scene, count, k)) for k in range(1, 6)]


@case(
    "32768 elements under a load",
    "stiffness of an element over that of the rope is n^4",
    decades=18,
    digits=13,
    test="response/test_digits.py::test_assembled_stiffness_loses_digits_as_the_fourth_power_of_n",
    scene=RIGID_BEAM.replace(),
    ask=static(["z", 0.5]),
    how="L^3/48 B, exact for rigid elements",
    compile={"elements": 32768, "element": "rigid"},
)
def _(one):
    return [mpf(1) / (48 * mpf(B))]


@case(
    "10^6 elements of a string",
    "a million steps, each of which rounds",
    decades=12,
    digits=12,
    test="response/test_sweep_frf.py::test_long_pinned_chain_responds_as_its_two_waves",
    scene=rd.Scene(STRING, tension=T),
    ask=frf(70.0, ["z", 0.5]),
    how="Lagrange's string: tan(n theta/2)/(2 (T/a) sin theta), mpmath",
    compile={"elements": 1_000_000, "element": "rigid"},
)
def _(one):
    n, found = 1_000_000, []
    a = mpf(1) / n
    for f in one.ask["frequency"]:
        theta = mpmath.acos(1 - (2 * mpmath.pi * f) ** 2 * mpf(MU) * a**2 / (2 * mpf(T)))
        found.append(mpmath.tan(n * theta / 2) / (2 * mpf(T) / a * mpmath.sin(theta)))
    return found


# --- resonances ---------------------------------------------------------------------------------

TENSED = rd.Scene(BEAM, tension=T, ends=PINNED)
FIRST = math.sqrt(math.pi**2 * (T + B * math.pi**2) / MU) / (2 * math.pi)
for beside, digits in ((1e-3, 12), (1e-6, 9), (1e-9, 5), (1e-12, 2)):

    @case(
        f"{short(beside)} beside a resonance",
        "the answer is the quotient of what two stiffnesses leave",
        decades=-math.log10(beside),
        digits=digits,
        test="response/test_hard_resonances.py::"
        "test_response_next_to_a_resonance_is_known_to_its_rounding_error",
        scene=TENSED.replace(),
        ask=frf(FIRST * (1 + beside), ["z", 0.5]),
        how=WAVES,
    )
    def _(one):
        return [pinned_middle(one.scene, f) for f in one.ask["frequency"]]


@case(
    "on a resonance",
    "no digit is left, and some number would come out",
    decades=16,
    digits=None,
    test="response/test_hard_resonances.py::"
    "test_response_next_to_a_resonance_is_known_to_its_rounding_error",
    scene=TENSED.replace(),
    ask=frf(FIRST, ["z", 0.5]),
    how="refused",
    refusal="lies on an undamped resonance",
    peer=False,
)
def _(one):
    return []


PAIR = rd.Scene(
    BEAM.replace(length=2.0),
    tension=30.0,
    ends=PINNED,
    parts=[rd.PointMass(1.0, 1e5, rotary_inertia=1e5)],
)


@case(
    "between two resonances 2e-7 apart",
    "two large answers of unlike sign cancel what the nearer one says",
    decades=7,
    digits=14,
    test="response/test_hard_resonances.py::"
    "test_response_between_nearly_repeated_resonances_is_known_to_its_rounding_error",
    scene=PAIR,
    ask=frf(float(PAIR.compile().modes(4).frequency[2:].mean()), ["z", 0.5], ["z", 1.5]),
    how="response of the exact transfer matrices, mpmath",
)
def _(one):
    return receptance(one.scene, one.ask)


LOADED = rd.Scene(STRING, tension=1000.0, parts=[rd.PointMass(0.3, 0.1)])


@case(
    "1e-9 beside an antiresonance",
    "two large parts cancel: the driven point stands still",
    decades=9,
    digits=5,
    test="response/test_rounding_error.py::"
    "test_antiresonance_of_a_loaded_string_is_known_to_its_rounding_error",
    scene=LOADED,
    ask=frf(100.0 * (1 + 1e-9), ["z", 0.5]),
    how=ROOTS.replace("zeros of the determinant", "response"),
)
def _(one):
    return receptance(one.scene, one.ask)


PART = rd.Scene(BEAM.replace(length=0.3), tension=T)


@case(
    "a part resonates",
    "clamped at both ends the first 0.3 m would resonate to the last digit: a transfer matrix of "
    "it is singular",
    decades=16,
    digits=14,
    test="response/test_hard_resonances.py::"
    "test_response_is_exact_where_a_part_of_the_chain_resonates",
    scene=rd.Scene(BEAM, tension=T, parts=[rd.PointMass(0.3, 0.02)]),
    ask=frf(float(PART.compile().modes(1).frequency[0]), ["z", 0.6]),
    how="response of the exact transfer matrices, mpmath",
)
def _(one):
    return receptance(one.scene, one.ask)


HIGH = rd.Scene(BEAM, tension=T, ends=PINNED)


@case(
    "ten thousand half waves",
    "the phase along the rope keeps what 3e4 radians leave",
    decades=4.5,
    digits=11,
    test="response/test_continuous_frf.py::test_beam_responds_as_the_continuum",
    scene=HIGH,
    ask=frf(7.853981e8, ["z", 0.5]),
    how=WAVES,
    peer=False,
)
def _(one):
    return [pinned_middle(one.scene, f) for f in one.ask["frequency"]]


# --- critical loads -----------------------------------------------------------------------------

for side, digits, word in ((1e-6, 9, "below"), (1e-12, 2, "below"), (-1e-12, 3, "beyond")):

    @case(
        f"{short(abs(side))} {word} the critical load",
        "what is left of the stiffness, or grows",
        decades=-math.log10(abs(side)),
        digits=digits,
        test="eigen/test_continuous_modes.py::"
        "test_first_frequency_keeps_what_the_critical_load_leaves",
        scene=rd.Scene(BEAM, tension=-EULER * (1 - side), ends=PINNED),
        ask=modes(1),
        how="closed form, mpmath",
    )
    def _(one):
        return pinned_lowest(one.scene, 1)


def static_middle(scene):
    """(tan(u)/u - 1) L/4P, u = L sqrt(P/B)/2, P = -T."""
    P = -mpf(scene.tension)
    u = mpmath.sqrt(P / mpf(B)) / 2
    return (mpmath.tan(u) / u - 1) / (4 * P)


for side, digits in ((1e-6, 9), (1e-12, 2)):

    @case(
        f"deflection {short(side)} below the critical load",
        "hardly any stiffness is left to hold the load",
        decades=-math.log10(side),
        digits=digits,
        test="response/test_static.py::"
        "test_rounding_error_covers_what_is_lost_next_to_the_critical_load",
        scene=rd.Scene(BEAM, tension=-EULER * (1 - side), ends=PINNED),
        ask=static(["z", 0.5]),
        how="closed form, mpmath",
    )
    def _(one):
        return [static_middle(one.scene)]


BEYOND = rd.Scene(BEAM, tension=-9.5 * EULER, ends=PINNED)


@case(
    "deflection beyond three critical loads",
    "the sign of the answer is wrong unless someone counts",
    decades=1,
    digits=None,
    test="response/test_static.py::test_deflection_beyond_critical_loads_is_refused_and_said",
    scene=BEYOND.replace(),
    ask=static(["z", 0.5]),
    how="refused",
    refusal="3 critical loads are met or exceeded",
    peer=False,
)
def _(one):
    return []


@case(
    "that deflection, asked for",
    "three directions give way, and the answer says so",
    decades=1,
    digits=13,
    test="response/test_static.py::test_deflection_beyond_critical_loads_is_refused_and_said",
    scene=BEYOND.replace(),
    ask=static(["z", 0.5], unstable=True),
    how="closed form, mpmath",
)
def _(one):
    return [static_middle(one.scene)]


@case(
    "growth beyond a thousand critical loads",
    "thirty-one motions grow, the fastest nearly alike",
    decades=3,
    digits=14,
    test="eigen/test_continuous_modes.py::test_growth_rates_far_beyond_the_critical_load",
    scene=rd.Scene(BEAM, tension=-1000.5 * EULER, ends=PINNED),
    ask=modes(10),
    how="closed form, mpmath",
)
def _(one):
    return pinned_lowest(one.scene, 10)


DOUBLE = rd.Scene(BEAM, tension=-10 * EULER)


@case(
    "double growth rate",
    "an even and an odd shape grow alike to the last digit",
    decades=16,
    digits=14,
    test="eigen/test_continuous_modes.py::test_double_growth_rate_of_a_compressed_beam",
    scene=DOUBLE,
    ask=modes(2),
    how="both zeros within a circle, mpmath",
)
def _(one):
    return roots(one.scene, groups=[(0, 2)])


# --- free ropes ---------------------------------------------------------------------------------


@case(
    "free beam",
    "two motions of 0 Hz exactly, then elastic ones",
    decades=16,
    digits=14,
    test="eigen/test_modes_ratios.py::test_rigid_motion_has_frequency_zero",
    scene=rd.Scene(BEAM, ends=FREE),
    ask=modes(7),
    how="roots of cos k cosh k = 1, mpmath",
)
def _(one):
    return [mpf(0)] * 2 + [unit_frequency(one.scene, k) for k in between_beams(5)]


SOFT = rd.End(z="free", beta="free", spring={"z": 2.5e-12})


@case(
    "springs of 1e-12 at the ends of a free beam",
    "two motions near 0 Hz: their stiffness is a rounding of the rope's",
    decades=12,
    digits=14,
    test="eigen/test_modes_ratios.py::test_spring_at_a_free_end",
    scene=rd.Scene(BEAM, ends=(SOFT, SOFT)),
    ask=modes(4),
    how=ROOTS,
)
def _(one):
    return roots(one.scene)


@case(
    "a free beam at 1e-4 Hz",
    "the force of inertia is 1e-12 of the elastic ones",
    decades=12,
    digits=14,
    test="response/test_hard_ratios.py::test_ratios_of_1e12_cost_no_digit",
    scene=rd.Scene(BEAM, ends=FREE),
    ask=frf(1e-4, ["z", 0.25]),
    how="response of the exact transfer matrices, mpmath",
)
def _(one):
    return receptance(one.scene, one.ask)


# --- masses, springs and stations ---------------------------------------------------------------

RATIOS = {
    "a mass of 1e12": ([rd.PointMass(0.3, 1e11)], 12),
    "masses of 1e12 and 1e-12": ([rd.PointMass(0.3, 1e11), rd.PointMass(0.7, 1e-13)], 24),
    "springs of 1e12 and 1e-12": ([rd.Spring(0.3, 2.5e12), rd.Spring(0.7, 2.5e-12)], 24),
    "a spring of 1e12 under a mass of 1e6": (
        [rd.Spring(0.3, 2.5e12), rd.PointMass(0.3, 1e5)],
        18,
    ),
}
for title, (parts, apart) in RATIOS.items():

    @case(
        title,
        "times the rope's own: a sum of both keeps one of them",
        decades=apart,
        digits=14,
        test="eigen/test_modes_ratios.py::test_any_mass_at_a_node",
        scene=rd.Scene(BEAM, tension=T, ends=("clamped", "pinned"), parts=parts),
        ask=modes(5),
        how=ROOTS,
    )
    def _(one):
        return roots(one.scene)


@case(
    "stations 2e-9 apart",
    "the span between two masses is 1e27 as stiff as the rope",
    decades=27,
    digits=14,
    test="eigen/test_modes_ratios.py::test_unequal_spans",
    scene=rd.Scene(
        BEAM, tension=T, parts=[rd.PointMass(0.3, 0.05), rd.PointMass(0.3 + 2e-9, 0.05)]
    ),
    ask=modes(6),
    how=ROOTS,
)
def _(one):
    return roots(one.scene)


# --- clusters -----------------------------------------------------------------------------------


@case(
    "ten equal strings",
    "one frequency ten times, to the last digits",
    decades=16,
    digits=14,
    test="eigen/test_modes_clusters.py::test_ten_equal_string_spans_have_a_tenfold_frequency",
    scene=rd.Scene(STRING, tension=T, parts=[rd.Support(k / 10) for k in range(1, 10)]),
    ask=modes(10),
    how="sqrt(T/mu)/2 l of the ten lengths, mpmath",
)
def _(one):
    x = [mpf(0), *(mpf(part.x) for part in one.scene.parts), mpf(1)]
    return sorted(mpmath.sqrt(mpf(T) / mpf(MU)) / (2 * (b - a)) for a, b in itertools.pairwise(x))


HEAVY = rd.Scene(
    BEAM.replace(length=2.0),
    tension=30.0,
    ends=PINNED,
    parts=[rd.PointMass(1.0, 1e9, rotary_inertia=1e9)],
)


@case(
    "two spans about a mass of 1e10",
    "pairs of frequencies 1e-10 apart, and two slow motions",
    decades=10,
    digits=14,
    test="eigen/test_continuous_modes.py::test_two_spans_about_a_heavy_mass_have_pairs_of_frequencies",
    scene=HEAVY,
    ask=modes(6),
    how="zeros within circles, mpmath",
)
def _(one):
    return roots(one.scene, groups=[(2, 2), (4, 2)])


# --- damping ------------------------------------------------------------------------------------

ONE_MASS = rd.Scene(rd.Rope(1.0, 2.0), tension=1.0, parts=[rd.Dashpot(0.5, 4e8)])


@case(
    "overdamped by 1e8",
    "two decay rates 1e16 apart",
    decades=16,
    digits=14,
    test="eigen/test_damped_modes.py::test_one_mass_is_overdamped_beyond_twice_the_root_of_k_m",
    scene=ONE_MASS,
    ask=rates(2),
    how="m s^2 + c s + k = 0, mpmath",
    compile={"elements": 2},
)
def _(one):
    c = mpf(4e8)
    fast = -c / 2 - mpmath.sqrt(c**2 / 4 - 4)
    return [4 / fast, fast]


ALIKE = rd.Rope(1.0, 0.25)
for miss, digits in ((1e-3, 12), (1e-9, 7)):

    @case(
        f"a dashpot that matches to {short(miss)}",
        "waves come back that weak: rates are logarithms of the mismatch",
        decades=-math.log10(miss),
        digits=digits,
        test="eigen/test_damped_modes.py::"
        "test_nearly_matched_end_lets_motion_stay_for_log_of_the_mismatch",
        scene=rd.Scene(
            ALIKE,
            tension=T,
            ends=("clamped", rd.End(z="free", dashpot={"z": 5.0 * (1 + miss)})),
        ),
        ask=rates(4),
        how="log((c - Z)/(c + Z)) and turns, mpmath",
        peer=miss > 1e-6,
    )
    def _(one):
        c, Z = mpf(one.scene.ends[1].dashpot["z"]), mpmath.sqrt(mpf(T) * mpf(0.25))
        speed = mpmath.sqrt(mpf(T) / mpf(0.25))
        decay = mpmath.log((c - Z) / (c + Z)) / 2
        return [speed * mpmath.mpc(decay, k * mpmath.pi) for k in range(4)]


@case(
    "a dashpot that matches",
    "every wave is absorbed: there is no mode, and rounding would invent some",
    decades=16,
    digits=None,
    test="eigen/test_damped_modes.py::test_matched_end_lets_no_motion_stay",
    scene=rd.Scene(ALIKE, tension=T, ends=("clamped", rd.End(z="free", dashpot={"z": 5.0}))),
    ask=rates(4),
    how="refused",
    refusal="matches the rope's impedance",
    peer=False,
)
def _(one):
    return []


@case(
    "a dashpot of 1e6 impedances",
    "it holds its point nearly still; one rate is slow",
    decades=6,
    digits=9,
    test="eigen/test_damped_modes.py::test_no_root_of_a_damped_string_is_missed_or_doubled",
    scene=rd.Scene(ALIKE, tension=T, parts=[rd.Dashpot(0.31, 5e6)]),
    ask=rates(5),
    how="zeros of sinh s + c sinh(s x) sinh(s (1 - x)), mpmath",
)
def _(one):
    tau, Z, x, c = mpf(1) / 20, mpf(5), mpf(0.31), mpf(5e6)
    assert mpmath.sqrt(mpf(T) / mpf(0.25)) == 20

    def zero(s):
        sinh, s = mpmath.sinh, s * tau
        return sinh(s) + c / Z * sinh(s * x) * sinh(s * (1 - x))

    near = one.scene.compile().modes(5, damped=True).eigenvalue.tolist()
    return [mpmath.findroot(zero, mpmath.mpmathify(s), tol=1e-55, verify=False) for s in near]


# --- couplings ----------------------------------------------------------------------------------


def hanging(parameter):
    slope2 = min(0.01, parameter)
    axial = parameter * T / slope2
    g = math.sqrt(slope2 / (1 - slope2 / 8)) * T / MU
    rope = rd.Rope(1.0, MU, axial_stiffness=axial)
    return rd.Scene(rope, tension=T, gravity=rd.Gravity(g))


def irvine(scene, number):
    """tan x = x - 4 x^3/lambda^2, x = Omega/2, and the antisymmetric ones."""
    EA, g = mpf(scene.rope.axial_stiffness), mpf(scene.gravity.g)
    slope = mpf(MU) * g / mpf(T)
    lam2 = slope**2 * EA / (mpf(T) * (1 + slope**2 / 8))

    def zero(x):
        return mpmath.sin(x) - x * mpmath.cos(x) + 4 / lam2 * x**3 * mpmath.cos(x)

    unit = mpmath.sqrt(mpf(T) / mpf(MU)) / (2 * mpmath.pi)
    pi = mpmath.pi
    symmetric = [
        2 * unit * mpmath.findroot(zero, (k * pi / 2, (k + 2) * pi / 2), "anderson")
        for k in range(1, 2 * number, 2)
    ]
    return sorted([*symmetric, *(2 * k * pi * unit for k in range(1, number + 1))])[:number]


for title, parameter, apart in (
    ("sag at the crossover", 4 * math.pi**2, 16),
    ("sag without stretch", 1e9, 9),
):

    @case(
        title,
        "a symmetric and an antisymmetric mode have one frequency"
        if apart == 16
        else "the rope hangs as if its length could not change",
        decades=apart,
        digits=14,
        test="chain/test_sag.py::test_hanging_string_has_irvines_frequencies",
        scene=hanging(parameter),
        ask=modes(7),
        how="Irvine and Caughey 1974, mpmath",
    )
    def _(one):
        return irvine(one.scene, 7)


def laid(scene, number):
    """(k pi/L)^2 times the eigenvalues of diag(mu, p)^-1 [[EA, D], [D, C]]."""
    r = scene.rope
    mu, p = mpf(r.linear_density), mpf(r.polar_inertia)
    a, c = mpf(r.axial_stiffness) / mu, mpf(r.torsional_stiffness) / p
    half = mpmath.sqrt((a - c) ** 2 / 4 + mpf(r.lay_coupling) ** 2 / (mu * p))
    low = (a * c - mpf(r.lay_coupling) ** 2 / (mu * p)) / ((a + c) / 2 + half)
    every = [(k * mpmath.pi) ** 2 * v for k in range(1, 200) for v in (low, (a + c) / 2 + half)]
    return [hertz(v) for v in sorted(every)[:number]]


for miss, digits in ((1e-3, 14), (1e-9, 14)):

    @case(
        f"lay coupling of 1 - {short(miss)}",
        "stretch and twist are nearly one motion: what is left of their stiffness is a difference",
        decades=-math.log10(miss),
        digits=digits,
        test="chain/test_exact_span.py::test_held_laid_rod_vibrates_in_sines",
        scene=rd.Scene(
            rd.Rope(
                1.0,
                MU,
                axial_stiffness=4e6,
                torsional_stiffness=1.0,
                polar_inertia=2e-7,
                lay_coupling=2e3 * (1 - miss),
            )
        ),
        ask=modes(5),
        how="closed form, mpmath",
    )
    def _(one):
        return laid(one.scene, 5)


def turned(scene, number):
    """Bending that twists, between pins that let it turn: two sines each."""
    r = scene.rope
    H, bend, twist = mpf(r.lay_slope), mpf(r.bending_stiffness), mpf(r.torsional_stiffness)
    mu, p = mpf(r.linear_density), mpf(r.polar_inertia)
    tt, tb, bb = (
        x / (1 + H**2) for x in (twist + H**2 * bend, H * (twist - bend), bend + H**2 * twist)
    )
    found = []
    for k in range(1, 200):
        q = k * mpmath.pi
        a, b = q**2 * tt / p, (q**4 * bb + mpf(scene.tension) * q**2) / mu
        half = mpmath.sqrt((a - b) ** 2 / 4 + (q**3 * tb) ** 2 / (p * mu))
        high = (a + b) / 2 + half
        found += [high, (a * b - (q**3 * tb) ** 2 / (p * mu)) / high]
    return [mpf(0), *(hertz(v) for v in sorted(found)[: number - 1])]


TURNS = rd.End(alpha="free", beta="free")


@case(
    "lay slope of 1",
    "bending and twist share one section, stiffnesses 1e6 apart",
    decades=6,
    digits=14,
    test="chain/test_exact_span.py::test_rope_whose_bending_twists_vibrates_in_sines",
    scene=rd.Scene(
        BEAM.replace(torsional_stiffness=2.5e-6, polar_inertia=1e-6, lay_slope=1.0),
        tension=T,
        ends=(TURNS, TURNS),
    ),
    ask=modes(6),
    how="closed form, mpmath",
)
def _(one):
    return turned(one.scene, 6)


# --- motion -------------------------------------------------------------------------------------

K, M = 400.0, 0.05
"""Of the mass at the end of two elements of a string [N/m, kg]."""


@case(
    "after a million periods",
    "the phase is known to what a million turns leave",
    decades=6,
    digits=10,
    test="motion/test_convolution.py::"
    "test_recurrence_keeps_its_phase_and_amplitude_over_many_steps",
    scene=rd.Scene(STRING, tension=T),
    ask={
        "kind": "motion",
        "time": [70248.25],
        "start": ["z", 0.5, 4.0],
        "response": ["z", 0.5],
        "tolerance": 1e-5,
    },
    how="0.01 cos(omega t), mpmath",
    compile={"elements": 2, "element": "rigid"},
    peer=False,
)
def _(one):
    omega = mpmath.sqrt(4 * mpf(T) / (mpf(MU) / 2))
    return [mpf(4.0) / (4 * mpf(T)) * mpmath.cos(omega * mpf(t)) for t in one.ask["time"]]


STOP, GAP = 4e11, 5e-3


@case(
    "a stop 1e9 as stiff as the rope",
    "a contact lasts 1e-5 of a period, thirty times",
    decades=9,
    digits=10,
    test="motion/test_events.py::test_stops_are_met_when_an_independent_integration_meets_them",
    scene=rd.Scene(STRING, tension=T, parts=[rd.Stop(0.5, STOP, gap=GAP)]),
    ask={
        "kind": "motion",
        "time": [0.1, 1.0],
        "start": ["z", 0.5, -4.0],
        "response": ["z", 0.5],
        "tolerance": 1e-6,
    },
    how="cosines from contact to contact, mpmath",
    compile={"elements": 2, "element": "rigid"},
    peer=False,
)
def _(one):
    m, k = mpf(MU) / 2, 4 * mpf(T)
    omega, away, gap = mpmath.sqrt(k / m), mpf(4.0) / k, mpf(GAP)
    # from the far side to the stop, and along it until the mass leaves
    travel = mpmath.acos(-gap / away) / omega
    speed = omega * mpmath.sqrt(away**2 - gap**2)
    # in contact m x'' = -(k + K) (x - c), c = K gap/(k + K), from gap with that speed
    both = mpmath.sqrt((k + mpf(STOP)) / m)
    centre = mpf(STOP) * gap / (k + mpf(STOP))
    touch = 2 * mpmath.atan2(speed / both, gap - centre) / both
    found = []
    for t in one.ask["time"]:
        left = mpf(t) % (2 * travel + touch)
        if left > travel + touch:
            left = 2 * travel + touch - left
        assert left <= travel
        found.append(-away * mpmath.cos(omega * left))
    return found


# --- tongues, counts, peaks ---------------------------------------------------------------------


def mathieu(order, q, odd):
    """Characteristic value a or b of this order, of the tridiagonal of Fourier coefficients."""
    n, first = 24, 1 if order % 2 else 0 if not odd else 2
    index = [first + 2 * k for k in range(n)]
    A = mpmath.zeros(n)
    for i, k in enumerate(index):
        A[i, i] = mpf(k) ** 2
        if i:
            A[i, i - 1] = A[i - 1, i] = q * (mpmath.sqrt(2) if index[i - 1] == 0 else 1)
    if first == 1:
        A[0, 0] += -q if odd else q
    return min(mpmath.eigsy(A, eigvals_only=True), key=lambda x: abs(x - mpf(order) ** 2))


PULSE = 0.02


def off_edge(order, odd, alpha):
    """Zero on an edge of the tongue of this order."""
    return mathieu(order, mpf(PULSE * T) / mpf(T) * alpha / 2, odd) - alpha


@case(
    "tongues of orders 1 to 4",
    "the fourth is 3e-9 of its frequency wide",
    decades=8.5,
    digits=14,
    test="parametric/test_tongues.py::test_tongues_of_one_mode_are_those_of_mathieu",
    scene=rd.Scene(STRING, tension=T),
    ask={"kind": "tongues", "frequency": [7.2, 34.0], "amplitude": PULSE * T, "modes": 1},
    how="Mathieu's characteristic values, mpmath",
    peer=False,
)
def _(one):
    first = mpmath.sqrt(mpf(T) / mpf(MU)) / 2
    found = []
    for order in (4, 3, 2, 1):
        for odd in (True, False):
            # alpha = 4/Omega^2 is a or b of q = e alpha/2, Omega in units of the frequency
            alpha = mpmath.findroot(functools.partial(off_edge, order, odd), mpf(order) ** 2)
            found.append(2 * first / mpmath.sqrt(alpha))
    return sorted(found)


@case(
    "modes below a limit, 10^5 of them",
    "a count that walks along every half wave would lose one",
    decades=10,
    digits=15,
    test="eigen/test_counts.py::test_long_string_is_counted_between_any_two_of_its_frequencies",
    scene=rd.Scene(BEAM, tension=T, ends=PINNED),
    ask={"kind": "count", "below": 7.8539816e10},
    how="half waves of the closed form",
    peer=False,
)
def _(one):
    omega = 2 * mpmath.pi * mpf(one.ask["below"])
    half = mpf(T) / (2 * mpf(B))
    q = mpmath.sqrt(mpmath.sqrt(half**2 + mpf(MU) * omega**2 / mpf(B)) - half)
    return [mpmath.floor(q / mpmath.pi)]


@case(
    "peaks that tell nothing",
    "tension and mass of a string change all its frequencies alike",
    decades=16,
    digits=None,
    test="study/test_hard_cases.py::test_every_case_keeps_the_digits_that_it_promises",
    scene=rd.Scene(STRING, tension=T),
    ask={"kind": "identify", "peaks": [15.8, 31.6, 47.4], "unknown": ["tension", "linear_density"]},
    how="the interval must be infinite",
    refusal="an infinite std",
    peer=False,
)
def _(one):
    return []


# --- the file -----------------------------------------------------------------------------------


def computed(one):
    """The value of a case in texts of many digits; complex ones are pairs."""
    stored.SESSION.inside = True
    try:
        with mpmath.workdps(WORK):
            return [text(v) for v in one.value(one)]
    finally:
        stored.SESSION.inside = False


def text(value):
    if isinstance(value, mpmath.mpc):
        return [text(value.real), text(value.imag)]
    return mpmath.nstr(value, KEPT)


def record(one):
    """What the file says of a case."""
    return {
        "name": one.name,
        "hard": one.hard,
        "decades": round(one.decades, 1),
        "digits": one.digits,
        "test": one.test,
        "scene": plain(document(one.scene)),
        "compile": one.compile,
        "ask": one.ask,
        "peer": one.peer,
        "refusal": one.refusal,
        "how": one.how,
        "value": computed(one),
    }


def plain(value):
    return json.loads(json.dumps(value))


def main():
    found = []
    for one in LIST:
        found.append(record(one))
        print(one.name, time.process_time(), file=sys.stderr)
    FILE.write_text("[\n" + ",\n".join(map(json.dumps, found)) + "\n]\n", encoding="utf-8")


if __name__ == "__main__":
    main()
