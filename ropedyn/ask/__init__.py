"""Questions: what can be asked of any model, kept apart from the model.

Examples
--------
>>> import ropedyn as rd
>>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
>>> question = rd.ask.modes(2)
>>> for model in (scene.compile(), scene.compile(elements=8)):
...     print(question.of(model).frequency.round(2))
[15.81 31.62]
[15.71 30.82]
"""

from .forced import FRFQuestion, StaticQuestion, SteppedSineQuestion
from .free import CountQuestion, FloquetQuestion, ModesQuestion
from .many import FamilyQuestion, IdentifyQuestion
from .over_time import MotionQuestion
from .question import AnyQuestion as AnyQuestion

modes, count, floquet = ModesQuestion, CountQuestion, FloquetQuestion
frf, stepped_sine, static = FRFQuestion, SteppedSineQuestion, StaticQuestion
motion, identify, family = MotionQuestion, IdentifyQuestion, FamilyQuestion
