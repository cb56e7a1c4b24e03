"""The same inputs give the same numbers, on any number of cores and in any number of blocks."""

import os
import shutil
import subprocess
import sys

import pytest
from projects import ROOT, Project
from test_kills import require_same_sweep

from fem.matrices import Matrices

BLADE = "results/paper"
SWEEP = f"{BLADE}/paper-e1/sweep.nc"


@pytest.mark.slow
@pytest.mark.parametrize(("cores", "blocks", "threads"), [(1, 1, 1), (2, 4, 2)])
def test_sweeps_have_the_same_bits_on_any_cores_and_in_any_blocks(
    project, tmp_path, cores, blocks, threads
):
    """The project's ran in two blocks on two cores; threads are those of BLAS in each job."""
    other = Project(shutil.copytree(project.folder, tmp_path / "copy", symlinks=True))
    shutil.rmtree(other.folder / BLADE / "paper-e1")
    other.edit("workflow/config.yaml", lambda config: config.update(blocks=blocks))
    subprocess.run(
        [*other.command("--cores", str(cores), SWEEP)],
        cwd=other.folder,
        env=other.environment | {"OMP_NUM_THREADS": str(threads)},
        check=True,
        capture_output=True,
    )
    made = list((other.folder / BLADE / "paper-e1").glob("block-*.nc"))
    assert len(made) == blocks
    require_same_sweep(other.folder / SWEEP, project.folder / SWEEP)


ASSEMBLE = """
import sys
from fem.assemble import assemble
from geometry.blade import Blade
from rom.polynomial import basis_speeds
blade = Blade.load(sys.argv[1])
speeds = basis_speeds(blade.basis, blade.top_speed)
assemble(blade, "coarse", sys.argv[2], speeds).save(sys.argv[3])
"""


@pytest.mark.slow
@pytest.mark.parametrize("threads", [1, 2])
def test_matrices_are_the_same_between_processes_and_with_threads(
    coarse_yaml, coarse_files, coarse_matrices, tmp_path, threads, record_property
):
    """To 1e-12 of the largest entry: threads may add in another order."""
    path = tmp_path / "matrices.h5"
    command = [sys.executable, "-c", ASSEMBLE, *map(str, (coarse_yaml, coarse_files.mesh, path))]
    environment = os.environ | {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": str(threads)}
    subprocess.run(command, env=environment, check=True, capture_output=True)
    found, names = Matrices.load(path), ("M", "S", "u_static")
    pairs = [(getattr(found, name), getattr(coarse_matrices, name)) for name in names]
    pairs += zip(found.K, coarse_matrices.K, strict=True)
    worst = max(difference(A, B) for A, B in pairs)
    record_property(f"matrices, {threads} threads", f"largest relative difference {worst:.1e}")
    assert worst <= 1e-12


def difference(A, B) -> float:
    """Largest difference over the largest entry."""
    return float(abs(A - B).max() / abs(B).max())
