"""One mass in the middle of a string, at the end of two elements: an oscillator."""

import math

import numpy as np

import ropedyn as rd

LENGTH, DENSITY, TENSION = 1.0, 0.1, 100.0
MASS, STIFFNESS = DENSITY * LENGTH / 2, 4 * TENSION / LENGTH
OMEGA = math.sqrt(STIFFNESS / MASS)
PERIOD = 2 * math.pi / OMEGA
AMPLITUDE = 0.01
MIDDLE = ("z", LENGTH / 2)


def mass_on_a_string(*parts, tension=TENSION, **rope):
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY, **rope), tension=tension, parts=parts)
    return scene.compile(elements=2)


def coulomb(time, friction):
    """The mass between sticking points, half a period at a time; it loses 4 F/k a period."""
    found, shift = [], friction / STIFFNESS
    for t in time:
        x, left = AMPLITUDE, t
        while abs(x) > shift and left > PERIOD / 2:
            x, left = 2 * math.copysign(shift, x) - x, left - PERIOD / 2
        centre = math.copysign(shift, x)
        found.append(x if abs(x) <= shift else centre + (x - centre) * math.cos(OMEGA * left))
    return np.array(found)
