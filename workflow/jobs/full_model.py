"""The full model on a mesh: its matrices, its modes and its compliance."""

from collections.abc import Sequence
from pathlib import Path

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from geometry.blade import Blade
from geometry.project import Say, counted, read_settings, silent
from rom.full_model import FullModel
from rom.full_model import solve as solve_at
from workflow.assembled import assembled


def assemble(blade: str, mesh: str, matrices: str, tell: Say) -> None:
    """Assemble M, K(Omega) and S."""
    made = assembled(read_settings(Blade, blade), Path(blade).stem, mesh, tell)
    print("equilibrium residuals over the load:", made.residuals)
    made.save(matrices)


def solve(blade: str, mesh: str, speeds: Sequence[float], full: str, tell: Say) -> None:
    """Modes and compliance at the ``speeds`` of the check, rad/s."""
    solved = solved_at(speeds, blade, mesh, tell)
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)


def solved_at(speeds: Sequence[float], blade: str, mesh: str, say: Say = silent) -> FullModel:
    """The full model of the blade in a file at ``speeds``, rad/s."""
    settings, cholesky = read_settings(Blade, blade), Cholesky()
    fom, states = over_speeds(settings, Path(blade).stem, mesh, speeds, cholesky)
    return solve_at(fom, counted(states, len(speeds), "speed", say), cholesky)
