# The identification: tables of the engine, and what they say of the parameters.
wildcard_constraints:
    sample=one_of(TABLES),
    identified=one_of(IDENTIFIED),
    draws=one_of(DRAWS),


rule identify_block:
    input:
        code=code_of("workflow.jobs.design"),
        rom=rom_of_identified,
        check=ancient(check_of_identified),
        table="results/identify/{identified}/{sample}.csv",
    output:
        block="results/identify/{identified}/{sample}-block-{block}.nc",
    log:
        "results/identify/{identified}/logs/{sample}-block-{block}.log",
    benchmark:
        "results/identify/{identified}/benchmarks/{sample}-block-{block}.tsv"
    params:
        run="workflow.jobs.design:block",
        scene=settings_of_identified,
        file=lambda wildcards, output: output.block,
        parts="results/identify/{identified}/parts",
        blocks=CONFIG.blocks,
    message:
        "Blade {wildcards.identified}, block {wildcards.block} of its table {wildcards.sample}"
    script:
        "../scripts/job.py"


rule identify_rows:
    input:
        code=code_of("workflow.jobs.design"),
        rom=rom_of_identified,
        table="results/identify/{identified}/{sample}.csv",
        blocks=expand(
            "results/identify/{{identified}}/{{sample}}-block-{block}.nc",
            block=range(CONFIG.blocks),
        ),
    output:
        runs="results/identify/{identified}/{sample}-runs.nc",
        rows="results/identify/{identified}/{sample}-rows.nc",
    log:
        "results/identify/{identified}/logs/{sample}-rows.log",
    benchmark:
        "results/identify/{identified}/benchmarks/{sample}-rows.tsv"
    params:
        run="workflow.jobs.design:tables",
        scene=settings_of_identified,
        file=lambda wildcards, output: output.rows,
    message:
        "Blade {wildcards.identified}: peaks of its table {wildcards.sample}"
    script:
        "../scripts/job.py"


rule identify:
    input:
        expand(
            "results/identify/{identified}/{file}",
            identified=IDENTIFIED,
            file=["fits.json", "posterior.png"],
        ),
        "results/identify/blades.json",
        expand(
            "results/identify/{identified}/{file}",
            identified=JUDGED_ON,
            file=["scene.json", "shares.json", "together.png"],
        ),
