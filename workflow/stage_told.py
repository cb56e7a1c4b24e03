"""What a summary says of the blades of a stage: which of them rub, and the worst one."""

from collections.abc import Sequence
from itertools import groupby
from statistics import correlation, median
from typing import Literal

from simulate.sweeps.result_types import OfBlades

HEADS = ["EO", "mode", "rpm", "number (blade)", "worst blade", "most", "median", "least"]
SCATTERED: dict[str, tuple[Literal["longer", "frequencies"], float, str, tuple[str, str]]] = {
    "length": ("longer", 1e6, "µm", ("longest", "shortest")),
    "frequencies": ("frequencies", 1e2, "%", ("highest", "lowest")),
}  # by name: key, scale, unit, names of the ends
EQUAL = 1e-9  # m, and relative: less is no difference
FEWEST = 5  # values that differ, of which a rank correlation says something


def listed(numbers: Sequence[int]) -> str:
    """Ascending numbers of blades, those in turn as a range.

    >>> listed([0, 1, 2, 5, 7, 8])
    '0 to 2, 5, 7, 8'
    """
    turns = groupby(enumerate(numbers), key=lambda at: at[1] - at[0])
    runs = ([number for _, number in turn] for _, turn in turns)
    return ", ".join(
        f"{run[0]} to {run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs
    )


def worst(of: OfBlades) -> str:
    """Which blades rub, how the worst one and the one that moves least differ, in a sentence."""
    count, rub, number = len(of["longer"]), of["rub"], of["worst"]
    differ = [name for name, (key, *_) in SCATTERED.items() if max(of[key]) - min(of[key]) > EQUAL]
    largest = of["numbers"]["displacement"]
    least = largest.index(min(largest))
    parts = [
        f"all {count} blades rub"
        if len(rub) == count
        else f"{len(rub)} of {count} blades rub ({listed(rub) or 'none'})",
        f"the worst is blade {number}: {_off(of, number, differ)}",
    ]
    if median(largest) > 0:
        parts += [
            f"its largest displacement is {largest[number] / median(largest):.3g} times the median",
            f"blade {least} moves least, by {largest[least] / largest[number]:.3g} of it: "
            f"{_off(of, least, differ)}",
        ]
    with_each = [
        f"{correlation(largest, values, method='ranked'):+.1f} with {name}"
        for name in differ
        if len({*(values := of[SCATTERED[name][0]])}) >= FEWEST and len({*largest}) > 1
    ]
    return "; ".join([*parts, *[f"rank correlation {', '.join(with_each)}"] * bool(with_each)])


def _off(of: OfBlades, number: int, differ: Sequence[str]) -> str:
    """By how much a blade is off those of the scene in what they ``differ`` in."""
    return ", ".join(_of(of, number, name) for name in differ) or "equal to the others"


def _of(of: OfBlades, number: int, name: str) -> str:
    """The same of one ``name`` of ``SCATTERED``, and whether the blade alone is at an end."""
    key, scale, unit, ends = SCATTERED[name]
    values, value = of[key], of[key][number]
    at = {max(values): f" (the {ends[0]})", min(values): f" (the {ends[1]})"}
    end = at.get(value, "") * (values.count(value) == 1)
    return f"{name} {scale * value:+.3g} {unit}{end}"
