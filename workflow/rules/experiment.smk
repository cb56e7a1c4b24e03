# Experiments: workflow/experiments/NAME.yaml, its rows in blocks, and their picture. Their table is a row of numbers.yaml.
wildcard_constraints:
    experiment=r"[^/]+",


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
        run="workflow.jobs.many:experiment",
        contents=contents_of_experiment,
        given=plan_of_experiment,
        block="{block}",
        folder="results/experiments/{experiment}/rows",
    message:
        "Experiment {wildcards.experiment}, block {wildcards.block} of its rows"
    script:
        "../scripts/job.py"


rule experiment_picture:
    input:
        code=code_of("workflow.jobs.figure", "workflow.figures.experiment"),
        rows="results/experiments/{experiment}/table.json",
    output:
        png="results/experiments/{experiment}/picture.png",
        pdf="results/experiments/{experiment}/picture.pdf",
    log:
        "results/experiments/{experiment}/logs/picture.log",
    localrule: True
    params:
        run="workflow.jobs.figure:draw",
        module="workflow.figures.experiment",
        given=lambda wildcards: {"picture": picture_of_experiment(wildcards)},
    message:
        "Picture of experiment {wildcards.experiment}"
    script:
        "../scripts/job.py"
