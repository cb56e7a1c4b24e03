"""Types of values in files of results. Light: Snakemake imports the summary, which has them."""

from typing import TypedDict


class Course(TypedDict, total=False):
    """How a run went on to its end; of one that ended early the trend alone."""

    trend: str  # whether the motion is steady
    time_constant: float  # revolutions, in which the mode that responds dies out to 1/e
    largest_round: float  # number of the revolution of the largest displacement
    wears: float  # m3 in a revolution, mean of the last quarter
    place: float  # xi of the motion that is told, on a casing that tapers


class CriticalSpeed(TypedDict):
    """Crossing of a mode with an engine order, or a rub peak along one."""

    what: str  # in words
    mode: int | None  # None of a rub peak
    k: int  # engine order
    rpm: float
    quadratic_rpm: float | None  # where f^2 goes on as a quadratic; None of a rub peak
    bound: bool  # whether it is at an end of a sweep, and may lie beyond
