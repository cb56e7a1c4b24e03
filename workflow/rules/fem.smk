FEM_USES = (*GEOMETRY_USES, "material", "max_speed_rad_s", "prestress")

ASSEMBLY = sources(*MATRICES_CODE, "fem/matrices.py", "rom/speeds.py")
RESOLVED = sources(
    *(f"rom/{n}.py" for n in ("between", "full_model", "modes", "polynomial", "projection")),
    "workflow/assembled.py",
)


rule assemble:
    input:
        code=ASSEMBLY + RESOLVED,
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
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        basis=speeds_of_basis,
    message:
        "M and K(Omega) of blade {wildcards.blade} at the speeds of the basis"
    script:
        "../scripts/assemble.py"


rule read_matrices:
    input:
        unpack(blade_source),
        code=sources(*MATRICES_CODE, "fem/matrices.py", "fem/given.py", "geometry/given.py"),
    output:
        matrices="results/{blade}/matrices.h5",
    log:
        "results/{blade}/logs/read-matrices.log",
    wildcard_constraints:
        blade=one_of(blades_with(GivenMatrices.key)),
    params:
        blade=blade_file,
        uses=lambda wildcards: blade_settings(wildcards.blade).settings_of_matrices(),
    message:
        "M and K(Omega) of blade {wildcards.blade} from elsewhere"
    script:
        "../scripts/read_matrices.py"
