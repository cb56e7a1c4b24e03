"""The interface table beside the mesh: ``interface.csv``, leading edge first.

A physical group of dimension 0 in the mesh file makes DOLFINx 0.11's reader abort, so the nodes are
kept in a table of their own.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.files import whole


@dataclass(frozen=True)
class InterfaceNodes:
    """Interface nodes, i = 1 at the leading edge."""

    points: NDArray[np.float64]  # (nodes, 3), m: x, y, z of mesh nodes on the tip

    @property
    def radius(self) -> NDArray[np.float64]:
        """r_i (nodes,), m."""
        return np.hypot(self.points[:, 0], self.points[:, 1])

    @property
    def theta(self) -> NDArray[np.float64]:
        """theta_i (nodes,), rad."""
        return np.arctan2(self.points[:, 1], self.points[:, 0])

    def save(self, path: str | Path) -> None:
        """Write the table, 17 significant digits so that it reads back bit for bit."""
        with whole(path) as temporary, open(temporary, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["node", "x_m", "y_m", "z_m"])
            for i, point in enumerate(self.points, start=1):
                writer.writerow([i, *(f"{value:.17g}" for value in point)])

    @classmethod
    def load(cls, path: str | Path) -> "InterfaceNodes":
        """Read the table."""
        rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
        return cls(points=rows[:, 1:])
