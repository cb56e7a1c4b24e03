rule explore:
    input:
        code=sources(
            *(f"workflow/explore/{name}.py" for name in ("blade", "page", "results")),
            *(
                f"workflow/explore/{name}"
                for name in ("blade.js", "page.css", "page.html", "page.js")
            ),
            "workflow/figures/response.py",
            "workflow/summary.py",
            "fem/fields.py",
            "fem/solid.py",
            "rom/polynomial.py",
            "rom/reconstruct.py",
            "rom/stored.py",
            "simulate/errors/signals.py",
            "simulate/sweeps/peak.py",
        ),
        mesh="results/{blade}/blade.msh",
        rom=rom_of_scene,
        basis=basis_of_scene,
        sweep="results/{blade}/{scene}/sweep.nc",
        answers="results/{blade}/{scene}/answers.json",
    output:
        html=report(
            "results/{blade}/{scene}/explore.html",
            caption="../report/explore.rst",
            category="To explore",
            labels={
                "figure": "{scene}",
                "shows": "every speed: spectrum, wear, history, the blade in motion",
            },
        ),
        stress="results/{blade}/{scene}/stress.json",
    log:
        "results/{blade}/{scene}/logs/explore.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/explore.tsv"
    params:
        blade=blade_file,
        uses=blade_uses("material", "prestress"),
        operating=lambda wildcards: blade_settings(wildcards.blade).operating_rpm,
    message:
        "Page to explore scene {wildcards.scene}"
    script:
        "../scripts/explore.py"


rule rub:
    input:
        code=sources(
            "workflow/explore/rub.py", "workflow/figures/response.py", "workflow/figures/style.py"
        )
        + MARCH,
        rom=rom_of_scene,
        check=ancient(check_of_scene),
        settings=settings_of_scene,
        start=sweep_before,
    output:
        animation="results/{blade}/{scene}/rub-{speed}.{format}",
    log:
        "results/{blade}/{scene}/logs/rub-{speed}-{format}.log",
    wildcard_constraints:
        speed=r"\d+(\.\d+)?",
        format="gif|mp4",
    params:
        scene=settings_told,
    message:
        "Animation of scene {wildcards.scene} at {wildcards.speed} f1(0)"
    script:
        "../scripts/rub.py"
