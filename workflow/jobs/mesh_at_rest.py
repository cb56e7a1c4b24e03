"""The mesh at rest of a blade whose geometry is given as it runs."""

from fem.at_rest import build_mesh_at_rest
from geometry.base import Say
from geometry.blade import Blade
from workflow.jobs.mesh import report_mesh


def build(blade: Blade, mesh: str, report: Say, source: str | None = None) -> None:
    """Mesh a blade at rest, with the geometry in the file ``source`` where its own names one."""
    report_mesh(build_mesh_at_rest(blade, mesh, source), report)
