"""Matrices and reduced models made elsewhere."""

from pathlib import Path

from fem.elsewhere import read_matrices
from fem.matrices import Matrices
from geometry.elsewhere import read_blade
from rom.components import ComponentModes
from rom.elsewhere import UNCHECKED, described, read_elsewhere
from rom.full_model import MODES, of_components


def read(blade: str, matrices: str) -> None:
    """Read matrices, and make their interface operator."""
    path = Path(blade)
    fom = read_matrices(read_blade(path), path.stem, path.parent)
    print(f"{len(fom.coordinates)} free nodes, K at {fom.speeds} rad/s")
    fom.save(matrices)


def solve(matrices: str, modes: str, full: str) -> None:
    """Modes of the full model and its compliance, at the speeds of the matrices."""
    solved = of_components(Matrices.load(matrices), ComponentModes.load(modes).each(MODES))
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)


def take(blade: str, source: str, directions: str, rom: str) -> None:
    """Take a reduced model with these ``directions``, if its checks find no fault."""
    taken = read_elsewhere(source, Path(blade).stem)
    taken.require_directions(directions)
    print(*described(taken), "not checked:", *UNCHECKED, sep="\n")
    taken.save(rom)
