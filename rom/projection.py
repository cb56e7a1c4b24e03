"""Matrices in the coordinates of a basis."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix


def project(A: csr_matrix | NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T^T A T, symmetric to the last bit."""
    reduced = T.T @ (A @ T)
    return (reduced + reduced.T) / 2
