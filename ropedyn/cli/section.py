"""The command that computes the section of a rope from its catalogue line."""

from __future__ import annotations

import argparse
from typing import Any

from ..base.errors import SceneError
from ..experiment.plan.wire_shifts import broken_wire_shifts
from ..scene.construction.catalogue import CORES, NAMES
from ..scene.construction.construction import Construction
from ..scene.construction.standard import ROPE_LAYS, STRAND_LAYS
from ..scene.construction.stiffness import TORSIONS
from ..scene.rope import Rope
from ..scene.scene import Scene
from .options import Command, OptionGroup, option, refuse, show, switch
from .text import whole_numbers


def _section(options: argparse.Namespace) -> None:
    construction = Construction.standard(
        options.name,
        diameter=options.diameter,
        core=options.core,
        lay=options.lay,
        lay_length=options.lay_length,
        strand_lay=options.strand_lay,
        scaled=not options.unscaled,
    )
    section = construction.section(options.torsion, radial_stiffness=options.radial_stiffness)
    if options.broken is None:
        refuse(options, BREAK[1:], "--broken")
        return show(options, section)
    if options.length is None:
        raise SceneError("--length must be given with --broken, got none")
    rope = Rope.from_construction(options.length, section)
    given = {name: getattr(options, name) for name in ("friction", "modes", "std")}
    asked = {name: value for name, value in given.items() if value is not None}
    scene = Scene(rope, tension=options.tension or TENSION)
    show(options, broken_wire_shifts(scene, options.broken, **USUAL | asked))


FRICTION, TENSION, LOWEST = 0.2, 0.0, 5  # Between wires, of the rope, and modes, where not given.
USUAL: dict[str, Any] = {"friction": FRICTION, "modes": LOWEST}
BREAK = (
    option("--broken", "wires broken at one place, such as 1,2,4: shifts instead", whole_numbers),
    option("--length", "of the rope, which is clamped [m]", type=float),
    option("--tension", f"of the rope ({TENSION:g}) [N]", type=float),
    option("--friction", f"between wires ({FRICTION})", type=float),
    option("--modes", f"the lowest so many ({LOWEST})", type=int),
    option("--std", "standard deviation of a measured frequency [Hz]", type=float),
)

SECTION = Command(
    "section",
    _section,
    "stiffnesses, mass and inertias of a rope from its construction",
    (
        option("--diameter", "of the rope or the strand [m]", type=float, required=True),
        option("--core", "of a rope (FC)", choices=CORES),
        option("--lay", "sense of lay (sZ, or Z)", choices=(*ROPE_LAYS, *STRAND_LAYS)),
        option("--lay-length", "of strands, or of the outer wires of a strand [m]", type=float),
        option("--strand-lay", "lay length of wires in strands [m]", type=float),
        option(
            "--torsion",
            "what wires do in strands (%(default)s)",
            choices=TORSIONS,
            default=TORSIONS[0],
        ),
        option("--radial-stiffness", "of the core; radii are kept without it [N]", type=float),
        switch("--unscaled", "area and mass of touching circles, not of tables"),
        OptionGroup(BREAK, "what broken wires change of frequencies, over where they are"),
    ),
    elements=(),
    subject=(option("name", "of the construction", choices=NAMES, metavar="NAME"),),
)
