# The paper: its claims and their cost. Run on request, not part of `rule all`.


rule paper:
    input:
        "results/paper/claims.md",
        "results/paper/index.html",
        "results/paper/cost.md",
        pictures(
            name
            for name, row in FIGURES.rows.items()
            if row.category == "The paper" or name.startswith("fig")
        ),
        pictures(["stress-paper-e10"]),


rule paper_beyond:
    input:
        "results/paper/long-times.json",
        pictures(["long-times"]),


rule paper_uncertainty:
    input:
        lambda wildcards: further_files_of("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: further_files_of("paper_causes"),


rule paper_rotor37:
    input:
        lambda wildcards: further_files_of("paper_rotor37"),
