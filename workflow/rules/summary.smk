# Answers at the peaks of each scene, and the summary of all of them.
rule answers:
    input:
        code=code_of("answers"),
        rom=scenes.rom,
        check=scenes.check,
        mesh_error=blades.mesh_error,
        start=scenes.start,
        stress=scenes.stress,
        sweep="results/{blade}/{scene}/sweep.nc",
    output:
        json="results/{blade}/{scene}/answers.json",
    log:
        "results/{blade}/{scene}/logs/answers.log",
    benchmark:
        "results/{blade}/{scene}/benchmarks/answers.tsv"
    priority: LONGEST
    params:
        contents=scenes.contents,
    message:
        "Peaks of scene {wildcards.scene}: force, torque, wear, and their uncertainty"
    script:
        "../scripts/answers.py"


rule summary:
    input:
        answers=project.of_sweeps("results/{blade}/{scene}/answers.json"),
        roms=project.of_sweeps("results/{blade}/rom-{directions}.nc"),
        stress=[f"results/{scenes[name].blade}/{name}/stress.json" for name in project.stressed],
        code=code_of("summary"),
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
        operating=project.operating_of_delivered,
        others=project.others_with_results,
    message:
        "Summary of the run"
    script:
        "../scripts/summary.py"


# Where tables of designs and the summary were among what was asked for, they are the last that the terminal shows.
onsuccess:
    for words in closing_words(
        project, {str(of) for job in workflow.dag.jobs for of in job.output}
    ):
        print(words, flush=True)
