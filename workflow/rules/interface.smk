# The study of the interface: run when asked for, no part of `rule all`.
from workflow.study.interface import SCENES as INTERFACE_SCENES
from workflow.study.interface_models import OF_MESH

OF_INTERFACE = sources(
    "simulate/*.py",
    "simulate/laws/*.py",
    "rom/*.py",
    "fem/*.py",
    "workflow/study/interface*.py",
    "workflow/study/trade_errors.py",
    "workflow/study/trade_runs.py",
)
INTERFACE_SETTINGS = {
    name: (SCENES[scene].model_dump(mode="json"), speed)
    for name, (scene, speed) in INTERFACE_SCENES.items()
    if scene in SCENES
}


rule interface_models:
    input:
        code=OF_INTERFACE,
        matrices="results/{blade}/matrices.h5",
        mesh="results/{blade}/blade.msh",
    output:
        json="results/interface/{blade}.json",
    log:
        "results/interface/logs/{blade}.log",
    benchmark:
        "results/interface/benchmarks/{blade}.tsv"
    wildcard_constraints:
        blade="|".join(OF_MESH),
    params:
        blade=blade_file,
        scene=lambda wildcards: SCENES["peak-e1"].model_dump(mode="json"),
    message:
        "Interface of blade {wildcards.blade}"
    script:
        "../scripts/interface_models.py"


rule interface_nodes:
    input:
        code=OF_INTERFACE,
        matrices="results/reference-all-nodes/matrices.h5",
        mesh="results/reference-all-nodes/blade.msh",
    output:
        json="results/interface/all-nodes.json",
    log:
        "results/interface/logs/all-nodes.log",
    benchmark:
        "results/interface/benchmarks/all-nodes.tsv"
    params:
        blade="workflow/blades/reference-all-nodes.yaml",
        scenes={n: INTERFACE_SETTINGS[n] for n in ("calm", "resonance", "stiff")},
    message:
        "Contact at all nodes of the tip"
    script:
        "../scripts/interface_nodes.py"


rule interface:
    input:
        code=OF_INTERFACE,
        models=expand("results/interface/{blade}.json", blade=OF_MESH),
        checks=expand("results/{blade}/rom-check-r.nc", blade=OF_MESH),
        all_nodes="results/interface/all-nodes.json",
    output:
        json="results/interface/interface.json",
        table="results/interface/interface.md",
    log:
        "results/interface/logs/interface.log",
    benchmark:
        "results/interface/benchmarks/interface.tsv"
    params:
        scenes={name: scene for name, (scene, _) in INTERFACE_SETTINGS.items()},
    message:
        "What mesh, patches, strips and modes change"
    script:
        "../scripts/interface.py"
