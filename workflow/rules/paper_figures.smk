# Figures of the paper that `figures.smk` does not draw, and the target `paper`.
rule paper_figure:
    input:
        unpack(lambda wildcards: PAPER_FIGURES[wildcards.figure][1]),
        code=lambda wildcards: code_of("workflow.jobs.figure", drawer(wildcards))(wildcards),
    output:
        png=picture("../report/paper.rst", "The paper", "figure of the paper"),
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(PAPER_FIGURES),
    localrule: True
    params:
        run="workflow.jobs.figure:draw",
        module=drawer,
        caption=lambda wildcards: PAPER_FIGURES[wildcards.figure][2],
        given=lambda wildcards: FIGURE_GIVEN.get(wildcards.figure, {}),
    message:
        "Figure {wildcards.figure} of the paper"
    script:
        "../scripts/job.py"


# Also drawn by the default workflow
SHARED_FIGURES = [
    "fig03",
    "fig09",
    "fig10a",
    "fig10b",
    "fig11a",
    "fig11b",
    "fig12",
    "stress-peak-e1",
]


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/index.html",
        "results/paper/long-times.json",
        "results/paper/cost.md",
        expand(
            "results/figures/{figure}.{suffix}",
            figure=[*SHARED_FIGURES, *PAPER_FIGURES],
            suffix=["png", "pdf"],
        ),
