# A rule for each row of the tables of figures, workflow/figures/figures.yaml and that of the paper.
for name, row in FIGURES.rows.items():
    path = table.path_of(name)
    folder, _, file = path.rpartition("/")

    rule:
        name:
            f"draw_{re.sub(r'\W+', '_', name).strip('_')}"
        input:
            unpack(project.of_figure(FIGURES.files, name)),
            code=code_of("figure", f"workflow.{row.draw}"),
        output:
            png=report(
                f"{path}.png",
                caption="../report/figure.rst",
                category=row.category,
                labels={"figure": name, "shows": row.title},
            ),
            pdf=f"{path}.pdf",
        log:
            f"{folder}/logs/{file}-picture.log",
        localrule: True
        params:
            module=f"workflow.{row.draw}",
            given=project.of_figure(FIGURES.given, name),
            caption=project.of_figure(FIGURES.caption, name),
        message:
            f"{row.title[0].upper()}{row.title[1:]}: {{output.png}}"
        script:
            "../scripts/figure.py"


rule figures:
    input:
        project.delivered_figures(),
