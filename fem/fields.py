"""Displacement, strain and stress of the whole blade at one time, and their VTK file for ParaView.

From the static deflection and the vibration, prestress included: Eqs. (b), (e).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import ufl
from dolfinx import fem
from dolfinx.plot import vtk_mesh

from fem.solid import Solid, green_lagrange, read_solid, small_strain
from geometry.blade import Blade
from geometry.project import write_whole

AWAY = 0.05  # of the blade's length: distance from clamp and tip at which the stress has converged
TENSOR = ((0, 1, 2, 0, 1, 0), (0, 1, 2, 1, 2, 2))  # VTK's order: xx, yy, zz, xy, yz, xz
FULL = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2)])  # places in it of the entries of a tensor


@dataclass(frozen=True)
class Stress:
    """Strain and Cauchy stress at the nodes of the mesh, clamped ones included.

    Evaluated in each cell at its nodes, and averaged by component over the cells that share a node,
    as usual in finite-element codes. Averaging smooths jumps of the stress between cells;
    ``of_cells`` is not averaged, and the difference of both indicates the error of the mesh.
    """

    strain: NDArray[np.float64]  # (nodes, 3, 3), Green-Lagrange; small strain for `linear`
    stress: NDArray[np.float64]  # (nodes, 3, 3), Pa, Cauchy
    of_cells: NDArray[np.float64]  # (nodes,), Pa, largest von Mises stress in any cell of the node

    @property
    def von_mises(self) -> NDArray[np.float64]:
        """Von Mises stress (nodes,), Pa, of the averaged stress."""
        return von_mises(self.stress)


def stress(solid: Solid, u: NDArray[np.float64], prestress: str) -> Stress:
    """Strain and stress of displacements ``u`` (free DoFs), m: static deflection plus vibration.

    With ``prestress`` `nonlinear`, E and Eq. (e) of the sum; with `linear`, small strain and
    C : eps, which superpose. The vibration is assumed to be small: its quadratic terms in Eq. (e)
    are not in K(Omega).
    """
    tensors = _strain_and_stress(solid, solid.field(u), prestress)
    strain, sigma = (_expression(solid, of) for of in tensors)
    of_cells = _at_nodes_of_cells(solid, sigma)
    return Stress(
        strain=_averaged(solid, _at_nodes_of_cells(solid, strain)),
        stress=_averaged(solid, of_cells),
        of_cells=_largest(solid, von_mises(of_cells)),
    )


def rates(
    solid: Solid, u: NDArray[np.float64], along: NDArray[np.float64], prestress: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Derivatives of strain and stress about displacements ``u`` (free DoFs), m.

    Parameters
    ----------
    along : (k, free DoFs), displacements in whose directions the derivatives are taken

    Returns
    -------
    strain, stress : (k, nodes, 6), 1 and Pa per unit of each, in the order of ``TENSOR``, averaged
        at nodes as in ``Stress``
    """
    at, v = solid.field(u), fem.Function(solid.V)
    tensors = [ufl.derivative(of, at, v) for of in _strain_and_stress(solid, at, prestress)]
    expressions, found = [_expression(solid, of) for of in tensors], []
    for direction in along:
        v.x.array[solid.free] = direction
        fields = (_averaged(solid, _at_nodes_of_cells(solid, of)) for of in expressions)
        found.append([of[:, *TENSOR] for of in fields])
    strain, sigma = np.array(found).swapaxes(0, 1)
    return strain, sigma


def von_mises(sigma: NDArray[np.float64]) -> NDArray[np.float64]:
    """Von Mises stress sqrt(3/2 s : s), s the deviator of ``sigma`` (..., 3, 3)."""
    mean = np.trace(sigma, axis1=-2, axis2=-1) / 3
    deviator = sigma - mean[..., None, None] * np.eye(3)
    return np.sqrt(1.5 * (deviator**2).sum(axis=(-2, -1)))


def _strain_and_stress(
    solid: Solid, u: fem.Function, prestress: str
) -> tuple[ufl.core.expr.Expr, ufl.core.expr.Expr]:
    if prestress == "linear":
        eps = small_strain(u)
        return eps, solid.stress(eps)
    E, F = green_lagrange(u), ufl.Identity(3) + ufl.grad(u)
    return E, F * solid.stress(E) * F.T / ufl.det(F)


def _expression(solid: Solid, tensor: ufl.core.expr.Expr) -> fem.Expression:
    """``tensor`` at the nodes of a cell, compiled."""
    return fem.Expression(tensor, solid.V.element.interpolation_points)


def _at_nodes_of_cells(solid: Solid, expression: fem.Expression) -> NDArray[np.float64]:
    """Values of a tensor in every cell at its own nodes (cells, 10, 3, 3)."""
    cells = np.arange(len(solid.V.dofmap.list), dtype=np.int32)
    return expression.eval(solid.mesh, cells).reshape(len(cells), -1, 3, 3)


def _averaged(solid: Solid, of_cells: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean over the cells at each node (nodes, 3, 3)."""
    nodes = solid.V.dofmap.list
    total = np.zeros((nodes.max() + 1, 3, 3))
    np.add.at(total, nodes, of_cells)
    return total / np.bincount(nodes.ravel())[:, None, None]


def _largest(solid: Solid, of_cells: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest value at each node (nodes,) of those of its cells (cells, 10)."""
    nodes = solid.V.dofmap.list
    largest = np.zeros(nodes.max() + 1)
    np.maximum.at(largest, nodes, of_cells)
    return largest


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

        Raises
        ------
        geometry.project.errors.WriteError
            When it cannot be written.
        """
        data = {
            "static displacement (m)": self.static,
            "vibration (m)": self.vibration,
            "displacement (m)": self.static + self.vibration,
            "strain": self.total.strain[:, *TENSOR],
            "stress (Pa)": self.total.stress[:, *TENSOR],
            "von Mises (Pa)": self.total.von_mises,
            "von Mises of prestress (Pa)": self.prestress.von_mises,
        }
        save_vtu(self.points, self.cells, data, path, numbers)


def save_vtu(
    points: NDArray[np.float64],
    cells: NDArray[np.int64],
    data: Mapping[str, NDArray[np.float64]],
    path: str | Path,
    numbers: Mapping[str, float] | None = None,
) -> None:
    """Write ``data`` of the nodes by name, and ``numbers`` of the whole, as VTK XML, ``.vtu``.

    It is made in memory: where a disk is full VTK crashes.

    Parameters
    ----------
    points, cells : (nodes, 3) and (cells, 10), as of ``Fields``

    Raises
    ------
    geometry.project.errors.WriteError
        When it cannot be written.
    """
    grid = pv.UnstructuredGrid({pv.CellType.QUADRATIC_TETRA: cells}, points)
    grid.point_data.update(data)
    for name, value in (numbers or {}).items():
        grid.field_data[name] = [value]
    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    write_whole(writer.GetOutputString(), path)


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
    cells, points = grid_of(solid)
    return Fields(
        points=points,
        cells=cells,
        static=solid.field(static).x.array.reshape(-1, 3),
        vibration=solid.field(vibration).x.array.reshape(-1, 3),
        total=stress(solid, static + vibration, prestress),
        prestress=stress(solid, static, prestress),
        settled=away(solid),
    )


def grid_of(solid: Solid) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Cells (cells, 10), ten-node tetrahedra in VTK's order, and points (nodes, 3), m."""
    cells, _, points = vtk_mesh(solid.V)
    return cells.reshape(-1, 11)[:, 1:], points


def away(
    solid: Solid, from_clamp: float | None = None, from_tip: float | None = None
) -> NDArray[np.bool_]:
    """Nodes (nodes,) farther from clamp and tip than these, m, or ``AWAY`` of the blade's length.

    Nearer the stress does not converge: at the ends of the clamp with the mesh, under the contact
    with the patches.
    """
    points = solid.V.tabulate_dof_coordinates()
    length = np.ptp(np.hypot(points[:, 0], points[:, 1]))
    ends = solid.clamped_coordinates(), points[np.unique(solid.tip)]
    widths = (AWAY * length if width is None else width for width in (from_clamp, from_tip))
    nodes = [(cKDTree(of), width) for of, width in zip(ends, widths, strict=True) if len(of)]
    near = [tree.query(points)[0] <= width for tree, width in nodes]
    return ~np.any(near, axis=0) if near else np.ones(len(points), bool)


def dofs_at(coordinates: NDArray, points: NDArray) -> NDArray[np.int64]:
    """DoFs (points, 3) of the nodes of ``coordinates`` (nodes, 3), m, at ``points`` (points, 3)."""
    distance, node = cKDTree(coordinates).query(points)
    if distance.max() > 1e-9:
        raise ValueError(f"nodes and mesh differ by {distance.max():.1e} m: rebuild what is older")
    return 3 * node[:, None].astype(np.int64) + np.arange(3)
