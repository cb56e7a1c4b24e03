# The study of the interface: run when asked for, no part of `rule all`.
include: "interface_names.smk"


rule interface_numbers:
    input:
        code=OF_INTERFACE,
        matrices=lambda wildcards: f"results/{INTERFACE_MESHES[wildcards.mesh][0]}/matrices.h5",
        mesh=lambda wildcards: f"results/{INTERFACE_MESHES[wildcards.mesh][0]}/blade.msh",
    output:
        json="results/interface/{mesh}.json",
    log:
        "results/interface/logs/{mesh}.log",
    benchmark:
        "results/interface/benchmarks/{mesh}.tsv"
    wildcard_constraints:
        mesh="|".join(INTERFACE_MESHES),
    params:
        module=lambda wildcards: f"workflow.study.{INTERFACE_MESHES[wildcards.mesh][1]}",
        given=given_to_interface,
    message:
        "Interface of {wildcards.mesh}"
    script:
        "../scripts/numbers.py"


rule interface:
    input:
        code=OF_INTERFACE,
        models=expand("results/interface/{blade}.json", blade=INTERFACE_BLADES),
        checks=expand("results/{blade}/rom-check-r.nc", blade=INTERFACE_BLADES),
        all_nodes="results/interface/all-nodes.json",
    output:
        json="results/interface/interface.json",
        markdown="results/interface/interface.md",
    log:
        "results/interface/logs/interface.log",
    benchmark:
        "results/interface/benchmarks/interface.tsv"
    params:
        module="workflow.study.interface",
        given=lambda wildcards: {"scenes": settings_of_studied(INTERFACE_SCENES)},
    message:
        "What mesh, patches, strips and modes change"
    script:
        "../scripts/numbers.py"
