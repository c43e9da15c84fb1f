"""The command that computes the section of a rope from its catalogue line."""

from __future__ import annotations

import argparse

from ..scene.construction.catalogue import CORES, NAMES
from ..scene.construction.construction import Construction
from ..scene.construction.standard import ROPE_LAYS, STRAND_LAYS
from ..scene.construction.stiffness import TORSIONS
from .options import Command, option, show, switch


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
    show(options, section)


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
    ),
    elements=(),
    subject=(option("name", "of the construction", choices=NAMES, metavar="NAME"),),
)
