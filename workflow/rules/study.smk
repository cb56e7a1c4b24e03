# Studies: run on request, not part of `rule all`.
include: "study_names.smk"


wildcard_constraints:
    level="|".join(map(str, range(len(MESH_FACTORS)))),
    jobs=r"\d+",


for study, (module, files, drawn) in STUDY_PICTURES.items():

    rule:
        name:
            study
        input:
            **files,
            code=code_of("workflow.jobs.figure", f"workflow.{module}"),
        output:
            png=f"{drawn}.png",
            pdf=f"{drawn}.pdf",
        log:
            f"{kept_beside(drawn, 'logs')}-picture.log",
        wildcard_constraints:
            figure=one_of(MESH_CONVERGENCE),
        localrule: True
        params:
            run="workflow.jobs.figure:draw",
            module=f"workflow.{module}",
        message:
            "Picture {output.png}"
        script:
            "../scripts/job.py"


rule study_mesh:
    input:
        expand(
            "results/figures/{name}.{suffix}",
            name=[
                n
                for n, b in MESH_CONVERGENCE.items()
                if b in BLADES and b in MESHED and BLADES[b].mesh
            ],
            suffix=["png", "pdf"],
        ),


rule study_bases:
    input:
        [
            f"results/{name}/bases.json"
            for name, blade in BLADES.items()
            if name in MESHED and len(basis_speeds(blade.basis, 1.0)) == 4  # those of the default
        ],


rule study_rotor37:
    input:
        expand("results/rotor37/{study}.json", study=["frequencies", "edge-cuts"]),


rule stability:
    input:
        "results/figures/stability.png",
        "results/figures/stability-matrix.json",


rule trade:
    input:
        "results/experiments/trade/table.md",
        [f"{drawn}.png" for *_, drawn in STUDY_PICTURES.values() if "/trade/" in drawn],


rule scaling:
    input:
        "results/scaling/scaling.png",
        "results/scaling/scaling.json",
