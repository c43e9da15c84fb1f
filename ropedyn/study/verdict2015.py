"""What the readings of the 2015 study and ropes of its diameter show: proved, fitting, open."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..base.array import Real
from ..base.table import Table
from ..curves.peaks import Peaks
from ..model import Model
from . import printed as study
from .implied import STATED_TENSION

FREQUENCY = np.linspace(1.0, 300.0, 1197)  # Lines of the study's characteristics, 0.25 Hz apart.

VERDICT = """
What is proved, by arithmetic and by the study's own model:
- No {thick:g} mm steel rope has its mass. 0.13725 kg over {L:g} m are {whole:.3f} kg/m: a solid bar
has {bar:.3f}, ropes have {m:.2g} to {M:.2g}, and with that mass are {thicker:.1f} mm thick at
least. At each of the seven masses it is {each:.3f} kg/m, {bars:.1f} solid bars.
- B = {B:.1f} N m^2 is {B_bars:.0f} times that of the solid bar ({B_bar:.2f}), which no rope
exceeds: these have {b:.2g} to {b_slip:.2g} where all wires slip and {b_stick:.3g} to {b_most:.3g}
where none does.
- The study's agreement holds for eight elements only: refined, its kinematics goes from {f1:.1f} to
{refined:.1f} Hz, towards a wave of bending rotation.
- Its third mode, called rotational, has {z:.0f} % of its kinetic energy in z, {beta:.0f} % in
bending rotation and {alpha:.1f} % in twist.
- "There is no 3rd peak" in z: the model has one at {peaks_z} of the {masses} masses, in twist at
{peaks_alpha}. Nor is twist there "over 10 time's bigger": its third peak is at most {grown:.1f}
times what the force twists a mass at rest and 1/{below:.0f} of the first peak, and with gamma as
printed no mode at {f3:.0f} Hz grows beyond {alone:.1f} times.
- The "8 %" of its conclusions are {claimed:.1f} % at the first peak.
- Torsion of these ropes begins at {t:.3g} to {T:.3g} Hz over {L:g} m whatever their diameter, not
at {u:.3g} to {U:.3g}: stretch gives way to twist, which lowers it by {r:.2g} to {R:.2g} times where
wires slip.
What fits:
- Read as the mass of the whole rope, 0.13725 kg gives the published peaks within {off_whole:.0f} %;
read literally, at each mass, it misses them by {off_each:.0f} %.
- So do its moments of inertia: with a seventh of 0.13725 kg their radii of gyration are
{about[0]:.2f} mm about the rope and {across[0]:.0f} mm across it, with 0.13725 kg {about[1]:.2f}
and {across[1]:.0f}; a bar as thick has {round:.2f}, a line as long as an element {piece:.0f}.
- C = {C} N m^2 is that of a rope as thick: {off_C:+.1f} % from {C_of} whose wires slip, between
slip and stick for {C_between}.
- A tensed beam meets all three measured peaks within {off_beam:.1f} % (T = {T_beam:.2f} kN, B =
{B_beam:.2f} N m^2, {among} slipping and sticking wires): two numbers for three peaks, evidence but
no proof. The peaks fix T per mass; B they hardly feel.
- {third:.0f} Hz as torsion of the bare rope: between slip and stick for {third_between}; within
95 % of what lays, moduli, core and friction leave open for {third_drawn}. Of {next}, the next,
these begin at {begin:.0f} Hz.
What is open:
- The tension: the study states {T_stated:.0f} N, and 90 % of the nominal strength. With the mass of
a rope the beam needs {T_least:.1f} to {T_most:.1f} kN.
- The exciter: {grams:.0f} g on {flexure:g} N/mm, clamped to the third mass, would shift that beam
by {shift} %. Fitted with it, a beam meets the peaks within {off_driven:.1f} % at T =
{T_driven:.2f} kN and B = {B_driven:.2f} N m^2. Whether it was there when they were measured the
study does not say.
- The third peak: a transverse mode, torsion, or the parametric image of torsion at twice its
frequency. The study's own constants, without lay coupling, twist at {own:.0f} Hz, twice
{half:.0f} Hz; of the ropes, with it, {twice_between} may twist at {twice:.0f} Hz, and nearest is
{near}, {near_at:.0f} Hz. More tension raises transverse modes, and torsion not.
"""


def short(ropes: Table) -> Table:
    """Return the table of ropes with three digits and headings that fit a line."""
    headings = ("kg/m", "C slip", "C stick", "B slip", "B stick", "no lay", "slip", "stick")
    digits = [[v if v is None else float(f"{v:.3g}") for v in row[1:]] for row in ropes.rows]
    rows = tuple((row[0].replace(", layers", ""), *three) for row, three in zip(ropes.rows, digits))
    return Table(f"{ropes.title} [Hz]; C, B [N m^2]", (ropes.columns[0], *headings), rows)


def verdict(
    models: Mapping[str, Model],
    published: Peaks,
    measured: Peaks,
    ropes: Table,
    drawn: Mapping[str, tuple[float, float]],
) -> str:
    """Say what is proved, what fits and what is open, a line for each point.

    `drawn` has the interval of the torsional frequency of each rope, in the order of the table.
    """
    said, seen = (np.asarray(peaks.frequency) for peaks in (published, measured))
    third = float(seen[2])
    return re.sub(r"\n(?!- |What)", " ", VERDICT.strip()).format(
        claimed=_most(said, seen),
        third=third,
        twice=2 * third,
        **_inertias(),
        **_ropes(ropes, models[study.FITTED]),
        **_torsion(ropes, third, drawn),
        **_model(models[study.WHOLE]),
        **_fits(models, said, seen),
    )


def _most(frequency: Real, peaks: Real) -> float:
    """Return the largest difference in per cent of the peaks."""
    return float(np.abs(100 * (frequency / peaks - 1)).max())


def _columns(ropes: Table) -> tuple[list[str], Real, Real]:
    """Return names and numbers of the ropes alone, and the numbers of the bar."""
    rows = {row[0]: row[1:] for row in ropes.rows if row[0] != study.STATED}
    bar = np.array(rows.pop(study.SOLID), dtype=np.float64)
    return list(rows), np.array(list(rows.values()), dtype=np.float64).T, bar


def _between(names: list[str], low: Real, value: float, high: Real) -> str:
    """Name what has a value between its bounds."""
    return ", ".join(np.array(names)[(low <= value) & (value <= high)].tolist()) or "none"


def _inertias() -> dict[str, Any]:
    """Return radii of gyration, of printed inertias, of a bar as thick and a line as long [mm]."""
    masses = np.array([study.MASS / (study.ELEMENTS - 1), study.MASS])
    return {
        "about": 1e3 * np.sqrt(study.TWIST_INERTIA / masses),
        "across": 1e3 * np.sqrt(study.BENDING_INERTIA / masses),
        "round": 1e3 * study.DIAMETER / np.sqrt(8),
        "piece": 1e3 * study.ELEMENT_LENGTH / np.sqrt(12),
    }


def _ropes(ropes: Table, beam: Model) -> dict[str, Any]:
    """Return mass and bending of the study against those of the ropes and the bar."""
    _, (mass, *_, slip, stick, _, _, _), bar = _columns(ropes)
    whole, each = study.MASS / study.LENGTH, study.MASS / study.ELEMENT_LENGTH
    rope, T = beam.scene.rope, beam.scene.mean_tension / 1e3
    B = rope.bending_stiffness or 0.0
    needs = T / rope.linear_density * mass
    return {
        "L": study.LENGTH,
        "thick": 1e3 * study.DIAMETER,
        "thicker": 1e3 * study.DIAMETER * np.sqrt(whole / mass.max()),
        **{"whole": whole, "each": each, "bar": bar[0], "bars": each / bar[0]},
        **{"m": mass.min(), "M": mass.max()},
        **{"B": study.BENDING_STIFFNESS, "B_bar": bar[3]},
        "B_bars": study.BENDING_STIFFNESS / bar[3],
        **{"b": slip.min(), "b_slip": slip.max(), "b_stick": stick.min(), "b_most": stick.max()},
        **{"T_beam": T, "B_beam": B},
        "among": "between" if slip.max() < B < stick.min() else "not between",
        **{"T_stated": STATED_TENSION, "T_least": needs.min(), "T_most": needs.max()},
    }


def _torsion(
    ropes: Table, third: float, drawn: Mapping[str, tuple[float, float]]
) -> dict[str, Any]:
    """Return torsional stiffness and frequencies of the ropes against those of the study."""
    names, (_, C_slip, C_stick, _, _, alone, slip, stick), _ = _columns(ropes)
    C, low_high = study.TORSIONAL_STIFFNESS, np.transpose([drawn[name] for name in names])
    off, ratio = C / C_slip - 1, alone / slip
    k, near = np.abs(off).argmin(), np.abs(stick - 2 * third).argmin()
    begin, after = min((low, name) for name, (low, _) in drawn.items() if low > third)
    return {
        **{"C": C, "off_C": 100 * off[k], "C_of": names[k]},
        "C_between": _between(names, C_slip, C, C_stick),
        **{"t": slip.min(), "T": stick.max(), "u": alone.min(), "U": alone.max()},
        **{"r": ratio.min(), "R": ratio.max(), "begin": begin, "next": after},
        "third_between": _between(names, slip, third, stick),
        "third_drawn": _between(names, low_high[0], third, low_high[1]),
        "twice_between": _between(names, slip, 2 * third, stick),
        **{"near": names[near], "near_at": stick[near]},
    }


def _model(model: Model) -> dict[str, Any]:
    """Return what the study's own model says of its third mode and of its figures 9 and 10."""
    from scipy.signal import find_peaks

    modes, found = model.modes(4), {}
    f, energy = modes.frequency, modes.energy
    low, high = (f[1] + f[2]) / 2, (f[2] + f[3]) / 2
    for c in ("z", "alpha"):
        at = [(c, x) for x in study.MASSES]
        curves = np.abs(model.frf([0.0, *FREQUENCY], drive=study.DRIVE, response=at).value)
        peaks = [1 + find_peaks(curve[1:])[0] for curve in curves]
        near = [k[(FREQUENCY[k - 1] > low) & (FREQUENCY[k - 1] < high)] for k in peaks]
        third = np.array([curve[k].max(initial=0.0) for curve, k in zip(curves, near)])
        found[c] = curves, third
    twist, third = found["alpha"]
    return {
        **{"f1": f[0], "f3": f[2], "masses": len(study.MASSES)},
        **{c: 100 * energy[c][2] for c in ("z", "beta", "alpha")},
        **{f"peaks_{c}": np.count_nonzero(third) for c, (_, third) in found.items()},
        **{"grown": (third / twist[:, 0]).max(), "below": twist.max() / third.max()},
        # 1/(2 zeta), where zeta = gamma omega/2
        "alone": 1 / (study.GAMMA * 2 * np.pi * f[2]),
    }


def _fits(models: Mapping[str, Model], said: Real, seen: Real) -> dict[str, Any]:
    """Return how far readings are from peaks, the exciter's among them."""
    f = {name: model.modes(3).frequency for name, model in models.items()}
    with_it, without = models[study.DRIVEN].scene, models[study.FITTED].scene
    loaded = without.replace(parts=with_it.parts).compile().modes(3).frequency
    moved = 100 * (loaded / f[study.FITTED] - 1)
    return {
        "refined": f[study.REFINED][0],
        "off_whole": _most(f[study.WHOLE], said),
        "off_each": _most(f[study.LITERAL], said),
        "off_beam": _most(f[study.FITTED], seen),
        "off_driven": _most(f[study.DRIVEN], seen),
        **{"grams": 1e3 * study.EXCITER_MASS, "flexure": 1e-3 * study.EXCITER_STIFFNESS},
        "shift": ", ".join(f"{d:+.0f}" for d in moved),
        "T_driven": with_it.mean_tension / 1e3,
        "B_driven": with_it.rope.bending_stiffness,
        **{"own": f[study.TORSION][0], "half": f[study.TORSION][0] / 2},
    }
