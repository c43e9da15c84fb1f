"""Measurements that others published, as numbers with their sources.

Tubes: J. Bono, "Natural Frequencies of Straw Tubes", Fermilab, Mu2e-doc-6392-v5, September 2019,
and its plotting macros (github.com/jasonbono/StrawNaturalFrequency: plots/FrequencyVsTension.C has
the table, FitData.C and FitSimpleSupport.C stiffness and density). Straws of metallised Mylar, 5 mm
in diameter, glued at both ends, under hanging masses. Density: weighed, with 2.4e-5 kg/m of air
inside and as much of virtual mass outside, as the paper says. Stiffness: from the deflection of a
straw of 1 m under its own weight, 0.00376582 in FitData.C. No uncertainty is stated; the author's
later experiment quotes 3 mm, 10 g and 0.5 Hz.

Cord: M. Ali, D. Broggi, G. Cantarini, "Propagazione delle onde su una corda vibrante", report of a
laboratory course (github.com/giiulia/LabI-Dynamics-Thermodynamics, Vibrating_string): a cord
between a shaker and a pulley under a hanging mass, weighed and measured by length six times.
"""

import numpy as np

import ropedyn as rd

STRAW_LENGTH = (1.168, 0.95, 0.6415, 0.473, 0.4)
"""[m]."""
STRAW_TENSION = 9.8 * np.array([0.101, 0.202, 0.302, 0.403, 0.499, 0.6, 0.701])
"""[N]."""
STRAW_FREQUENCY = np.array(
    [
        [23.788, 32.49, 40.261, 46.051, 50.909, 54.499, 58.637],
        [30.84, 40.99, 49.2576, 56.31402, 62.04, 67.347, 72.5],
        [49.667, 66.6, 78.053, 86.828, 94.511, 104.05, 112.352],
        [76.64, 97.32, 112.24, 124.87, 136.64, 147.96, 158.64],
        [92.16, 120.43794, 137.5, 151.37616, 162.6, 174.6, 186.4],
    ]
)
"""First natural frequency of each length and tension [Hz]."""

CORD_TENSION = 1.9728
"""0.201102 kg times 9.81 m/s^2; friction of the pulley was not measured [N]."""
CORD_FREQUENCY = (13.88, 27.89, 42.13, 56.85, 71.87)
"""Of modes 1 to 5, read to 0.01 Hz [Hz]."""


def straw(length, tension):
    """A straw between glued ends."""
    return rd.Scene(rd.Rope(length, 3.96e-4, bending_stiffness=3.766e-3), tension=float(tension))


def cord(ends="pinned", bending_stiffness=1e-4):
    """The cord, whose stiffness nobody measured."""
    rope = rd.Rope(1.08, 3.8283e-3 / 1.7426, bending_stiffness=bending_stiffness)
    return rd.Scene(rope, tension=1.0, ends=(ends, ends))
