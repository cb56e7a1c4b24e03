"""Abradable liner of a scene."""

from typing import ClassVar, Literal

from pydantic import Field

from geometry.project import Settings, SettingsError, checked, known
from simulate.scene.laws import AnyLaw

STRIPS = 16  # along the chord, where the scene does not say
# Pa. Stiffer than ten times diamond, a liner is the law `rigid`: its rods ask for steps that no
# scene has, and central differences agree with half their step where both are wrong.
RANGES = {"E": (1e5, 1e13), "K": (0.0, 1e16), "sigma_Y": (0.0, 1e16)}


class Liner(Settings):
    """Abradable liner: strips of independent rods, each over an equal part of the tip's chord."""

    replaced: ClassVar = {
        "strip_width_m": "strips have their widths from the tip: give liner.strips, their number"
    }

    hints: ClassVar = {
        "thickness_m": "in m: 5 mm is 5.0e-3",
        "footprint_m": "in m: 5 mm is 5.0e-3; the arc over which one strip of the tip rubs",
    }

    law: AnyLaw = Field(description="Law of the rods")
    thickness_m: float = Field(ge=1e-7, le=0.1, description="Thickness l (m)")
    strips: int | None = Field(
        default=None,
        ge=1,
        le=256,
        description=f"Number of strips along the chord, of equal length; {STRIPS} without "
        "accuracy, which chooses it",
    )
    footprint_m: float | None = Field(
        default=None,
        ge=1e-5,
        le=0.3,
        description="Arc of a strip that the tip rubs (m), the same along the chord; without it "
        "that which the tip covers at each place. Required for a model that does not know the "
        "thickness of its tip; not used with interface.across: 2",
    )
    rods_per_round: int | None = Field(
        default=None,
        ge=1,
        le=10_000_000,
        description="Density nu, rods per revolution; required without accuracy",
    )
    worn_through: Literal["stop", "casing"] = Field(
        default="stop",
        description="When the liner is worn through: stop, or continue on the rigid casing",
    )

    law_in_march: bool = Field(
        default=False,
        description="Compile a law from Python into the time integration, in some 12 s; otherwise "
        "the integration calls it, at some 1.6 times the time",
    )

    @checked
    def _law_in_pascals(self) -> None:
        """Refuse moduli that are of another unit than ``unit_Pa``."""
        unit = getattr(self.law, "unit_Pa", 0.0)
        for name, (least, largest) in RANGES.items():
            value = getattr(self.law, name, None)
            if unit and value is not None and not least <= value * unit <= largest:
                stiffer = "; a stiffer liner is `kind: rigid`" if name == "E" else ""
                raise SettingsError(
                    f"is {value * unit:.3g} Pa with unit_Pa: {unit:g}; allowed from {least:g} to "
                    f"{largest:g} Pa: liners have 1e7 to 1e11 Pa; {name} is given in unit_Pa, "
                    f"which is 1.0e+9 for GPa{stiffer}",
                    key=f"law.{name}",
                    value=value,
                    allowed=(least / unit, largest / unit),
                )

    @property
    def m(self) -> int:
        """Number of strips."""
        return self.strips or STRIPS

    @property
    def nu(self) -> int:
        """Rods per revolution, given or chosen by ``accuracy``."""
        return known(self.rods_per_round, "liner.rods_per_round")

    @property
    def rigid_key(self) -> str | None:
        """Key that makes the casing rigid for the tip; None where the rods always deform."""
        if not self.law.deforms:
            return f"law.kind: {self.law.called}"
        through = self.law.touches and self.worn_through == "casing"
        return "worn_through: casing" if through else None
