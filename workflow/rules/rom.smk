rule modes:
    input:
        code=code_of("modes"),
        matrices="results/{blade}/matrices.h5",
        mesh=blades.mesh,
    output:
        modes="results/{blade}/modes.h5",
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/modes.log",
    benchmark:
        "results/{blade}/benchmarks/modes.tsv"
    wildcard_constraints:
        blade=one_of(blades.reduced),
    priority: LONGEST
    resources:
        mem_mb=blades.memory("modes"),
    params:
        blade=blades.file,
        uses=blades.uses("material", "prestress"),
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
    priority: LONGEST
    resources:
        mem_mb=blades.memory("reduce"),
    params:
        blade=blades.file,
        uses=blades.uses_of_basis,
    message:
        "Reduced model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/reduce.py"


# Beside the modes: the speeds at which the polynomial K(Omega) errs most.
rule solve_between:
    input:
        code=code_of("solve_between"),
        mesh="results/{blade}/blade.msh",
        matrices=blades.linear,
    output:
        full="results/{blade}/full-between.nc",
    log:
        "results/{blade}/logs/full-between.log",
    benchmark:
        "results/{blade}/benchmarks/full-between.tsv"
    wildcard_constraints:
        blade=one_of(blades.meshed),
    resources:
        mem_mb=blades.memory("solve_between"),
    params:
        blade=blades.file,
        uses=blades.uses(*FEM_USES),
        speeds=blades.speeds_between,
    message:
        "Full model of blade {wildcards.blade} between the speeds of the basis"
    script:
        "../scripts/solve_between.py"


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
        uses=blades.uses("frequencies_Hz"),
    message:
        "Reduced model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/take_rom.py"


# At further speeds of the full model, too, where neighbours disagree.
rule check_rom:
    input:
        mesh=blades.mesh,
        matrices=blades.linear,
        code=code_of("check_rom"),
        full="results/{blade}/full-model.nc",
        between=blades.between,
        rom="results/{blade}/rom-{directions}.nc",
    output:
        checked="results/{blade}/rom-check-{directions}.nc",
    log:
        "results/{blade}/logs/check-rom-{directions}.log",
    priority: LONGEST
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
