# Figures and claims of the paper: run on request, not part of `rule all`.
include: "paper_names.smk"


rule paper_uncertainty:
    input:
        lambda wildcards: further_files_of("paper_uncertainty"),


rule paper_causes:
    input:
        lambda wildcards: further_files_of("paper_causes"),


rule paper_rotor37:
    input:
        lambda wildcards: further_files_of("paper_rotor37"),
