"""The reduced model of a blade, and its basis."""

from fem.matrices import Matrices
from geometry.base import Say
from geometry.elsewhere import read_blade
from rom.reconstruct import Basis
from rom.reduce import reduce


def make(
    blade: str,
    matrices: Matrices,
    names: dict[str, str],
    rom: str,
    tell: Say,
    basis: str,
) -> None:
    """Reduce M and K(Omega)."""
    reduced, T = reduce(matrices, read_blade(blade).basis, names["directions"], tell)
    print(f"n = {reduced.n}, f1(0) = {reduced.f1:.2f} Hz")
    Basis.of(matrices, T, reduced.provenance).save(basis)
    reduced.save(rom)
