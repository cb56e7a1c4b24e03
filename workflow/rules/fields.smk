rule peak:
    input:
        code=code_of("workflow.jobs.peak"),
        mesh="results/{blade}/blade.msh",
        basis=basis_of_scene,
        sweep=sweep_with_states,
    output:
        vtu="results/{blade}/{scene}/peak.vtu",
        json="results/{blade}/{scene}/peak.json",
    log:
        "results/{blade}/{scene}/logs/peak.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/peak.tsv"
    params:
        run="workflow.jobs.peak:write",
        blade=blade_file,
        uses=blade_uses("material", "prestress"),
    message:
        "Displacement and stress of scene {wildcards.scene} when the tip exceeds the gap most"
    script:
        "../scripts/job.py"


rule stress:
    input:
        code=code_of("workflow.jobs.stress"),
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
        run="workflow.jobs.stress:write",
        blade=blade_file,
        uses=blade_uses("material", "prestress", "fatigue"),
    message:
        "Mean and alternating stress of scene {wildcards.scene}"
    script:
        "../scripts/job.py"
