rule build_mesh:
    input:
        code=sources("geometry/*.py"),
    output:
        mesh="results/{blade}/blade.msh",
        interface="results/{blade}/interface.csv",
    log:
        "results/{blade}/logs/mesh.log",
    benchmark:
        "results/{blade}/benchmarks/mesh.tsv"
    params:
        blade=blade_file,
        uses=blade_uses("sections", "mesh", "interface"),
    message:
        "Mesh of blade {wildcards.blade}"
    script:
        "../scripts/build_mesh.py"


rule mesh:
    input:
        expand("results/{blade}/blade.msh", blade=BLADES),
