# Answers at the peaks of each scene, and the summary of all of them.
rule answers:
    input:
        code=MARCH,
        rom=rom_of_scene,
        check=check_of_scene,
        mesh_error=known_mesh_error,
        settings=settings_of_scene,
        start=sweep_before,
        sweep="results/{blade}/{scene}/sweep.nc",
    output:
        answers="results/{blade}/{scene}/answers.json",
    log:
        "results/{blade}/{scene}/logs/answers.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/answers.tsv"
    message:
        "Peaks of scene {wildcards.scene}: force, torque, wear, and what is not known of them"
    script:
        "../scripts/answers.py"


rule summary_of_run:
    input:
        answers=of_scenes("results/{blade}/{scene}/answers.json"),
        stress=[
            f"results/{scene.blade}/{name}/peak.json"
            for name, scene in SWEEPS.items()
            if scene.record.states_rounds
        ],
        pages=[f"results/{SCENES[name].blade}/{name}/stress.json" for name in EXPLORED],
        code=sources("workflow/summary.py", "workflow/markdown.py"),
    output:
        json="results/summary.json",
        csv="results/summary.csv",
        markdown=report(
            "results/summary.md",
            caption="../report/summary-of-run.rst",
            category="Numbers",
            labels={"figure": "summary", "shows": "critical speeds, loads, wear, in rpm, µm, N"},
        ),
    log:
        "results/logs/summary.log",
    localrule: True
    params:
        module="workflow.summary",
        given={"operating": {name: blade.operating_rpm for name, blade in BLADES.items()}},
    message:
        "Summary of the run"
    script:
        "../scripts/compute.py"


# Where the summary was among what was asked for, it is the last that the terminal shows.
onsuccess:
    if SUMMARY in {str(file) for job in workflow.dag.jobs for file in job.output}:
        print(last_words("results"), flush=True)
