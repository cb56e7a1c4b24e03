"""Points of the tables: a blade of the prior, and places of the other parameters.

A table's file has rows of a cube: the first coordinate stands for the blade, the others for the
parameters after its shape, in the order of ``priors.NAMES``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Self, TypedDict

import numpy as np
from numpy.typing import NDArray

from workflow.identify.blades import BladeNumbers
from workflow.identify.priors import NAMES, SHAPE, Points, Priors, sobol

UNIT = NAMES.index("unit_Pa") - len(SHAPE)  # of the parameters after the shape
UNIFORM = 12**-0.5  # standard deviation over a unit interval

type Values = dict[str, NDArray[np.float64]]  # (points,) of each parameter


class TablePoints(TypedDict):
    """Points of a table, as its file has them."""

    data: str | None  # by which they were drawn, of ``likelihood.DATA``; None of the prior
    cube: list[list[float]]


@dataclass(frozen=True)
class Blades:
    """The blades of a prior, equally likely."""

    places: Points  # (blades, shape), in the unit cube
    softness: NDArray[np.float64]  # (blades,), of mode 1 at the tip, as a shift of the unit's place
    tips: NDArray[np.float64]  # (blades, 2): other modes, and the leading edge in mode 1

    @classmethod
    def of(cls, blades: Sequence[BladeNumbers], priors: Priors) -> Self:
        """The blades of their files; numbers of the tips have the spread of a unit cube."""
        softness, others = np.log([[blade["softness"], blade["others"]] for blade in blades]).T
        tips = np.stack([others, [blade["leading"] for blade in blades]], axis=1)
        return cls(
            np.array([blade["places"] for blade in blades]),
            (softness - softness.mean()) / priors.unit_Pa.width,
            UNIFORM * (tips - tips.mean(axis=0)) / tips.std(axis=0),
        )

    def number(self, cube: Points) -> NDArray[np.int64]:
        """Number (points,) of each point's blade."""
        return (cube[:, 0] * len(self.places)).astype(int)

    def points(self, cube: Points) -> Points:
        """Places (points, parameters) in the unit cube of all parameters."""
        return np.hstack([self.places[self.number(cube)], cube[:, 1:]])

    def features(self, cube: Points) -> Points:
        """What an emulator is a function of (points, features), the blade by what contact sees."""
        number = self.number(cube)
        features = np.hstack([cube[:, 1:], self.tips[number]])
        features[:, UNIT] += self.softness[number]
        return features


def of_prior(number: int, seed: int) -> Points:
    """Rows of the cube, drawn by the prior."""
    return sobol(number, 1 + len(NAMES) - len(SHAPE), seed)


def value_at(values: Mapping[str, Sequence[float]] | Values, point: int) -> dict[str, float]:
    """The parameters of one point."""
    return {name: float(samples[point]) for name, samples in values.items()}
