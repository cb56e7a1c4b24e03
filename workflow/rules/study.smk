# Studies: run on request, not part of `rule all`.
wildcard_constraints:
    jobs=r"\d+",


STUDIES = {
    "study_mesh": pictures(["mesh-convergence"]),
    "study_bases": "results/experiments/bases/table.md",
    "study_bars": "results/experiments/bars/table.md",
    "study_rotor37": "results/experiments/frequencies/table.md",
    "stability": [
        "results/figures/stability.png",
        "results/figures/stability-matrix.json",
        "results/figures/stability-sweeps.json",
    ],
    "trade": [
        "results/experiments/trade/table.md",
        *pictures(["trade/stages"]),
    ],
    "scaling": ["results/scaling/scaling.png", "results/scaling/scaling.json"],
}

for target, files in STUDIES.items():

    rule:
        name:
            target
        input:
            files,
