"""The full model on a mesh: its matrices, its modes and its compliance."""

from pathlib import Path

import numpy as np

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from fem.matrices import Matrices
from fem.second_order import SecondOrder
from fem.solid import read_solid
from geometry.base import ProvenanceError, Say, anew, counted, silent
from geometry.blade import Blade
from rom.components import ComponentModes
from rom.full_model import MODES, FullModel, of_components, resolved, solve as solve_at
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
    solved = solved_at(speeds, blade, mesh, tell, modes)
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)


def solved_at(
    speeds: list[float], blade: str, mesh: str, say: Say = silent, modes: str = ""
) -> FullModel:
    """The full model of the blade in a file at ``speeds``, rad/s; those with ``modes`` are known.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        When the modes have their nodes in another order than the mesh.
    """
    settings, cholesky = Blade.load(blade), Cholesky()
    solid = read_solid(str(mesh), settings.material)
    along = SecondOrder(solid, settings.prestress).along
    known = ComponentModes.load(modes) if modes else None
    further = [speed for speed in speeds if known is None or speed not in known.speeds]
    fom, states = over_speeds(settings, Path(blade).stem, mesh, further, cholesky, solid)
    solved = solve_at(fom, counted(states, len(further), "speed", say), cholesky, along)
    if known is None:
        return solved
    if not np.array_equal(known.coordinates, fom.coordinates):
        raise ProvenanceError(f"{modes}: other nodes than those of the mesh; {anew(modes)}")
    at_speeds = (at for at in known.each(MODES) if at.speed in speeds)
    return of_components(fom, at_speeds, along).joined(solved)
