"""Write VALIDATION.md: ``python tests/validation.py`` measures what is due, ``--slow`` samples too.

A row is due where files that it covers (tests/covers.py) have changed since it was
measured; ``--due`` says which are. Of rows that a merge left twice the later one is kept, and its
marks go.
"""

import argparse
import platform
import re
import subprocess
import sys
from pathlib import Path

import covers
import pytest
from claims import MEASURED, MOST, claim_of

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "VALIDATION.md"
HEAD = """# What is validated

One row for each physical claim: what it is measured against, the worst error measured, the error
accepted, within 100 times that, and the test that asserts it. `python tests/validation.py` writes
this page; every number comes from the tests. `files` is a hash of the test and of the folders that
its row covers, as tests/covers.py lists them: where they have changed since, the row is due to be
measured again, which CI asks for; of large samples `--due` lists them. The condition of an answer h
is 1 + the sum of |d ln h/d ln p| over p = section, tension, springs, inertia,
dashpots: `condition` in tests/support/exact_chain.py.

"""
LIMITS = """
## Limits, and where another choice is better

"""
SLOW = """
## Large samples

Run by `python tests/validation.py --slow` before a release; kept from the last such run otherwise.

"""
MARKS = {False: "claim and not slow", True: "claim"}
"""What is run, without and with the large samples."""
COLUMNS = ["claim", "reference", "measured", "accepted", "test", "files"]
SLOW_COLUMNS = [*COLUMNS[:-1], "commit", "machine", "files"]
ROW = re.compile(
    r"^\| .*\| (?P<measured>\S+) \| (?P<accepted>\S+) \| `(?P<test>\S+)` "
    r"\|(?:.* (?P<files>[0-9a-f]{8}) \|)?.*$",
    re.M,
)


class Recorder:
    """Collects claims, and the worst number measured for each test function."""

    def __init__(self):
        self.claims = {}
        self.in_ci = set()
        self.worst = {}

    @pytest.hookimpl(tryfirst=True)
    def pytest_collection_modifyitems(self, items):
        for item in items:
            claim = claim_of(item)
            if claim:
                name = item.nodeid.partition("[")[0]
                self.claims[name] = claim
                if not item.get_closest_marker("slow"):
                    self.in_ci.add(name)

    @property
    def slow(self):
        """Claims of large samples alone."""
        return self.claims.keys() - self.in_ci

    def pytest_runtest_logreport(self, report):
        for key, value in report.user_properties:
            if report.when == "call" and key == MEASURED:
                name = report.nodeid.partition("[")[0]
                self.worst[name] = max(value, self.worst.get(name, value))


def asked(*arguments):
    """Run pytest; return what it recorded, or exit with its status if it fails."""
    recorder = Recorder()
    status = pytest.main(["-q", "-p", "no:cacheprovider", *arguments], [recorder])
    if status:
        sys.exit(int(status))
    return recorder


def collected():
    """Return all claims, the large samples among them."""
    # -m "": these too; in this process, which gathers them
    return asked("-qq", "--collect-only", "-m", "", "--numprocesses=0", str(ROOT / "tests"))


def due(recorder, page, names):
    """Those of the tests without a row of the page that the files are as they were for."""
    rows = rows_of(page)
    for name in sorted(names):
        if name not in rows or ROW.fullmatch(rows[name])["files"] != covers.state(name):
            yield name


def rows_of(page):
    """Rows of a page by test; of two the later."""
    return {found["test"]: found.group() for found in ROW.finditer(page)}


def number(value):
    return f"{value:.2g}"


def start_of_row(name, claim):
    return f"| {claim.what.replace('|', '&#124;')} | {claim.reference} | "


def row(name, claim, measured, where=()):
    cells = [number(measured), number(claim.accepted), f"`{name}`", *where, covers.state(name)]
    return start_of_row(name, claim) + " | ".join(cells) + " |"


def table(rows, columns=COLUMNS):
    return "\n".join(["| " + " | ".join(columns) + " |", "|---" * len(columns) + "|", *rows, ""])


def where():
    """Commit and machine of a slow run."""
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    ).stdout.strip()
    info = Path("/proc/cpuinfo")  # where there is one
    text = info.read_text(encoding="utf-8") if info.exists() else ""
    names = [*re.findall(r"model name\s*: (.*)", text), platform.processor(), "unknown"]
    return [commit or "unknown", next(filter(None, names))]


def written(recorder, old):
    """The page: measured rows, slow ones that were not measured as they were."""
    kept, parts = rows_of(old), {HEAD: [], LIMITS: [], SLOW: []}
    for name, claim in sorted(recorder.claims.items()):
        slow = name in recorder.slow
        place = parts[SLOW if slow else LIMITS if claim.limit else HEAD]
        if name in recorder.worst:
            place.append(row(name, claim, recorder.worst[name], where() if slow else ()))
        elif name in kept:
            place.append(kept[name])
    return "".join(
        head + table(rows, SLOW_COLUMNS if head is SLOW else COLUMNS)
        for head, rows in parts.items()
    )


def differences(recorder, page):
    """What of the page is not what the tests claim."""
    rows = rows_of(page)
    for name in sorted(rows.keys() - recorder.claims.keys()):
        yield f"no test {name}"
    for name, claim in sorted(recorder.claims.items()):
        if name not in rows:
            continue
        found = ROW.fullmatch(rows[name])
        if not rows[name].startswith(start_of_row(name, claim)):
            yield f"other words at {name}"
        if found["accepted"] != number(claim.accepted):
            yield f"another bound at {name}"
        measured, accepted = float(found["measured"]), float(found["accepted"])
        if measured > accepted:
            yield f"measured beyond accepted at {name}"
        # one rounding is as little as is measured, what is less is luck
        if accepted > MOST * max(measured, 2**-52) and measured > 0 and not claim.wide:
            yield f"accepted more than {MOST} times what is measured at {name}"
    for name in due(recorder, page, recorder.in_ci):
        yield f"due: {name}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--slow", action="store_true", help="measure the large samples too")
    parser.add_argument("--all", action="store_true", help="those that are not due too")
    parser.add_argument("--only", default="", help="those whose name has this regular expression")
    parser.add_argument("--due", action="store_true", help="say what is due, measure nothing")
    parser.add_argument("--check", action="store_true", help="compare the page with the claims")
    given = parser.parse_args()
    old = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    recorder = collected()
    if given.check:
        found = list(differences(recorder, old))
        sys.exit("\n".join(["VALIDATION.md is out of date:", *found]) if found else 0)
    # of what is due the large samples are told apart
    names = recorder.claims if given.slow or given.due else recorder.in_ci
    wanted = names if given.all else due(recorder, old, names)
    wanted = [name for name in wanted if re.search(given.only, name)]
    if given.due:
        print(
            *(f"{'slow' if name in recorder.slow else 'fast'}  {name}" for name in wanted), sep="\n"
        )
        return
    if wanted:
        paths = [str(ROOT / name) for name in wanted]
        recorder.worst = asked("-m", MARKS[given.slow], *paths).worst
    PAGE.write_text(written(recorder, old), encoding="utf-8")


if __name__ == "__main__":
    main()
