# The study of accuracy and time: run when asked for, no part of `rule all`.
from workflow.study.trade_models import BASES, EIGHT, LINEAR, REFERENCE, all_models
from workflow.study.trade_plan import SCENES as TRADE_SCENES
from workflow.study.trade_plan import least_of

TRADE = sources(
    "simulate/*.py",
    "simulate/laws/*.py",
    *(f"workflow/study/trade{n}.py" for n in ("", "_models", "_plan", "_runs", "_errors")),
)
# the same scene may be studied at two speeds
TRADE_SETTINGS = {
    name: SCENES[scene].model_dump(mode="json")
    for name, (scene, _) in TRADE_SCENES.items()
    if scene in SCENES
}


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


rule trade_scene:
    input:
        code=TRADE,
        models=lambda wildcards: [m.file for m in all_models(least_of(wildcards.part))],
    output:
        json="results/trade/scene-{part}.json",
    log:
        "results/trade/logs/scene-{part}.log",
    benchmark:
        "results/trade/benchmarks/scene-{part}.tsv"
    wildcard_constraints:
        part="|".join(TRADE_SCENES),
    priority: 1
    params:
        scene=lambda wildcards: TRADE_SETTINGS[wildcards.part],
    message:
        "Accuracy and time on scene {wildcards.part}"
    script:
        "../scripts/trade_scene.py"


rule merge_trade:
    input:
        code=sources("workflow/study/trade_levels.py"),
        scenes=expand("results/trade/scene-{part}.json", part=TRADE_SCENES),
    output:
        json="results/trade/trade.json",
    log:
        "results/trade/logs/trade.log",
    params:
        names=list(TRADE_SCENES),
    message:
        "Fronts and levels of accuracy and time"
    script:
        "../scripts/trade_levels.py"


rule trade_smaller:
    input:
        code=TRADE + sources("workflow/study/trade_smaller.py"),
        models=[m.to(d).file for m in (REFERENCE, LINEAR) for d in ("r", "rt")],
    output:
        json="results/trade/smaller.json",
    log:
        "results/trade/logs/smaller.log",
    benchmark:
        "results/trade/benchmarks/smaller.tsv"
    priority: -1  # the longest jobs wait for models
    params:
        scenes=TRADE_SETTINGS,
    message:
        "Linear stress, fewer rounds, fewer speeds"
    script:
        "../scripts/trade_smaller.py"


rule trade_features:
    input:
        code=TRADE + sources("rom/*.py", "workflow/study/trade_features.py"),
        matrices=f"results/{PAPER_BLADE}/matrices.h5",
        models=[m.to(d).file for m in (REFERENCE, LINEAR, EIGHT) for d in ("r", "rt")]
        + [REFERENCE.to("rtz").file],
    output:
        json="results/trade/features.json",
    log:
        "results/trade/logs/features.log",
    benchmark:
        "results/trade/benchmarks/features.tsv"
    priority: -1
    params:
        scenes=TRADE_SETTINGS,
    message:
        "What a scene requires"
    script:
        "../scripts/trade_features.py"


TRADE_PICTURES = {  # and their modules
    "trade": "trade",
    "steps": "trade_steps",
    "choices": "trade_choices",
    "features": "trade_features",
}


rule draw_trade:
    input:
        code=lambda wildcards: drawn_by(TRADE_PICTURES[wildcards.picture]) + drawn_by("trade"),
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
