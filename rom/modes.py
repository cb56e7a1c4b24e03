"""Eigenmodes and static solutions of sparse symmetric matrices, by MUMPS, SLEPc and block Lanczos.

A column of a block of eight takes a fifth of the time of one that is solved alone.
"""

from collections.abc import Callable
from dataclasses import dataclass

from fem.petsc import PETSc, SLEPc

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import LinearOperator, eigsh

from fem.cholesky import Cholesky, petsc_matrix
from geometry.base import UserError
from rom.basis import project

EIGEN_TOLERANCE = 1e-10  # asked of SLEPc, relative to the eigenvalue
RESIDUAL_TOLERANCE = (
    1e-6  # of ||K phi - omega^2 M phi|| / ||K phi||: round-off of K^-1 comes on top
)
BLOCK = 8  # columns solved together: with 16 and 24 block Lanczos takes a tenth and a fifth longer
CONVERGED = 1e-7  # of K^-1 M phi - phi / omega^2, over phi / omega^2
VANISHED = 1e-8  # of the length of a vector: what is left of it is mostly round-off


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

    def in_blocks(self, count: int) -> Modes:
        """The modes of ``modes``, by block Lanczos, and a step of inverse iteration.

        That step takes what is left of high modes away. Raises the errors of ``modes``.
        """
        inverse, n = self.solve, self.K.shape[0]
        start = np.random.default_rng(0).normal(size=(n, min(BLOCK, n)))
        Phi = inverse(self.M @ block_lanczos(inverse, self.M, inverse(self.M @ start), count))
        if Phi.shape[1] < count:
            raise ModesError(f"there are {Phi.shape[1]} of {count} modes; ask for fewer modes")
        values, V = eigh(project(self.K, Phi), project(self.M, Phi))
        return self._checked(list(zip(values, (Phi @ V).T, strict=True)))

    def modes(self, count: int) -> Modes:
        """Lowest ``count`` modes by SLEPc's Krylov-Schur, each checked by its residual.

        Raises
        ------
        ModesError
            When K is not positive definite, fewer are found, or a residual exceeds
            ``RESIDUAL_TOLERANCE``.
        """
        eps = SLEPc.EPS().create(PETSc.COMM_SELF)
        eps.setOperators(self._factor().matrix, petsc_matrix(self.M, self.M.data))
        eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        eps.setTarget(0.0)
        eps.getST().setType(SLEPc.ST.Type.SINVERT)
        ksp = eps.getST().getKSP()
        ksp.setType(PETSc.KSP.Type.PREONLY)
        ksp.getPC().setType(PETSc.PC.Type.PYTHON)
        ksp.getPC().setPythonContext(self._cholesky)
        eps.setDimensions(count, PETSc.DECIDE, PETSc.DECIDE)
        eps.setTolerances(EIGEN_TOLERANCE, 500)
        # two steps of the power method leave little but low modes: a start that saves a restart
        random = np.random.default_rng(0).normal(size=(self.K.shape[0], 1))
        start = self.solve(self.M @ self.solve(random))[:, 0]
        eps.setInitialSpace(PETSc.Vec().createWithArray(start, comm=PETSc.COMM_SELF))
        eps.solve()
        converged = eps.getConverged()
        if converged < count:
            raise ModesError(f"SLEPc found {converged} of {count} modes; ask for fewer modes")
        x = PETSc.Vec().createSeq(self.K.shape[0], comm=PETSc.COMM_SELF)
        pairs = [(eps.getEigenpair(i, x).real, x.array.copy()) for i in range(count)]
        return self._checked(pairs)

    def solve(self, B: NDArray[np.float64]) -> NDArray[np.float64]:
        """K^-1 B for a dense block B (n, columns), with the same factor."""
        return self._factor().solve(B)

    def fixed_modes(
        self,
        A: NDArray[np.float64],
        Phi_R: NDArray[np.float64],
        S: csr_matrix,
        count: int,
    ) -> Modes:
        """Lowest ``count`` modes with S phi = 0: those of (K^-1 - A C^-1 A^T) M, checked.

        By ARPACK, since the operator is not a matrix. The reactions S^T mu of the fixed interface,
        mu = Phi_R^T r, are subtracted from the residual r.

        Parameters
        ----------
        A, Phi_R : (n, n_c), K^-1 S^T and A C^-1
        """

        def held(b: NDArray[np.float64]) -> NDArray[np.float64]:
            """K^-1 b - A C^-1 A^T b of a vector ``b`` (n,): displacements with S u = 0."""
            return self.solve(b.reshape(-1, 1))[:, 0] - Phi_R @ (A.T @ b.ravel())

        n = self.K.shape[0]
        values, Phi = eigsh(
            self.K, count, self.M, sigma=0, OPinv=LinearOperator((n, n), held), v0=held(np.ones(n))
        )
        Phi = Phi - Phi_R @ (S @ Phi)
        pairs = list(zip(values, Phi.T, strict=True))
        return self._checked(pairs, lambda r: r - S.T @ (Phi_R.T @ r))

    def _factor(self) -> Cholesky:
        """Factorise K.

        Raises
        ------
        ModesError
            When it is not positive definite.
        """
        factor = self._cholesky.of(self.K)
        if factor.negative > 0:
            raise ModesError(
                f"K is not positive definite ({factor.negative} negative eigenvalues): the blade "
                f"is not stable at this speed; lower the highest speed"
            )
        return factor

    def _checked(
        self,
        pairs: list[tuple[float, NDArray]],
        without_reactions: Callable[[NDArray], NDArray] = lambda r: r,
    ) -> Modes:
        pairs = sorted(pairs, key=lambda pair: pair[0])
        Phi = np.column_stack([vector / np.sqrt(vector @ (self.M @ vector)) for _, vector in pairs])
        values = np.array([value for value, _ in pairs])
        K_Phi = self.K @ Phi
        residuals = np.linalg.norm(without_reactions(K_Phi - self.M @ Phi * values), axis=0)
        residuals /= np.linalg.norm(K_Phi, axis=0)
        if not residuals.max() <= RESIDUAL_TOLERANCE:
            raise ModesError(
                f"mode {residuals.argmax() + 1} leaves a residual of {residuals.max():.1e}, "
                f"above {RESIDUAL_TOLERANCE:.0e}"
            )
        return Modes(np.sqrt(values), Phi, residuals)


def block_lanczos(
    inverse: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    M: csr_matrix,
    start: NDArray[np.float64],
    count: int,
) -> NDArray[np.float64]:
    """Vectors (n, count) of the largest eigenvalues of K^-1 M, by block Lanczos.

    With each block reorthogonalised to all before it (Golub and Underwood 1977; Parlett 1980), in
    the product of M. Fewer than ``count`` where the space of the ``start`` ends.

    Parameters
    ----------
    inverse : K^-1 B of a block B (n, columns)
    start : (n, block)
    """
    Q: list[NDArray[np.float64]] = []  # M-orthonormal blocks
    H = np.empty((0, 0))  # Q^T M K^-1 M Q
    W, M_W = start, M @ start
    while True:
        W, M_W = _orthonormal(W, M_W, M, Q)
        if not W.size:
            break
        Q.append(W)
        W = inverse(M_W)
        M_W = M @ W
        column = np.vstack([block.T @ M_W for block in Q])
        size = len(H)
        H = np.block([[H, column[:size]], [column[:size].T, column[size:]]])
        values, Y = (of[..., -count:] for of in eigh(H))
        for block, of_block in zip(Q, _parts(column, Q), strict=True):
            W -= block @ of_block
        M_W = M @ W
        rest, last = W.T @ M_W, Y[size:]
        if values.size == count and np.all(
            np.einsum("ik,ij,jk->k", last, rest, last) <= (CONVERGED * values) ** 2
        ):
            break
    return sum((B @ y for B, y in zip(Q, _parts(Y, Q), strict=True)), np.zeros(()))


def _parts(rows: NDArray, Q: list[NDArray]) -> list[NDArray]:
    """The rows of each block of Q."""
    return np.split(rows, np.cumsum([block.shape[1] for block in Q])[:-1])


def _orthonormal(
    W: NDArray, M_W: NDArray, M: csr_matrix, Q: list[NDArray]
) -> tuple[NDArray, NDArray]:
    """M-orthonormal basis B of W, but for the blocks Q, and M B; no columns if nothing is left."""
    before = np.einsum("ij,ij->j", W, M_W).max(initial=0.0)
    for block in Q:
        W = W - block @ (block.T @ M_W)
    M_W = M @ W
    lengths, V = eigh(W.T @ M_W)
    kept = lengths > VANISHED**2 * before
    V = V[:, kept] / np.sqrt(lengths[kept])
    return W @ V, M_W @ V
