"""Prestressed states: static deflection and K(Omega), Eqs. (a)-(d) of the package."""

from collections.abc import Iterator
from dataclasses import dataclass

import dolfinx_solver  # noqa: F401  orders MPI ahead of the compiled bindings

from petsc4py import PETSc

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

import ufl
from dolfinx import fem
from dolfinx.fem.petsc import LinearProblem, NonlinearProblem

from fem.solid import Solid, green_lagrange, small_strain
from geometry.errors import UserError

DIRECT = {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "mumps"}
NEWTON = {"snes_type": "newtonls", "snes_linesearch_type": "none", "snes_max_it": 25}
RESIDUAL_TOLERANCE = 1e-9  # equilibrium residual over the centrifugal load
SMALLEST_STEP = 0.05  # least step of the speed, over the target speed, where Newton fails


class EquilibriumError(UserError):
    """Newton found no stable static equilibrium; the message says at which speed and why."""


@dataclass(frozen=True)
class State:
    """Prestressed state at one speed, free DoFs."""

    speed: float  # rad/s
    K: csr_matrix  # N/m
    u_static: NDArray[np.float64]  # m
    residual: float  # equilibrium residual over the centrifugal load


def nonlinear_states(solid: Solid, speeds: NDArray[np.float64]) -> Iterator[State]:
    """States of prestress `nonlinear` at ascending ``speeds`` (rad/s).

    Raises
    ------
    EquilibriumError
        When Newton does not converge, or converges to an equilibrium that is not stable.
    """
    path = _Equilibria(solid)
    for speed in speeds:
        residual = path.reach(speed) if speed > 0 else 0.0
        yield State(speed, solid.matrix(path.tangent), path.u.x.array[solid.free].copy(), residual)


class _Equilibria:
    """Equilibria at ascending speeds, each extrapolated from the last ones as the initial guess."""

    def __init__(self, solid: Solid) -> None:
        v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
        self.u, self.Omega = fem.Function(solid.V), fem.Constant(solid.mesh, 0.0)
        residual, self.tangent = equilibrium_forms(solid, self.Omega, self.u, v, du)
        self._problem = NonlinearProblem(
            residual,
            self.u,
            J=self.tangent,
            bcs=[solid.clamp],
            petsc_options_prefix="equilibrium_",
            petsc_options=DIRECT | NEWTON,
        )
        # per Omega^2, on the undeformed blade
        load = fem.assemble_vector(fem.form(solid.spin_load(ufl.SpatialCoordinate(solid.mesh), v)))
        self._load = float(np.linalg.norm(load.array[solid.free]))
        self._equilibria: list[tuple[float, NDArray]] = []  # Omega, deflection

    def reach(self, speed: float) -> float:
        """Find the equilibrium at ``speed`` (rad/s); where Newton fails, by intermediate speeds.

        Returns its residual over the load.

        Raises
        ------
        EquilibriumError
            When Newton fails even for a step of ``SMALLEST_STEP`` from the last equilibrium.
        """
        target = speed
        while True:
            last = self._equilibria[-1][0] if self._equilibria else 0.0
            self.Omega.value = target
            self.u.x.array[:] = _start(self._equilibria[-3:], target)
            try:
                residual = _solve(self._problem, target, target**2 * self._load, last)
            except EquilibriumError:
                if target - last <= SMALLEST_STEP * speed:
                    raise
                target = (last + target) / 2
                continue
            self._equilibria.append((target, self.u.x.array.copy()))
            if target == speed:
                return residual
            target = speed


def _start(equilibria: list[tuple[float, NDArray]], Omega: float) -> NDArray | float:
    """Initial guess of the static deflection at Omega: u/Omega^2 extrapolated in Omega^2."""
    squares = np.array([speed**2 for speed, _ in equilibria])
    u = 0.0
    for j, (speed, u_speed) in enumerate(equilibria):
        others = np.delete(squares, j)
        weight = np.prod((Omega**2 - others) / (speed**2 - others))
        u = u + (Omega / speed) ** 2 * weight * u_speed
    return u


def linear_states(solid: Solid, speeds: NDArray[np.float64]) -> Iterator[State]:
    """States of prestress `linear`, Eq. (d): K is linear in Omega^2 by construction."""
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    x = ufl.SpatialCoordinate(solid.mesh)
    elastic = ufl.inner(solid.stress(small_strain(du)), small_strain(v)) * solid.dx
    u1 = LinearProblem(
        elastic,
        solid.spin_load(x, v),
        bcs=[solid.clamp],
        petsc_options_prefix="static_",
        petsc_options=DIRECT,
    ).solve()
    sigma = solid.stress(small_strain(u1))
    geometric = ufl.inner(sigma, ufl.grad(du).T * ufl.grad(v)) * solid.dx
    K0, K1 = solid.matrix(elastic), solid.matrix(geometric - solid.spin_load(du, v))
    u1_free = u1.x.array[solid.free]
    for speed in speeds:
        yield State(speed, K0 + speed**2 * K1, speed**2 * u1_free, 0.0)


def mass(solid: Solid) -> csr_matrix:
    """M, kg, free DoFs."""
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    return solid.matrix(solid.material.density_kg_m3 * ufl.inner(du, v) * solid.dx)


def equilibrium_forms(
    solid: Solid, Omega: fem.Constant, u: fem.Function, v: ufl.Argument, du: ufl.Argument
) -> tuple[ufl.Form, ufl.Form]:
    """Forms of the residual, Eq. (a), and of its tangent, Eq. (c)."""
    dE = ufl.sym((ufl.Identity(3) + ufl.grad(u)).T * ufl.grad(v))
    x = ufl.SpatialCoordinate(solid.mesh) + u
    residual = ufl.inner(
        solid.stress(green_lagrange(u)), dE
    ) * solid.dx - Omega**2 * solid.spin_load(x, v)
    return residual, ufl.derivative(residual, u, du)


def _solve(problem: NonlinearProblem, speed: float, load: float, last: float) -> float:
    """Newton iteration to ``RESIDUAL_TOLERANCE``; returns the residual over the load.

    ``last``: speed (rad/s) of the last equilibrium, for the message.
    """
    snes = problem.solver
    snes.setTolerances(rtol=0.0, atol=RESIDUAL_TOLERANCE * load, stol=0.0)
    try:
        problem.solve()
        failure = "" if snes.getConvergedReason() > 0 else f"reason {snes.getConvergedReason()}"
    except PETSc.Error as error:
        failure = str(error).splitlines()[-1]
    reached = snes.getFunctionNorm() / load
    if failure or not reached <= RESIDUAL_TOLERANCE:
        raise EquilibriumError(
            f"no static equilibrium at {speed:.6g} rad/s (the last at {last:.6g} rad/s): after "
            f"{snes.getIterationNumber()} Newton steps the residual is {reached:.1e} of the "
            f"centrifugal load (wanted {RESIDUAL_TOLERANCE:.0e}; {failure}); lower max_speed_rad_s "
            f"or use prestress: linear"
        )
    # of the last tangent factorised: a negative pivot is a direction in which the energy decreases
    negative = snes.getKSP().getPC().getFactorMatrix().getMumpsInfog(12)
    if negative > 0:
        raise EquilibriumError(
            f"the static equilibrium found at {speed:.6g} rad/s is not stable ({negative} negative "
            f"eigenvalues of K; the last stable one is at {last:.6g} rad/s); lower max_speed_rad_s"
        )
    return reached
