"""What was meshed, in the units of a drawing: span, radius of the tip, mass, elements."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geometry.blade import Blade
from geometry.facets import normals
from geometry.mesh_file import read_mesh_file
from geometry.tetrahedra import edge_lengths, surface

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
    read = read_mesh_file(mesh)
    root, tip = (read.face_groups[name] for name in ("root", "tip"))
    of_root, of_tip, all_faces = (
        np.linalg.norm(normals(faces, read.points), axis=1).sum() / 2
        for faces in (root, tip, surface(read.cells))
    )
    radius = np.hypot(read.points[:, 0], read.points[:, 1])
    return Description(
        span=float(radius[tip].mean() - radius[root].mean()),
        tip_radius=float(radius[tip].max()),
        mass=float(blade.material.density_kg_m3 * volume),
        thickness=float(2 * volume / (all_faces - of_root - of_tip)),
        edge=float(edge_lengths(read.points, read.cells).mean()),
        cells=len(read.cells),
        nodes=len(read.points),
    )
