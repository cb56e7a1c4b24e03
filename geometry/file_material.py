"""Materials that a mesh file names: shown, and compared with that of the blade, which is taken."""

from dataclasses import dataclass

from geometry.blade import METRES, Material

APART = 0.01  # relative difference of which is warned


@dataclass(frozen=True)
class FileMaterial:
    """An elastic material in the units of its file; None for what the file does not say."""

    name: str
    young_modulus: float | None = None
    poisson_ratio: float | None = None
    density: float | None = None

    def taken_in(self, unit: str) -> dict[str, float]:
        """Values by the key of ``Material``, if the file's unit of force is the newton.

        Its unit of stress is then N per square ``unit``, that of mass N s2 per ``unit``.
        """
        m = METRES[unit]
        values = {
            "young_modulus_GPa": self.young_modulus and self.young_modulus / m**2 * 1e-9,
            "poisson_ratio": self.poisson_ratio,
            "density_kg_m3": self.density and self.density / m**4,
        }
        return {key: value for key, value in values.items() if value is not None}

    def described(self, unit: str) -> str:
        """The values that the file has, in N and its ``unit`` of length."""
        values = ", ".join(f"{key} {value:.5g}" for key, value in self.taken_in(unit).items())
        return f"material {self.name} of the file, read in N and {unit}: {values or 'no values'}"

    def differs(self, material: Material, unit: str) -> list[str]:
        """Keys of ``material``, with its value, where the file says something else."""
        return [
            f"{key} {getattr(material, key):.5g}"
            for key, value in self.taken_in(unit).items()
            if abs(value - getattr(material, key)) > APART * abs(getattr(material, key))
        ]
