"""Forces and responses between the nodes of a chain: what elements give by themselves there."""

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

import ropedyn as rd

LENGTH, TENSION, ELEMENTS = 1.3, 2000.0, 8
BENT = rd.Rope(LENGTH, 0.25, bending_stiffness=5.0, rotary_inertia=1e-5)
STRING = rd.Rope(LENGTH, 0.25)
NODE, INSIDE = 0.325, 0.437
FORCE = rd.Sine(3.0, 47.0)
DASHPOT = rd.Dashpot(0.65, 30.0)
HARDENING = rd.NodeForce(0.65, lambda t, u, v: -2e7 * u**3)
STILL = rd.Tension(TENSION, amplitude=1e-9, frequency=50.0)


def chain(rope, tension=TENSION, element="tensed", **scene):
    return rd.Scene(rope, tension=tension, **scene).compile(elements=ELEMENTS, element=element)


@pytest.mark.parametrize("element", ["tensed", "rigid"])
@pytest.mark.parametrize(
    ("drive", "response"),
    [
        (("z", NODE), ("z", INSIDE)),
        (("z", NODE), ("beta", INSIDE)),
        (("z", INSIDE), ("z", NODE)),
        (("beta", INSIDE), ("z", NODE)),
    ],
    ids=str,
)
def test_a_tension_that_hardly_pulsates_moves_points_as_one_that_does_not(element, drive, response):
    """Points inside tensed elements moved as those of untensed ones: 0.4 to 2.7 % off."""
    time = np.linspace(0.0, 0.06, 601)
    still, pulsating = (
        chain(BENT, tension, element).transient(
            time, drive=drive, force=FORCE, response=response, tolerance=1e-6
        )
        for tension in (TENSION, STILL)
    )
    assert (still.cost.method, pulsating.cost.method) == ("modal", "collocation")
    most = np.abs(still.value).max()
    assert np.abs(still.value - pulsating.value).max() < 1e-11 * most  # measured: 4e-13


LAID = rd.Rope(
    1.1,
    0.1,
    torsional_stiffness=0.21,
    axial_stiffness=4.1e5,
    lay_coupling=95.0,
    polar_inertia=2.2e-7,
)
TWISTS = rd.Dashpot(0.55, 1e-3, coordinate="alpha")


@pytest.mark.parametrize(
    ("model", "drives"),
    [
        (chain(STRING, parts=[DASHPOT]), [("z", INSIDE)]),
        (chain(STRING, parts=[HARDENING]), [("z", INSIDE)]),
        (chain(STRING, parts=[DASHPOT], damping=rd.RayleighDamping(3.0, 1e-4)), [("z", INSIDE)]),
        (chain(BENT, parts=[DASHPOT]), [("z", INSIDE), ("beta", INSIDE - 0.02)]),
        (chain(BENT, parts=[HARDENING]), [("beta", INSIDE)]),
        (chain(LAID, parts=[TWISTS]), [("alpha", 0.5), ("alpha", 0.53)]),
    ],
    ids=["string", "law", "lags", "beam", "law of a beam", "twist"],
)
def test_energy_is_the_work_of_what_drives_between_nodes(model, drives):
    """It missed what the element gives by itself: 1 to 10 % of the input, and of the strain."""
    time = np.linspace(0.0, 0.06, 6001)
    forces = [rd.Sine(0.02 * (k + 1), 47.0 + 20.0 * k) for k in range(len(drives))]
    forces[0] = forces[0] if drives[0][0] != "z" else FORCE
    history = model.transient(
        time, drive=drives, force=forces, response=drives, quantity="velocity", tolerance=1e-4
    )
    power = sum(force.value(time) * v for force, v in zip(forces, history.value))
    work = cumulative_simpson(power, x=time, initial=0.0)
    e, most = history.energy, np.abs(work).max()
    assert np.abs(e["input"] - work).max() < 1e-4 * most  # measured: 2e-6 to 2.1e-5
    kept = sum(e[name] for name in e if name != "input")
    assert np.abs(kept - e["input"]).max() < 1e-4 * most


@pytest.mark.parametrize("part", [rd.Spring(0.65, 1e3), rd.Dashpot(0.65, 1.0, exponent=2.0)])
def test_energy_of_tensed_beams_is_told_where_modes_move_them_as_they_move(part):
    """Sections alone are damped: 5e-3 of the input was wrong without a word."""
    time = np.linspace(0.0, 0.06, 3001)
    drive, force = ("beta", NODE), rd.Sine(0.3, 47.0)
    asked = {"drive": drive, "force": force, "response": drive, "quantity": "velocity"}
    for gamma in (1e-5, 1e-3):
        model = chain(BENT, parts=[part], damping=rd.StiffnessDamping(gamma))
        history = model.transient(time, **asked)
        if gamma == 1e-3:
            with pytest.raises(rd.SolveError, match=r"energy is known to .*e-02 only"):
                history.energy["input"]
            continue
        work = cumulative_simpson(force.value(time) * history.value[0], x=time, initial=0.0)
        off = np.abs(history.energy["input"] - work).max()
        assert off < 1e-3 * np.abs(work).max()  # measured: 5e-5
        rigid = chain(BENT, parts=[part], damping=rd.StiffnessDamping(1e-3), element="rigid")
        assert rigid.transient(time, **asked).energy["input"].any()


@pytest.mark.parametrize(
    ("tension", "damping"),
    [
        (rd.Tension(TENSION, amplitude=100.0, frequency=60.0), None),
        (TENSION, rd.StiffnessDamping(1e-4)),
    ],
    ids=["varies", "sections alone lag"],
)
def test_energy_between_nodes_is_refused_where_the_element_gives_way_to_more(tension, damping):
    model = chain(BENT, tension, parts=[DASHPOT], damping=damping)
    time = np.linspace(0.0, 0.01, 11)
    asked = {"force": FORCE, "response": ("z", 0.65)}
    with pytest.raises(rd.SceneError, match=r"drive must be at nodes for energy .*\('z', 0.437\)"):
        model.transient(time, drive=("z", INSIDE), **asked).energy["input"]
    assert model.transient(time, drive=("z", NODE), **asked).energy["input"].any()


@pytest.mark.parametrize("part", [DASHPOT, HARDENING])
def test_energy_of_spans_that_steps_would_tell_is_refused(part):
    """Between the nodes of spans it was a bare error about lumps."""
    model = rd.Scene(STRING, tension=TENSION, parts=[part]).compile()
    history = model.transient(np.linspace(0.0, 0.01, 11), drive=("z", INSIDE), force=FORCE)
    with pytest.raises(rd.SceneError, match="elements must be given where steps follow all modes"):
        _ = history.energy


def test_a_law_beside_drag_that_inertia_of_turning_has_none_of_moves_nothing():
    """What rounding leaves of motion that is 0 by symmetry ended the run."""
    time = np.linspace(0.0, 0.06, 301)
    nothing = rd.NodeForce(0.65, lambda t, u, v: 0.0 * u)
    plain, beside = (
        chain(BENT, damping=rd.ViscousDamping(1.0), parts=parts).transient(
            time, drive=("z", NODE), force=FORCE, response=("z", NODE), tolerance=1e-6
        )
        for parts in ([], [nothing])
    )
    assert beside.cost.method == "collocation"
    most = np.abs(plain.value).max()
    assert np.abs(plain.value - beside.value).max() < 5e-8 * most  # measured: 8e-10
