"""Matrix of changes: by a feature left out or by a choice of the model, and the time it saves."""

from collections.abc import Iterator, Sequence

from matplotlib.figure import Figure

from workflow.figures import cells
from workflow.figures.trade import Run
from workflow.markdown import two_digits
from workflow.study.levels import of_group

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
SAID = "change (%; of lobes: their number); CPU time saved (%)"


def draw(study: Sequence[Run], groups: Sequence[str] = ("feature",)) -> Figure:
    """One matrix for each scene: rows of the ``groups`` down, observables and time saved across."""
    changed = of_group(study, *groups)
    times = {(row["scene"], row["row"]): row["cpu_s"] for row in study}
    shown = [key for key in COLUMNS if any(row["errors"].get(key) is not None for row in changed)]
    records = [
        {"scene": row["scene"], "row": row["row"].replace(": ", " → ")} | cell
        for row in changed
        for cell in _cells(row, shown, row["cpu_s"] / times[row["scene"], row["against"]])
    ]
    look = {"panel": "scene", "labels": COLUMNS | {"change": SAID}, "limits": SHOWN, "log": True}
    return cells.draw(records, "of", "row", "change", text="text", **look)


def _cells(row: Run, shown: Sequence[str], time_ratio: float) -> Iterator[dict[str, object]]:
    """Changes, coloured by their size in %; number of lobes and time saved are written alone."""
    for key in shown:
        change = row["errors"][key]
        size = None if change is None or key == "lobes" else 100 * abs(change)
        yield {"of": key, "change": size, "text": _text(change, size)}
    saved = f"{100 * (1 - time_ratio):.0f}"
    yield {"of": "time", "change": None, "text": saved.replace("-", MINUS)}


def _text(change: float | None, size: float | None) -> str:
    """The size in %, 0 below ``FEWEST``; without a size the number of lobes, if it is known."""
    if size is None:
        return "" if change is None else f"{int(change)}".replace("-", MINUS)
    return two_digits(size) if size >= FEWEST else "0"
