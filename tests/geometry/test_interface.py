"""Number of patches allowed by a mesh, and places of an interface of points on the facets."""

import exports
import meshio
import numpy as np
import pytest
from blades import given, on_tip
from refused import refused

from geometry.base import MeshError
from geometry.blade import Interface
from geometry.interface import on_facets, places_of, require_patches, tip_of
from geometry.mesh import build_mesh
from geometry.tip import cartesian

POINTS = {"basis": {"kind": "paper"}}


@pytest.mark.parametrize(
    ("patches", "xi", "serves"),
    [
        (64, np.linspace(0, 1, 13), 12),
        (12, np.linspace(0, 1, 9), 8),
        (64, np.linspace(0, 1, 31), 30),
        (7, np.linspace(0, 1, 3), 2),
        # across the thickness a mesh has many nodes, all at one chord fraction
        (8, np.repeat(np.linspace(0, 1, 5), 10), 4),
        (4, np.array([0.0, 1.0]), 0),
    ],
)
def test_more_patches_than_the_mesh_resolves_are_refused_with_the_number_allowed(
    patches, xi, serves
):
    """Equally spaced nodes: a hat at either end needs a second node under it, short of its foot."""
    for count in {patches, serves + 1} - {serves}:
        error = refused(MeshError, require_patches, count, xi)
        assert (error.key, error.value) == ("interface.patches", count)
        assert error.allowed == {"le": serves}
    if serves:
        require_patches(serves, xi)


def test_a_blade_with_too_many_patches_is_refused_and_meshed_with_the_number_allowed(
    coarse_blade, tmp_path
):
    error = refused(
        MeshError,
        build_mesh,
        given(coarse_blade, interface={"patches": 64}),
        tmp_path / "b.msh",
    )
    assert not list(tmp_path.iterdir())
    serves = error.allowed["le"]
    assert serves >= 8  # the number that the coarse blade has
    build_mesh(given(coarse_blade, interface={"patches": serves}), tmp_path / "b.msh")


@pytest.fixture(scope="module")
def facets(coarse_mesh):
    """Points (n, 3), m, of the coarse mesh, and its tip's facets (k, 6)."""
    mesh = meshio.read(coarse_mesh.mesh)
    return mesh.points, exports.groups(mesh)["tip"]


@pytest.fixture(scope="module")
def tip(facets):
    points, corners = facets
    return tip_of(corners, points)


def test_the_orientation_of_the_facets_does_not_matter(facets, tip):
    """Facets of a file may have inward normals: the outline is the same."""
    points, corners = facets
    mixed = corners.copy()
    mixed[::2] = corners[::2][:, [0, 2, 1, 5, 4, 3]]
    np.testing.assert_allclose(tip_of(mixed, points).xi(points), tip.xi(points), atol=1e-13)


def test_points_by_rule_are_in_the_middles_of_equal_chord_lengths(coarse_blade, facets, tip):
    """Against the sections' closed form, on the tip cylinder.

    The outline is of straight pieces, and the developed tip's chord is not quite the section's:
    measured 9 um across the chord and 1.5e-4 along it.
    """
    places = places_of(Interface(nodes=8), tip)
    _, _, found = on_facets(facets[0], facets[1], tip, places)
    nearby = np.linspace(-5e-4, 5e-4, 41)
    for point, xi in zip(found, (np.arange(8) + 0.5) / 8, strict=True):
        line = np.array([on_tip(coarse_blade.sections, xi + d, 0) for d in nearby])
        gap = np.linalg.norm(line - point, axis=1)
        assert gap.min() < 2e-5
        assert abs(nearby[gap.argmin()]) < 2.5e-4
    assert np.all(np.diff(found[:, 2]) > 0)  # leading edge first


def test_points_listed_are_found_to_the_digits_given(coarse_blade, facets, tip):
    """Three digits of a mm put them 0.5 um off the tip along each axis; inside, and on its edge."""
    s = coarse_blade.sections
    listed = [on_tip(s, 0.2, 0), on_tip(s, 0.4, 0.5), on_tip(s, 0.6, -0.99)]
    listed = [np.round(1e3 * place, 3).tolist() for place in listed]
    nodes, values, there = on_facets(
        facets[0], facets[1], tip, places_of(Interface(points_mm=listed), tip)
    )
    np.testing.assert_allclose(1e3 * there, listed, atol=1e-3)
    np.testing.assert_allclose(values.sum(axis=1), 1, atol=1e-13)
    of_nodes = np.einsum("nk,nkd->nd", values, facets[0][nodes])
    np.testing.assert_allclose(of_nodes, there, atol=1e-15)


@pytest.mark.parametrize(
    ("move", "fault"),
    [
        ([5, 0, 0], r"^interface point 2 lies 5 mm off the tip or beside it; allowed 0.1 mm$"),
        ([0, 10, 0], r"interface point 2 lies .* off the tip or beside it"),  # at its radius
    ],
)
def test_listed_point_off_the_tip_is_refused_before_anything_is_written(
    coarse_blade, tmp_path, move, fault
):
    listed = [1e3 * on_tip(coarse_blade.sections, xi, 0) for xi in (0.2, 0.4)]
    listed[1] = listed[1] + move
    rule = {"points_mm": [place.tolist() for place in listed]}
    refused(
        MeshError,
        build_mesh,
        given(coarse_blade, interface=rule, **POINTS),
        tmp_path / "b.msh",
        match=fault,
    )
    assert not list(tmp_path.iterdir())


def test_the_number_of_points_does_not_depend_on_the_mesh(coarse_blade, tmp_path):
    """Points use shape functions and need no node of the mesh."""
    build_mesh(given(coarse_blade, interface={"nodes": 60}, **POINTS), tmp_path / "b.msh")


def test_camber_line_of_the_mesh_is_that_of_the_sections(coarse_blade, tip):
    """Midway between two polylines of a coarse mesh: measured 12 um off, at the ends 0.4 um."""
    line = cartesian(tip.camber_line())
    nearby = np.array([on_tip(coarse_blade.sections, xi, 0) for xi in np.linspace(0, 1, 2001)])
    gap = np.linalg.norm(line[:, None] - nearby, axis=2).min(axis=1)
    assert gap.max() < 2e-5
    ends = np.linalg.norm(line[[0, -1]] - nearby[[0, -1]], axis=1)
    assert ends.max() < 1e-6
