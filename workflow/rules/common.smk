import logging
import os
import re
import sys
from contextlib import suppress
from functools import cache
from itertools import chain
from pathlib import Path
from tempfile import gettempdir

from snakemake.exceptions import WorkflowError

from geometry.blade import SOURCES
from geometry.elsewhere import ELSEWHERE, MatricesElsewhere, ModelElsewhere, read_blade
from geometry.base import (
    WARNING,
    SettingsError,
    fingerprint,
    hashes,
    printable,
    sources_of,
    yaml_file,
)
from rom.polynomial import basis_speeds, check_speeds
from workflow.many.design import Design
from workflow.many.table import last_words as table_words
from simulate.scene import Scene, fault_of_blade, own_laws
from simulate.scene.casing import CASING
from workflow.at_work import ANOTHER, hold, not_writable
from workflow.config import read_config
from workflow.summary import last_words

ROOT = Path(workflow.basedir)
SUMMARY = "results/summary.json"
SHOWN_MODE = 3  # the highest natural mode whose motion pages show
DESIGNS = {}  # those read, by scene


def without_sources(record):
    """Leave the modules that a job imports out of a message: errors then name the files of users."""
    if isinstance(getattr(record, "input", None), list):
        record.input = [file for file in record.input if not file.endswith(".py")]
    return True


def without_traceback(record):
    """Of what is refused of files or requests of users, leave the sentences alone."""
    text = str(record.msg)
    if re.match(r"WorkflowError in file|InputFunctionException[\s\S]*?\n +WorkflowError:", text):
        around = r"^[\s\S]*?WorkflowError.*\n *|\nWildcards:[\s\S]*|\n +File \"[\s\S]*"
        record.msg = re.sub(around, "", text)
    return True


for of_messages in (without_sources, without_traceback):
    logging.getLogger("snakemake.logging").addFilter(of_messages)

if not os.path.isfile("workflow/config.yaml"):
    raise WorkflowError(
        f"{os.getcwd()}: no workflow/config.yaml; start in the folder of a project, as ./run does, or "
        f"add --directory {ROOT}"
    )


for folder, remedy in (
    (os.getcwd(), ""),
    (os.environ.get("TMPDIR", gettempdir()), "; or set TMPDIR"),
):
    if fault := not_writable(folder):
        raise WorkflowError(fault + remedy)


def read_or_fail(read, *arguments):
    """Result of ``read``; an error in a user's file is raised as one line."""
    try:
        return read(*arguments)
    except SettingsError as error:
        raise WorkflowError(str(error)) from None


def files_of(blade):
    """Paths of the files that the blade's file names, by their key; none for parameters."""
    if isinstance(blade, ELSEWHERE):
        return {blade.key: [Path("workflow/blades", file) for file in blade.files]}
    return {f"{blade.source_key}.file": [Path("workflow/blades", blade.file)]} if blade.file else {}


def require_shown(path, key, named):
    """Refuse a file that Snakemake cannot name in a line: it shows names as they are."""
    if printable(named) != named:
        raise WorkflowError(f"{path}: {key}: {named!r}: rename it, without control characters")


@cache
def blade_settings(name):
    """Settings of a blade, used by a scene or not."""
    path = f"workflow/blades/{name}.yaml"
    blade = read_or_fail(read_blade, path)
    for key, files in files_of(blade).items():
        for file in files:
            named = str(file).removeprefix("workflow/blades/")
            require_shown(path, key, named)
            if not os.path.isfile(file):
                raise WorkflowError(f"{path}: {key}: {named!r}: no such file")
    return blade


def blades_with(key):
    """Names of the blades whose file has a key; a file that cannot be read is refused when it is used."""

    def has(name):
        try:
            return key in yaml_file.read_mapping(f"workflow/blades/{name}.yaml")
        except SettingsError:
            return False

    return [name for name in BLADE_FILES if has(name)]


def scene_file(name):
    """Path of a scene's file; that of a variant need not exist."""
    return f"workflow/scenes/{name}.yaml"


@cache
def scene_settings(name):
    """A scene, configured or not."""
    scene = read_or_fail(Scene.load, scene_file(name))
    if scene.blade not in BLADE_FILES:
        raise WorkflowError(
            f"{scene_file(name)}: blade: {scene.blade!r}: no workflow/blades/{scene.blade}.yaml"
        )
    if fault := fault_of_blade(scene, blade_settings(scene.blade)):
        raise WorkflowError(f"{scene_file(name)}: {fault}")
    if scene.start:
        require_start(name, scene.start.scene, scene.blade)
    without_mesh = {
        "explore": name in EXPLORED and scene.blade not in MESHED,
        "record.states_rounds": scene.blade in FOREIGN and scene.record.states_rounds,
        "record.gauges": scene.record.gauges and scene.blade not in MESHED,
    }
    for key in (key for key, refused in without_mesh.items() if refused):
        raise WorkflowError(
            f"{scene_file(name)}: {key}: blade {scene.blade!r} is a model or matrices from elsewhere, "
            f"without the mesh that pictures of the whole blade and gauges need: take it out"
        )
    if name in EXPLORED and scene.gaps.vary:
        raise WorkflowError(refused_at_rest(name))
    if name in EXPLORED and scene.design:
        raise WorkflowError(
            f"workflow/config.yaml: explore: {name!r} is a design: allowed are sweeps"
        )
    if scene.design:
        require_shown(scene_file(name), "design", scene.design)
        DESIGNS[name] = design = read_or_fail(Design.of, scene, Path(scene_file(name)))
        for blade in design.blades:
            if blade not in BLADE_FILES:
                raise WorkflowError(
                    f"{design.path}: column blade: {blade!r}: no workflow/blades/{blade}.yaml; there are "
                    + ", ".join(BLADE_FILES)
                )
    return scene


def refused_at_rest(name):
    """Why a scene with gaps at rest has no page."""
    return (
        f"workflow/config.yaml: explore: {name!r}: its page has one gap for all speeds: allowed are "
        f"scenes with `clearance: {{at: running}}`, without a line or a table of the shift"
    )


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


class Scenes(dict):
    """All scenes by name; each is read and checked when it is used."""

    def __getitem__(self, name):
        return scene_settings(name)


def read_all(settings, names):
    """Settings by name; all faults of all files in one message, before any job starts."""
    faults = []
    for name in names:
        try:
            settings(name)
        except WorkflowError as error:
            faults += str(error).splitlines()
    if faults:  # of a base or a blade, the same for several names
        raise WorkflowError("\n".join(dict.fromkeys(faults)))
    return {name: settings(name) for name in names}


def one_of(names):
    """Pattern of a wildcard that matches one of ``names``; without names it matches nothing."""
    return "|".join(map(re.escape, names)) or "(?!)"


def keeps_motion(scene):
    """Whether the sweep of a scene keeps the motion of which pages and stresses are made."""
    return not scene.design and scene.blade in MESHED


BLADE_FILES = read_or_fail(yaml_file.names, "workflow/blades")
FOREIGN = blades_with(ModelElsewhere.key)  # of a reduced model made elsewhere
WITH_MATRICES = blades_with(MatricesElsewhere.key)  # made elsewhere
MESHED = [name for name in BLADE_FILES if name not in (*FOREIGN, *WITH_MATRICES)]
AS_IT_RUNS = blades_with("geometry_at_rpm")  # whose shape at rest is computed
SCENES = Scenes.fromkeys(read_or_fail(yaml_file.names, "workflow/scenes"))
# Not by `configfile:`, which takes the last of equal keys. `config`: what --config gives.
CONFIG = read_or_fail(read_config, "workflow/config.yaml", config, SCENES)
EXPLORED = [name for name in CONFIG.explore if name in CONFIG.scenes]
# Configured scenes and their blades are checked at once and delivered; others when they are used.
DELIVERED = read_all(scene_settings, dict.fromkeys(CONFIG.scenes))
SWEEPS = {name: scene for name, scene in DELIVERED.items() if not scene.design}
STRESSED = [name for name, scene in SWEEPS.items() if keeps_motion(scene)]
BLADES = read_all(blade_settings, sorted({scene.blade for scene in DELIVERED.values()}))


wildcard_constraints:
    blade=one_of(BLADE_FILES),
    scene=one_of(SCENES),
    block=r"\d+",
    row=r"\d+",
    directions="r|rt|rtz",


def here(files):
    """Paths, relative in the working directory: a project that is moved does not rerun."""
    folder = Path.cwd()
    paths = map(Path, files)
    return [str(f.relative_to(folder) if f.is_relative_to(folder) else f) for f in paths]


def own_files(names):
    """Files of the project, as inputs of jobs that read or import them."""
    return here(ROOT / name for name in names)


def code_of(*jobs):
    """Source files that jobs import, as inputs: the jobs rerun when they change.

    ``jobs``: modules, or functions named ``module:function``. They are read for jobs that are needed.
    """
    return lambda wildcards: own_files(sources_of(*(job.partition(":")[0] for job in jobs)))


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
    """Speeds at which the reduced model needs the full matrices, rad/s, and what decides on more."""
    blade = blade_settings(wildcards.blade)
    speeds = basis_speeds(blade.basis, blade.top_speed).tolist()
    return speeds, blade.basis.tolerance_percent


def speeds_of_check(wildcards):
    """Speeds at which the reduced model is checked, rad/s."""
    return check_speeds(speeds_of_basis(wildcards)[0]).tolist()


def mesh_of(wildcards):
    """The blade's mesh, where it has one."""
    meshed = wildcards.blade in MESHED
    return {"mesh": f"results/{wildcards.blade}/blade.msh"} if meshed else {}


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


def files_of_blade(wildcards):
    """Paths of the files that the blade's file names."""
    return list(map(str, chain(*files_of(blade_settings(wildcards.blade)).values())))


def blade_source(wildcards):
    """The input file with the blade's geometry, if the blade names one."""
    files = files_of_blade(wildcards)
    return {"source": files if len(files) > 1 else files[0]} if files else {}


def contents_of_blade(wildcards):
    """Hashes of the files that the blade's file names, for the jobs that read them."""
    return Told(read_or_fail(hashes, files_of_blade(wildcards)))


def contents_of_scene(wildcards):
    """Hashes of the files that runs of the scene read: of its design, and of laws of one's own."""
    scene = SCENES[wildcards.scene]
    laws, files = dict(scene.liner.law.code_files), ()
    if scene.design:
        design = DESIGNS[wildcards.scene]
        files = design.files
        for law in design.laws:
            with suppress(SettingsError):  # it is refused in its row
                laws |= own_laws.named(law).code_files
    return Told(read_or_fail(hashes, files) | dict(zip(here(laws), laws.values())))


def blade_file(wildcards):
    return f"workflow/blades/{wildcards.blade}.yaml"


def blocks(wildcards):
    """Blocks of a sweep or a design, at most as many as its speeds or rows; one of speeds in turn."""
    scene = SCENES[wildcards.scene]
    if scene.speeds.in_turn:
        return range(1)
    most = DESIGNS[wildcards.scene].count if scene.design else scene.speeds.count
    return range(min(CONFIG.blocks, most))


class Told(dict):
    """Settings of a job: Snakemake compares and shows a short hash of them; jobs get a dictionary."""

    def __repr__(self):
        return f"settings {fingerprint(dict(self))[:12]}"

    def __reduce__(self):
        return dict, (dict(self),)


def settings_told(wildcards):
    """All settings of the scene.

    Its sweep keeps the motion for its stresses and a page to explore, with or without a page: one
    that is asked for later needs no second sweep.
    """
    scene = SCENES[wildcards.scene]
    if keeps_motion(scene) and not scene.record.motion:
        scene = scene.but(record={"motion": SHOWN_MODE})
    return Told(scene.model_dump(mode="json"))


def sought_of(blade):
    """The number of modes, and the engine orders, whose critical speeds are told of a blade."""
    return blade_settings(blade).margins.model_dump()


def operating_of(blade):
    """Operating speeds of a blade, rpm by name, the crossings that are told, and what excites some.

    Of all scenes to deliver of the blade, so that all its figures and tables tell the same.
    """
    scenes = [scene for scene in DELIVERED.values() if scene.blade == blade]
    by_orders = (scene.casing.excites.items() for scene in scenes)
    # an order of one casing may be a side band of another: the harmonic is told
    excited = dict(sorted(chain(*by_orders), key=lambda item: item[1] == CASING))
    sought, lines = sought_of(blade), blade_settings(blade).operating_rpm
    orders = sorted({*sought["orders"], *excited})
    return sought | {"lines": lines, "orders": orders, "excited": excited}


def of_scenes(pattern):
    """``pattern`` for every sweep to deliver, with its blade."""
    return [pattern.format(blade=scene.blade, scene=name) for name, scene in SWEEPS.items()]


def others_with_results():
    """Scenes that are there, have results of the summary, and are not to be delivered."""
    found = {path.parent.name for path in Path("results").glob("*/*/answers.json")}
    return sorted(found & SCENES.keys() - SWEEPS.keys())


def of_designs():
    """The tables of every design to deliver."""
    return [
        f"results/{scene.blade}/{name}/{table}"
        for name, scene in DELIVERED.items()
        if scene.design
        for table in ("design-runs.nc", "design-rows.nc", "design.csv")
    ]


def design_of(wildcards):
    """The design of a scene."""
    if SCENES[wildcards.scene].design is None:
        raise WorkflowError(f"{scene_file(wildcards.scene)}: design: missing: it is no table")
    return DESIGNS[wildcards.scene]


def table_of_design(wildcards):
    """The CSV file of a scene's design."""
    return str(design_of(wildcards).path)


def rows_of_block(wildcards):
    """Number of the rows of a block of a design."""
    return len(range(int(wildcards.block), design_of(wildcards).count, len(blocks(wildcards))))


def of_other_blades(name, without=()):
    """A file of each blade that only some rows of a design have, but for those ``without`` it."""

    def files(wildcards):
        directions = SCENES[wildcards.scene].directions
        _, *others = design_of(wildcards).blades
        return [f"results/{of}/{name}-{directions}.nc" for of in others if of not in without]

    return files


def of_row(of_scene, name, without=()):
    """A file of the model of a row of a design: that of its scene, or of another blade."""

    def file(wildcards):
        blade = read_or_fail(design_of(wildcards).require_row, int(wildcards.row)).blade
        path = f"results/{blade}/{name}-{SCENES[wildcards.scene].directions}.nc"
        return of_scene(wildcards) if blade == wildcards.blade else [] if blade in without else path

    return file


def delivered(wildcards):
    """Outputs of the workflow: every sweep, design and figure."""
    return [
        *of_scenes("results/{blade}/{scene}/sweep.nc"),
        *of_designs(),
        *(
            f"results/{of.blade}/{name}/gauges.csv"
            for name, of in SWEEPS.items()
            if of.record.gauges
        ),
        *all_figures(),
        *(f"results/{SCENES[name].blade}/{name}/explore.html" for name in EXPLORED),
        *([SUMMARY] if SWEEPS else []),
    ]


def rom_with_directions(wildcards):
    """The reduced model with the interface directions that the scene needs."""
    return f"results/{wildcards.blade}/rom-{SCENES[wildcards.scene].directions}.nc"


def rom_of_scene(wildcards):
    """The same; of a scene with strain gauges, with what they read."""
    gauges = f"results/{wildcards.blade}/{wildcards.scene}/gauges.nc"
    return gauges if SCENES[wildcards.scene].record.gauges else rom_with_directions(wildcards)


def gauges_of_scene(wildcards):
    """The strain gauges of a scene, as settings of its record."""
    record = SCENES[wildcards.scene].record
    if not record.gauges:
        raise WorkflowError(f"{scene_file(wildcards.scene)}: record.gauges: missing")
    return Told({"gauges": record.model_dump(mode="json")["gauges"]})


def sweep_before(wildcards):
    """The sweep of the scene that a scene starts from."""
    scene = SCENES[wildcards.scene]
    return f"results/{scene.blade}/{scene.start.scene}/sweep.nc" if scene.start else []


def stress_of_scene(wildcards):
    """The stresses of a scene that keeps its motion."""
    path = f"results/{wildcards.blade}/{wildcards.scene}/stress.json"
    return path if keeps_motion(SCENES[wildcards.scene]) else []


def stress_of_page(wildcards):
    """The same for its page; without gaps at rest."""
    if SCENES[wildcards.scene].gaps.vary:
        raise WorkflowError(refused_at_rest(wildcards.scene))
    return stress_of_scene(wildcards)


def sweep_with_motion(wildcards):
    """The sweep of a scene of whose motion the stresses are known."""
    if not keeps_motion(SCENES[wildcards.scene]):
        raise WorkflowError(
            f"{scene_file(wildcards.scene)}: without the motion of a meshed blade, of which stresses are "
            f"made: take out design, or another blade"
        )
    return f"results/{wildcards.blade}/{wildcards.scene}/sweep.nc"


def settings_of_scene(wildcards):
    """Settings chosen by the pilot, for a scene with an accuracy."""
    path = f"results/{wildcards.blade}/{wildcards.scene}/settings.json"
    return path if SCENES[wildcards.scene].accuracy else []


def checked_scene(wildcards):
    """The check of a scene that blocks march; with an accuracy the pilot has it."""
    path = f"results/{wildcards.blade}/{wildcards.scene}/checked"
    return [] if SCENES[wildcards.scene].accuracy else path


def mesh_error_of_scene(wildcards):
    """Error of the mesh, for a scene with an accuracy, if a coarser mesh can be made."""
    return known_mesh_error(wildcards) if SCENES[wildcards.scene].accuracy else []


def known_mesh_error(wildcards):
    """Error of the mesh, if a coarser mesh can be made."""
    known = wildcards.blade in MESHED and blade_settings(wildcards.blade).mesh
    return f"results/{wildcards.blade}/mesh-error.json" if known else []


def check_of_scene(wildcards):
    """Check of the scene's model: nothing is marched on a model that misses its tolerance.

    A reduced model from elsewhere is checked where it is taken.
    """
    if SCENES[wildcards.scene].blade in FOREIGN:
        return []
    return f"results/{wildcards.blade}/rom-check-{SCENES[wildcards.scene].directions}.nc"
