"""Claims about the physics that tests measure: the rows of VALIDATION.md.

A test marked ``@pytest.mark.claim(what, reference=..., accepted=...)`` calls its fixture ``claim``
with what it measured. `accepted` is the only place where the bound is written.
"""

import dataclasses

import pytest

MEASURED = "measured"
"""Name of the property of a test report that carries a measured number."""

MOST = 100
"""How far the accepted error may be from the measured one."""


@dataclasses.dataclass(frozen=True)
class Claim:
    """What a test claims.

    Attributes
    ----------
    what : str
        The claim, for a reader who knows the physics.
    reference : str
        What it is measured against, and where that comes from.
    accepted : float
        Largest accepted error: within `MOST` times what is measured, so that losing two digits
        fails. Ten times it is room enough for other processors and kernels of LAPACK.
    limit : bool
        It says where the library is not right or not the best.
    wide : str
        Why more than `MOST` times what is measured is accepted, "" where that is not so.
    """

    what: str
    reference: str
    accepted: float
    limit: bool = False
    wide: str = ""


def claim_of(item):
    """The claim of a test, or None."""
    marker = item.get_closest_marker("claim")
    return marker and Claim(*marker.args, **marker.kwargs)


@pytest.fixture
def claim(request, record_property):
    """Hold measured numbers against the accepted one and keep them for the page."""
    accepted = claim_of(request.node).accepted

    def hold(measured):
        record_property(MEASURED, float(measured))
        assert measured <= accepted

    return hold
