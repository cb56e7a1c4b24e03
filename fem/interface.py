"""DoFs on the mesh by their place, and the turn of the interface's into radial and tangential."""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix, identity
from scipy.spatial import cKDTree


def dofs_at(coordinates: NDArray, points: NDArray) -> NDArray[np.int64]:
    """DoFs (points, 3) of the nodes of ``coordinates`` (nodes, 3), m, at ``points`` (points, 3).

    Raises
    ------
    ValueError
        When a point is no node: the files do not belong together.
    """
    distance, node = cKDTree(coordinates).query(points)
    if distance.max() > 1e-9:
        raise ValueError(f"nodes and mesh differ by {distance.max():.1e} m: rebuild what is older")
    return 3 * node[:, None].astype(np.int64) + np.arange(3)


def cylindrical(n: int, dofs: NDArray[np.int64], theta: NDArray) -> csr_matrix:
    """Q (n, n): u = Q u', where u' is radial, tangential, axial at the interface nodes."""
    Q = identity(n, format="lil")
    for (x, y, _), angle in zip(dofs, theta, strict=True):
        Q[x, x] = Q[y, y] = np.cos(angle)
        Q[x, y], Q[y, x] = -np.sin(angle), np.sin(angle)
    return Q.tocsr()
