GEOMETRY_USES = ("sections", "section_table", "cad", "mesh_file", "mesh", "interface")


rule build_mesh:
    input:
        unpack(blade_source),
        code=code_of("workflow.jobs.mesh"),
    output:
        mesh="results/{blade}/blade.msh",
    log:
        "results/{blade}/logs/mesh.log",
    benchmark:
        "results/{blade}/benchmarks/mesh.tsv"
    wildcard_constraints:
        blade=one_of([name for name in MESHED if name not in AS_IT_RUNS]),
    params:
        run="workflow.jobs.mesh:build",
        contents=contents_of_blade,
        blade=blade_file,
        uses=blade_uses(*GEOMETRY_USES),
    message:
        "Mesh of blade {wildcards.blade}"
    script:
        "../scripts/job.py"


rule mesh:
    input:
        expand("results/{blade}/blade.msh", blade=[name for name in BLADES if name in MESHED]),
