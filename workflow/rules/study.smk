# Studies: run on request, not part of `rule all`.
include: "study_names.smk"


wildcard_constraints:
    level="|".join(map(str, range(len(MESH_FACTORS)))),
    studied="[a-z]+",
    modes=r"\d+",
    jobs=r"\d+",


use rule reduce as reduce_for_trade with:
    output:
        rom="results/trade/models/{blade}-{modes}-modes-{directions}.nc",
    log:
        "results/trade/logs/reduce-{blade}-{modes}-modes-{directions}.log",
    benchmark:
        "results/trade/benchmarks/reduce-{blade}-{modes}-modes-{directions}.tsv"
    params:
        changes=lambda wildcards: {"basis__natural_modes": int(wildcards.modes)},
    message:
        "Reduced model of blade {wildcards.blade}, {wildcards.modes} modes, {wildcards.directions}"


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
        [f"results/trade/{name}.json" for name in ("trade", "smaller", "features")],
        [f"results/{name}.png" for name in FIGURES.rows if name.startswith("trade/")],


rule scaling:
    input:
        "results/scaling/scaling.png",
        "results/scaling/scaling.json",
