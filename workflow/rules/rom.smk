rule reduce:
    input:
        code=code_of("workflow.jobs.reduced"),
        matrices="results/{blade}/matrices.h5",
    output:
        rom="results/{blade}/rom-{directions}.nc",
        basis="results/{blade}/basis-{directions}.h5",
    log:
        "results/{blade}/logs/reduce-{directions}.log",
    benchmark:
        "results/{blade}/benchmarks/reduce-{directions}.tsv"
    wildcard_constraints:
        blade=one_of([name for name in BLADE_FILES if name not in FOREIGN]),
    params:
        run="workflow.jobs.reduced:make",
        blade=blade_file,
        uses=basis_uses,
    message:
        "Reduced model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/job.py"


rule solve_full_model:
    input:
        code=code_of("workflow.jobs.full_model"),
        mesh="results/{blade}/blade.msh",
    output:
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/full-model.log",
    benchmark:
        "results/{blade}/benchmarks/full-model.tsv"
    wildcard_constraints:
        blade=one_of(MESHED),
    params:
        run="workflow.jobs.full_model:solve",
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        speeds=speeds_of_check,
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}"
    script:
        "../scripts/job.py"


# At the speeds of the matrices from elsewhere: no others are known.
rule solve_given_model:
    input:
        code=code_of("workflow.jobs.elsewhere"),
        matrices="results/{blade}/matrices.h5",
    output:
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/full-model.log",
    wildcard_constraints:
        blade=one_of(WITH_MATRICES),
    params:
        run="workflow.jobs.elsewhere:solve",
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/job.py"


rule take_rom:
    input:
        unpack(blade_source),
        code=code_of("workflow.jobs.elsewhere"),
    output:
        rom="results/{blade}/rom-{directions}.nc",
    log:
        "results/{blade}/logs/take-rom-{directions}.log",
    wildcard_constraints:
        blade=one_of(FOREIGN),
    params:
        run="workflow.jobs.elsewhere:take",
        contents=contents_of_blade,
        blade=blade_file,
    message:
        "Reduced model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/job.py"


# At further speeds of the full model, too, where neighbours disagree.
rule check_rom:
    input:
        unpack(mesh_of),
        code=code_of("workflow.jobs.check_rom"),
        full="results/{blade}/full-model.nc",
        rom="results/{blade}/rom-{directions}.nc",
    output:
        checked="results/{blade}/rom-check-{directions}.nc",
    log:
        "results/{blade}/logs/check-rom-{directions}.log",
    params:
        run="workflow.jobs.check_rom:compare",
        settings=blade_file,
        speeds=lambda wildcards: speeds_of_basis(wildcards)[0] if mesh_of(wildcards) else None,
        tolerance=lambda wildcards: blade_settings(wildcards.blade).basis.tolerance_percent,
    message:
        "Reduced against full model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/job.py"


rule rom:
    input:
        [
            f"results/{blade}/{file}-{directions_of(blade)}.nc"
            for blade in BLADES
            for file in ("rom", *(() if blade in FOREIGN else ("rom-check",)))
        ],
