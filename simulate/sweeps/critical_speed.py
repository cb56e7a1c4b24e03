"""A critical speed, as results in files have it. Nothing is imported: Snakemake reads such rows."""

from typing import TypedDict


class CriticalSpeed(TypedDict):
    """Crossing of a mode with an engine order, or a rub peak along one."""

    what: str  # in words
    mode: int | None  # None of a rub peak
    k: int  # engine order
    rpm: float
    quadratic_rpm: float | None  # where f^2 goes on as a quadratic; None of a rub peak
    bound: bool  # whether it is at an end of a sweep, and may lie beyond
