"""Reduction bases valid over a speed range: that of Eqs. (4)-(5), and a more accurate one.

With S the interface operator, c = S u the interface DoFs, and X any displacements,

    A = K^-1 S^T,    C = S A,    Phi_R = A C^-1,    T = [Phi_R(0), Psi],    S T = [I, 0]

Phi_R are the constraint modes: the static displacements with c = I. Psi spans X minus its static
part, X - Phi_R S X, so that c remain the interface DoFs. If S selects single DoFs, this is Craig
and Bampton's basis of Eq. (5). The two bases differ in the space that Psi spans.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

COLUMNS = 24  # of a product with a matrix of the full model that are in memory at a time


@dataclass(frozen=True)
class Components:
    """Component modes at one speed."""

    Phi_R: NDArray[np.float64]  # (n_full, n_c), constraint modes
    X: NDArray[np.float64]  # (n_full, modes), fixed-interface or natural modes


def paper_basis(at_speeds: list[Components], rank_tolerance: float) -> NDArray[np.float64]:
    """T (n_full, n) of Eq. (5).

    Psi is the orthonormal basis of the starred constraint modes and the fixed-interface modes of
    Eq. (4), each scaled to unit norm, by an SVD without the directions whose singular value is
    below ``rank_tolerance`` times the largest.

    Parameters
    ----------
    at_speeds : components at 0, Omega_m/2, Omega_m
    """
    columns = np.hstack(_nonzero(_starred(at_speeds) + [c.X for c in at_speeds]))
    U, singular, _ = np.linalg.svd(columns / np.linalg.norm(columns, axis=0), full_matrices=False)
    return np.hstack([at_speeds[0].Phi_R, U[:, singular > rank_tolerance * singular[0]]])


def enriched_basis(
    at_speeds: list[Components],
    S: csr_matrix,
    K_rest: csr_matrix,
    M: csr_matrix,
    rank_tolerance: float,
) -> NDArray[np.float64]:
    """T (n_full, n): Eq. (5) with the natural modes of every speed in the span of Psi.

    The starred constraint modes of Eq. (4) are combined with the natural modes minus their static
    part at rest, X - Phi_R(0) S X, which makes their frequencies exact at these speeds
    (Rayleigh-Ritz). The columns are scaled to unit strain energy at rest; their principal
    directions in that energy with singular values above ``rank_tolerance`` times the largest are
    kept (method of snapshots, Sirovich 1987). Psi are the fixed-interface modes at rest in this
    space: Psi^T M Psi = I and Psi^T K(0) Psi is diagonal, as in Craig and Bampton (1968).

    Parameters
    ----------
    at_speeds : components at ascending speeds, rest first
    S : (n_c, n_full), interface operator
    K_rest, M : (n_full, n_full), N/m and kg
    """
    Phi_R = at_speeds[0].Phi_R
    natural = [c.X - Phi_R @ (S @ c.X) for c in at_speeds]
    Psi = _principal(_nonzero(_starred(at_speeds) + natural), K_rest, rank_tolerance)
    Psi = _ritz(Psi, K_rest, M)
    Psi -= Phi_R @ (S @ Psi)  # S Psi = 0 up to round-off
    return np.hstack([Phi_R, Psi])


def project(A: csr_matrix | NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T^T A T, symmetric to the last bit: a matrix in the coordinates of the basis T."""
    reduced = _product(A, T)
    return (reduced + reduced.T) / 2


def _product(A: csr_matrix | NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T^T A T, with A T of a few columns at a time."""
    parts = (T[:, start : start + COLUMNS] for start in range(0, T.shape[1], COLUMNS))
    return np.hstack([T.T @ (A @ part) for part in parts])


def _starred(at_speeds: list[Components]) -> list[NDArray]:
    """Constraint modes at speed relative to those at rest, Eq. (4)."""
    rest, *others = at_speeds
    return [other.Phi_R - rest.Phi_R for other in others]


def _nonzero(blocks: list[NDArray]) -> list[NDArray]:
    """The blocks without columns of zeros."""
    return [block[:, block.any(axis=0)] for block in blocks]


def _principal(blocks: list[NDArray], K: csr_matrix, rank_tolerance: float) -> NDArray:
    """K-orthonormal principal directions of all columns, which are first scaled to unit energy."""
    columns = np.hstack(blocks)
    gram = _product(K, columns)
    scale = np.sqrt(np.diag(gram))
    values, V = eigh(gram / np.outer(scale, scale))
    singular = np.sqrt(np.maximum(values, 0))
    kept = singular > rank_tolerance * singular[-1]
    return columns @ (V[:, kept] / singular[kept] / scale[:, None])


def _ritz(Psi: NDArray, K: csr_matrix, M: csr_matrix) -> NDArray:
    """Modes of K, M in the span of Psi, M-normalised, frequencies ascending."""
    _, V = eigh(project(K, Psi), project(M, Psi))
    return Psi @ V
