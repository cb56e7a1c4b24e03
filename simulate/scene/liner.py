"""Abradable liner of a scene, and its contact: profile of the tip, and its tangential force."""

from typing import ClassVar, Literal

from pydantic import Field

from geometry.base import Fault, Settings, SettingsError, checked, known, require, shifted
from simulate.scene.laws import AnyLaw

STRIPS = 16  # along the chord, where the scene does not say
# Pa. Stiffer than ten times diamond, a liner is the law `rigid`: its rods ask for steps that no
# scene has, and central differences agree with half their step where both are wrong.
RANGES = {"E": (1e5, 1e13), "K": (0.0, 1e16), "sigma_Y": (0.0, 1e16)}


class Liner(Settings):
    """Abradable liner: strips of independent rods, each over an equal part of the tip's chord."""

    replaced: ClassVar = {
        "strip_width_m": "strips have their widths from the tip: give liner.strips, their number",
        "law_in_march": "take it out: a law from Python is called, with the same result",
    }

    hints: ClassVar = {
        "thickness_mm": "in mm",
        "footprint_mm": "the arc over which one strip of the tip rubs, in mm",
    }

    law: AnyLaw = Field(description="Law of the rods")
    thickness_mm: float = Field(ge=1e-4, le=100, description="Thickness l (mm)")
    strips: int | None = Field(
        default=None,
        ge=1,
        le=256,
        description=f"Number of strips along the chord, of equal length; {STRIPS} without "
        "accuracy, which chooses it",
    )
    footprint_mm: float | None = Field(
        default=None,
        ge=0.01,
        le=300,
        description="Arc of a strip that the tip rubs (mm), the same along the chord; without it "
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

    @checked
    def _law_in_pascals(self) -> None:
        """Refuse moduli that are of another unit than ``unit_MPa``."""
        unit = getattr(self.law, "unit_Pa", 0.0)
        for name, (least, largest) in RANGES.items():
            value = getattr(self.law, name, None)
            if unit and value is not None and not least <= value * unit <= largest:
                stiffer = "; a stiffer liner is `kind: rigid`" if name == "E" else ""
                raise SettingsError(
                    f"is {value * unit:.3g} Pa with unit_MPa: {unit / 1e6:g}; allowed from "
                    f"{least:g} to {largest:g} Pa: liners have 1e7 to 1e11 Pa; {name} is given in "
                    f"unit_MPa, which is 1000 for GPa{stiffer}",
                    key=f"law.{name}",
                    value=value,
                    allowed=(least / unit, largest / unit),
                )

    @property
    def thickness_m(self) -> float:
        """Thickness l, m."""
        return shifted(self.thickness_mm, -3)

    @property
    def footprint_m(self) -> float | None:
        """Arc of a strip that the tip rubs, m, where it is given."""
        return self.footprint_mm and shifted(self.footprint_mm, -3)

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


class Profile(Settings):
    """Profile of the tip over the footprint, Fig. 4, closest to the casing at p = 0.

    p(s) = tilt s + edge_drop (2 s / footprint)^2 + constant, s from the camber line in the sense of
    rotation.
    """

    hints: ClassVar = {
        "edge_drop_um": "in um: 0.005 mm is 5",
        "tilt": "a slope: 1 deg is 0.01745",
    }

    edge_drop_um: float = Field(
        default=0.0,
        ge=0,
        le=2e4,
        description="Rounding: how far both ends lie below the middle (um)",
    )
    tilt: float = Field(
        default=0.0, ge=-1, le=1, description="Slope of the tip; its trailing side rubs if > 0"
    )

    @checked
    def _not_flat(self) -> None:
        if self.edge_drop_um == 0 and self.tilt == 0:
            raise ValueError("give edge_drop_um or tilt: without either the tip is flat")

    @property
    def edge_drop_m(self) -> float:
        """The rounding, m."""
        return shifted(self.edge_drop_um, -6)


class Contact(Settings):
    """Contact model: profile of the tip and tangential force."""

    profile: Profile | None = Field(default=None, description="Rounded tip; flat without it")
    tangential: bool = Field(
        default=False,
        description="Tangential force: the force of each rod acts along the profile's normal",
    )
    friction: float | None = Field(
        default=None,
        gt=0,
        le=1,
        description="Coefficient of the friction of the sliding tip, against the rotation",
    )

    @property
    def along(self) -> bool:
        """Whether there is a tangential force."""
        return self.tangential or self.friction is not None

    @checked
    def _one_tangential_force(self) -> None:
        require(
            (
                not self.tangential or self.profile is not None,
                Fault(
                    "needs `profile: {edge_drop_um: ...}`: on a flat tip the force is radial",
                    "tangential",
                    True,
                ),
            ),
            (
                not self.tangential or self.friction is None,
                Fault(
                    "does not go with `tangential: true`, the tangential force of the profile: "
                    "take one of them out",
                    "friction",
                ),
            ),
            kind=SettingsError,
        )
