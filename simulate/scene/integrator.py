"""Time integration of a scene: scheme and step."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from geometry.base import Settings, SettingsError, one_of

StepsPerRound = Annotated[int, Field(ge=64, le=10**9)]
NO_SCALING = {"mass_scaling_hz": "take it out: `piecewise-exact` is stable for any step"}


class CentralDifference(Settings):
    """Central differences with prediction and correction, Eqs. (18)-(20)."""

    either: ClassVar = [("steps_per_round", "fraction_of_limit")]
    replaced: ClassVar = NO_SCALING

    scheme: Literal["central-difference"] = Field(description="the paper's, Eqs. (18)-(20)")
    steps_per_round: StepsPerRound | None = Field(default=None, description="Steps per revolution")
    fraction_of_limit: float | None = Field(
        default=None, gt=0, le=1, description="Step over the stability limit with contact"
    )


class PiecewiseExact(Settings):
    """Exact modes under a force constant over each step, that force implicit: always stable."""

    replaced: ClassVar = NO_SCALING

    scheme: Literal["piecewise-exact"] = Field(
        description="exact for a contact force constant over the step, stable for any step"
    )
    steps_per_round: StepsPerRound = Field(description="Steps per revolution")

    @model_validator(mode="before")
    @classmethod
    def _no_limit(cls, values: Any) -> Any:
        if isinstance(values, dict) and "fraction_of_limit" in values:
            raise SettingsError(
                "piecewise-exact has no stability limit; give steps_per_round instead",
                key="fraction_of_limit",
            )
        return values


Integrator = Annotated[
    PiecewiseExact | CentralDifference,
    one_of("integrator", "scheme", PiecewiseExact, CentralDifference),
]
