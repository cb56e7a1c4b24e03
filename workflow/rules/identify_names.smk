# Blades of the identification by name, and the scenes of their tables.
IDENTIFIED = {"reference": "identify", "rotor37": "identify-rotor37"}
TABLES = {"prior": 256, "proposed": 384}  # points of each table
PRIORS = "workflow/identify/priors.yaml"


def scene_of_identified(wildcards):
    return SCENES[IDENTIFIED[wildcards.identified]]


def settings_of_identified(wildcards):
    """Settings of the scene of a table, as the scripts of designs take them."""
    return (
        scene_of_identified(wildcards).but(design=f"{wildcards.sample}.csv").model_dump(mode="json")
    )


def rom_of_identified(wildcards):
    return rom_of(scene_of_identified(wildcards))


def roms_of_identified(wildcards):
    return {"rom": rom_of_identified(wildcards), "reference": OF_REFERENCE("rom-r.nc")}


def of_identified(wildcards, *names):
    return [f"results/identify/{wildcards.identified}/{name}" for name in names]


def files_of_proposed(wildcards):
    points, rows = of_identified(wildcards, "prior.json", "prior-rows.nc")
    return {"points": points, "rows": rows, "priors": PRIORS} | roms_of_identified(wildcards)


def files_of_fits(wildcards):
    return {
        "points": of_identified(wildcards, *(f"{sample}.json" for sample in TABLES)),
        "rows": of_identified(wildcards, *(f"{sample}-rows.nc" for sample in TABLES)),
        "priors": PRIORS,
    }


def identify_code(*names):
    """Modules of workflow/identify."""
    return sources(*(f"workflow/identify/{name}.py" for name in names))


def table_of_points(name, files, *modules):
    """Row of the points of a table."""
    pattern = f"results/identify/{{identified}}/{name}"
    return {
        "output": {"json": f"{pattern}.json", "csv": f"{pattern}.csv"},
        "module": "identify.numbers",
        "function": name,
        "files": files,
        "given": {"number": TABLES[name]},
        "code": sources("simulate/peak.py", "rom/*.py")
        + identify_code("table", "priors", *modules),
        "message": f"Blade {{wildcards.identified}}: points of its table {name}",
    }


# Rows of `numbers.smk`.
IDENTIFY_NUMBERS = {
    "identify_prior": table_of_points(
        "prior", lambda wildcards: {"priors": PRIORS} | roms_of_identified(wildcards)
    ),
    "identify_proposed": table_of_points(
        "proposed", files_of_proposed, "emulator", "posterior", "likelihood"
    ),
    "identify_fits": {
        "output": {"json": "results/identify/{identified}/fits.json"},
        "module": "identify.numbers",
        "function": "fits",
        "files": files_of_fits,
        "code": identify_code("table", "priors", "fits", "posterior", "likelihood"),
        "message": "Blade {wildcards.identified}: fits to the paper's critical speeds",
    },
}
