"""Studies whose rows are blades: their numbers on the coarse blade, and tables of made rows."""

from pathlib import Path

import numpy as np
import pytest
from runs import swept
from scenes import EXACT, RUBBING, scene

from geometry.base import read_mapping, write_json
from geometry.hats import hats
from rom.modes import ShiftInvert
from workflow import readme
from workflow.study import blades, frequencies, mesh_convergence

ROOT = Path(__file__).parents[2]
MODES = 10
FACTORS, OWN = (2.0, 2**0.5, 1.0, 0.5**0.5), 2
SIZES = 2.48 * np.array(FACTORS)
LIMIT = np.linspace(250.0, 6500.0, MODES)
SLOPE = np.linspace(5e-4, 3e-3, MODES)  # error at the own size
TIP = 4e-4
SPEEDS = [0.0, 50.0, 100.0]


def made(label, f, **of):
    """A row of an experiment with frequencies, Hz, at each speed."""
    f = [list(at_speed) for at_speed in f]
    return {"row": label, "numbers": {"speeds_rad_s": SPEEDS, "frequencies_Hz": f}} | of


def levels(order):
    """Rows of four sizes, with errors of one order of frequencies and deflection."""
    rows = []
    for size, factor in zip(SIZES, FACTORS, strict=True):
        step = (size / SIZES[OWN]) ** order
        rest, speed = LIMIT * (1 + SLOPE * step), 1.1 * LIMIT * (1 + 0.8 * SLOPE * step)
        row = made(mesh_convergence.OWN if factor == 1 else str(factor), [rest, rest, speed])
        nodes = int(2e4 * FACTORS[OWN] / factor**2)
        deflection = TIP * (1 - 2e-4 * step)
        row["numbers"] |= {"element_size_mm": size, "nodes": nodes, "tip_deflection_m": deflection}
        rows.append(row)
    return rows


@pytest.fixture
def of_meshes():
    """Rows with errors of order 1.4."""
    return levels(order=1.4)


@pytest.mark.parametrize("order", [0.9, 1.4, 2.0, 3.3])
def test_the_order_and_limit_of_a_sequence_are_recovered(order):
    values = np.array([row["numbers"]["frequencies_Hz"][0] for row in levels(order)])
    found = mesh_convergence.common_order(SIZES[-3:], values[-3:])
    assert found == pytest.approx(order, abs=1e-3)  # of the search
    np.testing.assert_allclose(mesh_convergence.limits(SIZES, values, order), LIMIT, rtol=1e-14)


def test_errors_are_against_the_limit_and_the_band_is_that_of_the_finest(of_meshes):
    found = mesh_convergence.numbers(of_meshes)
    at_rest = found["at_rest_Hz"]
    # the order is found to 1e-3
    np.testing.assert_allclose(at_rest["error"][OWN], SLOPE, rtol=5e-3)
    np.testing.assert_allclose(at_rest["band"], 1.25 * SLOPE * 2**-0.7, rtol=5e-3)
    np.testing.assert_allclose(found["tip_deflection_m"]["error"][OWN], -2e-4, rtol=5e-3)
    assert found["tip_deflection_m"]["limit"] == pytest.approx([TIP], rel=1e-6)


def test_the_coarsest_size_does_not_affect_the_order(of_meshes):
    order = mesh_convergence.numbers(of_meshes)["order"]
    of_meshes[0]["numbers"]["frequencies_Hz"][0] = list(1.01 * LIMIT)
    assert mesh_convergence.numbers(of_meshes)["order"] == order


def test_table_states_limits_errors_and_bands(of_meshes):
    text = mesh_convergence.table(of_meshes)
    assert "4.96 mm (5,000 nodes)" in text and "observed order 1.40" in text
    assert "| 1 | 250.00 | +0.05 ± 0.04 | 275.00 | +0.04 ± 0.03 |" in text
    assert "0.4000 mm, error -0.02 ± 0.02 %" in text


def test_the_sizes_of_the_meshes_are_in_the_ratios_of_which_the_limit_is():
    """Of the blades of both experiments, to the last digit."""
    for name in ("mesh", "mesh-rotor37"):
        rows = read_mapping(ROOT / f"workflow/experiments/{name}.yaml")["rows"]
        blades = [row.get("blade", "reference") for row in rows.values()]
        sizes = [
            read_mapping(ROOT / f"workflow/blades/{blade}.yaml")["mesh"]["element_size_mm"]
            for blade in blades
        ]
        own = sizes[[*rows].index(mesh_convergence.OWN)]
        np.testing.assert_allclose(sizes, own * np.array(FACTORS), rtol=1e-15)


def camber_at(camber, xi):
    return [np.interp(xi, np.linspace(0, 1, len(camber)), column) for column in camber.T]


def test_frequencies_and_deflection_of_a_blade(coarse_blade, coarse_files, coarse_matrices):
    found = frequencies.numbers(coarse_blade, coarse_files.mesh, coarse_files.matrices)
    fom = coarse_matrices
    assert found["element_size_mm"] == coarse_blade.mesh.element_size_mm
    assert 3 * found["nodes"] > fom.M.shape[0]
    np.testing.assert_allclose(found["speeds_rad_s"], [0, 325, 650], rtol=1e-12)
    for K, f in zip((fom.K[0], fom.K[1], fom.K[-1]), found["frequencies_Hz"], strict=True):
        omega = ShiftInvert(K, fom.M).modes(MODES).omega
        np.testing.assert_allclose(f, omega / (2 * np.pi), rtol=1e-8)  # of the solver
    deflection = fom.u_static[-1]
    (at,) = hats(1 / 16, fom.xi) @ (fom.S @ deflection).reshape(-1, 3)
    assert found["tip_deflection_m"] == pytest.approx(np.linalg.norm(at), rel=1e-12)
    # the nearest node of the mesh, some mm away
    r, theta, z = camber_at(fom.camber, 1 / 16)
    place = np.array([r * np.cos(theta), r * np.sin(theta), z])
    node = np.linalg.norm(fom.coordinates - place, axis=1).argmin()
    of_node = np.linalg.norm(deflection.reshape(-1, 3)[node])
    assert found["tip_deflection_m"] == pytest.approx(of_node, rel=0.05)


def test_a_page_takes_a_study_where_it_has_been_run(of_meshes, tmp_path):
    write_json(of_meshes, tmp_path / "results/experiments/mesh/table.json")
    pages = readme.generated(readme.read_pages(ROOT), tmp_path)
    assert mesh_convergence.table(of_meshes) in pages["fem/README.md"]


def test_peaks_of_blades_are_those_of_the_sweep_and_of_a_longer_run(coarse_rom, monkeypatch):
    """The worst, the median and the least of two unequal blades; the longer run stops in time."""
    monkeypatch.setattr(blades, "PASSES", 24)
    stage = {"count": 2, "longer_um": [0, 3]}
    record = {"samples_per_round": 64, "spectrum_rounds": 4}
    case = scene(
        **RUBBING | {"integrator": EXACT, "rounds": 6},
        record=record,
        stage=stage,
        speeds={"over_f1": [0.34, 0.36, 0.38]},
    )
    runs = swept(case, coarse_rom)
    found = blades.at_peaks(runs, case, coarse_rom)["EO 4"]
    at = runs.sel(speed_over_f1=found["speed"])
    along = 1e6 * at["blade_along"].sel(order=4).values
    assert found["amplitude_um"] == pytest.approx(along[found["worst"]], rel=1e-6)
    assert found["median_um"] == pytest.approx(along.mean(), rel=1e-6)
    assert found["least_um"] == pytest.approx(along.min(), rel=1e-6)
    assert found["largest_um"] == pytest.approx(1e6 * at["blade_displacement"].values.max())
    later = case.but(rounds=12, speeds={"over_f1": [found["speed"]]})
    expected = swept(later, coarse_rom)["blade_along"].sel(order=4)[0, found["worst"]].item()
    assert found["steady"]["rounds"] == 12
    assert found["steady"]["amplitude_um"] == pytest.approx(1e6 * expected, rel=0.05)


def of_blades(group, row, amplitude, trend="steady", status="ok"):
    """A made row of the experiment of blades."""
    steady = {"status": status, "trend": trend, "rounds": 212.0, "wear_um": 1.0}
    steady["amplitude_um"] = None if status != "ok" else 2 * amplitude
    of = {"speed": 0.37, "stands_out": 1, "amplitude_um": amplitude, "steady": steady}
    of |= {"median_um": 5e-3, "least_um": 0.0, "largest_um": 9.0, "wear_um": 1.0, "worst": 0}
    return {"group": group, "row": row, "numbers": {"EO 4": of, "EO 5": of}}


def test_the_table_of_blades_has_rows_and_quantiles_of_draws():
    rows = [
        of_blades("20 revolutions", "one blade", 74.0, status="liner-exhausted", trend="growing"),
        of_blades("casing", "400 Hz", 64.0, trend="growing"),
        *(of_blades("scatter", f"draw {i}", 80.0 + i) for i in range(10)),
    ]
    heads, _, one, casing, half, last = blades.table(rows).splitlines()
    assert heads.count("EO 4: Ω / f₁(0)") == heads.count("EO 5: Ω / f₁(0)") == 1
    later = "liner-exhausted, not steady after 212 rev."
    assert one.startswith(f"| 20 revolutions: one blade | 0.37 | 74 | 0 | 9 | {later} | 0.37 ")
    assert casing.startswith("| casing: 400 Hz | 0.37 | 64 ")
    assert "| 128, not steady after 212 rev. |" in casing
    exact = np.quantile(80.0 + np.arange(10), [0.5, 0.9])
    for line, share, value in zip((half, last), (50, 90), exact, strict=True):
        cells = line.split(" | ")
        assert cells[0] == f"| scatter: {share} % of 10 draws"
        assert cells[2].startswith(f"{value:.3g} (") and cells[5].endswith("; 10 steady")
