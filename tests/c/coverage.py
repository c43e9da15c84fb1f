#!/usr/bin/env python3
"""Which lines of the core its C tests run: coverage.py <csrc> <folder of gcov's files>."""

import gzip
import json
import subprocess
import sys
import tempfile
from pathlib import Path

LEAST = 0.9
"""Share of the lines of the core, and of every file of more than a few, that has to run."""


def lines_run(core, build):
    """How often each line ran, in whichever source it was included: {path: {line: count}}."""
    counts = {}
    notes = sorted(str(path) for path in build.glob("*.gcno"))
    with tempfile.TemporaryDirectory() as folder:
        command = ["gcov", "--json-format", "--preserve-paths", *notes]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
        for path in sorted(Path(folder).glob("*.json.gz")):
            for file in json.loads(gzip.decompress(path.read_bytes()))["files"]:
                name = Path(file["file"]).resolve()
                if name.is_relative_to(core):
                    found = counts.setdefault(name.relative_to(core).as_posix(), {})
                    for line in file["lines"]:
                        number = line["line_number"]
                        found[number] = found.get(number, 0) + line["count"]
    return counts


def main(core, build):
    """Print the share of lines that ran, by file; exit with 1 where it is below the least."""
    counts = lines_run(Path(core).resolve(), Path(build))
    missed = {name: sorted(k for k, n in found.items() if not n) for name, found in counts.items()}
    share = {name: 1 - len(missed[name]) / len(found) for name, found in counts.items()}
    for name in sorted(share, key=share.get):
        lines = " ".join(map(str, missed[name]))
        print(f"{share[name]:7.1%} of {len(counts[name]):4} lines of {name}  {lines}".rstrip())
    all_lines = sum(map(len, counts.values()))
    whole = 1 - sum(map(len, missed.values())) / all_lines
    print(f"{whole:7.1%} of {all_lines} lines of the core")
    sys.exit(whole < LEAST)


if __name__ == "__main__":
    main(*sys.argv[1:])
