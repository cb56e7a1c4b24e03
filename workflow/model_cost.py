"""Time and memory of the jobs from a blade's mesh to its checked model, before they run.

Powers of the number of nodes, fitted to blade `paper` with 10,000 to 104,000 nodes on one core
(fem/README.md, Large blades). MUMPS factorises a sparser K sooner: that of a blade with more
elements through its thickness takes longer, and more memory. So do further speeds, where K(Omega)
needs them, and equilibria that Newton finds slowly.
"""

import re
from dataclasses import dataclass
from pathlib import Path

from geometry.base import MeshError, Say, duration, memory_of_machine, require
from geometry.blade import Blade

MESH, IN_SQUARE = 10_000, 16  # nodes, usual; on a square of an element's size of a thin blade
SCALE = 1e5  # nodes: of each law the number there, and its exponent
LAWS = {
    "assembly": (16.0, 1.0),  # s, M, K and S, and their file
    "factor": (28.0, 1.78),  # s, of Cholesky
    "column": (0.16, 1.3),  # s, of block Lanczos
    "static": (0.06, 1.25),  # s, a column of K^-1 S^T
    "SLEPc": (31.0, 1.6),  # s, the ten modes of the check
    "reduction": (27.0, 1.0),  # s
    "bytes of a factor": (1.6e9, 1.39),
}
START, EMPTY = 3.0, 0.33e9  # s and bytes of a job that does nothing
MODES = 10  # of the check, at least
LANCZOS = 49, 3.3  # columns: for no mode, and for each
NEWTON = 6.0  # factors for an equilibrium
K_AND_M, TANGENT = 16e3, 15e3  # bytes a node: with those of the mesh; for Newton, with its factor
OF_BASIS = 4.5  # times its columns, in memory
NODES_OVER_SIZE = 2.6  # exponent of the number of nodes over the size of an element, falling


@dataclass(frozen=True)
class Cost:
    """Cost of a job."""

    seconds: float  # on one core
    memory: float  # bytes, at most


def costs(blade: Blade, nodes: int) -> dict[str, Cost]:
    """Cost of each job from a mesh of so many nodes to the checked model, by its rule."""
    law = {name: there * (nodes / SCALE) ** power for name, (there, power) in LAWS.items()}
    speeds, nonlinear = getattr(blade.basis, "speeds", 3), blade.prestress == "nonlinear"
    natural = max(getattr(blade.basis, "natural_modes", 0), MODES)
    interface = 3 * blade.interface.patches * blade.interface.across
    static, factor = interface * law["static"], law["factor"]
    equilibria = NEWTON * (speeds - 1) if nonlinear else 1
    lanczos = (LANCZOS[0] + LANCZOS[1] * natural) * law["column"]
    columns = 8 * 3 * nodes * speeds * (natural + interface)  # bytes
    held = law["bytes of a factor"] + K_AND_M * nodes
    tangent = TANGENT * nodes * nonlinear
    between = factor * (NEWTON if nonlinear else 1) + law["SLEPc"] + static
    each = {
        "assemble": (
            (speeds if nonlinear else 1) * law["assembly"] + equilibria * factor,
            held + tangent,
        ),
        "modes": (speeds * (factor + lanczos + static), held + columns),
        "solve_between": ((speeds - 1) * between, held + tangent),
        "reduce": (law["reduction"], OF_BASIS * columns),
    }
    return {job: Cost(START + seconds, EMPTY + more) for job, (seconds, more) in each.items()}


def require_room(blade: Blade, nodes: int, say: Say) -> None:
    """Tell the cost of the model of a mesh of so many ``nodes``.

    Raises
    ------
    MeshError
        When this machine has not the memory for one of its jobs.
    """
    each, room = costs(blade, nodes), memory_of_machine()
    most, job = max((cost.memory, job) for job, cost in each.items())
    seconds = sum(cost.seconds for cost in each.values())
    more = ", more if K(Omega) needs further speeds" if blade.prestress == "nonlinear" else ""
    say(
        f"from this mesh to the checked model some {duration(seconds)} on one core, "
        f"{most / 1e9:.2g} GB of memory at most ({job}){more}"
    )
    few, coarser = nodes * room / most, (most / room) ** (1 / NODES_OVER_SIZE)
    remedy = (
        f"take mesh.element_size_mm above {blade.mesh.element_size_mm * coarser:.2g}"
        if blade.mesh
        else "export a coarser mesh"
    )
    require(
        (
            most <= room,
            f"{nodes} nodes: {job} needs some {most / 1e9:.2g} GB, this machine has "
            f"{room / 1e9:.2g} GB: {remedy} (some {few:.2g} nodes), or take a larger machine",
        ),
        kind=MeshError,
    )


def expected_nodes(blade: Blade, mesh: str | Path) -> int:
    """Number of nodes of a mesh; of one that is not there yet some, by the size of its elements."""
    if there := nodes_of(mesh):
        return there
    if not (blade.sections and blade.mesh):
        return MESH
    chord = (blade.sections.hub.chord_mm + blade.sections.tip.chord_mm) / 2
    return round(IN_SQUARE * blade.sections.span_mm * chord / blade.mesh.element_size_mm**2)


def nodes_of(mesh: str | Path) -> int:
    """Number of nodes of a file of Gmsh; 0 where there is none, or a damaged one."""
    text = Path(mesh).read_text(errors="replace") if Path(mesh).is_file() else ""
    found = re.search(r"^\$Nodes\n\d+ (\d+)", text, re.MULTILINE)
    return int(found[1]) if found else 0
