"""`import ropedyn` brings NumPy and the core; what else is needed comes when it is used."""

import subprocess
import sys

import pytest

LATER = ("scipy", "matplotlib", "pandas", "xarray", "h5netcdf", "h5py", "pyuff", "tomli_w", "pint")
LATER += ("dask", "distributed", "cloudpickle", "multiprocessing")
ROPE = "rd.Rope(1.0, 0.1, bending_stiffness=1.0)"
WORK = {
    "import": "",
    "scene": f"rd.Scene({ROPE}).without('tension')",
    "modes": f"rd.Scene({ROPE}).compile(elements=4).modes(2)",
    "frf": f"rd.Scene({ROPE}).compile(elements=4).frf([1.0], drive=('z', 0.5)).table()",
    "accuracy": f"rd.accuracy_cost(rd.Scene({ROPE}), rd.ask.modes(1), elements=4).table()",
    "effects": f"rd.effect_cost(rd.Scene({ROPE}), rd.ask.modes(1)).table()",
    "static": f"rd.Scene({ROPE}).compile(elements=4).static({{('z', 0.5): 1.0}})",
    "peaks": "str(rd.Peaks([1.0, 2.0]))",
    "sweep": "rd.sweep(abs, [-1.0]).table()",
}


def run(code):
    """Run code in a fresh interpreter that lets nothing pass in silence."""
    command = [sys.executable, "-W", "error", "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


@pytest.mark.parametrize("work", WORK)
def test_heavy_libraries_are_not_imported_before_they_are_used(work):
    code = (
        f"import sys, ropedyn as rd\n{WORK[work]}\nprint(*[m for m in {LATER} if m in sys.modules])"
    )
    assert run(code).split() == []


# the same check sees a library that is used: what is compared is really there
@pytest.mark.parametrize(
    ("work", "library"),
    [
        (f"rd.Scene({ROPE}).compile(elements=4).stiffness()", "scipy"),
        ("rd.Peaks([1.0]).plot()", "matplotlib"),
        ("rd.Peaks([1.0]).to_dataframe()", "pandas"),
    ],
)
def test_heavy_libraries_are_imported_by_what_needs_them(work, library):
    code = f"import sys, ropedyn as rd\n{work}\nprint(*[m for m in {LATER} if m in sys.modules])"
    assert library in run(code).split()


def test_plotting_opens_no_window_and_no_pyplot():
    code = "import sys, ropedyn as rd\nrd.Peaks([1.0]).plot()\nprint(*sys.modules)"
    loaded = run(code).split()
    assert "matplotlib" in loaded
    assert "matplotlib.pyplot" not in loaded


def test_every_public_name_is_there():
    code = "import ropedyn as rd\nprint(*[n for n in rd.__all__ if not hasattr(rd, n)])"
    assert run(code).split() == []


def test_import_prints_nothing():
    assert run("import ropedyn") == ""


def test_star_import_brings_the_public_names_alone():
    code = "before = set(dir())\nfrom ropedyn import *\nprint(*set(dir()) - before - {'before'})"
    import ropedyn

    assert set(run(code).split()) == set(ropedyn.__all__)
