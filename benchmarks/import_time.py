"""What `import ropedyn` adds to `import numpy`: medians of fresh processes, in turn.

python benchmarks/import_time.py
"""

import statistics
import subprocess
import sys
import time

RUNS = 15


def seconds(code: str) -> float:
    start = time.perf_counter()
    subprocess.run([sys.executable, "-c", code], check=True)
    return time.perf_counter() - start


def main() -> None:
    codes = {"python": "pass", "numpy": "import numpy", "ropedyn": "import ropedyn"}
    times: dict[str, list[float]] = {name: [] for name in codes}
    for code in codes.values():
        seconds(code)  # warm the file cache
    for _ in range(RUNS):
        for name, code in codes.items():
            times[name].append(seconds(code))
    median = {name: 1000 * statistics.median(values) for name, values in times.items()}
    print(f"import numpy:   {median['numpy'] - median['python']:.0f} ms")
    print(f"import ropedyn: {median['ropedyn'] - median['python']:.0f} ms")
    print(f"ropedyn adds:   {median['ropedyn'] - median['numpy']:.0f} ms to numpy")


if __name__ == "__main__":
    main()
