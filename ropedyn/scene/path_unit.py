"""Units of the numbers that paths lead to."""

from __future__ import annotations

import re

_END = re.compile(r"ends\[[01]\]\.(spring|dashpot|mass)\.(x|z|alpha|beta)")

_OF_END = {
    "spring": ("N/m", "N m"),
    "dashpot": ("N s/m", "N m s"),
    "mass": ("kg", "kg m^2"),
}
"""Along the coordinate, and turning."""

_OF_DAMPING = {"mass": "1/s", "stiffness": "s"}
"""Where it is not as in a part."""

_OF_NAME = {
    "tension": "N",
    "mean": "N",
    "amplitude": "N",
    "frequency": "Hz",
    "phase": "rad",
    "length": "m",
    "x": "m",
    "start": "m",
    "stop": "m",
    "diameter": "m",
    "radius": "m",
    "gap": "m or rad",
    "linear_density": "kg/m",
    "mass": "kg",
    "rotary_inertia": "kg m or kg m^2",
    "polar_inertia": "kg m or kg m^2",
    "bending_stiffness": "N m^2",
    "torsional_stiffness": "N m^2",
    "axial_stiffness": "N",
    "lay_coupling": "N m",
    "stiffness": "N/m or N m",
    "damping": "N s/m or N m s",
    "coefficient": "N s/m^2",
    "gamma": "s",
    "youngs_modulus": "N/m^2",
    "g": "m/s^2",
    "inclination": "rad",
}


def unit_of(path: str) -> str:
    """Return the unit of the number at a path, both where the path alone does not tell.

    Parameters
    ----------
    path : str
        As `value_at` takes it.

    Returns
    -------
    str
        Such as "N m^2", "N/m or N m", or "" for a plain number.

    Examples
    --------
    >>> from ropedyn.scene.path_unit import unit_of
    >>> unit_of("bending_stiffness"), unit_of("ends[0].spring.beta"), unit_of("damping.eta")
    ('N m^2', 'N m', '')
    """
    if found := _END.fullmatch(path):
        return _OF_END[found[1]][found[2] in ("alpha", "beta")]
    name = path.rsplit(".", 1)[-1]
    if path.startswith("damping") and name in _OF_DAMPING:
        return _OF_DAMPING[name]
    if name == "density":
        return "kg/m^3 or 1"
    return _OF_NAME.get(name, "")
