"""Errors and CPU time of rods, modes, interface and mesh, each varied alone."""

from collections.abc import Iterator, Sequence
from typing import Any

from matplotlib.figure import Figure

from workflow.figures import cells
from workflow.figures.trade import Run, title, uncertainty
from workflow.markdown import two_digits
from workflow.study.trade_levels import cost

CHOICES = ("rods", "modes", "interface", "mesh")  # varied one at a time
COLUMNS = {
    "amplitude": "ampli-\ntude",
    "wear": "wear\nmap",
    "force": "peak\nforce",
    "history": "first\nrounds",
    "time": "time",
    "error": "error (%), in brackets below the uncertainty of the reference; CPU time over that of "
    "the default (bold)",
}
SETTINGS = ("rods", "blade", "directions", "modes", "n", "patches", "strips", "mesh_mm")
SHOWN = 0.01, 100  # % at the ends of the colours; white below


def draw(study: dict[str, Any]) -> Figure:
    """One matrix for each scene: choices down, errors and CPU time across."""
    records = [
        {"scene": title(study, name)} | cell
        for name, scene in study["scenes"].items()
        for choice in CHOICES
        for cell in _cells([run for run in study["runs"] if run["scene"] == name], choice, scene)
    ]
    look = {"panel": "scene", "labels": COLUMNS, "limits": SHOWN, "log": True}
    return cells.draw(records, "of", "choice", "error", text="text", bold="default", **look)


def _cells(runs: Sequence[Run], choice: str, scene: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Errors in % of the runs of a choice, and their CPU time over that of the default."""
    usual = default(runs, choice)
    for run in (run for run in runs if run["study"] == choice):
        label = f"mesh {run['label']}" if choice == "mesh" else run["label"]
        row = {"choice": label, "default": run is usual}
        for key, unsure in uncertainty(scene, run).items():
            if key in COLUMNS:
                yield row | {"of": key} | _error(run["errors"][key], unsure or 0)
        yield row | {"of": "time", "error": None, "text": f"{cost(run) / cost(usual):.2f}"}


def _error(error: float | None, unsure: float) -> dict[str, Any]:
    """An error in %, in brackets below what is ``unsure``; nothing where it is not known."""
    if error is None:
        return {"error": None, "text": ""}
    text = two_digits(100 * error)
    return {"error": 100 * error, "text": f"({text})" if error <= unsure else text}


def default(runs: Sequence[Run], study: str) -> Run:
    """The run of a study that shares most settings with the runs of the study of schemes."""
    usual = next(run for run in runs if run["study"] == "scheme")
    of_study = [run for run in runs if run["study"] == study]
    return max(of_study, key=lambda run: sum(run[key] == usual[key] for key in SETTINGS))
