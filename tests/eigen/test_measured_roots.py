"""`rounding_error` of modes and damped modes against roots in 60 digits, from the scene's numbers.

They are where the receptance of a point is infinite.
"""

import mpmath
import numpy as np
import pytest
from conftest import EPS, samples
from exact_chain import DIGITS, Exact
from exact_roots import pole
from exact_scene import places
from exact_span import Continuum, coupled
from random_scene import damped, taut_scene

import ropedyn as rd

FEW, MANY, MODES = 12, 2_500, 3
AT = 0.3819660113


def model_of(seed):
    """A rope that is not pushed, as a chain of ten elements or as spans, with dashpots or not."""
    random = np.random.default_rng([seed, 7])
    scene = taut_scene(random, int(random.choice([1, 2])), 1e3)
    is_damped = bool(random.random() < 0.5)
    scene = damped(random, scene) if is_damped else scene.replace(damping=None)
    scene = scene.replace(parts=[*scene.parts, rd.PointMass(AT, 1e-6)])
    if random.random() < 0.5:
        return scene.compile(), is_damped
    return scene.compile(elements=max(10, len(set(places(scene))) + 1)), is_damped


def exact_of(model):
    """The model in many digits, and the point whose receptance is asked."""
    if model.element == "continuous":
        return Continuum(model.scene, coupled(model.scene, "z")), ("z", AT)
    return Exact(model, model.component_of("z")), ("z", int(np.abs(model.x - AT).argmin()))


def errors(seed):
    """Error, `rounding_error` and size of each rate s, rad/s; none where a scene is refused."""
    model, is_damped = model_of(seed)
    try:
        modes = model.modes(MODES, damped=is_damped)
    except rd.SolveError:
        return []
    found = []
    with mpmath.workdps(DIGITS):
        exact, port = exact_of(model)
        rates = modes.eigenvalue if is_damped else 2j * np.pi * modes.frequency
        for s, error in zip(rates, 2 * np.pi * modes.rounding_error):
            if s == 0:
                continue
            start = -1j * mpmath.mpmathify(complex(s))
            try:
                omega = pole(exact, port, start)
            except (ValueError, ZeroDivisionError):
                continue
            # that of another mode, where this one stands still at the point
            if abs(omega - start) < 1e-7 * abs(start):
                true = start
                if not is_damped:  # the frequency itself is a double, 2 pi is not
                    true = mpmath.sqrt(mpmath.mpf(float(modes.eigenvalue[found_at(modes, s)])))
                found.append((float(abs(omega - true)), error, abs(s)))
    return found


def found_at(modes, s):
    """Which undamped mode has this rate."""
    return int(np.abs(2 * np.pi * modes.frequency - abs(s)).argmin())


@pytest.mark.parametrize("seeds", samples(FEW, MANY))
@pytest.mark.claim(
    "rounding_error of a mode, damped or not, of chains and spans, over the true error, median of "
    "random scenes, none of which is beyond it",
    reference="roots of the inverse receptance, mpmath, 60 digits",
    accepted=10.0,
)
def test_rounding_error_bounds_rates_and_is_no_useless_bound(seeds, claim):
    error, estimate, size = np.array([one for seed in seeds for one in errors(seed)]).T
    assert len(error) >= len(seeds)
    assert (error <= estimate).all(), np.flatnonzero(error > estimate)
    claim(np.median(estimate / np.maximum(error, EPS / 2 * size)))
