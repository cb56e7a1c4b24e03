"""Materials that a mesh file names: shown, and compared with that of the blade, which is taken."""

from dataclasses import dataclass

from geometry.blade import Material

UNITS = {  # of stress (Pa) and of density (kg/m3) by that of length, as programs pair them
    "m": (1.0, 1.0, "Pa and kg/m3"),
    "cm": (1e4, 1e8, "N/cm2 and N s2/cm4"),
    "mm": (1e6, 1e12, "MPa and t/mm3"),
    "in": (6894.757, 1.06869e7, "psi and lbf s2/in4"),
}
APART = 0.01  # relative difference of which is warned


@dataclass(frozen=True)
class FileMaterial:
    """An elastic material in the units of its file; None for what the file does not say."""

    name: str
    young_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None

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
            if not abs(value - getattr(material, key)) <= APART * abs(getattr(material, key))
        ]
