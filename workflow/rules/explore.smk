rule explore:
    input:
        code=code_of("workflow.jobs.explore"),
        parts=own_files(
            f"workflow/explore/{name}"
            for name in ("blade.js", "page.css", "page.html", "page.js", "save.js", "units.js")
        ),
        mesh="results/{blade}/blade.msh",
        rom=rom_of_scene,
        basis=basis_of_scene,
        sweep="results/{blade}/{scene}/sweep.nc",
        answers="results/{blade}/{scene}/answers.json",
        stress=stress_of_page,
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
    log:
        "results/{blade}/{scene}/logs/explore.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/explore.tsv"
    params:
        run="workflow.jobs.explore:write",
        blade=blade_file,
        uses=blade_uses("material", "prestress"),
        operating=lambda wildcards: operating_of(wildcards.blade),
    message:
        "Page to explore scene {wildcards.scene}"
    script:
        "../scripts/job.py"


rule rub:
    input:
        code=code_of("workflow.jobs.rub"),
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
        format="gif|mp4|png",
    params:
        run="workflow.jobs.rub:animate",
        contents=contents_of_scene,
        scene=settings_told,
    message:
        "Animation of scene {wildcards.scene} at {wildcards.speed} f1(0)"
    script:
        "../scripts/job.py"
