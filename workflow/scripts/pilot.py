"""Choose step, density and strips for a scene with an accuracy."""

from adapter import stage

from geometry.project import write_json
from rom.model import Rom
from simulate.errors.accuracy import NOT_KNOWN, basis_error, choose, mesh_error
from simulate.scene import Scene
from simulate.sweeps.over_speeds import tell_before

with stage(snakemake) as tell:
    scene = Scene.model_validate(snakemake.params.scene)
    rom, source = Rom.load(snakemake.input.rom), snakemake.input
    if rom.foreign:
        print(NOT_KNOWN)
    of_mesh = mesh_error(source.mesh_error, rom) if source.mesh_error else None
    choice = choose(scene, rom, basis_error(source.check, rom), of_mesh)
    tell_before(choice.scene(scene), rom, tell.now)
    write_json(choice.plain(), snakemake.output.settings)
