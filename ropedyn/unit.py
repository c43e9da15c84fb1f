"""Units and names of coordinates and of their forces."""

UNIT = {"x": "m", "z": "m", "alpha": "rad", "beta": "rad"}
FORCE = {"x": "F_x", "z": "F_z", "alpha": "M_alpha", "beta": "M_beta"}
OF_FORCE = {force: coordinate for coordinate, force in FORCE.items()}
"""Coordinate of each internal force."""
FORCE_UNIT = {"x": "N", "z": "N", "alpha": "N m", "beta": "N m"}
NAME = {
    "x": "axial displacement",
    "z": "transverse displacement",
    "alpha": "twist",
    "beta": "bending rotation",
}
FAMILY = {"x": "axial", "z": "transverse", "alpha": "torsional", "beta": "bending rotation"}
QUANTITIES = {"receptance": 0, "mobility": 1, "accelerance": 2}
"""How often the displacement is differentiated."""
MOTIONS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""How often the displacement is differentiated."""
WIRE = "wire"
"""In a response: the tip of a broken wire, by its number among them."""
END = "end"
"""In a drive: the motion of an end, by its number."""


def label(
    response: tuple[str, float], drive: str | None = None, quantity: str = "receptance"
) -> str:
    """Say what a response is, such as ``z at 0.500 m [m/N]``."""
    name, x = response
    unit = FORCE_UNIT[OF_FORCE[name]] if name in OF_FORCE else UNIT.get(name, UNIT["z"])
    where = f"tip of {name} {x:.0f}" if name == WIRE else f"{name} at {x:.3f} m"
    unit += ("", "/s", "/s^2")[(QUANTITIES | MOTIONS)[quantity]]
    if drive is None:
        return f"{where} [{unit}]"
    force = FORCE_UNIT[drive]
    per = f"{unit}/{force}" if " " not in force else f"{unit}/({force})"
    return f"{where} [{per}]"


def power(value: float) -> str:
    """Write a power of ten shortly, such as ``1e-3``."""
    return f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e+")
