# The paper, figure by figure and claim by claim: run when asked for, no part of `rule all`.
include: "paper_names.smk"


NUMBERS = "workflow.paper.numbers"


wildcard_constraints:
    edition=EDITION,
    repeat=EDITION,
    part=one_of(PARTS.values()),
    row="[^/]+",
    cause="[^/]+",
    table=rf"{EDITION}/grid|{one_of(SCENES_OF_MAPS)}",


rule repeat_sweep:
    input:
        code=MARCH,
        rom=lambda wildcards: rom_of(of_part(wildcards.repeat, wildcards.part)),
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


rule table_row:
    input:
        code=lambda wildcards: STUDIED + code_of(wildcards),
        rom=lambda wildcards: rom_of(scene_of_table(wildcards)),
    output:
        json="results/paper/{table}/{row}.json",
    log:
        "results/paper/{table}/logs/{row}.log",
    benchmark:
        "results/paper/{table}/benchmarks/{row}.tsv"
    params:
        module=NUMBERS,
        function="row",
        given=lambda wildcards: {
            "scene": scene_of_table(wildcards).model_dump(mode="json"),
            "table": kind_of(wildcards),
            "name": wildcards.row,
        },
    message:
        "Row {wildcards.row} of {wildcards.table}"
    script:
        "../scripts/numbers.py"


rule table:
    input:
        code=code_of,
        rows=rows_of,
    output:
        json="results/paper/{table}.json",
    log:
        "results/paper/{table}/logs/table.log",
    params:
        module=NUMBERS,
        function="whole",
        given=lambda wildcards: {"table": kind_of(wildcards)},
    message:
        "Table {wildcards.table}"
    script:
        "../scripts/numbers.py"


rule contact_map:
    input:
        "results/paper/contact-map.json",


rule stiffness:
    input:
        "results/paper/stiffness.json",


rule cause:
    input:
        code=STUDIED + sources("workflow/paper/causes.py", "workflow/paper/measure.py"),
        rom=rom_of_cause,
    output:
        json="results/paper/causes/{cause}.json",
    log:
        "results/paper/causes/logs/{cause}.log",
    benchmark:
        "results/paper/causes/benchmarks/{cause}.tsv"
    params:
        module=NUMBERS,
        function="cause",
        given=lambda wildcards: {
            "scene": scene_of_cause(wildcards).model_dump(mode="json"),
            "name": wildcards.cause,
        },
    message:
        "Cause {wildcards.cause}"
    script:
        "../scripts/numbers.py"


rule growth:
    input:
        code=STUDIED + sources("workflow/paper/worst.py", "workflow/paper/grid.py"),
        grid="results/paper/{edition}/grid.json",
        rom=lambda wildcards: rom_of(of_part(wildcards.edition, "grid")),
        rigid=lambda wildcards: sweep_of_part(wildcards.edition, "rigid"),
    output:
        json="results/paper/{edition}/growth.json",
    log:
        "results/paper/{edition}/logs/growth.log",
    benchmark:
        "results/paper/{edition}/benchmarks/growth.tsv"
    params:
        module=NUMBERS,
        function="growth",
        given=lambda wildcards: {"scene": settings_of_part(wildcards.edition, "grid")},
    message:
        "Worst coatings over 200 rounds, {wildcards.edition}"
    script:
        "../scripts/numbers.py"


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
    params:
        module=NUMBERS,
        function="model",
    message:
        "The paper's reduced model, {wildcards.edition}"
    script:
        "../scripts/numbers.py"


rule paper_settled:
    input:
        code=STUDIED + sources("workflow/paper/measure.py", "workflow/paper/laws.py"),
        rom="results/reference/rom-r.nc",
        densities=[sweep_of(scene) for scene in DENSITIES],
        steps=[sweep_of(scene) for scene in STEPS],
        peak="results/reference/peak-e1/peak.json",
    output:
        json="results/paper/reference/settled.json",
    log:
        "results/paper/reference/logs/settled.log",
    benchmark:
        "results/paper/reference/benchmarks/settled.tsv"
    params:
        module=NUMBERS,
        function="settled",
        given=lambda wildcards: {"scene": settings_of_part("reference", DENSITIES[0])},
    message:
        "Densities, steps, laws, cost of the density, stress"
    script:
        "../scripts/numbers.py"


rule paper_numbers:
    input:
        unpack(lambda wildcards: {part: sweep_of_part(wildcards.edition, part) for part in PARTS}),
        code=STUDIED + sources("workflow/paper/grid.py", "workflow/paper/measure.py"),
        rom=lambda wildcards: rom_of(of_part(wildcards.edition, "e1")),
        grid="results/paper/{edition}/grid.json",
        growth="results/paper/{edition}/growth.json",
        more=more_of_edition,
    output:
        json="results/paper/{edition}/numbers.json",
    log:
        "results/paper/{edition}/logs/numbers.log",
    params:
        module=NUMBERS,
        function="edition",
        given={"parts": SWEPT},
    message:
        "Numbers of the claims, {wildcards.edition}"
    script:
        "../scripts/numbers.py"


CLAIMS_CODE = sources(
    "workflow/markdown.py",
    *(
        f"workflow/paper/{n}.py"
        for n in ("claims", "verdict", "report", "contact_map", "stiffness", "cases")
    ),
)


rule paper_claims:
    input:
        asked_beside,
        code=CLAIMS_CODE,
        numbers="results/paper/reference/numbers.json",
    output:
        json="results/paper/claims.json",
    log:
        "results/paper/logs/claims.log",
    params:
        module=NUMBERS,
        function="claims",
        given=lambda wildcards: {"beside": there_beside(wildcards)},
        made=made_beside,
    message:
        "Verdicts on the paper's claims"
    script:
        "../scripts/numbers.py"


rule paper_claims_table:
    input:
        asked_beside,
        code=CLAIMS_CODE,
        numbers="results/paper/reference/numbers.json",
    output:
        markdown=report(
            "results/paper/claims.md",
            caption="../report/claims.rst",
            category="The paper",
            labels={"figure": "claims", "shows": "the paper's claims, judged"},
        ),
    log:
        "results/paper/logs/claims-table.log",
    params:
        module=NUMBERS,
        function="claims_text",
        given=lambda wildcards: {"beside": there_beside(wildcards)},
        made=made_beside,
    message:
        "Table of the paper's claims"
    script:
        "../scripts/text.py"


rule paper_cost:
    input:
        code=sources("workflow/markdown.py", "workflow/paper/cost.py"),
        claims="results/paper/claims.json",
    output:
        markdown="results/paper/cost.md",
    log:
        "results/paper/logs/cost.log",
    params:
        module=NUMBERS,
        function="cost_text",
        given=lambda wildcards: {"targets": folders_of_targets(wildcards)},
    message:
        "What the paper's targets cost"
    script:
        "../scripts/text.py"


rule paper_uncertainty:
    input:
        lambda wildcards: files_beside("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: files_beside("paper_causes"),
        expand("results/figures/{figure}.{suffix}", figure=OF_CAUSES, suffix=["png", "pdf"]),


rule paper_rotor37:
    input:
        lambda wildcards: files_beside("paper_rotor37"),
