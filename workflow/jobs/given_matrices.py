"""Matrices made elsewhere."""

from pathlib import Path

from fem.given import read_matrices
from geometry.given import read_blade


def read(blade: str, matrices: str) -> None:
    """Read matrices, and make their interface operator."""
    path = Path(blade)
    fom = read_matrices(read_blade(path), path.stem, path.parent)
    print(f"{len(fom.coordinates)} free nodes, K at {fom.speeds} rad/s")
    fom.save(matrices)
