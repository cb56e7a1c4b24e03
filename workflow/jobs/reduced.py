"""The reduced model of a blade, and its basis."""

from typing import Any

from fem.matrices import Matrices
from geometry.given import read_blade
from geometry.project import Say
from rom.reconstruct import Basis
from rom.reduce import reduce


def make(
    blade: str,
    matrices: str,
    names: dict[str, str],
    rom: str,
    tell: Say,
    basis: str | None = None,
    changes: dict[str, Any] | None = None,
) -> None:
    """Reduce M and K(Omega); ``changes``: other settings than those of the blade's file."""
    settings = read_blade(blade).but(**changes or {})
    fom = Matrices.load(matrices)
    reduced, T = reduce(fom, settings.basis, names["directions"], tell)
    print(f"n = {reduced.n}, f1(0) = {reduced.f1:.2f} Hz")
    if basis:
        Basis.of(fom, T, reduced.provenance).save(basis)
    reduced.save(rom)
