# A rule for each row of the table of figures, workflow/figures/figures.yaml, and the summaries.
from workflow.figures import table

FIGURES = table.Figures(
    read_or_fail(table.read, own_files(["workflow/figures/figures.yaml"])[0]),
    table.Project(
        scenes=SCENES,
        configured=DELIVERED,
        explored=EXPLORED,
        directions=directions_of,
        operating=lambda blade: blade_settings(blade).operating_rpm,
        blades={
            "matrices": lambda blade: blade not in FOREIGN,
            "mesh": lambda blade: blade in MESHED,
            "element sizes": lambda blade: blade in MESHED and blade_settings(blade).mesh,
        },
    ),
)
PAPER_BLADE = "reference"


def figures_of_blades(of_paper, shows, names):
    """Blade by name of its file; that of the paper's blade has no blade in its name."""
    return {of_paper if name == PAPER_BLADE else f"{shows}-{name}": name for name in names}


SUMMARIES = figures_of_blades(
    "summary", "summary", sorted({scene.blade for scene in SWEEPS.values()})
)


def of_figure(told, name):
    """What a method of FIGURES tells of a figure by its wildcards."""
    return lambda wildcards: read_or_fail(told, name, dict(wildcards.items()))


def files_of_summary(wildcards):
    """The reduced model, its check and the sweeps of a blade's scenes."""
    blade = SUMMARIES[wildcards.figure]
    of = f"results/{blade}", directions_of(blade)
    check = {} if blade in FOREIGN else {"check": "{}/rom-check-{}.nc".format(*of)}
    sweeps = [f"results/{blade}/{name}/sweep.nc" for name in scenes_of_summary(wildcards)]
    return {"rom": "{}/rom-{}.nc".format(*of), "sweeps": sweeps} | check


def scenes_of_summary(wildcards):
    blade = SUMMARIES[wildcards.figure]
    return [name for name, scene in SWEEPS.items() if scene.blade == blade]


def pictures(names):
    """Both files of each figure."""
    return expand("{path}.{suffix}", path=map(table.path_of, names), suffix=["png", "pdf"])


def all_figures():
    """Every figure of the scenes to deliver, and the summaries."""
    return [
        *pictures(FIGURES.configured(lambda row: row.part == table.DELIVERED)),
        *expand("results/figures/{name}.{suffix}", name=SUMMARIES, suffix=["json", "md"]),
    ]


for name, row in FIGURES.rows.items():
    path = table.path_of(name)

    rule:
        name:
            f"draw_{re.sub(r'\W+', '_', name).strip('_')}"
        input:
            unpack(of_figure(FIGURES.files, name)),
            code=code_of("workflow.jobs.figure", f"workflow.{row.draw}"),
        output:
            png=report(
                f"{path}.png",
                caption="../report/figure.rst",
                category=row.category,
                labels={"figure": name, "shows": row.title},
            ),
            pdf=f"{path}.pdf",
        log:
            f"{kept_beside(path, 'logs')}-picture.log",
        localrule: True
        params:
            run="workflow.jobs.figure:draw",
            module=f"workflow.{row.draw}",
            given=of_figure(FIGURES.given, name),
            caption=of_figure(FIGURES.caption, name),
        message:
            f"{row.title[0].upper()}{row.title[1:]}: {{output.png}}"
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
