"""``./run check SCENE``: second runs at the peaks of a scene, also of another mesh, as a table.

At each reported peak of its sweep the run is repeated with all gaps changed by 1e-10, half and a
quarter of the step, twice the rods, twice the strips, on a model with fewer patches and modes and
on one with twice the patches and strips, and on that of a mesh finer by the square root of two.
"""

import sys
from collections.abc import Iterator, Mapping
from math import sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

import xarray as xr

from geometry.base import (
    SettingsError,
    UserError,
    command,
    duration,
    write_whole,
    yaml_file,
)
from geometry.blade import RPM_PER_HZ, Blade
from geometry.elsewhere import read_blade
from rom.coarser import coarser
from rom.model import Rom
from simulate.errors.neighbour import Neighbour
from simulate.errors.neighbours import HALF, ITSELF, QUARTER, TWIN
from simulate.errors.observables import Numbers
from simulate.marching import check_scene
from simulate.scene import Scene
from simulate.sweeps.cost import cost
from simulate.sweeps.dataset import load, require_rom
from simulate.sweeps.peak import Peak
from simulate.sweeps.peak_results import asked, at_peak, case_of, to_march
from workflow import markdown
from workflow.job_cost import cpu_seconds
from workflow.summary import Column, known_columns

FINER = sqrt(2)  # element size of the mesh over that of the finer one
DEARER = 4.0  # matrices and modes on that mesh, 2.8 times the nodes
JOBS = ("mesh", "assemble", "reduce-{}")  # whose times give the cost of another model


def twice_the_strips(scene: Scene) -> Scene:
    """The scene with strips half as long."""
    return scene.but(liner__strips=2 * scene.liner.m)


CHANGES = (
    TWIN,
    HALF,
    QUARTER,
    Neighbour(
        "twice the rods",
        scene=lambda scene: scene.but(liner__rods_per_round=2 * scene.liner.rods_per_round + 1),
        cost=2.0,
    ),
    Neighbour("twice the strips", scene=twice_the_strips, cost=2.0),
    Neighbour("fewer patches and modes", rom=lambda rom: coarser(rom)[0]),
    # a strip's middle meets every other patch where strips do not go with them
    Neighbour(
        "twice the patches and strips",
        scene=lambda scene: scene if scene.liner.m == 1 else twice_the_strips(scene),
        blade=lambda blade: blade.but(interface__patches=2 * blade.interface.patches),
        cost=3.0,
    ),
    Neighbour(
        "mesh finer by 1.41",
        blade=lambda blade: blade.but(mesh__element_size_mm=blade.mesh.element_size_mm / FINER),
        remeshed=True,
    ),
)


class Subject(NamedTuple):
    """A scene with its blade, its model, and the peaks of its sweep."""

    name: str
    folder: Path  # of its results
    scene: Scene
    blade: Blade
    rom: Rom
    runs: xr.Dataset
    peaks: list[Peak]

    @classmethod
    def read(cls, name: str) -> "Subject":
        """Read the files of a scene that has been run.

        Raises
        ------
        geometry.base.errors.UserError
            When it has not, or its model is another one now.
        """
        if name not in yaml_file.names("workflow/scenes"):
            raise SettingsError(
                f"no workflow/scenes/{name}.yaml; of these there are results: "
                + ", ".join(
                    sorted(file.parent.name for file in Path("results").glob("*/*/sweep.nc"))
                ),
                key=name or "SCENE",
            )
        scene = Scene.load(f"workflow/scenes/{name}.yaml")
        folder = Path("results", scene.blade, name)
        if not (folder / "sweep.nc").is_file():
            raise SettingsError(
                "its design makes tables, and no sweep: name a scene without one"
                if scene.design
                else f"no result yet: ./run snakemake {folder}/sweep.nc, then call this again",
                key=name,
            )
        runs = load(folder / "sweep.nc")
        rom = Rom.load(folder.parent / f"rom-{scene.directions}.nc")
        require_rom(runs, rom)
        blade = read_blade(f"workflow/blades/{scene.blade}.yaml")
        if not isinstance(blade, Blade):
            raise SettingsError(f"blade {scene.blade} is from elsewhere: it has no mesh", key=name)
        return cls(name, folder, to_march(runs), blade, rom, runs, asked(runs, rom))

    def at_peaks(self, other: Neighbour) -> list[Numbers]:
        """Numbers of a second run at each peak.

        Raises
        ------
        geometry.base.errors.UserError
            When it is not possible.
        """
        if other.blade:
            model, along = _model(self, other), self.scene.speeds.over_f1 is not None
            other = other._replace(rom=lambda _: model, along=along)
        check_scene(other.scene(self.scene), other.rom(self.rom))
        return [
            at_peak(case_of(self.runs, self.scene, self.rom, peak).neighbour(other), peak)
            for peak in self.peaks
        ]


def expected(subject: Subject) -> float:
    """Time that the check will take, s: its runs, and the models that it makes."""
    runs = sum(run.cost for run in (ITSELF, *CHANGES))
    marches = cost(subject.scene, subject.rom, len(subject.peaks)).seconds * runs
    logs, directions = subject.folder.parent / "logs", subject.scene.directions
    seconds = [cpu_seconds(logs / f"{job.format(directions)}.log") for job in JOBS]
    patches, mesh = sum(seconds[1:]), DEARER * sum(seconds) if subject.blade.mesh else 0.0
    return marches + (0.0 if subject.blade.of_points else patches) + mesh


def checked(subject: Subject) -> Iterator[tuple[str, list[Numbers] | str]]:
    """Each change with its numbers at the peaks, or why it is not possible; unchanged first."""
    yield ITSELF.name, subject.at_peaks(ITSELF)
    for other in CHANGES:
        print(f"{other.name} ...")
        try:
            yield other.name, subject.at_peaks(other)
        except UserError as error:
            yield other.name, str(error).splitlines()[0]


def _model(subject: Subject, changed: Neighbour) -> Rom:
    """The reduced model of the changed blade; its mesh is not kept."""
    from rom.reduce import reduce
    from workflow.jobs.full_model import assembled

    if subject.blade.of_points:
        raise SettingsError("basis paper: its interface has points, which stay")
    if subject.blade.mesh is None and changed.remeshed:
        raise SettingsError(
            "the mesh is a file: give a finer one as another blade", key="mesh_file"
        )
    blade = changed.blade(subject.blade)
    with TemporaryDirectory() as folder:
        mesh = subject.folder.parent / "blade.msh"
        if changed.remeshed:
            from fem.at_rest import build_mesh_at_rest

            mesh = Path(folder, "blade.msh")
            source = blade.file and Path("workflow/blades", blade.file)
            build_mesh_at_rest(blade, mesh, source)
        fom = assembled(blade, subject.scene.blade, mesh)
        return reduce(fom, blade.basis, subject.scene.directions)[0]


def table(subject: Subject, results: Mapping[str, list[Numbers] | str]) -> str:
    """Markdown: for each peak a row for each change, with the change of each number in percent.

    Numbers that no peak has are left out.
    """
    unchanged = results[ITSELF.name]
    columns = known_columns(unchanged)
    rows = []
    for number, peak in enumerate(subject.peaks):
        rpm = f"{RPM_PER_HZ * subject.rom.f1 * peak.Omega_c:.0f} rpm"
        where = ", ".join(filter(None, [peak.name, rpm]))
        for name, result in results.items():
            cells = (
                [result, *[""] * (len(columns) - 1)]
                if isinstance(result, str)
                else [_cell(column, unchanged[number], result[number]) for column in columns]
            )
            rows.append([where, name, *cells])
    return markdown.table(["peak", "changed", *(column.head for column in columns)], rows)


def _cell(column: Column, unchanged: Numbers, result: Numbers) -> str:
    """The number of the run itself; of another one its relative change."""
    if result is unchanged:
        return column.shown(unchanged)
    if not result:
        return "no result"
    if not unchanged.get(column.name) or column.name not in result:
        return "-"
    return markdown.change(result[column.name] / unchanged[column.name] - 1)


@command
def main(arguments: list[str]) -> None:
    """Check a scene: print its cost and progress, and the table, which is kept as ``check.md``."""
    if len(arguments) != 1:
        raise UserError(__doc__)
    subject, start = Subject.read(*arguments), perf_counter()
    print(
        f"{subject.name}: {len(subject.peaks)} speeds, {len(CHANGES)} changes: some "
        f"{duration(expected(subject))} on one core (Ctrl-C stops it, nothing is lost)"
    )
    text = table(subject, dict(checked(subject)))
    path = subject.folder / "check.md"
    write_whole(f"# What scene {subject.name} depends on\n\n{text}\n", path)
    print(f"{duration(perf_counter() - start)}; {path}")
    print(text)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
