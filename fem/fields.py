"""Displacement, strain and stress of the whole blade at one time, and their VTK file for ParaView.

From the static deflection and the vibration, prestress included: Eqs. (b), (e). It is read on the
airfoil, the part of the blade away from clamp and contact. And what strain gauges on its surface
read: a grid averages over its length the strain e . E e along it, and the stress e . sigma e, of
the fields averaged at nodes, quadratic on each facet. With `nonlinear` prestress E and e are those
of the blade at rest, on which gauges are bonded.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fem.petsc import MPI  # noqa: F401  ahead of DOLFINx

import numpy as np
import pyvista as pv
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.spatial import cKDTree
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

import ufl
from dolfinx import fem
from dolfinx.plot import vtk_mesh

from fem.fatigue import von_mises
from fem.forms import compiled_at
from fem.solid import Solid, green_lagrange, read_solid, small_strain
from geometry.base import SettingsError, require, write_whole
from geometry.blade import Blade, Stress as Asked
from geometry.facets import normals, shape_functions
from geometry.frame import axes
from geometry.hats import middles
from geometry.tetrahedra import exterior

AWAY = 0.05  # of the blade's length: distance from clamp and tip at which the stress has converged
TENSOR = ((0, 1, 2, 0, 1, 0), (0, 1, 2, 1, 2, 2))  # VTK's order: xx, yy, zz, xy, yz, xz
TWICE = np.where(np.equal(*TENSOR), 1, 2)  # how often a tensor has each of them
FARTHEST = 1e-3  # m, from the surface to the place that is given for a gauge
LEAST = 0.2  # part of a direction along the surface: with less the facet decides on the grid
PLACES = 5  # along a grid, at which the fields are averaged
ALONG = 31  # places along an edge of a facet, at which distances are taken


@dataclass(frozen=True)
class Stress:
    """Strain and Cauchy stress at the nodes of the mesh, clamped ones included.

    Evaluated in each cell at its nodes, and averaged by component over the cells that share a node,
    as usual in finite-element codes.
    """

    strain: NDArray[np.float64]  # (nodes, 3, 3), Green-Lagrange; small strain for `linear`
    stress: NDArray[np.float64]  # (nodes, 3, 3), Pa, Cauchy

    @property
    def von_mises(self) -> NDArray[np.float64]:
        """Von Mises stress (nodes,), Pa, of the averaged stress."""
        return von_mises(self.stress[:, *TENSOR])


def stress(solid: Solid, u: NDArray[np.float64], prestress: str) -> Stress:
    """Strain and stress of displacements ``u`` (free DoFs), m: static deflection plus vibration.

    With ``prestress`` `nonlinear`, E and Eq. (e) of the sum; with `linear`, small strain and
    C : eps, which superpose. The vibration is assumed to be small: its quadratic terms in Eq. (e)
    are not in K(Omega).
    """
    tensors = _strain_and_stress(solid, solid.field(u), prestress)
    cells = np.arange(len(solid.V.dofmap.list))
    average = _average(solid, cells)
    strain, sigma = (
        _averaged(average, _at_nodes(solid, _expression(solid, tensor), cells))
        for tensor in tensors
    )
    return Stress(strain, sigma)


def linearised(
    solid: Solid,
    u: NDArray[np.float64],
    along: NDArray[np.float64],
    prestress: str,
    nodes: NDArray[np.int64] | None = None,
    *,
    strain: bool = True,
) -> NDArray[np.float64]:
    """Strain and stress about displacements ``u`` (free DoFs), m: their values and derivatives.

    Parameters
    ----------
    along : (k, free DoFs), displacements in whose directions the derivatives are taken
    nodes : those of the result; all if not given
    strain : whether it is wanted, or stress alone

    Returns
    -------
    strain, stress : (2 or 1, 1 + k, nodes, 6), 1 and Pa, those of ``u``, then those per unit of
        each of ``along``; in the order of ``TENSOR``, averaged at nodes as in ``Stress``
    """
    nodes = np.arange(len(solid.V.tabulate_dof_coordinates())) if nodes is None else nodes
    cells = cells_of(solid, nodes)
    rows, average = _rows(solid, u, along, prestress, cells, strain), _average(solid, cells)[nodes]
    averaged = [[_averaged(average, tensor) for tensor in row] for row in rows]
    return np.array(averaged)[..., *TENSOR].swapaxes(0, 1)


def disagreement(
    solid: Solid, u: NDArray[np.float64], along: NDArray[np.float64], prestress: str, node: int
) -> NDArray[np.float64]:
    """Von Mises stress (1 + k,), Pa, by which the cells of a node differ from their mean.

    Root mean square over the cells, the largest of the node and those ``around`` it; of the stress
    of ``u``, then of that per unit of each of ``along``, as of ``linearised``. The exact stress is
    continuous: this is a measure of the error of the mesh there (Zienkiewicz and Zhu, Int. J.
    Numer. Meth. Engng. 24, 1987).
    """
    nodes = around(solid, node)
    cells = cells_of(solid, nodes)
    of_cells, average = solid.V.dofmap.list[cells], _average(solid, cells)
    off = (
        sigma - _averaged(average, sigma)[of_cells]
        for (sigma,) in _rows(solid, u, along, prestress, cells, strain=False)
    )
    squares = (average[nodes] @ von_mises(by[..., *TENSOR]).ravel() ** 2 for by in off)
    return np.sqrt([of_nodes.max() for of_nodes in squares])


def around(solid: Solid, node: int) -> NDArray[np.int64]:
    """A node, and all others of its cells."""
    return np.unique(solid.V.dofmap.list[cells_of(solid, np.array([node]))])


def cells_of(solid: Solid, nodes: NDArray[np.int64]) -> NDArray[np.int64]:
    """Cells that have any of the ``nodes``."""
    return np.flatnonzero(np.isin(solid.V.dofmap.list, nodes).any(axis=1))


def _rows(
    solid: Solid,
    u: NDArray[np.float64],
    along: NDArray[np.float64],
    prestress: str,
    cells: NDArray[np.int64],
    strain: bool,
) -> Iterator[list[NDArray[np.float64]]]:
    """Strain and stress at the nodes of ``cells`` (cells, 10, 3, 3): of ``u``, then per unit."""
    deflected, v = solid.field(u), fem.Function(solid.V)
    tensors = _strain_and_stress(solid, deflected, prestress)[0 if strain else 1 :]
    rates = [_expression(solid, ufl.derivative(tensor, deflected, v)) for tensor in tensors]
    values = [_expression(solid, tensor) for tensor in tensors]
    for row, direction in zip([values] + [rates] * len(along), [0.0, *along], strict=True):
        v.x.array[solid.free] = direction
        yield [_at_nodes(solid, tensor, cells) for tensor in row]


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
    return compiled_at(tensor, solid.V.element.interpolation_points)


def _at_nodes(
    solid: Solid, expression: fem.Expression, cells: NDArray[np.int64]
) -> NDArray[np.float64]:
    """A tensor in ``cells`` at each of their nodes (cells, 10, 3, 3)."""
    return expression.eval(solid.mesh, cells.astype(np.int32)).reshape(len(cells), -1, 3, 3)


def _average(solid: Solid, cells: NDArray[np.int64]) -> csr_matrix:
    """Mean over ``cells`` at each node (nodes, 10 cells) of values at theirs; 0 at all others."""
    nodes, of_all = solid.V.dofmap.list[cells].ravel(), int(solid.V.dofmap.list.max()) + 1
    share = 1 / np.bincount(nodes, minlength=of_all)[nodes]
    return csr_matrix((share, (nodes, np.arange(len(nodes)))), (of_all, len(nodes)))


def _averaged(average: csr_matrix, tensor: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean (nodes, 3, 3) of a tensor as of ``_at_nodes``."""
    return (average @ tensor.reshape(-1, 9)).reshape(-1, 3, 3)


@dataclass(frozen=True)
class Fields:
    """Displacement, strain and stress at the nodes of the mesh, clamped ones included."""

    points: NDArray[np.float64]  # (nodes, 3), m, undeformed
    cells: NDArray[np.integer]  # (cells, 10), ten-node tetrahedra in VTK's order
    static: NDArray[np.float64]  # (nodes, 3), m, deflection under rotation
    vibration: NDArray[np.float64]  # (nodes, 3), m, about it
    total: Stress  # of their sum
    prestress: Stress  # of the static deflection alone

    def save(self, path: str | Path, numbers: Mapping[str, float]) -> None:
        """Write VTK XML, ``.vtu``, with ``numbers`` of it by name: speed, time.

        Raises
        ------
        geometry.base.errors.WriteError
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
    cells: NDArray[np.integer],
    data: dict[str, NDArray[np.float64]],
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
    geometry.base.errors.WriteError
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
    )


def grid_of(solid: Solid) -> tuple[NDArray[np.integer], NDArray[np.float64]]:
    """Cells (cells, 10), ten-node tetrahedra in VTK's order, and points (nodes, 3), m."""
    cells, _, points = vtk_mesh(solid.V)
    return cells.reshape(-1, 11)[:, 1:], points


def away(
    solid: Solid,
    from_clamp: float | None = None,
    from_tip: float | None = None,
    places: NDArray[np.float64] | None = None,
) -> NDArray[np.bool_]:
    """Nodes (nodes,) farther from clamp and tip than these, m, or ``AWAY`` of the blade's length.

    Or ``places`` (n, 3), m. Nearer the stress does not converge: at the ends of the clamp with the
    mesh, under the contact with the patches.
    """
    points = solid.V.tabulate_dof_coordinates()
    where = points if places is None else places
    length = np.ptp(np.hypot(points[:, 0], points[:, 1]))
    ends = solid.clamped_coordinates(), points[np.unique(solid.tip)]
    widths = (AWAY * length if width is None else width for width in (from_clamp, from_tip))
    near = [
        cKDTree(end).query(where)[0] <= width
        for end, width in zip(ends, widths, strict=True)
        if len(end)
    ]
    return ~np.any(near, axis=0) if near else np.ones(len(where), bool)


def airfoil(solid: Solid, asked: Asked) -> tuple[NDArray[np.bool_], float]:
    """Nodes (nodes,) whose stress is read, and their least distance from the clamp, m.

    That of ``asked``; without one the ``thickness`` at a sharp clamp, where the stress has no
    limit. With a fillet all but the cells that touch the clamp (distance 0), which is its edge.
    From the tip they are as far as those of ``away``.

    Raises
    ------
    SettingsError
        When there are none.
    """
    sharp = asked.root == "sharp"
    distance = 1e-3 * asked.away_mm if asked.away_mm else thickness(solid) if sharp else 0.0
    settled = away(solid, distance)
    if not sharp and not asked.away_mm:
        settled[solid.V.dofmap.list[cells_of(solid, np.flatnonzero(solid.clamped))]] = False
    require(
        (
            settled.any(),
            "no node of the mesh is farther from the clamp, and away from the contact",
        ),
        kind=SettingsError,
        key="stress.away_mm",
        value=1e3 * distance,
    )
    return settled, distance


def thickness(solid: Solid) -> float:
    """Thickness of the blade at its clamp, m: of the largest circle in the clamped face.

    0 where no face is clamped.
    """
    cells, points = grid_of(solid)
    facets = exterior(cells)
    clamped = solid.clamped[facets]
    root, beside = clamped.all(axis=1), clamped.any(axis=1) & ~clamped.all(axis=1)
    if not root.any() or not beside.any():
        return 0.0
    one, other = np.meshgrid(*2 * [np.linspace(0, 1, ALONG)])
    shapes = shape_functions(np.stack([one, other], axis=-1)[one + other <= 1 + 1e-9])
    inside, near = (shapes @ points[facets[of]] for of in (root, beside))
    rim = near[clamped[beside] @ shapes.T > 1 - 1e-9]  # places between clamped nodes alone
    return 2 * float(cKDTree(rim).query(inside.reshape(-1, 3))[0].max())


def gauge_rows(
    blade: Blade,
    mesh_path: str | Path,
    coordinates: NDArray[np.float64],
    grids: Iterable[tuple[Any, float]],
    statics: Iterable[NDArray[np.float64]],
    T: NDArray[np.float64],
) -> NDArray[np.float64]:
    """What grids read (deflections, 2, grids, 1 + n): strain, and stress, Pa, along each.

    Of each static deflection, then the derivatives about it by the columns of ``T``.

    Parameters
    ----------
    coordinates : (n_full / 3, 3), m, the free nodes in the order of the displacements
    grids : gauge (`name`, `at`, `direction`, `length_mm`) and angle, deg, of each grid
    statics : (n_full,), m
    T : (n_full, n), displacements

    Raises
    ------
    SettingsError
        As ``grid``.
    """
    solid, A = read_solid(str(mesh_path), blade.material), axes(blade.drawn)
    order = dofs_at(coordinates, solid.free_coordinates()).ravel()
    placed = [grid(solid, A, gauge, angle) for gauge, angle in grids]
    weights, along = map(np.array, zip(*placed, strict=True))
    nodes = np.flatnonzero(weights.any(axis=0))
    fields = (linearised(solid, u[order], T.T[:, order], blade.prestress, nodes) for u in statics)
    return np.array(
        [np.einsum("gm,qkmc,gc->qgk", weights[:, nodes], of, along, optimize=True) for of in fields]
    )


def grid(
    solid: Solid, A: NDArray[np.float64], gauge: Any, angle: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Weights of a field at the nodes (nodes,), and of its components (6,) as in ``TENSOR``.

    ``A``: as of ``geometry.frame.axes``; ``angle``: deg from the gauge's direction, anticlockwise
    seen from outside.

    Raises
    ------
    SettingsError
        When the gauge is not on the surface, its direction is not along it, or a part of the grid
        leaves it or is where the stress does not converge.
    """
    cells, points = grid_of(solid)
    facets = exterior(cells)
    surface = pv.PolyData.from_regular_faces(points, facets[:, :3])
    place, direction = A @ gauge.at, A @ gauge.direction
    facet, foot = _closest(surface, place)
    normal = normals(facets[[facet]], points)[0]
    across = np.cross(normal, direction)
    sides = np.cross(across, normal), across * np.sign(np.linalg.det(A))  # A may mirror
    first, second = (vector / (np.linalg.norm(vector) or 1.0) for vector in sides)
    e = np.cos(np.radians(angle)) * first + np.sin(np.radians(angle)) * second
    places = foot + 1e-3 * gauge.length_mm * (middles(PLACES)[:, None] - 0.5) * e
    under, feet = _closest(surface, places)
    off, at = np.linalg.norm(place - foot), f"gauge {gauge.name!r}, at {[*gauge.at]}"
    require(
        (
            off <= FARTHEST,
            f"{at}: {1e3 * off:.3g} mm from the surface; allowed {1e3 * FARTHEST:g} mm",
        ),
        (
            first @ direction > LEAST * np.linalg.norm(direction),
            f"gauge {gauge.name!r}, direction {[*gauge.direction]}: across the surface there; give "
            "one along it",
        ),
        (
            away(solid, places=feet).all(),
            f"{at}: nearer to clamp or tip than {AWAY:.0%} of the blade's length, where the stress "
            "does not converge with mesh and patches; allowed farther",
        ),
        (
            # no place farther from the surface than from its neighbour, none round an edge
            np.linalg.norm(places - feet, axis=1).max() <= 1e-3 * gauge.length_mm / PLACES
            and (normals(facets[under], points) @ normal).min() > 0,
            f"gauge {gauge.name!r}, length_mm {gauge.length_mm:g}: its grid leaves the surface; "
            "allowed shorter or farther from the edge",
        ),
        kind=SettingsError,
        key="record.gauges",
    )
    a, b, c = points[facets[under, :3]].transpose(1, 0, 2)
    edges = np.stack([b - a, c - a], axis=2)
    local = (np.linalg.pinv(edges) @ (feet - a)[..., None])[..., 0]
    weights = (shape_functions(local) / PLACES).ravel()
    return np.bincount(facets[under].ravel(), weights, len(points)), np.outer(e, e)[TENSOR] * TWICE


def _closest(surface: pv.PolyData, points: NDArray[np.float64]) -> tuple[Any, Any]:
    """Facet of the surface closest to each of the ``points`` (..., 3), m, and the place on it."""
    return surface.find_closest_cell(points, return_closest_point=True)  # pyright: ignore[reportReturnType]


def dofs_at(coordinates: NDArray, points: NDArray) -> NDArray[np.int64]:
    """DoFs (points, 3) of the nodes of ``coordinates`` (nodes, 3), m, at ``points`` (points, 3)."""
    distance, node = cKDTree(coordinates).query(points)
    require(
        (
            distance.max() <= 1e-9,
            f"nodes and mesh differ by {distance.max():.1e} m: rebuild what is older",
        ),
        kind=ValueError,
    )
    return 3 * node[:, None].astype(np.int64) + np.arange(3)
