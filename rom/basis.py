"""Reduction basis valid over a speed range: Eqs. (4)-(5)."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from geometry.files import whole
from rom.modes import ShiftInvert


@dataclass(frozen=True)
class Components:
    """Component modes at one speed, on the DoFs off the interface."""

    Phi_R: NDArray[np.float64]  # (n_i, n_b), constraint modes: -K_ii^-1 K_ib
    Phi_L: NDArray[np.float64]  # (n_i, eta), fixed-interface modes


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


def components(K: csr_matrix, M: csr_matrix, split: Split, eta: int) -> Components:
    """Constraint modes (one block solve) and ``eta`` fixed-interface modes of K, M."""
    K_ii, M_ii = K[split.i][:, split.i], M[split.i][:, split.i]
    inverse = ShiftInvert(K_ii, M_ii)
    return Components(
        Phi_L=inverse.modes(eta).Phi,
        Phi_R=-inverse.solve(K[split.i][:, split.b].toarray()),
    )


def multi_speed_basis(
    at_speeds: list[Components], split: Split, rank_tolerance: float
) -> NDArray[np.float64]:
    """T (n_full, n) of Eq. (5): [[I, 0], [Phi_R(0), Psi]].

    Psi spans the starred constraint modes and the fixed-interface modes of Eq. (4), each column
    scaled to unit norm, orthonormalised by an SVD that drops directions whose singular value is
    below ``rank_tolerance`` times the largest.

    Parameters
    ----------
    at_speeds : components at 0, Omega_m/2, Omega_m
    """
    rest, *others = at_speeds
    columns = [other.Phi_R - rest.Phi_R for other in others] + [c.Phi_L for c in at_speeds]
    Psi = _orthonormal(np.hstack(columns), rank_tolerance)
    n_b = len(split.b)
    T = np.zeros((n_b + len(split.i), n_b + Psi.shape[1]))
    T[split.b, np.arange(n_b)] = 1.0
    T[split.i, :n_b] = rest.Phi_R
    T[split.i, n_b:] = Psi
    return T


def save_basis(T: NDArray[np.float64], path: str | Path) -> None:
    """Write T (n_full, n) to HDF5, ``basis.h5``; only fields and stresses need it."""
    with whole(path) as temporary, h5py.File(temporary, "w") as file:
        file["T"] = T


def load_basis(path: str | Path) -> NDArray[np.float64]:
    """Read T (n_full, n)."""
    with h5py.File(path) as file:
        return file["T"][:]


def _orthonormal(columns: NDArray[np.float64], rank_tolerance: float) -> NDArray[np.float64]:
    norms = np.linalg.norm(columns, axis=0)
    kept = columns[:, norms > 0] / norms[norms > 0]
    U, singular, _ = np.linalg.svd(kept, full_matrices=False)
    return U[:, singular > rank_tolerance * singular[0]]
