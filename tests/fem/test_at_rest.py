"""The shape at rest of a blade whose geometry is that at speed."""

import exports
import meshio
import numpy as np
import pytest
from refused import refused

from fem import at_rest
from fem.assemble import assemble
from fem.at_rest import build_mesh_at_rest
from fem.fields import dofs_at
from fem.prestress import nonlinear_states
from fem.solid import read_solid
from geometry.base import RPM, MeshError
from rom.modes import ShiftInvert

OMEGA = 640.0  # rad/s
SPAN = 0.14  # m


@pytest.fixture(scope="module")
def running(coarse_blade, coarse_mesh, solid, tmp_path_factory):
    """The coarse blade's mesh as it runs, and the settings that name it."""
    (state,) = nonlinear_states(solid, np.array([OMEGA]))
    parts = exports.parts(coarse_mesh.mesh)
    points = 1e-3 * parts.points
    moved = solid.field(state.u_static).x.array[dofs_at(solid.V.tabulate_dof_coordinates(), points)]
    path = tmp_path_factory.mktemp("running") / "blade.msh"
    exports.write_msh(path, points + moved, *parts[1:])
    blade = exports.as_meshed(coarse_blade, path.name, "root", "tip", unit="m")
    return path, blade.model_copy(update={"geometry_at_rpm": OMEGA * RPM})


@pytest.fixture(scope="module")
def found(running, tmp_path_factory):
    """The mesh at rest made of it."""
    path, blade = running
    mesh = tmp_path_factory.mktemp("at-rest") / "blade.msh"
    build_mesh_at_rest(blade, mesh, path)
    return mesh


def test_the_shape_at_rest_is_that_which_was_spun(found, running, coarse_mesh):
    """Two ways: from rest to speed by Newton, back by the fixed point."""
    was, at_speed, back = (meshio.read(p).points for p in (coarse_mesh.mesh, running[0], found))
    assert abs(at_speed - was).max() > 1e-3 * SPAN
    assert abs(back - was).max() < 1e-6 * SPAN


def test_it_has_the_frequencies_at_rest_and_at_speed(found, running, coarse_blade, coarse_mesh):
    """Taken for the shape at rest, the running one would have other ones."""
    speeds = [0.0, OMEGA]
    ours, expected = (
        assemble(blade, "at rest", mesh, speeds)
        for blade, mesh in ((running[1], found), (coarse_blade, coarse_mesh.mesh))
    )
    for K, expected_K in zip(ours.K, expected.K, strict=True):
        omega, expected_omega = (
            ShiftInvert(A, of.M).modes(10).omega for A, of in ((K, ours), (expected_K, expected))
        )
        np.testing.assert_allclose(omega, expected_omega, rtol=1e-6)


def test_what_does_not_close_is_refused(running, tmp_path, monkeypatch):
    monkeypatch.setattr(at_rest, "ROUNDS", 1)
    path, blade = running
    error = refused(MeshError, build_mesh_at_rest, blade, tmp_path / "blade.msh", path)
    assert error.key == "geometry_at_rpm" and "not found" in error.text
    assert not (tmp_path / "blade.msh").exists()


def test_without_the_key_the_geometry_is_at_rest(coarse_blade, coarse_mesh, tmp_path):
    summary = build_mesh_at_rest(coarse_blade, tmp_path / "blade.msh")
    assert summary == coarse_mesh.summary
    solids = (
        read_solid(str(p), coarse_blade.material)
        for p in (tmp_path / "blade.msh", coarse_mesh.mesh)
    )
    first, second = (of.mesh.geometry.x for of in solids)
    np.testing.assert_array_equal(first, second)
