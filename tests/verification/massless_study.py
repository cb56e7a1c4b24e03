"""Error over CPU time of the massless boundary and of the product's schemes.

    ./run python tests/verification/massless_study.py

measures all settings on the reference blade, and writes ``massless_study.json`` and
``massless_study.png``. Errors are against ``piecewise-exact`` with 65536 steps per revolution. CPU
times are those of the compiled kernel alone, in one process, the least of some repeats.
"""

import os
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent / "simulate")]
os.environ["OMP_NUM_THREADS"] = "1"

from massless import Run  # noqa: E402
from massless_boundary import (  # noqa: E402
    FEW,
    LAWS,
    MANY,
    MEASURED,
    OTHERS,
    OWN,
    PEAK,
    Method,
    Rub,
    central,
    error,
    exact,
    exact_with_static,
    massless,
    model,
    rub,
)
from matplotlib.figure import Figure  # noqa: E402

from geometry.project import write_json  # noqa: E402
from workflow.figures import style  # noqa: E402
from workflow.markdown import rounded  # noqa: E402

SPEEDS = 0.30, 0.34, PEAK  # over f1(0)
STEPS = [shares << k for k in range(7, 14) for shares in (2, 3)][:-1]  # per revolution
CONVERGED = 65536
FRACTIONS = [0.8, 0.4, 0.2]  # of the stability limit
LEVELS = 0.1, 0.03, 0.01, 0.003, 0.001
MASSLESS, CENTRAL, STATIC = OTHERS


class Tried(NamedTuple):
    """A method, its settings, and how it is drawn."""

    method: str
    modes: int | None  # that move; None: all
    run: Method
    settings: Sequence[float] = STEPS  # per revolution, or fractions of the limit
    line: str = ""  # not drawn
    colour: str = ""
    repeats: int = 3

    @property
    def name(self) -> str:
        """Its name in the picture."""
        return self.method + (f", {self.modes} modes move" if self.modes else "")


def _massless(modes: int, line: str, colour: str) -> Tried:
    return Tried(MASSLESS, modes, partial(massless, modes), STEPS, line, colour)


METHODS = [
    Tried(OWN, None, exact, STEPS, "o-", style.BLACK),
    _massless(6, "v:", style.GREY),
    _massless(10, "s--", style.VERMILLION),
    _massless(FEW, "^-.", style.BLUE),
    _massless(MANY, "D:", style.GREEN),
    Tried(CENTRAL, None, central, FRACTIONS, "x--", style.GREY, repeats=1),
    Tried(STATIC, FEW, partial(exact_with_static, FEW)),
]


class Point(NamedTuple):
    """A method with one setting, over all speeds."""

    casing: str
    method: str
    modes: int | None
    setting: float
    error: float  # largest
    cpu: float  # s, of the runs at all speeds


def main() -> None:
    """Measure, write, draw."""
    points = [*measure()]
    write_json({"points": points, "levels": cheapest(points)}, MEASURED)
    style.save(picture(points), MEASURED.with_suffix(".png"))


def measure() -> Iterator[Point]:
    """Errors and CPU times of all settings that are stable at all speeds."""
    rom = model("reference", 5.0)
    for casing, law in LAWS.items():
        rubs = [rub(rom, law, over_f1) for over_f1 in SPEEDS]
        converged = [exact(of, CONVERGED) for of in rubs]
        for tried in METHODS:
            for setting in tried.settings:
                runs = [timed(tried, of, setting) for of in rubs]
                if None not in runs:
                    worst, cpu = max(map(error, runs, converged)), sum(run.cpu for run in runs)
                    of = casing, tried.method, tried.modes, setting
                    yield Point(*of, rounded(worst, 4), rounded(cpu, 4))


def timed(tried: Tried, of: Rub, setting: float) -> Run | None:
    """The fastest of the repeats."""
    runs = [tried.run(of, setting) for _ in range(tried.repeats)]
    return None if None in runs else min(runs, key=lambda run: run.cpu)


def cheapest(points: Sequence[Point]) -> list[list[str]]:
    """CPU time of the cheapest setting within each level, ms, and that of others over it."""
    rows = []
    for casing, level in product(LAWS, LEVELS):
        within = [of for of in points if of.casing == casing and of.error <= level]
        own = min(of.cpu for of in within if of.method == OWN)
        others = (
            min((of for of in within if of.method == method), key=lambda of: of.cpu, default=None)
            for method in OTHERS
        )
        rows.append(
            [casing, f"{100 * level:g} %", f"{1e3 * own:.0f}", *(over(of, own) for of in others)]
        )
    return rows


def over(of: Point | None, own: float) -> str:
    """Cell of the table: CPU time over ``own``, with the modes that move; - where not reached."""
    if of is None:
        return "-"
    return f"{of.cpu / own:.2g}" + (f" ({of.modes} modes)" if of.modes else "")


@style.styled
def picture(points: Sequence[Point]) -> Figure:
    """A panel for each casing: error over CPU time."""
    drawn = style.panels(len(LAWS), style.DOUBLE, 2.9, columns=3)
    for axes, casing in zip(drawn.axes, LAWS, strict=True):
        for tried in METHODS:
            own = [of for of in points if of[:3] == (casing, tried.method, tried.modes)]
            if own and tried.line:
                x, y = zip(*((1e3 * of.cpu, 100 * of.error) for of in own), strict=True)
                axes.plot(x, y, tried.line, color=tried.colour, label=tried.name)
        axes.set(xscale="log", yscale="log", xlabel="CPU time of three runs (ms)")
        axes.set_title(casing, loc="right")
    drawn.axes[0].set_ylabel("largest error of three speeds (%)")
    style.legend(drawn, "lower center", ncols=3)
    return drawn


if __name__ == "__main__":
    main()
