"""A release says one version everywhere, and what it is built for."""

import re
import tomllib
from importlib import metadata
from pathlib import Path

import ropedyn as rd

ROOT = Path(__file__).parent.parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_one_version_is_said_everywhere():
    cited = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    said = {
        metadata.version("ropedyn"),
        re.search(r"^version: (\S+)$", cited, re.MULTILINE)[1],
        re.search(r"^## ([\d.]+)", changes, re.MULTILINE)[1],
    }
    assert said == {rd.__version__}
    assert "version" not in PROJECT["project"]


def test_wheels_are_described_for_what_the_core_allows():
    tool = PROJECT["tool"]["cibuildwheel"]
    assert tool["linux"]["archs"] == ["x86_64", "aarch64"]
    assert not {"macos", "windows"} & tool.keys()
    setup = (ROOT / "setup.py").read_text(encoding="utf-8")
    assert 'if not sys.platform.startswith("linux")' in setup
