"""What the benchmarks write: the machine, tables and figures, kept in benchmarks/results."""

from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results"


def machine() -> str:
    """Name the processor and the vector instructions that matter here."""
    info = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    fields = dict(
        [part.strip() for part in line.split(":", 1)] for line in info.splitlines() if ":" in line
    )
    flags = fields.get("flags", "").split()
    vectors = next((name for name in ("avx512f", "avx2") if name in flags), "no AVX2")
    return f"{fields.get('model name', 'unknown processor')} ({vectors}), one thread"


def write(name: str, text: str) -> None:
    """Print a result and keep it."""
    print(text)
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / name).write_text(text + "\n", encoding="utf-8")


def table(head: list[str], rows: list[list[str]]) -> str:
    """Lay out a Markdown table with columns of one width, text left and numbers right."""
    widths = [max(map(len, column)) for column in zip(head, *rows)]
    line = ["-" * (w - 1) + (":" if k else "-") for k, w in enumerate(widths)]
    laid = [
        [c.rjust(w) if k else c.ljust(w) for k, (c, w) in enumerate(zip(row, widths))]
        for row in (head, line, *rows)
    ]
    return "\n".join("| " + " | ".join(row) + " |" for row in laid)


def digits(value: float | None) -> str:
    """Write a number with two digits, nothing as a dash."""
    if value is None:
        return "-"
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"


def panels() -> tuple[Any, Any]:
    """Return a figure and its two rows of two axes, with the scale shared along a row."""
    import matplotlib as mpl

    mpl.use("agg")
    import matplotlib.pyplot as plt

    return plt.subplots(2, 2, figsize=(10, 8), sharex=True, sharey="row")


def save(figure: Any, axes: Any, name: str, title: str, labels: tuple[str, str]) -> None:
    """Finish a figure, `labels` beside its two rows, legends in the left column, and keep it."""
    for (left, _), label in zip(axes, labels):
        left.set_ylabel(label)
        left.legend(fontsize=9)
    for ax in axes.flat:
        ax.grid(alpha=0.3)
    figure.suptitle(title)
    figure.tight_layout()
    RESULTS.mkdir(exist_ok=True)
    figure.savefig(RESULTS / name, dpi=130)
