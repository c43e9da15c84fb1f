"""What the 2015 study prints: its chain, its rope and its rig."""

from __future__ import annotations

ELEMENTS = 8  # of the study's chain
ELEMENT_LENGTH = 0.16875  # [m]
LENGTH = ELEMENTS * ELEMENT_LENGTH  # of the fragment of rope [m]
MASS = 0.13725  # printed as that of each of the seven nodes; in our reading of the rope [kg]
TWIST_INERTIA = 2.352e-8  # I_alpha of each mass [kg m^2]
BENDING_INERTIA = 7.8168e-5  # I_beta of each mass [kg m^2]
TORSIONAL_STIFFNESS = 0.1485  # C [N m^2]
BENDING_STIFFNESS = 54.626  # B [N m^2]
LAY_SLOPE = 0.01  # H [1]
GAMMA = 1e-4  # damping matrix over stiffness matrix [s]
DIAMETER = 4e-3  # of the measured rope [m]
MASSES = tuple(k * ELEMENT_LENGTH for k in range(1, ELEMENTS))  # where the seven masses stand [m]
DRIVE = ("z", MASSES[2])  # the transverse force acts on the third mass

# of the exciter's moving element, Brüel & Kjær, product data of type 4810
EXCITER_MASS = 0.018  # [kg]
EXCITER_STIFFNESS = 2e3  # [N/m]

LITERAL = "study, 0.13725 kg each mass"
WHOLE = "study, 0.13725 kg in all"
REFINED = "  128 elements"
FITTED = "fitted"
DRIVEN = "  with exciter"
TORSION = "torsion alone, no lay slope"
"""Names of readings, as far as they stand before a colon."""

ROPES = f"{1e3 * DIAMETER:g} mm ropes: first torsional frequency over {LENGTH:g} m"
SOLID, STATED = "solid bar", "the study"
COLUMNS = (
    "construction",
    "mass [kg/m]",
    "C, slip [N m^2]",
    "C, stick [N m^2]",
    "B, slip [N m^2]",
    "B, stick [N m^2]",
    "no lay coupling [Hz]",
    "slip [Hz]",
    "stick [Hz]",
)
"""Ropes of the study's diameter, beside a bar and the study's own numbers."""
