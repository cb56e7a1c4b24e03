"""Reduction of the full matrices to the reduced model."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis, PaperBasis, settings_of_basis
from geometry.progress import Say, counted, silent
from rom.basis import enriched_basis, paper_basis
from rom.components import fixed_components, natural_components
from rom.model import CODE, Rom, direction_names
from rom.polynomial import interpolate
from rom.projection import project
from rom.speeds import basis_speeds


def reduce(
    fom: Matrices,
    basis: EnrichedBasis | PaperBasis,
    directions: str = "rtz",
    say: Say = silent,
) -> tuple[Rom, NDArray[np.float64]]:
    """Reduced model and its basis T (n_full, n).

    Parameters
    ----------
    fom : matrices at the speeds of ``basis_speeds`` and perhaps more, or given ones at their own
    directions : of the interface DoFs: "r" radial, "rt" also tangential, "rtz" also axial
    say : is told after each speed how many are left

    Raises
    ------
    ValueError
        When ``fom`` lacks one of these speeds.
    """
    names = direction_names(directions)
    Omega_m = fom.top_speed
    wanted = basis_speeds(basis, Omega_m)
    apart = abs(wanted[:, None] - fom.speeds).min(axis=1).max()
    further = isinstance(basis, EnrichedBasis) or len(fom.speeds) == len(wanted)
    if not (fom.given or (further and apart <= 1e-12 * Omega_m)):
        raise ValueError(f"the basis needs the speeds {wanted}, not {fom.speeds}")
    T = _basis(fom, basis, fom.rows(len(names)), say)
    # Eq. (1) projected by Eq. (5)
    M, K = project(fom.M, T), np.stack([project(K, T) for K in fom.K])
    lowest = eigh(K[0], M, eigvals_only=True, subset_by_index=[0, 0])[0]
    rom = Rom(
        M=M,
        K=interpolate(K, fom.speeds),
        directions=names,
        xi=fom.xi,
        points=fom.points,
        camber=fom.camber,
        Omega_m=Omega_m,
        f1=float(np.sqrt(lowest) / (2 * np.pi)),
        span=fom.span,
        growth=growth_of(fom),
        provenance=fom.provenance.made(CODE, basis=settings_of_basis(basis), directions=directions),
    )
    return rom, T


def _basis(
    fom: Matrices, basis: EnrichedBasis | PaperBasis, S: csr_matrix, say: Say
) -> NDArray[np.float64]:
    tolerance, stiffnesses = basis.rank_tolerance, counted(fom.K, len(fom.K), "speed", say)
    if isinstance(basis, PaperBasis):
        eta = basis.fixed_interface_modes
        return paper_basis([fixed_components(K, fom.M, S, eta) for K in stiffnesses], tolerance)
    modes = basis.natural_modes
    at_speeds = [natural_components(K, fom.M, S, modes) for K in stiffnesses]
    return enriched_basis(at_speeds, S, fom.K[0], fom.M, tolerance)


def growth_of(fom: Matrices) -> NDArray[np.float64]:
    """Coefficients (powers, n), m, of the growth on the patches, or at the points, of ``fom``.

    The radius of each node, |x + u| less |x| across the engine axis, is projected like a radial
    displacement: an untwist that moves a node sideways by t counts with t^2 / (2 r). (0, n) where
    the static deflections are not known.
    """
    if np.isnan(fom.u_static).any():
        return np.empty((0, len(fom.xi)))
    if not fom.u_static.any():
        return np.zeros((len(fom.u_static), len(fom.xi)))
    x, y = fom.coordinates[:, 0], fom.coordinates[:, 1]
    r = np.hypot(x, y)
    e_r = np.stack([x / r, y / r, 0 * r], axis=1)
    S_r = fom.S[::3]
    at_speeds = []
    for u in fom.u_static.reshape(len(fom.u_static), -1, 3):
        grown = np.hypot(x + u[:, 0], y + u[:, 1]) - r
        at_speeds.append(S_r @ (grown[:, None] * e_r).ravel())
    return interpolate(np.array(at_speeds), fom.speeds)
