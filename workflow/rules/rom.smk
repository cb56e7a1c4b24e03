rule reduce:
    input:
        code=sources("rom/*.py", "fem/matrices.py", "fem/interface.py"),
        matrices="results/{blade}/matrices.h5",
    output:
        rom="results/{blade}/rom-rtz.nc",
        basis="results/{blade}/basis.h5",
    log:
        "results/{blade}/logs/reduce.log",
    benchmark:
        "results/{blade}/benchmarks/reduce.tsv"
    params:
        blade=blade_file,
        uses=blade_uses("basis"),
    message:
        "Reduced model of blade {wildcards.blade}"
    script:
        "../scripts/reduce.py"


rule check_rom:
    input:
        code=sources("rom/*.py", "fem/matrices.py", "fem/interface.py"),
        matrices="results/{blade}/matrices-check.h5",
        rom="results/{blade}/rom-rtz.nc",
    output:
        check="results/{blade}/rom-check.nc",
    log:
        "results/{blade}/logs/check-rom.log",
    benchmark:
        "results/{blade}/benchmarks/check-rom.tsv"
    message:
        "Reduced against full model of blade {wildcards.blade}"
    script:
        "../scripts/check_rom.py"


rule rom:
    input:
        expand("results/{blade}/{file}", blade=BLADES, file=["rom-rtz.nc", "rom-check.nc"]),
