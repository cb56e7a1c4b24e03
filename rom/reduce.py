"""Full matrices -> reduced model (fom -> rom)."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fem.matrices import Matrices
from rom.basis import Split, components, multi_speed_basis
from rom.model import Rom
from rom.polynomial import interpolate
from rom.speeds import basis_speeds


def reduce(fom: Matrices, eta: int, rank_tolerance: float) -> tuple[Rom, NDArray[np.float64]]:
    """Reduced model and its basis T (n_full, n).

    Parameters
    ----------
    fom : matrices at the three speeds of ``basis_speeds``
    eta : fixed-interface modes at each speed
    rank_tolerance : relative singular value below which a direction leaves the basis
    """
    Omega_m = fom.speeds[-1]
    if len(fom.speeds) != 3 or not np.allclose(fom.speeds, basis_speeds(Omega_m), rtol=1e-12):
        raise ValueError(f"a basis needs the speeds 0, Omega_m/2, Omega_m, not {fom.speeds}")
    split = Split.of(fom.M.shape[0], fom.interface_dofs)
    at_speeds = [components(K, fom.M, split, eta) for K in fom.K]
    T = multi_speed_basis(at_speeds, split, rank_tolerance)
    M = project(fom.M, T)
    K = interpolate(np.stack([project(K, T) for K in fom.K]), Omega_m)
    lowest = eigh(K[0], M, eigvals_only=True, subset_by_index=[0, 0])[0]
    rom = Rom(
        M=M,
        K=K,
        points=fom.interface_points,
        Omega_m=float(Omega_m),
        f1=float(np.sqrt(lowest) / (2 * np.pi)),
        span=fom.span,
        provenance=f"mesh {fom.mesh_hash}; eta {eta}; rank tolerance {rank_tolerance:g}",
    )
    return rom, T


def project(A: NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T^T A T, symmetric to the last bit."""
    reduced = T.T @ (A @ T)
    return (reduced + reduced.T) / 2
