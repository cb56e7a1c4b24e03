"""Cholesky factors of sparse symmetric matrices, by PETSc and MUMPS."""

from typing import Self

from fem.petsc import PETSc

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

COLUMNS = 24  # that are solved together: more gain no time


def petsc_matrix(A: csr_matrix, values: NDArray[np.float64]) -> PETSc.Mat:
    """Symmetric positive definite matrix with the pattern of A, that reads the array ``values``."""
    matrix = PETSc.Mat().createAIJWithArrays(
        A.shape, (A.indptr, A.indices, values), comm=PETSc.COMM_SELF
    )
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    return matrix


class Cholesky:
    """Factor of one matrix at a time, the last one that was given to ``of``.

    Matrices of the same sparsity pattern, as K(Omega) over the speeds, share the symbolic
    factorisation.
    """

    matrix: PETSc.Mat  # the factorised one
    _pc: PETSc.PC

    def __init__(self) -> None:
        self._A: csr_matrix | None = None

    def of(self, A: csr_matrix) -> Self:
        """Factorise the symmetric (n, n) matrix A, unless this is its factor already."""
        if A is not self._A:
            if self._has_pattern_of(A):
                self._values[:] = A.data
                self.matrix.stateIncrease()  # to be factorised anew
            else:
                self._prepare(A)
            self._pc.setUp()
            self._A = A
        return self

    @property
    def made(self) -> bool:
        """Whether there is a factor."""
        return self._A is not None

    @property
    def negative(self) -> int:
        """Number of negative pivots, which is that of negative eigenvalues (Sylvester)."""
        return self._factor.getMumpsInfog(12)

    def solve(self, B: NDArray[np.float64]) -> NDArray[np.float64]:
        """A^-1 B for a dense block B (n, columns)."""
        X = np.empty(B.shape, order="F")
        for start in range(0, B.shape[1], COLUMNS):
            part = slice(start, start + COLUMNS)
            right, solution = (
                PETSc.Mat().createDense(of.shape, array=of, comm=PETSc.COMM_SELF)
                for of in (np.asfortranarray(B[:, part]), X[:, part])
            )
            self._factor.matSolve(right, solution)
        return X

    def apply(self, pc: PETSc.PC, x: PETSc.Vec, y: PETSc.Vec) -> None:
        """Solve A y = x, as a PETSc preconditioner."""
        self._factor.solve(x, y)

    @property
    def _factor(self) -> PETSc.Mat:
        return self._pc.getFactorMatrix()

    def _has_pattern_of(self, A: csr_matrix) -> bool:
        old = self._A
        return (
            old is not None
            and old.shape == A.shape
            and np.array_equal(old.indptr, A.indptr)
            and np.array_equal(old.indices, A.indices)
        )

    def _prepare(self, A: csr_matrix) -> None:
        """Solver of a matrix with the pattern and values of A, not yet factorised."""
        self._values = A.data.copy()  # PETSc reads this array
        self.matrix = petsc_matrix(A, self._values)
        self._pc = PETSc.PC().create(PETSc.COMM_SELF)
        self._pc.setOperators(self.matrix)
        self._pc.setType(PETSc.PC.Type.CHOLESKY)
        self._pc.setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
