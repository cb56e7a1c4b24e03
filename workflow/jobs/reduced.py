"""The reduced model of a blade, and its basis."""

from fem.matrices import Matrices
from geometry.base import Say
from geometry.elsewhere import read_blade
from rom.components import ComponentModes
from rom.measured import told, with_frequencies
from rom.reconstruct import Basis
from rom.reduce import reduce


def make(
    blade: str, matrices: str, modes: str, directions: str, rom: str, basis: str, tell: Say
) -> None:
    """Reduce M and K(Omega), with these ``directions`` of the interface."""
    fom, components = Matrices.load(matrices), ComponentModes.load(modes)
    settings = read_blade(blade)
    clamped, T = reduce(fom, settings.basis, directions, tell, components)
    reduced = with_frequencies(clamped, settings.frequencies_Hz)
    print(f"n = {reduced.n}, f1(0) = {reduced.f1:.2f} Hz", *told(reduced), sep="\n")
    Basis.of(fom, T, reduced.provenance).save(basis)
    reduced.save(rom)
