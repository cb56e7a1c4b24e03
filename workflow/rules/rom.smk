rule reduce:
    input:
        code=sources(
            *ROM_CODE,
            *(f"rom/{n}.py" for n in ("model", "reconstruct", "stored")),
            "fem/matrices.py",
        ),
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
        blade=blade_file,
        uses=basis_uses,
    message:
        "Reduced model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/reduce.py"


rule solve_full_model:
    input:
        code=ASSEMBLY + sources(*(f"rom/{n}.py" for n in ("full_model", "modes", "stored"))),
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
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        speeds=speeds_of_check,
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}"
    script:
        "../scripts/solve_full_model.py"


# At the speeds of the matrices from elsewhere: no others are known.
rule solve_given_model:
    input:
        code=sources(*(f"rom/{n}.py" for n in ("full_model", "modes", "stored"))),
        matrices="results/{blade}/matrices.h5",
    output:
        full="results/{blade}/full-model.nc",
    log:
        "results/{blade}/logs/full-model.log",
    wildcard_constraints:
        blade=one_of(blades_with(GivenMatrices.key)),
    message:
        "Modes and tip compliance of the full model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/solve_given_model.py"


rule take_rom:
    input:
        unpack(blade_source),
        code=sources(
            *ROM_CODE,
            *(f"rom/{n}.py" for n in ("compliance", "foreign", "model", "stored")),
            "geometry/given.py",
        ),
    output:
        rom="results/{blade}/rom-{directions}.nc",
    log:
        "results/{blade}/logs/take-rom-{directions}.log",
    wildcard_constraints:
        blade=one_of(FOREIGN),
    params:
        blade=blade_file,
    message:
        "Reduced model of blade {wildcards.blade}, from elsewhere"
    script:
        "../scripts/take_rom.py"


# At further speeds of the full model, too, where neighbours disagree.
rule check_rom:
    input:
        unpack(mesh_of),
        code=sources(
            *(f"rom/{n}.py" for n in ("between", "check", "compliance", "full_model", "model")),
            *(f"rom/{n}.py" for n in ("polynomial", "speeds", "stored")),
        ),
        full="results/{blade}/full-model.nc",
        rom="results/{blade}/rom-{directions}.nc",
    output:
        check="results/{blade}/rom-check-{directions}.nc",
    log:
        "results/{blade}/logs/check-rom-{directions}.log",
    params:
        settings=blade_file,
        basis=lambda wildcards: speeds_of_basis(wildcards) if mesh_of(wildcards) else None,
        tolerance=lambda wildcards: blade_settings(wildcards.blade).basis.tolerance_percent,
    message:
        "Reduced against full model of blade {wildcards.blade}, interface {wildcards.directions}"
    script:
        "../scripts/check_rom.py"


rule rom:
    input:
        [
            f"results/{blade}/{file}-{directions_of(blade)}.nc"
            for blade in BLADES
            for file in ("rom", *(() if blade in FOREIGN else ("rom-check",)))
        ],
