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
PRIORS = "workflow/identify/priors.yaml"


def scene_of_identified(wildcards):
    return SCENES[IDENTIFIED[wildcards.identified]]


def settings_of_identified(wildcards):
    """Settings of the scene of a table, as the jobs of designs take them."""
    return (
        scene_of_identified(wildcards).but(design=f"{wildcards.sample}.csv").model_dump(mode="json")
    )


def rom_of_identified(wildcards):
    return rom_of(scene_of_identified(wildcards))


def check_of_identified(wildcards):
    return f"results/{scene_of_identified(wildcards).blade}/rom-check-r.nc"


def roms_of_identified(wildcards):
    return {"rom": rom_of_identified(wildcards), "reference": OF_REFERENCE("rom-r.nc")}


def of_identified(wildcards, *names):
    return [f"results/identify/{wildcards.identified}/{name}" for name in names]


def tables_of(wildcards):
    """Names of all tables of a blade."""
    return [*TABLES] if wildcards.identified == JUDGED_ON else TABLES_OF_OTHERS


def before(sample):
    """The tables before one."""
    return list(TABLES)[: list(TABLES).index(sample)]


def marched(wildcards, samples):
    """Points and peaks of tables that were marched."""
    names = {"points": "{}.json", "rows": "{}-rows.nc"}
    return {
        key: of_identified(wildcards, *map(name.format, samples)) for key, name in names.items()
    }


def files_of_points(wildcards):
    return (
        marched(wildcards, before(wildcards.sample))
        | roms_of_identified(wildcards)
        | {"priors": PRIORS}
    )


def files_of_fits(wildcards):
    return marched(wildcards, tables_of(wildcards)) | {"priors": PRIORS}


def given_scene(wildcards):
    """Parameters of the paper's scenes, which took the medoid of a run of the tables."""
    from workflow.identify.table import parameters

    return {"parameters": parameters(SCENES["paper"])}


def files_of_scene(wildcards):
    points = of_identified(wildcards, *(f"{sample}.json" for sample in TABLES))
    fits = f"results/identify/{wildcards.identified}/fits.json"
    return {"points": points, "fits": fits, "priors": PRIORS}


def files_of_draws(wildcards):
    of_prior = wildcards.draws == "prior"
    samples = ["prior"] if of_prior else tables_of(wildcards)
    tables = of_identified(wildcards, *(f"{sample}.csv" for sample in samples))
    fits = [] if of_prior else f"results/identify/{wildcards.identified}/fits.json"
    return {"fits": fits, "tables": tables, "rom": rom_of_identified(wildcards)}


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


def files_of_shares(wildcards):
    names = [f"measured/{draws}-{block}.json" for draws, block in ALL_BLOCKS]
    return {"measured": of_identified(wildcards, *names)}


# Rows of `numbers.smk`.
IDENTIFY_NUMBERS = {
    "identify_points": {
        "output": {
            "json": "results/identify/{identified}/{sample}.json",
            "csv": "results/identify/{identified}/{sample}.csv",
        },
        "run": "identify.points:points",
        "files": files_of_points,
        "given": lambda wildcards: dict(zip(("number", "data"), TABLES[wildcards.sample])),
        "message": "Blade {wildcards.identified}: points of its table {wildcards.sample}",
    },
    "identify_fits": {
        "output": {"json": "results/identify/{identified}/fits.json"},
        "run": "identify.numbers:fits",
        "files": files_of_fits,
        "message": "Blade {wildcards.identified}: fits to the paper's critical speeds",
    },
    "identify_scene": {
        "output": {"json": "results/identify/{identified}/scene.json"},
        "run": "identify.numbers:of_scene",
        "files": files_of_scene,
        "given": given_scene,
        "message": "Blade {wildcards.identified}: how near the scenes are to the medoid",
    },
    "identify_blades": {
        "output": {"json": "results/identify/blades.json"},
        "run": "identify.numbers:blades",
        "files": lambda wildcards: {
            "fits": [f"results/identify/{name}/fits.json" for name in IDENTIFIED]
        },
        "given": {"names": list(IDENTIFIED)},
        "message": "Fits of all blades",
    },
    "identify_measured": {
        "output": {"json": "results/identify/{identified}/measured/{draws}-{block}.json"},
        "run": "identify.numbers:at_draws",
        "files": files_of_draws,
        "given": given_draws,
        "message": "Blade {wildcards.identified}: what claims compare, draws {wildcards.draws}, block "
        "{wildcards.block}",
    },
    "identify_shares": {
        "output": {"json": "results/identify/{identified}/shares.json"},
        "run": "identify.shares:numbers",
        "files": files_of_shares,
        "given": {"draws": [draws for draws, _ in ALL_BLOCKS]},
        "message": "Blade {wildcards.identified}: shares of the claims",
    },
}
