"""``./run check SCENE``: what a scene's result at its peaks depends on, as a table.

At each reported peak of its sweep the run is marched again with half the step, twice the strips, on
a reduced model with twice the patches, and on that of a mesh finer by the square root of two.
"""

import csv
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from math import pi, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, NamedTuple

from geometry.blade import Blade
from geometry.given import read_blade
from geometry.project import (
    SettingsError,
    UserError,
    duration,
    read_settings,
    write_whole,
    yaml_file,
)
from rom.model import Rom
from simulate.marching.run import march
from simulate.marching.setup import check_scene, prepare
from simulate.scene import Scene
from simulate.sweeps.at_peaks import Numbers, asked, numbers_of, to_march
from simulate.sweeps.cost import cost
from simulate.sweeps.dataset import load, require_rom
from workflow import markdown
from workflow.summary import COLUMNS, Column

FINER = sqrt(2)  # element size of the mesh over that of the finer one
DEARER = 4.0  # matrices and modes on that mesh, 2.8 times the nodes
LEAST = 0.01  # percent: changes below it are shown as none
MODEL_JOBS = ("mesh", "assemble", "reduce-{}")  # whose times say what another model costs

type Say = Callable[[str], None]


class Change(NamedTuple):
    """Something that the result may depend on."""

    name: str
    scene: Callable[[Scene], Scene]
    blade: Callable[[Blade], Blade] | None  # None where the model stays


def _same(scene: Scene) -> Scene:
    return scene


def half_the_step(scene: Scene) -> Scene:
    """The scene with twice as many steps, and twice the rods, which go with them."""
    given, rods = scene.integrator.steps_per_round, 2 * scene.liner.rods_per_round + 1
    if given is None:
        fraction = scene.integrator.fraction_of_limit / 2
        return scene.but(integrator={"fraction_of_limit": fraction}, liner__rods_per_round=rods)
    return scene.but(integrator={"steps_per_round": 2 * given}, liner__rods_per_round=rods)


CHANGES = (
    Change("half the step, twice the rods", half_the_step, None),
    Change("twice the strips", lambda scene: scene.but(liner__strips=2 * scene.liner.m), None),
    Change(
        "twice the patches",
        _same,
        lambda blade: blade.but(interface__patches=2 * blade.interface.patches),
    ),
    Change(
        "mesh finer by 1.41",
        _same,
        lambda blade: blade.but(mesh__element_size_mm=blade.mesh.element_size_mm / FINER),
    ),
)


class Case(NamedTuple):
    """A scene with its blade, its model, and the peaks of its sweep."""

    name: str
    folder: Path  # of its results
    scene: Scene
    blade: Blade
    rom: Rom
    peaks: list[tuple[int | None, float]]  # engine order, and speed over f1(0)

    @classmethod
    def read(cls, name: str) -> "Case":
        """Read the files of a scene that has been run.

        Raises
        ------
        geometry.project.errors.UserError
            When it has not, or its model is another one now.
        """
        if name not in yaml_file.names("workflow/scenes"):
            raise SettingsError(f"no workflow/scenes/{name}.yaml", key=name)
        scene = read_settings(Scene, f"workflow/scenes/{name}.yaml")
        folder = Path("results", scene.blade, name)
        if not (folder / "sweep.nc").is_file():
            raise SettingsError(
                f"no result yet: ./run snakemake {folder}/sweep.nc, then check it", key=name
            )
        runs = load(folder / "sweep.nc")
        rom = Rom.load(folder.parent / f"rom-{scene.directions}.nc")
        require_rom(runs, rom)
        speeds = runs["speed_over_f1"].values
        peaks = [(k, float(speeds[index])) for k, index, _ in asked(runs, rom)]
        blade = read_blade(f"workflow/blades/{scene.blade}.yaml")
        if not isinstance(blade, Blade):
            raise SettingsError(f"blade {scene.blade} is from elsewhere: it has no mesh", key=name)
        return cls(name, folder, to_march(runs, None), blade, rom, peaks)

    def omega(self, rom: Rom, over_f1: float) -> float:
        """Speed of a peak on a model, rad/s: over its f1(0) where the scene gives speeds so."""
        of = rom if self.scene.speeds.over_f1 is not None else self.rom
        return min(2 * pi * of.f1 * over_f1, rom.Omega_m)


def expected(case: Case) -> float:
    """Time that the check will take, s: its runs, and the models that it makes."""
    marches = cost(case.scene, case.rom, len(case.peaks)).seconds * (1 + 4 + 2 + 1.5 + 1)
    jobs = [job.format(case.scene.directions) for job in MODEL_JOBS]
    seconds = [_seconds(case.folder.parent / "benchmarks" / f"{job}.tsv") for job in jobs]
    patches, mesh = sum(seconds[1:]), DEARER * sum(seconds) if case.blade.mesh else 0.0
    return marches + (0.0 if case.blade.of_points else patches) + mesh


def _seconds(benchmark: Path) -> float:
    """Time of a job, s; 0 where it is not known.

    Of a job that had to wait for others the wall time says too much. Its CPU time is sampled, and
    lacks what came after the last sample: twice as much is an upper bound in practice.
    """
    if not benchmark.is_file():
        return 0.0
    (row,) = list(csv.DictReader(benchmark.read_text().splitlines(), delimiter="\t"))[-1:]
    wall, cpu = float(row["s"]), row["cpu_time"].replace(".", "", 1)
    return min(wall, 2 * float(row["cpu_time"])) if cpu.isdigit() and int(cpu) else wall


def checked(case: Case, say: Say) -> Iterator[tuple[str, list[dict[str, Any]] | str]]:
    """Each change with its numbers at the peaks, or why it is not possible; first the own ones."""
    own = [_numbers(case, case.rom, case.scene, k, at) for k, at in case.peaks]
    yield "as it is", own
    for changed in CHANGES:
        say(f"{changed.name} ...")
        try:
            rom = _model(case, changed) if changed.blade else case.rom
            scene = changed.scene(case.scene)
            check_scene(scene, rom)
            yield changed.name, [_numbers(case, rom, scene, k, at) for k, at in case.peaks]
        except UserError as error:
            yield changed.name, str(error).splitlines()[0]


def _numbers(case: Case, rom: Rom, scene: Scene, k: int | None, at: float) -> Numbers:
    setup = prepare(scene, rom, case.omega(rom, at))
    return numbers_of(scene, rom, setup, march(scene, setup), k)


def _model(case: Case, changed: Change) -> Rom:
    """The reduced model of the changed blade; its mesh is not kept."""
    from rom.reduce import reduce
    from workflow.jobs.full_model import assembled

    if case.blade.of_points:
        raise SettingsError("basis paper: its interface has points, which stay")
    if case.blade.mesh is None and "mesh" in changed.name:
        raise SettingsError(
            "a finer mesh is one of your own: give it as another blade", key="mesh_file"
        )
    blade, source = changed.blade(case.blade), case.blade.file
    name, source = case.scene.blade, source and Path("workflow/blades", source)
    with TemporaryDirectory() as folder, _silent():
        mesh = case.folder.parent / "blade.msh"
        if blade.mesh != case.blade.mesh:
            from geometry.mesh import build_mesh

            mesh = Path(folder, "blade.msh")
            build_mesh(blade, mesh, source)
        fom = assembled(blade, name, mesh)
        return reduce(fom, blade.basis, case.scene.directions)[0]


@contextmanager
def _silent() -> Iterator[None]:
    """Without what gmsh writes on reading a mesh."""
    sys.stdout.flush()
    outside = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(outside, 1)
            os.close(outside)


def table(case: Case, found: Mapping[str, list[Numbers] | str]) -> str:
    """Markdown: for each peak a row for each change, with the change of each number in percent.

    Numbers that no peak has are left out.
    """
    own = found["as it is"]
    columns = [c for c in COLUMNS if any(c.name in numbers for numbers in own)]
    rows = []
    for at, (k, over_f1) in enumerate(case.peaks):
        rpm = 60 * case.rom.f1 * over_f1
        where = f"k = {k}, {rpm:.0f} rpm" if k else f"{rpm:.0f} rpm"
        for name, numbers in found.items():
            if isinstance(numbers, str):
                cells = [numbers]
            elif name == "as it is":
                cells = [_number(own[at], column) for column in columns]
            else:
                cells = [_changed(own[at], numbers[at], column) for column in columns]
            rows.append([where, name, *cells, *[""] * (len(columns) - len(cells))])
    return markdown.table(["peak", "changed", *(column.head for column in columns)], rows)


def _number(numbers: Numbers, column: Column) -> str:
    return f"{column.scale * numbers[column.name]:.3g}" if column.name in numbers else "-"


def _changed(own: Numbers, numbers: Numbers, column: Column) -> str:
    """How much a number has changed, over its own."""
    if not numbers:
        return "no result"
    if not own.get(column.name) or column.name not in numbers:
        return "-"
    percent = 100 * (numbers[column.name] / own[column.name] - 1)
    shown = markdown.two_digits(abs(percent)) if abs(percent) >= LEAST else "0"
    return f"{'-' if percent < 0 else '+'}{shown}%"


def check(name: str, say: Say = print) -> str:
    """Check a scene: says its cost, then what it does; return the table, kept as ``check.md``."""
    case, start = Case.read(name), perf_counter()
    say(
        f"{name}: {len(case.peaks)} speeds, {len(CHANGES)} changes: some "
        f"{duration(expected(case))} on one core (Ctrl-C stops it, nothing is lost)"
    )
    text = table(case, dict(checked(case, say)))
    write_whole(f"# What scene {name} depends on\n\n{text}\n", case.folder / "check.md")
    say(f"{duration(perf_counter() - start)}; {case.folder}/check.md")
    return text


def main(arguments: list[str]) -> int:
    """Run the command line; return the exit code, 2 for unusable input."""
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        print(check(arguments[0]))
    except UserError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
