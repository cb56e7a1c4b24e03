# Studies: run on request, not part of `rule all`.
import yaml


wildcard_constraints:
    jobs=r"\d+",


def source_of_blade(wildcards):
    """The input file with the blade's geometry; None where it names none."""
    return blade_source(wildcards).get("source")


def scene_of_stability(wildcards):
    return SCENES["hand-e1"].model_dump(mode="json")


def scene_of_interface(wildcards):
    """The scene at whose peak stresses are compared."""
    return SCENES["hand-peak"].model_dump(mode="json")


def scenes_of_nodes(wildcards):
    """Scenes of the default row of the study of the interface, without a tilted tip."""
    return {
        case.label: case.scene.model_dump(mode="json")
        for case in cases_of("interface")
        if case.row == "default" and case.label in ("calm", "resonance", "stiff")
    }


def number_of_jobs(wildcards):
    return int(wildcards.jobs)


def logs_of_scaling(wildcards):
    """Logs that the study of cost reads."""
    stages = yaml.safe_load(Path("workflow/study/scaling.yaml").read_text())
    return [stage["log"].format(name) for stage in stages for name in stage["of"]]


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
