"""Error over CPU time of the massless boundary and of the product's schemes.

    ./run python tests/verification/massless_study.py

measures all settings on the reference blade, and writes ``massless_study.json`` and
``massless_study.png``. Errors are against ``piecewise-exact`` with 65536 steps per revolution on a
basis of 60 natural modes: those of step and reduced model together. CPU times are those of the
compiled kernel alone, in one process, the least of some repeats.
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
from massless_runs import (  # noqa: E402
    CENTRAL,
    FIXED,
    LAWS,
    MASSLESS,
    MEASURED,
    OWN,
    PEAK,
    RICH,
    STATIC,
    USUAL,
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

from geometry.base import write_json  # noqa: E402
from workflow.figures import style  # noqa: E402
from workflow.markdown import rounded  # noqa: E402

SPEEDS = 0.30, 0.34, PEAK  # over f1(0)
STEPS = [shares << k for k in range(7, 13) for shares in (2, 3)][:-1]  # per revolution
CONVERGED, RICHER = 65536, 90  # steps, natural modes
EVERY = range(len(SPEEDS))
FRACTIONS = [0.8, 0.4, 0.2]  # of the stability limit
LEVELS = 0.1, 0.03, 0.01, 0.003
DYNAMIC = 6, 10, 16, 20, 24, 30, 40, 60


class Tried(NamedTuple):
    """A method, its settings, and how it is drawn."""

    method: str
    modes: int  # dynamic ones; of the product: natural modes of the basis
    run: Method
    settings: Sequence[float] = STEPS  # per revolution, or fractions of the limit
    line: str = ""  # not drawn
    colour: str = ""
    basis: int = RICH  # natural modes
    repeats: int = 3

    @property
    def name(self) -> str:
        """Its name in the picture."""
        kind = "dynamic" if self.method == MASSLESS else "natural"
        return f"{self.method}, {self.modes} {kind} modes"


DRAWN = {10: ("s--", style.VERMILLION), 24: ("^-.", style.BLUE), 40: ("D:", style.GREEN)}
METHODS = [
    Tried(OWN, USUAL, exact, STEPS, "o-", style.BLACK, USUAL),
    Tried(OWN, RICH, exact, STEPS, ".--", style.BLACK),
    *(Tried(MASSLESS, r, partial(massless, r), STEPS, *DRAWN.get(r, ())) for r in DYNAMIC),
    Tried(CENTRAL, USUAL, central, FRACTIONS, "x--", style.GREY, USUAL, repeats=1),
    Tried(FIXED, 24, partial(massless, 24, fixed=True), STEPS[-1:], repeats=1),
    Tried(STATIC, 24, partial(exact_with_static, 24), STEPS[6::2], repeats=1),
]


class Point(NamedTuple):
    """A method with one setting, over all speeds."""

    casing: str
    method: str
    modes: int
    setting: float
    errors: list[float]  # at each speed
    cpu: list[float]  # s, of the run at each

    def at(self, speeds: Sequence[int]) -> float:
        """CPU time at some speeds, s."""
        return sum(self.cpu[k] for k in speeds)


def main() -> None:
    """Measure, write, draw."""
    points = [*measure()]
    write_json({"basis": of_the_basis(), "points": points, "levels": cheapest(points)}, MEASURED)
    style.save(picture(points), MEASURED.with_suffix(".png"))


def rubs_on(natural_modes: int, law: dict) -> list[Rub]:
    """At all speeds, which are those of the rich basis, on another basis."""
    rom = model("reference", 5.0, natural_modes)
    at = [rub(model("reference", 5.0, RICH), law, over_f1) for over_f1 in SPEEDS]
    return [of._replace(rom=rom) for of in at]


def measure() -> Iterator[Point]:
    """Errors and CPU times of all settings that are stable at all speeds."""
    for casing, law in LAWS.items():
        converged = [exact(of, CONVERGED) for of in rubs_on(RICH, law)]
        for tried in METHODS:
            for setting in tried.settings:
                runs = [timed(tried, of, setting) for of in rubs_on(tried.basis, law)]
                if None not in runs:
                    errors = [rounded(of, 4) for of in map(error, runs, converged)]
                    cpu = [rounded(run.cpu, 3) for run in runs]
                    yield Point(casing, tried.method, tried.modes, setting, errors, cpu)


def timed(tried: Tried, of: Rub, setting: float) -> Run | None:
    """The fastest of the repeats."""
    runs = [tried.run(of, setting) for _ in range(tried.repeats)]
    return None if None in runs else min(runs, key=lambda run: run.cpu)


def of_the_basis() -> dict[str, float]:
    """What a richer basis changes in converged runs at the peak."""
    changes = {}
    for casing, law in LAWS.items():
        rich, richer = (exact(rubs_on(n, law)[-1], CONVERGED) for n in (RICH, RICHER))
        changes[casing] = rounded(error(rich, richer), 2)
    return changes


def cheapest(points: Sequence[Point]) -> list[list[str]]:
    """CPU time of the cheapest setting within each level, ms, and that of others over it."""
    rows = []
    for casing, level in product(LAWS, LEVELS):
        own, massless, central = (
            within(points, casing, method, level) for method in (OWN, MASSLESS, CENTRAL)
        )
        alone = (
            over(*(within(points, casing, method, level, [k]) for method in (MASSLESS, OWN)), [k])
            for k in EVERY
        )
        first = f"{rounded(1e3 * own.at(EVERY), 1):g} ({own.modes})"
        modes = f" ({massless.modes})" if massless else ""
        cells = [over(massless, own) + modes, ", ".join(alone), over(central, own)]
        rows.append([casing, f"{100 * level:g} %", first, *cells])
    return rows


def within(
    points: Sequence[Point], casing: str, method: str, level: float, at: Sequence[int] = EVERY
) -> Point | None:
    """The cheapest setting of a method whose errors ``at`` some speeds are no larger."""
    enough = (
        of for of in points if of[:2] == (casing, method) and all(of.errors[k] <= level for k in at)
    )
    return min(enough, key=lambda of: of.at(at), default=None)


def over(of: Point | None, other: Point, at: Sequence[int] = EVERY) -> str:
    """Cell of the table: CPU time over the other's; - where not reached."""
    return "-" if of is None else f"{rounded(of.at(at) / other.at(at), 1):g}"


@style.styled
def picture(points: Sequence[Point]) -> Figure:
    """A panel for each casing: error over CPU time."""
    drawn = style.panels(len(LAWS), style.DOUBLE, 2.9, columns=3)
    for axes, casing in zip(drawn.axes, LAWS, strict=True):
        for tried in METHODS:
            own = [of for of in points if of[:3] == (casing, tried.method, tried.modes)]
            if own and tried.line:
                x, y = zip(*((1e3 * sum(of.cpu), 100 * max(of.errors)) for of in own), strict=True)
                axes.plot(x, y, tried.line, color=tried.colour, label=tried.name)
        axes.set(xscale="log", yscale="log", xlabel="CPU time of three runs (ms)")
        axes.set_title(casing, loc="right")
    drawn.axes[0].set_ylabel("largest error of three speeds (%)")
    style.legend(drawn, "lower center", ncols=3)
    return drawn


if __name__ == "__main__":
    main()
