"""Second runs beside a first one: their names and changes.

Workflows import this module to list their jobs: it imports no compiled code.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

# Verdicts of second runs on a peak: whether they lead to another motion. None says it is steady.
ONE_MOTION, TWO_MOTIONS, CHAOTIC = "one motion", "two motions", "not predictable"


def same(value: Any) -> Any:
    """The thing itself."""
    return value


class Neighbour(NamedTuple):
    """Changes of a second run; each is the identity where nothing changes."""

    name: str
    scene: Callable = same  # Scene -> Scene
    rom: Callable = same  # Rom -> Rom: a model made from that of the run
    setup: Callable = same  # Setup -> Setup
    blade: Callable | None = None  # Blade -> Blade: its reduced model has to be made
    steps: float = 1  # times the steps per revolution
    along: bool = False  # at the same speed over f1(0) of the other model, not in rad/s
    cost: float = 1.0  # of the run, over that of the first
    remeshed: bool = False  # the blade needs another mesh
