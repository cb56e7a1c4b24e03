"""The check of a reduced model against the full one."""

import numpy as np

from geometry.base import Say
from rom.check import check, further_speeds
from rom.full_model import FullModel
from rom.measured import as_clamped
from rom.model import Rom


def compare(
    rom: str,
    full: str,
    between: str,
    settings: str,
    tolerance: float,
    speeds: list[float] | None,
    mesh: str,
    matrices: str,
    checked: str,
    report: Say,
) -> None:
    """Compare both models, clamped; at more speeds where neighbours of ``speeds`` disagree.

    ``between``: the full model at further speeds, for a blade that has a mesh.
    ``settings``: the blade's file; ``speeds``: of its basis, rad/s, None for matrices from
    elsewhere, which have no others, nor a mesh. ``matrices``: as of ``full_model.solved_at``.

    Raises
    ------
    rom.model.RomError
        When the error exceeds the tolerance, %.
    """
    reduced, full_model = as_clamped(Rom.load(rom)), FullModel.load(full)
    if between:
        full_model = full_model.joined(FullModel.load(between))
    result = check(reduced, full_model)
    more = further_speeds(result, np.array(speeds), tolerance) if speeds else np.empty(0)
    if more.size:
        from workflow.jobs.full_model import solved_at  # FEniCSx is imported for nothing else

        shown = ", ".join(f"{speed:.6g}" for speed in more)
        report(f"errors at neighbouring speeds disagree: full model at {shown} rad/s, too")
        result = check(reduced, full_model.joined(solved_at(more, settings, mesh, matrices)))
    print(f"full model solved at {', '.join(f'{speed:.6g}' for speed in result.speeds)} rad/s")
    print(f"largest frequency error of each mode: {abs(result.error).max(axis=0)}")
    result.require(tolerance)
    result.save(checked)
