"""Matrices and reduced models made elsewhere."""

from pathlib import Path

from fem.elsewhere import read_matrices
from geometry.elsewhere import read_blade
from rom.elsewhere import UNCHECKED, described, read_elsewhere
from rom.measured import told, with_frequencies


def read(blade: str, matrices: str) -> None:
    """Read matrices, and make their interface operator."""
    path = Path(blade)
    fom = read_matrices(read_blade(path), path.stem, path.parent)
    print(f"{len(fom.coordinates)} free nodes, K at {fom.speeds} rad/s")
    fom.save(matrices)


def take(blade: str, source: str, directions: str, rom: str) -> None:
    """Take a reduced model with these ``directions``, if its checks find no fault."""
    taken = read_elsewhere(source, Path(blade).stem)
    taken.require_directions(directions)
    taken = with_frequencies(taken, read_blade(blade).frequencies_Hz)
    print(*described(taken), *told(taken), "not checked:", *UNCHECKED, sep="\n")
    taken.save(rom)
