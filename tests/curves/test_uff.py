"""Universal files: what is written is read, what other programs write, and what is damaged."""

import re
import struct

import numpy as np
import pytest
from dataset58 import function
from hypothesis import given, settings
from hypothesis import strategies as st

import ropedyn as rd

FREQUENCY = np.arange(40) * 0.5 + 20.0
UNEVEN = FREQUENCY**1.01
RNG = np.random.default_rng(5)


def numbers(rows, columns):
    """Return complex numbers of many magnitudes."""
    size = 10.0 ** RNG.integers(-12, 12, (rows, columns))
    return size * (RNG.normal(size=(rows, columns)) + 1j * RNG.normal(size=(rows, columns)))


def measured(frequency=FREQUENCY, **changes):
    given = {
        "drive": ("z", 0.1 + 0.2),
        "response": [("z", 0.1 + 0.2), ("beta", 1 / 3), ("alpha", 0.9)],
        "quantity": "accelerance",
        "coherence": RNG.uniform(size=(3, len(frequency))),
        "averages": 12.5,
    }
    return rd.Measured(frequency, numbers(3, len(frequency)), **given | changes)


def assert_points_are_kept(found, of):
    assert (found.drive, found.response) == (of.drive, of.response)
    assert (found.quantity, found.averages) == (of.quantity, of.averages)


@pytest.mark.parametrize("frequency", [FREQUENCY, UNEVEN], ids=["even", "uneven"])
@pytest.mark.parametrize("suffix", [".uff", ".unv"])
def test_a_binary_universal_file_keeps_every_bit(tmp_path, frequency, suffix):
    of = measured(frequency)
    of.write(tmp_path / f"a{suffix}", binary=True)
    found = rd.Measured.read(tmp_path / f"a{suffix}")
    assert_points_are_kept(found, of)
    for name in ("frequency", "value", "coherence"):
        np.testing.assert_array_equal(getattr(found, name), getattr(of, name))


@pytest.mark.claim(
    "ASCII universal file: numbers written and read, relative difference",
    "the numbers; dataset 58 in double precision as pyuff writes it has 12 digits",
    5e-12,
)
@pytest.mark.parametrize("frequency", [FREQUENCY, UNEVEN], ids=["even", "uneven"])
def test_an_ascii_universal_file_keeps_twelve_digits(tmp_path, frequency, claim):
    of = measured(frequency)
    of.write(tmp_path / "a.uff")
    found = rd.Measured.read(tmp_path / "a.uff")
    assert_points_are_kept(found, of)
    for name in ("real", "imag"):
        exact = getattr(of.value, name)
        # half a unit of the twelfth digit
        claim(np.abs(getattr(found.value, name) / exact - 1).max())
    np.testing.assert_allclose(found.coherence, of.coherence, rtol=5e-12)
    # start and step have six digits, and so has each frequency where they are not even
    np.testing.assert_allclose(found.frequency, frequency, rtol=5e-6 if frequency is UNEVEN else 0)


def test_twelve_digits_written_are_twelve_digits_read(tmp_path):
    measured().write(tmp_path / "a.uff")
    once = rd.Measured.read(tmp_path / "a.uff")
    once.write(tmp_path / "b.uff")
    assert (tmp_path / "a.uff").read_bytes() == (tmp_path / "b.uff").read_bytes()
    np.testing.assert_array_equal(rd.Measured.read(tmp_path / "b.uff").value, once.value)


def test_a_calculated_response_to_several_drives_is_read_drive_by_drive(tmp_path):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
    points = [("z", 0.5), ("z", 0.25)]
    frf = model.frf(FREQUENCY, drive=points, response=points)
    frf.write(tmp_path / "a.uff", binary=True)
    for d, drive in enumerate(points):
        found = rd.Measured.read(tmp_path / "a.uff", drive=drive)
        np.testing.assert_array_equal(found.value, frf.value[d])
    with pytest.raises(rd.SceneError, match=r"drive must be one of .* \('z', 0.5\), \('z', 0.25\)"):
        rd.Measured.read(tmp_path / "a.uff")


def test_a_binary_file_says_how_many_bytes_follow(tmp_path):
    of = measured(UNEVEN, coherence=None)
    of.write(tmp_path / "a.uff", binary=True)
    content = (tmp_path / "a.uff").read_bytes()
    at = content.index(b"    58b")
    size = int(content[at + 31 : at + 43])
    start = at
    for _ in range(12):
        start = content.index(b"\n", start) + 1
    # frequency, real and imaginary part, then the line that closes the dataset
    assert size == 3 * 8 * len(UNEVEN)
    assert content[start + size :].startswith(b"    -1\n")
    first = struct.unpack("<3d", content[start : start + 24])
    assert first == (UNEVEN[0], of.value[0, 0].real, of.value[0, 0].imag)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"response": ("F_z", 0.3)}, r"response\[0\] must be a coordinate"),
        ({"drive": ("end", 0, "z"), "response": ("z", 0.3)}, r"drive\[0\] must be a coordinate"),
        ({"frequency": [1.0]}, "at least two lines"),
        ({"frequency": [1000.0, 1000.0001, 1000.00021]}, "must increase in the 6 digits"),
    ],
)
def test_what_a_universal_file_has_no_words_for_is_refused(tmp_path, changes, words):
    given = {"frequency": [1.0, 2.0, 3.0], "drive": ("z", 0.1), "response": ("z", 0.3)} | changes
    frequency = given.pop("frequency")
    of = rd.Measured(frequency, np.ones(len(frequency)), **given)
    with pytest.raises(rd.SceneError, match=words):
        of.write(tmp_path / "a.uff")
    assert not list(tmp_path.iterdir())


# files of other programs


def units(length=1.0, force=1.0):
    lines = ["    -1", "   164", f"{1:10}{'some':>20}{1:10}"]
    factors = [f"{x:25.16e}".replace("e", "D") for x in (length, force, 1.0, 0.0)]
    return "\n".join([*lines, "".join(factors[:3]), factors[3], "    -1", ""])


def read(tmp_path, *texts, **options):
    file = tmp_path / "a.uff"
    file.write_text("".join(texts))
    given = {"positions": {1: 0.5, 2: 0.2, 3: 0.7}, "coordinate": "z"}
    return rd.Measured.read(file, **given | options)


SI = ("m/s2", "N")
SI_IN_MM = ("mm/s2", "N")


@pytest.mark.parametrize("single", [True, False])
@pytest.mark.parametrize("uneven", [None, (1.0, 1.25)])
def test_a_file_by_the_specification_is_read(tmp_path, single, uneven):
    found = read(tmp_path, function(labels=SI, single=single, uneven=uneven))
    assert found.frequency.tolist() == [1.0, 1.25]
    assert found.value.tolist() == [[1 + 2j, 3 - 4j]]
    assert found.drive == (("z", 0.2),)
    assert found.response == (("z", 0.5),)
    assert found.quantity == "accelerance"


@pytest.mark.parametrize(
    ("kind", "quantity"), [(8, "receptance"), (11, "mobility"), (12, "accelerance")]
)
def test_the_type_of_the_ordinate_is_the_quantity(tmp_path, kind, quantity):
    assert read(tmp_path, units(), function(kinds=(kind, 13))).quantity == quantity


UNITS = {
    "m/s^2/N": (12, 1.0),
    "g/N": (12, 9.80665),
    "(mm/s^2)/N": (12, 1e-3),
    "mm/s/N": (11, 1e-3),
    "mm / N": (8, 1e-3),
    "µm/kN": (8, 1e-9),
    # 12 inches are a foot, 32.174... feet/s^2 are standard gravity: lbf = 0.45359237 kg g
    "in/lbf": (8, 0.0254 / (0.45359237 * 9.80665)),
    "g/kgf": (12, 1.0),
}


@pytest.mark.parametrize("unit", UNITS)
def test_units_are_turned_into_si(tmp_path, unit):
    kind, factor = UNITS[unit]
    stated = read(tmp_path, function(kinds=(kind, 13)), unit=unit)
    np.testing.assert_allclose(stated.value, [[factor * (1 + 2j), factor * (3 - 4j)]], rtol=1e-15)
    above, below = unit.replace(" ", "").rsplit("/", 1)
    for labels in ((above, below), (unit, "NONE")):
        labelled = read(tmp_path, function(kinds=(kind, 13), labels=labels))
        np.testing.assert_array_equal(labelled.value, stated.value)


def test_dataset_164_says_the_units_where_labels_do_not(tmp_path):
    # how many mm and mN are 1 m and 1 N
    found = read(tmp_path, units(1e3, 1e3), function(kinds=(8, 13)))
    assert found.value.tolist() == [[1 + 2j, 3 - 4j]]
    found = read(tmp_path, units(1e3, 1.0), function(kinds=(11, 13)))
    np.testing.assert_allclose(found.value, [[1e-3 + 2e-3j, 3e-3 - 4e-3j]], rtol=1e-15)


def test_a_slope_by_a_force_has_its_own_unit(tmp_path):
    coordinate = {"Z": "z", "RY": "-beta"}
    text = function(kinds=(8, 13), response=(1, 5))
    found = read(tmp_path, units(1e3, 1.0), text, coordinate=coordinate)
    # a rotation has no length
    assert found.value.tolist() == [[-1 - 2j, -3 + 4j]]
    assert found.response == (("beta", 0.5),)
    found = read(tmp_path, text, coordinate=coordinate, unit="mrad/N")
    np.testing.assert_allclose(found.value, -1e-3 * np.array([[1 + 2j, 3 - 4j]]), rtol=1e-15)


@pytest.mark.parametrize(
    ("response", "drive", "coordinate", "sign"),
    [
        (3, 3, "z", 1),
        (-3, 3, "z", -1),
        (-3, -3, "z", 1),
        (3, -3, {"Z": "z"}, -1),
        (3, 3, "-z", 1),
        (2, 3, {"Y": "-z", "Z": "z"}, -1),
        (-2, 3, {"Y": "-z", "Z": "z"}, 1),
        (0, 0, "z", 1),
    ],
)
def test_directions_turn_the_sign(tmp_path, response, drive, coordinate, sign):
    text = function(response=(1, response), drive=(2, drive), labels=SI)
    found = read(tmp_path, text, coordinate=coordinate)
    assert found.value.tolist() == [[sign * (1 + 2j), sign * (3 - 4j)]]


def geometry(kind=15, nodes=((1, 500.0), (2, 200.0), (4, 0.0))):
    """Return nodes along X in dataset 15 or 2411."""
    between, form = ("", "{:13.5e}") if kind == 15 else ("\n", "{:25.16e}")
    rows = [f"{n:10d}" + 3 * f"{1:10d}" + between + (3 * form).format(x, 7, 0) for n, x in nodes]
    text = "\n".join(["    -1", f"{kind:6d}", *rows, "    -1", ""])
    return text if kind == 15 else text.replace("e+", "D+")


@pytest.mark.parametrize("kind", [15, 2411])
def test_nodes_of_the_file_are_positions_along_one_of_its_axes(tmp_path, kind):
    found = read(tmp_path, units(1e3), geometry(kind), function(labels=SI_IN_MM), positions="X")
    assert (found.drive, found.response) == ((("z", 0.2),), (("z", 0.5),))
    with pytest.raises(rd.SceneError, match="positions must be stated in m: no dataset 164"):
        read(tmp_path, geometry(kind), function(labels=SI), positions="X")
    with pytest.raises(rd.SceneError, match="without node 3"):
        read(tmp_path, units(), geometry(kind), function(response=(3, 3)), positions="X")
    with pytest.raises(rd.SceneError, match="positions must be one of"):
        read(tmp_path, units(), geometry(kind), function(labels=SI), positions="x")
    with pytest.raises(rd.SceneError, match="must hold finite numbers"):
        read(tmp_path, units(), geometry(kind, [(1, np.nan)]), function(), positions="X")


def test_line_ends_may_be_those_of_windows(tmp_path):
    for options in ({}, {"single": True}, {"uneven": (1.0, 1.25)}):
        text = (units() + function(labels=SI, **options)).replace("\n", "\r\n")
        (tmp_path / "a.uff").write_bytes(text.encode())
        found = rd.Measured.read(tmp_path / "a.uff", positions={1: 0.5, 2: 0.2}, coordinate="z")
        assert found.value.tolist() == [[1 + 2j, 3 - 4j]]


@pytest.mark.parametrize(("label", "factor"), [("NONE", 1.0), ("kHz", 1e3), ("rpm", 1 / 60)])
def test_frequencies_are_turned_into_hertz(tmp_path, label, factor):
    found = read(tmp_path, function(labels=SI, abscissa=(18, label)))
    np.testing.assert_allclose(found.frequency, [factor, 1.25 * factor], rtol=1e-15)


@pytest.mark.parametrize(("step", "same"), [("2.50001e-01", True), ("2.50002e-01", False)])
def test_frequencies_are_the_same_to_one_part_in_a_million(tmp_path, step, same):
    """1.25 Hz and 0.8 or 1.6 millionths more, which is far less than 1 Hz."""
    other = function(response=(3, 3), labels=SI).replace("2.50000e-01", step)
    if same:
        assert len(read(tmp_path, function(labels=SI), other).value) == 2
    else:
        with pytest.raises(rd.SceneError, match="others in dataset 1 than in 0"):
            read(tmp_path, function(labels=SI), other)


def test_several_responses_and_their_coherences_are_joined_by_nodes_and_directions(tmp_path):
    share = {"function_type": 6, "kinds": (0, 0)}
    found = read(
        tmp_path,
        function([0.3, 0.4], response=(3, 3), **share),
        function([1 + 1j, 1], response=(1, -3), labels=SI),
        function([2, 2j], response=(3, 3), labels=SI),
        function([0.5, 0.6], response=(1, 3), **share),
        function([0.0, 0.0], response=(3, 3), drive=(1, 3), **share),
        function([7.0, 8.0], function_type=1, abscissa=(17, "s")),
    )
    assert found.response == (("z", 0.5), ("z", 0.7))
    assert found.value.tolist() == [[-1 - 1j, -1], [2, 2j]]
    assert found.coherence.tolist() == [[0.5, 0.6], [0.3, 0.4]]


def test_a_hammer_that_roves_measures_responses_at_its_places(tmp_path):
    texts = [function([k, 1j * k], drive=(k, 3), labels=SI) for k in (1, 2, 3)]
    found = read(tmp_path, *texts, reciprocal=True)
    assert found.drive == (("z", 0.5),)
    assert found.response == (("z", 0.5), ("z", 0.2), ("z", 0.7))
    assert found.value[:, 0].tolist() == [1, 2, 3]
    some = read(tmp_path, *texts, reciprocal=True, response=[("z", 0.7)])
    assert some.value[:, 0].tolist() == [3]
    left = read(tmp_path, *texts, positions={1: 0.5, 2: None, 3: None})
    assert left.value.tolist() == [[1, 1j]]
    with pytest.raises(rd.SceneError, match="with reciprocal=True these are watched"):
        read(tmp_path, *texts)


def test_one_of_two_runs_is_chosen_by_its_number(tmp_path):
    texts = [function([k, 1j * k], labels=SI) for k in (1, 2)]
    with pytest.raises(rd.SceneError, match="records must leave one of datasets 0 and 1"):
        read(tmp_path, *texts)
    assert read(tmp_path, *texts, records=1).value.tolist() == [[2, 2j]]
    with pytest.raises(rd.SceneError, match=r"records must be numbers out of \[0, 1\]"):
        read(tmp_path, *texts, records=[2])


FOUR = [0.1, 0.2, 0.3, 0.4]
REFUSED = {
    "no positions": ([function()], {"positions": None}, r"positions must be .*\(1, 2\), such as"),
    "a node missed": ([function()], {"positions": {1: 0.5}}, "positions must be .* without node 2"),
    "no node left": ([function()], {"positions": {1: None, 2: 0.2}}, "positions must leave"),
    "no coordinate": ([function()], {"coordinate": None}, r"coordinate must say .*\(Z\)"),
    "two directions": ([function(response=(1, 1))], {}, r"coordinate must say .*\(X, Z\)"),
    "no such coordinate": ([function()], {"coordinate": "w"}, "coordinate.* must be one of"),
    "no unit": ([function()], {}, "unit must be stated"),
    "half a unit": ([function(labels=("m/s2", "NONE"))], {}, "unit must be stated"),
    "unknown unit": ([function(labels=("furlong", "N"))], {}, "'furlong', which is not known"),
    "two units": ([units(), function(labels=("g", "N"))], {}, "'g' but dataset 164"),
    "unit of another quantity": (
        [function(labels=("mm", "N"))],
        {},
        "unit and quantity must agree",
    ),
    "stated for another": ([function()], {"unit": "mm/N"}, "unit and quantity must agree"),
    "unit of rotation": ([function()], {"unit": "rad/N"}, "unit must be m .* per N"),
    "no unit at all": ([function()], {"unit": "fast"}, "unit must be motion per force"),
    "no such quantity": (
        [function()],
        {"unit": "g/N", "quantity": "speed"},
        "quantity must be one of",
    ),
    "unit of no motion": ([function()], {"unit": "furlong/N"}, "unit must be motion per force"),
    "unit per unknown force": ([function()], {"unit": "m/st"}, "unit must be motion per force"),
    "too many units": ([function()], {"unit": ["g/N", "g/N"]}, "unit must be one, or 1"),
    "no such drive": ([function()], {"drive": ("z", 0.3)}, r"drive must be one of .*\('z', 0.2\)"),
    "no such response": ([function()], {"response": ("z", 0.3)}, "response must be one of"),
    "text option": ([function()], {"skip": 3}, "skip is for text in columns"),
    "time": ([function(abscissa=(17, "s"))], {"unit": "g/N"}, "over frequency"),
    "stress": ([function(kinds=(2, 13))], {"unit": "g/N"}, "must hold motion per force"),
    "force per motion": ([function(kinds=(13, 8))], {"unit": "g/N"}, "must hold motion per force"),
    "real": ([function([1.0, 2.0])], {"unit": "g/N"}, "must hold complex responses"),
    "no response": ([function([1.0, 2.0], function_type=2)], {}, "with a frequency response"),
    "quantities": (
        [function(labels=SI), function(response=(3, 3), kinds=(8, 13), labels=("m", "N"))],
        {},
        "quantity must be one for all",
    ),
    "frequencies": (
        [function(labels=SI), function([1j, 2, 3], response=(3, 3), labels=SI)],
        {},
        "must hold the same frequencies",
    ),
    "some coherences": (
        [
            function(labels=SI),
            function(response=(3, 3), labels=SI),
            function([0.5, 0.5], function_type=6),
        ],
        {},
        "a coherence for each response or for none",
    ),
    "coherences twice": (
        [function(labels=SI), *[function([0.5, 0.5], function_type=6)] * 2],
        {},
        r"records must leave one of datasets \[1, 2\]",
    ),
    "coherence elsewhere": (
        [function(labels=SI), function(FOUR, function_type=6)],
        {},
        "must hold real coherences",
    ),
    "coherence of 2": (
        [function(labels=SI), function([2.0, 0.5], function_type=6)],
        {},
        "coherence must lie between 0 and 1",
    ),
    "units of 0": ([units(0.0), function()], {}, "units > 0"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_not_said_is_asked_for_by_name(tmp_path, what):
    texts, options, words = REFUSED[what]
    with pytest.raises(rd.SceneError, match=words):
        read(tmp_path, *texts, **options)


# damaged files

WHOLE = units() + geometry() + function(labels=SI) + function([0.5, 1.0], function_type=6)
DAMAGED = {
    "empty": (b"", "which is empty"),
    "blank": (b" \n\n", "which is empty"),
    "text": (b"frequency,real,imag\n1,2,3\n", "no line of -1"),
    "garbage": (bytes(range(256)) * 4, "no line of -1"),
    "another dataset": (b"    -1\n    15\n    -1\n", r"with a dataset 58 .* with \[15\]"),
    "no number": (b"    -1\nfifty\n    -1\n", "has no number"),
    "head alone": (WHOLE[: WHOLE.index("Hz")].encode(), "has no end"),
    "one number short": (function(labels=SI).replace("  3.000000000000e+00", "").encode(), "value"),
    "word for a number": (
        function(labels=SI).replace("3.0000", "three.").encode(),
        "dataset 0 .from 0. can be read",
    ),
    "infinite": (function([1e300, 2j]).replace("e+300", "e+999").encode(), "must hold"),
    "VAX": (None, "byte order 1 and format 1"),
}


@pytest.mark.parametrize("what", DAMAGED)
def test_a_damaged_file_is_named_with_what_was_found(tmp_path, what, capfd):
    content, words = DAMAGED[what]
    file = tmp_path / "damaged.uff"
    if content is None:
        measured().write(file, binary=True)
        content = file.read_bytes().replace(b"58b     1     2", b"58b     1     1")
    file.write_bytes(content)
    with pytest.raises(rd.SceneError, match=words) as caught:
        rd.Measured.read(file, positions={1: 0.5, 2: 0.2}, coordinate="z")
    assert str(file) in str(caught.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("binary", [False, True])
def test_a_file_cut_anywhere_is_refused(tmp_path, binary):
    of = measured(coherence=None, response=[("z", 0.1), ("z", 0.2), ("z", 0.3)])
    of.write(tmp_path / "a.uff", binary=binary)
    content = (tmp_path / "a.uff").read_bytes()
    ends = [match.end() for match in re.finditer(rb"    -1\n", content)]
    for size in {*range(1, len(content) - 1, 97), *(end - 7 for end in ends)}:
        (tmp_path / "b.uff").write_bytes(content[:size])
        # between two datasets nothing shows that there was more
        if content[:size].endswith(b"    -1\n") and size in ends[3::2]:
            continue
        with pytest.raises(rd.SceneError, match="path must"):
            rd.Measured.read(tmp_path / "b.uff")


@pytest.fixture(scope="module")
def fuzzed(tmp_path_factory):
    folder = tmp_path_factory.mktemp("fuzz")
    wholes = [WHOLE.encode()]
    for binary in (False, True):
        measured(FREQUENCY[:5]).write(folder / "whole.uff", binary=binary)
        wholes.append((folder / "whole.uff").read_bytes())
    return folder / "fuzzed.uff", wholes


def try_it(file, content):
    """Read something: a response or an error that names the file or what is not said."""
    file.write_bytes(content)
    try:
        found = rd.Measured.read(file)
        assert np.isfinite(found.value).all()
    except rd.SceneError as error:
        assert "must" in str(error)
    try:
        rd.Measured.read(file, positions=dict.fromkeys(range(9), 0.5), coordinate="z")
    except rd.SceneError as error:
        assert "must" in str(error)
    try:
        rd.Measured.read(file, positions="X", coordinate="z", unit="m/s^2/N")
    except rd.SceneError as error:
        assert "must" in str(error)


@settings(max_examples=150)
@given(
    which=st.integers(0, 2),
    changes=st.lists(
        st.tuples(st.floats(0, 1, exclude_max=True), st.binary(max_size=6), st.integers(0, 6)),
        min_size=1,
        max_size=4,
    ),
)
def test_a_file_with_changed_bytes_is_read_or_refused(fuzzed, which, changes):
    file, wholes = fuzzed
    content = wholes[which]
    for part, new, old in changes:
        at = int(part * len(content))
        content = content[:at] + new + content[at + old :]
    try_it(file, content)


HEAD = b"    -1\n    58\n"


@settings(max_examples=80)
@given(st.binary(max_size=400), st.sampled_from([b"", HEAD, b"    -1\n    58b"]))
def test_random_bytes_are_refused(fuzzed, content, head):
    try_it(fuzzed[0], head + content + b"\n    -1\n")


def test_without_pyuff_the_error_says_what_to_install(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "pyuff", None)
    (tmp_path / "a.uff").write_text(WHOLE)
    for call in (
        lambda: rd.Measured.read(tmp_path / "a.uff"),
        lambda: measured().write(tmp_path / "b.uff"),
    ):
        with pytest.raises(ImportError, match=r"pyuff is needed .*ropedyn\[io\]"):
            call()
