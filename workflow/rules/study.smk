# Studies: run when asked for, no part of `rule all`.

# Sizes of the mesh study over the blade's own, coarse to fine.
MESH_FACTORS = (2.0, 2**0.5, 1.0, 0.5**0.5)
MESH_CONVERGENCE = figures_of_blades("mesh-convergence", BLADE_FILES)


rule mesh_level:
    input:
        unpack(blade_source),
        code=sources(
            "geometry/*.py",
            "fem/*.py",
            "rom/modes.py",
            "workflow/study/mesh_level.py",
            "workflow/study/variants.py",
        ),
    output:
        json="results/{blade}/mesh-convergence/level-{level}.json",
    log:
        "results/{blade}/logs/mesh-level-{level}.log",
    benchmark:
        "results/{blade}/benchmarks/mesh-level-{level}.tsv"
    wildcard_constraints:
        level="|".join(map(str, range(len(MESH_FACTORS)))),
    params:
        module="workflow.study.mesh_level",
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        given=lambda wildcards: {
            "blade": blade_file(wildcards),
            "factor": MESH_FACTORS[int(wildcards.level)],
        },
    message:
        "Blade {wildcards.blade} on mesh {wildcards.level} of its mesh study"
    script:
        "../scripts/numbers.py"


rule mesh_convergence:
    input:
        code=sources("workflow/study/mesh.py"),
        levels=lambda wildcards: expand(
            "results/{blade}/mesh-convergence/level-{level}.json",
            blade=MESH_CONVERGENCE[wildcards.figure],
            level=range(len(MESH_FACTORS)),
        ),
    output:
        json="results/figures/{figure}.json",
    log:
        "results/figures/logs/{figure}-limits.log",
    wildcard_constraints:
        figure=one_of(MESH_CONVERGENCE),
    params:
        module="workflow.study.mesh",
        given={"own": MESH_FACTORS.index(1.0)},
    message:
        "Limits of the mesh study {wildcards.figure}"
    script:
        "../scripts/numbers.py"


rule draw_mesh_convergence:
    input:
        code=drawn_by() + sources("workflow/study/mesh.py"),
        study="results/figures/{figure}.json",
    output:
        png="results/figures/{figure}.png",
        pdf="results/figures/{figure}.pdf",
    log:
        "results/figures/logs/{figure}.log",
    wildcard_constraints:
        figure=one_of(MESH_CONVERGENCE),
    params:
        module="workflow.study.mesh",
    message:
        "Mesh study {wildcards.figure}"
    script:
        "../scripts/figure.py"


rule study_mesh:
    input:
        expand(
            "results/figures/{name}.{suffix}",
            name=[n for n, b in MESH_CONVERGENCE.items() if b in BLADES and BLADES[b].mesh],
            suffix=["png", "pdf"],
        ),


rule compare_bases:
    input:
        code=sources("rom/*.py", "fem/matrices.py", "workflow/study/bases.py"),
        matrices="results/{blade}/matrices.h5",
        full="results/{blade}/full-model.nc",
        of_paper=lambda wildcards: [
            f"results/{wildcards.blade}-paper/{file}"
            for file in ("matrices.h5", "full-model.nc")
            if f"{wildcards.blade}-paper" in BLADE_FILES
        ],
    output:
        json="results/{blade}/bases.json",
    log:
        "results/{blade}/logs/bases.log",
    benchmark:
        "results/{blade}/benchmarks/bases.tsv"
    params:
        module="workflow.study.bases",
    message:
        "Reduction bases of blade {wildcards.blade} against the full model"
    script:
        "../scripts/numbers.py"


rule study_bases:
    input:
        [
            f"results/{name}/bases.json"
            for name, blade in BLADES.items()
            if len(basis_speeds(blade.basis, 1.0)) == 4  # those of the default
        ],


STUDY_OF_FREQUENCIES = sources(
    "fem/*.py",
    "rom/modes.py",
    "workflow/study/rotor37.py",
    "workflow/study/variants.py",
)


rule frequencies:
    input:
        code=STUDY_OF_FREQUENCIES,
        mesh="results/{blade}/blade.msh",
    output:
        json="results/{blade}/frequencies.json",
    log:
        "results/{blade}/logs/frequencies.log",
    benchmark:
        "results/{blade}/benchmarks/frequencies.tsv"
    params:
        module="workflow.study.rotor37",
        function="prestresses",
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
        given=lambda wildcards: {"blade": blade_file(wildcards)},
    message:
        "Frequencies of blade {wildcards.blade} with either prestress"
    script:
        "../scripts/numbers.py"


rule edge_cuts:
    input:
        unpack(blade_source),
        code=sources("geometry/*.py") + STUDY_OF_FREQUENCIES,
    output:
        json="results/{blade}/edge-cuts.json",
    log:
        "results/{blade}/logs/edge-cuts.log",
    benchmark:
        "results/{blade}/benchmarks/edge-cuts.tsv"
    params:
        module="workflow.study.rotor37",
        function="edge_cuts",
        blade=blade_file,
        uses=blade_uses(*GEOMETRY_USES, "material"),
        given=lambda wildcards: {"blade": blade_file(wildcards)},
    message:
        "Blade {wildcards.blade} with other cuts of its edges"
    script:
        "../scripts/numbers.py"


rule study_rotor37:
    input:
        expand("results/rotor37/{study}.json", study=["frequencies", "edge-cuts"]),


rule map_stability:
    input:
        code=MARCH + sources("workflow/study/stability/map.py"),
        rom=f"results/{PAPER_BLADE}/rom-r.nc",
    output:
        json="results/figures/stability-map.json",
    log:
        "results/figures/logs/stability-map.log",
    params:
        module="workflow.study.stability.map",
        given=lambda wildcards: {"scene": SCENES["paper-e1"].model_dump(mode="json")},
    message:
        "Stable and accurate steps over E"
    script:
        "../scripts/numbers.py"


rule draw_stability:
    input:
        code=drawn_by() + sources("workflow/study/stability/report.py"),
        study="results/figures/stability-map.json",
    output:
        png="results/figures/stability.png",
        pdf="results/figures/stability.pdf",
    log:
        "results/figures/logs/stability.log",
    params:
        module="workflow.study.stability.report",
    message:
        "Map of stable and accurate steps"
    script:
        "../scripts/figure.py"


rule judge_stability:
    input:
        code=MARCH
        + sources(*(f"workflow/study/stability/{n}.py" for n in ("cases", "matrix", "runs"))),
        rom=f"results/{PAPER_BLADE}/rom-rt.nc",
    output:
        json="results/figures/stability-matrix.json",
    log:
        "results/figures/logs/stability-matrix.log",
    benchmark:
        "results/figures/benchmarks/stability-matrix.tsv"
    params:
        module="workflow.study.stability.matrix",
    message:
        "Cases at the extremes"
    script:
        "../scripts/numbers.py"


rule stability:
    input:
        "results/figures/stability.png",
        "results/figures/stability-matrix.json",
