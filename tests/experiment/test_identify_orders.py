"""Which mode a peak is, which ends a rope has, and many ropes at once."""

import json
import warnings

import numpy as np
import pytest
from given_ends import fitted
from test_identify import BOTH, LENGTH, TENSION, noisy, pinned_beam, scene

import ropedyn as rd
from ropedyn.cli.command import main

# M. Ali, D. Broggi, G. Cantarini, Propagazione delle onde su una corda vibrante, laboratory report,
# repository giiulia/LabI-Dynamics-Thermodynamics: a cord between a shaker and a pulley with a
# weight of 0.201102 kg, 3.8283 g over 1.7426 m, f = 13.88 ... 71.87 Hz
CORD = rd.Scene(
    rd.Rope(1.08, 0.00219691, bending_stiffness=1e-4), tension=1.0, ends=("pinned", "pinned")
)
CORD_PEAKS = [13.88, 27.89, 42.13, 56.85, 71.87]
CORD_TENSION = 1.9728


# --- orders -----------------------------------------------------------------------------------


def test_orders_that_are_said_wrong_show_in_chi_square():
    peaks = np.delete(pinned_beam(7, TENSION, 2.0), 3)
    given = rd.Peaks(peaks, std=1e-3 * peaks)
    with pytest.warns(rd.IdentifyWarning, match="the peaks are off by more than their std"):
        fitted(scene(900.0, 2.0), given, BOTH, orders=[1, 2, 3, 4, 5, 6])


# --- ends -------------------------------------------------------------------------------------


@pytest.mark.claim(
    "tension of a measured cord by its five peaks, pinned ends [%]",
    reference="the weight it hangs on: 1.9728 N (M. Ali, D. Broggi, G. Cantarini)",
    accepted=0.5,
)
def test_measured_cord_has_the_tension_of_its_weight(claim):
    claim(100 * abs(fitted(CORD, CORD_PEAKS, BOTH).value["tension"] / CORD_TENSION - 1))


def test_measured_cord_fits_clamped_ends_as_well_with_less_tension():
    fit = fitted(CORD, CORD_PEAKS, BOTH)
    # 1 - 4 sqrt(B/T)/L of the tension, for clamped spans act as shorter ones by sqrt(B/T) each end
    assert fit.said_of_ends[1].startswith("clamped ends fit as well but give tension -6.9 %")
    first = fit.report().splitlines()[0]
    assert first.startswith("ends taken as given: pinned and pinned; clamped ends fit as well")


@pytest.mark.parametrize("std", [None, 1e-4])
def test_ends_that_do_not_fit_are_told_from_those_that_do(std):
    clamped, mixed = ("clamped", "clamped"), ("clamped", "pinned")
    peaks = noisy(scene(TENSION, 20.0, clamped).compile().modes(8).frequency, 1e-4, 1)
    given = rd.Peaks(peaks, std=None if std is None else std * peaks)
    pinned = fitted(scene(TENSION, 20.0, clamped), given, BOTH).said_of_ends[1]
    assert pinned.startswith("pinned ends fit worse")
    with warnings.catch_warnings():
        # with a std the wrong ends do not fit at all
        warnings.simplefilter("ignore", rd.IdentifyWarning)
        wrong = fitted(scene(TENSION, 20.0, mixed), given, BOTH, orders=[*range(1, 9)])
    shown, pinned, clamped = wrong.said_of_ends
    assert shown == "clamped and pinned"
    assert pinned.startswith("pinned ends fit worse")
    assert clamped.startswith("clamped ends fit better")


def test_of_strings_nothing_is_said_of_ends():
    string = rd.Scene(rd.Rope(LENGTH, 0.5), tension=900.0)
    peaks = pinned_beam(3, TENSION, 1e-12)
    assert fitted(string, peaks, "tension").said_of_ends == ()


# --- many ropes -------------------------------------------------------------------------------


def test_many_ropes_are_identified_each_and_failures_kept_in_place(tmp_path):
    tensions = [900.0, 1000.0, 1100.0]
    peaks = [rd.Peaks(pinned_beam(4, t, 2.0)) for t in tensions]
    fits = fitted(scene(TENSION, 1.0), [*peaks[:2], rd.Peaks([9.0]), peaks[2]], BOTH)
    assert len(fits) == 4 and fits[2] is None and list(fits.failed) == [2]
    assert isinstance(fits.failed[2], rd.SceneError)
    found = [fit.value["tension"] for fit in fits if fit is not None]
    np.testing.assert_allclose(found, tensions, rtol=1e-9)
    assert fits.table().column("tension")[2] is None
    assert "at least 2 peaks" in fits.table().column("failure")[2]
    fits.save(tmp_path / "fits.nc")
    assert str(rd.load(tmp_path / "fits.nc")) == str(fits)
    np.testing.assert_array_equal(fits.plot().get_lines()[0].get_ydata(), fits.value[:, 0])


def test_notes_of_many_ropes_say_which():
    string = rd.Scene(rd.Rope(LENGTH, 0.5), tension=900.0)
    peaks = [rd.Peaks([11.0, 22.0]), rd.Peaks([11.0])]
    with pytest.warns(rd.IdentifyWarning, match="rope 1: as many unknown as peaks"):
        fitted(string, peaks, "tension")


# --- command line -----------------------------------------------------------------------------


@pytest.fixture
def cord_file(tmp_path):
    CORD.save(tmp_path / "cord.toml")
    return str(tmp_path / "cord.toml")


PEAKS = ["--peaks", ",".join(map(str, CORD_PEAKS)), "--unknown", "tension,bending_stiffness"]
GIVEN = ["--ends", "given", "--orders", "1,2,3,4,5"]


def test_command_prints_the_report(cord_file, capsys):
    assert main(["identify", cord_file, *PEAKS, *GIVEN]) == 0
    peaks = rd.Peaks(CORD_PEAKS, order=[1, 2, 3, 4, 5])
    assert capsys.readouterr().out.rstrip() == fitted(CORD, peaks, BOTH).report()


def test_command_takes_std_orders_and_prior_and_prints_numbers(cord_file, tmp_path, capsys):
    options = ["--std", "0.05", *GIVEN, "--prior", "tension=1.97:0.001"]
    figure = ["--plot", str(tmp_path / "cord.png")]
    assert main(["identify", cord_file, *PEAKS, *options, *figure, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    peaks = rd.Peaks(CORD_PEAKS, std=0.05, order=[1, 2, 3, 4, 5])
    fit = fitted(CORD, peaks, BOTH, prior={"tension": (1.97, 0.001)})
    assert [row["value"] for row in rows] == fit.value.tolist()
    assert [row["std"] for row in rows] == fit.std.tolist()
    assert (tmp_path / "cord.png").stat().st_size > 1000


def test_command_says_what_peaks_do_not_tell_beside_its_numbers(cord_file, capsys):
    few = ["--peaks", "13.88,27.89", "--unknown", "tension,bending_stiffness", "--csv"]
    assert main(["identify", cord_file, *few, "--ends", "given", "--orders", "1,2"]) == 3
    printed = capsys.readouterr()
    assert printed.out.startswith("unknown,value,std")
    assert "as many unknown as peaks" in printed.err


def test_command_reads_a_file_as_a_whole_or_its_peaks(tmp_path, capsys):
    damped = CORD.replace(tension=1.97, damping=rd.RayleighDamping(2.0, 0.0))
    drive, lines = ("z", 0.3), np.arange(5.0, 60.0, 0.25)
    frf = damped.compile().frf(lines, drive=drive)
    measured = rd.Measured(lines, frf.value, drive=drive, response=drive)
    measured.write(tmp_path / "run.csv")
    damped.replace(tension=1.5).save(tmp_path / "guess.toml")
    command = ["identify", str(tmp_path / "guess.toml"), "--measured", str(tmp_path / "run.csv")]
    command += ["--unknown", "tension,bending_stiffness"]
    values = []
    for more in ([], ["--only-peaks", "--ends", "given"]):
        assert main([*command, *more, "--json"]) == 0
        rows = json.loads(capsys.readouterr().out)["rows"]
        values.append([row["value"] for row in rows])
    # exact to the digits of the file; peaks to what others add to them between the lines
    np.testing.assert_allclose(values[0], [1.97, 1e-4], rtol=1e-6)
    assert values[1][0] == pytest.approx(1.97, rel=1e-3)
    assert main(command) == 0
    assert "calculated against measured response" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--drive", "z@0.1"], "--measured must be given with --drive, got none"),
        (["--only-peaks"], "--measured must be given with --only-peaks, got none"),
        (["--prior", "tension=3"], "--prior must be path=value:std"),
        (["--orders", "one"], "--orders must be a comma list of whole numbers"),
        (["--unknown", "mass"], r"--unknown"),
    ],
)
def test_command_refuses_bad_input(cord_file, capsys, options, message):
    assert main(["identify", cord_file, *PEAKS, *options]) == 2
    assert message in capsys.readouterr().err
