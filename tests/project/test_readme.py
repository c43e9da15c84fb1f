"""What the README and the pages say in Python and as commands runs, and gives their numbers."""

import ast
import inspect
import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from dataset58 import function

import ropedyn as rd
from ropedyn.base import progress
from ropedyn.cli import options
from ropedyn.cli.command import main, parser

ROOT = Path(__file__).parent.parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDE = (ROOT / "docs/guide.md").read_text(encoding="utf-8")
TUTORIALS = sorted((ROOT / "docs/tutorials").glob("*.md"))
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *TUTORIALS]


def blocks(text, language):
    return re.findall(rf"^```{language}\n(.*?)^```", text, flags=re.M | re.S)


def commands(text):
    """Return the lines of a page that call ropedyn, without where they print to."""
    lines = [line for block in blocks(text, "text") for line in block.splitlines()]
    return [line.partition(">")[0] for line in lines if line.startswith("ropedyn ")]


def run(text, folder):
    """Return the names that the blocks have bound, run one after another in a folder."""
    bound = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for block in blocks(text, "python"):
            exec(compile(block, "page", "exec"), bound)
    return bound


@pytest.fixture(scope="module")
def first_screen(tmp_path_factory):
    return run(README, tmp_path_factory.mktemp("readme"))


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    return run(GUIDE, tmp_path_factory.mktemp("guide"))


def held(fit, text, digits, scale=1.0):
    """Hold status, tension and interval against the first comment that has them."""
    unit = "MN" if scale > 1 else "N"
    pattern = rf"# (?:(\w+), )?(\S+) {unit}, from (\S+) to (\S+)(?: {unit})?\n"
    status, *printed = re.search(pattern, text).groups()
    numbers = [fit.value["tension"], *fit.interval(0.95)["tension"]]
    assert [f"{one / scale:.{digits}f}" for one in numbers] == printed
    assert status in (None, fit.status)


def test_first_tension_is_the_one_that_is_printed(first_screen):
    held(first_screen["fit"], README, 2, 1e6)
    assert np.isfinite(first_screen["frf"].value).all()


def test_first_commands_give_the_same_tension_and_response(
    first_screen, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    example, tension, response = commands(README)[:3]
    assert main(shlex.split(example)[1:]) == 0
    Path("rope.toml").write_text(capsys.readouterr().out, encoding="utf-8")
    assert main(shlex.split(tension)[1:]) == 0
    printed = re.search(r"^tension +(\S+) MN   95 %: (\S+) to (\S+) MN", capsys.readouterr().out)
    fit = first_screen["fit"]
    numbers = [fit.value["tension"], *fit.interval(0.95)["tension"]]
    assert printed.groups() == tuple(f"{one / 1e6:.4g}" for one in numbers)
    assert main([*shlex.split(response)[1:], "--csv"]) == 0
    rows = [line.split(",") for line in capsys.readouterr().out.splitlines()[1:]]
    assert [float(row[1]) for row in rows] == np.abs(first_screen["frf"].value[0]).tolist()
    assert Path("frf.png").stat().st_size > 0


def test_fit_is_the_one_that_is_printed(names):
    held(names["fit"], GUIDE, 3)


def test_tension_of_the_record_is_the_one_that_is_printed(names):
    held(names["signed"], GUIDE, 1, 1e6)


def test_answers_are_finite(names):
    assert np.isfinite(names["frf"].value).all()
    assert np.isfinite(names["tip"].value).all()
    assert names["damped"].damping_ratio[0] > 0
    assert names["sticks"].value[0, -1] != 0  # friction holds the rope off its rest
    many = names["many"]
    assert (many.frequency.shape, many.derivative.shape) == ((1000, 10), (1000, 10, 3))
    assert many.certified.all() and many.failed == {}


@pytest.mark.parametrize("name", ["cannot_tell", "index"])
def test_blocks_of_other_pages_run(name, tmp_path):
    assert run((ROOT / f"docs/{name}.md").read_text(encoding="utf-8"), tmp_path)


SHOWN = r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```)?"


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.stem)
def test_tutorials_print_what_they_show(path, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("tests").symlink_to(ROOT / "tests")
    bound = {}
    for block, shown in re.findall(SHOWN, path.read_text(encoding="utf-8"), flags=re.M | re.S):
        exec(compile(block, path.name, "exec"), bound)
        printed = capsys.readouterr().out
        assert printed == ("" if shown.startswith("ropedyn ") else shown)


def test_no_page_has_python_that_nothing_runs():
    pages = [path for path in (ROOT / "docs").rglob("*.md") if "generated" not in path.parts]
    having = {path.stem for path in pages if blocks(path.read_text(encoding="utf-8"), "python")}
    ran = {"guide", "cannot_tell", "index", *(path.stem for path in TUTORIALS)}
    assert having <= ran


MEASURED = r"\]\(((?:benchmarks/results/|docs/measured|docs/hard|VALIDATION)[^)#]*md)"
FIGURE = r"(?<![\w.^-])\d+(?: \d{3})*(?:\.\d+)?(?:e[+-]?\d+)?(?: %)?"


def figures(text):
    """Return the numbers of a text as written, what links and code say left out."""
    plain = re.sub(r"\]\([^)]*\)|`[^`]*`", "", text)
    return [re.sub(r" (?=\d)", "", one) for one in re.findall(FIGURE, plain)]


def stands_in(number, found):
    """Whether one of the numbers is this one in so many digits; a share may be in per cent."""
    text = number.removesuffix(" %")
    digits = re.sub(r"e.*|\.", "", text).lstrip("0")
    places = len(digits.rstrip("0") if "." not in text else digits) - 1
    each = [float(one.removesuffix(" %")) for one in found]
    each += [100 * one for one in each if text != number]
    return any(f"{one:.{places}e}" == f"{float(text):.{places}e}" for one in each)


def measured_claims():
    """Return of the README each row, item or paragraph with the pages of numbers it leads to."""
    for part in re.split(r"\n(?=\||- |\n)", README):
        if pages := re.findall(MEASURED, part):
            yield part.strip(), pages


@pytest.mark.parametrize(("text", "pages"), list(measured_claims()))
def test_numbers_of_the_readme_stand_on_the_pages_that_made_them(text, pages):
    made = [one for page in pages for one in figures((ROOT / page).read_text(encoding="utf-8"))]
    assert [one for one in figures(text) if not stands_in(one, made)] == []


@pytest.mark.long
def test_the_page_of_hard_cases_says_what_comes_of_them():
    page = " ".join((ROOT / "docs/hard.md").read_text(encoding="utf-8").split())
    first, last = rd.hard_cases().verdict.split(". ")
    assert f"runs {first.split()[2]} cases" in page
    assert last in page


@pytest.mark.parametrize(
    ("number", "found", "is_there"),
    [
        ("270", ["272"], True),
        ("0.29", ["0.286"], True),
        ("0.29", ["0.28"], False),
        ("1.6 %", ["0.016"], True),
        ("1.6", ["0.016"], False),
        ("4e-9", ["3.6e-09"], True),
    ],
)
def test_a_number_is_found_in_its_digits(number, found, is_there):
    assert stands_in(number, found) is is_there


def slugs(text):
    """Return the anchors of the headings of a page."""
    headings = re.findall(r"^#+ (.+)$", text, flags=re.M)
    return {re.sub(r"[^\w\- ]", "", one.lower()).strip().replace(" ", "-") for one in headings}


FOLDERS = ("docs", "benchmarks", "notebooks", "tests")
WRITTEN = [*ROOT.glob("*.md"), *(path for one in FOLDERS for path in (ROOT / one).rglob("*.md"))]
"""Every page, of the site or read where it lies."""
NAMED = {
    name
    for path in (ROOT / "docs").rglob("*.md")
    for name in re.findall(r"^\((\S+)\)=$", path.read_text(encoding="utf-8"), flags=re.M)
}
"""What pages of the site call places of their own, which Sphinx finds from any."""


@pytest.mark.parametrize("path", WRITTEN, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_to_files_and_headings(path):
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    for target, anchor in re.findall(r"\]\(([^)#:]*)(?:#([^)]*))?\)", text):
        # notebooks are pages of the gallery on the site
        at = (path.parent / target).resolve() if target else path
        if at.parent == ROOT / "docs/gallery" and at.suffix == ".ipynb":
            at = ROOT / "notebooks" / at.name
        assert at.exists(), target
        if anchor:
            assert anchor in slugs(at.read_text(encoding="utf-8")) | NAMED


def said_of_numbers():
    """Return what the page of commands says of numbers, with where the code has them."""
    wait = {2.0: "two"}[progress.PATIENCE]
    yield f"takes longer than {wait} seconds"
    for name in ("table", "tension"):
        schema = json.loads((ROOT / f"ropedyn/{name}-1.schema.json").read_text(encoding="utf-8"))
        yield f'"{schema["properties"]["schema"]["const"]}"'
    level = inspect.signature(rd.Fit.interval).parameters["level"].default
    yield f"with its {100 * level:g} % interval"
    for status in (options.SOLVED, options.REFUSED, options.BAD_INPUT, *options.STATUS.values()):
        yield f"\n| {status} | "


def test_numbers_of_the_page_of_commands_are_those_of_the_code():
    page = (ROOT / "docs/command_line.md").read_text(encoding="utf-8")
    said = [*said_of_numbers(), *("2015 study", "five figures")]
    assert [one for one in said if one not in page] == []
    left = re.sub(r"^```.*?^```|`[^`]*`|\{[^}]*\}", "", page, flags=re.M | re.S)
    for one in said:
        left = left.replace(one, "")
    assert re.findall(r"(?<![\w.])\d+", left) == []


def test_the_study_draws_five_figures(tmp_path, capsys):
    assert main(["study", "--folder", str(tmp_path)]) == 0
    assert len(list(tmp_path.glob("*.png"))) == capsys.readouterr().out.count("figure: ") == 5


def texts_of_help():
    """Return the texts of the command line's options and commands as its source has them."""
    for path in sorted((ROOT / "ropedyn/cli").glob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") in HELP:
                given = [*node.args, *(word.value for word in node.keywords)]
                words = [one for part in given for one in ast.walk(part)]
                yield from (n.value for n in words if isinstance(getattr(n, "value", 0), str))


HELP = {"option", "repeated", "switch", "Command", "Option"}
"""What takes texts of `--help`."""
EXAMPLES = r"such as .*|end:0:z|\.mp4|0 for none|values of 40 digits|@0\.5"
"""What they show; the digits are those of the cases (tests/study/test_hard_cases.py)."""


def test_numbers_of_help_are_not_typed_but_taken_from_the_code():
    texts = [re.sub(EXAMPLES, "", one) for one in texts_of_help()]
    assert len(texts) > 100
    assert [one for one in texts if re.search(r"\d", one)] == []


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_commands_have_the_options_they_are_shown_with(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("peaks.txt").write_text("2.110\n", encoding="utf-8")  # read where options are
    for line in commands(path.read_text(encoding="utf-8")):
        parser().parse_args(shlex.split(line)[1:])


@pytest.fixture
def measured(tmp_path, monkeypatch):
    """The files that the commands are shown with: two scenes, a record, peaks and a response."""
    monkeypatch.chdir(tmp_path)
    rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
    scene = rd.Scene(rope, tension=2830.0, damping=rd.RayleighDamping(4.0, 1e-5))
    scene.save("rope.toml")
    time, lines = np.arange(12_000) / 100.0, np.linspace(20.0, 400.0, 400)
    how = {"drive": ("z", 20.0), "modes": 10, "quantity": "acceleration"}
    wind = np.random.default_rng(1).normal(0.0, 30.0, len(time))
    cable = rd.Scene(rd.Rope(60.0, 80.0, bending_stiffness=1e6), tension=5e6)
    damped = cable.replace(damping=rd.ModalDamping(0.003)).compile()
    response = [("z", x) for x in (3.5, 6.0, 9.0)]
    np.savetxt("record.csv", damped.transient(time, force=wind, response=response, **how).value.T)
    Path("peaks.txt").write_text("2.110 0.003\n4.226 0.003\n6.349 0.003\n", encoding="utf-8")
    frf = scene.compile().frf(lines, drive=("z", 0.5), response=("z", 0.8))
    kinds = {"kinds": (8, 13), "response": (2, 3), "drive": (1, 3), "labels": ("m", "N")}
    Path("run1.uff").write_text(function(frf.value[0], **kinds, uneven=lines), encoding="ascii")


def test_commands_of_the_page_run_and_say_something(measured, capsys):
    page = (ROOT / "docs/command_line.md").read_text(encoding="utf-8")
    for line in re.findall(r"^ropedyn (.*)$", page, flags=re.M):
        command, _, file = line.partition(" > ")
        if command.startswith("hard"):
            continue  # takes half a minute: tests/study/test_hard_cases.py
        assert main(shlex.split(command)) in (0, 3), line
        said = capsys.readouterr().out
        assert len(said) > 50, line
        if file:
            Path(file).write_text(said, encoding="utf-8")
    assert {path.name for path in Path().glob("*.png")} >= {
        "modes.png",
        "overlay.png",
        "section.png",
    }


def test_the_first_screen_stays_short():
    assert README.count("\n") <= 150
