"""What a mesh file says of the blade besides its mesh: materials, masses, and what is not read.

Materials are shown, and compared with that of the blade, which is taken.
"""

from collections import Counter
from dataclasses import dataclass, field

from geometry.base import require
from geometry.blade import Material

UNITS = {  # of stress (Pa) and of density (kg/m3) by that of length, as programs pair them
    "m": (1.0, 1.0, "Pa and kg/m3"),
    "cm": (1e4, 1e8, "N/cm2 and N s2/cm4"),
    "mm": (1e6, 1e12, "MPa and t/mm3"),
    "in": (6894.757, 1.06869e7, "psi and lbf s2/in4"),
}
APART = 0.01  # relative difference of which is warned


def listed(counts: Counter[str]) -> str:
    """How many there are of each kind, those of which there are any."""
    return ", ".join(f"{count} {kind}" for kind, count in sorted(counts.items()) if count)


def agree(one: float, other: float) -> bool:
    """Whether two values of a material are the same within ``APART``."""
    return abs(one - other) <= APART * abs(other)


@dataclass(frozen=True)
class FileMaterial:
    """An elastic material in the units of its file; None for values that the file does not give."""

    name: str
    young_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None
    cells: int = 0  # solid cells that are of it; 0 where the file does not say
    other: str = ""  # the card by which it is not isotropic, or has an orientation

    def taken_in(self, unit: str) -> dict[str, float]:
        """Values by the key of ``Material``, if its units go with the file's ``unit`` of length."""
        stress, density, _ = UNITS[unit]
        values = {
            "young_modulus_GPa": self.young_modulus and self.young_modulus * stress * 1e-9,
            "poisson_ratio": self.poisson_ratio,
            "density_kg_m3": self.density and self.density * density,
        }
        return {key: value for key, value in values.items() if value is not None}

    def described(self, unit: str) -> str:
        """The values that the file has, and the units in which they are read."""
        values = ", ".join(f"{key} {value:.5g}" for key, value in self.taken_in(unit).items())
        return (
            f"material {self.name} of the file, read in {UNITS[unit][2]}: {values or 'no values'}"
        )

    def differs(self, material: Material, unit: str) -> list[str]:
        """Keys of ``material``, with its value, where the file says something else."""
        return [
            f"{key} {getattr(material, key):.5g}"
            for key, value in self.taken_in(unit).items()
            if not agree(value, getattr(material, key))
        ]

    def same_as(self, other: "FileMaterial") -> bool:
        """Whether the file gives all values of both, and they are the same."""
        one, two = self.taken_in("m"), other.taken_in("m")
        return len(one) == len(two) == 3 and all(agree(one[key], two[key]) for key in one)


@dataclass(frozen=True)
class Physics:
    """What a file says besides its mesh."""

    materials: tuple[FileMaterial, ...] = ()  # of its solid cells
    masses: Counter[str] = field(default_factory=Counter)  # point masses by their card
    left_out: Counter[str] = field(default_factory=Counter)  # cards and elements that are not read

    @property
    def described(self) -> str:
        """What is not taken of the file, with its number; empty where that is nothing."""
        return listed(self.masses + self.left_out)

    def require_plain(self) -> None:
        """Refuse physics that the model of a meshed blade does not have.

        Raises
        ------
        MeshError
            When the cells have materials of different values, one that is not isotropic or has an
            orientation, or there are point masses.
        """
        faults = [f"material {m.name} with {m.other}" for m in self.materials if m.other]
        if any(not material.same_as(self.materials[0]) for material in self.materials[1:]):
            named = ", ".join(
                f"{m.name} of {m.cells} cells" if m.cells else m.name for m in self.materials
            )
            faults.insert(0, f"{len(self.materials)} materials ({named})")
        if self.masses:
            faults.append(f"point masses ({listed(self.masses)})")
        require(
            (
                not faults,
                f"has {' and '.join(faults)}; a blade of `mesh_file` is of one isotropic material "
                "without masses: give the matrices of its program by `full_matrices` "
                "(fem/matrices.md), which have all of that, or a file without it",
            )
        )
