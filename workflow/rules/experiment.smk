# Experiments: workflow/experiments/NAME.yaml, its rows in blocks, and their picture.
rule experiment_block:
    input:
        models=experiments.models,
        checks=ancient(experiments.checks),
        code=experiments.code,
    output:
        json="results/experiments/{experiment}/block-{block}.json",
    log:
        "results/experiments/{experiment}/logs/block-{block}.log",
    benchmark:
        "results/experiments/{experiment}/benchmarks/block-{block}.tsv"
    params:
        contents=experiments.contents,
        given=experiments.plan,
        block="{block}",
        folder="results/experiments/{experiment}/rows",
    message:
        "Experiment {wildcards.experiment}, block {wildcards.block} of its rows"
    script:
        "../scripts/experiment_block.py"


rule experiment:
    input:
        blocks=experiments.blocks,
        code=code_of("experiment"),
    output:
        json="results/experiments/{experiment}/table.json",
        csv="results/experiments/{experiment}/table.csv",
        markdown="results/experiments/{experiment}/table.md",
    log:
        "results/experiments/{experiment}/logs/table.log",
    localrule: True
    params:
        folder="results/experiments/{experiment}/rows",
    message:
        "Table of experiment {wildcards.experiment}"
    script:
        "../scripts/experiment.py"


rule experiment_picture:
    input:
        code=code_of("figure", "workflow.figures.experiment"),
        rows="results/experiments/{experiment}/table.json",
    output:
        png="results/experiments/{experiment}/picture.png",
        pdf="results/experiments/{experiment}/picture.pdf",
    log:
        "results/experiments/{experiment}/logs/picture.log",
    localrule: True
    params:
        module="workflow.figures.experiment",
        given=lambda wildcards: {"picture": experiments.picture(wildcards)},
    message:
        "Picture of experiment {wildcards.experiment}"
    script:
        "../scripts/figure.py"
