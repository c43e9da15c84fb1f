"""Write VALIDATION.md: ``python tests/validation.py`` runs every claim, ``--slow`` samples too."""

import argparse
import re
import subprocess
import sys
from pathlib import Path

import pytest
from claims import MEASURED, claim_of

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "VALIDATION.md"
HEAD = """# What is validated

One row for each physical claim: what it is measured against, the worst error measured, the error
accepted, and the test that asserts it. `python tests/validation.py` writes this page; every number
comes from the tests. The condition of an answer h is 1 + the sum of |d ln h/d ln p| over p =
section, tension, springs, inertia, dashpots: `condition` in tests/support/exact_chain.py.

"""
LIMITS = """
## Limits, and where another choice is better

"""
SLOW = """
## Large samples

Run by `python tests/validation.py --slow`; kept from the last such run otherwise.

"""
MARKS = {False: "claim and not slow", True: "claim"}
"""What is run, without and with the large samples."""
COLUMNS = ["claim", "reference", "measured", "accepted", "test"]
ROW = re.compile(r"^\| .*\| (?P<measured>\S+) \| (?P<accepted>\S+) \| `(?P<test>\S+)`.*\|$", re.M)


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


def collected(*arguments):
    """Run or only collect the claims; exit with pytest's status if it fails."""
    recorder = Recorder()
    # one process: what tests measured is gathered in this one
    options = ["-q", "-p", "no:cacheprovider", "--numprocesses=0", *arguments]
    status = pytest.main([*options, str(ROOT / "tests")], [recorder])
    if status:
        sys.exit(int(status))
    return recorder


def rows_of(page):
    """Rows of a page by test."""
    return {found["test"]: found.group() for found in ROW.finditer(page)}


def number(value):
    return f"{value:.2g}"


def start_of_row(name, claim):
    return f"| {claim.what.replace('|', '&#124;')} | {claim.reference} | "


def row(name, claim, measured, where=()):
    cells = [number(measured), number(claim.accepted), f"`{name}`", *where]
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
    names = re.findall(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"))
    return [commit or "unknown", names[0] if names else "unknown"]


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
        head + table(rows, [*COLUMNS, "commit", "machine"] if head is SLOW else COLUMNS)
        for head, rows in parts.items()
    )


def differences(recorder, page):
    """What of the page is not what the tests claim."""
    rows = rows_of(page)
    for name in sorted(rows.keys() - recorder.claims.keys()):
        yield f"no test {name}"
    for name, claim in sorted(recorder.claims.items()):
        if name not in rows:
            # a large sample may not have been run yet
            if name not in recorder.slow:
                yield f"no row of {name}"
            continue
        found = ROW.fullmatch(rows[name])
        if not rows[name].startswith(start_of_row(name, claim)):
            yield f"other words at {name}"
        if found["accepted"] != number(claim.accepted):
            yield f"another bound at {name}"
        if float(found["measured"]) > float(found["accepted"]):
            yield f"measured beyond accepted at {name}"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--slow", action="store_true", help="run the large samples too")
    parser.add_argument("--only", default="", help="those of such names, as pytest's -k has them")
    parser.add_argument("--check", action="store_true", help="compare the page with the claims")
    given = parser.parse_args()
    old = PAGE.read_text(encoding="utf-8") if PAGE.exists() else ""
    if given.check:
        # -m "" : the slow ones too
        found = list(differences(collected("--collect-only", "-qq", "-m", ""), old))
        sys.exit("\n".join(["VALIDATION.md is out of date:", *found]) if found else 0)
    recorder = collected("-m", MARKS[given.slow], "-k", given.only)
    PAGE.write_text(written(recorder, old), encoding="utf-8")


if __name__ == "__main__":
    main()
