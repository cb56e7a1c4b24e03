"""Reduction of the full matrices to the reduced model, from component modes at each speed."""

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import csr_matrix

from fem.matrices import Matrices
from geometry.base import Say, counted, silent
from geometry.blade import EnrichedBasis, PaperBasis, settings_of_basis
from geometry.hats import mean, over_edges
from geometry.tip import EDGES
from rom.basis import Components, enriched_basis, paper_basis, project
from rom.components import ComponentModes, at_speeds
from rom.model import CODE, DIRECTIONS, Rom, require_letters
from rom.modes import ModesError, ShiftInvert
from rom.polynomial import basis_speeds, interpolate

MOST_CONDITION = 1e8  # of C; above, the mesh does not resolve the patches


def reduce(
    fom: Matrices,
    basis: EnrichedBasis | PaperBasis,
    directions: str = "rtz",
    say: Say = silent,
    components: ComponentModes | None = None,
) -> tuple[Rom, NDArray[np.float64]]:
    """Reduced model and its basis T (n_full, n).

    Parameters
    ----------
    fom : matrices at the speeds of ``basis_speeds`` and perhaps more, or given ones at their own
    directions : of the interface DoFs: "r" radial, "rt" also tangential, "rtz" also axial, which a
        tip that tapers has in any case
    say : called after each speed with the number left
    components : those of ``fom``, which an enriched basis computes else

    Raises
    ------
    ValueError
        When ``fom`` lacks one of these speeds.
    """
    require_letters(directions)
    slope = fom.slope
    letters = directions.removesuffix("z") + "z" if slope.any() else directions
    Omega_m = fom.top_speed
    wanted = basis_speeds(basis, Omega_m)
    nearest = abs(wanted[:, None] - fom.speeds).min(axis=1).max()
    further = isinstance(basis, EnrichedBasis) or len(fom.speeds) == len(wanted)
    if not (fom.given or (further and nearest <= 1e-12 * Omega_m)):
        raise ValueError(f"the basis needs the speeds {wanted}, not {fom.speeds}")
    T = (
        _paper_basis(fom, basis, fom.rows(letters), say)
        if isinstance(basis, PaperBasis)
        else _enriched_basis(
            fom,
            basis,
            letters,
            components or ComponentModes.of(fom, at_speeds(fom, basis.natural_modes, say)),
        )
    )
    # Eq. (1) projected by Eq. (5)
    M = project(fom.M, T)
    K = np.tensordot(fom.weights, [project(K, T) for K in fom.K], axes=1)
    lowest = eigh(K[0], M, eigvals_only=True, subset_by_index=[0, 0])[0]
    rom = Rom(
        M=M,
        K=interpolate(K, fom.speeds),
        directions=tuple(DIRECTIONS[letter] for letter in letters),
        xi=fom.xi,
        points=fom.points,
        camber=fom.camber,
        slope=slope,
        across=fom.across,
        sides=fom.sides,
        Omega_m=Omega_m,
        f1=float(np.sqrt(lowest) / (2 * np.pi)),
        span=fom.span,
        growth=growth_of(fom),
        advance=advance_of(fom) if slope.any() else np.empty((0, fom.across * len(fom.xi))),
        u_t=over_edges(EDGES, fom.xi, mean(fom.across)) @ (fom.rows("t") @ T)
        if slope.any()
        else np.empty((0, len(M))),
        speeds=fom.speeds,
        provenance=fom.provenance.made(CODE, basis=settings_of_basis(basis), directions=directions),
    )
    return rom, T


def _paper_basis(fom: Matrices, basis: PaperBasis, S: csr_matrix, say: Say) -> NDArray[np.float64]:
    states = counted(fom.states(), len(fom.speeds), "speed", say)
    each = [fixed_components(of.K, fom.M, S, basis.fixed_interface_modes) for of in states]
    return paper_basis(each, basis.rank_tolerance)


def _enriched_basis(
    fom: Matrices, basis: EnrichedBasis, letters: str, components: ComponentModes
) -> NDArray[np.float64]:
    S, kept = fom.rows(letters), fom.kept(letters)
    modes = components.Phi[..., : basis.natural_modes]
    each = [
        Components(constraint_modes(A[:, kept], S), Phi)
        for A, Phi in zip(components.A, modes, strict=True)
    ]
    return enriched_basis(each, S, fom.K[0], fom.M, basis.rank_tolerance)


def growth_of(fom: Matrices) -> NDArray[np.float64]:
    """Coefficients (powers, across n), m, of the growth on the patches, or at points, of ``fom``.

    The radius of each node, ``|x + u|`` less ``|x|`` across the engine axis, is projected like a
    radial displacement: an untwist that moves a node sideways by t counts with t^2 / (2 r). (0, n)
    where the static deflections are not known.
    """
    if np.isnan(fom.u_static).any():
        return np.empty((0, fom.across * len(fom.xi)))
    if not fom.u_static.any():
        return np.zeros((len(fom.u_static), fom.across * len(fom.xi)))
    x, y = fom.coordinates[:, 0], fom.coordinates[:, 1]
    r = np.hypot(x, y)
    e_r = np.stack([x / r, y / r, 0 * r], axis=1)
    u = fom.u_static.reshape(len(fom.u_static), -1, 3)
    grown = np.hypot(x + u[..., 0], y + u[..., 1]) - r
    radial = (grown[..., None] * e_r).reshape(len(u), -1)
    return interpolate((fom.S[::3] @ radial.T).T, fom.speeds)


def advance_of(fom: Matrices) -> NDArray[np.float64]:
    """Coefficients (powers, n), m, of the axial displacement of the tip, as those of the growth."""
    if np.isnan(fom.u_static).any():
        return np.empty((0, fom.across * len(fom.xi)))
    return interpolate((fom.S[2::3] @ fom.u_static.T).T, fom.speeds)


def fixed_components(K: csr_matrix, M: csr_matrix, S: csr_matrix, eta: int) -> Components:
    """Constraint modes, and ``eta`` fixed-interface modes, those of (K^-1 - A C^-1 A^T) M.

    K, M: (n_full, n_full), N/m and kg; S: (n_c, n_full). Raises ``ModesError``.
    """
    inverse = ShiftInvert(K, M)
    A = inverse.solve(S.T.toarray())
    Phi_R = constraint_modes(A, S)
    return Components(Phi_R, inverse.fixed_modes(A, Phi_R, S, eta).Phi)


def constraint_modes(A: NDArray[np.float64], S: csr_matrix) -> NDArray[np.float64]:
    """Phi_R = A C^-1 (n_full, n_c) of A = K^-1 S^T.

    Raises
    ------
    ModesError
        When C is singular to round-off.
    """
    C = S @ A
    C = (C + C.T) / 2
    scale = 1 / np.sqrt(np.diag(C))  # axial and radial compliances differ by orders of magnitude
    condition = np.linalg.cond(C * np.outer(scale, scale))
    if not condition <= MOST_CONDITION:
        raise ModesError(
            f"the mesh of the tip cannot tell so many apart (condition {condition:.0e} of their "
            f"compliance, allowed {MOST_CONDITION:.0e}); take half as many, or refine the mesh",
            key="interface.patches",
        )
    Phi_R = np.linalg.solve(C, A.T).T
    return Phi_R - A @ np.linalg.solve(C, S @ Phi_R - np.eye(len(C)))  # S Phi_R = I
