"""Time and memory of the jobs from a mesh to the checked reduced model, over the size of the mesh.

    ./run python -m tests.benchmarks.large                 # 10k, 26k, 43k and 103k nodes
    ./run python -m tests.benchmarks.large --size 26k --prestress nonlinear --cores 1
    ./run python -m tests.benchmarks.large --size 103k --memory 6000   # MB, of all jobs together

Blade `paper`, or `reference` with nonlinear prestress, with other elements, through Snakemake in a
copy of the project; of each job what its log says, beside what is told before
(``workflow.model_cost``). The frequencies at the highest speed of the basis are compared with those
that SLEPc computes alone. A row of a mesh replaces the one in workflow/study/kept/large.csv, for
the page. Compiled forms come from the cache: a first run compiles them, too.
"""

import argparse
import csv
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

from fem.petsc import PETSc, SLEPc

import numpy as np

from fem.matrices import Matrices
from geometry.blade import Blade
from rom.components import ComponentModes
from tests.workflow.projects import Project, copied
from workflow.job_cost import read_usage
from workflow.model_cost import costs, nodes_of

ROOT = Path(__file__).parents[2]
KEPT = ROOT / "workflow/study/kept/large.csv"
SIZES = {"10k": 3.9, "26k": 2.48, "43k": 2.02, "103k": 1.4, "250k": 1.0}  # mm
LOGS = {
    "assemble": "assemble",
    "modes": "modes",
    "solve_between": "full-between",
    "reduce": "reduce-rtz",
}
HEADS = (
    *("nodes", "prestress", *LOGS, "all, CPU s", "told", "largest, GB", "told, GB"),
    *("wall, s", "cores", "from SLEPc"),
)
BLADES = {"linear": "paper", "nonlinear": "reference"}
COMPARED = 10  # frequencies


def add_blade(project: Project, name: str, size: str, prestress: str) -> None:
    """Add the blade of a prestress, with elements of a size."""
    (project.folder / f"workflow/blades/{name}.yaml").write_text(
        f"base: {BLADES[prestress]}\nmesh: {{element_size_mm: {SIZES[size]}}}\n"
    )


def row(folder: Path, blade: Blade, nodes: int) -> list[str]:
    """What each job took, and all beside what was told."""
    told = costs(blade, nodes).values()
    used = [read_usage(folder / f"logs/{log}.log") for log in LOGS.values()]
    return [
        *(f"{of['seconds']:.0f} s, {of['peak_MB'] / 1e3:.2g} GB" for of in used),
        f"{sum(of['seconds'] for of in used):.0f}",
        f"{sum(cost.seconds for cost in told):.0f}",
        f"{max(of['peak_MB'] for of in used) / 1e3:.2g}",
        f"{max(cost.memory for cost in told) / 1e9:.2g}",
    ]


def error_against_slepc(folder: Path) -> float:
    """Largest relative difference from frequencies of SLEPc with a factor of its own."""
    *_, state = Matrices.load(folder / "matrices.h5").states()
    M, modes = Matrices.load(folder / "matrices.h5").M, ComponentModes.load(folder / "modes.h5")
    operators = [
        PETSc.Mat().createAIJWithArrays(A.shape, (A.indptr, A.indices, A.data))
        for A in (state.K, M)
    ]
    eps = SLEPc.EPS().create()
    eps.setOperators(*operators)
    eps.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    eps.setDimensions(COMPARED)
    eps.setTarget(0.0)
    eps.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
    eps.setTolerances(1e-12)
    eps.getST().setType(SLEPc.ST.Type.SINVERT)
    solver = eps.getST().getKSP()
    solver.setType(PETSc.KSP.Type.PREONLY)
    solver.getPC().setType(PETSc.PC.Type.LU)
    solver.getPC().setFactorSolverType(PETSc.Mat.SolverType.MUMPS)
    eps.solve()
    squares = np.sort([eps.getEigenvalue(i).real for i in range(COMPARED)])
    return float(abs(modes.omega[-1, :COMPARED] / np.sqrt(squares) - 1).max())


def keep(rows: list[list[str]]) -> None:
    """Add the rows to those that are kept, in place of those of the same meshes."""
    text = KEPT.read_text().splitlines()[2:] if KEPT.exists() else []
    kept = {tuple(cells[:2]): cells for cells in [*csv.reader(text), *rows]}
    ordered = sorted(kept.values(), key=lambda cells: (cells[1], int(cells[0])))
    with KEPT.open("w", newline="") as file:
        file.write("# ./run python -m tests.benchmarks.large\n")
        csv.writer(file, lineterminator="\n").writerows([HEADS, *ordered])


def main() -> None:
    """Run the sizes that are named, print and keep their rows."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", nargs="+", choices=SIZES, default=["10k", "26k", "43k", "103k"])
    parser.add_argument("--prestress", choices=BLADES, default="linear")
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument("--memory", type=int, help="MB of all jobs together")
    parser.add_argument("--no-peer", action="store_true", help="not compared with SLEPc")
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        project = copied(Path(folder))
        for size in given.size:
            name = f"{given.prestress}-{size}"
            add_blade(project, name, size, given.prestress)
            of, start = project.folder / f"results/{name}", perf_counter()
            limit = [f"--resources=mem_mb={given.memory}"] if given.memory else []
            model = f"results/{name}/rom-check-rtz.nc"
            command = project.command("--cores", f"{given.cores}", *limit, "--", model)
            subprocess.run(command, cwd=folder, env=project.environment, check=True)
            wall = perf_counter() - start
            nodes = nodes_of(of / "blade.msh")
            blade = Blade.load(project.folder / f"workflow/blades/{name}.yaml")
            error = "" if given.no_peer else f"{error_against_slepc(of):.1e}"
            cells = [f"{nodes}", given.prestress, *row(of, blade, nodes)]
            cells += [f"{wall:.0f}", f"{given.cores}", error]
            print(*(f"{head}: {cell}" for head, cell in zip(HEADS, cells, strict=True)), sep="\n")
            keep([cells])


if __name__ == "__main__":
    main()
