"""The paper's reduced model of a blade."""

from adapter import job

from rom.check import RomCheck
from rom.model import Rom
from workflow.paper.measure import model

job(
    snakemake,
    lambda of, tell: model(
        Rom.load(of.input.rom),
        RomCheck.load(of.input.check),
        Rom.load(of.input.paper),
        RomCheck.load(of.input.paper_check),
        Rom.load(of.input.nonlinear),
    ),
)
