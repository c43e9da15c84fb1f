"""Lines of the C core that a scene executes: an extension that counts them, read by gcov."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import scipy_openblas32 as lapacke

ROOT = Path(__file__).parent.parent.parent
TESTS = [str(ROOT / "tests" / name) for name in ("", "support", "scene")]

ASK = """
import sys
sys.path[:0] = [{package!r}, *{tests!r}]
import ropedyn as rd
assert rd.__file__.startswith({package!r})
import test_effects
test_effects.ask(test_effects.{scene})
"""


def build(folder):
    """Build the package with counters; return where its object files are."""
    shutil.copytree(ROOT / "csrc", folder / "csrc")
    shutil.copytree(ROOT / "ropedyn", folder / "ropedyn", ignore=shutil.ignore_patterns("*.so"))
    objects = folder / "objects"
    objects.mkdir()
    include = (np.get_include(), lapacke.get_include_dir(), sysconfig.get_paths()["include"])
    flags = ["-std=c17", "-O0", "--coverage", "-fPIC", "-w", "-Icsrc"]
    flags += [f"-I{path}" for path in include]

    def compile_one(source):
        name = str(source.relative_to(folder))
        made = str(objects / Path(name).with_suffix(".o").as_posix().replace("/", "."))
        subprocess.run(["gcc", *flags, "-c", name, "-o", made], cwd=folder, check=True)
        return made

    with ThreadPoolExecutor(os.cpu_count()) as executor:
        made = list(executor.map(compile_one, sorted((folder / "csrc").rglob("*.c"))))
    library = lapacke.get_lib_dir()
    links = [f"-L{library}", "-lscipy_openblas", f"-Wl,-rpath,{library}", "-lm"]
    core = folder / "ropedyn" / f"_core{sysconfig.get_config_var('EXT_SUFFIX')}"
    command = ["gcc", "-shared", "--coverage", *made, *links, "-o", str(core)]
    subprocess.run(command, check=True)
    return objects


def lines_of(scene, folder, objects):
    """Run `test_effects.ask` of a scene, an expression there; return the lines it executed."""
    counts = Path(tempfile.mkdtemp(dir=folder))
    code = ASK.format(
        package=str(folder),
        tests=TESTS,
        scene=scene,
    )
    environment = os.environ | {"GCOV_PREFIX": str(counts), "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True)
    place = counts / objects.relative_to("/")
    for notes in objects.glob("*.gcno"):
        shutil.copy(notes, place)
    files = [str(f) for f in sorted(place.glob("*.gcda"))]
    command = ["gcov", "--json-format", "--stdout", *files]
    report = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    return {
        (source["file"], line["line_number"])
        for unit in report.stdout.splitlines()
        for source in json.loads(unit)["files"]
        if source["file"].startswith("csrc/")
        for line in source["lines"]
        if line["count"] > 0
    }
