rule pilot:
    input:
        code=code_of("workflow.jobs.march"),
        rom=rom_of_scene,
        check=check_of_scene,
        mesh_error=mesh_error_of_scene,
    output:
        json="results/{blade}/{scene}/settings.json",
    log:
        "results/{blade}/{scene}/logs/pilot.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/pilot.tsv"
    params:
        run="workflow.jobs.march:pilot",
        contents=contents_of_scene,
        scene=lambda wildcards: Told(
            SCENES[wildcards.scene].but(design=None).model_dump(mode="json")
        ),
    message:
        "Scene {wildcards.scene}: step and density for its accuracy"
    script:
        "../scripts/job.py"


rule check_scene:
    input:
        code=code_of("simulate.sweeps.over_speeds"),
        rom=rom_of_scene,
    output:
        checked=touch("results/{blade}/{scene}/checked"),
    log:
        "results/{blade}/{scene}/logs/check.log",
    localrule: True
    params:
        run="simulate.sweeps.over_speeds:check_sweep",
        scene=settings_told,
    message:
        "Scene {wildcards.scene} against its reduced model"
    script:
        "../scripts/job.py"


rule sweep_block:
    input:
        code=code_of("workflow.jobs.march"),
        rom=rom_of_scene,
        check=ancient(check_of_scene),
        checked=checked_scene,
        settings=settings_of_scene,
        start=sweep_before,
    output:
        runs="results/{blade}/{scene}/block-{block}.nc",
    log:
        "results/{blade}/{scene}/logs/block-{block}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/block-{block}.tsv"
    params:
        run="workflow.jobs.march:block",
        contents=contents_of_scene,
        scene=settings_told,
        blocks=lambda wildcards: len(blocks(wildcards)),
    message:
        "Scene {wildcards.scene}, block {wildcards.block} of its speeds"
    script:
        "../scripts/job.py"


rule sweep:
    input:
        code=code_of("workflow.jobs.sweep"),
        rom=rom_of_scene,
        settings=settings_of_scene,
        start=sweep_before,
        blocks=lambda wildcards: expand(
            "results/{{blade}}/{{scene}}/block-{block}.nc", block=blocks(wildcards)
        ),
    output:
        sweep="results/{blade}/{scene}/sweep.nc",
    log:
        "results/{blade}/{scene}/logs/sweep.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/sweep.tsv"
    params:
        run="workflow.jobs.sweep:of_blocks",
        contents=contents_of_scene,
        scene=settings_told,
        sought=lambda wildcards: sought_of(wildcards.blade),
    message:
        "Sweep of scene {wildcards.scene}"
    script:
        "../scripts/job.py"


# Rows that are done are in the folder `rows`, which Snakemake does not know: a block that is started anew, by a change or another
# number of blocks, marches only rows that are not there.
rule design_block:
    input:
        code=code_of("workflow.jobs.many"),
        rom=rom_of_scene,
        check=ancient(check_of_scene),
        settings=settings_of_scene,
        table=table_of_design,
        models=of_other_blades("rom"),
        checks=ancient(of_other_blades("rom-check", FOREIGN)),
    output:
        json="results/{blade}/{scene}/design-block-{block}.json",
    log:
        "results/{blade}/{scene}/logs/design-block-{block}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/design-block-{block}.tsv"
    params:
        run="workflow.jobs.many:design",
        contents=contents_of_scene,
        scene=settings_told,
        file=lambda wildcards: scene_file(wildcards.scene),
        folder="results/{blade}/{scene}/rows",
        block="{block}",
        blocks=lambda wildcards: len(blocks(wildcards)),
        of_rows=rows_of_block,
    message:
        "Scene {wildcards.scene}, block {wildcards.block} of its design, {params.of_rows} rows"
    script:
        "../scripts/job.py"


rule design:
    input:
        code=code_of("workflow.jobs.many"),
        rom=rom_of_scene,
        settings=settings_of_scene,
        table=table_of_design,
        blocks=lambda wildcards: expand(
            "results/{{blade}}/{{scene}}/design-block-{block}.json", block=blocks(wildcards)
        ),
    output:
        runs="results/{blade}/{scene}/design-runs.nc",
        rows="results/{blade}/{scene}/design-rows.nc",
    log:
        "results/{blade}/{scene}/logs/design.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/design.tsv"
    params:
        run="workflow.jobs.many:tables",
        contents=contents_of_scene,
        scene=settings_told,
        file=lambda wildcards: scene_file(wildcards.scene),
        folder="results/{blade}/{scene}/rows",
    message:
        "Design of scene {wildcards.scene}: tables of its runs and rows"
    script:
        "../scripts/job.py"


rule design_row:
    input:
        code=code_of("workflow.jobs.many"),
        rom=of_row(rom_of_scene, "rom"),
        check=ancient(of_row(check_of_scene, "rom-check", FOREIGN)),
        settings=settings_of_scene,
        table=table_of_design,
    output:
        sweep="results/{blade}/{scene}/row-{row}.nc",
    log:
        "results/{blade}/{scene}/logs/row-{row}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/row-{row}.tsv"
    params:
        run="workflow.jobs.many:row",
        contents=contents_of_scene,
        scene=settings_told,
        file=lambda wildcards: scene_file(wildcards.scene),
    message:
        "Scene {wildcards.scene}, row {wildcards.row} of its design as a sweep"
    script:
        "../scripts/job.py"


rule sweeps:
    input:
        of_scenes("results/{blade}/{scene}/sweep.nc"),
        of_designs(),
