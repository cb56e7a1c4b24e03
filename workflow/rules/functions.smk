# Functions of the rules of figures, experiments, studies and the paper.
# They stand apart from the rules, whose files are then only rules. `=name` in numbers.yaml calls one.
from workflow.many.plan import Experiment, cases
from workflow.figures import table

FIGURES = table.Figures(
    read_or_fail(
        table.read, *own_files(f"workflow/{of}/figures.yaml" for of in ("figures", "paper"))
    ),
    scenes=SCENES,
    delivered=DELIVERED,
    stressed=STRESSED,
    directions=directions_of,
    operating=operating_of,
    blades={
        "matrices": lambda blade: blade not in FOREIGN,
        "mesh": lambda blade: blade in MESHED,
        "fatigue": lambda blade: blade in MESHED and blade_settings(blade).fatigue is not None,
    },
)
PAPER_BLADE = "paper"


def of_figure(told, name):
    """What a method of FIGURES tells of a figure by its wildcards."""
    return lambda wildcards: read_or_fail(told, name, dict(wildcards.items()))


def pictures(names):
    """Both files of each figure."""
    return expand("{path}.{suffix}", path=map(table.path_of, names), suffix=["png", "pdf"])


def all_figures():
    """Every figure of the scenes to deliver."""
    return pictures(FIGURES.configured(lambda row: row.part == table.DELIVERED))


@cache
def cases_of(name):
    """Rows of an experiment on their scenes; refused where their blade does not allow them."""
    path = f"workflow/experiments/{name}.yaml"
    found = read_or_fail(cases, path)
    for case in found:
        blade, of = case.scene.blade, f"{path}: {case.row}, {case.label}"
        if blade not in BLADE_FILES:
            raise WorkflowError(f"{of}: blade: {blade!r}: no workflow/blades/{blade}.yaml")
        if fault := fault_of_blade(case.scene, blade_settings(blade)):
            raise WorkflowError(f"{of}: {fault}")
    return found


def models_of_experiment(wildcards):
    """Reduced models of the rows that are marched, and the files that numbers need."""
    found = cases_of(wildcards.experiment)
    files = [file for case in found for file in map(case.file, case.needs)]
    return list(dict.fromkeys(files))


def checks_of_experiment(wildcards):
    """Checks of the models: nothing is marched on one that misses its tolerance."""
    files = [
        case.file("check")
        for case in cases_of(wildcards.experiment)
        if "rom" in case.needs and case.scene.blade not in FOREIGN
    ]
    return list(dict.fromkeys(files))


def code_of_experiment(wildcards):
    """The engine, and the functions of all rows."""
    found = cases_of(wildcards.experiment)
    functions = {of for case in found for of in (case.function, case.model) if of}
    return code_of("workflow.jobs.many", *sorted(functions))(wildcards)


def contents_of_experiment(wildcards):
    """Hashes of the files of the laws of one's own in its rows."""
    laws = dict(
        chain(*(case.scene.liner.law.code_files.items() for case in cases_of(wildcards.experiment)))
    )
    return Told(zip(here(laws), laws.values()))


def plan_of_experiment(wildcards):
    """All rows, and the number of blocks."""
    found = cases_of(wildcards.experiment)
    return Told(
        {
            "cases": [case.model_dump(mode="json") for case in found],
            "blocks": min(CONFIG.blocks, len(found)),
        }
    )


def blocks_of_experiment(wildcards):
    count = min(CONFIG.blocks, len(cases_of(wildcards.experiment)))
    return expand("results/experiments/{{experiment}}/block-{block}.json", block=range(count))


def picture_of_experiment(wildcards):
    """What is drawn of the table."""
    path = f"workflow/experiments/{wildcards.experiment}.yaml"
    picture = read_or_fail(Experiment.load, path).picture
    if picture is None:
        raise WorkflowError(f"{path}: picture: missing: give lines or cells")
    return Told(picture.model_dump(mode="json", exclude_none=True))


def source_of_blade(wildcards):
    """The input file with the blade's geometry; None where it names none."""
    return blade_source(wildcards).get("source")


def further_files():
    """Files that the claims table includes if all of a group exist, by target and by group."""

    def of(name, *files):
        return {file: f"results/experiments/{name}/{file}.json" for file in ("table", *files)}

    model = f"results/{SCENES['rotor37-e1'].blade}/paper-model.json"
    return {
        "paper_uncertainty": {"repeats": of("repeats", "growth")},
        "paper_causes": {"causes": of("causes")},
        "paper_rotor37": {"other": of("rotor37", "growth") | {"model": model}},
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
    folders = {
        "paper": [
            *("paper", "paper-points", "reference-points-coarse", "experiments/grid"),
            *(f"paper/paper-{name}" for name in (*SWEPT, *OTHERS)),
        ],
        "paper_beyond": [f"paper/{name}" for name in BEYOND],
        "paper_uncertainty": ["paper-rich", "experiments/repeats"],
        "paper_causes": ["paper-nonlinear", "paper-wide", "paper-edges", "experiments/causes"],
        "paper_rotor37": ["rotor37-fast", "rotor37-fast-points", "experiments/rotor37"],
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
