# What the study of accuracy and time marches, and with which models.
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
