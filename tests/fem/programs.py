"""M and K with the nodes and directions of their rows, written as other programs write them."""

from typing import NamedTuple

import numpy as np
from scipy.sparse import save_npz, triu


class Files(NamedTuple):
    """Names of the files of M and K."""

    M: str
    K: str


def write_calculix(folder, M, K, rows):
    for suffix, A in (".mas", M), (".sti", K):
        upper = triu(A).tocoo()
        table = np.column_stack([upper.row + 1, upper.col + 1, upper.data])
        np.savetxt(folder / f"job{suffix}", table, "%d %d %20.13e")
    np.savetxt(folder / "job.dof", rows, "%d.%d")
    return Files("job.mas", "job.sti")


def write_matrix_input(folder, M, K, rows):
    """The lower triangle."""
    for name, A in ("M", M), ("K", K):
        upper = triu(A).tocoo()
        table = np.column_stack([rows[upper.col], rows[upper.row], upper.data])
        np.savetxt(
            folder / f"{name}.mtx", table, "%d,%d, %d,%d, %.15e", header="** rows", comments=""
        )
    return Files("M.mtx", "K.mtx")


def write_coordinate(folder, M, K, rows):
    """Both triangles, of rows in the order of their nodes."""
    order = np.lexsort(rows.T[::-1])
    for name, A in ("M", M), ("K", K):
        of = A[order][:, order].tocoo()
        np.savetxt(
            folder / f"{name}.mtx",
            np.column_stack([of.row + 1, of.col + 1, of.data]),
            "%d %d %.15e",
        )
    return Files("M.mtx", "K.mtx")


def write_dmig(folder, M, K, rows):
    """A punch file with both, one triangle each, in ten digits."""
    lines = [
        "GRID*                  1                             4.0           0.0",
        "*           0.0",
    ]
    for name, A in ("KAAX", K), ("K4AAX", 0.02 * K), ("MAAX", M):
        lines.append(f"DMIG    {name:8}{0:8d}{6:8d}{2:8d}{0:8d}")
        lower = triu(A).tocsr()
        for column in range(A.shape[0]):
            node, direction = rows[column]
            lines.append(f"DMIG*   {name:16}{node:16d}{direction:16d}")
            for row, value in zip(lower[column].indices, lower[column].data, strict=True):
                number = f"{value:.9E}".replace("E", "D")
                lines.append(f"*       {rows[row][0]:16d}{rows[row][1]:16d}{number:>16}")
    (folder / "model.pch").write_text("\n".join([*lines, ""]))
    return Files("model.pch", "model.pch")


def write_npz(folder, M, K, rows):
    order = np.lexsort(rows.T[::-1])
    for name, A in ("M", M), ("K", K):
        save_npz(folder / f"{name}.npz", A[order][:, order].tocsr())
    return Files("M.npz", "K.npz")


WRITERS = {
    "CalculiX": write_calculix,
    "Abaqus, MATRIX INPUT": write_matrix_input,
    "Abaqus, COORDINATE": write_coordinate,
    "Nastran, DMIG": write_dmig,
    "SciPy": write_npz,
}
