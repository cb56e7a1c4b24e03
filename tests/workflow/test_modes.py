"""The job of component modes: of the matrices, and the full model at their speeds."""

from dataclasses import replace

import numpy as np
import pytest
import yaml
from refused import refused

from geometry.base import ProvenanceError, silent
from rom.components import ComponentModes
from rom.full_model import MODES, FullModel
from workflow.jobs.full_model import assembled, solve_modes, solved_at


@pytest.fixture
def given(tmp_path, coarse_blade, coarse_mesh, coarse_matrices):
    """Paths of a blade's file, its matrices and its mesh."""
    blade, matrices = tmp_path / "coarse.yaml", tmp_path / "matrices.h5"
    blade.write_text(yaml.safe_dump(coarse_blade.model_dump(mode="json", exclude_unset=True)))
    coarse_matrices.save(matrices)
    return str(blade), str(matrices), str(coarse_mesh.mesh)


def test_the_full_model_has_the_modes_of_the_basis(given, tmp_path):
    """The second order of vibrations with a mesh alone; as many modes as the check needs."""
    blade, matrices, mesh = given
    modes, full = str(tmp_path / "modes.h5"), str(tmp_path / "full-model.nc")
    for of_mesh, count in ((mesh, 12), ("", 0)):
        solve_modes(blade, matrices, of_mesh, count, modes, full, silent)
        components, solved = ComponentModes.load(modes), FullModel.load(full)
        assert components.omega.shape == (4, max(count, MODES))
        np.testing.assert_array_equal(solved.omega, components.omega[:, :MODES])
        assert np.isfinite(solved.second_order).all() == bool(of_mesh)


def test_matrices_of_nodes_in_another_order_are_refused(given, tmp_path, coarse_matrices):
    blade, matrices, mesh = given
    other = replace(coarse_matrices, coordinates=coarse_matrices.coordinates[::-1].copy())
    other.save(matrices)
    modes, full = str(tmp_path / "modes.h5"), str(tmp_path / "full-model.nc")
    error = refused(ProvenanceError, solve_modes, blade, matrices, mesh, 4, modes, full, silent)
    assert error.file == matrices and not (tmp_path / "modes.h5").exists()


def test_matrices_of_linear_prestress_give_the_full_model_at_other_speeds(
    tmp_path, coarse_blade, coarse_mesh
):
    """As those that are assembled there, with the second order of vibrations."""
    settings = coarse_blade.but(prestress="linear")
    blade, matrices = tmp_path / "coarse.yaml", tmp_path / "matrices.h5"
    blade.write_text(yaml.safe_dump(settings.model_dump(mode="json", exclude_unset=True)))
    assembled(settings, "coarse", coarse_mesh.mesh).save(matrices)
    mesh, speeds = str(coarse_mesh.mesh), [123.0, 456.0]
    given, anew = (solved_at(speeds, str(blade), mesh, of) for of in (str(matrices), ""))
    for name in ("speeds", "omega", "compliance", "second_order"):
        expected = getattr(anew, name)
        np.testing.assert_allclose(
            getattr(given, name), expected, rtol=0, atol=1e-8 * abs(expected).max()
        )
