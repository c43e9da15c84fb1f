"""A function of a universal file, as its specification has it."""

import numpy as np


def function(
    value=(1 + 2j, 3 - 4j),
    *,
    response=(1, 3),
    drive=(2, 3),
    kinds=(12, 13),
    labels=("NONE", "NONE"),
    abscissa=(18, "Hz"),
    function_type=4,
    single=False,
    uneven=None,
):
    """Return one dataset 58 as its specification has it, written without pyuff."""
    value = np.asarray(value)
    is_complex = np.iscomplexobj(value)
    kind = (5 if single else 6) if is_complex else (2 if single else 4)
    side = "{:>10d}" + 3 * "    0" + " {:<20} {:<20}"
    even = f"{1.0:13.5e}{0.25:13.5e}" if uneven is None else 2 * f"{0.0:13.5e}"
    lines = ["    -1", "    58", *["NONE"] * 5]
    lines += [
        f"{function_type:5d}{0:10d}{0:5d}{0:10d} {'NONE':10}{response[0]:10d}{response[1]:4d} "
        f"{'NONE':10}{drive[0]:10d}{drive[1]:4d}",
        f"{kind:10d}{len(value):10d}{int(uneven is None):10d}{even}{0.0:13.5e}",
        side.format(abscissa[0], "NONE", abscissa[1]),
        side.format(kinds[0], "NONE", labels[0]),
        side.format(kinds[1], "NONE", labels[1]),
        side.format(0, "NONE", "NONE"),
    ]
    parts = value.view(np.float64).reshape(len(value), -1) if is_complex else value[:, np.newaxis]
    form = "{:13.5e}" if single else "{:20.12e}"
    if uneven is not None:
        rows = [f"{x:13.5e}" + "".join(map(form.format, row)) for x, row in zip(uneven, parts)]
        lines += ["".join(rows)] if single else rows
    else:
        flat, width = parts.ravel(), 6 if single else 4
        cut = [flat[k : k + width] for k in range(0, len(flat), width)]
        lines += ["".join(map(form.format, row)) for row in cut]
    return "\n".join([*lines, "    -1", ""])
