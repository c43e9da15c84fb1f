"""Friction between wires in steady motion: time integration, limits, energy, what is refused."""

import numpy as np
import pytest
from scipy.integrate import quad

import ropedyn as rd
from ropedyn.response.friction import cells, solve
from ropedyn.response.friction.balance import Layers, SlipBalance
from ropedyn.response.friction.loops import harmonics, loops
from ropedyn.scene.construction.friction import Grip

MADE = rd.Construction.standard("1x19", diameter=20e-3)
SECTION = MADE.section()
FRICTION = SECTION.wire_friction(0.3)
LENGTH, TENSION, DRIVE = 6.0, 30e3, ("z", 1.8)
ROPE = rd.Rope.from_construction(
    LENGTH,
    MADE,
    rotary_inertia=None,
    polar_inertia=None,
    axial_stiffness=None,
    torsional_stiffness=None,
    lay_coupling=None,
)
DRAG = 10.0
RUBBING = rd.Scene(
    ROPE,
    tension=TENSION,
    ends=("pinned", "pinned"),
    damping=(FRICTION, rd.ViscousDamping(DRAG)),
)
STUCK = RUBBING.without("wire friction")


def first_curve(curvature):
    """Return the moment of a layer of stiffness 1 that slips from the curvature 1."""
    return Grip(np.ones(1), np.ones(1)).moment(np.asarray(curvature))


def sliders(count):
    """Return stiffness and slip of sliders in parallel whose first curve is that of a layer."""
    edge = np.linspace(1.0, np.pi / 2, count + 1)
    slope = np.diff(first_curve(edge)) / np.diff(edge)
    return -np.diff(np.concatenate([[1.0], slope, [0.0]])), edge


def marched(frequency, force, *, cycles=100, modes=14, parts=56, count=16):
    """Integrate the modes of a pinned rope with sliders in each part; return what is steady.

    An independent way: sines as shapes, time steps, and sliders that stick or give way, for several
    frequencies and forces at once. What higher modes add is that of the rope that sticks.
    """
    f, F = np.broadcast_arrays(np.asarray(frequency, float), np.asarray(force, float))
    k = np.arange(1, modes + 1) * np.pi / LENGTH
    mass, h = ROPE.linear_density, LENGTH / parts
    steps = int(
        np.ceil(
            np.sqrt((TENSION + SECTION.bending_stick * k[-1] ** 2) / mass) * k[-1] / (0.5 * f.min())
        )
    )
    dt = 1 / (f * steps)[:, None]
    edge = np.linspace(0, LENGTH, parts + 1)
    bent = np.diff(np.cos(np.outer(edge, k)), axis=0) * k / h
    soft, slip = sliders(count)
    stiffness = np.concatenate([b * soft for b in FRICTION.stiffness])
    limit = np.concatenate([TENSION * first * slip for first in FRICTION.slip])
    omega2 = (TENSION * k**2 + SECTION.bending_slip * k**4) / mass
    push = 2 / (mass * LENGTH) * F[:, None] * np.sin(k * DRIVE[1])
    q, v = np.zeros((2, len(f), modes))
    held, before = np.zeros((len(f), parts, len(limit))), np.zeros((len(f), parts))
    value = np.zeros(len(f), dtype=complex)
    brake = DRAG / mass * dt / 2
    for n in range(cycles * steps):
        kappa = q @ bent.T
        held = np.clip(held + (kappa - before)[..., None], -limit, limit)
        before = kappa
        if n >= (cycles - 1) * steps:
            value += (q @ np.sin(k * DRIVE[1])) * np.exp(-2j * np.pi * n / steps)
        torque = 2 / (mass * LENGTH) * h * (held @ stiffness) @ bent
        rate = push * np.cos(2 * np.pi * n / steps) - omega2 * q - torque
        v = (v * (1 - brake) + dt * rate) / (1 + brake)
        q = q + dt * v
    higher = np.arange(modes + 1, 400) * np.pi / LENGTH
    stiff = (TENSION * higher**2 + SECTION.bending_stick * higher**4) * LENGTH / 2
    return 2 / steps * value / F + (np.sin(higher * DRIVE[1]) ** 2 / stiff).sum()


def asked(scene, frequency, force, **how):
    """Return the answers one by one, as each force asks."""
    model = scene.compile()
    pairs = zip(*np.broadcast_arrays(np.atleast_1d(frequency), force))
    return [model.frf([f], drive=DRIVE, amplitude=F, **how) for f, F in pairs]


def test_a_rope_moves_as_one_that_is_integrated_over_time():
    f, F = np.array([9.0, 10.0, 10.45, 10.45, 11.0]), np.array([400.0, 100.0, 100.0, 400.0, 400.0])
    # 10 modes, 40 parts, 10 sliders and 60 periods differ by 1e-3 from more of each; the third
    # harmonic that is left out moves the first by 0.2 to 1 %
    exact = marched(f, F, cycles=60, modes=10, parts=40, count=10)
    found = asked(RUBBING, f, F)
    off = np.array([abs(one.value[0, 0] / true - 1) for one, true in zip(found, exact)])
    assert off.max() < 0.011
    assert (off < [one.rounding_error[0, 0] for one in found]).all()
    stuck = STUCK.compile().frf(f, drive=DRIVE).value[0]
    assert abs(stuck / exact - 1).max() > 0.07


@pytest.mark.slow
@pytest.mark.claim(
    "Response with friction between wires: 24 random forces and frequencies about the resonance",
    reference="time integration of modes and sliders in parallel in each part of the rope",
    accepted=1.0,
)
def test_random_ropes_move_as_they_do_over_time(claim):
    random = np.random.default_rng(2024)
    f, F = random.uniform(8.5, 13.0, 24), np.exp(random.uniform(np.log(20), np.log(600), 24))
    exact = marched(f, F, cycles=100, modes=12, parts=48, count=12)
    found = asked(RUBBING, f, F)
    off = np.array([abs(one.value[0, 0] / true - 1) for one, true in zip(found, exact)])
    # per estimated error, and what the integration itself is off by where nothing slips
    told = np.array([one.rounding_error[0, 0] for one in found])
    claim((off / (told + 1e-3)).max())


def test_small_motion_sticks_and_large_motion_slides():
    f = np.linspace(8.0, 24.0, 9)
    small = RUBBING.compile().frf(f, drive=DRIVE, amplitude=1e-3)
    assert abs(small.value / STUCK.compile().frf(f, drive=DRIVE).value - 1).max() < 1e-12
    assert not small.loss_factor.any() and not small.third_harmonic.any()
    large = RUBBING.compile().frf(f, drive=DRIVE, amplitude=1e7)
    slid = STUCK.replace(rope=ROPE.replace(bending_stiffness=SECTION.bending_slip))
    exact = slid.compile().frf(f, drive=DRIVE).value
    # moments of layers that slip are constant: they go down as 1/amplitude; cells stay
    off = abs(large.value / exact - 1)
    assert off.max() < 0.01
    assert (off < large.rounding_error).all()


def test_what_the_drive_gives_is_what_cells_lose():
    f, F = np.linspace(9.0, 12.0, 7), 200.0
    scene = RUBBING.replace(damping=FRICTION)
    found = scene.compile().frf(f, drive=DRIVE, amplitude=F)
    given = -np.pi * F**2 * found.value[0].imag
    lost = np.pi * found.bending_stiffness * found.loss_factor * found.curvature**2
    assert abs((np.diff(found.x) @ lost) / given - 1).max() < 1e-6


def test_the_equivalent_loss_is_the_loop_of_the_section():
    kappa = np.array([1e-3, 0.02, 0.3, 5.0])
    stiffness, first = (np.tile(v, (4, 1)) for v in (FRICTION.stiffness, FRICTION.slip))
    found = loops(stiffness, TENSION * first, kappa)
    loss = SECTION.loss(kappa, tension=TENSION, friction=0.3)
    B = SECTION.bending(kappa, tension=TENSION, friction=0.3)
    # the spline between 1500 amplitudes
    assert abs(found.first.imag - loss * B).max() < 2e-5 * SECTION.bending_stick


@pytest.mark.parametrize("u", [1.0001, 1.3, 1.7, 4.0, 300.0])
@pytest.mark.parametrize("k", [1, 3])
def test_harmonics_are_those_of_masings_loop(u, k):
    def moment(t):
        return float((first_curve([u]) - 2 * first_curve([u * np.sin(t / 2) ** 2]))[0])

    bends = [2 * np.arcsin(np.sqrt(one / u)) for one in (1.0, np.pi / 2) if one < u]
    how = {"points": bends, "limit": 200, "epsrel": 1e-10}
    even, _ = quad(lambda t: moment(t) * np.cos(k * t), 0, np.pi, **how)
    odd, _ = quad(lambda t: moment(t) * np.sin(k * t), 0, np.pi, **how)
    exact = 2 / np.pi * (even - 1j * odd) / u
    place = (k - 1) // 2
    # of the rules: 24 points where the loop bends as (u - 1)^1.5
    assert abs(harmonics(np.array([u]))[0, place] - exact) < 1e-8
    spline = loops(np.ones((1, 1)), np.ones((1, 1)), np.array([u]))
    assert abs((spline.first, spline.third)[place][0] - exact) < 2e-5


def test_smaller_cells_change_it_by_less_than_is_told(monkeypatch):
    f, F = np.array([9.5, 10.5, 21.0, 40.0]), 300.0
    scene = RUBBING.replace(ends=("clamped", "clamped"))
    found = scene.compile().frf(f, drive=DRIVE, amplitude=F)
    told = found.rounding_error[0] - found.third_harmonic
    for name in ("FIRST", "GROWTH", "WAVE"):
        monkeypatch.setattr(cells, name, getattr(cells, name) / 3)
    finer = scene.compile().frf(f, drive=DRIVE, amplitude=F)
    off = abs(finer.value[0] / found.value[0] - 1)
    assert (off < told).all() and told.max() < 0.03
    assert len(finer.x) > 2 * len(found.x)


def test_the_moment_at_a_clamp_is_in_balance():
    # of a cantilever at rest: force times length less tension times deflection, whatever slips
    scene = RUBBING.replace(ends=("clamped", "free"), damping=FRICTION)
    response = [("z", LENGTH), ("M_beta", 0.0)]
    for force in (1.0, 500.0):
        drive = {"drive": ("z", LENGTH), "amplitude": force}
        z, M = scene.compile().frf([0.0], response=response, **drive).value[:, 0]
        # the balance of cells: rounding of H, and where their mean is not the clamp
        assert abs(abs(M) - abs(LENGTH - TENSION * z)) < 0.02 * abs(M)


def test_a_softer_stretch_has_softer_layers():
    soft = RUBBING.replace(parts=[rd.LocalChange(0.0, LENGTH, bending=0.5)])
    half = rd.WireFriction([b / 2 for b in FRICTION.stiffness], FRICTION.slip)
    other = RUBBING.replace(
        rope=ROPE.replace(bending_stiffness=ROPE.bending_stiffness / 2),
        damping=(half, rd.ViscousDamping(DRAG)),
    )
    values = [
        one.compile().frf([10.4], drive=DRIVE, amplitude=200.0).value for one in (soft, other)
    ]
    # its cells are another's, for the sliding rope is softer: as told
    told = asked(soft, 10.4, 200.0)[0]
    assert abs(values[0] / values[1] - 1) < told.rounding_error - told.third_harmonic


def test_stepped_sine_is_the_same_and_ends_may_move():
    model, f = RUBBING.compile(), [9.0, 10.4]
    one = model.frf(f, drive=DRIVE, amplitude=100.0, quantity="mobility")
    two = model.stepped_sine(f, drive=DRIVE, amplitude=100.0, quantity="mobility")
    assert one.value.tolist() == two.value.tolist() and two.stable is None
    clamped = RUBBING.replace(ends=("clamped", "clamped"))
    moved = {"drive": ("end", 0, "beta"), "response": DRIVE, "amplitude": 1e-9}
    found = clamped.compile().frf(f, **moved)
    exact = (
        clamped.without("wire friction").compile().frf(f, drive=("end", 0, "beta"), response=DRIVE)
    )
    assert abs(found.value / exact.value - 1).max() < 1e-9
    assert abs(clamped.compile().frf(f, **moved | {"amplitude": 0.05}).loss_factor).max() > 0.1


def test_other_steady_motion_is_said():
    # one cell that takes energy: 1 + G g passes 0, and three amplitudes balance the drive
    layers = Layers(np.ones((1, 1)), np.ones((1, 1)))
    several = SlipBalance(layers, np.array([1.0 + 0j]), np.array([[1.2 + 0.25j]])).found(
        [], alone=False
    )
    assert several is not None and several.several
    passive = SlipBalance(layers, np.array([1.0 + 0j]), np.array([[0.3 - 0.1j]]))
    assert not passive.found([], alone=False).several


def test_motion_that_is_not_found_is_an_error(monkeypatch):
    monkeypatch.setattr(SlipBalance, "found", lambda *_, **__: None)
    with pytest.raises(rd.SolveError, match=r"frequency 9.0 Hz: no steady motion was found"):
        asked(RUBBING, 9.0, 1.0)


def test_an_undamped_resonance_at_three_times_the_frequency_is_said():
    scene = RUBBING.replace(damping=FRICTION)
    f = STUCK.compile().modes(2).frequency[1] / 3
    found = scene.compile().frf([f, f + 0.5], drive=DRIVE, amplitude=100.0)
    assert found.third_harmonic[0] > 0.05 or np.isinf(found.third_harmonic[0])
    assert np.isfinite(found.third_harmonic[1])


def test_an_answer_survives_its_file(tmp_path):
    found = asked(RUBBING, 10.0, 200.0)[0]
    found.save(tmp_path / "found.nc")
    again = rd.load(tmp_path / "found.nc")
    assert isinstance(again, rd.FrictionResponse)
    assert again.loss_factor.tolist() == found.loss_factor.tolist()
    assert again.drive_amplitude == 200.0
    assert "mean loss factor" in found.table().columns
    with pytest.raises(rd.SceneError, match="derivative must be of a linear scene"):
        found.derivative("tension")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"planes": "both"}, 'planes must be "z" where there is friction'),
        ({"rope": ROPE.replace(bending_stiffness=50.0)}, "bending_stiffness must be that of wires"),
        ({"damping": (FRICTION, rd.ModalDamping(0.01))}, "no ModalDamping, got a ModalDamping"),
        ({"damping": (FRICTION, FRICTION)}, "got 2 of it"),
    ],
)
def test_scenes_without_meaning_are_refused(changes, message):
    with pytest.raises(rd.SceneError, match=message):
        RUBBING.replace(**changes)


@pytest.mark.parametrize(
    ("changes", "how", "message"),
    [
        ({}, {"amplitude": None}, r"amplitude must be given with friction .* \[N\], got None"),
        ({}, {"amplitude": 0.0}, "amplitude must be a finite number > 0"),
        ({}, {"drive": [DRIVE, DRIVE]}, "drive must be one point"),
        ({}, {"decay": 1.0}, "decay must be 0.0 with friction between wires, got 1.0"),
        ({}, {"solver": "band"}, "solver must be 'sweep'"),
        ({}, {"harmonic": 2}, "harmonic must be 1"),
        (
            {"tension": rd.Tension(3e4, amplitude=9.0, frequency=5.0)},
            {},
            "tension must be constant",
        ),
        ({"parts": [rd.Hinge(2.0)]}, {}, "parts must not hold a hinge"),
        ({"parts": [rd.Stop(2.0, 1e3)]}, {}, r"parts\[0\].* nothing else may be nonlinear"),
        ({"gravity": rd.Gravity(inclination=0.3)}, {}, "gravity must not change the tension"),
    ],
)
def test_what_is_not_known_with_friction_is_refused_by_name(changes, how, message):
    given = {"drive": DRIVE, "amplitude": 10.0} | how
    with pytest.raises(rd.SceneError, match=message):
        RUBBING.replace(**changes).compile().frf([9.0], **given)


def test_a_drive_that_bends_nothing_is_refused_and_one_on_a_support_moves_nothing():
    twisting = RUBBING.replace(rope=ROPE.replace(torsional_stiffness=30.0, polar_inertia=1e-4))
    with pytest.raises(rd.SceneError, match="drive must bend the rope"):
        twisting.compile().frf([9.0], drive=("alpha", 2.0), amplitude=1.0)
    held = RUBBING.compile().frf([9.0], drive=("z", 0.0), amplitude=1.0)
    assert held.value[0, 0] == 0 and held.third_harmonic[0] == 0
    assert held.mean_bending_stiffness[0] == pytest.approx(SECTION.bending_stick, rel=1e-12)


def test_chains_are_refused():
    with pytest.raises(rd.SceneError, match="elements must be left out with friction"):
        RUBBING.compile(elements=8).frf([9.0], drive=DRIVE, amplitude=1.0)


@pytest.mark.parametrize(
    "ask",
    [
        lambda model: model.modes(2),
        lambda model: model.modes(2, damped=True),
        lambda model: model.count(below=20.0),
        lambda model: model.static({DRIVE: 1.0}),
        lambda model: model.transient([0.0, 0.1], start={DRIVE: 1.0}),
        lambda model: model.floquet(),
        lambda model: model.stability_map([1.0, 2.0], [0.0, 1.0]),
        lambda model: rd.identify(model.scene, rd.Peaks([10.4, 21.1]), ["tension"], ends="given"),
        lambda model: rd.compare(model, rd.Peaks([10.4, 21.1])),
    ],
)
def test_other_verbs_refuse_friction_and_say_what_to_ask(ask):
    with pytest.raises(rd.SceneError, match="friction between wires") as told:
        ask(RUBBING.compile())
    assert 'scene.without("wire friction")' in str(told.value)


def test_branches_of_it_are_refused():
    with pytest.raises(rd.SceneError, match="branches must be False with friction"):
        RUBBING.compile().stepped_sine([9.0, 10.0], drive=DRIVE, amplitude=1.0, branches=True)


def test_cells_beyond_number_are_refused():
    with pytest.raises(rd.SceneError, match="frequency must be so low"):
        RUBBING.compile().frf([1e6], drive=DRIVE, amplitude=1.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (([1.0, 0.0], [1.0, 1.0]), r"stiffness\[1\] must be a finite number > 0"),
        (([1.0, 2.0], [1.0]), "slip must hold a number for each of the 2 layers"),
        (([1.0], [-1.0]), r"slip\[0\] must be a finite number >= 0"),
    ],
)
def test_layers_without_meaning_are_refused(given, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.WireFriction(*given)


def test_a_wire_alone_has_nothing_that_slips():
    with pytest.raises(rd.SceneError, match="must have a layer whose wires could slip"):
        rd.Construction(core=rd.Wire(2e-3)).section().wire_friction(0.2)
    assert solve.BLOCK > 1
