"""Frequencies of bricks and wedges, for geometry/README.md: ./run python tests/fem/bricks_table.py.

Writes bricks.json beside this file, in some minutes. It needs CalculiX (`ccx`).
"""

import sys
import warnings
from collections.abc import Iterator, Sequence
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.with_name("geometry"))]

import calculix  # noqa: E402
import exports  # noqa: E402
import numpy as np  # noqa: E402
from bricks import Bricks  # noqa: E402

from fem.assemble import assemble  # noqa: E402
from geometry.base import ROOT, MeshWarning, check_settings, write_json  # noqa: E402
from geometry.blade import Blade  # noqa: E402
from geometry.mesh import build_mesh  # noqa: E402
from rom.modes import ShiftInvert  # noqa: E402
from workflow.study.mesh_convergence import common_order, limits  # noqa: E402

JSON = HERE / "bricks.json"
SIZES = (2**0.5, 1.0, 0.5**0.5)  # of tetrahedra over the blade's own: the finest of its mesh study
# kinds of Abaqus: how the generator makes them, and the names by which CalculiX takes them
KINDS = {
    "C3D20": ("hexahedron", True, ("C3D20", "C3D20R")),
    "C3D15": ("wedge", True, ("C3D15",)),
    "C3D8": ("hexahedron", False, ("C3D8", "C3D8I")),
}
SECOND_ORDER = ("C3D20", "C3D15")
GRIDS = {  # cells along the chord, across and up, and their kinds
    (10, 1, 20): (*SECOND_ORDER, "C3D8"),
    (20, 2, 40): (*SECOND_ORDER, "C3D8"),
    (40, 2, 80): SECOND_ORDER,
}
PACKAGES = ("dolfinx-solver-real", "gmsh")

type Row = dict[str, Any]


def main() -> None:
    """Compute all rows, and write them with their limit and the versions of what made them."""
    blade = Blade.load(ROOT / "workflow/blades/reference.yaml")
    [*of_bricks(blade, (8, 1, 4), ["C3D20"])]  # compiles the forms before time is taken
    sizes = [blade.mesh.element_size_mm * times for times in SIZES]
    rows = [of_tetrahedra(blade, size) for size in sizes]
    rows += [row for grid, kinds in GRIDS.items() for row in of_bricks(blade, grid, kinds)]
    found = {
        "versions": {"ccx": calculix.version()} | {name: version(name) for name in PACKAGES},
        "speed_rad_s": blade.top_speed,
        "limit_Hz": limit(sizes, rows[: len(sizes)]),
        "rows": rows,
    }
    write_json(found, JSON)


def limit(sizes: list[float], rows: list[Row]) -> list[list[float]]:
    """Richardson's limit of tetrahedra at rest and at speed, Hz, as in the study of the mesh."""
    values = [np.ravel(row["frequencies_Hz"]) for row in rows]
    converged = limits(sizes, values, common_order(sizes, values))
    return converged.reshape(2, -1).round(4).tolist()


def of_tetrahedra(blade: Blade, size: float) -> Row:
    """The blade meshed with elements of a size, mm."""
    values = blade.model_dump(exclude_unset=True) | {"mesh": {"element_size_mm": size}}
    return ours(check_settings(Blade, values, "a size"), f"tetrahedra of {size:.2f} mm")


def of_bricks(blade: Blade, grid: tuple[int, int, int], kinds: Sequence[str]) -> Iterator[Row]:
    """The blade in cells of some kinds on a grid, by both programs."""
    bricks = Bricks(blade.sections, *grid)
    for kind in kinds:
        shape, second_order, names = KINDS[kind]
        points, nodes, groups = bricks.parts(shape, second_order)
        of_file = {"cells": len(nodes), "nodes": len(points)}  # before they are split
        with TemporaryDirectory() as folder:
            file = Path(folder) / "blade.inp"
            exports.write_inp(file, points, nodes, groups, kind)
            yield ours(exports.as_meshed(blade, file.name), kind, file) | of_file
        for name in names:
            yield theirs(blade, calculix.Cells(name, 1e-3 * points, nodes, groups["root"]))


def ours(blade: Blade, kind: str, file: Path | None = None) -> Row:
    """Solve a blade, from its parameters or from the file of its mesh on."""
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", MeshWarning)  # of first order
        mesh = Path(folder) / "blade.msh"
        start = process_time()
        summary = build_mesh(blade, mesh, file)
        at_rest = modes(blade, mesh, 0.0)
        seconds = process_time() - start
        both = [at_rest, modes(blade, mesh, blade.top_speed)]
    return told("Tiprub", kind, summary.cells, summary.nodes, both, seconds)


def modes(blade: Blade, mesh: Path, speed: float) -> np.ndarray:
    """Our frequencies at a speed (rad/s), Hz."""
    matrices = assemble(blade, "table", mesh, [speed])
    found = ShiftInvert(matrices.K[0], matrices.M).modes(calculix.COUNT)
    return found.omega / (2 * np.pi)


def theirs(blade: Blade, cells: calculix.Cells) -> Row:
    """Solve the same cells by CalculiX."""
    at_rest, at_speed = (
        calculix.frequencies(cells, blade.material, speed) for speed in (0.0, blade.top_speed)
    )
    both = [at_rest.frequencies, at_speed.frequencies]
    sizes = len(cells.nodes), len(cells.points)
    return told("CalculiX", cells.kind, *sizes, both, at_rest.seconds)


def told(
    program: str, kind: str, cells: int, nodes: int, frequencies: list[np.ndarray], seconds: float
) -> Row:
    """Frequencies at rest and at speed, Hz, and CPU time of those at rest; prints f1 and it."""
    print(f"{program}, {cells} {kind}: {frequencies[0][0]:.2f} Hz, {seconds:.2f} s", flush=True)
    return {
        "program": program,
        "kind": kind,
        "cells": cells,
        "nodes": nodes,  # of the file
        "solved": nodes,
        "frequencies_Hz": np.round(frequencies, 4).tolist(),
        "cpu_s": round(seconds, 2),
    }


if __name__ == "__main__":
    main()
