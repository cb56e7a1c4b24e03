rule gauges:
    input:
        code=code_of("workflow.jobs.gauges"),
        mesh="results/{blade}/blade.msh",
        basis=basis_of_scene,
        rom=rom_with_directions,
    output:
        model="results/{blade}/{scene}/gauges.nc",
    log:
        "results/{blade}/{scene}/logs/gauges.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/gauges.tsv"
    wildcard_constraints:
        blade=one_of(MESHED),
    params:
        run="workflow.jobs.gauges:place",
        settings=blade_file,
        uses=blade_uses("material", "prestress", *SOURCES),
        record=gauges_of_scene,
    message:
        "What the strain gauges of scene {wildcards.scene} read"
    script:
        "../scripts/job.py"


rule stress:
    input:
        code=code_of("workflow.stress"),
        mesh="results/{blade}/blade.msh",
        rom=rom_of_scene,
        basis=basis_of_scene,
        sweep=sweep_with_motion,
    output:
        vtu="results/{blade}/{scene}/stress.vtu",
        json="results/{blade}/{scene}/stress.json",
    log:
        "results/{blade}/{scene}/logs/stress.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/stress.tsv"
    params:
        run="workflow.stress:write",
        blade=blade_file,
        uses=blade_uses("material", "prestress", "fatigue", "stress", *SOURCES),
    message:
        "Mean and alternating stress of scene {wildcards.scene}"
    script:
        "../scripts/job.py"
