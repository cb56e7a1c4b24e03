"""The full matrices of a blade's basis, at as many speeds as its tolerance needs."""

from pathlib import Path

from fem.assemble import over_speeds
from fem.matrices import Matrices
from geometry.blade import Blade
from geometry.project import Say, counted, silent
from rom.between import resolved
from rom.speeds import basis_speeds


def assembled(blade: Blade, name: str, mesh: str | Path, say: Say = silent) -> Matrices:
    """M, S and K(Omega) at the speeds of the basis, and at more where K(Omega) needs them.

    ``name``: of the blade, for the provenance. Raises the errors of ``fem.assemble.over_speeds``
    and ``rom.between.resolved``.
    """
    speeds = basis_speeds(blade.basis, blade.max_speed_rad_s).tolist()
    fom, states = over_speeds(blade, name, mesh, speeds)
    return resolved(fom, counted(states, len(speeds), "speed", say), speeds, blade.basis, say)
