"""The mesh of a blade."""

from geometry.base import WARNING, Say
from geometry.blade import Blade
from geometry.mesh import ENOUGH, MeshSummary, build_mesh
from workflow.model_cost import require_room


def build(blade: str, source: str, mesh: str, report: Say) -> None:
    """Mesh a blade, with the geometry in the file ``source`` where its own file names one."""
    settings = Blade.load(blade)
    report_mesh(build_mesh(settings, mesh, source or None), settings, report)


def report_mesh(summary: MeshSummary, blade: Blade, report: Say) -> None:
    """Report the mesh, with a warning where the elements are too few, and the cost of its model.

    Raises
    ------
    geometry.base.errors.MeshError
        When this machine has not the memory for the model.
    """
    report(("" if summary.through >= ENOUGH else WARNING) + summary.blade_line())
    require_room(blade, summary.nodes, report)
