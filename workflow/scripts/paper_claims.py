"""Numbers, and those of repeats, causes and the other blade that are there -> the verdicts."""

from adapter import stage

from geometry.files import read_json, whole, write_json
from workflow.paper.claims import CLAIMS
from workflow.paper.contact_map import ranges
from workflow.paper.report import markdown, verdicts
from workflow.paper.stiffness import told


def read(files: dict[str, str]) -> dict[str, dict]:
    """Numbers of each file, by the same names."""
    return {name: read_json(file) for name, file in files.items()}


with stage(snakemake):
    beside = {name: read(files) for name, files in snakemake.params.beside.items()}
    numbers = read_json(snakemake.input.numbers)
    found = verdicts(CLAIMS, numbers, *(beside[x] for x in ("repeats", "other", "causes")))
    kept = {"as they are": numbers, **beside["repeats"]}
    e1 = {name: of["e1"]["peaks"] for name, of in kept.items()}
    write_json(found, snakemake.output.json)
    with whole(snakemake.output.markdown) as temporary:
        maps = [ranges(of, e1) for of in beside["map"].values()]
        maps += [told(of) for of in beside["stiffness"].values()]
        temporary.write_text(markdown(found, "\n".join(maps)))
