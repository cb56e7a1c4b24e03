# The paper: its claims and their cost. Run on request, not part of `rule all`.


def further_files():
    """Files that the claims table includes if all of a group exist, by target and by group."""

    def of(name, *files):
        return {file: f"results/experiments/{name}/{file}.json" for file in ("table", *files)}

    model = f"results/{SCENES['rotor37-e1'].blade}/paper-model.json"
    return {
        "paper_uncertainty": {"repeats": of("repeats", "growth")},
        "paper_causes": {"causes": of("causes")},
        "paper_rotor37": {"other": of("rotor37", "growth") | {"model": model}},
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


SWEPT = ("e1", "e10", "two-five", "tilted", "tangential")  # scenes of the claims, after `paper-`
OTHERS = ("density-1", "density-4", "step-08", "step-04", "step-02")  # of those about the method
BEYOND = ("long-20", "long-200", "long-2000", "run-up", "run-down", "on-worn")


def folders_of_targets(wildcards):
    """Folders with the benchmarks of the jobs of each target."""
    swept = [*(f"paper-{name}" for name in (*SWEPT, *OTHERS)), "peak-e1", *BEYOND]
    folders = {
        "blade, mesh, reduced models": ["reference", "reference-paper"],
        "paper": ["paper", "experiments/grid", *(f"reference/{name}" for name in swept)],
        "paper_uncertainty": ["reference-rich", "experiments/repeats"],
        "paper_causes": ["reference-linear", "reference-wide", "experiments/causes"],
        "paper_rotor37": ["rotor37-fast", "rotor37-fast-paper", "experiments/rotor37"],
    }
    return {target: [f"results/{name}" for name in names] for target, names in folders.items()}


def models_of_growth(wildcards):
    """Models of the coatings whose table an experiment has."""
    found = [case for case in cases_of(wildcards.experiment) if case.label == "grid"]
    return list(dict.fromkeys(case.file("rom") for case in found))


def files_of_long_times(wildcards):
    """Those of the figure."""
    return FIGURES.files("long-times", {})


def scene_of_density(wildcards):
    """Settings of the scene whose density is changed, for its cost."""
    return SCENES["paper-density-1"].model_dump(mode="json")


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/index.html",
        "results/paper/long-times.json",
        "results/paper/cost.md",
        pictures(
            name
            for name, row in FIGURES.rows.items()
            if row.category == "The paper" or name.startswith("fig")
        ),
        pictures(["stress-peak-e1"]),


rule paper_uncertainty:
    input:
        lambda wildcards: further_files_of("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: further_files_of("paper_causes"),


rule paper_rotor37:
    input:
        lambda wildcards: further_files_of("paper_rotor37"),
