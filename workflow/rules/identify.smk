# The identification: tables of the engine, and what they say of the parameters.
# Blades of the identification by name, and the scenes of their tables.
IDENTIFIED = {"reference": "identify", "rotor37": "identify-rotor37", "leaned": "identify-leaned"}
JUDGED_ON = "reference"  # the blade on which the claims are judged at draws, too
# Points of each table, and the data by which they are drawn from what the tables before it say.
TABLES = {
    "prior": (256, None),
    "first": (256, "shifts"),
    "second": (384, "shifts"),
    "third": (256, "with C12 and C16"),
    "fourth": (256, "with C12 and C16"),
    "fifth": (256, "with C12 and C16"),
}
TABLES_OF_OTHERS = ["prior", "first", "second"]  # of a blade on which only the shifts are fitted
# Draws at which the paper's other claims are judged: of the prior, and of posteriors: by K of E = 1, and data.
DRAWS = ("prior", "4.55-with-order")
DRAW_BLOCKS = 10  # jobs for each of them
# Scenes of these claims.
CLAIM_SCENES = {
    "e10": "identify-e10",
    "two_five": "identify-two-five",
    "grid": "identify-grid",
    "rigid": "identify-rigid",
}


def scene_of_identified(wildcards):
    return SCENES[IDENTIFIED[wildcards.identified]]


def settings_of_identified(wildcards):
    """Settings of the scene of a table, as the jobs of designs take them."""
    return (
        scene_of_identified(wildcards).but(design=f"{wildcards.sample}.csv").model_dump(mode="json")
    )


def rom_of_identified(wildcards):
    scene = scene_of_identified(wildcards)
    return f"results/{scene.blade}/rom-{scene.directions}.nc"


def check_of_identified(wildcards):
    return f"results/{scene_of_identified(wildcards).blade}/rom-check-r.nc"


def of_identified(wildcards, pattern, samples):
    """Files of tables of a blade."""
    return [f"results/identify/{wildcards.identified}/{pattern.format(of)}" for of in samples]


def all_samples(wildcards):
    """Names of all tables of a blade."""
    return [*TABLES] if wildcards.identified == JUDGED_ON else TABLES_OF_OTHERS


def samples_before(wildcards):
    """The tables before one."""
    return list(TABLES)[: list(TABLES).index(wildcards.sample)]


def points_before(wildcards):
    return of_identified(wildcards, "{}.json", samples_before(wildcards))


def rows_before(wildcards):
    return of_identified(wildcards, "{}-rows.nc", samples_before(wildcards))


def all_points(wildcards):
    return of_identified(wildcards, "{}.json", all_samples(wildcards))


def all_rows(wildcards):
    return of_identified(wildcards, "{}-rows.nc", all_samples(wildcards))


def points_of_table(wildcards):
    """Number of the points of a table, and the data by which they are drawn."""
    return dict(zip(("number", "data"), TABLES[wildcards.sample]))


def parameters_of_scene(wildcards):
    """Parameters of the paper's scenes, which took the medoid of a run of the tables."""
    from workflow.identify.table import parameters

    return parameters(SCENES["paper"])


def fits_of_draws(wildcards):
    of_prior = wildcards.draws == "prior"
    return [] if of_prior else f"results/identify/{wildcards.identified}/fits.json"


def tables_of_draws(wildcards):
    samples = ["prior"] if wildcards.draws == "prior" else all_samples(wildcards)
    return of_identified(wildcards, "{}.csv", samples)


def claim_scenes():
    """Scenes of the claims, without the parameters that every draw sets: these rerun nothing."""
    from workflow.identify.measured import at

    scenes = {part: SCENES[name] for part, name in CLAIM_SCENES.items()}
    return at(scenes, SCENES["identify"], span=1.0)


def given_draws(wildcards):
    return {
        "scene": scene_of_identified(wildcards).model_dump(mode="json"),
        "parts": {part: scene.model_dump(mode="json") for part, scene in claim_scenes().items()},
        "draws": wildcards.draws,
        "block": int(wildcards.block),
        "blocks": DRAW_BLOCKS,
        "folder": f"results/identify/{wildcards.identified}/measured/parts",
    }


ALL_BLOCKS = [(draws, block) for draws in DRAWS for block in range(DRAW_BLOCKS)]


def all_measured(wildcards):
    names = [f"{draws}-{block}" for draws, block in ALL_BLOCKS]
    return of_identified(wildcards, "measured/{}.json", names)


def draws_of_measured(wildcards):
    return [draws for draws, _ in ALL_BLOCKS]


wildcard_constraints:
    sample=one_of(TABLES),
    identified=one_of(IDENTIFIED),
    draws=one_of(DRAWS),


rule identify_block:
    input:
        code=code_of("workflow.jobs.design"),
        rom=rom_of_identified,
        check=ancient(check_of_identified),
        table="results/identify/{identified}/{sample}.csv",
    output:
        block="results/identify/{identified}/{sample}-block-{block}.nc",
    log:
        "results/identify/{identified}/logs/{sample}-block-{block}.log",
    benchmark:
        "results/identify/{identified}/benchmarks/{sample}-block-{block}.tsv"
    params:
        run="workflow.jobs.design:block",
        scene=settings_of_identified,
        file=lambda wildcards, output: output.block,
        parts="results/identify/{identified}/parts",
        blocks=CONFIG.blocks,
    message:
        "Blade {wildcards.identified}, block {wildcards.block} of its table {wildcards.sample}"
    script:
        "../scripts/job.py"


rule identify_rows:
    input:
        code=code_of("workflow.jobs.design"),
        rom=rom_of_identified,
        table="results/identify/{identified}/{sample}.csv",
        blocks=expand(
            "results/identify/{{identified}}/{{sample}}-block-{block}.nc",
            block=range(CONFIG.blocks),
        ),
    output:
        runs="results/identify/{identified}/{sample}-runs.nc",
        rows="results/identify/{identified}/{sample}-rows.nc",
    log:
        "results/identify/{identified}/logs/{sample}-rows.log",
    benchmark:
        "results/identify/{identified}/benchmarks/{sample}-rows.tsv"
    params:
        run="workflow.jobs.design:tables",
        scene=settings_of_identified,
        file=lambda wildcards, output: output.rows,
    message:
        "Blade {wildcards.identified}: peaks of its table {wildcards.sample}"
    script:
        "../scripts/job.py"


rule identify:
    input:
        expand(
            "results/identify/{identified}/{file}",
            identified=IDENTIFIED,
            file=["fits.json", "posterior.png"],
        ),
        "results/identify/blades.json",
        expand(
            "results/identify/{identified}/{file}",
            identified=JUDGED_ON,
            file=["scene.json", "shares.json", "together.png"],
        ),
