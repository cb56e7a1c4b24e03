"""The reduced model of a blade, and its basis."""

from fem.matrices import Matrices
from geometry.base import Say
from geometry.elsewhere import read_blade
from rom.components import ComponentModes
from rom.reconstruct import Basis
from rom.reduce import reduce


def make(
    blade: str, matrices: str, modes: str, directions: str, rom: str, basis: str, tell: Say
) -> None:
    """Reduce M and K(Omega), with these ``directions`` of the interface."""
    fom, components = Matrices.load(matrices), ComponentModes.load(modes)
    reduced, T = reduce(fom, read_blade(blade).basis, directions, tell, components)
    print(f"n = {reduced.n}, f1(0) = {reduced.f1:.2f} Hz")
    Basis.of(fom, T, reduced.provenance).save(basis)
    reduced.save(rom)
