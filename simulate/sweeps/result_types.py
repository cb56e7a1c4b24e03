"""Types of values in files of results. Light: Snakemake imports the summary, which has them."""

from collections.abc import Sequence
from statistics import median
from typing import NamedTuple, Self, TypedDict

NO_CROSSING = "no linear crossing explains it"


def order_name(k: float | None) -> str:
    """Engine order ``k``, or f / Omega of a line on no integer order; empty without one.

    >>> order_name(4), order_name(3.4)
    ('EO 4', 'f/Ω 3.4')
    """
    return "" if k is None else f"EO {k:g}" if k % 1 == 0 else f"f/Ω {k:.3g}"


def numbers_of(modes: Sequence[int]) -> str:
    """One mode, or those of which it may be; empty where none is known.

    >>> numbers_of([1]), numbers_of([2, 3])
    ('1', '2 or 3')
    """
    return " or ".join(map(str, modes))


def mode_name(modes: Sequence[int]) -> str:
    """The same with the word; empty where none is known."""
    return f"mode {numbers_of(modes)}" if modes else ""


class Course(TypedDict, total=False):
    """How a run went on to its end; of one that ended early the trend alone."""

    trend: str  # whether the motion is steady
    rounds: float  # revolutions computed
    time_constant: float  # revolutions, in which the mode that responds dies out to 1/e
    largest_round: float  # number of the revolution of the largest displacement
    wears: float  # m3 in a revolution, mean of the last quarter
    grows: float  # share by which a growing swing rises in ``grows_in`` revolutions more
    grows_in: int
    place: float  # xi of the motion that is told, on a casing that tapers


class OfBlades(TypedDict):
    """Numbers of each blade of a stage in one run."""

    worst: int  # its number
    rub: Sequence[int]  # those that touch the casing
    longer: Sequence[float]  # m, of each
    frequencies: Sequence[float]  # relative changes of each
    numbers: dict[str, Sequence[float]]  # of each, by the name of the number


class Spread(NamedTuple):
    """A number over the blades: of the blade that has most, of half of them, of that with least."""

    most: float
    of_most: int  # number of that blade
    median: float
    least: float
    of_least: int

    @classmethod
    def of(cls, values: Sequence[float]) -> Self:
        """Spread of the ``values`` of all blades.

        >>> Spread.of([2.0, 5.0, 1.0, 4.0])
        Spread(most=5.0, of_most=1, median=3.0, least=1.0, of_least=2)
        """
        ends = [(end(values), values.index(end(values))) for end in (max, min)]
        return cls(*ends[0], median(values), *ends[1])


class CriticalSpeed(TypedDict):
    """Crossing of a mode with an engine order, or a rub peak along one."""

    what: str  # in words
    modes: Sequence[int]  # of a rub peak those of which it may be; none: no crossing explains it
    k: float  # engine order, or f / Omega
    rpm: float
    quadratic_rpm: float | None  # where f^2 goes on as a quadratic; None of a rub peak
    bound: bool  # whether it is at an end of a sweep, and may lie beyond
