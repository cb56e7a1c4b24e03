"""Read matrices made elsewhere, and make their interface operator."""

from pathlib import Path

from adapter import stage

from fem.given import read_matrices
from geometry.given import read_blade

with stage(snakemake):
    path = Path(snakemake.params.blade)
    matrices = read_matrices(read_blade(path), snakemake.wildcards.blade, path.parent)
    print(f"{len(matrices.coordinates)} free nodes, K at {matrices.speeds} rad/s")
    matrices.save(snakemake.output.matrices)
