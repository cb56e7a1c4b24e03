"""Blades that differ from a given one, and parts of their meshes."""

from pathlib import Path

import meshio
import numpy as np
from exports import groups

from geometry.base import check_settings
from geometry.blade import SOURCES, Blade, Sections
from geometry.interface import tip_of
from geometry.profile import Airfoil, profile_at
from geometry.tip import cartesian


def given(blade: Blade, **settings) -> Blade:
    """The blade with some of its settings replaced; a new source replaces the old one."""
    values = blade.model_dump(exclude_unset=True)
    if set(settings) & set(SOURCES):
        values = {key: value for key, value in values.items() if key not in SOURCES}
    return check_settings(Blade, values | settings, "test")


def nodes_of(mesh: meshio.Mesh, group: str) -> np.ndarray:
    """Points of the facets of a physical group."""
    return mesh.points[np.unique(groups(mesh)[group])]


# Ten-node tetrahedron: corners, then the middles of these edges.
EDGES = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]


def jacobians(points: np.ndarray, cells: np.ndarray, barycentric: np.ndarray) -> np.ndarray:
    """det dX/dxi (cells, places) of every cell at some places, from the shape functions."""
    to_local = np.array([[-1.0, -1, -1], [1, 0, 0], [0, 1, 0], [0, 0, 1]])  # dL / d(xi, eta, zeta)
    gradients = []
    for L in np.asarray(barycentric, dtype=float):
        corners = [(4 * L[a] - 1) * to_local[a] for a in range(4)]
        middles = [4 * (L[a] * to_local[b] + L[b] * to_local[a]) for a, b in EDGES]
        gradients.append(corners + middles)
    return np.linalg.det(np.einsum("cai,paj->cpij", points[cells], gradients))


def volume(points: np.ndarray, cells: np.ndarray) -> float:
    """Volume of ten-node cells by a rule of degree 3: exact, as that of the determinant is."""
    places = np.vstack([np.full(4, 1 / 4), 1 / 6 + np.eye(4) / 3])
    weights = np.array([-4 / 5, 9 / 20, 9 / 20, 9 / 20, 9 / 20]) / 6
    return float((jacobians(points, cells, places) @ weights).sum())


def first_frequency(blade: Blade, path: Path) -> float:
    """Omega of the first mode at rest, rad/s, of the mesh ``path``."""
    from fem.assemble import assemble
    from rom.modes import ShiftInvert

    matrices = assemble(blade, "test", path, [0.0])
    return ShiftInvert(matrices.K[0], matrices.M).modes(1).omega[0]


def camber_line(path) -> np.ndarray:
    """Camber line (101, 3), m, x, y, z, of the tip of ``blade.msh``."""
    mesh = meshio.read(path)
    return cartesian(tip_of(groups(mesh)["tip"], mesh.points).camber_line())


def height(profile: Airfoil, xi: np.ndarray, side: float) -> np.ndarray:
    """Height over the chord, from the definition: camber and half the thickness to one side."""
    w = 4 * xi * (1 - xi)
    half = profile.thickness / 2 * (profile.edge + (1 - profile.edge) * w)
    return profile.camber * w + side * half


def on_tip(sections: Sections, xi: float, side: float, radius: float | None = None) -> np.ndarray:
    """Point (3,), m, on the cylinder of the tip, or another one, at ``xi`` of its section.

    ``side`` is 0 on the camber line, 1 on the suction and -1 on the pressure side. The plane of the
    section follows by fixed-point iteration on the cylinder about z: x = sqrt(R^2 - y^2);
    each of twenty iterations contracts by the slope of the lean, below 1e-2.
    """
    x = radius = radius or sections.tip_radius
    for _ in range(20):
        profile = profile_at(sections, x)
        _, y, z = profile.place(xi, height(profile, xi, side))[0]
        x = np.sqrt(radius**2 - y**2)
    return np.array([x, y, z])
