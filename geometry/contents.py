"""What a mesh or a STEP file of a blade holds, in its own unit and axes, for its settings."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geometry.cad import StepFile
from geometry.mesh_file import READERS, read_mesh_file

SHOWN = 20  # groups


def contents(path: str | Path) -> list[str]:
    """Cells or faces, box, likely radial axis and groups, a line each; nothing of other files.

    Raises
    ------
    MeshError
        When the file cannot be read.
    """
    suffix = Path(path).suffix.lower()
    if suffix in READERS:
        return _of_mesh(path)
    return _of_step(StepFile(path)) if suffix in (".step", ".stp") else []


def _of_mesh(path: str | Path) -> list[str]:
    mesh = read_mesh_file(path).without_unused()
    sizes = {name: f"{len(nodes)} nodes" for name, nodes in mesh.node_groups.items()}
    sizes |= {name: f"{len(of)} faces" for name, of in mesh.face_groups.items() if len(of)}
    order = "first" if mesh.first_order else "second"
    made = mesh.made or f"{len(mesh.cells)} tetrahedra on {len(mesh.points)} nodes"
    return [f"{made}, of {order} order", *_box(mesh.points), _groups(sizes)]


def _of_step(step: StepFile) -> list[str]:
    names, vertices = zip(*step.faces(), strict=True)
    sizes = {name: f"{count} faces" for name, count in Counter(filter(None, names)).items()}
    unit = f"unit {' and '.join(sorted(step.units)) or 'not declared'}, {len(names)} faces"
    return [unit, *_box(np.concatenate(vertices)), _groups(sizes)]


def _box(points: NDArray[np.float64]) -> list[str]:
    """The box of ``points`` (n, 3), and the axis along which it is farthest from the origin."""
    low, high = points.min(axis=0), points.max(axis=0)
    sides = zip("xyz", low, high, strict=True)
    box = ", ".join(f"{axis} {a:.5g} to {b:.5g}" for axis, a, b in sides)
    most = int(np.argmax(abs(low + high)))
    radial = "-" * bool(low[most] + high[most] < 0) + "xyz"[most]
    others = " or ".join("xyz".replace("xyz"[most], ""))
    return [
        f"box of its points, in its unit: {box}",
        f"axes: radial {radial} (assumed: the box is farthest from 0 there), the engine's {others}",
    ]


def _groups(sizes: Mapping[str, str]) -> str:
    """Names of the groups with their size, the first ones of many."""
    named = [f"{name} ({size})" for name, size in sorted(sizes.items())]
    more = [f"{len(named) - SHOWN} more"] if len(named) > SHOWN else []
    return f"groups: {', '.join(named[:SHOWN] + more) or 'none'}"
