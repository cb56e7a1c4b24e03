"""Tables of the identification: fits, ranges of the parameters, shares of the claims."""

from collections.abc import Mapping
from itertools import product
from typing import Any

from workflow.identify.fits import TWO_NEAREST, of_fit
from workflow.identify.likelihood import FITS, K_OF_E1, SHIFTS, WITH_ORDER, Fit
from workflow.identify.priors import NAMES
from workflow.identify.shares import JUDGED
from workflow.markdown import LEAST, cell, percent, records, table
from workflow.paper.claims import CLAIMS

MET = "points within one sigma"
BOTH = "C12 and C16 hold in"
UNKNOWN = "-"  # without any point that has the data


def fits(numbers: Mapping[str, Any]) -> str:
    """One row for each fit: its best point, and how much the data support it."""
    head = [
        "K of E = 1, reading of k = 6",
        "least χ²",
        "deviations there, E = 1, E = 10",
        f"{MET}, with C12 and C16",
        "mean likelihood",
        "effective size",
        BOTH,
        "effective size with these",
        "and blades",
    ]
    listed = table(head, [_fit(each_fit, numbers["fits"][each_fit.name]) for each_fit in FITS])
    return f"{listed}\n\nThe points were drawn for the reading `{numbers['served']}`."


def _fit(data_fit: Fit, numbers: Mapping[str, Any]) -> list[str]:
    shifts, with_order = numbers[SHIFTS], numbers[WITH_ORDER]
    if not shifts["evidence"]:
        return [data_fit.name, "no point has all peaks", *[""] * 7]
    return [
        data_fit.name,
        f"{numbers['chi_squared']:.2g}",
        ", ".join(f"{value:+.1f}" for value in numbers["best"]["deviations"]),
        f"{shifts['met']}, {with_order['met']}",
        f"{shifts['evidence']:.2g}",
        f"{shifts['effective']:.0f}",
        percent(with_order["evidence"] / shifts["evidence"], LEAST),
        f"{with_order['effective']:.0f}",
        f"{with_order['blades']:.0f}",
    ]


def factors(numbers: Mapping[str, Any], posterior: Mapping[str, Any], name: str) -> list[float]:
    """Range of a positive parameter as a ratio, in a posterior and in the prior."""
    return [
        distribution["ranges"][name][2] / distribution["ranges"][name][0]
        for distribution in (posterior, numbers["prior"])
    ]


def ranges(numbers: Mapping[str, Any]) -> str:
    """Median of each parameter, with 5 and 95 %, in the fits to the reading that was served.

    With the share of casings that are nearest at four places, as the posterior has two modes, and
    the effective size: from ``fits.ENOUGH`` on ranges are more than rough.
    """
    columns = {"prior": numbers["prior"]} | {
        f"K = {K:g}, {data}": of_fit(numbers, K)[data]
        for data, K in product((SHIFTS, WITH_ORDER), K_OF_E1)
    }
    rows = [
        [f"`{name}`", *(_range(distribution, name) for distribution in columns.values())]
        for name in NAMES
    ]
    shares = [f"{100 * distribution['four_places']:.0f} %" for distribution in columns.values()]
    sizes = [cell(distribution.get("effective")) for distribution in columns.values()]
    below = f"`fourth_over_second` below {TWO_NEAREST}"
    return table(["", *columns], [*rows, [below, *shares], ["effective size", *sizes]])


def _range(distribution: Mapping[str, Any], name: str) -> str:
    """Median of a parameter, with 5 and 95 %, in a posterior or in the prior."""
    if distribution["ranges"] is None:
        return UNKNOWN
    low, median, high = (f"{value:.3g}" for value in distribution["ranges"][name])
    return f"{median} ({low} to {high})"


def shares(numbers: Mapping[str, Any]) -> str:
    """Verdict of each claim at the medoid, shares of the draws, and the draw at which most hold."""
    says = {claim.id: claim.says for claim in CLAIMS}
    rows = [
        {
            "": claim,
            "the paper says": says[claim],
            "at the medoid": numbers["medoid"][claim],
            f"holds in {numbers['draws']} draws": f"{100 * numbers['holds'][claim]:.0f} %",
            "not judged": f"{100 * numbers['not judged'][claim]:.0f} %",
        }
        for claim in JUDGED
    ]
    values = ", ".join(f"`{name}` {value:.3g}" for name, value in numbers["values"].items())
    missed = ", ".join(numbers["missed"]) or "none"
    best = f"At the draw at which most hold, all do but {missed}: {values}."
    return (
        f"{records(rows)}\n\n"
        f"Effective size of what is drawn from: {numbers['effective']:.0f}. {best}"
    )
