"""The reference blade on a coarse mesh: CalculiX's frequencies of the same cells.

Their digits are kept in ``calculix.json``, for machines without `ccx`.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import calculix
import exports
import numpy as np
from blades import given
from bricks_table import modes
from calculix import Cells
from cases import Case, Row
from numpy.typing import NDArray

from geometry.base import ROOT, read_json, write_json
from geometry.blade import Blade, Material
from geometry.mesh import build_mesh

PINS = Path(__file__).with_name("calculix.json")
TOLERANCE = 4e-4  # of curved cells, which CalculiX integrates at four points


def kept[T](name: str, compute: Callable[[], T]) -> T:
    """Digits of CalculiX: as kept, and where not, computed."""
    pins = read_json(PINS)["digits"] if PINS.exists() else {}
    if name not in pins:
        pins[name] = compute()
        write_json({"version": calculix.version(), "digits": pins}, PINS)
    return pins[name]


def theirs(name: str, cells: Cells, material: Material, speeds: Sequence[float]) -> list[list]:
    """Frequencies of CalculiX, Hz, at each speed (rad/s)."""
    return kept(
        name,
        lambda: [calculix.frequencies(cells, material, of).frequencies.tolist() for of in speeds],
    )


def coarse() -> Blade:
    """The reference blade on 768 cells."""
    blade = Blade.load(ROOT / "workflow/blades/reference.yaml")
    return given(blade, mesh={"element_size_mm": 10.0}, interface={"patches": 8, "across": 1})


def cells_of(mesh: Path) -> Cells:
    """Ten-node cells of a mesh of ours."""
    parts = exports.parts(mesh)
    return Cells("C3D10", 1e-3 * parts.points, parts.cells, np.unique(parts.facets["root"]))


def beside(
    speeds: Sequence[float],
    of_calculix: list[list],
    ours: Sequence[NDArray[np.float64]],
    tolerance: float = TOLERANCE,
) -> Iterator[Row]:
    """Frequencies of both at each speed."""
    for speed, *both in zip(speeds, of_calculix, ours, strict=True):
        for mode, (a, b) in enumerate(zip(*both, strict=True), 1):
            yield Row(f"f{mode} at {speed:g} rad/s, Hz", a, float(b), tolerance)


def rows() -> Iterator[Row]:
    """Ten frequencies at rest and at the highest speed."""
    blade = coarse()
    speeds = 0.0, blade.top_speed
    with TemporaryDirectory() as folder:
        mesh = Path(folder) / "blade.msh"
        build_mesh(blade, mesh)
        of_calculix = theirs("reference", cells_of(mesh), blade.material, speeds)
        yield from beside(speeds, of_calculix, [modes(blade, mesh, speed) for speed in speeds])


CASE = Case(
    title="Reference blade (CalculiX)",
    source="CalculiX 2.20 on the cells of our mesh (C3D10), at speed about the equilibrium that it "
    "finds itself; a deck that [a test](fem/calculix.py) writes",
    compared="The reference blade on 768 cells.",
    reason="CalculiX integrates a cell at four points, which is not exact where its sides are "
    "curved.",
    rows=rows,
)
