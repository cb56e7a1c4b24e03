rule pilot:
    input:
        code=code_of("pilot"),
        rom=scenes.rom,
        check=scenes.check,
        mesh_error=scenes.mesh_error,
    output:
        json="results/{blade}/{scene}/settings.json",
    log:
        "results/{blade}/{scene}/logs/pilot.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/pilot.tsv"
    params:
        contents=scenes.contents,
        scene=scenes.told_alone,
    message:
        "Scene {wildcards.scene}: step and density for its accuracy"
    script:
        "../scripts/pilot.py"


rule check_scene:
    input:
        code=code_of("check_scene"),
        rom=scenes.rom,
    output:
        checked=touch("results/{blade}/{scene}/checked"),
    log:
        "results/{blade}/{scene}/logs/check.log",
    priority: LONGEST
    localrule: True
    params:
        scene=scenes.told,
    message:
        "Scene {wildcards.scene} against its reduced model"
    script:
        "../scripts/check_scene.py"


rule sweep_block:
    input:
        code=code_of("sweep_block"),
        rom=scenes.rom,
        check=ancient(scenes.check),
        checked=scenes.checked,
        settings=scenes.settings,
        start=scenes.start,
    output:
        runs="results/{blade}/{scene}/block-{block}.nc",
    log:
        "results/{blade}/{scene}/logs/block-{block}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/block-{block}.tsv"
    priority: LONGEST
    params:
        contents=scenes.contents,
        scene=scenes.told,
        blocks=scenes.block_count,
    message:
        "Scene {wildcards.scene}, block {wildcards.block} of its speeds"
    script:
        "../scripts/sweep_block.py"


rule sweep:
    input:
        code=code_of("sweep"),
        rom=scenes.rom,
        settings=scenes.settings,
        start=scenes.start,
        blocks=scenes.of_blocks("results/{blade}/{scene}/block-{block}.nc"),
    output:
        sweep="results/{blade}/{scene}/sweep.nc",
    log:
        "results/{blade}/{scene}/logs/sweep.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/sweep.tsv"
    priority: LONGEST
    params:
        contents=scenes.contents,
        scene=scenes.told,
        sought=project.sought,
    message:
        "Sweep of scene {wildcards.scene}"
    script:
        "../scripts/sweep.py"


# Rows that are done are in the folder `rows`, unknown to Snakemake: a block that is started anew marches only others.
rule design_block:
    input:
        code=code_of("design_block"),
        rom=scenes.rom,
        check=ancient(scenes.check),
        settings=scenes.settings,
        table=scenes.table,
        models=scenes.of_other_blades("rom"),
        checks=ancient(scenes.of_other_blades("rom-check", blades.foreign)),
    output:
        json="results/{blade}/{scene}/design-block-{block}.json",
    log:
        "results/{blade}/{scene}/logs/design-block-{block}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/design-block-{block}.tsv"
    params:
        contents=scenes.contents,
        scene=scenes.told,
        file=scenes.file,
        folder="results/{blade}/{scene}/rows",
        block="{block}",
        blocks=scenes.block_count,
        of_rows=scenes.rows_of_block,
    message:
        "Scene {wildcards.scene}, block {wildcards.block} of its design, {params.of_rows} rows"
    script:
        "../scripts/design_block.py"


rule design:
    input:
        code=code_of("design"),
        rom=scenes.rom,
        settings=scenes.settings,
        table=scenes.table,
        blocks=scenes.of_blocks("results/{blade}/{scene}/design-block-{block}.json"),
    output:
        runs="results/{blade}/{scene}/design-runs.nc",
        rows="results/{blade}/{scene}/design-rows.nc",
    log:
        "results/{blade}/{scene}/logs/design.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/design.tsv"
    params:
        contents=scenes.contents,
        scene=scenes.told,
        file=scenes.file,
        folder="results/{blade}/{scene}/rows",
    message:
        "Design of scene {wildcards.scene}: tables of its runs and rows"
    script:
        "../scripts/design.py"


rule design_row:
    input:
        code=code_of("design_row"),
        rom=scenes.of_row(scenes.rom, "rom"),
        check=ancient(scenes.of_row(scenes.check, "rom-check", blades.foreign)),
        settings=scenes.settings,
        table=scenes.table,
    output:
        sweep="results/{blade}/{scene}/row-{row}.nc",
    log:
        "results/{blade}/{scene}/logs/row-{row}.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/row-{row}.tsv"
    params:
        contents=scenes.contents,
        scene=scenes.told,
        file=scenes.file,
    message:
        "Scene {wildcards.scene}, row {wildcards.row} of its design as a sweep"
    script:
        "../scripts/design_row.py"


# Where the rows differ by seeds.
rule design_quantiles:
    input:
        rows="results/{blade}/{scene}/design-rows.nc",
        code=code_of("design_quantiles"),
    output:
        csv="results/{blade}/{scene}/quantiles.csv",
    log:
        "results/{blade}/{scene}/logs/quantiles.csv.log",
    localrule: True
    message:
        "Design of scene {wildcards.scene}: quantiles over its seeds"
    script:
        "../scripts/design_quantiles.py"


rule design_csv:
    input:
        rows="results/{blade}/{scene}/design-rows.nc",
        code=code_of("design_csv"),
    output:
        csv="results/{blade}/{scene}/design.csv",
    log:
        "results/{blade}/{scene}/logs/design.csv.log",
    localrule: True
    params:
        blade=blades.file,
    message:
        "Design of scene {wildcards.scene}: its rows as CSV"
    script:
        "../scripts/design_csv.py"


rule sweeps:
    input:
        project.of_sweeps("results/{blade}/{scene}/sweep.nc"),
        project.tables_of_designs(),
