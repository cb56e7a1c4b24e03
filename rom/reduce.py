"""Full matrices -> reduced model (fom -> rom)."""

import json

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from fem.matrices import Matrices
from geometry.blade import EnrichedBasis, PaperBasis
from rom.basis import Split, components, enriched_basis, paper_basis, project
from rom.model import Rom, direction_names
from rom.polynomial import interpolate
from rom.speeds import basis_speeds


def reduce(
    fom: Matrices, basis: EnrichedBasis | PaperBasis, directions: str = "rtz"
) -> tuple[Rom, NDArray[np.float64]]:
    """Reduced model and its basis T (n_full, n).

    Parameters
    ----------
    fom : matrices at the speeds of ``basis_speeds``
    directions : interface DoFs of each node: "r" radial, "rt" and tangential, "rtz" and axial

    Raises
    ------
    ValueError
        When ``fom`` is at other speeds.
    """
    names = direction_names(directions)
    Omega_m = float(fom.speeds[-1])
    wanted = basis_speeds(basis, Omega_m)
    if len(fom.speeds) != len(wanted) or not np.allclose(fom.speeds, wanted, rtol=1e-12):
        raise ValueError(f"the basis needs the speeds {wanted}, not {fom.speeds}")
    split = Split.of(fom.M.shape[0], fom.interface_dofs[:, : len(names)])
    T = _basis(fom, basis, split)
    M, K = project(fom.M, T), np.stack([project(K, T) for K in fom.K])
    lowest = eigh(K[0], M, eigvals_only=True, subset_by_index=[0, 0])[0]
    rom = Rom(
        M=M,
        K=interpolate(K, fom.speeds),
        directions=names,
        points=fom.interface_points,
        Omega_m=Omega_m,
        f1=float(np.sqrt(lowest) / (2 * np.pi)),
        span=fom.span,
        provenance=f"mesh {fom.mesh_hash}; basis {_settings(basis)}",
    )
    return rom, T


def _settings(basis: EnrichedBasis | PaperBasis) -> str:
    """What makes the basis; the tolerance only judges it."""
    return json.dumps(basis.model_dump(exclude={"tolerance_percent"}))


def _basis(fom: Matrices, basis: EnrichedBasis | PaperBasis, split: Split) -> NDArray[np.float64]:
    eta, tolerance = basis.fixed_interface_modes, basis.rank_tolerance
    if isinstance(basis, PaperBasis):
        return paper_basis([components(K, fom.M, split, eta) for K in fom.K], split, tolerance)
    at_speeds = [components(K, fom.M, split, eta, basis.natural_modes) for K in fom.K]
    return enriched_basis(at_speeds, split, fom.K[0], fom.M, tolerance)
