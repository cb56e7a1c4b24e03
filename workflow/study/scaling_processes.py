"""The finite-element stage on a mesh that several processes share: mpiexec -n N python -m ...

Each process has its part of the mesh and of the rows of M and K; MUMPS and SLEPc work on all of
them. The first process writes K with its rows in the order of the nodes' positions, so that it can
be compared for any number of processes, and tells the CPU time of each part in the process that
takes longest. A process that waits for another one is busy.
"""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from time import process_time
from types import SimpleNamespace
from typing import Any

import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

from mpi4py import MPI
from petsc4py import PETSc
from slepc4py import SLEPc

import h5py  # noqa: F401  loads its HDF5 before PETSc's of another version
import numpy as np
from scipy.sparse import csr_matrix, save_npz, vstack

import ufl
from dolfinx import fem, la
from dolfinx.fem.petsc import NonlinearProblem, assemble_matrix
from dolfinx.io.gmsh import read_from_msh

from fem.prestress import DIRECT, NEWTON, RESIDUAL_TOLERANCE, equilibrium_forms
from fem.solid import Solid
from geometry.blade import Blade
from geometry.settings import read_settings
from rom.full_model import MODES, SPARE
from rom.modes import EIGEN_TOLERANCE

COMM = MPI.COMM_WORLD
DIGITS = 9  # of a position, m, by which rows are ordered


def main(blade: str, mesh: str, matrix: str) -> None:
    """Equilibrium at the highest speed, K there, its modes; K is written to ``matrix``."""
    seconds: dict[str, float] = {}
    settings = read_settings(Blade, blade)
    solid = _solid(settings, mesh)
    forms = _forms(solid, settings.max_speed_rad_s)
    with timed(seconds, "assembly of M and K"):
        K = assemble_matrix(forms.tangent, bcs=[solid.clamp])
        M = assemble_matrix(forms.mass, bcs=[solid.clamp], diag=0.0)  # clamped: omega is infinite
        for A in (M, K):
            A.assemble()
    with timed(seconds, "equilibrium"):
        _solve(solid, forms)
    K.zeroEntries()
    assemble_matrix(K, forms.tangent, bcs=[solid.clamp])
    K.assemble()
    eps = _modes_of(K, M)
    with timed(seconds, "factor of K"):
        eps.setUp()
    with timed(seconds, "modes"):
        eps.solve()
    lowest = float(np.sqrt(eps.getEigenvalue(0).real))
    _save(K, solid, matrix)
    if COMM.rank == 0:
        nodes = solid.V.dofmap.index_map.size_global
        print(json.dumps({"nodes": nodes, "lowest_rad_s": lowest, "parts": seconds}))


@contextmanager
def timed(seconds: dict[str, float], part: str) -> Iterator[None]:
    """Add the CPU time of a block, in the process that takes longest."""
    COMM.Barrier()
    begun = process_time()
    yield
    seconds[part] = COMM.allreduce(process_time() - begun, MPI.MAX)


def _solid(settings: Blade, path: str) -> Solid:
    """The clamped blade on all processes."""
    data = read_from_msh(path, COMM, 0, gdim=3)
    V = fem.functionspace(data.mesh, ("Lagrange", 2, (3,)))
    data.mesh.topology.create_connectivity(2, 3)
    root = data.facet_tags.find(data.physical_groups["root"].tag)
    nodes = fem.locate_dofs_topological(V, 2, root)
    clamp = fem.dirichletbc(np.zeros(3, dtype=PETSc.ScalarType), nodes, V)
    return Solid(data.mesh, settings.material, V, clamp, free=nodes, tip=nodes)  # not used here


def _forms(solid: Solid, Omega: float) -> Any:
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    u, speed = fem.Function(solid.V), fem.Constant(solid.mesh, Omega)
    residual, tangent = equilibrium_forms(solid, speed, u, v, du)
    mass = solid.material.density_kg_m3 * ufl.inner(du, v) * solid.dx
    load = Omega**2 * solid.spin_load(ufl.SpatialCoordinate(solid.mesh), v)
    return SimpleNamespace(
        u=u, residual=residual, J=tangent, tangent=fem.form(tangent), mass=fem.form(mass), load=load
    )


def _solve(solid: Solid, forms: Any) -> None:
    """Find the equilibrium by Newton from rest; K is needed to 1e-12, which takes one step more."""
    load = fem.assemble_vector(fem.form(forms.load))
    load.scatter_reverse(la.InsertMode.add)
    own = load.array[: 3 * solid.V.dofmap.index_map.size_local]
    norm = np.sqrt(COMM.allreduce(float(own @ own)))
    problem = NonlinearProblem(
        forms.residual,
        forms.u,
        J=forms.J,
        bcs=[solid.clamp],
        petsc_options_prefix="shared_",
        petsc_options=DIRECT | NEWTON,
    )
    tolerance = RESIDUAL_TOLERANCE / 100 * norm
    problem.solver.setTolerances(rtol=0.0, atol=tolerance, stol=0.0)
    problem.solve()


def _modes_of(K: PETSc.Mat, M: PETSc.Mat) -> SLEPc.EPS:
    eps = SLEPc.EPS().create(COMM)
    eps.setOperators(K, M)
    eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    eps.setTarget(0.0)
    eps.getST().setType(SLEPc.ST.Type.SINVERT)
    ksp = eps.getST().getKSP()
    ksp.setType(PETSc.KSP.Type.PREONLY)
    ksp.getPC().setType(PETSc.PC.Type.CHOLESKY)
    ksp.getPC().setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
    eps.setDimensions(MODES + SPARE)
    eps.setTolerances(EIGEN_TOLERANCE, 500)
    return eps


def _save(K: PETSc.Mat, solid: Solid, path: str) -> None:
    """Write K, rows and columns by the positions of their nodes."""
    nodes = solid.V.dofmap.index_map
    size = 3 * nodes.size_global
    starts, columns, values = K.getValuesCSR()
    rows = csr_matrix((values, columns, starts), shape=(len(starts) - 1, size))
    own = solid.V.tabulate_dof_coordinates()[: nodes.size_local]
    parts = COMM.gather((rows, own), root=0)
    if COMM.rank == 0:
        order = np.lexsort(np.round(np.vstack([own for _, own in parts]), DIGITS).T)
        places = (3 * order[:, None] + np.arange(3)).ravel()
        save_npz(path, vstack([rows for rows, _ in parts]).tocsr()[places][:, places])


if __name__ == "__main__":
    main(*sys.argv[1:])
