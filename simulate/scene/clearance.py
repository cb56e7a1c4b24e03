"""Gap between tip and liner, before the casing distorts."""

from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from geometry.project import SettingsError, checked
from simulate.scene.quantities import IN_M, Alternatives
from simulate.scene.tables import AnyThermal

LEADING, TRAILING = 1 / 16, 15 / 16  # chord fractions at which gaps and outputs are given
OVER_SPAN = "over the span: 0.02 % of it is 2.0e-4"

Gap = Annotated[float, Field(ge=0, le=0.05)]
GapOverSpan = Annotated[float, Field(ge=0, le=0.5)]


class Clearance(Alternatives):
    """Gap between tip and liner, linear along the chord, given at two places of it."""

    either: ClassVar = [
        ("leading_edge_m", "leading_edge_over_span"),
        ("trailing_edge_m", "trailing_edge_over_span"),
    ]
    hints: ClassVar = {
        "leading_edge_m": IN_M,
        "trailing_edge_m": IN_M,
        "leading_edge_over_span": OVER_SPAN,
        "trailing_edge_over_span": OVER_SPAN,
    }

    leading_edge_m: Gap | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord (m)"
    )
    trailing_edge_m: Gap | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord (m)"
    )
    leading_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 1/16 of the chord over the blade length"
    )
    trailing_edge_over_span: GapOverSpan | None = Field(
        default=None, description="Gap at xi = 15/16 of the chord over the blade length"
    )
    at: Literal["running", "rest"] = Field(
        default="running",
        description="Where the gaps are these: at each speed of the sweep, or at rest; then each "
        "speed has them less the static growth of the tip",
    )
    thermal_growth: AnyThermal | None = Field(
        default=None,
        description="With `at: rest`: further growth of the tip over the speed, as a CSV file",
    )

    @checked
    def _growth_is_from_rest(self) -> None:
        if self.thermal_growth is not None and not self.at_rest:
            raise SettingsError(
                "only with `at: rest`: running gaps hold it already", key="thermal_growth"
            )

    @property
    def at_rest(self) -> bool:
        """Whether the gaps are those at rest, from which the growth of the tip takes."""
        return self.at == "rest"

    def gaps(self, xi: ArrayLike, span: float) -> NDArray[np.float64]:
        """Gaps as given, m, of the shape of the chord fractions ``xi``; ``span``: length, m."""
        in_m = (self.leading_edge_m, self.trailing_edge_m)
        of_span = (self.leading_edge_over_span, self.trailing_edge_over_span)
        first, last = (
            m if m is not None else share * span for m, share in zip(in_m, of_span, strict=True)
        )
        return first + (last - first) * (np.asarray(xi) - LEADING) / (TRAILING - LEADING)
