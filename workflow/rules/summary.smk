# Answers at the peaks of each scene, and the summary of all of them.
rule answers:
    input:
        code=code_of("workflow.jobs.answers"),
        rom=rom_of_scene,
        check=check_of_scene,
        mesh_error=known_mesh_error,
        start=sweep_before,
        stress=stress_of_scene,
        sweep="results/{blade}/{scene}/sweep.nc",
    output:
        json="results/{blade}/{scene}/answers.json",
    log:
        "results/{blade}/{scene}/logs/answers.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/answers.tsv"
    params:
        run="workflow.jobs.answers:find",
        contents=contents_of_scene,
    message:
        "Peaks of scene {wildcards.scene}: force, torque, wear, and their uncertainty"
    script:
        "../scripts/job.py"


rule summary:
    input:
        answers=of_scenes("results/{blade}/{scene}/answers.json"),
        roms=[f"results/{scene.blade}/rom-{scene.directions}.nc" for scene in SWEEPS.values()],
        stress=[f"results/{SCENES[name].blade}/{name}/stress.json" for name in STRESSED],
        code=code_of("workflow.summary"),
    output:
        json="results/summary.json",
        csv="results/summary.csv",
        margins="results/margins.csv",
        markdown=report(
            "results/summary.md",
            caption="../report/summary.rst",
            category="Numbers",
            labels={"figure": "summary", "shows": "critical speeds, loads, wear, in rpm, µm, N"},
        ),
    log:
        "results/logs/summary.log",
    localrule: True
    params:
        run="workflow.summary:numbers",
        given=lambda wildcards: {
            "operating": {blade: operating_of(blade) for blade in BLADES},
            "others": others_with_results(),
        },
    message:
        "Summary of the run"
    script:
        "../scripts/job.py"


# Where tables of designs and the summary were among what was asked for, they are the last that the terminal shows.
onsuccess:
    made = {str(file) for job in workflow.dag.jobs for file in job.output}
    for name in [name for name, scene in DELIVERED.items() if scene.design]:
        pictures = [f"results/figures/{kind}-{name}.png" for kind in ("design", "sensitivity")]
        files = [f"results/{DELIVERED[name].blade}/{name}/design.csv", *pictures]
        if found := [file for file in files if file in made]:
            print(
                f"Design of scene {name}: {', '.join(found)}; {table_words(files[0])}.",
                flush=True,
            )
    for path in sorted(
        file for file in made if re.fullmatch(r"results/experiments/[^/]+/table\.csv", file)
    ):
        print(f"Experiment: {path}; {table_words(path)}.", flush=True)
    if SUMMARY in made:
        print(last_words("results"), flush=True)
