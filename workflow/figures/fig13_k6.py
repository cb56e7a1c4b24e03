"""Fig. 13 for the peak k = 6."""

from typing import Any

from workflow.figures.grid import Grid
from workflow.figures.grid_map import draw

__all__ = ["draw", "load"]


def load(files: Any) -> tuple[Grid, int]:
    """Read the cases, ``files.grid``."""
    return Grid.read(files.grid), 6
