"""The exact reference of continuous spans, itself against closed forms and fine chains."""

import itertools
from types import SimpleNamespace

import exact_roots
import mpmath
import numpy as np
import pytest
from conftest import reference
from exact_chain import DIGITS, omega_of
from exact_roots import continuum
from exact_shapes import Mode
from mpmath import mpf

import ropedyn as rd

STORED = 1e-21
"""Relative: stored responses have 22 digits, frequencies 25."""
KNOWN = 1e-40
"""Relative to closed forms in 60 digits, at conditions far below 1e10."""
SPECTRA = reference("beam_spectra")["cases"]
L, MU, B, C, EA, P, J = 1.3, 0.1, 2.5, 0.75, 9e4, 1e-6, 2e-5


def decimal_beam(ends, tension, *dampings):
    """What `Continuum` reads of the beam of the reference files, in exact decimals."""
    length = mpf("1.35")
    numbers = ("axial_stiffness", "torsional_stiffness", "lay_coupling", "lay_slope")
    rope = SimpleNamespace(
        **dict.fromkeys((*numbers, "polar_inertia", "rotary_inertia")),
        length=length,
        linear_density=mpf("0.13725") / length,
        bending_stiffness=mpf("54.626"),
    )
    return SimpleNamespace(
        rope=rope,
        tension=tension,
        gravity=None,
        ends=(ends, ends),
        parts=(),
        dampings=dampings,
        coordinates=("z", "beta"),
    )


def spectrum(case):
    """A case of the reference file and its frequencies [Hz]."""
    tension = mpf(case["xi2"]) * mpf("54.626") / mpf("1.35") ** 2
    return continuum(decimal_beam(case["ends"], tension)), [mpf(f) for f in case["f"]]


def apart(values, exact):
    """Largest relative difference."""
    return max(float(abs(a / b - 1)) for a, b in zip(values, exact, strict=True))


@pytest.fixture(autouse=True)
def digits():
    with mpmath.workdps(DIGITS):
        yield


# stored ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("case", SPECTRA, ids=lambda c: f"{c['ends']} {c['xi2']}")
def test_roots_are_the_stored_frequencies_of_a_tensed_beam(case):
    exact, stored = spectrum(case)
    chosen = [stored[k] for k in (0, 1, 19)]
    found = [exact_roots.frequency(exact, f * (1 + mpf(10) ** -10)) for f in chosen]
    assert apart(found, chosen) < 1e-24


@pytest.mark.parametrize("case", SPECTRA[::4], ids=lambda c: f"{c['ends']} {c['xi2']}")
def test_count_is_that_of_the_stored_frequencies(case):
    exact, stored = spectrum(case)
    for k in (5, 20):
        high = omega_of(stored[k - 1] * mpf("1.01")) ** 2
        assert exact_roots.count(exact, -high, high) == k


@pytest.mark.parametrize("line", reference("frf_beam_exact")["lines"], ids=lambda c: c["f"][:6])
def test_responses_are_the_stored_ones_of_a_damped_tensed_beam(line):
    damping = SimpleNamespace(mass=0, stiffness=mpf("1e-4"))
    exact = continuum(decimal_beam("clamped", mpf(300), damping))
    points = [(c, x) for c in ("z", "beta") for x in line["x"]]
    stored = [mpmath.mpc(*pair) for pair in (*line["z"], *line["beta"])]
    found = exact.receptance(omega_of(mpf(line["f"])), ("z", "0.50625"), points)
    assert apart(found, stored) < STORED


# closed forms ------------------------------------------------------------------------------------


@pytest.mark.parametrize("f", [1e-3, 7.0, 1111.0])
@pytest.mark.parametrize(
    "damping", [None, rd.StiffnessDamping(1e-4), rd.RayleighDamping(3.0, 2e-5)]
)
def test_damped_rod_responds_as_its_wave(damping, f):
    # u(L) = tan(k L)/(EA g k), k^2 = -inertia mu/(EA g), g the factor on the section
    scene = rd.Scene(rd.Rope(L, MU, axial_stiffness=EA), ends=("clamped", "free"), damping=damping)
    omega, g, inertia = omega_of(f), mpf(1), -(omega_of(f) ** 2)
    if damping is not None:
        g = 1 + 1j * omega * mpf(getattr(damping, "gamma", 0) or damping.stiffness)
        inertia += 1j * omega * mpf(getattr(damping, "mass", 0))
    k = mpmath.sqrt(-inertia * mpf(MU) / (mpf(EA) * g))
    (h,) = continuum(scene, "x").receptance(omega, ("x", L), [("x", L)])
    assert apart([h], [mpmath.tan(k * mpf(L)) / (mpf(EA) * g * k)]) < KNOWN


@pytest.mark.parametrize(
    ("damping", "share"), [(rd.StiffnessDamping(1e-3), 0), (rd.RayleighDamping(0, 1e-3), 1)]
)
def test_only_rayleigh_damping_damps_the_tension_of_a_string(damping, share):
    # in the middle: tan(k L/2)/(2 T g k)
    omega = omega_of(33.0)
    scene = rd.Scene(rd.Rope(L, MU), tension=50.0, damping=damping)
    g = 1 + share * 1j * omega * mpf(1e-3)
    k = omega * mpmath.sqrt(mpf(MU) / (50 * g))
    (h,) = continuum(scene).receptance(omega, ("z", L / 2), [("z", L / 2)])
    assert apart([h], [mpmath.tan(k * mpf(L) / 2) / (100 * g * k)]) < KNOWN


@pytest.mark.parametrize("k", [1, 4])
def test_held_laid_rod_vibrates_in_sines(k):
    # lambda = (k pi/L)^2 times the eigenvalues of diag(mu, p)^-1 [[EA, D], [D, C]]
    D = -150.0
    rope = rd.Rope(
        L, MU, axial_stiffness=EA, torsional_stiffness=C, polar_inertia=P, lay_coupling=D
    )
    exact = continuum(rd.Scene(rope), "alpha")
    a, c, d = mpf(EA) / mpf(MU), mpf(C) / mpf(P), mpf(D) ** 2 / (mpf(MU) * mpf(P))
    half = mpmath.sqrt((a - c) ** 2 / 4 + d)
    for value in ((a + c) / 2 - half, (a + c) / 2 + half):
        closed = (k * mpmath.pi / mpf(L)) ** 2 * value
        assert (
            apart([exact_roots.eigenvalue(exact, closed * (1 + mpf(10) ** -9))], [closed]) < 1e-30
        )


@pytest.mark.parametrize(("slope", "tension"), [(0.02, 400.0), (-1.0, -5.0), (0.3, 0.0)])
def test_rope_whose_bending_twists_vibrates_in_sines(slope, tension):
    # z = Z sin q x, alpha = A cos q x between pins that let it turn: with K the inverse of the
    # section over (twist, bending), strain a = (q A, q^2 Z): a^T K a + T q^2 Z^2 against
    # p A^2 + (mu + j q^2) Z^2
    rope = rd.Rope(
        L,
        MU,
        bending_stiffness=B,
        torsional_stiffness=C,
        polar_inertia=P,
        rotary_inertia=J,
        lay_slope=slope,
    )
    pin = rd.End(alpha="free", beta="free")
    exact = continuum(rd.Scene(rope, tension=tension, ends=(pin, pin)))
    assert exact.coordinates == ("z", "alpha", "beta")
    H, b, c = mpf(slope), mpf(B), mpf(C)
    tt, tb, bb = ((c + H**2 * b), H * (c - b), (b + H**2 * c))
    tt, tb, bb = (x / (1 + H**2) for x in (tt, tb, bb))
    for k in (1, 4):
        q = k * mpmath.pi / mpf(L)
        mass = mpf(MU) + mpf(J) * q**2
        twist, bend = q**2 * tt / mpf(P), (q**4 * bb + mpf(tension) * q**2) / mass
        half = mpmath.sqrt((twist - bend) ** 2 / 4 + (q**3 * tb) ** 2 / (mpf(P) * mass))
        for closed in ((twist + bend) / 2 - half, (twist + bend) / 2 + half):
            found = exact_roots.eigenvalue(exact, closed * (1 + mpf(10) ** -9))
            assert apart([found], [closed]) < 1e-30
            # A/Z from the row of twist; fractions are sums of doubles
            ratio = q**3 * tb / (closed * mpf(P) - q**2 * tt)
            kinetic = mpf(P) * ratio**2 + mass
            shares = {"alpha": mpf(P) * ratio**2, "beta": mpf(J) * q**2, "z": mpf(MU)}
            shares["tension"] = mpf(tension) * q**2 / closed
            energy = Mode(exact, found).energy()
            assert all(abs(energy[c] - x / kinetic) < 1e-13 for c, x in shares.items())


def test_static_moment_of_a_tensed_cantilever():
    # M(x) = F sinh(kappa (L - x))/(kappa cosh(kappa L)), F_z is the load all along
    T = 1e6
    scene = rd.Scene(rd.Rope(L, MU, bending_stiffness=B), tension=T, ends=("clamped", "free"))
    kappa = mpmath.sqrt(mpf(T) / mpf(B))
    x = [0.0, 0.001, 0.1]
    moment = [mpmath.sinh(kappa * (mpf(L) - mpf(s))) / kappa for s in x]
    moment = [m / mpmath.cosh(kappa * mpf(L)) for m in moment]
    points = [("M_beta", s) for s in x] + [("F_z", s) for s in x]
    found = continuum(scene).receptance(mpf(0), ("z", L), points)
    assert apart(found, moment + [mpf(1)] * 3) < KNOWN


@pytest.mark.parametrize("stiffness", [0.0, 0.3, 1e6])
def test_hinge_adds_its_compliance(stiffness):
    # clamped, F in the middle: half of F on each cantilever and what the moment m closes:
    # m (1/k + L/B) = F L^2/8B by the jump of rotation, z = F L^3/48B - m L^2/8B
    rope = rd.Rope(2.0, MU, bending_stiffness=B)
    scene = rd.Scene(rope, parts=[rd.Hinge(1.0, stiffness=stiffness)])
    k, b = mpf(stiffness), mpf(B)
    moment = k * 4 / (8 * b) / (1 + k * 2 / b)
    z = 8 / (48 * b) - moment * 4 / (8 * b)
    found = continuum(scene).receptance(mpf(0), ("z", 1.0), [("z", 1.0), ("M_beta", 1.0)])
    # M > 0 bends upwards; a load in z bends the middle downwards
    assert apart(found[:1], [z]) < KNOWN
    assert abs(found[1] + moment) < KNOWN


def test_string_with_mass_and_spring_inside():
    # at x = a: T k (cot k a + cot k (L - a)) = m omega^2 - s
    T, a, m, s = 80.0, 0.4, 0.05, 120.0
    scene = rd.Scene(rd.Rope(L, MU), tension=T, parts=[rd.PointMass(a, m), rd.Spring(a, s)])

    def balance(omega):
        k = omega * mpmath.sqrt(mpf(MU) / T)
        cot = mpmath.cot(k * mpf(a)) + mpmath.cot(k * (mpf(L) - mpf(a)))
        return T * k * cot - mpf(m) * omega**2 + s

    first = mpmath.findroot(balance, 60)
    exact = continuum(scene)
    assert (
        apart([exact_roots.eigenvalue(exact, first**2 * (1 + mpf(10) ** -9))], [first**2]) < 1e-30
    )


def test_cluster_of_two_spans_about_a_heavy_mass():
    # antisymmetric: half the rope, clamped; symmetric: half the rope, its end on half the mass
    heavy = rd.PointMass(1.0, 1e9, rotary_inertia=1e9)
    rope = rd.Rope(2.0, MU, bending_stiffness=B)
    scene = rd.Scene(rope, tension=30.0)
    half = scene.replace(rope=rope.replace(length=1.0))
    body = rd.PointMass(1.0, 5e8, rotary_inertia=5e8)
    near = float(half.compile(elements=64).modes(1).eigenvalue[0])
    halves = [
        exact_roots.eigenvalue(
            continuum(half.replace(ends=("clamped", rd.End(**{c: "free"})), parts=[body])),
            near,
            1e-4,
        )
        for c in ("beta", "z")
    ]
    exact = continuum(scene.replace(parts=[heavy]))
    found = exact_roots.cluster(exact, halves[0], 1e-3)
    assert apart(found, sorted(halves)) < 1e-25
    assert 0 < found[1] / found[0] - 1 < 1e-6


def test_cluster_counts_repeated_eigenvalues():
    # two equal spans on a support, which a free hinge there parts: each is one span, pinned
    rope = rd.Rope(2.0, MU, bending_stiffness=B)
    parts = [rd.Hinge(1.0), rd.Support(1.0)]
    exact = continuum(rd.Scene(rope, ends=("pinned", "pinned"), parts=parts))
    closed = mpmath.pi**4 * mpf(B) / mpf(MU)
    assert apart(exact_roots.cluster(exact, closed * (1 + mpf(10) ** -5)), [closed] * 2) < 1e-25
    with pytest.raises(ValueError, match="simple"):
        exact_roots.eigenvalue(exact, closed)


# chains ------------------------------------------------------------------------------------------

WIDE = rd.Rope(
    L,
    MU,
    axial_stiffness=9e3,
    bending_stiffness=B,
    torsional_stiffness=C,
    polar_inertia=1e-5,
    rotary_inertia=J,
    lay_slope=0.3,
    lay_coupling=-40.0,
)
SPRUNG = rd.End(beta="free", x="free", spring={"beta": 5.0})
SCENES = {
    "every coupling, sprung, damped": rd.Scene(
        WIDE,
        tension=90.0,
        ends=(SPRUNG, "clamped"),
        damping=(rd.StiffnessDamping(1e-4), rd.RayleighDamping(2.0, 1e-5)),
        parts=[
            rd.PointMass(0.39, 0.02, rotary_inertia=1e-4, polar_inertia=1e-4),
            rd.Spring(0.65, 3.0, coordinate="alpha"),
        ],
    ),
    "compressed, hinged, supported": rd.Scene(
        rd.Rope(L, MU, bending_stiffness=B),
        tension=-4.0,
        ends=("clamped", "free"),
        parts=[rd.Hinge(0.65, stiffness=4.0), rd.Support(0.91), rd.Spring(0.39, 2e3)],
    ),
}


@pytest.mark.parametrize("name", SCENES)
def test_chains_converge_to_the_exact_response(name):
    # lumps of all coordinates are second order at least, also beside a hinge if the rope has no
    # rotary inertia: two doublings divide the error by 16
    scene, f = SCENES[name], 47.0
    points = [("z", 0.26), ("beta", 0.91), ("z", 1.04), ("beta", 0.39)]
    if "alpha" in scene.coordinates:
        points += [("alpha", 0.26), ("x", 1.04)]
    exact = continuum(scene).receptance(omega_of(f), ("z", 0.26), points)
    errors = []
    for n in (400, 1600):
        model = scene.compile(elements=n, element="tensed")
        value = model.frf(f, drive=("z", 0.26), response=points).value[:, 0]
        errors.append(
            [abs(complex(v) - complex(h)) / abs(complex(h)) for v, h in zip(value, exact)]
        )
    coarse, fine = np.array(errors)
    assert (fine < 1e-4).all()
    # 12: terms of higher order; 1e-9: what has converged further has no order to show
    assert ((fine < coarse / 12) | (fine < 1e-9)).all()


@pytest.mark.parametrize("name", SCENES)
def test_modes_of_chains_converge_to_the_exact_ones(name):
    # second order at least: with 400 elements 1e-4 of an eigenvalue and some times that of shapes
    scene = SCENES[name]
    found = scene.compile(elements=400, element="tensed").modes(2)
    exact = continuum(scene)
    for k in range(2):
        root = exact_roots.eigenvalue(exact, float(found.eigenvalue[k]), 1e-3)
        assert abs(float(found.eigenvalue[k] / root) - 1) < 2e-4
        mode = Mode(exact, root)
        places = [
            (a + (b - a) * j / 8) for a, b in itertools.pairwise(mode.stations) for j in range(8)
        ]
        at = [int(np.abs(found.x - x).argmin()) for x in [*places, scene.rope.length]]
        shape, chain = mode.shape(8), found.shape[k, at]
        chain = chain / chain[:, 1 if "x" in scene.coordinates else 0].max()
        own = shape[:, 1 if "x" in scene.coordinates else 0].max()
        assert (np.abs(chain - shape / own).max(axis=0) <= 1e-3 * np.abs(chain).max(axis=0)).all()
        for name_, fraction in mode.energy().items():
            assert abs(found.energy.get(name_, np.zeros(2))[k] - fraction) < 1e-3
