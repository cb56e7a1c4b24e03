"""Reduction bases valid over a speed range: Eqs. (4)-(5), and a richer one for the same size.

Both have the form T = [[I, 0], [Phi_R(0), Psi]], so interface DoFs keep their physical meaning;
they differ in the space that Psi spans.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from rom.modes import ShiftInvert


@dataclass(frozen=True)
class Split:
    """Interface DoFs b, node by node, and the others i."""

    b: NDArray[np.int64]
    i: NDArray[np.int64]

    @classmethod
    def of(cls, n: int, interface: NDArray[np.int64]) -> "Split":
        """Split ``n`` DoFs at ``interface`` (nodes, directions)."""
        b = interface.ravel()
        return cls(b=b, i=np.setdiff1d(np.arange(n), b))


@dataclass(frozen=True)
class Components:
    """Component modes at one speed."""

    Phi_R: NDArray[np.float64]  # (n_i, n_b), constraint modes: -K_ii^-1 K_ib
    Phi_L: NDArray[np.float64]  # (n_i, eta), fixed-interface modes
    Phi: NDArray[np.float64]  # (n_full, natural), natural modes: the interface free


def components(
    K: csr_matrix, M: csr_matrix, split: Split, eta: int, natural: int = 0
) -> Components:
    """Constraint modes (one block solve), ``eta`` fixed-interface and ``natural`` natural modes."""
    K_ii, M_ii = K[split.i][:, split.i], M[split.i][:, split.i]
    inverse = ShiftInvert(K_ii, M_ii)
    return Components(
        Phi_R=-inverse.solve(K[split.i][:, split.b].toarray()),
        Phi_L=inverse.modes(eta).Phi,
        Phi=ShiftInvert(K, M).modes(natural).Phi if natural else np.empty((K.shape[0], 0)),
    )


def paper_basis(
    at_speeds: list[Components], split: Split, rank_tolerance: float
) -> NDArray[np.float64]:
    """T (n_full, n) of Eq. (5).

    Psi spans the starred constraint modes and the fixed-interface modes of Eq. (4), each column
    scaled to unit norm, orthonormalised by an SVD that drops directions whose singular value is
    below ``rank_tolerance`` times the largest.

    Parameters
    ----------
    at_speeds : components at 0, Omega_m/2, Omega_m
    """
    columns = _nonzero(_starred(at_speeds) + [c.Phi_L for c in at_speeds])
    U, singular, _ = np.linalg.svd(columns / np.linalg.norm(columns, axis=0), full_matrices=False)
    return _join(at_speeds[0].Phi_R, U[:, singular > rank_tolerance * singular[0]], split)


def enriched_basis(
    at_speeds: list[Components],
    split: Split,
    K_rest: csr_matrix,
    M: csr_matrix,
    rank_tolerance: float,
) -> NDArray[np.float64]:
    """T (n_full, n): Eq. (5) with the natural modes of every speed in the span of Psi.

    To the columns of Eq. (4) come the natural modes less their static part at rest,
    Phi_i - Phi_R(0) Phi_b, which makes their frequencies exact at these speeds (Rayleigh-Ritz).
    Of all columns, each of unit strain energy at rest, the principal directions in that energy
    are kept whose singular value is above ``rank_tolerance`` times the largest (method of
    snapshots, Sirovich 1987). Psi are then the fixed-interface modes at rest of the kept space:
    Psi^T M Psi = I and Psi^T K(0) Psi is diagonal, as in Craig and Bampton (1968).
    """
    Phi_R = at_speeds[0].Phi_R
    natural = [c.Phi[split.i] - Phi_R @ c.Phi[split.b] for c in at_speeds]
    columns = _nonzero(_starred(at_speeds) + [c.Phi_L for c in at_speeds] + natural)
    K_ii, M_ii = K_rest[split.i][:, split.i], M[split.i][:, split.i]
    Psi = _principal(columns, K_ii, rank_tolerance)
    return _join(Phi_R, _ritz(Psi, K_ii, M_ii), split)


def _starred(at_speeds: list[Components]) -> list[NDArray]:
    """Constraint modes at speed relative to those at rest, Eq. (4)."""
    rest, *others = at_speeds
    return [other.Phi_R - rest.Phi_R for other in others]


def _nonzero(blocks: list[NDArray]) -> NDArray:
    columns = np.hstack(blocks)
    return columns[:, columns.any(axis=0)]


def _principal(columns: NDArray, K: csr_matrix, rank_tolerance: float) -> NDArray:
    """K-orthonormal principal directions of the columns, each of unit energy before."""
    gram = columns.T @ (K @ columns)
    scale = np.sqrt(np.diag(gram))
    values, V = eigh(gram / np.outer(scale, scale))
    singular = np.sqrt(np.maximum(values, 0))
    kept = singular > rank_tolerance * singular[-1]
    return (columns / scale) @ (V[:, kept] / singular[kept])


def _ritz(Psi: NDArray, K: csr_matrix, M: csr_matrix) -> NDArray:
    """Modes of K, M in the span of Psi, M-normalised, ascending."""
    _, V = eigh(project(K, Psi), project(M, Psi))
    return Psi @ V


def project(A: csr_matrix | NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T^T A T, symmetric to the last bit."""
    reduced = T.T @ (A @ T)
    return (reduced + reduced.T) / 2


def _join(Phi_R: NDArray, Psi: NDArray, split: Split) -> NDArray[np.float64]:
    n_b = len(split.b)
    T = np.zeros((n_b + len(split.i), n_b + Psi.shape[1]))
    T[split.b, np.arange(n_b)] = 1.0
    T[split.i, :n_b] = Phi_R
    T[split.i, n_b:] = Psi
    return T
