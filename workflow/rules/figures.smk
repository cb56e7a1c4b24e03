include: "figure_names.smk"


for name, (module, files, names, category, shows) in FIGURES.items():

    rule:
        name:
            name
        input:
            unpack(files),
            code=code_of("workflow.jobs.figure", f"workflow.figures.{module}"),
        output:
            png=picture(f"../report/{name}.rst", category, shows),
            pdf="results/figures/{figure}.pdf",
        log:
            "results/figures/logs/{figure}.log",
        wildcard_constraints:
            figure=one_of(names),
        localrule: True
        params:
            run="workflow.jobs.figure:draw",
            module=f"workflow.figures.{module}",
            given=given_figure,
        message:
            f"{shows[0].upper()}{shows[1:]}: {{wildcards.figure}}"
        script:
            "../scripts/job.py"


rule summary:
    input:
        unpack(files_of_summary),
        code=code_of("workflow.figures.summary"),
    output:
        json="results/figures/{figure}.json",
        markdown=report(
            "results/figures/{figure}.md",
            caption="../report/summary.rst",
            category="Numbers",
            labels={"figure": "{figure}", "shows": "values in the figures"},
        ),
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(SUMMARIES),
    localrule: True
    params:
        run="workflow.figures.summary:numbers",
        given=lambda wildcards: {"scenes": scenes_of_summary(wildcards)},
    message:
        "Values in the figures: {wildcards.figure}"
    script:
        "../scripts/job.py"


rule figures:
    input:
        all_figures(),
