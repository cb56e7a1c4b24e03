# The paper: its claims and their cost. Run on request, not part of `rule all`.
further = paper.Further(scenes)


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/index.html",
        "results/paper/cost.md",
        pictures(
            name
            for name, row in FIGURES.rows.items()
            if row.category == "The paper" or name.startswith("fig")
        ),
        pictures(["stress-paper-e10"]),


rule paper_beyond:
    input:
        "results/paper/long-times.json",
        pictures(["long-times"]),


for target in ("paper_uncertainty", "paper_causes", "paper_rotor37"):

    rule:
        name:
            target
        input:
            further.files(target),


rule paper_grid:
    input:
        rows="results/experiments/grid/table.json",
        code=code_of("paper_grid"),
    output:
        json="results/paper/grid.json",
    log:
        "results/paper/logs/grid.log",
    message:
        "Table of E and K"
    script:
        "../scripts/paper_grid.py"


rule growth:
    input:
        table="results/experiments/{experiment}/table.json",
        models=experiments.models_of_growth,
        code=code_of("growth"),
    output:
        json="results/experiments/{experiment}/growth.json",
    log:
        "results/experiments/{experiment}/logs/growth.log",
    benchmark:
        "results/experiments/{experiment}/benchmarks/growth.tsv"
    message:
        "Worst coatings over 200 revolutions, {wildcards.experiment}"
    script:
        "../scripts/growth.py"


rule paper_worst:
    input:
        table="results/experiments/grid/table.json",
        growth="results/experiments/grid/growth.json",
        code=code_of("paper_worst"),
    output:
        json="results/paper/growth.json",
    log:
        "results/paper/logs/growth.log",
    message:
        "Worst coatings over 200 revolutions, and the bare casing"
    script:
        "../scripts/paper_worst.py"


# Of a blade, and of its variant reduced as in the paper.
rule paper_model:
    input:
        rom="results/{blade}/rom-r.nc",
        check="results/{blade}/rom-check-r.nc",
        paper="results/{blade}-points/rom-rtz.nc",
        paper_check="results/{blade}-points/rom-check-rtz.nc",
        nonlinear="results/reference-points-coarse/rom-rtz.nc",  # its K2 is not zero
        code=code_of("paper_model"),
    output:
        json="results/{blade}/paper-model.json",
    log:
        "results/{blade}/logs/paper-model.log",
    benchmark:
        "results/{blade}/benchmarks/paper-model.tsv"
    params:
        blade=blades.file,
    message:
        "The paper's reduced model, blade {wildcards.blade}"
    script:
        "../scripts/paper_model.py"


rule paper_settled:
    input:
        rom="results/paper/rom-r.nc",
        densities=paper.sweeps("density-1", "density-4"),
        steps=paper.sweeps("step-08", "step-04", "step-02"),
        stress="results/paper/paper-e10/stress.json",
        code=code_of("paper_settled"),
    output:
        json="results/paper/settled.json",
    log:
        "results/paper/logs/settled.log",
    benchmark:
        "results/paper/benchmarks/settled.tsv"
    params:
        # whose density is changed, for its cost
        scene=lambda wildcards: scenes["paper-density-1"].model_dump(mode="json"),
    message:
        "Densities, steps, laws, cost of the density, stress"
    script:
        "../scripts/paper_settled.py"


rule paper_numbers:
    input:
        e1="results/paper/paper-e1/sweep.nc",
        e10="results/paper/paper-e10/sweep.nc",
        two_five="results/paper/paper-two-five/sweep.nc",
        tilted="results/paper/paper-tilted/sweep.nc",
        tangential="results/paper/paper-tangential/sweep.nc",
        rom="results/paper/rom-r.nc",
        grid="results/experiments/grid/table.json",
        growth="results/experiments/grid/growth.json",
        more=["results/paper/paper-model.json", "results/paper/settled.json"],
        code=code_of("paper_numbers"),
    output:
        json="results/paper/numbers.json",
    log:
        "results/paper/logs/numbers.log",
    benchmark:
        "results/paper/benchmarks/numbers.tsv"
    message:
        "Numbers of the claims"
    script:
        "../scripts/paper_numbers.py"


rule paper_long_times:
    input:
        unpack(lambda wildcards: FIGURES.files("long-times", {})),
        code=code_of("paper_long_times"),
    output:
        json="results/paper/long-times.json",
    log:
        "results/paper/logs/long-times.log",
    benchmark:
        "results/paper/benchmarks/long-times.tsv"
    message:
        "Long times, beyond the paper"
    script:
        "../scripts/paper_long_times.py"


# Further runs that were asked for in the same call of Snakemake are waited for.
rule paper_claims:
    input:
        numbers="results/paper/numbers.json",
        further=lambda wildcards: further.files(*workflow.dag_settings.targets)(wildcards),
        narrow="workflow/paper/identified/narrow.json",
        wide="workflow/paper/identified/wide.json",
        code=code_of("paper_claims"),
    output:
        json="results/paper/claims.json",
        markdown=report(
            "results/paper/claims.md",
            caption="../report/claims.rst",
            category="The paper",
            labels={"figure": "claims", "shows": "verdicts on the paper's claims"},
        ),
        html="results/paper/index.html",
    log:
        "results/paper/logs/claims.log",
    params:
        further=further.existing,
        times=further.times,
    message:
        "Verdicts on the paper's claims: table, and page of figures side by side"
    script:
        "../scripts/paper_claims.py"


rule paper_conclusions:
    input:
        claims="results/paper/claims.json",
        identified="workflow/paper/identified/narrow.json",
        long="results/paper/long-times.json",
        code=code_of("paper_conclusions"),
    output:
        markdown="results/paper/conclusions.md",
    log:
        "results/paper/logs/conclusions.md.log",
    message:
        "What a reader may conclude"
    script:
        "../scripts/paper_conclusions.py"


rule paper_cost:
    input:
        claims="results/paper/claims.json",
        code=code_of("paper_cost"),
    output:
        markdown="results/paper/cost.md",
    log:
        "results/paper/logs/cost.md.log",
    params:
        targets=paper.folders(),
    message:
        "Cost of the paper's targets"
    script:
        "../scripts/paper_cost.py"
