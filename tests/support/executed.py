"""Lines of the C core that a scene executes: an extension that counts them, read by gcov."""

import json
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import scipy_openblas32 as lapacke

ROOT = Path(__file__).parent.parent.parent
TESTS = [str(ROOT / "tests" / name) for name in ("", "support", "scene")]

ASK = """
import os
import sys
sys.path[:0] = [{package!r}, *{tests!r}]
import ropedyn as rd
assert rd.__file__.startswith({package!r})
import test_effects

def ask(scene, counts):
    os.environ["GCOV_PREFIX"] = counts
    test_effects.{ask}(eval(scene, vars(test_effects)))
    sys.exit()  # which writes the counts

for scene, counts in {asked!r}:
    child = os.fork()
    if child == 0:
        ask(scene, counts)
    if os.waitpid(child, 0)[1] != 0:
        sys.exit(scene + " failed")
"""
"""Each scene in a process of its own, so that nothing kept from another spares it code."""


def build(folder):
    """Build the package with counters; return where its object files are."""
    shutil.copytree(ROOT / "csrc", folder / "csrc")
    shutil.copytree(ROOT / "ropedyn", folder / "ropedyn", ignore=shutil.ignore_patterns("*.so"))
    objects = folder / "objects"
    objects.mkdir()
    include = (np.get_include(), lapacke.get_include_dir(), sysconfig.get_paths()["include"])
    flags = ["-std=c17", "-O0", "--coverage", "-fPIC", "-w", "-Wno-psabi", "-Icsrc"]
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


def counts_of(scenes, folder, objects, ask="ask"):
    """Run `test_effects.ask` of scenes, expressions there; return how often each ran which line."""
    places = [Path(tempfile.mkdtemp(dir=folder)) for _ in scenes]
    asked = [(scene, str(place)) for scene, place in zip(scenes, places)]
    workers = os.cpu_count()

    def run(some):
        code = ASK.format(package=str(folder), tests=TESTS, asked=some, ask=ask)
        aside = {"GCOV_PREFIX": tempfile.mkdtemp(dir=folder), "OPENBLAS_NUM_THREADS": "1"}
        subprocess.run([sys.executable, "-c", code], env=os.environ | aside, check=True)

    with ThreadPoolExecutor(workers) as executor:
        list(executor.map(run, [asked[k::workers] for k in range(workers)]))
        return list(executor.map(lambda place: _counted(place, folder, objects), places))


def _counted(counts, folder, objects):
    """How often each line (file, number) of the core was executed, those that were."""
    place = counts / objects.relative_to("/")
    for notes in objects.glob("*.gcno"):
        shutil.copy(notes, place)
    files = [str(f) for f in sorted(place.glob("*.gcda"))]
    command = ["gcov", "--json-format", "--stdout", *files]
    report = subprocess.run(command, cwd=folder, check=True, capture_output=True, text=True)
    found = Counter()
    for key, count in (
        ((source["file"], line["line_number"]), line["count"])
        for unit in report.stdout.splitlines()
        for source in json.loads(unit)["files"]
        if source["file"].startswith("csrc/")
        for line in source["lines"]
        if line["count"] > 0
    ):
        found[key] += count
    return found
