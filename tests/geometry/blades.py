"""Blades that differ from a given one, and what their meshes hold."""

import meshio
import numpy as np

from geometry.blade import SOURCES, Blade
from geometry.settings import check_settings


def given(blade: Blade, **settings) -> Blade:
    """The blade with some of its settings replaced; a new source replaces the old one."""
    values = blade.model_dump(exclude_unset=True)
    if set(settings) & set(SOURCES):
        values = {key: value for key, value in values.items() if key not in SOURCES}
    return check_settings(Blade, values | settings, "test")


def nodes_of(mesh: meshio.Mesh, group: str) -> np.ndarray:
    """Points of the facets of a physical group."""
    tag, dimension = mesh.field_data[group]
    assert dimension == 2
    groups = zip(mesh.cells, mesh.cell_data["gmsh:physical"], strict=True)
    facets = [block.data[tags == tag] for block, tags in groups if block.type == "triangle6"]
    return mesh.points[np.unique(np.vstack(facets))]
