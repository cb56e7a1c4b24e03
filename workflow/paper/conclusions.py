"""What a reader may conclude: which of the paper's claims stand where, and what would tell more."""

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any

from workflow.identify.likelihood import K_OF_E1, WITH_ORDER, Fit
from workflow.identify.report import WIDTH, share_at_four_places
from workflow.paper.verdict import HOLDS

NEARLY_ALL, HARDLY_ANY = 0.9, 0.1  # share of the draws

type Row = Mapping[str, Any]

INTRODUCTION = """\
Claims of the paper by where they hold: on the reference blade at its medoid, on {other}, and in
the draws of the posterior that the scenes take, where casing, unit of E and damping vary as far as
the paper's speeds allow. Claims about model and method have no draws."""
GROUPS = {  # what is said of the claims of each
    "everywhere": "**Stand wherever they were judged**: on every blade, and in at least 90 % of the"
    " draws:",
    "here": "**Stand here, but not everywhere**: on the other blade, or in more than a tenth of the"
    " draws, they do not:",
    "elsewhere": "**Differ here, and hold elsewhere**: on the other blade, or in more than a tenth"
    " of the draws:",
    "nowhere": "**Stand nowhere that was tried**, or in less than a tenth of the draws:",
}
LONG = """\
**Twenty rounds are not the end.** At {peak:.3f} f₁(0), the k = 4 peak of E = 10 after {rounds}
rounds, the amplitude is {begin:.2f} gaps then and {end:.2f} after {last}. A run-up through that
peak, each speed from where the one before ended, reaches {up:.1f} gaps and {up_wear:.1f} gaps of
wear at {up_at:.3f}; runs from rest reach {rest:.1f} and {rest_wear:.1f}. A critical speed read from
runs from rest is no bound for an engine that accelerates."""
EXPERIMENT = """\
**What an experiment would have to measure.** The paper's four speeds and the order of its coatings
leave open the unit of E by a factor of {unit:.2g}, the casing's largest distortion by {casing:.2g},
damping by {damping:.2g}, and the mean distortion between {low:.2g} and {high:.2g} of the second
harmonic (5 to 95 %). In {four:.0f} % of what they leave the casing is nearest at four places
instead of two. The number of rub marks away from resonance tells that; the depth of a slow rub
tells the largest distortion; a ring-down without contact tells damping; an indentation by the tip
tells the unit of E with its footprint over the thickness, which alone matters."""


def text(judged: Sequence[Row], found: Mapping[str, Any], long: Mapping[str, Any]) -> str:
    """The paragraphs, as Markdown.

    Parameters
    ----------
    judged : rows of the claims table
    found : the fits of the reference blade
    long : numbers of long times
    """
    others = list(dict.fromkeys(name for row in judged for name in row["other"]))
    groups: dict[str, list[str]] = {name: [] for name in GROUPS}
    for row in judged:
        if row["verdict"] != "not comparable":
            groups[_group(row)].append(_line(row))
    return "\n\n".join(
        [
            fill(INTRODUCTION.format(other=" and ".join(others) or "no other"), WIDTH),
            *("\n".join([fill(GROUPS[name], WIDTH), "", *of]) for name, of in groups.items() if of),
            fill(_long(long), WIDTH),
            fill(_experiment(found), WIDTH),
        ]
    )


def _group(row: Row) -> str:
    """Where a claim stands, as of ``GROUPS``."""
    share, elsewhere = _share(row), [other["verdict"] for other in row["other"].values()]
    there = [verdict in HOLDS for verdict in elsewhere if verdict != "not judged"]
    if row["verdict"] in HOLDS:
        alike = all(there) and (share is None or share >= NEARLY_ALL)
        return "everywhere" if alike else "here"
    return "elsewhere" if any(there) or (share or 0.0) > HARDLY_ANY else "nowhere"


def _share(row: Row) -> float | None:
    """Share of the draws of the posterior; None for a claim that is not judged there."""
    return next((share for name, share in row["shares"].items() if name != "prior"), None)


def _line(row: Row) -> str:
    """A claim with its verdict here, its share and its verdicts on other blades."""
    share = _share(row)
    told = [row["verdict"], *([f"{100 * share:.0f} % of the draws"] if share is not None else [])]
    told += [f"{name}: {there['verdict']}" for name, there in row["other"].items()]
    return f"- {row['id']}: {row['says']} ({'; '.join(told)})"


def _long(found: Mapping[str, Any]) -> str:
    first, last = found["amplitude"][0], found["amplitude"][-1]
    best, through = first.index(max(first)), found["through"]
    return LONG.format(
        rounds=found["rounds"][0],
        last=found["rounds"][-1],
        peak=found["speeds"][best],
        begin=first[best],
        end=last[best],
        up=through["run_up"]["largest"],
        up_at=through["run_up"]["at"],
        up_wear=through["run_up"]["deepest_wear"],
        rest=through["rest"]["largest"],
        rest_wear=through["rest"]["deepest_wear"],
    )


def _experiment(found: Mapping[str, Any]) -> str:
    taken = found["fits"][Fit(K_OF_E1[1], found["served"]).name][WITH_ORDER]
    ranges = taken["ranges"]
    factor = {name: ranges[name][2] / ranges[name][0] for name in FACTORS}
    return EXPERIMENT.format(
        unit=factor["unit_Pa"],
        casing=factor["casing_gaps"],
        damping=factor["damping_ratio"],
        low=ranges["constant_over_second"][0],
        high=ranges["constant_over_second"][2],
        four=100 * share_at_four_places(found, taken),
    )


FACTORS = ("unit_Pa", "casing_gaps", "damping_ratio")
