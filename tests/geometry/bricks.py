"""A structured mesh of a blade given by parameters: bricks, or wedges, of first or second order."""

import numpy as np
from blades import on_tip

from geometry.blade import Sections
from geometry.split import KINDS

ENDS = {"root": 0, "tip": 1}


class Bricks:
    """Cells between the nodes of a grid of twice as many intervals, whose odd nodes are middles."""

    def __init__(self, sections: Sections, along: int, across: int, up: int) -> None:
        self.shape = 2 * along + 1, 2 * across + 1, 2 * up + 1
        grids = np.meshgrid(*(np.linspace(0, 1, n) for n in self.shape), indexing="ij")
        at = np.stack(grids, axis=-1).reshape(-1, 3)
        hub, span = sections.hub_radius, sections.span
        places = [on_tip(sections, xi, 2 * s - 1, hub + share * span) for xi, s, share in at]
        self.points = 1e3 * np.array(places)
        self.first = np.stack(
            np.meshgrid(*(np.arange(0, n - 1, 2) for n in self.shape), indexing="ij"), axis=-1
        ).reshape(-1, 3)

    def nodes(
        self, kind: str, corners: list[tuple[int, int, int]], second_order: bool
    ) -> np.ndarray:
        """Nodes (m, k) of cells with ``corners`` at 0 or 2 from the first of each brick."""
        own = np.array(corners)
        if second_order:
            own = np.vstack([own, own[KINDS[kind].edges].sum(axis=1) // 2])
        at = self.first[:, None] + own
        return np.ravel_multi_index(tuple(np.moveaxis(at, -1, 0)), self.shape)

    def cells(self, kind: str, second_order: bool = True) -> np.ndarray:
        """Bricks, or two wedges for each, cut along the chord and across."""
        a, b, c, d = (0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)

        def raised(*corners):
            return [*corners, *((i, j, 2) for i, j, _ in corners)]

        if kind == "hexahedron":
            return self.nodes(kind, raised(a, b, c, d), second_order)
        both = [self.nodes(kind, raised(*of), second_order) for of in ((a, b, c), (a, c, d))]
        return np.stack(both, axis=1).reshape(2 * len(self.first), -1)

    def on(self, share: int, cells: np.ndarray) -> np.ndarray:
        """Nodes of ``cells`` at the root (0) or the tip (1)."""
        every = np.arange(len(self.points)).reshape(self.shape)
        return np.intersect1d(every[:, :, -share], cells)

    def parts(
        self, kind: str, second_order: bool = True
    ) -> tuple[np.ndarray, np.ndarray, dict[str, np.ndarray]]:
        """Points, mm, cells, and nodes of root and tip; without other nodes."""
        cells = self.cells(kind, second_order)
        used, own = np.unique(cells, return_inverse=True)
        groups = {name: np.searchsorted(used, self.on(i, cells)) for name, i in ENDS.items()}
        return self.points[used], own.reshape(cells.shape), groups

    def faces(self, kind: str, second_order: bool) -> dict[str, list[list[int]]]:
        """Corners of the faces of cells at the root and the tip."""
        cells = self.cells(kind, second_order)
        found = {}
        for name, share in ENDS.items():
            inside = set(self.on(share, cells).tolist())
            found[name] = [
                face
                for cell in cells.tolist()
                for places in KINDS[kind].faces
                if inside.issuperset(face := [cell[i] for i in places])
            ]
        return found
