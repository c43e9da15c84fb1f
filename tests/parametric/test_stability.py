"""Where motion grows: Mathieu's boundaries, first-order theory, and a scan by brute force."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.parametric.monodromy import exponent
from ropedyn.parametric.tongues import threshold

BOUNDARY = {
    (0.1, 0.0): (1.949698438262927689492, 2.049678773154419840148),
    (0.1, 0.005): (1.950683355664874811046, 2.048643835802765804021),
    (0.1, 0.01): (1.953771480266317108308, 2.045405647595916299075),
    (0.2, 0.0): (1.898848110496660565243, 2.098687560526568991977),
    (0.2, 0.005): (1.899323772250557749056, 2.098161818634659602245),
    (0.2, 0.01): (1.900766118767600911428, 2.096569227930373564402),
    (0.2, 0.05): (1.994513636272402453816, 1.998010904277412387027),
}
"""Of the principal tongue, Omega/omega_1 by (amplitude over mean, damping ratio): mpmath with 40
digits, Taylor series of order 60, 40 steps a period; 22 digits."""

STRING = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
BEAM = rd.Scene(
    rd.Rope(1.0, 0.1, bending_stiffness=2.0), tension=1000.0, ends=("pinned", "clamped")
)
"""Its ends are not alike: all modes are coupled."""


def mapped(scene, frequency, modes):
    """Return a map without amplitudes, for boundaries."""
    return scene.compile().stability_map(frequency, [0.0, 1.0], modes=modes)


@pytest.mark.claim(
    "relative error of the frequencies where a string becomes unstable",
    reference="Taylor series with 40 digits",
    accepted=5e-12,
)
@pytest.mark.parametrize("given", BOUNDARY)
def test_string_becomes_unstable_where_mathieu_says(given, claim):
    """Also at the tip of the tongue, which is then 0.002 wide."""
    amplitude, ratio = given
    scene = STRING.replace(damping=rd.ModalDamping(ratio))
    stability = mapped(scene, [40.0, 60.0], 1)
    first = stability.mode_frequency[0]
    found = stability.boundary(1000.0 * amplitude).frequency / first
    claim(np.abs(found / BOUNDARY[given] - 1).max())


def test_damping_closes_the_tongue_below_its_threshold():
    """amplitude/mean = 4 zeta, but for zeta^3."""
    stability = mapped(STRING.replace(damping=rd.ModalDamping(0.01)), [40.0, 60.0], 1)
    assert len(stability.boundary(0.999 * 40.0).frequency) == 0
    assert len(stability.boundary(1.001 * 40.0).frequency) == 2


def test_damping_closes_the_tongue_of_two_modes_below_its_threshold():
    """amplitude |Gamma_ij| = 4 zeta omega_i omega_j of equal decay, to first order."""
    decay = 0.05
    stability = mapped(BEAM.replace(damping=rd.RayleighDamping(2 * decay, 0.0)), [100.0, 200.0], 2)
    together = np.sqrt(stability.system.omega.prod())
    needed = 4 * decay * together / abs(stability.geometric[0, 1])
    middle = stability.mode_frequency.sum()

    def near(amplitude):
        return np.abs(stability.boundary(amplitude).frequency - middle) < 1.0

    assert not near(0.99 * needed).any()
    assert near(1.01 * needed).sum() == 2


def test_two_modes_grow_together_as_first_order_theory_says():
    """Omega = omega_i + omega_j +- (a/2) Gamma_ij/sqrt(omega_i omega_j), the rest being a^2."""
    stability = mapped(BEAM, [120.0, 200.0], 2)
    tongue = next(one for one in stability.tongues if one.kind == "sum")
    assert tongue.modes == (1, 2)
    off = []
    for amplitude in (5.0, 10.0):
        found = stability.boundary(amplitude).frequency
        found = found[np.abs(found - tongue.frequency) < 1.0]
        off.append(found - tongue.frequency - amplitude * tongue.spread * np.array([-1.0, 1.0]))
    assert off[1] / off[0] == pytest.approx([4.0, 4.0], rel=0.05)


def test_principal_tongue_of_every_mode_is_as_wide_as_first_order_theory_says():
    """The same with i = j."""
    stability = mapped(BEAM, [80.0, 400.0], 3)
    for tongue in stability.tongues:
        if tongue.kind == "principal":
            found = stability.boundary(1.0).frequency
            found = found[np.abs(found - tongue.frequency) < 1.0]
            assert np.ptp(found) == pytest.approx(2 * tongue.spread, rel=1e-3)


@pytest.mark.parametrize("damping", [None, rd.RayleighDamping(1.0, 0.0)])
def test_no_tongue_of_a_scan_is_missed(damping):
    """Every change of stability between 1500 frequencies has its boundary."""
    stability = mapped(BEAM.replace(damping=damping), [60.0, 240.0], 3)
    scan = np.linspace(60.0, 240.0, 1500)
    growth = exponent(stability.system, scan, np.full((len(scan), 1), 150.0))[:, 0]
    grows = growth > threshold(stability.system, scan)
    at = np.flatnonzero(grows[1:] != grows[:-1])
    assert len(at) > 6
    found = stability.boundary(150.0).frequency
    for low, high in zip(scan[at], scan[at + 1]):
        assert ((low <= found) & (found <= high)).any()
    # what the scan steps over are tongues, two boundaries each
    assert (len(found) - len(at)) % 2 == 0


def test_map_is_as_the_multipliers_are():
    """A map takes longer steps: 1e-10 in the growth over a period."""
    scene = BEAM.replace(damping=rd.ViscousDamping(0.2))
    frequency, amplitude = np.array([70.0, 109.0, 160.0]), np.array([100.0, 400.0])
    stability = scene.compile().stability_map(frequency, amplitude)
    for j, f in enumerate(frequency):
        for i, a in enumerate(amplitude):
            tension = rd.Tension(1000.0, amplitude=a, frequency=f)
            floquet = scene.replace(tension=tension).compile().floquet()
            assert stability.growth[i, j] == pytest.approx(floquet.growth[0], abs=1e-9 * f)
            assert stability.stable[i, j] == floquet.stable
    assert not stability.stable.all()
    assert stability.stable.any()


def test_layers_that_end_where_pieces_do_are_one_place():
    """A span between both, but for rounding, had no length, and the scene was refused."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.6)

    def growth(at):
        parts = [rd.Dashpot(at, 0.027), rd.PointMass(0.64, 0.037)]
        scene = rd.Scene(rope, tension=1000.0, ends=("pinned", "clamped"), parts=parts)
        return scene.compile().stability_map([34.0, 71.0], [250.0], modes=3).growth

    assert growth(0.21) == pytest.approx(growth(0.21 + 1e-7), rel=1e-5)


def test_undamped_rope_without_pulsation_is_stable():
    stability = BEAM.compile().stability_map(np.linspace(50.0, 250.0, 41), [0.0], modes=4)
    assert stability.stable.all()
    assert len(stability.boundary(0.0).frequency) == 0


def test_tongues_have_names():
    stability = mapped(BEAM, [30.0, 400.0], 2)
    f = stability.mode_frequency
    names = {one.label: one for one in stability.tongues}
    assert names["2 f1"].kind == "principal"
    assert names["f1 + f2"].kind == "sum"
    assert {"f1", "2 f1/3", "f2/2", "(f1 + f2)/2", "2 f2"} <= names.keys()
    assert names["(f1 + f2)/2"].kind == "secondary"
    assert names["(f1 + f2)/2"].frequency == pytest.approx(f.sum() / 2)
    assert "f1 + f2" not in {one.label for one in mapped(STRING, [10.0, 90.0], 2).tongues}


def test_answer_is_a_table_a_figure_and_a_file(tmp_path):
    told = []
    stability = BEAM.compile().stability_map(
        np.linspace(90.0, 130.0, 9), [0.0, 200.0], modes=2, progress=told.append
    )
    assert told[-1] == 1.0
    assert stability.table().column("amplitude [N]") == (0.0, 200.0)
    assert stability.table().column("unstable [%]")[0] == 0.0
    assert stability.plot().get_xlabel() == "frequency of the tension [Hz]"
    pytest.importorskip("h5netcdf")
    stability.save(tmp_path / "map.nc")
    again = rd.load(tmp_path / "map.nc")
    assert np.array_equal(again.growth, stability.growth)
    assert np.array_equal(again.boundary(200.0).frequency, stability.boundary(200.0).frequency)
    assert again.tongues == stability.tongues


@pytest.mark.parametrize(
    ("frequency", "amplitude", "message"),
    [
        ([50.0, 40.0], [1.0], "frequency must hold a number at least, and increase"),
        ([50.0], [2.0, 1.0], "amplitude must hold a number at least, and increase"),
        ([0.0, 1.0], [1.0], "frequency"),
        ([1.0], [-1.0], "amplitude"),
        ([50.0], [1001.0], "amplitude must be at most the mean tension"),
        ([1.0, 1e300], [1.0], "must be at most 1e\\+150 Hz, got 1e\\+300"),
    ],
)
def test_questions_without_meaning_are_refused(frequency, amplitude, message):
    with pytest.raises(rd.SceneError, match=message):
        STRING.compile().stability_map(frequency, amplitude)


def test_rope_that_only_twists_is_refused():
    scene = rd.Scene(rd.Rope(1.0, 0.1, torsional_stiffness=1.0, polar_inertia=1e-6))
    with pytest.raises(rd.SceneError, match="must move transversely"):
        scene.compile().stability_map([10.0], [0.0])


def test_amplitude_of_a_boundary_is_checked():
    with pytest.raises(rd.SceneError, match="amplitude"):
        mapped(STRING, [40.0, 60.0], 1).boundary(-1.0)
    with pytest.raises(rd.SceneError, match=r"at most the mean tension .* 1000.0 N, got 1500.0"):
        mapped(STRING, [40.0, 60.0], 1).boundary(1500.0)


def test_a_boundary_needs_two_frequencies_to_lie_between():
    with pytest.raises(rd.SceneError, match=r"frequency of the map must hold two at least.*50"):
        mapped(STRING, [50.0], 1).boundary(1.0)
