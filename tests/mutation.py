"""Do the tests see faults? Puts random ones into the package and the core, one at a time.

    .venv/bin/pip install coverage
    nice .venv/bin/python tests/mutation.py [--count 200] [--seed 2026] [--under ropedyn]

Outside CI: it takes about an hour on one core. A survey runs the tests once and keeps which test
executes which line; each fault then meets those that execute its place, the quickest first, until
one fails or the time for it is over. Nothing but the work folder is written to. A run that was
stopped goes on where it was; `--again` meets the survivors once more after tests were added.
Faults that do not compile or leave the object code as it is are none and others are drawn.
What survived when it was run last, and why, is in tests/mutation.md.
"""

import argparse
import json
import os
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import sysconfig
import time
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).parent.parent
COPIED = ("ropedyn", "csrc", "tests", "docs", "pyproject.toml", "setup.py", "README.md")
UNASKED = "not code_of_an_effect and not notebook and not c_tests_pass and not figures_are_drawn"
"""Tests of many seconds that see everything, and the C tests, which are asked one by one."""
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")
FLAGS = ["-std=c17", "-Wno-psabi", "-fPIC", "-ffp-contract=off", "-fno-math-errno", "-DRD_ONE_COPY"]
FLAGS += ["-Werror=incompatible-pointer-types", "-Werror=int-conversion"]
FLAGS += ["-DNPY_TARGET_VERSION=NPY_1_23_API_VERSION", "-DNPY_NO_DEPRECATED_API=7", "-pthread"]
CHAPTERS = {
    "assembled": ("eigen", "response", "chain"),
    "base": ("response", "eigen", "motion"),
    "chain": ("chain", "response", "eigen"),
    "closed": ("family", "eigen", "response", "experiment"),
    "collocation": ("motion",),
    "damped": ("eigen", "response"),
    "element": ("chain", "response", "eigen"),
    "energy": ("eigen", "response", "chain"),
    "graded": ("chain", "response", "eigen"),
    "law": ("motion",),
    "space": ("space", "axis"),
    "glue": ("project", "response", "eigen", "motion", "family", "chain"),
    "volterra": ("motion",),
    "mixed": ("chain", "response", "motion"),
    "modes": ("eigen", "chain"),
    "span": ("eigen", "response", "chain"),
    "sweep": ("response", "eigen", "chain"),
}
"""Folders of Python tests that ask a chapter of the core, besides the C tests."""
# a fault of the same size in the same second is no newer than what was compiled before
ENVIRONMENT = os.environ | {"PYTHONDONTWRITEBYTECODE": "1"}
ENVIRONMENT |= {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


# --- the core, compiled file by file --------------------------------------------------------------


class Core:
    """Object files of the core and of its tests."""

    def __init__(self, work, name, *flags):
        import numpy
        import scipy_openblas32 as lapacke

        self.work, self.objects = work, work / name
        self.objects.mkdir(exist_ok=True)
        include = [numpy.get_include(), lapacke.get_include_dir(), sysconfig.get_paths()["include"]]
        self.flags = [*FLAGS, *flags, "-Icsrc", "-Itests/c", *(f"-I{path}" for path in include)]
        library = lapacke.get_lib_dir()
        self.links = [f"-L{library}", "-lscipy_openblas", f"-Wl,-rpath,{library}", "-lm", *flags]
        sources = [*(work / "csrc").rglob("*.c"), *(work / "tests/c").glob("*.c")]
        self.sources = sorted(source.relative_to(work).as_posix() for source in sources)
        self.programs = [s for s in self.sources if Path(s).name.startswith("test_")]

    def object_of(self, source, folder=None):
        return (folder or self.objects) / (source.removesuffix(".c").replace("/", ".") + ".o")

    def compile(self, source, folder=None, seconds=600.0):
        command = ["gcc", *self.flags, "-MMD", "-c", source]
        command += ["-o", str(self.object_of(source, folder))]
        done = subprocess.run(
            command, cwd=self.work, timeout=seconds, check=False, capture_output=True
        )
        return done.returncode == 0

    def build(self):
        """Compile what is new."""
        for source in self.sources:
            made = self.object_of(source)
            needed = [self.work / name for name in self.needs(source)]
            if not made.exists() or any(n.stat().st_mtime > made.stat().st_mtime for n in needed):
                assert self.compile(source), source

    def needs(self, source):
        """The files that an object was made of."""
        rule = self.object_of(source).with_suffix(".d")
        text = rule.read_text().replace("\\\n", " ") if rule.exists() else f": {source}"
        return [name for name in text.split(":", 1)[1].split() if not name.startswith("/")]

    def link(self, target, sources, changed=()):
        """Link sources, those that a mutant changed from its own folder."""
        made = [self.object_of(s, self.objects / "mutant" if s in changed else None)
                for s in sources]  # fmt: skip
        shared = ["-shared"] if target.suffix == ".so" else []
        command = ["gcc", *shared, *map(str, made), *self.links, "-pthread", "-o", str(target)]
        subprocess.run(command, check=True, cwd=self.work)

    def extension(self, changed=()):
        sources = [s for s in self.sources if s.startswith("csrc")]
        self.link(self.work / "ropedyn" / f"_core{SUFFIX}", sources, changed)

    def program(self, source, changed=()):
        """Link one of the C tests."""
        own = [s for s in self.sources if not s.startswith("csrc/glue") and s not in self.programs]
        target = self.objects / Path(source).stem
        self.link(target, [source, *own], changed)
        return target


# --- which test executes which line ---------------------------------------------------------------


PYTEST = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-n", "0", "-k", UNASKED]
PYTEST += ["-m", "not slow"]


def environment_of(work, **more):
    paths = [str(work), str(work / "tests"), str(work / "tests/support")]
    return ENVIRONMENT | {"PYTHONPATH": os.pathsep.join(paths)} | more


def survey_python(work):
    """Run the tests under coverage, a context for each: .coverage and python.xml."""
    (work / ".coveragerc").write_text("[run]\nsource=ropedyn\ndynamic_context=test_function\n")
    command = [sys.executable, "-m", "coverage", "run", *PYTEST]
    command += ["--junitxml=python.xml", "--ignore=tests/c", "tests"]
    subprocess.run(command, cwd=work, env=environment_of(work), check=False)


def survey_core(work):
    """Count the lines of the core that each C test executes: core.json."""
    core = Core(work, "counted", "-O0", "--coverage")
    core.build()
    counts, found = work / "counts", defaultdict(list)
    for source in core.programs:
        prefix = {"GCOV_PREFIX": str(counts / source)}
        subprocess.run([core.program(source)], env=environment_of(work, **prefix), check=True)
        place = counts / source / core.objects.relative_to("/")
        for file, line in counted(place, core.objects, work):
            found[f"{file}:{line}"].append(source)
    (work / "core.json").write_text(json.dumps(found))


def counted(place, objects, work):
    """The lines (file, number) that counts in a folder say were executed."""
    files = []
    for data in sorted(place.glob("*.gcda")):
        shutil.copy(objects / f"{data.stem}.gcno", place)
        files.append(str(data))
    command = ["gcov", "--json-format", "--stdout", *files]
    report = subprocess.run(command, cwd=work, check=True, capture_output=True, text=True)
    return {
        (source["file"], line["line_number"])
        for unit in report.stdout.splitlines()
        for source in json.loads(unit)["files"]
        if source["file"].startswith("csrc/")
        for line in source["lines"]
        if line["count"] > 0
    }


class Survey:
    """Which tests execute a line, and how long they take."""

    def __init__(self, work):
        self.seconds, self.home = defaultdict(float), {}
        for case in ElementTree.parse(work / "python.xml").iter("testcase"):
            if case.find("failure") is not None or case.find("error") is not None:
                continue  # what fails by itself says nothing of a mutant
            file = case.get("classname").replace(".", "/") + ".py"
            function = case.get("name").split("[")[0]
            self.home[f"{Path(file).stem}.{function}"] = node = f"{file}::{function}"
            self.seconds[node] += float(case.get("time"))
            self.seconds[file] += float(case.get("time"))
        names = {node.split("::")[0] for node in self.home.values()}
        self.words = {name: (work / name).read_text() for name in names}
        self.core = json.loads((work / "core.json").read_text())
        self.lines = self._python(work)

    def _python(self, work):
        """Return the tests of each line of each module."""
        from coverage.numbits import numbits_to_nums

        ask = """select file.path, context.context, line_bits.numbits from line_bits
                 join file on file.id = file_id join context on context.id = context_id"""
        lines = defaultdict(lambda: defaultdict(list))
        with sqlite3.connect(work / ".coverage") as data:
            for path, context, bits in data.execute(ask):
                if node := self.home.get(context):
                    for line in numbits_to_nums(bits):
                        lines[path.removeprefix(f"{work}/")][line].append(node)
        return lines

    def of_python(self, mutant, text):
        """Return tests of a place in a module: of its line, or of where its name is used."""
        rows = self.lines[mutant.path]
        found = rows.get(mutant.line)
        if not found:  # executed when it is imported
            name = re.match(r"[ \t]*(\w+)", text.split("\n")[mutant.line - 1])
            used = name and re.compile(rf"\b{name[1]}\b")
            said = [k for k, row in enumerate(text.split("\n"), 1) if used and used.search(row)]
            found = sorted({node for k in said for node in rows.get(k, ())})
        found = found or sorted({node for row in rows.values() for node in row})
        return sorted(found, key=lambda node: (self.rank(node, mutant), node))

    def of_core(self, mutant):
        """Return C tests of a line or of the nearest before it, and modules of Python tests."""
        line = mutant.line
        while line > 1 and f"{mutant.path}:{line}" not in self.core:
            line -= 1
        chapter = mutant.path.split("/")[1]
        asked = [name for name in self.words if name.split("/")[1] in CHAPTERS[chapter]]
        programs = self.core.get(f"{mutant.path}:{line}", [])
        said = (chapter, Path(mutant.path).stem)
        near = {name: sum(word in self.words[name] for word in said) for name in asked}
        order = {name: (0.5 + self.seconds[name]) / 4 ** near[name] for name in asked}
        return programs, sorted(asked, key=lambda name: (order[name], name))

    def rank(self, test, mutant):
        """Seconds, fewer for a test of the same chapter and of the same name."""
        folder = mutant.path.split("/")[1]
        near = 4.0 if test.split("/")[1] == folder else 1.0
        same = 8.0 if Path(mutant.path).stem in test.split("::")[0].split("/")[-1] else 1.0
        return (0.05 + self.seconds[test]) / (near * same)


# --- one mutant -----------------------------------------------------------------------------------


def run(command, work, seconds):
    """Return status and last words of a command that has so many seconds of a processor."""
    process = subprocess.Popen(
        ["prlimit", f"--cpu={int(seconds)}", *map(str, command)], cwd=work, text=True,
        env=environment_of(work), start_new_session=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    try:
        words, _ = process.communicate(timeout=8 * seconds)  # of a machine that others use too
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        words, _ = process.communicate()
    if process.returncode in (-signal.SIGKILL, -signal.SIGXCPU):
        return process.returncode, "time"
    failed = [row for row in words.split("\n") if row.startswith(("FAILED", "ERROR"))]
    return process.returncode, (failed or words.strip().split("\n"))[-1][:120]


class Run:
    """Meets mutants with tests."""

    def __init__(self, work, seconds, also=()):
        self.work, self.seconds, self.also = work, seconds, list(also)
        self.core = Core(work, "objects", "-O1")
        self.core.build()
        self.core.extension()
        self.survey = Survey(work)

    def meet(self, mutant):
        """Return verdict ("killed", "survived", or "none" for no fault) and what decided it."""
        path = self.work / mutant.path
        text = path.read_text()
        path.write_text(mutant.apply(text))
        try:
            meet = self._meet_python if mutant.path.endswith(".py") else self._meet_core
            return meet(mutant, text)
        finally:
            path.write_text(text)

    def _pytest(self, tests):
        """Run tests, the first of them first, until one fails or time is over."""
        chosen, left = list(self.also), self.seconds
        for test in tests:
            left -= self.survey.seconds[test]
            if len(chosen) > len(self.also) and left < 0:
                break
            chosen.append(test)
        command = [sys.executable, *PYTEST, "-x", "--tb=no", *chosen]
        status, words = run(command, self.work, 20 + 2 * self.seconds)
        whole = f"{len(chosen)} of {len(tests)}"
        return ("survived", whole) if status in (0, 5) else ("killed", words)

    def _meet_python(self, mutant, text):
        tests = self.survey.of_python(mutant, text)
        return self._pytest([mutant.path, *tests])  # its doctests first

    def _meet_core(self, mutant, _):
        core = self.core
        folder = core.objects / "mutant"
        folder.mkdir(exist_ok=True)
        changed = [source for source in core.sources if mutant.path in core.needs(source)]
        for source in changed:
            try:
                if not core.compile(source, folder, 200.0):
                    return "none", "does not compile"
            except subprocess.TimeoutExpired:
                return "none", "takes long to compile"
        pairs = [(core.object_of(s), core.object_of(s, folder)) for s in changed]
        if all(old.read_bytes() == new.read_bytes() for old, new in pairs):
            return "none", "the same object code"
        programs, modules = self.survey.of_core(mutant)
        for source in programs:
            status, words = run([core.program(source, changed)], self.work, 60.0)
            if status != 0:
                return "killed", f"{Path(source).stem}: {words}"
        if not modules:
            return "survived", f"{len(programs)} C tests"
        core.extension(changed)
        try:
            verdict, words = self._pytest(modules)
        finally:
            core.extension()
        return verdict, f"{len(programs)} C tests, {words}" if verdict == "survived" else words


def copy(source, target):
    """Copy files that differ; what is as it was keeps its time."""
    if source.is_dir():
        target.mkdir(exist_ok=True)
        for one in source.iterdir():
            if one.name not in ("build", "__pycache__") and not one.name.startswith("_core.cpy"):
                copy(one, target / one.name)
    elif not target.exists() or target.read_bytes() != source.read_bytes():
        shutil.copyfile(source, target)


def prepared(work):
    """Copy the repository, what is as it was left alone, and survey it once."""
    work.mkdir(parents=True, exist_ok=True)
    for name in COPIED:
        copy(ROOT / name, work / name)
    core = Core(work, "objects", "-O1")
    core.build()
    core.extension()
    if not (work / "python.xml").exists():
        survey_python(work)
    if not (work / "core.json").exists():
        survey_core(work)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--count", type=int, default=200, help="mutants")
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "mutation")
    parser.add_argument("--seconds", type=float, default=30.0, help="of tests for each mutant")
    parser.add_argument("--under", default="", help="only files whose path begins so")
    parser.add_argument("--again", action="store_true", help="meet the survivors again")
    parser.add_argument("--also", nargs="*", default=(), help="tests that each meets first")
    given = parser.parse_args()
    # of what a shell runs in the background it lets Ctrl-C be ignored, which tests send
    signal.signal(signal.SIGINT, signal.default_int_handler)
    work = given.work.resolve()
    prepared(work)
    sys.path.insert(0, str(ROOT / "tests" / "support"))
    from mutants import Mutant, every_mutant

    kept = work / f"found-{given.seed}{given.under.replace('/', '-')}.json"
    found = json.loads(kept.read_text()) if kept.exists() else []
    meets = Run(work, given.seconds, given.also)
    if given.again:
        drawn = [Mutant(*row["mutant"]) for row in found if row["verdict"] == "survived"]
        found = [row for row in found if row["verdict"] != "survived"]
    else:
        every = [one for one in every_mutant(work) if one.path.startswith(given.under)]
        drawn = random.Random(given.seed).sample(every, min(5 * given.count, len(every)))
        drawn = drawn[len(found) :]
    for mutant in drawn:
        if not given.again and sum(row["verdict"] != "none" for row in found) >= given.count:
            break
        before, after = mutant.shown((work / mutant.path).read_text())
        begun = time.perf_counter()
        verdict, words = meets.meet(mutant)
        found.append({"mutant": mutant, "verdict": verdict, "words": words, "before": before})
        found[-1]["after"] = after
        kept.write_text(json.dumps(found, indent=1))
        took = time.perf_counter() - begun
        print(f"{took:5.0f} s  {verdict:8}  {mutant.path}:{mutant.line}  {words}", flush=True)
    report(found)


def report(found):
    """Print what survived."""
    real = [row for row in found if row["verdict"] != "none"]
    survived = [row for row in real if row["verdict"] == "survived"]
    print(f"\n{len(real)} mutants, {len(real) - len(survived)} killed, {len(survived)} survived\n")
    for row in survived:
        print(f"- `{row['mutant'][0]}:{row['mutant'][1]}` ({row['words']})")
        print(f"  `{row['before']}`\n  `{row['after']}`")


if __name__ == "__main__":
    main()
