"""The animation of a scene at one speed."""

from adapter import stage

from rom.model import Rom
from simulate.errors.accuracy import Choice
from simulate.scene import Scene
from simulate.sweeps.dataset import load
from workflow.explore.rub import by_rounds, save
from workflow.figures.response import liner_and_tip

with stage(snakemake):
    source, names = snakemake.input, snakemake.wildcards
    scene, rom = Scene.model_validate(snakemake.params.scene), Rom.load(source.rom)
    choice = Choice.load(source.settings) if scene.accuracy else None
    start = load(source.start) if scene.start else None
    rub = by_rounds(scene, rom, float(names.speed), choice, start)
    title = f"scene {names.scene}, blade {names.blade}: {liner_and_tip(scene)}"
    save(rub, title, snakemake.output.animation)
