"""Strain and stress of a displacement field, prestress included: Eqs. (b), (e)."""

from dataclasses import dataclass

import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

import numpy as np
from numpy.typing import NDArray

import ufl
from dolfinx import fem

from fem.solid import Solid, green_lagrange, small_strain


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
    strain, sigma = _strain_and_stress(solid, solid.field(u), prestress)
    of_cells = _at_nodes_of_cells(solid, sigma)
    return Stress(
        strain=_averaged(solid, _at_nodes_of_cells(solid, strain)),
        stress=_averaged(solid, of_cells),
        of_cells=_largest(solid, von_mises(of_cells)),
    )


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


def _at_nodes_of_cells(solid: Solid, tensor: ufl.core.expr.Expr) -> NDArray[np.float64]:
    """``tensor`` in every cell at its own nodes (cells, 10, 3, 3)."""
    cells = np.arange(len(solid.V.dofmap.list), dtype=np.int32)
    expression = fem.Expression(tensor, solid.V.element.interpolation_points)
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
