"""Vibration of axially tensed steel ropes.

Describe a rope and what acts on it as a `Scene`, compile it to a `Model`, ask for `modes`, `frf` or
`static`, and compare the answer with a measurement.

Numbers are in SI units, frequencies in Hz. Where pint is installed a quantity of it is taken in any
unit of the dimension.
"""

from . import ask, study2015
from .accuracy import AccuracyCost, accuracy_cost
from .animation import Animation
from .answer import Answer, Cost, load
from .bending_test import BendingTest
from .broken_wire import BrokenWire
from .choice import Choice
from .compare import Comparison, compare
from .damage import Damage
from .damped_modes import DampedModes
from .damping import LossFactor, ModalDamping, RayleighDamping, StiffnessDamping, ViscousDamping
from .deflection import Deflection
from .effect import EffectCost, effect_cost
from .end import End
from .errors import IdentifyWarning, RopedynError, SceneError, SolveError
from .fit import Fit
from .fits import Fits
from .floquet import Floquet
from .force import Chirp, Impulse, Sine, Step
from .frf import FRF
from .gravity import Gravity
from .history import History
from .identify import identify
from .measured import Measured
from .model import Model
from .modes import Modes
from .node_force import NodeForce
from .part import Dashpot, Hinge, PointMass, Spring, Support
from .peaks import Peaks
from .plan import Plan
from .planning import plan_measurement
from .prior import Prior
from .resonance import Resonances
from .resonator import Resonator
from .response_fit import ResponseFit
from .ringdown import RingDown
from .rope import Rope
from .scene import Scene
from .spectrum import Spectrum
from .stability import StabilityMap
from .stop import Stop
from .stretch import AddedMass, LocalChange
from .sweep import Sweep, sweep
from .table import Table
from .tension import Tension
from .torsion_test import TorsionTest

__version__ = "0.1.0"

__all__ = [
    "FRF",
    "AccuracyCost",
    "AddedMass",
    "Animation",
    "Answer",
    "BendingTest",
    "BrokenWire",
    "Chirp",
    "Choice",
    "Comparison",
    "Cost",
    "Damage",
    "DampedModes",
    "Dashpot",
    "Deflection",
    "EffectCost",
    "End",
    "Fit",
    "Fits",
    "Floquet",
    "Gravity",
    "Hinge",
    "History",
    "IdentifyWarning",
    "Impulse",
    "LocalChange",
    "LossFactor",
    "Measured",
    "ModalDamping",
    "Model",
    "Modes",
    "NodeForce",
    "Peaks",
    "Plan",
    "PointMass",
    "Prior",
    "RayleighDamping",
    "Resonances",
    "Resonator",
    "ResponseFit",
    "RingDown",
    "Rope",
    "RopedynError",
    "Scene",
    "SceneError",
    "Sine",
    "SolveError",
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
    "ViscousDamping",
    "accuracy_cost",
    "ask",
    "compare",
    "effect_cost",
    "identify",
    "load",
    "plan_measurement",
    "study2015",
    "sweep",
]
