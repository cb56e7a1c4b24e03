"""Natural modes of a blade; its reduced model, and its basis."""

from fem.matrices import Matrices
from geometry.base import Say
from geometry.elsewhere import read_blade
from rom.full_model import MODES
from rom.natural import NaturalModes, natural_modes
from rom.reconstruct import Basis
from rom.reduce import reduce


def solve(matrices: str, count: int, modes: str, tell: Say) -> None:
    """Lowest ``count`` natural modes of M and K(Omega), and those of the full model's check."""
    natural_modes(Matrices.load(matrices), max(count, MODES), tell).save(modes)


def make(
    blade: str, matrices: str, modes: str, directions: str, rom: str, basis: str, tell: Say
) -> None:
    """Reduce M and K(Omega), with these ``directions`` of the interface."""
    fom, natural = Matrices.load(matrices), NaturalModes.load(modes)
    reduced, T = reduce(fom, read_blade(blade).basis, directions, tell, natural)
    print(f"n = {reduced.n}, f1(0) = {reduced.f1:.2f} Hz")
    Basis.of(fom, T, reduced.provenance).save(basis)
    reduced.save(rom)
