"""The full model on a mesh: its matrices, its modes and its compliance."""

from pathlib import Path

import numpy as np

from fem.assemble import over_speeds
from fem.cholesky import Cholesky
from fem.matrices import Matrices
from fem.prestress import spun
from fem.second_order import SecondOrder
from fem.solid import read_solid
from geometry.base import ProvenanceError, Say, anew, counted, silent
from geometry.blade import Blade
from rom.components import ComponentModes, at_speeds
from rom.full_model import MODES, Along, FullModel, of_components, resolved, solve as solve_at
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


def solve_modes(
    blade: str, matrices: str, mesh: str, count: int, modes: str, full: str, tell: Say
) -> None:
    """Component modes at the speeds of the matrices, ``count`` natural ones; the full model there.

    ``mesh``: that of a blade which has one; else the second order of vibrations is not known.

    Raises
    ------
    geometry.base.provenance.ProvenanceError
        When the matrices have their nodes in another order than the mesh.
    """
    fom = Matrices.load(matrices)
    components = ComponentModes.of(fom, at_speeds(fom, max(count, MODES), tell))
    # the mesh takes memory: not beside a factor
    along = _second_order(Blade.load(blade), mesh, fom, matrices) if mesh else None
    components.save(modes)
    _save(of_components(fom, components.at_speeds(fom), along), full)


def _second_order(settings: Blade, mesh: str, fom: Matrices, matrices: str) -> Along:
    solid = read_solid(mesh, settings.material)
    if not np.array_equal(solid.free_coordinates(), fom.coordinates):
        raise ProvenanceError(
            f"its nodes are not as the mesh is read now; {anew(matrices)}", file=matrices
        )
    return SecondOrder(solid, settings.prestress).along


def solve(blade: str, mesh: str, matrices: str, speeds: list[float], full: str, tell: Say) -> None:
    """Modes and compliance at further ``speeds``, rad/s; ``matrices``: as of ``solved_at``."""
    _save(solved_at(speeds, blade, mesh, matrices, tell), full)


def _save(solved: FullModel, full: str) -> None:
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)


def solved_at(
    speeds: list[float], blade: str, mesh: str, matrices: str, say: Say = silent
) -> FullModel:
    """The full model of the blade in a file at ``speeds``, rad/s.

    ``matrices``: those of prestress `linear`, which hold K at all speeds; else it is assembled.
    """
    settings, cholesky = Blade.load(blade), Cholesky()
    if matrices:
        fom = Matrices.load(matrices)
        along = _second_order(settings, mesh, fom, matrices)
        states = spun(*fom.K, fom.u_static[-1] / fom.speeds[-1] ** 2, speeds)
    else:
        solid = read_solid(mesh, settings.material)
        fom, states = over_speeds(settings, Path(blade).stem, mesh, speeds, cholesky, solid)
        along = SecondOrder(solid, settings.prestress).along
    return solve_at(fom, counted(states, len(speeds), "speed", say), cholesky, along)
