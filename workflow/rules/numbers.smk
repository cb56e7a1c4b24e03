# Rules that compute numbers or write tables of them, one for each row of these lists. Keys of a row:
# `output`, JSON or Markdown or both, HTML, or JSON and the CSV table of a design; `run`, the module of
# `package` (workflow, if there is none) and its function, which is called with `files` and the
# arguments `given`; `uses`, other values whose change repeats the job.
for name, row in (STUDIES | PAPER_NUMBERS | IDENTIFY_NUMBERS).items():
    output = str(next(iter(row["output"].values())))
    function = f"{row.get('package', 'workflow')}.{row['run']}"

    rule:
        name:
            name
        input:
            unpack(row["files"]),
            code=code_of(function),
        output:
            **row["output"],
        log:
            f"{kept_beside(output, 'logs')}.log",
        benchmark:
            f"{kept_beside(output, 'benchmarks')}.tsv"
        priority: row.get("priority", 0)
        params:
            run=function,
            given=row.get("given", {}),
            blade=blade_file if "{blade}" in output else "",
            uses=row.get("uses", ""),
        message:
            row["message"]
        script:
            "../scripts/job.py"
