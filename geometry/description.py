"""What was meshed, in the units of a drawing: span, radius of the tip, mass, elements."""

from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

from geometry.blade import Blade
from geometry.tetrahedra import surface

ENOUGH = 1.0  # ten-node tetrahedra through the mean thickness: f1 to 0.1 % on the reference blade


@dataclass(frozen=True)
class Description:
    """Numbers of a mesh that its author knows from elsewhere."""

    span: float  # m, mean radius of the tip less that of the root
    tip_radius: float  # m, largest
    mass: float  # kg
    thickness: float  # m, mean: twice the volume over the area of the sides
    edge: float  # m, mean edge of the elements
    cells: int
    nodes: int

    @property
    def through(self) -> float:
        """Elements through the mean thickness."""
        return self.thickness / self.edge

    def line(self) -> str:
        """All of it in one line, and whether the elements are enough."""
        enough = self.through >= ENOUGH
        finer = f"take mesh.element_size_mm below {1e3 * self.thickness / ENOUGH:.2g}"
        return (
            f"span {1e3 * self.span:.1f} mm, tip radius {1e3 * self.tip_radius:.1f} mm, mass "
            f"{1e3 * self.mass:.4g} g; {self.cells} ten-node tetrahedra, {self.nodes} nodes, "
            f"{self.through:.1f} through the mean thickness of {1e3 * self.thickness:.2g} mm: "
            f"{'enough' if enough else f'too few for bending, {finer}'}"
        )


def describe(blade: Blade, mesh: str | Path, volume: float) -> Description:
    """Describe the mesh of a blade, ``blade.msh``, with its volume, m3."""
    read = meshio.read(mesh)
    cells = np.concatenate([block.data for block in read.cells if block.type == "tetra10"])
    root, tip = (_corners(read, group) for group in ("root", "tip"))
    ends = sum(_areas(read.points[of]).sum() for of in (root, tip))
    sides = _areas(read.points[surface(cells)]).sum() - ends
    radius = np.hypot(read.points[:, 0], read.points[:, 1])
    return Description(
        span=float(radius[tip].mean() - radius[root].mean()),
        tip_radius=float(radius[tip].max()),
        mass=float(blade.material.density_kg_m3 * volume),
        thickness=float(2 * volume / sides),
        edge=float(_edges(read.points[cells[:, :4]])),
        cells=len(cells),
        nodes=len(read.points),
    )


def _corners(read: meshio.Mesh, group: str) -> NDArray[np.int64]:
    """Corners (k, 3) of the facets of a group."""
    tag = read.field_data[group][0]
    facets = zip(read.cells, read.cell_data["gmsh:physical"], strict=True)
    of = [cells.data[tags == tag] for cells, tags in facets if cells.type == "triangle6"]
    return np.concatenate(of)[:, :3]


def _areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    a, b = (corners[:, i] - corners[:, 0] for i in (1, 2))
    return np.linalg.norm(np.cross(a, b), axis=1) / 2


def _edges(corners: NDArray[np.float64]) -> float:
    """Mean length of the edges of tetrahedra, m."""
    pairs = np.array([(i, j) for i in range(4) for j in range(i)])
    return float(np.linalg.norm(corners[:, pairs[:, 0]] - corners[:, pairs[:, 1]], axis=2).mean())
