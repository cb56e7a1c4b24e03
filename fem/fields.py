"""Fields of the whole blade at one time, and their VTK file for ParaView.

Displacement, strain and stress, from the static deflection and the vibration.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

from dolfinx.plot import vtk_mesh

from fem.solid import Solid, read_solid
from fem.stress import Stress, stress
from geometry.blade import Blade
from geometry.files import whole

AWAY = 0.05  # of the blade's length: distance from clamp and tip at which the stress has converged
TENSOR = ((0, 1, 2, 0, 1, 0), (0, 1, 2, 1, 2, 2))  # VTK's order: xx, yy, zz, xy, yz, xz


@dataclass(frozen=True)
class Fields:
    """Displacement, strain and stress at the nodes of the mesh, clamped ones included."""

    points: NDArray[np.float64]  # (nodes, 3), m, undeformed
    cells: NDArray[np.int64]  # (cells, 10), ten-node tetrahedra in VTK's order
    static: NDArray[np.float64]  # (nodes, 3), m, deflection under rotation
    vibration: NDArray[np.float64]  # (nodes, 3), m, about it
    total: Stress  # of their sum
    prestress: Stress  # of the static deflection alone
    settled: NDArray[np.bool_]  # (nodes,), away from the clamp's ends and from contact

    def numbers(self) -> dict[str, Any]:
        """Largest displacements, m, and von Mises stresses, Pa, with the place of the latter, m."""
        return {
            "largest_static_m": np.linalg.norm(self.static, axis=1).max(),
            "largest_vibration_m": np.linalg.norm(self.vibration, axis=1).max(),
            "von_mises": self._peak(self.total),
            "von_mises_of_prestress": self._peak(self.prestress),
        }

    def _peak(self, of: Stress) -> dict[str, Any]:
        """Largest of all nodes, and of those where it converges with mesh and patches."""
        nodes = np.flatnonzero(self.settled)
        return self._largest(of, np.arange(len(self.points))) | {
            "settled": self._largest(of, nodes) if len(nodes) else None
        }

    def _largest(self, of: Stress, nodes: NDArray[np.int64]) -> dict[str, Any]:
        node = nodes[of.von_mises[nodes].argmax()]
        return {
            "largest_Pa": of.von_mises[node],
            "at_m": self.points[node].tolist(),
            "largest_of_cells_Pa": float(of.of_cells[nodes].max()),
        }

    def save(self, path: str | Path, numbers: Mapping[str, float]) -> None:
        """Write VTK XML, ``.vtu``, with ``numbers`` of it by name: speed, time.

        It is made in memory: where a disk is full VTK crashes.

        Raises
        ------
        geometry.errors.WriteError
            When it cannot be written.
        """
        grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: self.cells}, self.points)
        grid.point_data.update(
            {
                "static displacement (m)": self.static,
                "vibration (m)": self.vibration,
                "displacement (m)": self.static + self.vibration,
                "strain": self.total.strain[:, *TENSOR],
                "stress (Pa)": self.total.stress[:, *TENSOR],
                "von Mises (Pa)": self.total.von_mises,
                "von Mises of prestress (Pa)": self.prestress.von_mises,
            }
        )
        for name, value in numbers.items():
            grid.field_data[name] = [value]
        writer = vtkXMLUnstructuredGridWriter()
        writer.SetInputData(grid)
        writer.SetDataModeToBinary()
        writer.WriteToOutputStringOn()
        writer.Write()
        with whole(path) as temporary:
            temporary.write_text(writer.GetOutputString())


def fields(
    blade: Blade,
    mesh_path: str | Path,
    coordinates: NDArray[np.float64],
    static: NDArray[np.float64],
    vibration: NDArray[np.float64],
) -> Fields:
    """Fields of the blade from displacements of its free nodes.

    Parameters
    ----------
    coordinates : (n_full / 3, 3), m, the free nodes in the order of the displacements
    static, vibration : (n_full,), m, Cartesian

    Raises
    ------
    ValueError
        When a free node of the mesh is not among the coordinates.
    """
    solid = read_solid(str(mesh_path), blade.material)
    order = dofs_at(coordinates, solid.free_coordinates()).ravel()
    return on_solid(solid, static[order], vibration[order], blade.prestress)


def on_solid(
    solid: Solid, static: NDArray[np.float64], vibration: NDArray[np.float64], prestress: str
) -> Fields:
    """Fields from displacements (free DoFs) in the order of ``solid``, m."""
    cells, _, points = vtk_mesh(solid.V)
    return Fields(
        points=points,
        cells=cells.reshape(-1, 11)[:, 1:],
        static=solid.field(static).x.array.reshape(-1, 3),
        vibration=solid.field(vibration).x.array.reshape(-1, 3),
        total=stress(solid, static + vibration, prestress),
        prestress=stress(solid, static, prestress),
        settled=away(solid),
    )


def away(solid: Solid) -> NDArray[np.bool_]:
    """Nodes (nodes,) farther from clamp and tip than ``AWAY`` of the blade's length.

    Nearer the stress does not converge: at the ends of the clamp with the mesh, under the contact
    with the patches.
    """
    points = solid.V.tabulate_dof_coordinates()
    length = np.ptp(np.hypot(points[:, 0], points[:, 1]))
    ends = solid.clamped_coordinates(), points[np.unique(solid.tip)]
    near = [cKDTree(of).query(points)[0] <= AWAY * length for of in ends if len(of)]
    return ~np.any(near, axis=0) if near else np.ones(len(points), bool)


def dofs_at(coordinates: NDArray, points: NDArray) -> NDArray[np.int64]:
    """DoFs (points, 3) of the nodes of ``coordinates`` (nodes, 3), m, at ``points`` (points, 3)."""
    distance, node = cKDTree(coordinates).query(points)
    if distance.max() > 1e-9:
        raise ValueError(f"nodes and mesh differ by {distance.max():.1e} m: rebuild what is older")
    return 3 * node[:, None].astype(np.int64) + np.arange(3)
