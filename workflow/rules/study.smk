# Studies: run on request, not part of `rule all`.
STUDIES = {
    "study_mesh": pictures(["mesh-convergence"]),
    "study_rotor37": "results/experiments/frequencies/table.md",
    "stability": [
        "results/figures/stability.png",
        "results/experiments/extremes/table.json",
        "results/experiments/extreme-sweeps/table.json",
    ],
    "trade": "results/experiments/trade/table.md",
}

for target, files in STUDIES.items():

    rule:
        name:
            target
        input:
            files,
