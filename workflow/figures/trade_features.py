"""Matrix of changes: what a feature left out, or a choice of the model, changes, and time saved."""

from collections.abc import Mapping, Sequence

from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.ticker import FuncFormatter

from workflow.figures import style
from workflow.figures.heat_map import cells, write
from workflow.figures.trade import Run, panels
from workflow.markdown import two_digits
from workflow.study.levels import SCENES, of_group

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


@style.styled
def draw(study: Sequence[Run], groups: Sequence[str] = ("feature",)) -> Figure:
    """One matrix for each scene: rows of the ``groups`` down, observables and time saved across."""
    changed = of_group(study, *groups)
    rows = list(dict.fromkeys(map(_name, changed)))
    shown = [key for key in COLUMNS if any(row["errors"][key] is not None for row in changed)]
    times = {(row["scene"], row["row"]): row["cpu_s"] for row in study}
    down = -(-len(SCENES) // 2)
    drawn = panels(0.6 + down * (HEADER + LINE * len(rows)), SCENES)
    for axes, scene in zip(drawn.axes, SCENES, strict=True):
        image = _matrix(axes, [row for row in changed if row["scene"] == scene], rows, shown, times)
        axes.set_title(scene, fontweight="bold")
    bar = drawn.colorbar(image, ax=drawn.axes, location="bottom", aspect=60, extend="both")
    bar.set_label("change (%; of lobes: their number); CPU time saved (%)")
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda change, _: f"{100 * change:g}"))
    return drawn


def _text(key: str, change: float) -> str:
    """Number of lobes, or the size of a change in %; 0 below ``FEWEST``."""
    if key == LOBES:
        return f"{int(change)}"
    return two_digits(100 * abs(change)) if abs(change) >= FEWEST else "0"


def _name(row: Run) -> str:
    return row["row"].replace(": ", " → ")


def _matrix(
    axes: Axes, changed: Sequence[Run], rows: list[str], shown: list[str], times: Mapping
) -> AxesImage:
    """Colour changes by their size, and write them and the time saved; lobes are not coloured."""
    sizes, texts = {}, {}
    for of in changed:
        row = rows.index(_name(of))
        known = {key: of["errors"][key] for key in shown if of["errors"][key] is not None}
        sizes |= {(row, shown.index(key)): abs(known[key]) for key in known if key != LOBES}
        texts |= {(row, shown.index(key)): _text(key, known[key]) for key in known}
        ratio = of["cpu_s"] / times[of["scene"], of["against"]]
        texts[row, len(shown)] = f"{100 * (1 - ratio):.0f}"
    heads = [*(COLUMNS[key] for key in shown), "time\nsaved"]
    image = cells(axes, heads, rows, sizes, style.MAP, NORM)
    for cell, text in texts.items():
        write(axes, cell, text.replace("-", MINUS))
    axes.grid(which="minor", color="0.8", linewidth=0.3)
    axes.invert_yaxis()
    axes.tick_params(labeltop=True, labelbottom=False, labelsize=7)
    axes.spines[:].set_visible(False)
    return image
