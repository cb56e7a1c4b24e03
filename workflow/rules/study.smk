# Studies: run on request, not part of `rule all`.
wildcard_constraints:
    jobs=r"\d+",


rule study_mesh:
    input:
        pictures(["mesh-convergence"]),


rule study_bases:
    input:
        "results/experiments/bases/table.md",


rule study_rotor37:
    input:
        "results/experiments/frequencies/table.md",


rule stability:
    input:
        "results/figures/stability.png",
        "results/figures/stability-matrix.json",


rule trade:
    input:
        "results/experiments/trade/table.md",
        [f"results/{name}.png" for name in FIGURES.rows if name.startswith("trade/")],


rule scaling:
    input:
        "results/scaling/scaling.png",
        "results/scaling/scaling.json",
