"""Features that a scene needs: change of its results and CPU time saved without each."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.ticker import FuncFormatter

from workflow.figures import style
from workflow.figures.heat_map import cells, write
from workflow.figures.trade import panels
from workflow.markdown import two_digits

COLUMNS = {
    "amplitude": "ampli-\ntude",
    "Omega_c": r"$\Omega_c$",
    "wear": "wear\nmap",
    "lobes": "lobes",
    "force": "peak\nforce",
    "history": "first\nrounds",
}
LOBES = "lobes"
NORM = LogNorm(1e-3, 1)  # of the colours; white below
LINE, HEADER = 0.19, 0.62  # in: height of a feature, and of the space above and below a scene's
MINUS = "\N{MINUS SIGN}"
FEWEST = 5e-4  # changes below this are written as 0

Entry = dict[str, Any]


@style.styled
def draw(study: dict[str, list[Entry]]) -> Figure:
    """One matrix for each scene: features down, observables and time saved across."""
    features = study["features"]
    rows = list(dict.fromkeys(map(_name, features)))
    shown = [key for key in COLUMNS if any(entry["changes"][key] is not None for entry in features)]
    scenes = list(dict.fromkeys(entry["scene"] for entry in features))
    down = -(-len(scenes) // 2)
    drawn = panels(0.6 + down * (HEADER + LINE * len(rows)), scenes)
    for axes, scene in zip(drawn.axes, scenes, strict=True):
        image = _matrix(axes, [e for e in features if e["scene"] == scene], rows, shown)
        axes.set_title(scene, fontweight="bold")
    bar = drawn.colorbar(image, ax=drawn.axes, location="bottom", aspect=60, extend="both")
    bar.set_label("change without the feature (%; of lobes: their number); CPU time saved (%)")
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda change, _: f"{100 * change:g}"))
    return drawn


def _text(key: str, change: float) -> str:
    """Number of lobes, or the size of a change in %; 0 below ``FEWEST``."""
    if key == LOBES:
        return f"{int(change)}"
    return two_digits(100 * abs(change)) if abs(change) >= FEWEST else "0"


def _name(entry: Entry) -> str:
    return f"{entry['feature']} → {entry['instead']}"


def _matrix(axes: Axes, entries: list[Entry], rows: list[str], shown: list[str]) -> AxesImage:
    """Colour changes by their size, and write them and the time saved; lobes are not coloured."""
    sizes, texts = {}, {}
    for entry in entries:
        row = rows.index(_name(entry))
        known = {key: entry["changes"][key] for key in shown if entry["changes"][key] is not None}
        sizes |= {(row, shown.index(key)): abs(known[key]) for key in known if key != LOBES}
        texts |= {(row, shown.index(key)): _text(key, known[key]) for key in known}
        if entry["time_ratio"] is not None:
            texts[row, len(shown)] = f"{100 * (1 - entry['time_ratio']):.0f}"
    heads = [*(COLUMNS[key] for key in shown), "time\nsaved"]
    image = cells(axes, heads, rows, sizes, style.MAP, NORM)
    for cell, text in texts.items():
        write(axes, cell, text.replace("-", MINUS))
    axes.grid(which="minor", color="0.8", linewidth=0.3)
    axes.invert_yaxis()
    axes.tick_params(labeltop=True, labelbottom=False, labelsize=7)
    axes.spines[:].set_visible(False)
    return image
