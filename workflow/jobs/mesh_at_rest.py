"""The mesh at rest of a blade whose geometry is given as it runs."""

from fem.at_rest import build_mesh_at_rest
from geometry.base import Say
from geometry.blade import Blade
from workflow.jobs.mesh import report_mesh


def build(blade: str, source: str, mesh: str, report: Say) -> None:
    """Mesh a blade at rest, with the geometry in the file ``source`` where its own names one."""
    report_mesh(build_mesh_at_rest(Blade.load(blade), mesh, source or None), report)
