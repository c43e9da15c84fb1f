"""What the README says in Python runs."""

import re
from pathlib import Path

import numpy as np
import pytest

README = (Path(__file__).parent.parent.parent / "README.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    """Names that the blocks have bound, run one after another in a folder of their own."""
    bound = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("readme"))
        for block in re.findall(r"^```python\n(.*?)^```", README, flags=re.M | re.S):
            exec(compile(block, "README.md", "exec"), bound)
    return bound


def test_fit_is_the_one_that_is_printed(names):
    value, low, high = re.search(r"# (\S+) N, from (\S+) to (\S+)", README).groups()
    fit = names["fit"]
    found = [fit.value["tension"], *fit.interval(0.95)["tension"]]
    assert [f"{one:.3f}" for one in found] == [value, low, high]


def test_tension_of_the_record_is_the_one_that_is_printed(names):
    status, *printed = re.search(r"# (\w+), (\S+) MN, from (\S+) to (\S+) MN", README).groups()
    signed = names["signed"]
    found = [signed.value["tension"], *signed.interval(0.95)["tension"]]
    assert (signed.status, [f"{one / 1e6:.1f}" for one in found]) == (status, printed)


def test_answers_are_finite(names):
    assert np.isfinite(names["frf"].value).all()
    assert np.isfinite(names["tip"].value).all()
    assert names["damped"].damping_ratio[0] > 0
    assert names["sticks"].value[0, -1] != 0  # friction holds the rope off its rest


def test_links_lead_to_files():
    root = Path(__file__).parent.parent.parent
    for target in re.findall(r"\]\(([^)#:]+)\)", README):
        assert (root / target).exists(), target
