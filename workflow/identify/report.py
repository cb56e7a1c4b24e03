"""Tables of the identification: fits, ranges of the parameters, shares of the claims."""

from collections.abc import Mapping, Sequence
from textwrap import fill
from typing import Any

from workflow.identify.likelihood import FITS, K_OF_E1, SHIFTS, WITH_ORDER, Fit
from workflow.identify.priors import NAMES
from workflow.identify.shares import JUDGED, distributions
from workflow.markdown import table
from workflow.paper.claims import CLAIMS

BOTH = "C12 and C16 hold in"


def fits(found: Mapping[str, Any]) -> str:
    """One row for each fit: its best point, and how much the data support it."""
    head = [
        "K of E = 1, reading of k = 6",
        "least χ²",
        "deviations there, E = 1, E = 10",
        "mean likelihood",
        "effective size",
        BOTH,
        "effective size with these",
    ]
    listed = table(head, [_fit(of, found["fits"][of.name]) for of in FITS])
    return f"{listed}\n\nThe points were drawn for the reading `{found['served']}`."


def _fit(of: Fit, found: Mapping[str, Any]) -> list[str]:
    shifts, with_order = found[SHIFTS], found[WITH_ORDER]
    if not shifts["evidence"]:
        return [of.name, "no point has all peaks", *[""] * 5]
    return [
        of.name,
        f"{found['chi_squared']:.2g}",
        ", ".join(f"{value:+.1f}" for value in found["best"]["deviations"]),
        f"{shifts['evidence']:.2g}",
        f"{shifts['effective']:.0f}",
        _both(found),
        f"{with_order['effective']:.0f}",
    ]


ANSWER = """\
Some casing, unit of E and damping meet the four speeds, the farthest to {taken} half digits of the
paper with K = 4.55 for both coatings, to {loose} with K = 0.45 for E = 1, if the paper's k = 6
crossing is read as printed (as its k = 4 implies: χ² of four data {consistent:.0f}). What fits them
has the higher peak and the deeper wear with E = 10 in {both} of it with K = 4.55, in {both_loose}
with K = 0.45; as data besides, this prefers K = 4.55 by {preferred:.1f} to 1. All these data leave
the largest distortion of the casing open by a factor of {casing:.2g}, the unit of E by one of
{unit:.2g} (5 to 95 %)."""
WIDTH = 120  # of the lines of a page


def answer(found: Mapping[str, Any]) -> str:
    """Three sentences: how near the paper's speeds come, which K they prefer, what they tell."""
    loose, taken = (found["fits"][Fit(K, found["served"]).name] for K in K_OF_E1)
    consistent = [found["fits"][Fit(K, "consistent").name]["chi_squared"] for K in K_OF_E1]
    text = ANSWER.format(
        taken=_farthest(taken),
        loose=_farthest(loose),
        consistent=min(consistent),
        both=_both(taken),
        both_loose=_both(loose),
        preferred=taken[WITH_ORDER]["evidence"] / loose[WITH_ORDER]["evidence"],
        casing=_factor(taken[WITH_ORDER], "casing_gaps"),
        unit=_factor(taken[WITH_ORDER], "unit_Pa"),
    )
    return fill(text, WIDTH)


def _farthest(found: Mapping[str, Any]) -> str:
    return f"{max(map(abs, found['best']['deviations'])):.1f}"


def _both(found: Mapping[str, Any]) -> str:
    """Share of a posterior in which C12 and C16 hold."""
    return f"{100 * found[WITH_ORDER]['evidence'] / found[SHIFTS]['evidence']:.2g} %"


def _factor(posterior: Mapping[str, Any], name: str) -> float:
    """Range of a positive parameter as a ratio."""
    low, _, high = posterior["ranges"][name]
    return high / low


def ranges(found: Mapping[str, Any]) -> str:
    """Median of each parameter, with 5 and 95 %, in the fits to the reading that was served."""
    columns = [(K, data) for data in (SHIFTS, WITH_ORDER) for K in K_OF_E1]
    of = [found["fits"][Fit(K, found["served"]).name][data]["ranges"] for K, data in columns]
    head = ["", *(f"K = {K:g}, {data}" for K, data in columns)]
    rows = [[f"`{name}`", *(_range(each and each[name]) for each in of)] for name in NAMES]
    return table(head, rows)


def _range(quantiles: Sequence[float] | None) -> str:
    if quantiles is None:
        return "too few"
    low, median, high = (f"{value:.2g}" for value in quantiles)
    return f"{median} ({low} to {high})"


def blades(of: Mapping[str, Any]) -> str:
    """One row for each blade and K: how near the fit comes, and its parameters."""
    head = ["blade, K of E = 1, reading", "least χ²", "effective size", BOTH]
    head += [f"`{name}`" for name in NAMES]
    rows = [
        [f"{blade}, {K}, {found['served']}", *_of_blade(fit)]
        for blade, found in of.items()
        for K, fit in found["fits"].items()
    ]
    return table(head, rows)


def _of_blade(fit: Mapping[str, Any]) -> list[str]:
    both = fit["evidence"] and f"{100 * fit['evidence_with_order'] / fit['evidence']:.2g} %"
    ranges = [_range(fit["ranges"] and fit["ranges"][name]) for name in NAMES]
    return [f"{fit['chi_squared']:.2g}", f"{fit['effective']:.0f}", both or "", *ranges]


def shares(of: Mapping[str, Any]) -> str:
    """Share of the draws of the prior and of the posterior at which each claim holds."""
    says = {claim.id: claim.says for claim in CLAIMS}
    columns = {
        f"{name}, K = {K:g} ({drawn['draws']} draws)": drawn
        for K in K_OF_E1
        for name, drawn in distributions(of, f"{K:g}").items()
    }
    rows = [
        [claim, says[claim], *(_share(drawn, claim) for drawn in columns.values())]
        for claim in JUDGED
    ]
    return table(["", "the paper says", *columns], rows)


def _share(of: Mapping[str, Any], claim: str) -> str:
    unknown = of["not judged"][claim]
    held = f"{100 * of['holds'][claim]:.0f} %"
    return held + f" ({100 * unknown:.0f} % not judged)" * (unknown > 0)
