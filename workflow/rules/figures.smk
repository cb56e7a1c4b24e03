# A rule for each row of the table of figures, workflow/figures/figures.yaml.
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
        },
    ),
)
PAPER_BLADE = "reference"


def of_figure(told, name):
    """What a method of FIGURES tells of a figure by its wildcards."""
    return lambda wildcards: read_or_fail(told, name, dict(wildcards.items()))


def pictures(names):
    """Both files of each figure."""
    return expand("{path}.{suffix}", path=map(table.path_of, names), suffix=["png", "pdf"])


def all_figures():
    """Every figure of the scenes to deliver."""
    return pictures(FIGURES.configured(lambda row: row.part == table.DELIVERED))


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


rule figures:
    input:
        all_figures(),
