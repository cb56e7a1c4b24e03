"""Scene and reduced models -> errors and CPU time of every setting."""

from adapter import stage

from geometry.files import write_json
from simulate.scene import Scene
from workflow.study.trade import study_scene

with stage(snakemake):
    scene = Scene(**snakemake.params.scene)
    write_json(study_scene(snakemake.wildcards.part, scene), snakemake.output.json)
