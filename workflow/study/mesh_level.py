"""Sizes of the mesh study, and what is kept of the blade on each."""

from dataclasses import asdict, dataclass
from pathlib import Path

from geometry.files import read_json, write_json

MODES = 10
FACTORS = (2.0, 2**0.5, 1.0, 0.5**0.5)  # of the blade's own element size, coarse to fine
OWN = FACTORS.index(1.0)


@dataclass(frozen=True)
class Level:
    """The blade on one mesh."""

    element_size_mm: float
    nodes: int
    at_rest_Hz: list[float]  # (MODES,)
    at_Omega_m_Hz: list[float]  # (MODES,)
    tip_deflection_m: float  # at 1/16 of the chord, at Omega_m

    def save(self, path: str | Path) -> None:
        """Write JSON."""
        write_json(asdict(self), path)

    @classmethod
    def load(cls, path: str | Path) -> "Level":
        """Read JSON."""
        return cls(**read_json(path))
