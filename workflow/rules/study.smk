# Studies: run on request, not part of `rule all`.
STUDIES = {
    "study_mesh": pictures(["mesh-convergence"]),
    "study_rotor37": "results/experiments/frequencies/table.md",
    "stability": [
        "results/figures/stability.png",
        *expand("results/experiments/{of}/table.json", of=["extremes", "extreme-sweeps"]),
    ],
    "trade": "results/experiments/trade/table.md",
}

for target, files in STUDIES.items():

    rule:
        name:
            target
        input:
            files,


rule mesh_error:
    input:
        full="results/{blade}/full-model.nc",
        source=blades.source,
        code=code_of("mesh_error"),
    output:
        json="results/{blade}/mesh-error.json",
    log:
        "results/{blade}/logs/mesh-error.log",
    benchmark:
        "results/{blade}/benchmarks/mesh-error.tsv"
    priority: LONGEST
    params:
        contents=blades.contents,
        blade=blades.file,
    message:
        "Blade {wildcards.blade}: error of its mesh, from a coarser one"
    script:
        "../scripts/mesh_error.py"


rule interface:
    input:
        changes="results/experiments/interface/table.json",
        models="results/experiments/interface-models/table.json",
        code=code_of("interface"),
    output:
        markdown="results/interface/interface.md",
    log:
        "results/interface/logs/interface.md.log",
    localrule: True
    message:
        "Changes with mesh, patches, strips and modes"
    script:
        "../scripts/interface.py"
