from . import ask, study2015
from .axis.axis import Axis
from .base.answer import Answer, Cost, load
from .base.errors import (
    IdentifyWarning,
    ModelWarning,
    RopedynError,
    SceneError,
    SolveError,
    UnitWarning,
)
from .base.table import Table
from .curves.measured import Measured
from .curves.peaks import Peaks
from .curves.record.record import Record
from .curves.record.spectrum import RecordSpectrum
from .curves.resonance import Resonances
from .eigen.damage import Damage
from .eigen.damped.damped_modes import DampedModes
from .eigen.modes import Modes
from .experiment.compare.compare import Comparison, compare
from .experiment.identify.fit import Fit
from .experiment.identify.fits import Fits
from .experiment.identify.identify import identify
from .experiment.identify.response_fit import ResponseFit
from .experiment.plan.plan import Plan
from .experiment.plan.planning import plan_measurement
from .experiment.plan.wire_shifts import broken_wire_shifts
from .experiment.track.track import Track
from .experiment.track.tracking import track
from .family.family import Family
from .family.frf import FamilyFRF
from .family.modes import FamilyModes
from .model import Model
from .motion.history import History
from .motion.periodic.branches import Branches
from .parametric.floquet import Floquet
from .parametric.stability import StabilityMap
from .parametric.tongues import Boundary
from .response.deflection import Deflection
from .response.frf import FRF
from .response.friction.answer import FrictionResponse
from .response.second_harmonic import SecondHarmonic
from .scene.bench.bending_test import BendingTest
from .scene.bench.prior import Prior
from .scene.bench.torsion_test import TorsionTest
from .scene.construction.construction import Construction, Layer
from .scene.construction.section import Section
from .scene.construction.wire import Fibre, Wire
from .scene.damping import (
    LossFactor,
    ModalDamping,
    RayleighDamping,
    StiffnessDamping,
    ViscousDamping,
    WireFriction,
)
from .scene.end import End
from .scene.force import Chirp, Impulse, Sine, Step
from .scene.gravity import Gravity
from .scene.parts.broken_wire import BrokenWire
from .scene.parts.law import NodeForce, Stop
from .scene.parts.part import Dashpot, Hinge, PointMass, Spring, Support
from .scene.parts.resonator import Resonator
from .scene.parts.stretch import AddedMass, LocalChange
from .scene.rope import Rope
from .scene.scene import Scene
from .scene.tension import Tension
from .signal.spectrum import Spectrum
from .space.model import SpaceModel
from .space.wire import wound_wire
from .study.accuracy import AccuracyCost, accuracy_cost
from .study.effect import EffectCost, effect_cost
from .study.hard.hard_cases import HardCases, hard_cases
from .study.sweep import Sweep, sweep

__version__: str

__all__ = [
    "FRF",
    "AccuracyCost",
    "AddedMass",
    "Answer",
    "Axis",
    "BendingTest",
    "Boundary",
    "Branches",
    "BrokenWire",
    "Chirp",
    "Comparison",
    "Construction",
    "Cost",
    "Damage",
    "DampedModes",
    "Dashpot",
    "Deflection",
    "EffectCost",
    "End",
    "Family",
    "FamilyFRF",
    "FamilyModes",
    "Fibre",
    "Fit",
    "Fits",
    "Floquet",
    "FrictionResponse",
    "Gravity",
    "HardCases",
    "Hinge",
    "History",
    "IdentifyWarning",
    "Impulse",
    "Layer",
    "LocalChange",
    "LossFactor",
    "Measured",
    "ModalDamping",
    "Model",
    "ModelWarning",
    "Modes",
    "NodeForce",
    "Peaks",
    "Plan",
    "PointMass",
    "Prior",
    "RayleighDamping",
    "Record",
    "RecordSpectrum",
    "Resonances",
    "Resonator",
    "ResponseFit",
    "Rope",
    "RopedynError",
    "Scene",
    "SceneError",
    "SecondHarmonic",
    "Section",
    "Sine",
    "SolveError",
    "SpaceModel",
    "Spectrum",
    "Spring",
    "StabilityMap",
    "Step",
    "StiffnessDamping",
    "Stop",
    "Support",
    "Sweep",
    "Table",
    "Tension",
    "TorsionTest",
    "Track",
    "UnitWarning",
    "ViscousDamping",
    "Wire",
    "WireFriction",
    "accuracy_cost",
    "ask",
    "broken_wire_shifts",
    "compare",
    "effect_cost",
    "hard_cases",
    "identify",
    "load",
    "plan_measurement",
    "study2015",
    "sweep",
    "track",
    "wound_wire",
]
