"""Contact at every node of the tip: a reference for patches, strips, and rows across the thickness.

All nodes of the tip are the interface of a reduced model of their own. Over each strip it is
sampled by the shape functions of the facets at places across the thickness, at equal z, both edges
among them; between these the tip is linear. All places of a strip wear its one row of the liner
within the step. The march is that of the tests' independent program, in plain NumPy.

    ./run snakemake results/paper/matrices.h5
    ./run python -m tests.verification.nodes

compares patches with it on blade `paper`, and keeps the medians in ``KEPT``, from which the page of
``fem`` has them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import identity

from fem.interface_operator import at_places, interface_of
from fem.matrices import Matrices
from fem.solid import Solid, read_solid
from geometry.base import csv_text, write_whole
from geometry.blade import Blade
from geometry.hats import middles
from geometry.interface import on_facets, tip_of
from geometry.tip import cartesian, on_line
from rom.model import Rom
from rom.reduce import reduce
from simulate.contact.places import by_share, volume_of
from simulate.errors.observables import error
from simulate.marching import march, prepare
from simulate.scene import LEADING, Scene
from simulate.signals import on_rods
from tests.simulate.peer import piecewise_exact
from workflow.markdown import percent

STRIPS = 16  # of the reference
PLACES = 7  # across the thickness
RODS = 4  # times those of the scene
OVER_F1 = {  # speeds; of paper-e10 those of the peak of EO 4
    "paper-e1": (0.325, 0.33, 0.335, 0.34, 0.345, 0.35),
    "paper-e10": (0.355, 0.362, 0.37, 0.374, 0.378, 0.382, 0.39, 0.398),
}
HEAD = (
    *("scene", "rows across", "patches, strips", "speeds"),
    *("deepest wear", "volume", "amplitude", "wear, place by place"),
)
KEPT, COMMAND = "workflow/study/kept/nodes.csv", "./run python -m tests.verification.nodes"
MODELS = tuple((patches, across) for across in (1, 2) for patches in (8, 16, 32))


class Reference(NamedTuple):
    """A model whose interface is every node of the tip, and its places over strips."""

    rom: Rom
    P: NDArray[np.float64]  # (places, strips, n), their radial displacements
    leading: NDArray[np.float64]  # (1, n), at xi = 1/16, in the middle of the thickness
    sides: NDArray[np.float64]  # (2, strips), rad, angles of the edges


class Row(NamedTuple):
    """Relative differences of patches from every node of the tip, in a scene at a speed."""

    scene: str
    across: int
    patches: int
    nodes: int
    deepest: float
    volume: float
    amplitude: float
    wear: float  # in L2, place by place


class Result(NamedTuple):
    """Outputs that are compared."""

    deepest: float  # m, worn depth
    wear: NDArray[np.float64]  # (eighths of the chord, rods), m
    volume: float  # m3
    amplitude: float  # m, of xi = 1/16 in the last revolution


def compared(
    blade: Blade, matrices: str | Path, mesh: str | Path, scenes: Mapping[str, Scene]
) -> list[Row]:
    """Errors of patches in one row and two across the thickness against contact at every node.

    For a blade with its matrices and mesh, in ``scenes`` at ``OVER_F1``; strips are as many as
    patches. The tip rubs the arc that it covers in all.
    """
    fom, rows = Matrices.load(matrices), []
    solid = read_solid(str(mesh), blade.material)
    of_nodes = reference(blade, fom, solid)
    models = {model: of_patches(blade, fom, solid, *model) for model in MODELS}
    for name, scene in scenes.items():
        record = {"samples_per_round": scene.record.samples_per_round}
        case = scene.but(
            record=record, peaks=None, verify={"predictable": False}, liner__footprint_mm=None
        )
        for over_f1 in OVER_F1[name]:
            true = by_nodes(case, of_nodes, over_f1)
            for (patches, across), rom in models.items():
                found = by_patches(case.but(liner__strips=patches), rom, over_f1)
                changes = _changes(found, true)
                rows.append(Row(name, across, patches, len(of_nodes.rom.xi), *changes))
    return rows


def reference(blade: Blade, fom: Matrices, solid: Solid) -> Reference:
    """The model of all nodes of the tip, and its places over ``STRIPS`` strips."""
    points, used = solid.V.tabulate_dof_coordinates(), np.unique(solid.tip)
    tip = tip_of(solid.tip, points)
    S = at_places(identity(len(points), format="csr")[used], points[used], solid.free)
    rom, _ = reduce(replace(fom, S=S, xi=tip.xi(points[used])), blade.basis, "r")
    line = on_line(fom.camber, np.append(middles(STRIPS), LEADING))
    behind, ahead = tip.at_z(line[:, 2])
    theta = np.linspace(behind, ahead, PLACES)
    places = [cartesian(np.column_stack([line[:, 0], at, line[:, 2]])) for at in theta]
    nodes, values, _ = on_facets(points, solid.tip, tip, np.concatenate(places))
    rows = np.zeros((len(nodes), rom.n))
    np.put_along_axis(rows, np.searchsorted(used, nodes), values, axis=1)
    rows = rows.reshape(PLACES, -1, rom.n)
    sides = np.stack([behind, ahead])
    return Reference(rom, rows[:, :-1], rows[PLACES // 2, -1:], sides[:, :-1])


def of_patches(blade: Blade, fom: Matrices, solid: Solid, patches: int, across: int) -> Rom:
    """The model of so many patches, with one row or two across the thickness."""
    of = interface_of(solid, blade.but(interface={"patches": patches, "across": across}))
    return reduce(replace(fom, **vars(of)), blade.basis, "r")[0]


def by_nodes(scene: Scene, of: Reference, over_f1: float) -> Result:
    """March the scene with contact at every node."""
    nu = RODS * (scene.liner.nu + 1) - 1
    fine = scene.but(liner__strips=STRIPS, liner__rods_per_round=nu)
    Omega, steps = over_f1 * of.rom.omega1, fine.stepping.steps_per_round
    count = steps * fine.rounds
    there = piecewise_exact(of.rom, fine, Omega, steps, count, of.P, of.leading, of.sides)
    return _result(of.rom, fine, there.wear, there.out)


def by_patches(scene: Scene, rom: Rom, over_f1: float) -> Result:
    """March the scene on patches."""
    outcome = march(scene, prepare(scene, rom, over_f1 * rom.omega1))
    return _result(rom, scene, outcome.wear, outcome.u_r[-scene.record.samples_per_round :])


def _result(rom: Rom, scene: Scene, wear: NDArray[np.float64], u_r: NDArray[np.float64]) -> Result:
    ends = np.linspace(0, 1, len(wear) + 1)
    line = rom.line(ends)
    widths, radius = np.diff(line[:, 2]), rom.line(middles(len(wear)))[:, 0]
    volume = float(volume_of(wear.mean(axis=1), widths, radius))
    return Result(float(wear.max()), by_share(wear, ends), volume, float(np.ptp(u_r)) / 2)


def _changes(found: Result, true: Result) -> tuple[float, float, float, float]:
    """Relative differences; of wear the error in L2."""
    wear = on_rods(found.wear, true.wear.shape[1])
    return (
        found.deepest / true.deepest - 1,
        found.volume / true.volume - 1,
        found.amplitude / true.amplitude - 1,
        error(wear, true.wear),
    )


def table(rows: Sequence[Row]) -> list[list[str]]:
    """The table of the page: medians over the speeds."""
    models = dict.fromkeys(row[:3] for row in rows)
    of = {model: [row[4:] for row in rows if row[:3] == model] for model in models}
    return [
        [*map(str, model), str(len(at)), *map(percent, np.median(np.abs(at), axis=0).tolist())]
        for model, at in of.items()
    ]


def main() -> None:
    """Compare on blade `paper`, and keep the table."""
    scenes = {name: Scene.load(f"workflow/scenes/{name}.yaml") for name in OVER_F1}
    blade, results = Blade.load("workflow/blades/paper.yaml"), Path("results/paper")
    rows = compared(blade, results / "matrices.h5", results / "blade.msh", scenes)
    write_whole(f"# {COMMAND}\n{csv_text([HEAD, *table(rows)])}", KEPT)


if __name__ == "__main__":
    main()
