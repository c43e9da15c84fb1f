"""The model of a rope in a parabola, whatever its catenary is away: what `Scene.compile` asks."""

from ropedyn.eigen.tolerance import compile_within
from ropedyn.model import Model


def parabola(scene, **how):
    """Compile a scene that sags as one that does not: nothing is asked of its catenary."""
    model = object.__new__(Model)
    left_out = dict.fromkeys(("elements", "element", "tolerance", "below"))
    vars(model).update(vars(compile_within(scene, **(left_out | how))))
    return model
