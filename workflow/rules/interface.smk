# The study of the interface: run when asked for, no part of `rule all`.
from workflow.study.interface_plan import BLADES as INTERFACE_BLADES
from workflow.study.interface_plan import SCENES as INTERFACE_SCENES

OF_INTERFACE = sources(
    "simulate/*.py",
    "simulate/laws/*.py",
    "rom/*.py",
    "fem/*.py",
    "workflow/study/interface*.py",
    *(f"workflow/study/trade_{n}.py" for n in ("errors", "models", "plan", "runs", "table")),
)
INTERFACE_MESHES = {name: (name, "interface_models") for name in INTERFACE_BLADES} | {
    "all-nodes": ("reference-all-nodes", "interface_nodes")
}  # name: its blade and its module


def given_to_interface(wildcards):
    """The file of the blade; the scene of its peak, or those marched at all nodes of its tip."""
    blade, module = INTERFACE_MESHES[wildcards.mesh]
    given = {"blade": f"workflow/blades/{blade}.yaml"}
    if module == "interface_models":
        return given | {"scene": SCENES["peak-e1"].model_dump(mode="json")}
    at_nodes = {name: INTERFACE_SCENES[name] for name in ("calm", "resonance", "stiff")}
    return given | {"scenes": settings_of_studied(at_nodes)}


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
