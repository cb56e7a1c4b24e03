FEM_USES = (*GEOMETRY_USES, "material", "max_speed_rpm", "prestress")


rule build_mesh_at_rest:
    input:
        source=blades.source,
        code=code_of("build_mesh_at_rest"),
    output:
        mesh="results/{blade}/blade.msh",
    log:
        "results/{blade}/logs/mesh.log",
    benchmark:
        "results/{blade}/benchmarks/mesh.tsv"
    wildcard_constraints:
        blade=one_of(blades.as_it_runs),
    params:
        contents=blades.contents,
        blade=blades.file,
        uses=blades.uses(*GEOMETRY_USES, "geometry_at_rpm", "material"),
    message:
        "Mesh of blade {wildcards.blade} at rest"
    script:
        "../scripts/build_mesh_at_rest.py"


rule assemble:
    input:
        code=code_of("assemble"),
        mesh="results/{blade}/blade.msh",
    output:
        matrices="results/{blade}/matrices.h5",
    log:
        "results/{blade}/logs/assemble.log",
    benchmark:
        "results/{blade}/benchmarks/assemble.tsv"
    wildcard_constraints:
        blade=one_of(blades.meshed),
    priority: LONGEST
    resources:
        mem_mb=blades.memory("assemble"),
    params:
        blade=blades.file,
        uses=blades.uses(*FEM_USES),
        basis=blades.speeds_of_basis,
    message:
        "M and K(Omega) of blade {wildcards.blade} at the speeds of the basis"
    script:
        "../scripts/assemble.py"


rule read_matrices:
    input:
        source=blades.source,
        code=code_of("read_matrices"),
    output:
        matrices="results/{blade}/matrices.h5",
    log:
        "results/{blade}/logs/read-matrices.log",
    wildcard_constraints:
        blade=one_of(blades.with_matrices),
    params:
        contents=blades.contents,
        blade=blades.file,
        uses=lambda wildcards: blades.of(wildcards).settings_of_matrices(),
    message:
        "M and K(Omega) of blade {wildcards.blade} from elsewhere"
    script:
        "../scripts/read_matrices.py"
