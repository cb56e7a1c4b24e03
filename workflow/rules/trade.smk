# The study of accuracy and time: run when asked for, no part of `rule all`.
from workflow.study.trade_models import BASES, EIGHT, LINEAR, REFERENCE, all_models
from workflow.study.trade_plan import SCENES as TRADE_SCENES

TRADE = sources(
    "simulate/*.py",
    "simulate/laws/*.py",
    *(f"workflow/study/trade{n}.py" for n in ("", "_models", "_plan", "_runs", "_errors")),
)


def settings_of_studied(studied):
    """Settings of the scenes of a study, by their short names."""
    return {name: SCENES[of.file].model_dump(mode="json") for name, of in studied.items()}


def files_of_models(models, directions=("r", "rt")):
    return [model.to(d).file for model in models for d in directions]


TRADE_NUMBERS = {  # name: its module, and the models that it marches or other files
    f"scene-{name}": ("trade", {"models": [m.file for m in all_models(of.directions)]})
    for name, of in TRADE_SCENES.items()
} | {
    "trade": (
        "trade_levels",
        {"scenes": expand("results/trade/scene-{name}.json", name=TRADE_SCENES)},
    ),
    "smaller": ("trade_smaller", {"models": files_of_models([REFERENCE, LINEAR])}),
    "features": (
        "trade_features",
        {
            "matrices": f"results/{PAPER_BLADE}/matrices.h5",
            "models": [*files_of_models([REFERENCE, LINEAR, EIGHT]), REFERENCE.to("rtz").file],
        },
    ),
}
TRADE_PICTURES = {  # and their modules
    "trade": "trade",
    "steps": "trade_steps",
    "choices": "trade_choices",
    "features": "trade_features",
}


def given_to_trade(wildcards):
    """Settings of the scenes that are marched: of one by its name, of all, or of none."""
    if wildcards.part == "trade":
        return {}
    scenes = settings_of_studied(TRADE_SCENES)
    name = wildcards.part.removeprefix("scene-")
    return {"name": name, "scene": scenes[name]} if name in scenes else {"scenes": scenes}


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
