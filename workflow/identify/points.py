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

# Of the parameters after the shape
UNIT, FIFTH = (NAMES.index(name) - len(SHAPE) for name in ("unit_Pa", "fifth_over_second"))
# Of the features, by cross-validation on the first table: spread of the numbers of the tips (that
# of a parameter is 0.29), and a factor on places of the shape
SPREAD, OF_SHAPE = 0.43, 0.15

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
        """The blades of their files."""
        softness, others = np.log([[blade["softness"], blade["others"]] for blade in blades]).T
        tips = np.stack([others, [blade["leading"] for blade in blades]], axis=1)
        return cls(
            np.array([blade["places"] for blade in blades]),
            (softness - softness.mean()) / priors.unit_Pa.width,
            SPREAD * (tips - tips.mean(axis=0)) / tips.std(axis=0),
        )

    def number(self, cube: Points) -> NDArray[np.int64]:
        """Number (points,) of each point's blade."""
        return (cube[:, 0] * len(self.places)).astype(int)

    def points(self, cube: Points) -> Points:
        """Places (points, parameters) in the unit cube of all parameters."""
        return np.hstack([self.places[self.number(cube)], cube[:, 1:]])

    def features(self, cube: Points) -> Points:
        """What an emulator is a function of (points, features): no datum depends on the fifth.

        The blade counts by what contact sees of it, and a little by its shape.
        """
        number = self.number(cube)
        others = np.delete(cube[:, 1:], FIFTH, axis=1)
        others[:, UNIT] += self.softness[number]
        return np.hstack([others, self.tips[number], OF_SHAPE * self.places[number]])


def drawn_cube(number: int, seed: int) -> Points:
    """Rows of the cube, drawn by the prior."""
    return sobol(number, 1 + len(NAMES) - len(SHAPE), seed)


def parameters_at(values: Mapping[str, Sequence[float]] | Values, point: int) -> dict[str, float]:
    """The parameters of one point."""
    return {name: float(samples[point]) for name, samples in values.items()}
