"""CalculiX (`ccx`, Debian's calculix-ccx) on given cells: frequencies, deflection, matrices."""

import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from geometry.blade import Material

CCX = shutil.which("ccx")
COUNT = 10
A_LINE = 16  # numbers that ccx reads of a line
# residual and correction at which an equilibrium is found: with those of ccx, 5e-3 and 1e-2,
# frequencies of a blade that untwists by a degree are 1e-4 off
CONTROLS = ("*CONTROLS, PARAMETERS=FIELD", "1e-8, 1e-8")


class Cells(NamedTuple):
    """A mesh clamped at its root; every point belongs to a cell."""

    kind: str  # as C3D20
    points: NDArray  # (n, 3), m
    nodes: NDArray  # (m, k), in VTK's order, which is that of Abaqus
    root: NDArray  # nodes


class Found(NamedTuple):
    """Frequencies (COUNT,), Hz, to seven digits, and the CPU time that ccx took, s."""

    frequencies: NDArray
    seconds: float


def version() -> str:
    """Version of the program."""
    return subprocess.run([CCX, "-v"], capture_output=True, text=True).stdout.split()[-1]


def frequencies(cells: Cells, material: Material, speed: float = 0.0) -> Found:
    """Lowest frequencies about the equilibrium at a speed (rad/s) about the z axis; one thread."""
    before = _children()
    log, result = _result(cells, material, _steps(speed, "*FREQUENCY"))
    # number, eigenvalue, rad/s, Hz, imaginary
    found = [row[3] for row in _rows(result, 5)]
    if len(found) < COUNT:
        raise RuntimeError(f"ccx found {len(found)} of {COUNT} frequencies:\n{log}")
    return Found(np.array(found[:COUNT]), _children() - before)


def deflection(cells: Cells, material: Material, speed: float) -> NDArray[np.float64]:
    """Displacement (n, 3), m, of the points at the equilibrium at a speed (rad/s)."""
    steps = (*_equilibrium(speed), "*NODE PRINT, NSET=ALL", "U", "*END STEP")
    log, result = _result(cells, material, iter(steps))
    rows = _rows(result, 4)  # node, x, y, z
    if len(rows) != len(cells.points):
        raise RuntimeError(f"ccx moved {len(rows)} of {len(cells.points)} points:\n{log}")
    return np.array(rows)[:, 1:]


def matrices(cells: Cells, material: Material, speed: float, job: Path) -> None:
    """M and K at a speed (rad/s) in the files of a ``job``, with suffixes .mas, .sti and .dof."""
    log = _run(job, cells, material, _steps(speed, "*FREQUENCY, SOLVER=MATRIXSTORAGE"))
    if not job.with_suffix(".sti").exists():
        raise RuntimeError(f"ccx wrote no matrices:\n{log}")


def _result(cells: Cells, material: Material, steps: Iterator[str]) -> tuple[str, str]:
    """End of the log of a job, and what it printed."""
    with TemporaryDirectory() as folder:
        job = Path(folder) / "blade"
        log = _run(job, cells, material, steps)
        result = job.with_suffix(".dat")
        return log, result.read_text() if result.exists() else ""


def _run(job: Path, cells: Cells, material: Material, steps: Iterator[str]) -> str:
    """Write the deck of a job and run it; the end of its log."""
    lines = [*_mesh(cells), *_material(material), *steps, ""]
    job.with_suffix(".inp").write_text("\n".join(lines))
    log = subprocess.run(
        [CCX, "-i", job.name],
        cwd=job.parent,
        env={"OMP_NUM_THREADS": "1"},
        capture_output=True,
        text=True,
    )
    return log.stdout[-2000:]


def _children() -> float:
    """CPU time of the processes that have ended, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def _mesh(cells: Cells) -> Iterator[str]:
    yield "*NODE, NSET=ALL"
    for number, point in enumerate(cells.points, 1):
        # of a number 20 characters are read: without its exponent if it is longer
        yield ", ".join([str(number), *(f"{x:.12e}" for x in point)])
    yield f"*ELEMENT, TYPE={cells.kind}, ELSET=BLADE"
    for number, nodes in enumerate((cells.nodes + 1).tolist(), 1):
        row = [number, *nodes]
        lines = [row[i : i + A_LINE] for i in range(0, len(row), A_LINE)]
        yield ",\n".join(", ".join(map(str, line)) for line in lines)
    yield "*NSET, NSET=ROOT"
    yield from (f"{node + 1}," for node in cells.root.tolist())
    yield from ("*BOUNDARY", "ROOT, 1, 3")


def _material(material: Material) -> Iterator[str]:
    yield from ("*MATERIAL, NAME=METAL", "*ELASTIC")
    yield f"{material.young_modulus:.12e}, {material.poisson_ratio}"
    yield from ("*DENSITY", f"{material.density_kg_m3}")
    yield "*SOLID SECTION, ELSET=BLADE, MATERIAL=METAL"


def _steps(speed: float, frequency: str) -> Iterator[str]:
    """At a speed the nonlinear equilibrium, and modes about it with its stress and its load."""
    modes = [frequency, str(COUNT), "*END STEP"]
    if not speed:
        yield from ("*STEP", *modes)
        return
    yield from (*_equilibrium(speed), "*END STEP", "*STEP, PERTURBATION", *modes)


def _equilibrium(speed: float) -> Iterator[str]:
    """Static step, not yet ended."""
    yield from ("*STEP, NLGEOM", *CONTROLS, "*STATIC", "*DLOAD")
    yield f"BLADE, CENTRIF, {speed**2:.12e}, 0, 0, 0, 0, 0, 1"


def _rows(result: str, columns: int) -> list[list[float]]:
    """Rows of the tables of so many columns that ccx writes, the first an integer."""
    rows = [line.split() for line in result.splitlines()]
    return [[*map(float, row)] for row in rows if len(row) == columns and row[0].isdigit()]
