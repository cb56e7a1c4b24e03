# What the study of the interface marches, and on which meshes.
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
