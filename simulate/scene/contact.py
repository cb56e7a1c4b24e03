"""Contact of a scene: profile of the tip, and its tangential force."""

from typing import ClassVar

from pydantic import Field

from geometry.base import Fault, Settings, SettingsError, checked, require, shifted


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
