rule explore:
    input:
        code=code_of("explore"),
        parts=own_files(
            f"workflow/explore/{name}"
            for name in "blade.js page.css page.html page.js save.js stage.js units.js".split()
        ),
        mesh="results/{blade}/blade.msh",
        rom=scenes.rom,
        basis=scenes.basis,
        sweep="results/{blade}/{scene}/sweep.nc",
        answers="results/{blade}/{scene}/answers.json",
        stress=scenes.stress_of_page,
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
        blade=blades.file,
        uses=blades.uses("material", "prestress"),
        operating=lambda wildcards: project.operating(wildcards.blade),
    message:
        "Page to explore scene {wildcards.scene}"
    script:
        "../scripts/explore.py"


rule rub:
    input:
        code=code_of("rub"),
        rom=scenes.rom,
        check=ancient(scenes.check),
        settings=scenes.settings,
        start=scenes.start,
    output:
        animation="results/{blade}/{scene}/rub-{speed}.{format}",
    log:
        "results/{blade}/{scene}/logs/rub-{speed}-{format}.log",
    wildcard_constraints:
        speed=r"\d+(\.\d+)?",
        format="gif|mp4|png",
    params:
        contents=scenes.contents,
        scene=scenes.told,
    message:
        "Animation of scene {wildcards.scene} at {wildcards.speed} f1(0)"
    script:
        "../scripts/rub.py"
