"""Numbers of the paper's claims."""

from adapter import job

from geometry.base import read_json
from rom.model import Rom
from simulate.sweeps.dataset import load
from workflow.many.table import whole
from workflow.paper.numbers import of_scenes

job(
    snakemake,
    lambda of, tell: of_scenes(
        Rom.load(of.input.rom),
        *map(
            load,
            (of.input.e1, of.input.e10, of.input.two_five, of.input.tilted, of.input.tangential),
        ),
        whole(of.input.grid),
        read_json(of.input.growth),
        [*map(read_json, of.input.more)],
    ),
)
