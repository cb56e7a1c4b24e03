"""A reduced model with half of the patches and fewer modes, from the model itself.

It errs several times as much as the model, and so tells what that errs by. The coarse coefficients
c' = Pi c are the L2 projection of the field of hats c on half as many; forces go back by Pi^T. Of
the modes of the interface held, Psi, those of the highest frequencies are left out.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag, null_space

from geometry.hats import hat_nodes, hats
from rom.model import Rom, RomError
from rom.projection import project

MODES = 3 / 4  # kept of Psi: wear errs with about the fifth power of their number, four times more
POINTS = 4096  # of the quadrature along the chord


def coarser(rom: Rom) -> tuple[Rom, NDArray[np.float64]]:
    """The model on half of its patches and ``MODES`` of Psi, and W (n, its n): u = W u'.

    Raises
    ------
    RomError
        When its interface is of points, or of fewer than four patches.
    """
    n_c, directions = len(rom.xi), len(rom.directions)
    if rom.of_points or n_c < 4:
        raise RomError("accuracy needs a reduced model on patches, four or more: interface.patches")
    nodes, held = hat_nodes(n_c // 2), n_c * directions
    Pi = np.kron(_projection(rom.xi, nodes), np.eye(directions))
    kept = int(np.ceil(MODES * (rom.n - held)))
    # c = Pi^+ c' + N d: what Pi does not see stays in the model, behind c'
    W = block_diag(np.hstack([np.linalg.pinv(Pi), null_space(Pi)]), np.eye(kept))
    used = slice(held + kept)
    coarse = replace(
        rom,
        M=project(rom.M[used, used], W),
        K=np.stack([project(K[used, used], W) for K in rom.K]),
        xi=nodes,
    )
    return coarse, np.vstack([W, np.zeros((rom.n - len(W), W.shape[1]))])


def _projection(fine: NDArray[np.float64], coarse: NDArray[np.float64]) -> NDArray[np.float64]:
    """L2 projection (coarse, fine) over the chord of a field of hats on one of fewer."""
    xi = (np.arange(POINTS) + 0.5) / POINTS
    phi = hats(xi, coarse)
    return np.linalg.solve(phi.T @ phi, phi.T @ hats(xi, fine))
