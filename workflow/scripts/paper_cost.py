"""Cost of the paper's targets."""

from adapter import job

from workflow.paper.cost import cost

job(
    snakemake,
    lambda of, tell: cost(of.params.targets),
    markdown=str,
)
