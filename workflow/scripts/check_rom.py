"""Compare a reduced model with the full one; fail if its error exceeds its tolerance."""

import numpy as np
from adapter import stage

from rom.check import check, further_speeds
from rom.full_model import FullModel
from rom.model import Rom


def at_further(speeds):
    """The full model at further ``speeds``, rad/s; FEniCSx is imported for nothing else here."""
    from fem.assemble import over_speeds
    from fem.cholesky import Cholesky
    from geometry.blade import Blade
    from geometry.project import read_settings
    from rom.full_model import solve

    blade, cholesky = read_settings(Blade, snakemake.params.settings), Cholesky()
    name, mesh = snakemake.wildcards.blade, snakemake.input.mesh
    return solve(*over_speeds(blade, name, mesh, speeds, cholesky), cholesky)


with stage(snakemake) as tell:
    rom, full = Rom.load(snakemake.input.rom), FullModel.load(snakemake.input.full)
    result, tolerance = check(rom, full), snakemake.params.tolerance
    if basis := snakemake.params.basis:
        more = further_speeds(result, np.array(basis[0]), tolerance)
        if more.size:
            shown = ", ".join(f"{speed:.6g}" for speed in more)
            tell.now(f"errors at neighbouring speeds disagree: full model at {shown} rad/s, too")
            result = check(rom, full.joined(at_further(more)))
    print(f"full model solved at {', '.join(f'{speed:.6g}' for speed in result.speeds)} rad/s")
    print(f"largest frequency error of each mode: {abs(result.error).max(axis=0)}")
    result.require(tolerance)
    result.save(snakemake.output.check)
