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
