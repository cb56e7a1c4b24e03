"""Prestressed states: static deflection and K(Omega), Eqs. (a)-(d) of the package."""

from collections.abc import Iterable, Iterator

from fem.petsc import PETSc

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

import ufl
from dolfinx import fem
from dolfinx.fem.petsc import NonlinearProblem

from fem.cholesky import Cholesky
from fem.forms import compiled
from fem.matrices import Prestressed
from fem.solid import Solid, SymmetricForm, green_lagrange, small_strain
from geometry.base import RPM, UserError, require

DIRECT = {"ksp_type": "preonly", "pc_type": "cholesky", "pc_factor_mat_solver_type": "mumps"}
NEWTON = {"snes_type": "newtonls", "snes_linesearch_type": "none", "snes_max_it": 25}
RESIDUAL_TOLERANCE = 1e-9  # equilibrium residual over the centrifugal load
MODIFIED_TOLERANCE = RESIDUAL_TOLERANCE / 100  # of modified Newton, which converges linearly
FACTORS = 8  # most of them for an equilibrium
GAIN = 0.3  # of the residual in a step with an old factor, beyond which a new one takes less time
SMALLEST_STEP = 0.05  # least step of the speed, over the target speed, where Newton fails


class EquilibriumError(UserError):
    """Newton found no stable static equilibrium; the message says at which speed and why."""


def nonlinear_states(
    solid: Solid, speeds: Iterable[float], cholesky: Cholesky | None = None
) -> Iterator[Prestressed]:
    """States of prestress `nonlinear` at ascending ``speeds`` (rad/s).

    ``cholesky``, if given, holds the factor of each state's K. The next equilibrium is then sought
    by modified Newton with this factor, and by Newton only where that does not converge.

    Raises
    ------
    EquilibriumError
        When Newton does not converge, or converges to an equilibrium that is not stable.
    """
    return map(_Equilibria(solid, cholesky).state, speeds)


class _Equilibria:
    """Equilibria at ascending speeds, each extrapolated from the last ones as the initial guess."""

    def __init__(self, solid: Solid, cholesky: Cholesky | None) -> None:
        v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
        self.u, self.Omega = fem.Function(solid.V), fem.Constant(solid.mesh, 0.0)
        residual, tangent = equilibrium_forms(solid, self.Omega, self.u, v, du)
        self._free, self._cholesky = solid.free, cholesky
        self._residual, self._tangent = compiled(residual), SymmetricForm(tangent, solid.free)
        self._problem = NonlinearProblem(
            self._residual,
            self.u,
            J=self._tangent.form,
            bcs=[solid.clamp],
            petsc_options_prefix="equilibrium_",
            petsc_options=DIRECT | NEWTON,
        )
        # per Omega^2, on the undeformed blade
        x = ufl.SpatialCoordinate(solid.mesh)
        load = fem.assemble_vector(compiled(solid.spin_load(x, v)))
        self._load = float(np.linalg.norm(load.array[solid.free]))
        self._equilibria: list[tuple[float, NDArray]] = []  # Omega, deflection

    def state(self, speed: float) -> Prestressed:
        """State at ``speed`` (rad/s), its K factorised if there is a Cholesky."""
        last = self._last
        residual = self.reach(speed) if speed > 0 else 0.0
        K = self._tangent.matrix()
        if self._cholesky:
            _require_stable(self._cholesky.of(K).negative, speed, last)
        return Prestressed(speed, ((1.0, K),), self.u.x.array[self._free].copy(), residual)

    @property
    def _last(self) -> float:
        """Speed of the last equilibrium, rad/s."""
        return self._equilibria[-1][0] if self._equilibria else 0.0

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
            last = self._last
            self.Omega.value[...] = target
            self.u.x.array[:] = _start(self._equilibria[-3:], target)
            try:
                residual = self._find(target, last, modified=target == speed)
            except EquilibriumError:
                if target - last <= SMALLEST_STEP * speed:
                    raise
                target = (last + target) / 2
                continue
            self._equilibria.append((target, self.u.x.array.copy()))
            if target == speed:
                return residual
            target = speed

    def _find(self, speed: float, last: float, modified: bool) -> float:
        """Find the equilibrium at ``speed`` from u; returns its residual over the load.

        ``modified``: first by modified Newton.
        """
        load, start = speed**2 * self._load, self.u.x.array.copy()
        if modified and self._cholesky and self._cholesky.made:
            residual = self._modified_newton(self._cholesky, load)
            if residual <= RESIDUAL_TOLERANCE and self._cholesky.negative == 0:
                return residual
            self.u.x.array[:] = start
        return _solve(self._problem, speed, load, last)

    def _modified_newton(self, cholesky: Cholesky, load: float) -> float:
        """Iterate with the factor of the last state's K; where that gains little, with a new one.

        Returns the residual over the load.
        """
        u, r, factors = self.u.x.array, self._residual_of_u(), 0
        reached, old = np.linalg.norm(r) / load, True
        while reached > MODIFIED_TOLERANCE and factors <= FACTORS:
            before, last = reached, (u.copy(), r)
            u[self._free] -= cholesky.solve(r[:, None])[:, 0]
            r = self._residual_of_u()
            reached = np.linalg.norm(r) / load
            if not reached < before and old:  # a new factor's first steps may rise
                (u[:], r), reached = last, before
            old = reached < GAIN * before
            if not old:
                cholesky.of(self._tangent.matrix())
                factors += 1
        return float(reached)

    def _residual_of_u(self) -> NDArray[np.float64]:
        return fem.assemble_vector(self._residual).array[self._free]


def _start(equilibria: list[tuple[float, NDArray]], Omega: float) -> NDArray | float:
    """Initial guess of the static deflection at Omega: u/Omega^2 extrapolated in Omega^2."""
    squares = np.array([speed**2 for speed, _ in equilibria])
    u = 0.0
    for j, (speed, u_speed) in enumerate(equilibria):
        others = np.delete(squares, j)
        weight = np.prod((Omega**2 - others) / (speed**2 - others))
        u = u + (Omega / speed) ** 2 * weight * u_speed
    return u


def linear_states(
    solid: Solid, speeds: Iterable[float], cholesky: Cholesky | None = None
) -> Iterator[Prestressed]:
    """States of prestress `linear`, Eq. (d): K is linear in Omega^2 by construction.

    ``cholesky``, if given, holds the factor of each state's K. All K have one sparsity pattern.
    """
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    x, cholesky = ufl.SpatialCoordinate(solid.mesh), cholesky or Cholesky()
    elastic = ufl.inner(solid.stress(small_strain(du)), small_strain(v)) * solid.dx
    at_rest = SymmetricForm(elastic, solid.free)
    K0 = at_rest.matrix()
    load = fem.assemble_vector(compiled(solid.spin_load(x, v))).array[solid.free]
    u1 = cholesky.of(K0).solve(load[:, None])[:, 0]
    sigma = solid.stress(small_strain(solid.field(u1)))
    geometric = ufl.inner(sigma, ufl.grad(du).T * ufl.grad(v)) * solid.dx
    K1 = SymmetricForm(geometric - solid.spin_load(du, v), solid.free, at_rest).matrix()
    return spun(K0, K1, u1, speeds)


def spun(
    K0: csr_matrix, K1: csr_matrix, u1: NDArray[np.float64], speeds: Iterable[float]
) -> Iterator[Prestressed]:
    """States K0 + Omega^2 K1 with the static deflection Omega^2 u1 at ``speeds`` (rad/s)."""
    for speed in speeds:
        yield Prestressed(speed, ((1.0, K0), (speed**2, K1)), speed**2 * u1, 0.0)


def mass(solid: Solid) -> csr_matrix:
    """M, kg, free DoFs; without the zeros that couple directions."""
    v, du = ufl.TestFunction(solid.V), ufl.TrialFunction(solid.V)
    M = solid.matrix(solid.material.density_kg_m3 * ufl.inner(du, v) * solid.dx)
    M.eliminate_zeros()
    return M


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
    require(
        (
            not failure and reached <= RESIDUAL_TOLERANCE,
            f"no static equilibrium at {RPM * speed:.6g} rpm (the last at {RPM * last:.6g} rpm): "
            f"after {snes.getIterationNumber()} Newton steps the residual is {reached:.1e} of the "
            f"centrifugal load (wanted {RESIDUAL_TOLERANCE:.0e}; {failure}); lower the highest "
            f"speed or use prestress: linear",
        ),
        kind=EquilibriumError,
    )
    # of the last tangent factorised
    _require_stable(snes.getKSP().getPC().getFactorMatrix().getMumpsInfog(12), speed, last)
    return reached


def _require_stable(negative: int, speed: float, last: float) -> None:
    """Refuse a tangent with negative pivots: directions in which the energy decreases."""
    require(
        (
            negative <= 0,
            f"the static equilibrium found at {RPM * speed:.6g} rpm is not stable ({negative} "
            f"negative eigenvalues of K; the last stable one is at {RPM * last:.6g} rpm); lower "
            "the highest speed",
        ),
        kind=EquilibriumError,
    )
