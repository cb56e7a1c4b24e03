# Studies: run when asked for, no part of `rule all`.
include: "study_names.smk"


for study, row in STUDIES.items():

    rule:
        name:
            study
        input:
            unpack(row["files"]),
            code=study_code(row["module"]) + row.get("code", []),
        output:
            json=row["json"],
        log:
            f"{kept_beside(row['json'], 'log')}.log",
        benchmark:
            f"{kept_beside(row['json'], 'benchmark')}.tsv"
        wildcard_constraints:
            figure=one_of(MESH_CONVERGENCE),
            level="|".join(map(str, range(len(MESH_FACTORS)))),
        params:
            module=f"workflow.study.{row['module']}",
            function=row.get("function", "numbers"),
            given=row.get("given", {}),
            blade=blade_file if "{blade}" in row["json"] else "",
            uses=blade_uses(*row["uses"]) if "uses" in row else "",
        message:
            row["message"]
        script:
            "../scripts/numbers.py"


for study, (drawer, numbers, figure) in STUDY_PICTURES.items():

    rule:
        name:
            study
        input:
            code=drawn_by() + study_code(drawer),
            study=f"results/figures/{numbers}.json",
        output:
            png=f"results/figures/{figure}.png",
            pdf=f"results/figures/{figure}.pdf",
        log:
            f"results/figures/logs/{figure}-picture.log",
        wildcard_constraints:
            figure=one_of(MESH_CONVERGENCE),
        params:
            module=f"workflow.study.{drawer}",
        message:
            "Picture {output.png}"
        script:
            "../scripts/figure.py"


rule study_mesh:
    input:
        expand(
            "results/figures/{name}.{suffix}",
            name=[n for n, b in MESH_CONVERGENCE.items() if b in BLADES and BLADES[b].mesh],
            suffix=["png", "pdf"],
        ),


rule study_bases:
    input:
        [
            f"results/{name}/bases.json"
            for name, blade in BLADES.items()
            if len(basis_speeds(blade.basis, 1.0)) == 4  # those of the default
        ],


rule study_rotor37:
    input:
        expand("results/rotor37/{study}.json", study=["frequencies", "edge-cuts"]),


rule stability:
    input:
        "results/figures/stability.png",
        "results/figures/stability-matrix.json",
