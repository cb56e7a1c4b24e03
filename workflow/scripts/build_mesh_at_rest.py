"""The mesh at rest of a blade whose geometry is given as it runs."""

from adapter import job

from fem.at_rest import build_mesh_at_rest
from geometry.blade import Blade
from workflow.jobs.mesh import report_mesh


def build(of, tell):
    """Build it, and tell what its model costs."""
    blade = Blade.load(of.params.blade)
    report_mesh(
        build_mesh_at_rest(blade, of.output.mesh, of.input.source or None), blade, tell.report
    )


job(snakemake, build)
