"""What does not depend on the coatings: densities, steps, laws, cost, stress."""

from adapter import stage

from geometry.files import read_json, write_json
from rom.model import Rom
from simulate.dataset import load
from simulate.scene import Scene
from workflow.paper import measure
from workflow.paper.laws import slopes_over_closed_form

with stage(snakemake):
    files = snakemake.input
    scene = Scene.model_validate(snakemake.params.scene)
    peak = read_json(files.peak)
    numbers = {
        "densities": measure.densities(*map(load, files.densities)),
        "steps": measure.steps([load(file) for file in files.steps]),
        "density_cost": measure.density_cost(scene, Rom.load(files.rom)),
        "laws": slopes_over_closed_form(),
        "stress": measure.stress(peak),
    }
    write_json(numbers, snakemake.output.json)
