"""The full model on a mesh: its matrices, its modes and its compliance."""

from pathlib import Path

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from fem.matrices import Matrices
from fem.second_order import SecondOrder
from fem.solid import read_solid
from geometry.base import Say, counted, silent
from geometry.blade import Blade
from rom.full_model import FullModel, resolved, solve as solve_at
from rom.natural import NaturalModes
from rom.polynomial import basis_speeds


def assemble(blade: str, mesh: str, matrices: str, tell: Say) -> None:
    """Assemble M, K(Omega) and S."""
    made = assembled(Blade.load(blade), Path(blade).stem, mesh, tell)
    print("equilibrium residuals over the load:", made.residuals)
    made.save(matrices)


def assembled(blade: Blade, name: str, mesh: str | Path, say: Say = silent) -> Matrices:
    """M, S and K(Omega) at the speeds of the basis, and at more where K(Omega) needs them.

    ``name``: of the blade, for the provenance. Raises the errors of ``fem.assemble.over_speeds``
    and ``rom.full_model.resolved``.
    """
    speeds = basis_speeds(blade.basis, blade.top_speed).tolist()
    fom, states = over_speeds(blade, name, mesh, speeds)
    states = counted(states, len(speeds), "speed", say)
    if blade.prestress == "linear":  # K is linear in Omega^2: two speeds give it at all others
        return Matrices.of(fom, states)
    return resolved(fom, states, speeds, blade.basis, say)


def solve(blade: str, mesh: str, modes: str, speeds: list[float], full: str, tell: Say) -> None:
    """Modes and compliance at the ``speeds`` of the check, rad/s; some ``modes`` are known."""
    solved = solved_at(speeds, blade, mesh, tell, NaturalModes.load(modes))
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)


def solved_at(
    speeds: list[float],
    blade: str,
    mesh: str,
    say: Say = silent,
    natural: NaturalModes | None = None,
) -> FullModel:
    """The full model of the blade in a file at ``speeds``, rad/s; ``natural``: modes of some."""
    settings, cholesky = Blade.load(blade), Cholesky()
    solid = read_solid(str(mesh), settings.material)
    fom, states = over_speeds(settings, Path(blade).stem, mesh, speeds, cholesky, solid)
    along = SecondOrder(solid, settings.prestress).along
    return solve_at(fom, counted(states, len(speeds), "speed", say), cholesky, along, natural)
