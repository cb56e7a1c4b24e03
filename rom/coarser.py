"""A coarser model, with half of the patches and fewer natural modes, made from a reduced model.

Its error is several times that of the model, which can so be estimated. The coarse coefficients
c' = Pi c are the L2 projection of the displacement with coefficients c on half as many hat
functions; forces are transferred by Pi^T. The model is then reduced like a full one, with
S = [Pi, 0] and the share ``MODES`` of the natural modes.
"""

from dataclasses import replace
from math import ceil

import numpy as np
from numpy.typing import NDArray

from geometry.blade import EnrichedBasis
from geometry.hats import hat_nodes, projection
from rom.basis import Components, enriched_basis, project
from rom.model import Rom, RomError
from rom.polynomial import basis_speeds

MODES = 3 / 4  # the error of wear is of about fifth order in the natural modes: four times as large


def coarser(rom: Rom) -> tuple[Rom, NDArray[np.float64]]:
    """The coarser model, and T (n, n') with u = T u' from its displacements u' (n',).

    Raises
    ------
    RomError
        When the interface has points, or fewer than four patches.
    """
    if rom.of_points or len(rom.xi) < 4:
        raise RomError(
            "accuracy needs a reduced model on patches, four or more: see interface.patches"
        )
    basis = EnrichedBasis(**rom.provenance.settings["basis"])
    nodes, directions = hat_nodes(len(rom.xi) // 2), len(rom.directions)
    along = np.kron(np.eye(rom.across), projection(rom.xi, nodes))
    Pi = np.kron(along, np.eye(directions))
    S = np.hstack([Pi, np.zeros((len(Pi), rom.n - Pi.shape[1]))])
    modes = ceil(MODES * basis.natural_modes)
    at_speeds = [_components(rom, Omega, S, modes) for Omega in basis_speeds(basis, rom.Omega_m)]
    T = enriched_basis(at_speeds, S, rom.stiffness(0.0), rom.M, basis.rank_tolerance)
    K = np.stack([project(K, T) for K in rom.K])
    growth, advance = (part @ along.T if part.size else part for part in (rom.growth, rom.advance))
    reduced = {"M": project(rom.M, T), "K": K, "u_t": rom.u_t.reshape(-1, rom.n) @ T}
    of_tip = {"xi": nodes, "growth": growth, "advance": advance}
    return replace(rom, **reduced, **of_tip, gauges=()), T


def _components(rom: Rom, Omega: float, S: NDArray[np.floating], modes: int) -> Components:
    """Constraint modes for c' = S u, and ``modes`` natural modes, of the reduced model."""
    A = np.linalg.solve(rom.stiffness(Omega), S.T)
    return Components(np.linalg.solve(S @ A, A.T).T, rom.modes(Omega)[1][:, :modes])
