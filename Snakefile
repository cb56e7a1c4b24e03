# Tiprub: blade -> mesh -> finite elements -> reduced model -> speed sweeps with wear -> figures.
# Results of a blade are in results/<blade>/, those of a scene in results/<blade>/<scene>/.


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"


rule all:
    input:
        project.delivered_files,


for part in (
    *("geometry", "fem", "rom", "simulate", "fields", "summary"),
    *("figures", "experiment", "study", "paper", "explore"),
):

    include: f"workflow/rules/{part}.smk"


onstart:
    # Jobs that Snakemake starts as runs of their own are no other run. Kept open until this one ends.
    if workflow.is_main_process:
        workflow.at_work = hold(Path(".snakemake/at-work"))
        if workflow.at_work is None:
            print(WARNING + ANOTHER, file=sys.stderr)
        jobs = [
            (job.rule.name, job.wildcards) for job in workflow.dag.needrun_jobs() if job.output
        ]
        print(told(project, jobs), file=sys.stderr)
