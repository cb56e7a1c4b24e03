# A rule for each row of the table of numbers, workflow/rules/numbers.yaml.
NUMBERS = read_or_fail(yaml_file.read_mapping, own_files(["workflow/rules/numbers.yaml"])[0])


def filled(value):
    """Function of wildcards: a value of the table with its patterns filled and functions called."""

    def of(value, wildcards):
        if isinstance(value, dict):
            found = {key: of(one, wildcards) for key, one in value.items()}
            return {key: one for key, one in found.items() if one is not None}
        if isinstance(value, list):
            return [of(one, wildcards) for one in value]
        if isinstance(value, str) and value.startswith("="):
            return globals()[value[1:]](wildcards)
        return value.format(**dict(wildcards.items())) if isinstance(value, str) else value

    return lambda wildcards: of(value, wildcards)


def outputs(row):
    """Outputs of a row, one of them in the report where it says so."""
    files = dict(row["output"])
    if about := row.get("report"):
        labels = {"figure": about["caption"], "shows": about["shows"]}
        caption = f"../report/{about['caption']}.rst"
        files[about["of"]] = report(
            files[about["of"]], caption=caption, category=about["category"], labels=labels
        )
    return files


for name, row in NUMBERS.items():
    output = next(iter(row["output"].values()))
    function = f"workflow.{row['run']}"

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
        localrule: row.get("local", False)
        params:
            run=function,
            given=filled(row.get("given", {})),
            contents=filled(row.get("contents", {})),
            blade=blade_file if "{blade}" in output else "",
            uses=filled(row.get("uses", "")),
        message:
            row["message"]
        script:
            "../scripts/job.py"
