"""What every figure must have: named axes with units, no text cut off or over another."""

import re
from collections.abc import Iterator
from itertools import combinations

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from workflow.figures.style import RC

TOUCH = 3.0  # pixels by which the boxes of two texts may overlap: they have a margin
UNITS = ("(", "/", "over", "%", ", ")  # of an axis: in brackets, a ratio, or behind a comma
# numbers without a unit: counts, shares, and moduli in the unit that a scene gives them
PURE = (
    "nodes",
    "fraction",
    "lobes",
    "number",
    "patches",
    "modulus",
    "strain",
    "stress",
    "share",
    "error",
    "revolutions",
)
NUMBER = re.compile(r"[-\N{MINUS SIGN}]?[\d.,]+( %)?|\$\\mathdefault.*")


def faults(drawn: Figure) -> list[str]:
    """What is wrong with a figure, a line each."""
    with mpl.rc_context(RC):
        drawn.dpi = RC["savefig.dpi"]
        drawn.draw_without_rendering()
        boxes = {text: text.get_window_extent() for text in _texts(drawn) if _is_seen(text)}
    page = drawn.bbox.padded(TOUCH)
    cut = [f"cut off: {text.get_text()!r}" for text, box in boxes.items() if not _in(box, page)]
    level = [(text, box) for text, box in boxes.items() if text.get_rotation() % 90 == 0]
    over = [
        f"over one another: {one.get_text()!r} and {other.get_text()!r}"
        for (one, at), (other, there) in combinations(level, 2)
        if _overlap(at, there)
    ]
    return cut + over + [fault for axes in _all_axes(drawn) for fault in _of_axes(axes)]


def _of_axes(axes: Axes) -> Iterator[str]:
    """Axes with numbers, but without a label or unit."""
    for name, axis in (("x", axes.xaxis), ("y", axes.yaxis)):
        labels = {axis.label.get_text(), *_labels_beside(axes, name)} - {""}
        numbers = any(NUMBER.fullmatch(label.get_text()) for label in _tick_labels(axis))
        if not axes.axison or not numbers:
            continue
        if not labels:
            yield f"no label: {name} axis of {axes.get_title()!r}"
        elif not any(unit in label for label in labels for unit in UNITS + PURE):
            yield f"no unit: {labels}"


def _labels_beside(axes: Axes, name: str) -> Iterator[str]:
    """Labels of the figure, and of the panels in the same column (x) or row (y)."""
    drawn = axes.get_figure()
    yield getattr(drawn, f"get_sup{name}label")()
    span = {"x": "colspan", "y": "rowspan"}[name]
    for other in drawn.axes:
        both = [one.get_subplotspec() for one in (axes, other)]
        if None not in both and len({getattr(one, span) for one in both}) == 1:
            yield getattr(other, f"get_{name}label")()


def _all_axes(drawn: Figure) -> list[Axes]:
    return [one for axes in drawn.axes for one in (axes, *axes.child_axes)]


def _tick_labels(axis: Axis) -> list[Text]:
    """Labels of the ticks that are drawn: others are there too, beyond the ends of the axis."""
    return [
        label
        for tick in axis._update_ticks()
        for label in (tick.label1, tick.label2)
        if label.get_visible() and label.get_text()
    ]


def _texts(drawn: Figure) -> Iterator[Text]:
    yield from (*drawn.texts, drawn._suptitle, drawn._supxlabel, drawn._supylabel)
    for legend in (*drawn.legends, *(axes.get_legend() for axes in drawn.axes)):
        yield from legend.get_texts() if legend else ()
    for axes in _all_axes(drawn):
        yield from (*axes.texts, axes.title, axes._left_title, axes._right_title)
        for axis in (axes.xaxis, axes.yaxis) if axes.axison else ():
            yield from (axis.label, axis.get_offset_text(), *_tick_labels(axis))


def _is_seen(text: Text | None) -> bool:
    return text is not None and text.get_visible() and bool(text.get_text().strip())


def _in(box: Bbox, page: Bbox) -> bool:
    return page.x0 <= box.x0 and page.y0 <= box.y0 and box.x1 <= page.x1 and box.y1 <= page.y1


def _overlap(one: Bbox, other: Bbox) -> bool:
    shared = Bbox.intersection(one, other)
    return shared is not None and min(shared.width, shared.height) > TOUCH
