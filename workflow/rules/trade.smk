# The study of accuracy and time: run when asked for, no part of `rule all`.
include: "trade_names.smk"


rule reduce_for_trade:
    input:
        code=sources("rom/*.py", "fem/matrices.py", "workflow/study/trade_models.py"),
        matrices="results/{blade}/matrices.h5",
    output:
        rom="results/trade/models/{blade}-{basis}-{directions}.nc",
    log:
        "results/trade/logs/reduce-{blade}-{basis}-{directions}.log",
    benchmark:
        "results/trade/benchmarks/reduce-{blade}-{basis}-{directions}.tsv"
    wildcard_constraints:
        basis="|".join(BASES),
    message:
        "Reduced model of blade {wildcards.blade}, basis {wildcards.basis}, {wildcards.directions}"
    script:
        "../scripts/trade_model.py"


rule trade_numbers:
    input:
        unpack(lambda wildcards: TRADE_NUMBERS[wildcards.part][1]),
        code=lambda wildcards: TRADE
        + sources("rom/*.py", f"workflow/study/{TRADE_NUMBERS[wildcards.part][0]}.py"),
    output:
        json="results/trade/{part}.json",
    log:
        "results/trade/logs/{part}.log",
    benchmark:
        "results/trade/benchmarks/{part}.tsv"
    wildcard_constraints:
        part="|".join(TRADE_NUMBERS),
    priority: -1  # the longest jobs wait for models
    params:
        module=lambda wildcards: f"workflow.study.{TRADE_NUMBERS[wildcards.part][0]}",
        given=given_to_trade,
    message:
        "Accuracy and time: {wildcards.part}"
    script:
        "../scripts/numbers.py"


rule draw_trade:
    input:
        code=lambda wildcards: drawn_by(TRADE_PICTURES[wildcards.picture], "trade")
        + sources("workflow/study/trade_errors.py", "workflow/study/trade_levels.py"),
        trade="results/trade/trade.json",
        features="results/trade/features.json",
    output:
        png="results/trade/{picture}.png",
        pdf="results/trade/{picture}.pdf",
    log:
        "results/trade/logs/draw-{picture}.log",
    wildcard_constraints:
        picture="|".join(TRADE_PICTURES),
    params:
        module=lambda wildcards: f"workflow.figures.{TRADE_PICTURES[wildcards.picture]}",
    message:
        "Picture {wildcards.picture} of the study of accuracy and time"
    script:
        "../scripts/figure.py"


rule trade:
    input:
        expand("results/trade/{part}.json", part=["trade", "smaller", "features"]),
        expand("results/trade/{picture}.png", picture=TRADE_PICTURES),
