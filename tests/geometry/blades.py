"""Blades that differ from a given one, and parts of their meshes."""

import meshio
import numpy as np

from geometry.blade import SOURCES, Blade, Sections
from geometry.interface import tip_of
from geometry.profile import profile_at
from geometry.settings import check_settings
from geometry.tip import cartesian


def given(blade: Blade, **settings) -> Blade:
    """The blade with some of its settings replaced; a new source replaces the old one."""
    values = blade.model_dump(exclude_unset=True)
    if set(settings) & set(SOURCES):
        values = {key: value for key, value in values.items() if key not in SOURCES}
    return check_settings(Blade, values | settings, "test")


def nodes_of(mesh: meshio.Mesh, group: str) -> np.ndarray:
    """Points of the facets of a physical group."""
    return mesh.points[np.unique(facets_of(mesh, group))]


def facets_of(mesh: meshio.Mesh, group: str) -> np.ndarray:
    """Facets (k, 6) of a physical group."""
    tag, dimension = mesh.field_data[group]
    assert dimension == 2
    groups = zip(mesh.cells, mesh.cell_data["gmsh:physical"], strict=True)
    return np.vstack([b.data[tags == tag] for b, tags in groups if b.type == "triangle6"])


def camber_line(path) -> np.ndarray:
    """Camber line (101, 3), m, x, y, z, of the tip of ``blade.msh``."""
    mesh = meshio.read(path)
    return cartesian(tip_of(facets_of(mesh, "tip"), mesh.points).camber_line())


def on_tip(sections: Sections, xi: float, side: float) -> np.ndarray:
    """Point (3,), m, on the tip cylinder at chord fraction ``xi`` of its section.

    ``side`` is 0 on the camber line, 1 on the suction and -1 on the pressure side. The plane of the
    section follows by fixed-point iteration: the tip is a cylinder about z, so x = sqrt(R^2 - y^2);
    each of twenty iterations contracts by the slope of the lean, below 1e-2.
    """
    x = sections.tip_radius
    for _ in range(20):
        profile = profile_at(sections, x)
        w = 4 * xi * (1 - xi)
        half = profile.thickness / 2 * (profile.edge + (1 - profile.edge) * w)
        _, y, z = profile.place(xi, profile.camber * w + side * half)[0]
        x = np.sqrt(sections.tip_radius**2 - y**2)
    return np.array([x, y, z])
