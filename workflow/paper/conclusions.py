"""Texts on the paper's claims: where they hold, and what would decide the rest.

And the blocks of pages that the paper fills, for ``workflow.readme``.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from math import sqrt
from textwrap import fill
from typing import Any

from workflow.markdown import WIDTH, cell, table
from workflow.paper import long as long_times
from workflow.paper.claims import COATING
from workflow.paper.published import SHIFTS
from workflow.paper.report import Row, named, short
from workflow.paper.verdict import HOLDS
from workflow.summary import OVER_F1, OVER_GAP, over_gap, peaks

FIT, DATA = "K = 4.55, printed", "with C12 and C16"  # whose medoid the scenes of the paper take
NEARLY_ALL, HARDLY_ANY = 0.9, 0.1  # share of the draws

INTRODUCTION = """\
Claims of the paper by where they hold: on the scenes' blade with the scenes' values, on {other},
and in the draws of the posterior that the scenes take, where blade, casing, unit of E and damping
vary as far as the paper's critical speeds and the order of its coatings allow ({draws} draws of a
posterior of effective size {size:.0f}: a share of {share:.0f} % has a standard error of
{error:.0f} %). Claims about model and method have no draws."""
GROUPS = {  # text on the claims of each
    "everywhere": "**Hold on each blade where they were judged**, and in at least 90 % of the"
    " draws:",
    "here": "**Hold here, but not everywhere**: on the other blade, or in more than a tenth of the"
    " draws, they do not:",
    "data": "**Were data here**, and are predictions on the other blade only:",
    "elsewhere": "**Differ here, and hold elsewhere**: on the other blade, or in more than a tenth"
    " of the draws:",
    "nowhere": "**Hold on neither blade**, and in at most a tenth of the draws (a choice of ours"
    " made otherwise may reverse them: `results/paper/claims.md`):",
    "open": "**Open**: our uncertainty spans both answers, or their runs are missing:",
}
LONG = """\
**Twenty revolutions are not the end.** At {peak:.3f} f₁(0), the peak of EO 4 of E = 10 after
{rounds} revolutions, the amplitude is {begin:.2f} gaps then; after {last}: {end}. A run-up
through that peak, each speed from the end of the one before, reaches {up:.1f} gaps and
{up_wear:.1f} gaps of wear at {up_at:.3f}{ended}; runs from rest reach {rest:.1f} and
{rest_wear:.1f}. A critical speed from runs from rest is no bound for an engine that accelerates."""
STILL_GROWING = ", where it ends, so that its peak may be higher still"
EXPERIMENT = """\
**What an experiment would have to measure.** The paper's four critical speeds and the order of its
coatings leave open the unit of E by a factor of {unit[0]:.2g} (assumed: {unit[1]:.3g}), the
casing's largest distortion by {casing[0]:.2g} ({casing[1]:.2g}), damping by {damping[0]:.2g}
({damping[1]:.2g}), and the mean distortion between {mean[0]:.2g} and {mean[2]:.2g} of the second
harmonic ({assumed[0]:.2g} and {assumed[2]:.2g}; all 5 to 95 %). In {four:.0f} % of the posterior
({four_before:.0f} % of the prior) the casing is nearest at four places instead of two. The number
of rub marks away from resonance shows this; the paper's two (C15) were no datum. The depth of a
slow rub shows the largest distortion; a ring-down without contact shows damping; an indentation by
the tip shows the unit of E times footprint over thickness, and no more than this product enters the
contact force."""
OF_MODEL = 10  # claims on model and method, the first ones
PARAGRAPH = """\
Of the paper's {model} statements on its model and method, {held} hold here; of {silent} the
paper gives no number. Of its {motion} statements on how the blade vibrates and the liner wears,
{data} served to infer or set what it leaves open; of the other {predicted}, {holding} hold on the
blade inferred, {in_kind} of them with other numbers than the paper's. Not found there: {differs};
undecided, within the error of our runs: {undecided}."""


def text(claims: Sequence[Row], identified: Mapping[str, Any], long: Mapping[str, Any]) -> str:
    """The paragraphs, as Markdown.

    Parameters
    ----------
    claims : rows of their table
    identified : what the identification found (workflow/paper/identified)
    long : numbers of long times
    """
    compared = [row for row in claims if row["verdict"] != "not comparable"]
    groups = {name: [_line(row) for row in compared if _group(row) == name] for name in GROUPS}
    draws, size = identified["shares"]["draws"], identified["fits"][FIT][DATA]["effective"]
    return "\n\n".join(
        [
            fill(
                INTRODUCTION.format(
                    other=" and ".join(named(claims, "other")) or "no other",
                    draws=draws,
                    size=size,
                    share=100 * NEARLY_ALL,
                    error=100 * sqrt(NEARLY_ALL * (1 - NEARLY_ALL) * (1 / draws + 1 / size)),
                ),
                WIDTH,
            ),
            *(
                "\n".join([fill(GROUPS[name], WIDTH), "", *lines])
                for name, lines in groups.items()
                if lines
            ),
            fill(_long(long), WIDTH),
            fill(_experiment(identified), WIDTH),
        ]
    )


def _group(row: Row) -> str:
    """Where a claim stands, as of ``GROUPS``."""
    share, elsewhere = _share(row), [other["verdict"] for other in row["other"].values()]
    there = [verdict in HOLDS for verdict in elsewhere if verdict != "not judged"]
    if row["verdict"] in ("undecided", "not judged"):
        return "open"
    if row["verdict"] == "calibrated":
        return "data"
    if row["verdict"] in HOLDS:
        alike = all(there) and (share is None or share >= NEARLY_ALL)
        return "everywhere" if alike else "here"
    return "elsewhere" if any(there) or (share or 0.0) > HARDLY_ANY else "nowhere"


def _share(row: Row) -> float | None:
    """Share of the draws, of the first prior; None for a claim that is not judged there."""
    return next(iter(row["shares"].values()), None)


def _line(row: Row) -> str:
    """A claim with its verdict here, its share and its verdicts on other blades."""
    share = _share(row)
    parts = [
        row["verdict"],
        *([f"{100 * share:.0f} % of the draws"] if share is not None else []),
        *(f"{name}: {there['verdict']}" for name, there in row["other"].items()),
    ]
    return f"- {row['id']}: {row['says']} ({'; '.join(parts)})"


def _long(numbers: Mapping[str, Any]) -> str:
    first, last = numbers["amplitude"][0], numbers["amplitude"][-1]
    best, through = first.index(max(first)), numbers["through"]
    return LONG.format(
        rounds=numbers["rounds"][0],
        last=numbers["rounds"][-1],
        peak=numbers["speeds"][best],
        begin=first[best],
        end=cell(last[best], numbers["status"][-1][best]),
        up=through["run_up"]["largest"],
        up_at=through["run_up"]["at"],
        up_wear=through["run_up"]["deepest_wear"],
        ended=STILL_GROWING * (through["run_up"]["largest"] == through["run_up"]["at_highest"]),
        rest=through["rest"]["largest"],
        rest_wear=through["rest"]["deepest_wear"],
    )


def _experiment(identified: Mapping[str, Any]) -> str:
    taken, prior = identified["fits"][FIT][DATA], identified["prior"]

    def factors(name: str) -> list[float]:
        """Range of a positive parameter as a ratio, in the posterior and in the prior."""
        return [of["ranges"][name][2] / of["ranges"][name][0] for of in (taken, prior)]

    return EXPERIMENT.format(
        unit=factors("unit_Pa"),
        casing=factors("casing_gaps"),
        damping=factors("damping_ratio"),
        mean=taken["ranges"]["constant_over_second"],
        assumed=prior["ranges"]["constant_over_second"],
        four=100 * taken["four_places"],
        four_before=100 * prior["four_places"],
    )


def coatings(summary: Mapping[str, Any]) -> str:
    """Critical speeds, amplitudes and wear of both coatings at the two main engine orders."""
    by_scene = {
        (scene["scene"], str(row["k"])): row for scene, row in peaks(summary) if 1 in row["modes"]
    }
    rows = [
        [COATING[part], k, *cells[:2], f"{paper:.3f}", *cells[2:]]
        for (part, k), (paper, _) in SHIFTS.items()
        if (row := by_scene.get((f"paper-{part}", k))) and (cells := over_gap(row))
    ]
    return table(["coating", "k", *OVER_F1, "in the paper", *OVER_GAP], rows)


def verdicts(judged: Sequence[Mapping[str, Any]]) -> str:
    """Three sentences on the paper's claims for a reader who does not know them."""
    model, motion = (
        Counter(row["verdict"] for row in of) for of in (judged[:OF_MODEL], judged[OF_MODEL:])
    )
    held, holding = (sum(of[verdict] for verdict in HOLDS) for of in (model, motion))
    data = motion["calibrated"]
    return fill(
        PARAGRAPH.format(
            model=model.total(),
            held=held,
            silent=model["not comparable"],
            motion=motion.total(),
            data=data,
            predicted=motion.total() - data,
            holding=holding - data,
            in_kind=motion["reproduced in kind"],
            **{
                verdict: ", ".join(
                    f'"{row["says"]}"' for row in judged if row["verdict"] == verdict
                )
                or "none"
                for verdict in ("differs", "undecided")
            },
        ),
        WIDTH,
    )


# block, file that holds its numbers, function that writes them
COMPUTED = (
    ("found", "results/summary.json", coatings),
    ("verdicts", "results/paper/claims.json", verdicts),
    ("claims", "results/paper/claims.json", short),
    ("conclusions", "results/paper/conclusions.md", str),
    ("cost", "results/paper/cost.md", str),
    ("long", "results/paper/long-times.json", long_times.table),
)
