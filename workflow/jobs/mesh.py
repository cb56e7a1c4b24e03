"""The mesh of a blade."""

from geometry.base import WARNING, Say
from geometry.blade import Blade
from geometry.mesh import ENOUGH, MeshSummary, build_mesh


def build(blade: str, source: str, mesh: str, report: Say) -> None:
    """Mesh a blade, with the geometry in the file ``source`` where its own file names one."""
    report_mesh(build_mesh(Blade.load(blade), mesh, source or None), report)


def report_mesh(summary: MeshSummary, report: Say) -> None:
    """Report the mesh; a warning where the elements are too few."""
    report(("" if summary.through >= ENOUGH else WARNING) + summary.blade_line())
