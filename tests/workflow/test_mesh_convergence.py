"""Mesh study: limits of prescribed sequences, and one element size on the coarse blade."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from geometry.hats import hats
from geometry.project import write_json
from rom.modes import ShiftInvert
from workflow import readme
from workflow.study import mesh, mesh_level

MODES = 10
FACTORS, OWN = (2.0, 2**0.5, 1.0, 0.5**0.5), 2
SIZES = 2.48 * np.array(FACTORS)
LIMIT = np.linspace(250.0, 6500.0, MODES)
SLOPE = np.linspace(5e-4, 3e-3, MODES)  # error at the own size
TIP = 4e-4


def levels(order):
    """Frequencies and deflection with errors of one order."""
    steps = (SIZES / SIZES[OWN]) ** order
    return [
        {
            "element_size_mm": size,
            "nodes": int(2e4 * FACTORS[OWN] / factor**2),
            "at_rest_Hz": list(LIMIT * (1 + SLOPE * step)),
            "at_Omega_m_Hz": list(1.1 * LIMIT * (1 + 0.8 * SLOPE * step)),
            "tip_deflection_m": TIP * (1 - 2e-4 * step),
        }
        for size, factor, step in zip(SIZES, FACTORS, steps, strict=True)
    ]


def camber_at(camber, xi):
    return [np.interp(xi, np.linspace(0, 1, len(camber)), column) for column in camber.T]


def numbers(folder, levels):
    """Results from files, as in a job."""
    paths = [folder / f"level-{i}.json" for i in range(len(FACTORS))]
    for path, level in zip(paths, levels, strict=True):
        write_json(level, path)
    return mesh.numbers(SimpleNamespace(levels=paths), own=OWN)


@pytest.fixture
def summary(tmp_path):
    return numbers(tmp_path, levels(order=1.4))


@pytest.mark.parametrize("order", [0.9, 1.4, 2.0, 3.3])
def test_the_order_and_limit_of_a_sequence_are_recovered(order):
    values = np.array([level["at_rest_Hz"] for level in levels(order)])
    found = mesh.common_order(SIZES[-3:], values[-3:])
    assert found == pytest.approx(order, abs=1e-3)  # of the search
    np.testing.assert_allclose(mesh.limits(SIZES, values, order), LIMIT, rtol=1e-14)


def test_errors_are_against_the_limit_and_the_band_is_that_of_the_finest(summary):
    at_rest = summary["at_rest_Hz"]
    # the order is found to 1e-3
    np.testing.assert_allclose(at_rest["error"][OWN], SLOPE, rtol=5e-3)
    np.testing.assert_allclose(at_rest["band"], 1.25 * SLOPE * 2**-0.7, rtol=5e-3)
    np.testing.assert_allclose(summary["tip_deflection_m"]["error"][OWN], -2e-4, rtol=5e-3)
    assert summary["tip_deflection_m"]["limit"] == pytest.approx([TIP], rel=1e-6)


def test_the_coarsest_size_does_not_affect_the_order(summary, tmp_path):
    bent = levels(order=1.4)
    bent[0]["at_rest_Hz"] = list(1.01 * LIMIT)
    assert numbers(tmp_path, bent)["order"] == summary["order"]


def test_table_states_limits_errors_and_bands(summary):
    text = mesh.table(summary)
    assert "4.96 mm (5,000 nodes)" in text and "observed order 1.40" in text
    assert "| 1 | 250.00 | +0.05 ± 0.04 | 275.00 | +0.04 ± 0.03 |" in text
    assert "0.4000 mm, error -0.02 ± 0.02 %" in text


def test_page_takes_the_study_where_it_has_been_run(summary, tmp_path):
    pages = readme.read_pages(Path(__file__).parents[2])
    write_json(summary, tmp_path / "results/figures/mesh-convergence.json")
    assert mesh.table(summary) in readme.generated(pages, tmp_path)["fem/README.md"]


def test_the_own_size_gives_the_mesh_of_the_workflow(coarse_blade, coarse_yaml, coarse_matrices):
    own = mesh_level.numbers(None, coarse_yaml, FACTORS[OWN])
    assert own["element_size_mm"] == coarse_blade.mesh.element_size_mm
    assert 3 * own["nodes"] > coarse_matrices.M.shape[0]
    for name, K in (("at_rest_Hz", coarse_matrices.K[0]), ("at_Omega_m_Hz", coarse_matrices.K[-1])):
        omega = ShiftInvert(K, coarse_matrices.M).modes(MODES).omega
        np.testing.assert_allclose(own[name], omega / (2 * np.pi), rtol=1e-8)  # of the solver
    deflection = coarse_matrices.u_static[-1]
    (at,) = hats(1 / 16, coarse_matrices.xi) @ (coarse_matrices.S @ deflection).reshape(-1, 3)
    # equilibrium, from another start
    assert own["tip_deflection_m"] == pytest.approx(np.linalg.norm(at), rel=1e-7)
    # the nearest node of the mesh, some mm away
    r, theta, z = camber_at(coarse_matrices.camber, 1 / 16)
    place = np.array([r * np.cos(theta), r * np.sin(theta), z])
    node = np.linalg.norm(coarse_matrices.coordinates - place, axis=1).argmin()
    of_node = np.linalg.norm(deflection.reshape(-1, 3)[node])
    assert own["tip_deflection_m"] == pytest.approx(of_node, rel=0.05)
