"""CPU time of whole commands in two states of the project, in turn on one machine, and its ratio.

    ./run python tests/benchmarks/states.py main       # the checkout beside that commit
    ./run python tests/benchmarks/states.py v0.2.0 main   # two commits

Each state is exported to a folder of its own and runs with this environment. The first turn
compiles, and the best of the others counts, so that a busy machine troubles both alike. The lines
are added to states.csv beside this file: commit what a release or a faster kernel gained. Two equal
states differ by a tenth; it takes some ten minutes.
"""

import argparse
import csv
import io
import os
import resource
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from datetime import date
from math import nan
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".csv")
HEADS = ("date", "command", "before", "after", "CPU s before", "CPU s after", "ratio")
TURNS = 7  # of one state they differ by half
SCENES = {  # of the first coating at 40 speeds, by the words in the table
    "sweep": "verify: {predictable: false}",
    "sweep without checks": "verify: {share: 0, predictable: false}",
    "sweep with central differences": "integrator: {scheme: central-difference, "
    "fraction_of_limit: 0.8}\nrounds: 6\nrecord: {spectrum_rounds: 4}\n"
    "verify: {share: 0, predictable: false}",
}
SCENE = """base: paper-e1
blade: reference
speeds: {{over_f1: {{first: 0.12, last: 0.38, count: 40}}}}
peaks: null
{}
"""
MODEL = "results/reference/rom-r.nc"
# A design of 200 rows of one speed, as a job marches it: in the states of both of its interfaces
DESIGN = """
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from rom.model import Rom
model, folder = sys.argv[1], Path(sys.argv[2])
rows = "".join(f"{0.1 + k / 200}\\n" for k in range(200))
(folder / "table.csv").write_text("liner.law.K\\n" + rows)
scene = (folder / "sweep.yaml").read_text() + "design: table.csv\\nrounds: 2\\n"
scene += "record: {spectrum_rounds: 1}\\n"
(folder / "rows.yaml").write_text(scene.replace("count: 40", "count: 2"))
rom = Rom.load(model)
with TemporaryDirectory() as kept:
    try:
        from workflow.many.design import Design
        from workflow.many.design_tables import tables
        from workflow.many.engine import march_block
        design = Design.load(folder / "rows.yaml")
        block = march_block(design.rows(), kept, design.count, models={"reference": rom})
        tables(design, rom, [block], kept)
    except ImportError:  # before there was workflow.many
        from simulate.scene.design import Design
        from simulate.sweeps.design_runs import Engine, march_block, row_table
        engine = Engine.of(Design.load(folder / "rows.yaml"), rom)
        row_table(engine, march_block(engine, kept))
"""


class State:
    """A state of the project in a folder."""

    def __init__(self, name: str, folder: Path) -> None:
        """Export the commit ``name``, or the files of the checkout for ""."""
        self.folder = folder
        # "": what is not committed yet, of files that git knows
        changes = "" if name else _git("stash", "create").decode().strip()
        self.name = _git("rev-parse", "--short", name or "HEAD").decode().strip()
        self.name += " and changes" if changes else ""
        tar = _git("archive", changes or name or "HEAD")
        with tarfile.open(fileobj=io.BytesIO(tar)) as files:
            files.extractall(folder, filter="data")
        for scene, keys in SCENES.items():
            self.scene(scene).write_text(SCENE.format(keys))
        (folder / "design_of_200_rows.py").write_text(DESIGN)

    def scene(self, name: str) -> Path:
        """File of a scene."""
        return self.folder / f"workflow/scenes/{name.replace(' ', '-')}.yaml"

    def commands(self) -> dict[str, list[str]]:
        """Commands by their words in the table; the first makes the model of the others."""
        model = ["snakemake", "--cores", "1", "--quiet", "all", "--forceall", MODEL]
        out = str(self.folder / "out.nc")
        design = ["design_of_200_rows", MODEL, str(self.folder / "workflow/scenes")]
        return (
            {"blade to reduced model": model}
            | {name: ["simulate", MODEL, str(self.scene(name)), "-o", out] for name in SCENES}
            | {"design of 200 rows": design}
        )

    def seconds(self, command: list[str]) -> float:
        """CPU time of a module's command in the folder, s; nan where this state refuses it."""
        before = _children()
        environment = os.environ | {"PYTHONPATH": str(self.folder), "OMP_NUM_THREADS": "1"}
        done = subprocess.run(
            [sys.executable, "-m", *command],
            cwd=self.folder,
            env=environment,
            capture_output=True,
            text=True,
        )
        if done.returncode:
            print(f"{self.name}: {' '.join(command)}: {done.stderr or done.stdout}")
        return nan if done.returncode else _children() - before


def _git(*arguments: str) -> bytes:
    return subprocess.check_output(["git", *arguments], cwd=ROOT)


def _children() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def compared(before: State, after: State) -> Iterator[tuple[str, float, float]]:
    """Name of each command with its best CPU times before and after, s."""
    for name in before.commands():
        turns = 1 if name == "blade to reduced model" else TURNS
        pairs = [
            [state.seconds(state.commands()[name]) for state in (before, after)]
            for _ in range(turns)
        ]
        yield name, *map(min, zip(*pairs[turns > 1 :], strict=True))


def main() -> None:
    """Compare the states that are named, print and keep the lines."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", help="commit")
    parser.add_argument("after", nargs="?", default="", help="commit; without: the checkout")
    names = vars(parser.parse_args())
    with TemporaryDirectory() as folder:
        states = [State(name, Path(folder, at)) for at, name in names.items()]
        rows = []
        for command, *seconds in compared(*states):
            cells = [f"{of:.2f}" for of in (*seconds, seconds[1] / seconds[0])]
            of_states = (state.name for state in states)
            rows.append([date.today().isoformat(), command, *of_states, *cells])
            print(*(f"{cell:>12}" for cell in cells), command)
    new = not KEPT.exists()
    with KEPT.open("a", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([HEADS] * new + rows)


if __name__ == "__main__":
    main()
