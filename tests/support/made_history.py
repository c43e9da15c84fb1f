"""Motion over time that formulas give: what no solver has computed."""

import numpy as np

import ropedyn as rd
from ropedyn.motion.history import Balance


def made(time, value, *, force=None, response=None, quantity="displacement", **changes):
    """Return a history of these values, shape (t,) or (responses, t)."""
    time, value = np.array(time, float), np.atleast_2d(value)
    nodes = np.array([0.0, 0.5, 1.0])
    fields = {
        "drive": () if force is None else (("z", 0.5),),
        "response": response or tuple(("z", 0.1 * (k + 1)) for k in range(len(value))),
        "quantity": quantity,
        "coordinates": ("z", "beta"),
        "time": time,
        "value": value,
        "force": np.zeros((0, len(time))) if force is None else np.atleast_2d(force),
        "snapshot_time": time[:2],
        "x": nodes,
        "snapshot": np.stack([np.outer(nodes, [1.0, 0.1]), np.outer(nodes**2, [1.0, 0.1])]),
        "cost": rd.Cost("modal", 2, 3, seconds=0.5),
        "balance": Balance({"kinetic": np.ones(len(time))}),
        "error": np.zeros(value.shape),
        "mesh_error": np.zeros(value.shape),
    }
    return rd.History(**fields | changes)


def decaying(time, *modes):
    """Return the sum of modes (undamped natural frequency [Hz], damping ratio, amplitude)."""
    total = np.zeros(len(time))
    for frequency, ratio, amplitude in modes:
        rate = 2 * np.pi * frequency * (-ratio + 1j * np.sqrt(1 - ratio**2))
        total += (amplitude * np.exp(rate * time)).real
    return total
