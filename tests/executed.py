"""Lines of the C core that a scene executes: an extension that counts them, read by gcov."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parent.parent

ASK = """
import sys
import tempfile
sys.path[:0] = [{package!r}, {tests!r}]
import ropedyn as rd
assert rd.__file__.startswith({package!r})
import test_effects
test_effects.ask(test_effects.{scene})
"""


def build(folder):
    """Build the package with counters; return where its object files are."""
    shutil.copytree(ROOT / "csrc", folder / "csrc")
    shutil.copytree(ROOT / "ropedyn", folder / "ropedyn", ignore=shutil.ignore_patterns("*.so"))
    for name in ("setup.py", "pyproject.toml", "README.md"):
        shutil.copy(ROOT / name, folder)
    command = [sys.executable, "setup.py", "-q", "build_ext", "--inplace"]
    environment = os.environ | {"CFLAGS": "-O0 --coverage -w"}
    subprocess.run(command, cwd=folder, env=environment, check=True, capture_output=True)
    return next(folder.glob("build/temp*/csrc"))


def lines_of(scene, folder, objects):
    """Run `test_effects.ask` of a scene, an expression there; return the lines it executed."""
    counts = Path(tempfile.mkdtemp(dir=folder))
    code = ASK.format(package=str(folder), tests=str(Path(__file__).parent), scene=scene)
    environment = os.environ | {"GCOV_PREFIX": str(counts), "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
    place = counts / objects.relative_to("/")
    for notes in objects.glob("*.gcno"):
        shutil.copy(notes, place)
    files = [str(f) for f in sorted(place.glob("*.gcda"))]
    command = ["gcov", "--json-format", "--stdout", *files]
    report = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    return {
        (Path(source["file"]).name, line["line_number"])
        for unit in report.stdout.splitlines()
        for source in json.loads(unit)["files"]
        if source["file"].startswith("csrc")
        for line in source["lines"]
        if line["count"] > 0
    }
