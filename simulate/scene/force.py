"""Engine orders that excite a blade beside the rub, as the wakes of a row of vanes do.

On the mode k the generalised force Re(P_k e^{i E theta}), E the order and theta = Omega t the angle
of blade 0 in the casing, both in the sense of rotation; modes with phi^T M phi = 1 and u_r > 0 at
xi = 1/16. Blade j of N is at 2 pi j / N.
"""

from collections.abc import Sequence
from typing import Annotated, ClassVar, Literal

from pydantic import ConfigDict, Field

from geometry.base import Settings, SettingsError, checked
from simulate.scene.casing import HIGHEST_ORDER

FORCE = "force"  # what excites its orders


class EngineOrder(Settings):
    """Excitation of one engine order."""

    either: ClassVar = [("amplitude_um", "modal_force")]
    hints: ClassVar = {"amplitude_um": "in um: 0.1 mm is 100"}

    order: int = Field(ge=1, le=HIGHEST_ORDER, description="Its number")
    amplitude_um: float | None = Field(
        default=None,
        ge=0,
        le=1e5,
        description="As large that mode 1 alone has this amplitude of u_r at xi = 1/16, without "
        "contact, where its frequency meets the order (um)",
    )
    modal_force: list[Annotated[float, Field(ge=-1e6, le=1e6)]] | None = Field(
        default=None,
        min_length=1,
        max_length=100,
        description="Instead: generalised forces on the first families of modes, one by one "
        "(N kg^-1/2)",
    )
    phase_deg: float = Field(default=0.0, description="Phase, by which it is ahead (deg)")
    grows: bool = Field(
        default=False,
        description="Whether it grows with Omega^2, through the value given where mode 1 meets the "
        "order; by default it is the same at all speeds",
    )

    @property
    def needs_crossing(self) -> bool:
        """Whether it refers to the speed at which mode 1 meets the order."""
        return self.grows or self.amplitude_um is not None


class Force(Settings):
    """Excitation of some engine orders, which begins with the run."""

    model_config = ConfigDict(serialize_by_alias=True)

    orders: list[EngineOrder] = Field(min_length=1, max_length=16, description="Engine orders")
    from_: Literal["rest", "steady"] = Field(
        default="rest",
        alias="from",
        description="Start of a blade at rest, or in its steady response without contact",
    )

    @checked
    def _each_order_once(self) -> None:
        if len({*self.numbers}) < len(self.orders):
            raise SettingsError("names an order twice", key="orders", value=self.numbers)

    @property
    def numbers(self) -> Sequence[int]:
        """The engine orders."""
        return [one.order for one in self.orders]
