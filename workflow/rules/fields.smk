rule peak:
    input:
        code=sources(
            *(f"fem/{name}.py" for name in ("fields", "solid", "interface")),
            "rom/polynomial.py",
            "rom/reconstruct.py",
            "rom/stored.py",
            "simulate/marching/states.py",
        ),
        mesh="results/{blade}/blade.msh",
        basis=basis_of_scene,
        sweep="results/{blade}/{scene}/sweep.nc",
    output:
        vtu="results/{blade}/{scene}/peak.vtu",
        numbers="results/{blade}/{scene}/peak.json",
    log:
        "results/{blade}/{scene}/logs/peak.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/peak.tsv"
    params:
        blade=blade_file,
        uses=blade_uses("material", "prestress"),
    message:
        "Displacement and stress of scene {wildcards.scene} when the tip exceeds the gap most"
    script:
        "../scripts/peak.py"
