GEOMETRY_USES = ("sections", "section_table", "cad", "mesh_file", "mesh", "interface")


rule build_mesh:
    input:
        source=blades.source,
        code=code_of("build_mesh"),
    output:
        mesh="results/{blade}/blade.msh",
    log:
        "results/{blade}/logs/mesh.log",
    benchmark:
        "results/{blade}/benchmarks/mesh.tsv"
    wildcard_constraints:
        blade=one_of([name for name in blades.meshed if name not in blades.as_it_runs]),
    params:
        contents=blades.contents,
        blade=blades.file,
        uses=blades.uses(*GEOMETRY_USES),
    message:
        "Mesh of blade {wildcards.blade}"
    script:
        "../scripts/build_mesh.py"


rule mesh:
    input:
        [f"results/{name}/blade.msh" for name in project.delivered_blades if name in blades.meshed],
