# Experiments: workflow/experiments/NAME.yaml, its rows in blocks, and their table.
from workflow.experiment.plan import Experiment, cases

EXPERIMENTS = read_or_fail(yaml_file.names, "workflow/experiments")


@cache
def cases_of(name):
    """Rows of an experiment on their scenes; refused where their blade does not allow them."""
    path = f"workflow/experiments/{name}.yaml"
    found = read_or_fail(cases, path)
    for case in found:
        blade, of = case.scene.blade, f"{path}: {case.row}, {case.label}"
        if blade not in BLADE_FILES:
            raise WorkflowError(f"{of}: blade: {blade!r}: no workflow/blades/{blade}.yaml")
        if fault := fault_of_blade(case.scene, blade_settings(blade)):
            raise WorkflowError(f"{of}: {fault}")
    return found


def models_of_experiment(wildcards):
    """Reduced models of the rows that are marched, and the files that numbers need."""
    files = [
        file
        for case in cases_of(wildcards.experiment)
        for file in map(case.file, (*["rom"][: case.marched], *case.needs))
    ]
    return list(dict.fromkeys(files))


def checks_of_experiment(wildcards):
    """Checks of the models: nothing is marched on one that misses its tolerance."""
    files = [
        case.file("check")
        for case in cases_of(wildcards.experiment)
        if case.marched and case.scene.blade not in FOREIGN
    ]
    return list(dict.fromkeys(files))


def code_of_experiment(wildcards):
    """The engine, and the functions of all rows."""
    found = cases_of(wildcards.experiment)
    functions = {of for case in found for of in (case.function, case.model) if of}
    return code_of("workflow.jobs.experiment", *sorted(functions))(wildcards)


def plan_of_experiment(wildcards):
    """All rows, and the number of blocks."""
    found = cases_of(wildcards.experiment)
    return Told(
        {
            "cases": [case.model_dump(mode="json") for case in found],
            "blocks": min(CONFIG.blocks, len(found)),
        }
    )


def blocks_of_experiment(wildcards):
    count = min(CONFIG.blocks, len(cases_of(wildcards.experiment)))
    return expand("results/experiments/{{experiment}}/block-{block}.json", block=range(count))


def picture_of_experiment(wildcards):
    """What is drawn of the table."""
    path = f"workflow/experiments/{wildcards.experiment}.yaml"
    picture = read_or_fail(Experiment.load, path).picture
    if picture is None:
        raise WorkflowError(f"{path}: picture: missing: give lines or cells")
    return Told(picture.model_dump(mode="json", exclude_none=True))


wildcard_constraints:
    experiment=one_of(EXPERIMENTS),


# Rows that are done are in `rows`, which Snakemake does not know, as those of designs.
rule experiment_block:
    input:
        models=models_of_experiment,
        checks=ancient(checks_of_experiment),
        code=code_of_experiment,
    output:
        json="results/experiments/{experiment}/block-{block}.json",
    log:
        "results/experiments/{experiment}/logs/block-{block}.log",
    benchmark:
        "results/experiments/{experiment}/benchmarks/block-{block}.tsv"
    params:
        run="workflow.jobs.experiment:block",
        plan=plan_of_experiment,
        folder="results/experiments/{experiment}/rows",
    message:
        "Experiment {wildcards.experiment}, block {wildcards.block} of its rows"
    script:
        "../scripts/job.py"


rule experiment:
    input:
        code=code_of("workflow.jobs.experiment"),
        blocks=blocks_of_experiment,
    output:
        json="results/experiments/{experiment}/table.json",
        csv="results/experiments/{experiment}/table.csv",
        markdown="results/experiments/{experiment}/table.md",
    log:
        "results/experiments/{experiment}/logs/table.log",
    localrule: True
    params:
        run="workflow.jobs.experiment:rows",
    message:
        "Table of experiment {wildcards.experiment}"
    script:
        "../scripts/job.py"


rule experiment_picture:
    input:
        code=code_of("workflow.jobs.figure", "workflow.experiment.picture"),
        rows="results/experiments/{experiment}/table.json",
    output:
        png="results/experiments/{experiment}/picture.png",
        pdf="results/experiments/{experiment}/picture.pdf",
    log:
        "results/experiments/{experiment}/logs/picture.log",
    localrule: True
    params:
        run="workflow.jobs.figure:draw",
        module="workflow.experiment.picture",
        given=lambda wildcards: {"picture": picture_of_experiment(wildcards)},
    message:
        "Picture of experiment {wildcards.experiment}"
    script:
        "../scripts/job.py"
