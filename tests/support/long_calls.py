"""Calls of every kind that take long: what each is made of, and the call itself.

As a program it makes those that it is told by name, one after the other, and says how much of the
processor it had used when Ctrl-C reached it.
"""

import contextlib
import io
import signal
import sys
import tempfile
import threading
import time
from pathlib import Path

# ahead of every call: a package whose import Ctrl-C ends is of no use to the calls after it
import matplotlib.animation
import matplotlib.pyplot  # noqa: F401
import numpy as np
import scipy.integrate
import scipy.ndimage
import scipy.optimize
import scipy.signal
import scipy.special
import scipy.stats  # noqa: F401
import xarray  # noqa: F401

import ropedyn as rd
from ropedyn.cli import main

ROPE = rd.Rope(10.0, 0.1, bending_stiffness=0.01)
HELD = rd.Scene(ROPE, tension=1000.0)
LAID = HELD.replace(
    rope=ROPE.replace(torsional_stiffness=0.4, lay_slope=0.1, polar_inertia=1e-6),
)
STRING = rd.Scene(rd.Rope(10.0, 0.1), tension=1000.0)
SHORT = rd.Scene(rd.Rope(2.0, 0.2), tension=500.0)
STRAND = rd.Construction.standard("1x19", diameter=20e-3)
UNSEEN = ("rotary_inertia", "polar_inertia", "axial_stiffness", "torsional_stiffness")
RUBBING = rd.Scene(
    rd.Rope.from_construction(6.0, STRAND, lay_coupling=None, **dict.fromkeys(UNSEEN)),
    tension=30e3,
    ends=("pinned", "pinned"),
    damping=(STRAND.section().wire_friction(0.3), rd.ViscousDamping(10.0)),
)
COIL = rd.Scene(
    rd.Rope(
        rd.Axis.helix(0.5, 0.4, 0.9),
        0.8,
        bending_stiffness=(40.0, 30.0),
        torsional_stiffness=25.0,
        axial_stiffness=1e5,
    ),
    planes="both",
)
BEADS = [rd.PointMass((k + 0.5) / 20, 1e-3 * (1 + k / 200)) for k in range(200)]
PUSH = {"drive": ("z", 5.0), "response": ("z", 3.0)}
TIME = np.linspace(0.0, 40.0, 400_001)
LINES = np.linspace(1.0, 50.0, 100_000)


def uneven(elements=None, **options):
    """Return a chain of many kinds of elements."""
    return HELD.replace(parts=BEADS).compile(elements=elements, **options)


def again(call):
    """Call something that is soon done again and again."""
    while True:
        call()


def tracked(scene):
    one = {"std": 0.05, "order": [1, 2, 3]}
    records = [rd.Peaks([f, 2 * f, 3 * f], **one) for f in np.linspace(25.0, 26.0, 60)]
    again(lambda: rd.track(scene, records, temperature=np.linspace(20.0, 0.0, 60)))


def recorded():
    time = np.arange(200_000) / 512
    value = np.random.default_rng(1).normal(size=(2, len(time)))
    points = {"response": [("z", 1.0), ("z", 3.0)], "quantity": "acceleration"}
    return rd.Record(time, value, rate=512.0, **points)


def written(record):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "record.csv")

        def there_and_back():
            record.write(path)
            rd.Record.read(path)

        again(there_and_back)


def typed(scene):
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        path = Path(folder, "scene.toml")
        scene.save(path)
        again(lambda: main(["modes", str(path), "--elements", "5000"]))


def moved(model, method, force, time=TIME, **options):
    return model.transient(time, force=force, method=method, **PUSH, **options)


PEAKS = rd.Peaks([25.0, 50.1, 75.3, 100.9], std=0.1)
SWEPT = np.sin(TIME**2)
CALLS = {
    "modes": (
        lambda: uneven(100_000, element="rigid"),
        lambda m: again(lambda: m.modes(300)),
    ),
    "modes of continuous spans": (uneven, lambda m: m.modes(4000)),
    "modes by lapack": (
        lambda: HELD.compile(elements=2000, element="rigid"),
        lambda m: again(lambda: m.modes(5, solver="lapack")),
    ),
    "one count": (
        lambda: uneven(500_000, element="rigid"),
        lambda m: again(lambda: m.count(below=100.0)),
    ),
    "damped modes": (
        lambda: HELD.replace(parts=[*BEADS, rd.Dashpot(3.0, 5.0)]).compile(),
        lambda m: m.modes(400, damped=True),
    ),
    "responses": (lambda: uneven(20_000, element="rigid"), lambda m: m.frf(LINES, **PUSH)),
    "responses in closed form": (
        HELD.compile,
        lambda m: again(lambda: m.frf(np.tile(LINES, 4), **PUSH)),
    ),
    "responses by the band": (
        lambda: uneven(20_000, element="rigid"),
        lambda m: m.frf(LINES, solver="band", **PUSH),
    ),
    "responses by lapack": (
        lambda: uneven(20_000, element="rigid"),
        lambda m: m.frf(LINES, solver="lapack", **PUSH),
    ),
    "one response of many elements": (
        lambda: uneven(500_000, element="rigid"),
        lambda m: again(lambda: m.frf(LINES[:1], **PUSH)),
    ),
    "one response of many elements by the band": (
        lambda: uneven(200_000, element="rigid"),
        lambda m: again(lambda: m.frf(LINES[:3], solver="band", **PUSH)),
    ),
    "derivatives of responses": (
        uneven,
        lambda m: again(lambda: m.frf(LINES[::10], **PUSH).derivative("tension")),
    ),
    "static deflections": (
        lambda: uneven(1_000_000, element="rigid"),
        lambda m: again(lambda: m.static({("z", 5.0): 1.0})),
    ),
    "motion by modes": (
        lambda: HELD.compile(elements=1000),
        lambda m: again(lambda: moved(m, "modal", SWEPT)),
    ),
    "energy of motion": (
        lambda: moved(HELD.compile(elements=200), "modal", SWEPT[:40_001], TIME[:40_001]),
        lambda history: again(vars(history)["_balance"]),
    ),
    "motion by the line": (
        lambda: HELD.replace(parts=[rd.Dashpot(3.0, 5.0)]).compile(),
        lambda m: again(lambda: moved(m, "line", SWEPT)),
    ),
    "motion by steps": (
        lambda: HELD.replace(
            tension=rd.Tension(1000.0, amplitude=50.0, frequency=3.0), parts=[rd.Dashpot(5.0, 3.0)]
        ).compile(elements=64, element="rigid"),
        lambda m: again(lambda: moved(m, "auto", rd.Sine(0.5, 4.0), TIME[::100])),
    ),
    "motion by an integral equation": (
        lambda: HELD.replace(
            parts=[rd.NodeForce(3.0, lambda t, u, v: -1e4 * u**3)],
            damping=rd.StiffnessDamping(1e-5),
        ).compile(),
        lambda m: again(lambda: moved(m, "auto", rd.Sine(20.0, 4.0), TIME[:40_001:20])),
    ),
    "motion against stops": (
        lambda: HELD.replace(parts=[rd.Stop(3.0, gap=1e-3, stiffness=1e4)]).compile(),
        lambda m: again(lambda: moved(m, "events", rd.Sine(20.0, 4.0), TIME[::100])),
    ),
    "motion with smooth laws": (
        lambda: STRING.replace(parts=[rd.NodeForce(5.0, lambda t, u, v: -1e4 * u**3)]).compile(
            elements=4
        ),
        lambda m: again(lambda: moved(m, "auto", rd.Sine(0.5, 4.0), TIME[::100])),
    ),
    "steady motion": (
        lambda: HELD.replace(
            parts=[rd.NodeForce(3.0, lambda t, u, v: -1e4 * u**3)],
            damping=rd.RayleighDamping(1.0, 1e-6),
        ).compile(elements=32),
        lambda m: again(
            lambda: m.stepped_sine(np.linspace(4.0, 8.0, 50), drive=("z", 5.0), amplitude=1.0)
        ),
    ),
    "multipliers": (
        lambda: HELD.replace(tension=rd.Tension(1000.0, amplitude=50.0, frequency=3.0)).compile(
            elements=200
        ),
        lambda m: again(lambda: m.floquet(40)),
    ),
    "maps of stability": (
        lambda: HELD.compile(elements=200),
        lambda m: again(
            lambda: m.stability_map(np.linspace(1.0, 60.0, 60), np.linspace(0.0, 300.0, 20))
        ),
    ),
    "families": (
        lambda: HELD.replace(parts=BEADS[:1]).family(["tension"]),
        lambda f: f.modes(np.linspace(900.0, 1000.0, 100_000)[:, None], 60),
    ),
    "families row by row": (
        lambda: HELD.replace(parts=BEADS[:1]).family(["tension"], elements=64),
        lambda f: f.modes(np.linspace(900.0, 1000.0, 100_000)[:, None], 20),
    ),
    "identification": (
        lambda: SHORT,
        lambda s: again(lambda: rd.identify(s, PEAKS, ["tension"])),
    ),
    "identification with ends given": (
        lambda: SHORT,
        lambda s: again(lambda: rd.identify(s, PEAKS, ["tension"], ends="given")),
    ),
    "plans": (lambda: SHORT, lambda s: again(lambda: rd.plan_measurement(s, 6, sensors=4))),
    "tracks": (lambda: SHORT, tracked),
    "prices of accuracy": (
        lambda: HELD,
        lambda s: rd.accuracy_cost(s, rd.ask.modes(20), elements=[100, 600, 20_000], repeat=99),
    ),
    "prices of effects": (
        lambda: HELD.replace(parts=BEADS[:20]),
        lambda s: again(lambda: rd.effect_cost(s, rd.ask.modes(40))),
    ),
    "modes in space": (lambda: COIL, lambda s: again(lambda: s.compile().modes(40))),
    "responses in space": (
        COIL.compile,
        lambda m: again(lambda: m.frf(LINES[:1000], drive=("z", 0.1))),
    ),
    "friction between wires": (
        RUBBING.compile,
        lambda m: again(lambda: m.frf(np.linspace(1.0, 9.0, 20), drive=("z", 1.8), amplitude=50.0)),
    ),
    "spreads of sections": (
        STRAND.section,
        lambda s: again(lambda: s.spread(20_000)),
    ),
    "sweeps over scenes": (
        lambda: [HELD.replace(tension=t) for t in np.linspace(500.0, 1500.0, 5000)],
        lambda scenes: rd.sweep(lambda s: s.compile(elements=500).modes(20), scenes),
    ),
    "peaks of records": (recorded, lambda r: again(r.peaks)),
    "files": (recorded, written),
    "animations": (
        lambda: HELD.compile(elements=16).modes(2),
        lambda m: m.animate(0, frames=900).to_html(),
    ),
    "the command line": (lambda: LAID, typed),
}
"""By what a call is of: what makes the thing, not long, and what is then done with it."""


def interrupted(name):
    """Make a call, and return the time of the processor when it ends by Ctrl-C, else why not."""
    make, call = CALLS[name]
    try:
        thing = make()
        print("begin", flush=True)
        call(thing)
    except KeyboardInterrupt:
        used = time.process_time()
        for thread in threading.enumerate()[1:]:
            thread.join(10.0)  # what it has begun may end
        left = threading.active_count() - 1
        return f"{used} {left}"
    except Exception as error:
        return f"raised {error!r}"
    return "ended by itself"


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a job in the background ignores it
    for line in sys.stdin:
        print(interrupted(line.strip()), flush=True)
