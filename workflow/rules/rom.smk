rule modes:
    input:
        code=code_of("modes"),
        matrices="results/{blade}/matrices.h5",
    output:
        modes="results/{blade}/modes.h5",
    log:
        "results/{blade}/logs/modes.log",
    benchmark:
        "results/{blade}/benchmarks/modes.tsv"
    wildcard_constraints:
        blade=one_of(blades.reduced),
    params:
        natural=blades.modes_of_basis,
    message:
        "Modes of blade {wildcards.blade} at the speeds of the basis"
    script:
        "../scripts/modes.py"


rule reduce:
    input:
        code=code_of("reduce"),
        matrices="results/{blade}/matrices.h5",
        modes="results/{blade}/modes.h5",
    output:
        rom="results/{blade}/rom-{directions}.nc",
        basis="results/{blade}/basis-{directions}.h5",
    log:
        "results/{blade}/logs/reduce-{directions}.log",
    benchmark:
        "results/{blade}/benchmarks/reduce-{directions}.tsv"
    wildcard_constraints:
        blade=one_of(blades.reduced),
    params:
        blade=blades.file,
        uses=blades.uses_of_basis,
    message:
        "Reduced model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/reduce.py"


rule solve_full_model:
    input:
        code=code_of("solve_full_model"),
        mesh="results/{blade}/blade.msh",
        modes="results/{blade}/modes.h5",
    output:
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/full-model.log",
    benchmark:
        "results/{blade}/benchmarks/full-model.tsv"
    wildcard_constraints:
        blade=one_of(blades.meshed),
    params:
        blade=blades.file,
        uses=blades.uses(*FEM_USES),
        speeds=blades.speeds_of_check,
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}"
    script:
        "../scripts/solve_full_model.py"


# At the speeds of the matrices from elsewhere: no others are known.
rule solve_given_model:
    input:
        code=code_of("solve_given_model"),
        matrices="results/{blade}/matrices.h5",
        modes="results/{blade}/modes.h5",
    output:
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/full-model.log",
    wildcard_constraints:
        blade=one_of(blades.with_matrices),
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/solve_given_model.py"


rule take_rom:
    input:
        source=blades.source,
        code=code_of("take_rom"),
    output:
        rom="results/{blade}/rom-{directions}.nc",
    log:
        "results/{blade}/logs/take-rom-{directions}.log",
    wildcard_constraints:
        blade=one_of(blades.foreign),
    params:
        contents=blades.contents,
        blade=blades.file,
    message:
        "Reduced model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/take_rom.py"


# At further speeds of the full model, too, where neighbours disagree.
rule check_rom:
    input:
        mesh=blades.mesh,
        code=code_of("check_rom"),
        full="results/{blade}/full-model.nc",
        rom="results/{blade}/rom-{directions}.nc",
    output:
        checked="results/{blade}/rom-check-{directions}.nc",
    log:
        "results/{blade}/logs/check-rom-{directions}.log",
    params:
        settings=blades.file,
        speeds=lambda wildcards: (
            blades.speeds_of_basis(wildcards)[0] if blades.mesh(wildcards) else None
        ),
        tolerance=lambda wildcards: blades.of(wildcards).basis.tolerance_percent,
    message:
        "Reduced against full model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/check_rom.py"


rule rom:
    input:
        project.roms(),
