# The paper, figure by figure and claim by claim: run when asked for, no part of `rule all`.
include: "paper_names.smk"


wildcard_constraints:
    edition="|".join(EDITIONS),
    repeat="|".join(REPEATS),
    part="|".join(PARTS.values()),
    row=r"\d+",


rule repeat_sweep:
    input:
        code=MARCH,
        rom=lambda wildcards: rom_of_part(wildcards.repeat, wildcards.part),
    output:
        sweep="results/paper/{repeat}/paper-{part}.nc",
    log:
        "results/paper/{repeat}/logs/paper-{part}.log",
    benchmark:
        "results/paper/{repeat}/benchmarks/paper-{part}.tsv"
    params:
        scene=lambda wildcards: settings_of_part(wildcards.repeat, wildcards.part),
    message:
        "Scene paper-{wildcards.part} with {wildcards.repeat}"
    script:
        "../scripts/repeat_sweep.py"


rule grid_row:
    input:
        code=STUDIED + sources("workflow/paper/grid.py"),
        rom=lambda wildcards: rom_of_part(wildcards.edition, "grid"),
    output:
        json="results/paper/{edition}/grid-{row}.json",
    log:
        "results/paper/{edition}/logs/grid-{row}.log",
    benchmark:
        "results/paper/{edition}/benchmarks/grid-{row}.tsv"
    params:
        table="grid",
        scene=lambda wildcards: settings_of_part(wildcards.edition, "grid"),
        value=lambda wildcards: E[int(wildcards.row)],
    message:
        "Coatings of Table 1, E number {wildcards.row}, {wildcards.edition}"
    script:
        "../scripts/paper_rows.py"


rule grid:
    input:
        code=sources("workflow/paper/grid.py"),
        rows=expand("results/paper/{{edition}}/grid-{row}.json", row=range(len(E))),
    output:
        json="results/paper/{edition}/grid.json",
    log:
        "results/paper/{edition}/logs/grid.log",
    params:
        table="grid",
    message:
        "Table 1, {wildcards.edition}"
    script:
        "../scripts/paper_table.py"


rule growth:
    input:
        code=STUDIED + sources("workflow/paper/worst.py", "workflow/paper/grid.py"),
        grid="results/paper/{edition}/grid.json",
        rom=lambda wildcards: rom_of_part(wildcards.edition, "grid"),
        rigid=lambda wildcards: sweep_of_part(wildcards.edition, "rigid"),
    output:
        json="results/paper/{edition}/growth.json",
    log:
        "results/paper/{edition}/logs/growth.log",
    benchmark:
        "results/paper/{edition}/benchmarks/growth.tsv"
    params:
        scene=lambda wildcards: settings_of_part(wildcards.edition, "grid"),
    message:
        "Worst coatings over 200 rounds, {wildcards.edition}"
    script:
        "../scripts/paper_growth.py"


rule paper_model:
    input:
        code=sources("simulate/peaks.py", "workflow/paper/measure.py"),
        rom=blade_of_edition("rom-r.nc"),
        check=blade_of_edition("rom-check-r.nc"),
        paper=blade_of_edition("rom-rtz.nc", "-paper"),
        paper_check=blade_of_edition("rom-check-rtz.nc", "-paper"),
    output:
        json="results/paper/{edition}/model.json",
    log:
        "results/paper/{edition}/logs/model.log",
    benchmark:
        "results/paper/{edition}/benchmarks/model.tsv"
    message:
        "The paper's reduced model, {wildcards.edition}"
    script:
        "../scripts/paper_model.py"


rule paper_settled:
    input:
        code=STUDIED
        + sources("workflow/paper/measure.py", "workflow/paper/laws.py"),
        rom="results/reference/rom-r.nc",
        densities=[f"results/reference/paper-density-{i}/sweep.nc" for i in (1, 4)],
        steps=[f"results/reference/paper-step-0{i}/sweep.nc" for i in (8, 4, 2)],
        peak="results/reference/peak-e1/peak.json",
    output:
        json="results/paper/reference/settled.json",
    log:
        "results/paper/reference/logs/settled.log",
    benchmark:
        "results/paper/reference/benchmarks/settled.tsv"
    params:
        scene=SCENES["paper-density-1"].model_dump(mode="json"),
    message:
        "Densities, steps, laws, cost of the density, stress"
    script:
        "../scripts/paper_settled.py"


rule paper_numbers:
    input:
        unpack(lambda wildcards: {part: sweep_of_part(wildcards.edition, part) for part in PARTS}),
        code=STUDIED + sources("workflow/paper/grid.py", "workflow/paper/measure.py"),
        rom=lambda wildcards: rom_of_part(wildcards.edition, "e1"),
        grid="results/paper/{edition}/grid.json",
        growth="results/paper/{edition}/growth.json",
        more=more_of_edition,
    output:
        json="results/paper/{edition}/numbers.json",
    log:
        "results/paper/{edition}/logs/numbers.log",
    params:
        parts=SWEPT,
    message:
        "Numbers of the claims, {wildcards.edition}"
    script:
        "../scripts/paper_numbers.py"


rule cause:
    input:
        code=STUDIED + sources("workflow/paper/causes.py", "workflow/paper/measure.py"),
        rom=lambda wildcards: "results/{0.blade}/rom-{0.directions}.nc".format(
            CAUSES[int(wildcards.row)]
        ),
    output:
        json="results/paper/causes/{row}.json",
    log:
        "results/paper/causes/logs/{row}.log",
    benchmark:
        "results/paper/causes/benchmarks/{row}.tsv"
    params:
        study="pair",
        scene=SCENES["paper"].model_dump(mode="json"),
        cause=lambda wildcards: int(wildcards.row),
    message:
        "Both coatings, cause {wildcards.row}"
    script:
        "../scripts/paper_cause.py"


use rule cause as tip_cause with:
    input:
        code=STUDIED + sources("workflow/paper/causes.py", "workflow/paper/measure.py"),
        rom="results/reference/rom-rt.nc",
    output:
        json="results/paper/causes/tip-{row}.json",
    log:
        "results/paper/causes/logs/tip-{row}.log",
    benchmark:
        "results/paper/causes/benchmarks/tip-{row}.tsv"
    params:
        study="tips",
        scene=SCENES["paper-tangential"].model_dump(mode="json"),
        cause=lambda wildcards: int(wildcards.row),
    message:
        "Tip without and with tangential force, cause {wildcards.row}"


use rule grid_row as contact_map_row with:
    input:
        code=STUDIED + sources("workflow/paper/contact_map.py"),
        rom="results/reference/rom-r.nc",
    output:
        json="results/paper/contact-map/row-{row}.json",
    log:
        "results/paper/contact-map/logs/row-{row}.log",
    benchmark:
        "results/paper/contact-map/benchmarks/row-{row}.tsv"
    params:
        table="contact_map",
        scene=SCENES["paper-grid"].changed(integrator__steps_per_round=8192).model_dump(mode="json"),
        value=lambda wildcards: UNITS_PA[int(wildcards.row)],
    message:
        "Contact stiffness number {wildcards.row} over casing amplitudes"


use rule grid as contact_map with:
    input:
        code=sources("workflow/paper/contact_map.py"),
        rows=expand("results/paper/contact-map/row-{row}.json", row=range(len(UNITS_PA))),
    output:
        json="results/paper/contact-map.json",
    log:
        "results/paper/contact-map/logs/contact-map.log",
    params:
        table="contact_map",
    message:
        "Map of contact stiffness and casing amplitude"


use rule contact_map_row as stiffness_row with:
    input:
        code=STUDIED + sources("workflow/paper/stiffness.py"),
        rom="results/reference/rom-r.nc",
    output:
        json="results/paper/stiffness/row-{row}.json",
    log:
        "results/paper/stiffness/logs/row-{row}.log",
    benchmark:
        "results/paper/stiffness/benchmarks/row-{row}.tsv"
    params:
        table="stiffness",
        scene=SCENES["paper-stiffness"].model_dump(mode="json"),
        value=lambda wildcards: SCALES[int(wildcards.row)],
    message:
        "Both moduli in Pa, casing amplitude number {wildcards.row}"


use rule contact_map as stiffness with:
    input:
        code=sources("workflow/paper/stiffness.py"),
        rows=expand("results/paper/stiffness/row-{row}.json", row=range(len(SCALES))),
    output:
        json="results/paper/stiffness.json",
    log:
        "results/paper/stiffness/logs/stiffness.log",
    params:
        table="stiffness",
    message:
        "Map of both moduli"


rule paper_claims:
    input:
        code=sources(
            "workflow/markdown.py",
            *(
                f"workflow/paper/{n}.py"
                for n in ("claims", "verdict", "report", "contact_map", "stiffness", "cases")
            ),
        ),
        numbers="results/paper/reference/numbers.json",
    output:
        json="results/paper/claims.json",
        markdown=report(
            "results/paper/claims.md",
            caption="../report/claims.rst",
            category="The paper",
            labels={"figure": "claims", "shows": "the paper's claims, judged"},
        ),
    log:
        "results/paper/logs/claims.log",
    params:
        beside={name: there(files) for name, files in BESIDE.items()},
        made=made_at(BESIDE),
    message:
        "Verdicts on the paper's claims"
    script:
        "../scripts/paper_claims.py"


rule paper_cost:
    input:
        code=sources("workflow/markdown.py", "workflow/paper/cost.py"),
        claims="results/paper/claims.json",
    output:
        markdown="results/paper/cost.md",
    log:
        "results/paper/logs/cost.log",
    params:
        targets=TARGETS,
    message:
        "What the paper's targets cost"
    script:
        "../scripts/paper_cost.py"


rule paper_uncertainty:
    input:
        REPEATED.values(),


rule paper_causes:
    input:
        CAUSED.values(),
        expand("results/figures/{figure}.{suffix}", figure=OF_CAUSES, suffix=["png", "pdf"]),


rule paper_rotor37:
    input:
        ON_OTHER.values(),
