# Editions of the paper: their parts, and the files of their results.


def cases():
    """The paper's cases, imported only for the jobs of the paper."""
    from workflow.paper import cases

    return cases


def choices():
    """Our choices made otherwise, imported as the cases."""
    from workflow.paper import choices

    return choices


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
# Editions of the paper: on its blade, on another, and repeats on its blade for the uncertainty.
EDITION = r"[\w-]+"


def scene_of_part(edition, part):
    """Name of the scene of one part; repeats have that of the reference."""
    blade = OTHER if edition == OTHER else "paper"
    return f"{blade}-{PARTS.get(part, part)}"


def is_repeat(edition):
    """Whether an edition is a repeat, which changes the scenes of the reference.

    Raises
    ------
    WorkflowError
        When the edition is unknown.
    """
    own, repeats = ("reference", OTHER), cases().REPEATS
    if edition not in (*own, *repeats):
        raise WorkflowError(
            f"results/paper/{edition}: unknown edition; there are {', '.join((*own, *repeats))}"
        )
    return edition in repeats


def of_part(edition, part):
    """Scene of one part of an edition."""
    scene = SCENES[scene_of_part(edition, part)]
    return cases().REPEATS[edition].scene(scene) if is_repeat(edition) else scene


def settings_of_part(edition, part):
    """Settings of the scene of one part, as the jobs take them."""
    return of_part(edition, part).model_dump(mode="json")


def rom_of(scene):
    """The reduced model of a scene."""
    return f"results/{scene.blade}/rom-{scene.directions}.nc"


def sweep_of_part(edition, part):
    """File of the sweep of one part; repeats have files of their own."""
    name = scene_of_part(edition, part)
    if is_repeat(edition):
        return f"results/paper/{edition}/{name}.nc"
    return f"results/{SCENES[name].blade}/{name}/sweep.nc"


def rows_of(wildcards):
    """Files of the rows of the table of E and K."""
    return [f"results/paper/{wildcards.edition}/grid/{row}.json" for row in cases().ROWS]


def scene_of_cause(wildcards):
    """The scene that a cause changes."""
    return SCENES[_cause(wildcards)[0]]


def _cause(wildcards):
    """Name of the scene of a cause, and the cause."""
    (found,) = [
        (scene, cause)
        for scene, causes in choices().OF_SCENE.items()
        for cause in causes
        if cause.file == wildcards.cause
    ]
    return found


def rom_of_cause(wildcards):
    """The reduced model of a cause: of its blade, with the directions of scene and cause."""
    _, cause = _cause(wildcards)
    scene = cause.scene(scene_of_cause(wildcards))
    directions = max(cause.directions, scene.directions, key=len)
    return f"results/{scene.blade}/rom-{directions}.nc"


def more_of_edition(wildcards):
    """Files of further numbers of an edition; repeats have none."""
    if is_repeat(wildcards.edition):
        return []
    own = ["model", *(["settled"] if wildcards.edition == "reference" else [])]
    return [f"results/paper/{wildcards.edition}/{name}.json" for name in own]


def further_files():
    """Files that the claims table includes if they exist, by target and by group."""
    of = choices()
    return {
        "paper_uncertainty": {
            "repeats": {name: f"results/paper/{name}/numbers.json" for name in cases().REPEATS}
        },
        "paper_causes": {
            "causes": {
                cause.name: f"results/paper/causes/{cause.file}.json"
                for causes in of.OF_SCENE.values()
                for cause in causes
            },
        },
        "paper_rotor37": {"other": {OTHER: f"results/paper/{OTHER}/numbers.json"}},
        "identify": {"shares": {"reference": "results/identify/reference/shares.json"}},
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
        group: {name: file for name, file in files.items() if Path(file).is_file()}
        for groups in further_files().values()
        for group, files in groups.items()
    }


def times_of_further_files(wildcards):
    """Modification times of the existing further files: the table is remade for new ones."""
    groups = existing_further_files(wildcards).values()
    files = [file for group in groups for file in group.values()]
    return {file: Path(file).stat().st_mtime_ns for file in files}


def folders_of_targets(wildcards):
    """Folders with the benchmarks of the jobs of each target."""

    def of_edition(*editions):
        paper = "results/paper"
        return [f"{paper}/{name}" for name in (*editions, *(f"{e}/grid" for e in editions))]

    def of_scenes(names):
        return [f"results/{SCENES[name].blade}/{name}" for name in names]

    of = cases()
    swept = [scene_of_part("reference", part) for part in (*PARTS, *DENSITIES, *STEPS)]
    return {
        "blade, mesh, reduced models": ["results/reference", "results/reference-paper"],
        "paper": [*of_edition("reference"), *of_scenes([*swept, "peak-e1", *LONG, *IN_TURN])],
        "paper_uncertainty": [f"results/{of.RICHER}", *of_edition(*of.REPEATS)],
        "paper_causes": [
            *(f"results/{name}" for name in ("reference-linear", "reference-wide")),
            "results/paper/causes",
        ],
        "paper_rotor37": [
            "results/rotor37-fast",
            "results/rotor37-fast-paper",
            *of_edition(OTHER),
            *of_scenes(scene_of_part(OTHER, part) for part in PARTS),
        ],
    }


OF_REFERENCE = "results/reference/{}".format


def sweep_of(scene):
    """Sweep of one of the paper's scenes on its blade."""
    return OF_REFERENCE(f"paper-{scene}/sweep.nc")


def scene_of_table(wildcards):
    """The scene that every row of the table of E and K changes."""
    return of_part(wildcards.edition, "grid")


def given_cause(wildcards):
    scene = scene_of_cause(wildcards).model_dump(mode="json")
    return {"scene": scene, "name": wildcards.cause}


def files_of_growth(wildcards):
    return {
        "grid": f"results/paper/{wildcards.edition}/grid.json",
        "rom": rom_of(of_part(wildcards.edition, "grid")),
        "rigid": sweep_of_part(wildcards.edition, "rigid"),
    }


def files_of_model(wildcards):
    """Models of the edition's blade, and of its variant reduced as in the paper."""
    blade = of_part(wildcards.edition, "e1").blade
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


def files_of_edition(wildcards):
    edition = wildcards.edition
    return {part: sweep_of_part(edition, part) for part in PARTS} | {
        "rom": rom_of(of_part(edition, "e1")),
        "grid": f"results/paper/{edition}/grid.json",
        "growth": f"results/paper/{edition}/growth.json",
        "more": more_of_edition(wildcards),
    }


def files_of_claims(wildcards):
    """The numbers, and the further files that the table waits for."""
    return {
        "numbers": "results/paper/reference/numbers.json",
        "further": requested_further_files(wildcards),
    }


# Rows of `numbers.smk`.
PAPER_NUMBERS = {
    "table_row": {
        "output": {"json": "results/paper/{edition}/grid/{row}.json"},
        "run": "paper.grid:of_row",
        "files": lambda wildcards: {"rom": rom_of(scene_of_table(wildcards))},
        "given": lambda wildcards: {
            "scene": scene_of_table(wildcards).model_dump(mode="json"),
            "name": wildcards.row,
        },
        "message": "Row {wildcards.row} of the table of E and K, {wildcards.edition}",
    },
    "table": {
        "output": {"json": "results/paper/{edition}/grid.json"},
        "run": "paper.grid:of_rows",
        "files": lambda wildcards: {"rows": rows_of(wildcards)},
        "message": "Table of E and K, {wildcards.edition}",
    },
    "cause": {
        "output": {"json": "results/paper/causes/{cause}.json"},
        "run": "paper.causes:of_cause",
        "files": lambda wildcards: {"rom": rom_of_cause(wildcards)},
        "given": given_cause,
        "message": "Cause {wildcards.cause}",
    },
    "growth": {
        "output": {"json": "results/paper/{edition}/growth.json"},
        "run": "paper.worst:numbers",
        "files": files_of_growth,
        "given": lambda wildcards: {"scene": settings_of_part(wildcards.edition, "grid")},
        "message": "Worst coatings over 200 rounds, {wildcards.edition}",
    },
    "paper_model": {
        "output": {"json": "results/paper/{edition}/model.json"},
        "run": "paper.numbers:model",
        "files": files_of_model,
        "message": "The paper's reduced model, {wildcards.edition}",
    },
    "paper_settled": {
        "output": {"json": "results/paper/reference/settled.json"},
        "run": "paper.numbers:settled",
        "files": files_of_settled,
        "given": lambda wildcards: {"scene": settings_of_part("reference", DENSITIES[0])},
        "message": "Densities, steps, laws, cost of the density, stress",
    },
    "paper_numbers": {
        "output": {"json": "results/paper/{edition}/numbers.json"},
        "run": "paper.numbers:edition",
        "files": files_of_edition,
        "given": {"parts": SWEPT},
        "message": "Numbers of the claims, {wildcards.edition}",
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
