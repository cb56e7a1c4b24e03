# Editions of the paper: their parts, and the files of their results.


# Parts of every edition, and the names of their scenes.
PARTS = {
    "e1": "e1",
    "e10": "e10",
    "two_five": "two-five",
    "tilted": "tilted",
    "tangential": "tangential",
    "rigid": "rigid",
}
SWEPT = [part for part in PARTS if part != "rigid"]  # `rigid` belongs to the long runs
# Scenes of numbers that do not depend on the coatings, on the paper's blade alone.
DENSITIES = ("density-1", "density-4")
STEPS = ("step-08", "step-04", "step-02")
# Scenes that go on from others, beyond the paper
LONG = ("long-20", "long-200", "long-2000")
IN_TURN = ("run-up", "run-down", "on-worn")
OTHER = "rotor37"
# Experiments with editions of the paper: its table of E and K, repeats, another blade, causes.
EDITIONS = ("grid", "repeats", "rotor37", "causes")


def scene_of_part(part):
    """Name of the scene of one part."""
    return f"paper-{PARTS.get(part, part)}"


def rom_of(scene):
    """The reduced model of a scene."""
    return f"results/{scene.blade}/rom-{scene.directions}.nc"


def table_of(experiment):
    """Rows of an experiment."""
    return f"results/experiments/{experiment}/table.json"


def growth_of(experiment):
    """Long runs of the editions of an experiment."""
    return f"results/experiments/{experiment}/growth.json"


def further_files():
    """Files that the claims table includes if all of a group exist, by target and by group."""

    def of(name):
        return {"table": table_of(name), "growth": growth_of(name)}

    model = f"results/{SCENES['rotor37-e1'].blade}/paper-model.json"
    return {
        "paper_uncertainty": {"repeats": of("repeats")},
        "paper_causes": {"causes": {"table": table_of("causes")}},
        "paper_rotor37": {"other": of("rotor37") | {"model": model}},
        "identify": {"shares": {"path": "results/identify/reference/shares.json"}},
    }


def further_files_of(*targets):
    """Files of ``further_files`` that these targets make."""
    groups = [group for target in targets for group in further_files()[target].values()]
    return [file for group in groups for file in group.values()]


def requested_further_files(wildcards):
    """Further files requested in the same call of Snakemake: the table waits for them."""
    return further_files_of(*(workflow.dag_settings.targets & further_files().keys()))


def existing_further_files(wildcards):
    """Further files that exist when the table is made."""
    return {
        group: files
        for groups in further_files().values()
        for group, files in groups.items()
        if all(Path(file).is_file() for file in files.values())
    }


def times_of_further_files(wildcards):
    """Modification times of the existing further files: the table is remade for new ones."""
    groups = existing_further_files(wildcards).values()
    files = [file for group in groups for file in group.values()]
    return {file: Path(file).stat().st_mtime_ns for file in files}


def folders_of_targets(wildcards):
    """Folders with the benchmarks of the jobs of each target."""

    def of_experiment(name):
        return f"results/experiments/{name}"

    names = [scene_of_part(part) for part in (*SWEPT, *DENSITIES, *STEPS)]
    swept = [
        f"results/{SCENES[name].blade}/{name}" for name in (*names, "peak-e1", *LONG, *IN_TURN)
    ]
    return {
        "blade, mesh, reduced models": ["results/reference", "results/reference-paper"],
        "paper": ["results/paper", of_experiment("grid"), *swept],
        "paper_uncertainty": ["results/reference-rich", of_experiment("repeats")],
        "paper_causes": [
            *(f"results/{name}" for name in ("reference-linear", "reference-wide")),
            of_experiment("causes"),
        ],
        "paper_rotor37": [
            *(f"results/{name}" for name in ("rotor37-fast", "rotor37-fast-paper")),
            of_experiment("rotor37"),
        ],
    }


OF_REFERENCE = "results/reference/{}".format


def sweep_of(scene):
    """Sweep of one of the paper's scenes on its blade."""
    return OF_REFERENCE(f"paper-{scene}/sweep.nc")


GRID = "results/paper/grid.json"
FILES_OF_LONG = {
    "rest": sweep_of("e10"),
    "long": [OF_REFERENCE(f"{name}/sweep.nc") for name in LONG],
    **{name.replace("-", "_"): OF_REFERENCE(f"{name}/sweep.nc") for name in IN_TURN},
}


def models_of_growth(wildcards):
    """The table, and the models of the coatings in it."""
    found = [case for case in cases_of(wildcards.experiment) if case.label == "grid"]
    models = dict.fromkeys(case.file("rom") for case in found)
    return {"table": table_of(wildcards.experiment), "models": list(models)}


def files_of_model(wildcards):
    """Models of a blade, and of its variant reduced as in the paper."""
    blade = wildcards.blade
    return {
        "rom": f"results/{blade}/rom-r.nc",
        "check": f"results/{blade}/rom-check-r.nc",
        "paper": f"results/{blade}-paper/rom-rtz.nc",
        "paper_check": f"results/{blade}-paper/rom-check-rtz.nc",
    }


def files_of_settled(wildcards):
    return {
        "rom": "results/reference/rom-r.nc",
        "densities": [sweep_of(scene) for scene in DENSITIES],
        "steps": [sweep_of(scene) for scene in STEPS],
        "peak": "results/reference/peak-e1/peak.json",
    }


def files_of_numbers(wildcards):
    return {part: sweep_of(PARTS[part]) for part in SWEPT} | {
        "rom": OF_REFERENCE("rom-r.nc"),
        "grid": table_of("grid"),
        "growth": growth_of("grid"),
        "more": [OF_REFERENCE("paper-model.json"), "results/paper/settled.json"],
    }


def files_of_claims(wildcards):
    """The numbers, and the further files that the table waits for."""
    return {
        "numbers": "results/paper/numbers.json",
        "further": requested_further_files(wildcards),
    }


# Rows of `numbers.smk`.
PAPER_NUMBERS = {
    "grid": {
        "output": {"json": GRID},
        "run": "paper.numbers:of_grid",
        "files": lambda wildcards: {"table": table_of("grid")},
        "message": "Table of E and K",
    },
    "growth": {
        "output": {"json": "results/experiments/{experiment}/growth.json"},
        "run": "paper.editions:grown",
        "files": models_of_growth,
        "message": "Worst coatings over 200 rounds, {wildcards.experiment}",
    },
    "worst": {
        "output": {"json": "results/paper/growth.json"},
        "run": "paper.numbers:worst",
        "files": lambda wildcards: {"table": table_of("grid"), "growth": growth_of("grid")},
        "message": "Worst coatings over 200 rounds, and the bare casing",
    },
    "paper_model": {
        "output": {"json": "results/{blade}/paper-model.json"},
        "run": "paper.numbers:model",
        "files": files_of_model,
        "message": "The paper's reduced model, blade {wildcards.blade}",
    },
    "paper_settled": {
        "output": {"json": "results/paper/settled.json"},
        "run": "paper.numbers:settled",
        "files": files_of_settled,
        "given": lambda wildcards: {
            "scene": SCENES[scene_of_part(DENSITIES[0])].model_dump(mode="json")
        },
        "message": "Densities, steps, laws, cost of the density, stress",
    },
    "paper_numbers": {
        "output": {"json": "results/paper/numbers.json"},
        "run": "paper.numbers:of_scenes",
        "files": files_of_numbers,
        "given": {"parts": SWEPT},
        "message": "Numbers of the claims",
    },
    "paper_long_times": {
        "output": {"json": "results/paper/long-times.json"},
        "run": "paper.numbers:long_times",
        "files": lambda wildcards: FIGURES.files("long-times", {}),
        "message": "Long times, beyond the paper",
    },
    "paper_claims": {
        "output": {
            "json": "results/paper/claims.json",
            "markdown": report(
                "results/paper/claims.md",
                caption="../report/claims.rst",
                category="The paper",
                labels={"figure": "claims", "shows": "verdicts on the paper's claims"},
            ),
            "html": "results/paper/index.html",
        },
        "run": "paper.pages:claims",
        "files": files_of_claims,
        "given": lambda wildcards: {"further": existing_further_files(wildcards)},
        "uses": times_of_further_files,
        "message": "Verdicts on the paper's claims: table, and page of figures side by side",
    },
    "paper_conclusions": {
        "output": {"markdown": "results/paper/conclusions.md"},
        "run": "paper.pages:conclusions_text",
        "files": lambda wildcards: {
            "claims": "results/paper/claims.json",
            "fits": "results/identify/reference/fits.json",
            "long": "results/paper/long-times.json",
            "priors": PRIORS,
        },
        "message": "What a reader may conclude",
    },
    "paper_cost": {
        "output": {"markdown": "results/paper/cost.md"},
        "run": "paper.pages:cost_text",
        "files": lambda wildcards: {"claims": "results/paper/claims.json"},
        "given": lambda wildcards: {"targets": folders_of_targets(wildcards)},
        "message": "Cost of the paper's targets",
    },
}
