"""`import ropedyn` brings little; what is needed comes when a name is used."""

import subprocess
import sys

import ropedyn as rd

LATER = ("scipy", "matplotlib", "pandas", "xarray", "h5netcdf", "h5py", "pyuff", "tomli_w", "pint")
LATER += ("dask", "distributed", "cloudpickle", "multiprocessing")
ROPE = "rd.Rope(1.0, 0.1, bending_stiffness=1.0)"
WORK = {
    "import": "",
    "names": "[getattr(rd, name) for name in rd.__all__]",
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


def test_heavy_libraries_are_not_imported_before_they_are_used():
    lines = ["import sys, ropedyn as rd"]
    for name, work in WORK.items():
        lines += [work, f"print({name!r}, [m for m in {LATER} if m in sys.modules])"]
    assert run("\n".join(lines)).splitlines() == [f"{name} []" for name in WORK]


# the same check sees a library that is used: what is compared is really there
USES = {
    "scipy": f"rd.Scene({ROPE}).compile(elements=4).stiffness_matrix()",
    "matplotlib": "rd.Peaks([1.0]).plot()",
    "pandas": "rd.Peaks([1.0]).to_dataframe()",
}


def test_heavy_libraries_are_imported_by_what_needs_them_and_plotting_needs_no_pyplot():
    lines = ["import sys, ropedyn as rd"]
    for library, work in USES.items():
        lines += [f"print({library!r} in sys.modules)", work, f"print({library!r} in sys.modules)"]
        if library == "matplotlib":
            lines.append("print('pyplot:', 'matplotlib.pyplot' in sys.modules)")
    found = run("\n".join(lines)).splitlines()
    assert found == ["False", "True", "False", "True", "pyplot: False", "False", "True"]


def test_every_public_name_is_there_and_the_import_prints_nothing():
    code = "import ropedyn as rd\nprint([n for n in rd.__all__ if not hasattr(rd, n)])"
    assert run(code) == "[]\n"


def test_star_import_brings_the_public_names_alone():
    code = "before = set(dir())\nfrom ropedyn import *\nprint(*set(dir()) - before - {'before'})"
    assert set(run(code).split()) == set(rd.__all__)


def test_dir_shows_the_public_names_and_verbs_hide_behind_no_module():
    lines = ["import ropedyn as rd", "from ropedyn import *", "print(*dir(rd))"]
    lines.append("print([n for n in ('modes', 'frf', 'fit', 'peaks') if hasattr(rd, n)])")
    shown, hidden = run("\n".join(lines)).splitlines()
    assert shown.split() == sorted(rd.__all__)
    assert hidden == "[]"


def test_a_saved_answer_is_loaded_where_nothing_was_asked_before(tmp_path):
    path = str(tmp_path / "peaks.nc")
    rd.Peaks([1.0]).save(path)
    # libraries of the file may warn: what counts is what is loaded
    code = f"import ropedyn as rd\nprint(type(rd.load({path!r})).__name__)"
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "Peaks"
