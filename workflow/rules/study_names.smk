# Inputs, outputs and modules of the studies.
import yaml


def given_blade(wildcards):
    return {"blade": blade_file(wildcards)}


def full_model(wildcards):
    return {"full": f"results/{wildcards.blade}/full-model.nc"}


def matrices_and_mesh(blade):
    return {"matrices": f"results/{blade}/matrices.h5", "mesh": f"results/{blade}/blade.msh"}


# Meshes of the study of the interface
INTERFACE_MESHES = ("reference-coarse", "reference", "reference-fine", "rotor37", "rotor37-fine")


def files_of_interface(wildcards):
    return {
        "models": expand("results/interface/{blade}.json", blade=INTERFACE_MESHES),
        "checks": expand("results/{blade}/rom-check-r.nc", blade=INTERFACE_MESHES),
        "table": "results/experiments/interface/table.json",
        "all_nodes": "results/interface/all-nodes.json",
    }


def scenes_of_nodes(wildcards):
    """Scenes of the default row of the study of the interface, without a tilted tip."""
    return {
        case.label: case.scene.model_dump(mode="json")
        for case in cases_of("interface")
        if case.row == "default" and case.label in ("calm", "resonance", "stiff")
    }


def logs_of_scaling(wildcards):
    """The plan of the study of cost, and the logs that it reads."""
    path = "workflow/study/scaling.yaml"
    stages = yaml.safe_load(Path(path).read_text())
    logs = [stage["log"].format(name) for stage in stages for name in stage["of"]]
    return {"plan": path, "logs": logs}


# Rows of `numbers.smk`.
STUDIES = {
    "mesh_error": {  # also for scenes with an accuracy
        "output": {"json": "results/{blade}/mesh-error.json"},
        "run": "study.mesh_error:numbers",
        "files": lambda wildcards: blade_source(wildcards) | full_model(wildcards),
        "given": given_blade,
        "message": "Blade {wildcards.blade}: error of its mesh, from a coarser one",
    },
    "map_stability": {
        "output": {"json": "results/figures/stability-map.json"},
        "package": "tests.simulate.stability",
        "run": "map:numbers",
        "files": lambda wildcards: {"rom": f"results/{PAPER_BLADE}/rom-r.nc"},
        "given": lambda wildcards: {"scene": SCENES["hand-e1"].model_dump(mode="json")},
        "message": "Stable and accurate steps over E",
    },
    "judge_stability": {
        "output": {"json": "results/figures/stability-matrix.json"},
        "package": "tests.simulate.stability",
        "run": "matrix:numbers",
        "files": lambda wildcards: {"rom": f"results/{PAPER_BLADE}/rom-rt.nc"},
        "message": "Stability of cases with extreme parameters",
    },
    "interface_mesh": {
        "output": {"json": "results/interface/{blade}.json"},
        "run": "study.interface_models:numbers",
        "files": lambda wildcards: matrices_and_mesh(wildcards.blade),
        "given": lambda wildcards: given_blade(wildcards)
        | {"scene": SCENES["hand-peak"].model_dump(mode="json")},
        "message": "Interface of blade {wildcards.blade}",
    },
    "interface_nodes": {
        "output": {"json": "results/interface/all-nodes.json"},
        "run": "study.interface_nodes:numbers",
        "files": lambda wildcards: matrices_and_mesh("reference-all-nodes"),
        "given": lambda wildcards: {
            "blade": "workflow/blades/reference-all-nodes.yaml",
            "scenes": scenes_of_nodes(wildcards),
        },
        "message": "Contact at all nodes of the tip",
    },
    "interface": {
        "output": {
            "json": "results/interface/interface.json",
            "markdown": "results/interface/interface.md",
        },
        "run": "study.interface:numbers",
        "files": files_of_interface,
        "message": "Changes with mesh, patches, strips and modes",
    },
    "scaling_plan": {
        "output": {"json": "results/scaling/plan-{jobs}.json"},
        "run": "study.scaling:plan",
        "files": lambda wildcards: {},
        "given": lambda wildcards: {"blocks": int(wildcards.jobs)},
        "message": "How cost grows: plan of {wildcards.jobs} blocks",
    },
    "scaling_numbers": {
        "output": {"json": "results/scaling/scaling.json"},
        "run": "study.scaling:numbers",
        "files": logs_of_scaling,
        "message": "How cost grows: time and memory of jobs",
    },
}
