rule frequencies:
    input:
        code=sources("fem/*.py", "rom/modes.py", "rom/speeds.py"),
        mesh="results/{blade}/blade.msh",
        interface="results/{blade}/interface.csv",
    output:
        json="results/{blade}/frequencies.json",
    log:
        "results/{blade}/logs/frequencies.log",
    benchmark:
        "results/{blade}/benchmarks/frequencies.tsv"
    params:
        blade=blade_file,
        uses=blade_uses(*FEM_USES),
    message:
        "Frequencies of blade {wildcards.blade} with either prestress"
    script:
        "../scripts/frequencies.py"
