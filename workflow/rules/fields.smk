rule gauges:
    input:
        code=code_of("gauges"),
        mesh="results/{blade}/blade.msh",
        basis=scenes.basis,
        rom=scenes.rom_of_blade,
    output:
        model="results/{blade}/{scene}/gauges.nc",
    log:
        "results/{blade}/{scene}/logs/gauges.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/gauges.tsv"
    wildcard_constraints:
        blade=one_of(blades.meshed),
    params:
        settings=blades.file,
        uses=blades.uses("material", "prestress", *SOURCES),
        record=scenes.told_of_gauges,
    message:
        "What the strain gauges of scene {wildcards.scene} read"
    script:
        "../scripts/gauges.py"


rule gauges_csv:
    input:
        sweep="results/{blade}/{scene}/sweep.nc",
        code=code_of("gauges_csv"),
    output:
        csv="results/{blade}/{scene}/gauges.csv",
    log:
        "results/{blade}/{scene}/logs/gauges.csv.log",
    localrule: True
    params:
        blade=blades.file,
    message:
        "Scene {wildcards.scene}: strain gauges as CSV"
    script:
        "../scripts/gauges_csv.py"


rule stress:
    input:
        code=code_of("stress"),
        mesh="results/{blade}/blade.msh",
        rom=scenes.rom,
        basis=scenes.basis,
        sweep=scenes.sweep_with_motion,
    output:
        vtu="results/{blade}/{scene}/stress.vtu",
        json="results/{blade}/{scene}/stress.json",
    log:
        "results/{blade}/{scene}/logs/stress.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/stress.tsv"
    priority: LONGEST
    params:
        blade=blades.file,
        uses=blades.uses("material", "prestress", "fatigue", "stress", *SOURCES),
    message:
        "Mean and alternating stress of scene {wildcards.scene}"
    script:
        "../scripts/stress.py"
