"""Cost of a command before it runs: the sum over its jobs.

Jobs of blades and scenes as ``workflow.model_cost`` and ``simulate.sweeps.cost`` say, those of a
scene by the time of its runs; others as they take for the default scenes. Meshes and models that
are not there yet are taken to be of usual size. Code that is compiled for the first time is not
counted (16 s for each scheme and law).
"""

from collections.abc import Iterable
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from geometry.base import UserError, duration
from rom.model import Rom
from workflow.model_cost import EMPTY, MESH, START, Cost, costs, expected_nodes
from workflow.targets.project import Project

if TYPE_CHECKING:
    from simulate.sweeps.cost import Cost as CostOfSweep

OTHER, DRAWN = Cost(3.0, 0.25e9), Cost(6.0, 0.6e9)  # of a short job, and of a picture
DRAW = ("draw_", "explore", "rub", "experiment_picture")  # begin the rules that draw
OF_MESH = {  # s and bytes of jobs for each node, beside ``START`` and ``EMPTY``
    "build_mesh": (2e-4, 2e3),
    "mesh_error": (3e-4, 1.5e4),
    "stress": (7e-4, 2e4),
    "gauges": (3e-4, 2e4),
}
UNTOLD = ("experiment_block", "growth", "interface", "paper_")  # begin rules of unknown cost
RUNS = {"answers": 80.0, "pilot": 40.0}  # of the scene, that a job repeats or varies


def told(project: Project, jobs: Iterable[tuple[str, Any]]) -> str:
    """Number, CPU time and memory of ``jobs``, by rule and wildcards, in a line.

    Rules whose cost is not known are named.
    """
    of = [(rule, _known(project, rule, wildcards)) for rule, wildcards in jobs]
    each = [cost for _, cost in of if cost]
    seconds = sum(cost.seconds for cost in each)
    memory = max((cost.memory for cost in each), default=0.0)
    line = f"{len(of)} jobs: some {duration(seconds)} on one core, {memory / 1e9:.2g} GB for one"
    untold = sorted({rule for rule, cost in of if not cost})
    return f"{line} at most, without {', '.join(untold)}" if untold else f"{line} at most"


def _known(project: Project, rule: str, wildcards: Any) -> Cost | None:
    """Cost of a job; None where it is not known beforehand, for which no run is stopped."""
    if not rule.startswith(UNTOLD):
        with suppress(Exception):  # of files and scenes that the job itself refuses
            return _of_job(project, rule, wildcards)
    return None


def _of_job(project: Project, rule: str, wildcards: Any) -> Cost:
    """Cost of a job."""
    name, scene = wildcards.get("blade"), wildcards.get("scene")
    blade = project.blades.settings[name] if name in project.blades.meshed else None
    nodes = expected_nodes(blade, f"results/{name}/blade.msh") if blade else MESH
    if blade and rule in (of_model := costs(blade, nodes)):
        return of_model[rule]
    if rule in OF_MESH:
        seconds, memory = OF_MESH[rule]
        return Cost(START + seconds * nodes, EMPTY + memory * nodes)
    if scene in project.scenes and rule in ("sweep_block", "sweep", "design_block", *RUNS):
        return _of_scene(project, rule, wildcards)
    return DRAWN if rule.startswith(DRAW) else OTHER


def _of_scene(project: Project, rule: str, wildcards: Any) -> Cost:
    """Cost of a job that runs a scene."""
    of = _sweep(project, wildcards)
    run = of.seconds / of.runs
    if rule in RUNS:
        return Cost(START + RUNS[rule] * run, of.memory)
    if rule == "design_block":
        return Cost(START + of.seconds * project.scenes.rows_of_block(wildcards), of.memory)
    if rule == "sweep_block":
        blocks = project.scenes.block_count(wildcards)
        return Cost(START + of.runs_at_speeds * run / blocks, of.memory / blocks)
    return Cost(START + (of.runs - of.runs_at_speeds) * run, of.memory)


def _sweep(project: Project, wildcards: Any) -> "CostOfSweep":
    """Cost of the sweep of a scene, on a usual model where there is none."""
    from simulate.sweeps.cost import cost  # compiled code, which other commands do not load

    scene = project.scenes[wildcards.scene]
    try:
        return cost(scene, Rom.load(str(project.scenes.rom(wildcards))))
    except UserError:  # the model is made anew, or refuses the scene, which its check says
        return cost(scene, None)
