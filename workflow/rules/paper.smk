# The paper, figure by figure and claim by claim: run when asked for, no part of `rule all`.
include: "paper_names.smk"


wildcard_constraints:
    edition=EDITION,
    repeat=EDITION,
    part=one_of(PARTS.values()),
    row="[^/]+",
    cause="[^/]+",
    table=rf"{EDITION}/grid|{one_of(SCENES_OF_MAPS)}",


rule repeat_sweep:
    input:
        code=MARCH,
        rom=lambda wildcards: rom_of(of_part(wildcards.repeat, wildcards.part)),
    output:
        sweep="results/paper/{repeat}/paper-{part}.nc",
    log:
        "results/paper/{repeat}/logs/paper-{part}.log",
    benchmark:
        "results/paper/{repeat}/benchmarks/paper-{part}.tsv"
    params:
        scene=lambda wildcards: settings_of_part(wildcards.repeat, wildcards.part),
    message:
        "Scene paper-{wildcards.part} with {wildcards.repeat}"
    script:
        "../scripts/repeat_sweep.py"


rule contact_map:
    input:
        "results/paper/contact-map.json",


rule stiffness:
    input:
        "results/paper/stiffness.json",


rule paper_uncertainty:
    input:
        lambda wildcards: files_beside("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: files_beside("paper_causes"),
        expand("results/figures/{figure}.{suffix}", figure=OF_CAUSES, suffix=["png", "pdf"]),


rule paper_rotor37:
    input:
        lambda wildcards: files_beside("paper_rotor37"),
