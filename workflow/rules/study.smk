# Studies: run on request, not part of `rule all`.
include: "study_names.smk"


wildcard_constraints:
    level="|".join(map(str, range(len(MESH_FACTORS)))),
    jobs=r"\d+",


rule study_mesh:
    input:
        pictures(FIGURES.configured(lambda row: row.draw == "study.mesh")),


rule study_bases:
    input:
        [
            f"results/{name}/bases.json"
            for name, blade in BLADES.items()
            if name in MESHED and len(basis_speeds(blade.basis, 1.0)) == 4  # those of the default
        ],


rule study_rotor37:
    input:
        expand("results/rotor37/{study}.json", study=["frequencies", "edge-cuts"]),


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
