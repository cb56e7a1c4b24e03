# All that computes numbers, or writes a table of them: one rule for each row of these lists.
# By rule: outputs, JSON or Markdown or both; module of workflow/ that computes them from `files` and
# what it is `given`, by its `function`; the code that they depend on; what else repeats the job when
# it changes (`uses`); names of {figure}.
for name, row in (STUDIES | PAPER_NUMBERS).items():
    output = str(next(iter(row["output"].values())))

    rule:
        name:
            name
        input:
            unpack(row["files"]),
            code=row["code"],
        output:
            **row["output"],
        log:
            f"{kept_beside(output, 'logs')}.log",
        benchmark:
            f"{kept_beside(output, 'benchmarks')}.tsv"
        wildcard_constraints:
            figure=one_of(row.get("figures", [])),
        priority: row.get("priority", 0)
        params:
            module=f"workflow.{row['module']}",
            function=row.get("function", "numbers"),
            given=row.get("given", {}),
            blade=blade_file if "{blade}" in output else "",
            uses=row.get("uses", ""),
        message:
            row["message"]
        script:
            "../scripts/numbers.py"
