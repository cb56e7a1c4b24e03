"""Features that a scene needs: change of its results and CPU time saved without each."""

from collections.abc import Iterator, Sequence
from typing import Any

from matplotlib.figure import Figure

from workflow.figures import cells
from workflow.markdown import two_digits

COLUMNS = {
    "amplitude": "ampli-\ntude",
    "Omega_c": r"$\Omega_c$",
    "wear": "wear\nmap",
    "lobes": "lobes",
    "force": "peak\nforce",
    "history": "first\nrounds",
    "time": "time\nsaved",
}
SHOWN = 0.1, 100  # % at the ends of the colours; white below
MINUS = "\N{MINUS SIGN}"
FEWEST = 0.05  # %; changes below this are written as 0

Entry = dict[str, Any]


def draw(study: dict[str, list[Entry]]) -> Figure:
    """One matrix for each scene: features down, observables and time saved across."""
    entries = study["features"]
    shown = [key for key in COLUMNS if any(of["changes"].get(key) is not None for of in entries)]
    records = [
        {"scene": entry["scene"], "feature": f"{entry['feature']} → {entry['instead']}"} | cell
        for entry in entries
        for cell in _cells(entry, shown)
    ]
    said = "change without the feature (%; of lobes: their number); CPU time saved (%)"
    look = {"panel": "scene", "labels": COLUMNS | {"change": said}, "limits": SHOWN, "log": True}
    return cells.draw(records, "of", "feature", "change", text="text", **look)


def _cells(entry: Entry, shown: Sequence[str]) -> Iterator[dict[str, Any]]:
    """Changes, coloured by their size in %; number of lobes and time saved are written alone."""
    for key in shown:
        change = entry["changes"][key]
        size = None if change is None or key == "lobes" else 100 * abs(change)
        yield {"of": key, "change": size, "text": _text(change, size)}
    saved = "" if entry["time_ratio"] is None else f"{100 * (1 - entry['time_ratio']):.0f}"
    yield {"of": "time", "change": None, "text": saved.replace("-", MINUS)}


def _text(change: float | None, size: float | None) -> str:
    """The size in %, 0 below ``FEWEST``; without a size the number of lobes, if it is known."""
    if size is None:
        return "" if change is None else f"{int(change)}".replace("-", MINUS)
    return two_digits(size) if size >= FEWEST else "0"
