FEM_USES = (*GEOMETRY_USES, "material", "max_speed_rpm", "prestress")


use rule build_mesh as build_mesh_at_rest with:
    input:
        unpack(blade_source),
        code=code_of("workflow.jobs.mesh_at_rest"),
    wildcard_constraints:
        blade=one_of(AS_IT_RUNS),
    params:
        run="workflow.jobs.mesh_at_rest:build",
        contents=contents_of_blade,
        blade=blade_file,
        uses=blade_uses(*GEOMETRY_USES, "geometry_at_rpm", "material"),
    message:
        "Mesh of blade {wildcards.blade} at rest"


rule assemble:
    input:
        code=code_of("workflow.jobs.full_model"),
        mesh="results/{blade}/blade.msh",
    output:
        matrices="results/{blade}/matrices.h5",
    log:
        "results/{blade}/logs/assemble.log",
    benchmark:
        "results/{blade}/benchmarks/assemble.tsv"
    wildcard_constraints:
        blade=one_of(MESHED),
    params:
        run="workflow.jobs.full_model:assemble",
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        basis=speeds_of_basis,
    message:
        "M and K(Omega) of blade {wildcards.blade} at the speeds of the basis"
    script:
        "../scripts/job.py"


rule read_matrices:
    input:
        unpack(blade_source),
        code=code_of("workflow.jobs.elsewhere"),
    output:
        matrices="results/{blade}/matrices.h5",
    log:
        "results/{blade}/logs/read-matrices.log",
    wildcard_constraints:
        blade=one_of(WITH_MATRICES),
    params:
        run="workflow.jobs.elsewhere:read",
        contents=contents_of_blade,
        blade=blade_file,
        uses=lambda wildcards: blade_settings(wildcards.blade).settings_of_matrices(),
    message:
        "M and K(Omega) of blade {wildcards.blade} from elsewhere"
    script:
        "../scripts/job.py"
