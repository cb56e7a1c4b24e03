# A rule for each row of the table of numbers, workflow/rules/numbers.yaml.
NUMBERS = read_or_fail(yaml_file.read_mapping, own_files(["workflow/rules/numbers.yaml"])[0])


def filled(value):
    """Function of wildcards: a value of the table with its patterns filled and functions called."""

    def of(value, wildcards):
        if isinstance(value, dict):
            return {key: of(one, wildcards) for key, one in value.items()}
        if isinstance(value, list):
            return [of(one, wildcards) for one in value]
        if isinstance(value, str) and value.startswith("="):
            return globals()[value[1:]](wildcards)
        return value.format(**dict(wildcards.items())) if isinstance(value, str) else value

    return lambda wildcards: of(value, wildcards)


def outputs(row):
    """Outputs of a row, that for the report with its caption."""
    about = dict(row.get("report", {}))
    kind, caption = next(iter(about.items()), (None, None))
    return {
        name: report(
            file,
            caption=f"../report/{caption}.rst",
            category=about["category"],
            labels={"figure": caption, "shows": about["shows"]},
        )
        if name == kind
        else file
        for name, file in row["output"].items()
    }


for name, row in NUMBERS.items():
    output = next(iter(row["output"].values()))
    function = row["run"] if row["run"].startswith("tests.") else f"workflow.{row['run']}"

    rule:
        name:
            name
        input:
            unpack(filled(row.get("files", {}))),
            code=code_of(function),
        output:
            **outputs(row),
        log:
            f"{kept_beside(output, 'logs')}.log",
        benchmark:
            f"{kept_beside(output, 'benchmarks')}.tsv"
        wildcard_constraints:
            figure=one_of(row.get("figures", [])),
        params:
            run=function,
            given=filled(row.get("given", {})),
            blade=blade_file if "{blade}" in output else "",
            uses=filled(row.get("uses", "")),
        message:
            row["message"]
        script:
            "../scripts/job.py"
