"""The paper's reduction basis to the letter, against the full model and ours."""

from adapter import stage, write_json

from fem.matrices import Matrices
from geometry.blade import PaperBasis
from rom.check import RomCheck, check
from rom.full_model import FullModel
from rom.model import Rom
from rom.reduce import reduce
from rom.speeds import basis_speeds
from workflow.paper.measure import model

with stage(snakemake):
    files = snakemake.input
    fom, full = Matrices.load(files.matrices), FullModel.load(files.full)
    basis = PaperBasis(kind="paper")
    paper, _ = reduce(fom.at(basis_speeds(basis, float(fom.speeds[-1]))), basis)
    rom, checked = Rom.load(files.rom), RomCheck.load(files.check)
    numbers = model(rom, checked, paper, check(paper, full))
    write_json({"model": numbers}, snakemake.output.json)
