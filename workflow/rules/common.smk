import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

from pydantic import Field
from snakemake.exceptions import WorkflowError

from fem.matrices import CODE as MATRICES_CODE
from geometry import yaml_file
from geometry.blade import Blade
from geometry.provenance import fingerprint
from geometry.settings import Settings, SettingsError, check_settings, read_settings
from rom.model import CODE as ROM_CODE
from rom.speeds import basis_speeds, check_speeds
from simulate.design import Design
from simulate.scene import Scene
from workflow.summary import last_words

ROOT = Path(workflow.basedir)
SUMMARY = "results/summary.json"
SHOWN_MODE = 3  # the highest natural mode whose motion pages show
DESIGN_ROWS = {}  # number of rows of the designs read, by scene


def read_or_fail(read, *arguments):
    """Result of ``read``; an error in a user's file is raised as one line."""
    try:
        return read(*arguments)
    except SettingsError as error:
        raise WorkflowError(str(error)) from None


def file_of(blade):
    """Path of the file with the blade's geometry, if the blade names one."""
    return blade.file and Path("workflow/blades", blade.file)


@cache
def blade_settings(name):
    """Settings of a blade, used by a scene or not."""
    blade = read_or_fail(read_settings, Blade, f"workflow/blades/{name}.yaml")
    if blade.file and not file_of(blade).is_file():
        raise WorkflowError(
            f"workflow/blades/{name}.yaml: {blade.source_key}.file: {str(blade.file)!r}: no such file"
        )
    return blade


def scene_file(name):
    """Path of a scene's file; that of a variant need not exist."""
    return f"workflow/scenes/{name}.yaml"


@cache
def scene_settings(name):
    """A scene, configured or not."""
    scene = read_or_fail(read_settings, Scene, scene_file(name))
    if scene.blade not in BLADE_FILES:
        raise WorkflowError(
            f"{scene_file(name)}: blade: {scene.blade!r}: no workflow/blades/{scene.blade}.yaml"
        )
    if scene.start:
        require_start(name, scene.start.scene, scene.blade)
    if name in EXPLORED and not scene.record.motion:
        scene = scene.but(record={"motion": SHOWN_MODE})
    if name in EXPLORED and scene.design:
        raise WorkflowError(
            f"workflow/config.yaml: explore: {name!r} is a design: allowed are sweeps"
        )
    if scene.design:
        design = read_or_fail(Design.of, scene, Path(scene_file(name)))
        DESIGN_ROWS[name] = len(design.scenes)
    return scene


def require_start(name, before, blade):
    """Refuse a start from a scene that is not there, of another blade, or without ends."""
    fault = f"{scene_file(name)}: start.scene: {before!r}"
    if before not in SCENES or before == name:
        raise WorkflowError(f"{fault}: no other scene of workflow/scenes")
    there = scene_settings(before)
    if there.blade != blade:
        raise WorkflowError(f"{fault}: its blade is {there.blade!r}, allowed {blade!r}")
    if not there.record.end:
        raise WorkflowError(f"{fault}: holds no ends; set `record: {{end: true}}` there")


class Scenes(Mapping):
    """All scenes by name; each is read and checked when it is used."""

    def __init__(self, names):
        self.names = names

    def __getitem__(self, name):
        return scene_settings(name)

    def __contains__(self, name):
        return name in self.names

    def __iter__(self):
        return iter(self.names)

    def __len__(self):
        return len(self.names)


def read_all(settings, names):
    """Settings by name; all faults of all files in one message, before any job starts."""
    faults = []
    for name in names:
        try:
            settings(name)
        except WorkflowError as error:
            faults.append(str(error))
    if faults:
        raise WorkflowError("\n".join(faults))
    return {name: settings(name) for name in names}


class Config(Settings):
    """Settings of workflow/config.yaml."""

    scenes: list[str] = Field(min_length=1, description="Names of files in workflow/scenes/")
    blocks: int = Field(ge=1, le=1000, description="Number of jobs of a sweep")
    explore: list[str] = Field(
        default=[], description="Scenes with a page to explore, where they run"
    )


def one_of(names):
    """Pattern of a wildcard that matches one of ``names``; without names it matches nothing."""
    return "|".join(map(re.escape, names)) or "(?!)"


CONFIG = read_or_fail(check_settings, Config, config, "workflow/config.yaml")
EXPLORED = [name for name in CONFIG.explore if name in CONFIG.scenes]
BLADE_FILES = read_or_fail(yaml_file.names, "workflow/blades")
SCENES = Scenes(read_or_fail(yaml_file.names, "workflow/scenes"))
for name in set(CONFIG.explore) - set(SCENES):
    raise WorkflowError(f"workflow/config.yaml: explore: {name!r}: no workflow/scenes/{name}.yaml")
# Configured scenes and their blades are checked at once and delivered; others when they are used.
DELIVERED = read_all(scene_settings, dict.fromkeys(CONFIG.scenes))
SWEEPS = {name: scene for name, scene in DELIVERED.items() if not scene.design}
BLADES = read_all(blade_settings, sorted({scene.blade for scene in DELIVERED.values()}))


wildcard_constraints:
    blade=one_of(BLADE_FILES),
    scene=one_of(SCENES),
    block=r"\d+",
    row=r"\d+",
    directions="r|rt|rtz",


def sources(*patterns):
    """Source files that a job imports, as its inputs: it reruns when they change.

    Paths are relative in the working directory, so that a project that is moved does not rerun.
    """
    files = sorted(path for pattern in patterns for path in ROOT.glob(pattern))
    here = Path.cwd()
    return [str(f.relative_to(here) if f.is_relative_to(here) else f) for f in files]


def kept_beside(file, folder):
    """Name of a file's log or benchmark, in ``folder`` in the folder of the file."""
    path = Path(file.removesuffix(".json"))
    return str(path.parent / folder / path.name)


def blade_uses(*keys):
    """The settings of the blade that a job uses: of all settings, only these rerun it."""

    def settings(wildcards):
        values = blade_settings(wildcards.blade).model_dump(mode="json", exclude_none=True)
        return Told({key: values[key] for key in keys if key in values})

    return settings


def speeds_of_basis(wildcards):
    """Speeds at which the reduced model needs the full matrices, rad/s."""
    blade = blade_settings(wildcards.blade)
    return basis_speeds(blade.basis, blade.max_speed_rad_s).tolist()


def speeds_of_check(wildcards):
    """Speeds at which the reduced model is checked, rad/s."""
    return check_speeds(blade_settings(wildcards.blade).max_speed_rad_s).tolist()


def directions_of(blade):
    """Interface directions that the blade's scenes need; all directions without a scene."""
    needed = [scene.directions for scene in DELIVERED.values() if scene.blade == blade]
    return max(needed, key=len, default="rtz")


def basis_of_scene(wildcards):
    """The basis of the states recorded in the scene."""
    return f"results/{wildcards.blade}/basis-{SCENES[wildcards.scene].directions}.h5"


def basis_uses(wildcards):
    """The settings that determine the basis: all but the tolerance of its check."""
    settings = blade_settings(wildcards.blade).basis.model_dump(mode="json")
    return Told({key: value for key, value in settings.items() if key != "tolerance_percent"})


def blade_source(wildcards):
    """The input file with the blade's geometry, if the blade names one."""
    file = file_of(blade_settings(wildcards.blade))
    return {} if file is None else {"source": str(file)}


def blade_file(wildcards):
    return f"workflow/blades/{wildcards.blade}.yaml"


def blocks(wildcards):
    """Blocks of a sweep or a design, at most as many as its speeds or rows; one of speeds in turn."""
    scene = SCENES[wildcards.scene]
    if scene.speeds.in_turn:
        return range(1)
    most = DESIGN_ROWS[wildcards.scene] if scene.design else scene.speeds.count
    return range(min(CONFIG.blocks, most))


class Told(dict):
    """Settings of a job: Snakemake compares and shows a short hash of them; jobs get a dictionary."""

    def __repr__(self):
        return f"settings {fingerprint(dict(self))[:12]}"

    def __reduce__(self):
        return dict, (dict(self),)


def settings_told(wildcards):
    """All settings of the scene."""
    return Told(SCENES[wildcards.scene].model_dump(mode="json"))


def of_scenes(pattern):
    """``pattern`` for every sweep to deliver, with its blade."""
    return [pattern.format(blade=scene.blade, scene=name) for name, scene in SWEEPS.items()]


def of_designs():
    """The tables of every design to deliver."""
    return [
        f"results/{scene.blade}/{name}/design-{table}.nc"
        for name, scene in DELIVERED.items()
        if scene.design
        for table in ("runs", "rows")
    ]


def table_of_design(wildcards):
    """The CSV file of a scene's design."""
    scene = SCENES[wildcards.scene]
    if scene.design is None:
        raise WorkflowError(f"{scene_file(wildcards.scene)}: design: missing: it is no table")
    return str(Path(scene_file(wildcards.scene)).parent / scene.design)


def delivered(wildcards):
    """Outputs of the workflow: every sweep, design and figure."""
    return [
        *of_scenes("results/{blade}/{scene}/sweep.nc"),
        *of_designs(),
        *all_figures(),
        *(f"results/{SCENES[name].blade}/{name}/explore.html" for name in EXPLORED),
        *([SUMMARY] if SWEEPS else []),
    ]


def rom_of_scene(wildcards):
    """The reduced model with the interface directions that the scene needs."""
    return f"results/{wildcards.blade}/rom-{SCENES[wildcards.scene].directions}.nc"


def sweep_before(wildcards):
    """The sweep of the scene that a scene starts from."""
    scene = SCENES[wildcards.scene]
    return f"results/{scene.blade}/{scene.start.scene}/sweep.nc" if scene.start else []


def settings_of_scene(wildcards):
    """Settings chosen by the pilot, for a scene with an accuracy."""
    path = f"results/{wildcards.blade}/{wildcards.scene}/settings.json"
    return path if SCENES[wildcards.scene].accuracy else []


def mesh_error_of_scene(wildcards):
    """Error of the mesh, for a scene with an accuracy, if a coarser mesh can be made."""
    scene = SCENES[wildcards.scene]
    known = scene.accuracy and blade_settings(scene.blade).mesh
    return f"results/{wildcards.blade}/mesh-error.json" if known else []


def known_mesh_error(wildcards):
    """Error of the mesh, if a coarser mesh can be made."""
    known = blade_settings(wildcards.blade).mesh
    return f"results/{wildcards.blade}/mesh-error.json" if known else []


def check_of_scene(wildcards):
    """Check of the scene's model: nothing is marched on a model that misses its tolerance."""
    return f"results/{wildcards.blade}/rom-check-{SCENES[wildcards.scene].directions}.nc"
