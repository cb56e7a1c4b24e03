"""A block of the rows of an experiment."""

from adapter import job

from workflow.jobs.many import experiment

job(
    snakemake,
    lambda of, tell: experiment(
        of.params.given["cases"],
        of.params.given["blocks"],
        int(of.wildcards.block),
        of.params.folder,
        tell,
    ),
)
