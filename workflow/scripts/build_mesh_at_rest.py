"""The mesh at rest of a blade whose geometry is given as it runs."""

from adapter import job

from fem.at_rest import build_mesh_at_rest
from geometry.blade import Blade
from workflow.jobs.mesh import report_mesh

job(
    snakemake,
    lambda of, tell: report_mesh(
        build_mesh_at_rest(Blade.load(of.params.blade), of.output.mesh, of.input.source or None),
        tell.report,
    ),
)
