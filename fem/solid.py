"""The clamped blade as a DOLFINx problem: space, forms, sparse matrices on the free DoFs."""

from dataclasses import dataclass

from fem.petsc import MPI, PETSc

import gmsh
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import bsr_matrix, csr_matrix

import ufl
from dolfinx import fem
from dolfinx.io.gmsh import model_to_mesh
from dolfinx.mesh import Mesh

from fem.forms import compiled
from geometry.base import known
from geometry.blade import Material
from geometry.jacobians import DEGREE
from geometry.shape import merge, session

BASIX_TO_VTK = np.array([0, 1, 2, 5, 3, 4])  # basix: the middles opposite the corners 0, 1, 2
QUADRATURE = {"quadrature_degree": DEGREE}


@dataclass(frozen=True)
class Solid:
    """P2 displacement on the blade mesh, clamped on ``root``."""

    mesh: Mesh
    material: Material
    V: fem.FunctionSpace
    clamp: fem.DirichletBC
    free: NDArray[np.int32]  # free DoFs, unrolled, ascending
    tip: NDArray[np.int32]  # (k, 6), nodes of the facets of the tip, in VTK's order

    @property
    def dx(self) -> ufl.Measure:
        """Volume measure."""
        return ufl.Measure("dx", self.mesh, metadata=QUADRATURE)

    def lame(self) -> tuple[float, float]:
        """Lame parameters lambda, mu, Pa."""
        E, nu = self.material.young_modulus, self.material.poisson_ratio
        return E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def stress(self, E: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
        """S(E), Eq. (b), Pa; also C : eps for a small strain."""
        lambda_, mu = self.lame()
        return lambda_ * ufl.tr(E) * ufl.Identity(3) + 2 * mu * E

    def spin_load(self, x: ufl.core.expr.Expr, v: ufl.Argument) -> ufl.Form:
        """Virtual work of the centrifugal force at positions ``x``, per Omega^2: kg m2."""
        P = ufl.as_matrix([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 0]])
        return self.material.density_kg_m3 * ufl.inner(P * x, v) * self.dx

    def matrix(self, form: ufl.Form) -> csr_matrix:
        """Assemble a symmetric bilinear form, free rows and columns only."""
        return SymmetricForm(form, self.free).matrix()

    def field(self, u: NDArray[np.float64]) -> fem.Function:
        """The field of displacements ``u`` of the free DoFs, m; zero where clamped."""
        field = fem.Function(self.V)
        field.x.array[self.free] = u
        return field

    @property
    def clamped(self) -> NDArray[np.bool_]:
        """Whether a node is clamped (nodes,)."""
        clamped = np.ones(len(self.V.tabulate_dof_coordinates()), bool)
        clamped[self.free[::3] // 3] = False
        return clamped

    def free_coordinates(self) -> NDArray[np.float64]:
        """Free nodes (n_full / 3, 3), m."""
        return self.V.tabulate_dof_coordinates()[self.free[::3] // 3]

    def clamped_coordinates(self) -> NDArray[np.float64]:
        """Clamped nodes (n, 3), m."""
        return self.V.tabulate_dof_coordinates()[self.clamped]


class SymmetricForm:
    """A symmetric bilinear form, to be assembled for several values of its coefficients.

    ``like``: another form on the same space: the matrices of both then share one set of indices.
    """

    def __init__(
        self, form: ufl.Form, free: NDArray[np.int32], like: "SymmetricForm | None" = None
    ) -> None:
        self.form = compiled(form)
        self._assembled = fem.create_matrix(self.form)  # pyright: ignore[reportArgumentType]  one form
        if like:
            self._upper, self._lower = like._upper, like._lower
            return
        assembled = self._assembled.to_scipy()
        places = bsr_matrix(
            (
                np.arange(assembled.data.size, dtype=np.int32).reshape(assembled.data.shape),
                assembled.indices,
                assembled.indptr,
            ),
            assembled.shape,
        )
        # of the entries of the matrix and its transpose, free rows and columns
        self._upper = places.tocsr()[free][:, free]
        self._upper.sort_indices()
        self._lower = self._upper.T.tocsr()

    def matrix(self) -> csr_matrix:
        """Assemble the form, free rows and columns only; symmetric to the last bit."""
        self._assembled.data[:] = 0.0
        fem.assemble_matrix(self._assembled, self.form)
        values = self._assembled.data
        data = (values[self._upper.data] + values[self._lower.data]) / 2
        return csr_matrix((data, self._upper.indices, self._upper.indptr), self._upper.shape)


def small_strain(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
    """Linear strain sym(grad u)."""
    return ufl.sym(ufl.grad(u))


def green_lagrange(u: ufl.core.expr.Expr) -> ufl.core.expr.Expr:
    """E of Eq. (b), without the cancellation in F^T F - I, which matters at low speed."""
    H = ufl.grad(u)
    return ufl.sym(H) + H.T * H / 2


def read_solid(mesh_path: str, material: Material) -> Solid:
    """Read ``blade.msh``; the facets of its group ``root`` are clamped, those of ``tip`` kept.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        When the file is no mesh, or not as it was written.
    """
    with session("make the mesh anew"):
        merge(mesh_path)
        data = model_to_mesh(gmsh.model, MPI.COMM_SELF, 0, gdim=3)
    V = fem.functionspace(data.mesh, ("Lagrange", 2, (3,)))
    data.mesh.topology.create_connectivity(2, 3)
    root, tip = (
        known(data.facet_tags, group).find(data.physical_groups[group].tag)
        for group in ("root", "tip")
    )
    clamped = fem.locate_dofs_topological(V, 2, root)
    return make_solid(data.mesh, material, V, clamped, _facet_nodes(V, tip))


def make_solid(
    mesh: Mesh,
    material: Material,
    V: fem.FunctionSpace,
    clamped_nodes: NDArray[np.int32],
    tip: NDArray[np.int32] | None = None,
) -> Solid:
    """A solid clamped at ``clamped_nodes`` (numbers of the P2 space), with its tip's facets."""
    clamp = fem.dirichletbc(np.zeros(3, dtype=PETSc.ScalarType), clamped_nodes, V)
    nodes = np.setdiff1d(np.arange(V.dofmap.index_map.size_local), clamped_nodes)
    free = (3 * nodes[:, None] + np.arange(3)).ravel().astype(np.int32)
    tip = np.empty((0, 6), dtype=np.int32) if tip is None else tip
    return Solid(mesh, material, V, clamp, free, tip)


def _facet_nodes(V: fem.FunctionSpace, facets: NDArray[np.int32]) -> NDArray[np.int32]:
    """Nodes (k, 6) of the P2 space on boundary ``facets``, VTK's order."""
    topology = V.mesh.topology
    topology.create_connectivity(3, 2)
    cell_of, facets_of = topology.connectivity(2, 3), topology.connectivity(3, 2)
    nodes = np.empty((len(facets), 6), dtype=np.int32)
    for k, facet in enumerate(facets):
        cell = cell_of.links(facet)[0]
        local = int(np.flatnonzero(facets_of.links(cell) == facet)[0])
        closure = V.dofmap.dof_layout.entity_closure_dofs(2, local)
        nodes[k] = V.dofmap.cell_dofs(cell)[np.sort(closure)]
    return nodes[:, BASIX_TO_VTK]
