"""Eigenmodes and static solutions of sparse symmetric matrices, by ARPACK and MUMPS."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from fem.cholesky import Cholesky
from geometry.project import UserError

EIGEN_TOLERANCE = 1e-10  # asked of ARPACK, relative to the eigenvalue
RESIDUAL_TOLERANCE = (
    1e-6  # of ||K phi - omega^2 M phi|| / ||K phi||: round-off of K^-1 comes on top
)


class ModesError(UserError):
    """Modes did not converge, or their residuals are too large; the message names the value."""


@dataclass(frozen=True)
class Modes:
    """Modes of K phi = omega^2 M phi, M-normalised, ascending."""

    omega: NDArray[np.float64]  # (modes,), rad/s
    Phi: NDArray[np.float64]  # (n, modes)
    residuals: NDArray[np.float64]  # (modes,), ||K phi - omega^2 M phi|| / ||K phi||


class ShiftInvert:
    """K factorised once (MUMPS Cholesky): lowest modes about a zero shift, static solutions.

    Parameters
    ----------
    K, M : (n, n) csr_matrix, N/m and kg
        Symmetric positive definite.
    cholesky : factorises K, unless it holds its factor already
    """

    def __init__(self, K: csr_matrix, M: csr_matrix, cholesky: Cholesky | None = None) -> None:
        self.K, self.M = K, M
        self._cholesky = cholesky or Cholesky()

    def modes(self, count: int) -> Modes:
        """Lowest ``count`` modes, each checked by its residual.

        Raises
        ------
        ModesError
            When K is not positive definite, there are no more modes than asked for, they do not
            converge, or a residual exceeds ``RESIDUAL_TOLERANCE``.
        """
        return self._checked(*self._lowest(count, self.solve))

    def solve(self, B: NDArray[np.float64]) -> NDArray[np.float64]:
        """K^-1 B for a dense block B (n, columns), with the same factor.

        Raises
        ------
        ModesError
            When K is not positive definite.
        """
        factor = self._cholesky.of(self.K)
        if factor.negative > 0:
            raise ModesError(
                f"K is not positive definite ({factor.negative} negative eigenvalues): the blade "
                f"is not stable at this speed; lower max_speed_rad_s"
            )
        return factor.solve(B)

    def fixed_modes(
        self,
        A: NDArray[np.float64],
        Phi_R: NDArray[np.float64],
        S: csr_matrix,
        count: int,
    ) -> Modes:
        """Lowest ``count`` modes with S phi = 0: those of (K^-1 - A C^-1 A^T) M, checked.

        The reactions S^T mu of the fixed interface, mu = Phi_R^T r, are subtracted from the
        residual r. Raises the errors of ``modes``.

        Parameters
        ----------
        A, Phi_R : (n, n_c), K^-1 S^T and A C^-1
        """
        values, Phi = self._lowest(count, lambda B: self.solve(B) - Phi_R @ (A.T @ B))
        return self._checked(values, Phi - Phi_R @ (S @ Phi), lambda r: r - S.T @ (Phi_R.T @ r))

    def _lowest(
        self, count: int, inverse: Callable[[NDArray], NDArray]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Eigenvalues (count,), ascending, and vectors (n, count) of K, M by ``inverse``."""
        n = self.K.shape[0]
        if count >= n:
            raise ModesError(
                f"{n} DoFs allow up to {n - 1} modes, not {count}; ask for fewer modes"
            )
        operator = LinearOperator((n, n), lambda b: inverse(b.reshape(-1, 1))[:, 0])
        start = operator @ np.random.default_rng(0).normal(size=n)  # along no symmetry
        try:
            values, Phi = eigsh(
                self.K, count, self.M, sigma=0, OPinv=operator, v0=start, tol=EIGEN_TOLERANCE
            )
        except ArpackNoConvergence as error:
            found = len(error.eigenvalues)
            raise ModesError(
                f"ARPACK found {found} of {count} modes; ask for fewer modes"
            ) from None
        order = values.argsort()
        return values[order], Phi[:, order]

    def _checked(
        self,
        values: NDArray[np.float64],
        Phi: NDArray[np.float64],
        without_reactions: Callable[[NDArray], NDArray] = lambda r: r,
    ) -> Modes:
        """Modes of the eigenvalues and vectors, if their residuals are small."""
        Phi = Phi / np.sqrt(np.einsum("nm,nm->m", Phi, self.M @ Phi))
        K_Phi = self.K @ Phi
        residuals = np.linalg.norm(without_reactions(K_Phi - self.M @ Phi * values), axis=0)
        residuals /= np.linalg.norm(K_Phi, axis=0)
        if not residuals.max() <= RESIDUAL_TOLERANCE:
            raise ModesError(
                f"mode {residuals.argmax() + 1} leaves a residual of {residuals.max():.1e}, "
                f"above {RESIDUAL_TOLERANCE:.0e}"
            )
        return Modes(np.sqrt(values), Phi, residuals)
