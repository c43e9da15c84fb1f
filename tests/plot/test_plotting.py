"""Plots: axes in, axes out, labels with units, no window and no pyplot."""

import subprocess
import sys

import numpy as np
import pytest
from made_history import decaying, made
from matplotlib.figure import Figure

import ropedyn as rd
from ropedyn.plot.figure import PALETTE

NAMES = ["modes", "frf", "static", "compare", "peaks", "resonances", "accuracy", "effects"]
NAMES += ["history", "spectrum", "ring-down", "measured"]
TIME = np.linspace(0.0, 1.0, 200)
HISTORY = made(TIME, decaying(TIME, (20.0, 0.01, 1.0)), force=rd.Sine(3.0, 20.0).value(TIME))


@pytest.fixture(scope="module")
def model():
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.2, polar_inertia=1e-6)
    return rd.Scene(rope, tension=100.0, damping=rd.StiffnessDamping(1e-4)).compile(elements=16)


@pytest.fixture(scope="module")
def answers(model):
    frf = model.frf(np.linspace(1, 200, 400), drive=("z", 0.3), response=[("z", 0.5)])
    return {
        "modes": (model.modes(3), "position along the rope [m]", "transverse displacement [m]"),
        "frf": (frf, "frequency [Hz]", "receptance, amplitude [m/N]"),
        "static": (
            model.static({("z", 0.5): 1.0}),
            "position along the rope [m]",
            "share of the largest [1]",
        ),
        "compare": (rd.compare(model, rd.Peaks([20.0])), "measured [Hz]", "calculated [Hz]"),
        "peaks": (rd.Peaks([20.0]), "frequency [Hz]", ""),
        "accuracy": (
            rd.accuracy_cost(model.scene, rd.ask.modes(2), elements=8, repeat=1),
            "time from the scene to the answer",
            "largest relative error [1]",
        ),
        "effects": (
            rd.effect_cost(model.scene, rd.ask.modes(2), repeat=1),
            "largest change of frequency without the effect [Hz]",
            "",
        ),
        "history": (HISTORY, "time [s]", "displacement [m]"),
        "spectrum": (HISTORY.spectrum(), "frequency [Hz]", "displacement, amplitude [m]"),
        "ring-down": (HISTORY.ring_down(since=0.0), "frequency [Hz]", "damping ratio [%]"),
        "measured": (HISTORY.frf(), "frequency [Hz]", "receptance, amplitude [m/N]"),
        "resonances": (frf.peaks()[0], "frequency [Hz]", "amplitude of z at 0.500 m [m/N]"),
    }


@pytest.mark.parametrize("name", NAMES)
def test_plot_returns_labelled_axes(answers, name):
    answer, xlabel, ylabel = answers[name]
    ax = answer.plot()
    assert (ax.get_xlabel(), ax.get_ylabel()) == (xlabel, ylabel)
    assert ax.get_title()


@pytest.mark.parametrize("name", NAMES)
def test_plot_draws_into_given_axes(answers, name):
    ax = Figure().subplots()
    assert answers[name][0].plot(ax) is ax
    assert ax.lines or ax.collections or ax.patches


def test_curves_of_a_plot_are_the_values(model):
    frf = model.frf([10.0, 20.0, 30.0], drive=("z", 0.3))
    line = frf.plot().lines[0]
    assert line.get_ydata().tolist() == np.abs(frf.value[0]).tolist()
    assert line.get_label() == "z at 0.300 m [m/N]"


def test_modes_plot_another_coordinate(model):
    ax = model.modes(2).plot(coordinate="beta")
    assert ax.get_ylabel() == "bending rotation [rad]"
    with pytest.raises(rd.SceneError, match="coordinate must be one of"):
        model.modes(2).plot(coordinate="x")


def test_a_motion_over_time_is_plotted_with_its_units():
    line = HISTORY.plot().lines[0]
    assert line.get_xydata().tolist() == np.column_stack([TIME, HISTORY.value[0]]).tolist()
    assert line.get_label() == "z at 0.100 m [m]"


def test_snapshots_are_lines_along_the_rope():
    ax = HISTORY.plot_snapshots(coordinate="beta")
    assert ax.get_ylabel() == "bending rotation [rad]"
    first, second = (line.get_xydata().tolist() for line in ax.lines[:2])
    assert first == np.column_stack([HISTORY.x, HISTORY.snapshot[0, :, 1]]).tolist()
    assert second == np.column_stack([HISTORY.x, HISTORY.snapshot[1, :, 1]]).tolist()
    assert HISTORY.plot_snapshots(ax) is ax
    with pytest.raises(rd.SceneError, match="coordinate must be one of"):
        HISTORY.plot_snapshots(coordinate="x")
    nothing = made(TIME, HISTORY.value, snapshot_time=[], snapshot=np.zeros((0, 3, 2)))
    with pytest.raises(rd.SceneError, match="snapshots must have been asked for"):
        nothing.plot_snapshots()


def test_plotting_needs_no_pyplot():
    code = (
        "import sys, ropedyn as rd;"
        "m = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8);"
        "m.modes(2).plot();"
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_phases_stand_below_and_no_line_crosses_where_they_go_around():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(1.0))
    frf = scene.compile().frf(np.linspace(1.0, 100.0, 500), drive=("z", 0.3), response=("z", 0.8))
    upper, lower = frf.plot(phase=True).figure.axes
    assert (upper.get_ylabel(), lower.get_ylabel()) == (
        "receptance, amplitude [m/N]",
        "phase [degrees]",
    )
    (line,) = lower.lines
    steps = np.abs(np.diff(line.get_ydata()))
    around = np.abs(np.diff(np.degrees(np.angle(frf.value[0])))) > 180.0
    assert around.any()
    assert np.isnan(steps).sum() == 2 * around.sum()
    assert np.nanmax(steps) < 180.0
    with pytest.raises(rd.SceneError, match="grid of subplots"):
        frf.plot(Figure().add_axes((0.0, 0.0, 1.0, 1.0)), phase=True)


def test_ends_do_not_hide_what_a_loss_changes_between_them():
    modes = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1e-3), tension=100.0).compile().modes(3)
    damage = modes.damage()
    ax = damage.plot()
    shown = ax.collections[0].get_clim()[1]
    value = np.abs(damage.change["bending_stiffness"])
    middle = (damage.edge[1:] + damage.edge[:-1]) / 2
    assert shown == value[:, (middle > 0.05) & (middle < 0.95)].max()
    assert value.max() > 10 * shown


def test_colours_are_those_that_the_colour_blind_tell_apart(model):
    frf = model.frf([1.0, 2.0], drive=("z", 0.5), response=[("z", 0.3)] * 2)
    assert [line.get_color() for line in frf.plot().lines] == list(PALETTE[:2])


def test_phases_of_a_comparison_cross_no_figure():
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ViscousDamping(1.0))
    point = {"drive": ("z", 0.3), "response": ("z", 0.8)}
    frf = scene.compile().frf(np.linspace(1.0, 100.0, 500), **point)
    measured = rd.Measured(frf.frequency, frf.value, **point)
    ax = rd.compare(scene.compile(), measured).plot(of="phase")
    (line,) = [one for one in ax.lines if one.get_linestyle() == "-"]
    steps = np.abs(np.diff(line.get_ydata()))
    assert np.nanmax(steps) <= 180.0 < np.ptp(np.degrees(np.angle(frf.value)))


def test_names_of_tongues_stand_apart():
    scene = rd.Scene(
        rd.Rope(1.0, 0.1, bending_stiffness=2.0), tension=1000.0, ends=("pinned", "clamped")
    )
    ax = scene.compile().stability_map(np.linspace(80.0, 700.0, 50), [0.0, 300.0]).plot()
    at = np.sort([text.xy[0] for text in ax.texts])
    assert len(at) > 3
    assert np.diff(at).min() >= 0.0199 * 620.0


def test_edges_of_growth_stand_beside_their_orders():
    mapped = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
    mapped = mapped.stability_map([40.0, 110.0], [0.0], modes=1)
    edges = mapped.boundary(100.0)
    ax = edges.plot()
    assert np.array_equal(ax.lines[0].get_xydata().T, [edges.frequency, edges.order])
    assert ax.get_xlabel() == "frequency of the tension [Hz]"
    assert [text.get_text() for text in mapped.boundary(0.0).plot().texts] == [
        "nowhere between the frequencies of the map"
    ]


def test_a_legend_beside_many_curves_leaves_them_room(model):
    ax = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile().modes(40).plot()
    names = [text.get_text() for text in ax.get_legend().get_texts()]
    assert len(names) == 16
    assert names[-1] == "and 25 more"
    ax.figure.draw_without_rendering()
    assert ax.get_position().height > 0.6
