# Figures and claims of the paper: run on request, not part of `rule all`.
include: "paper_names.smk"


wildcard_constraints:
    edition=EDITION,
    repeat=EDITION,
    part=one_of(PARTS.values()),
    row="[^/]+",
    cause="[^/]+",


rule repeat_sweep:
    input:
        code=code_of("workflow.jobs.sweep"),
        rom=lambda wildcards: rom_of(of_part(wildcards.repeat, wildcards.part)),
    output:
        sweep="results/paper/{repeat}/paper-{part}.nc",
    log:
        "results/paper/{repeat}/logs/paper-{part}.log",
    benchmark:
        "results/paper/{repeat}/benchmarks/paper-{part}.tsv"
    params:
        run="workflow.jobs.sweep:at_once",
        scene=lambda wildcards: settings_of_part(wildcards.repeat, wildcards.part),
    message:
        "Scene paper-{wildcards.part} with {wildcards.repeat}"
    script:
        "../scripts/job.py"


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/index.html",
        "results/paper/long-times.json",
        "results/paper/cost.md",
        pictures(
            name
            for name, row in FIGURES.rows.items()
            if row.category == "The paper" or name.startswith("fig")
        ),
        pictures(["stress-peak-e1"]),


rule paper_uncertainty:
    input:
        lambda wildcards: further_files_of("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: further_files_of("paper_causes"),


rule paper_rotor37:
    input:
        lambda wildcards: further_files_of("paper_rotor37"),
