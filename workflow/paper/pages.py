"""Functions of the paper's rules: verdicts on its claims, and the pages that show them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.project import read_json
from workflow.identify.fits import POSTERIORS, TAKEN
from workflow.identify.shares import distributions
from workflow.paper import conclusions, page, report
from workflow.paper.claims import CLAIMS
from workflow.paper.cost import cost
from workflow.paper.editions import editions

K_OF_E1 = f"{POSTERIORS[TAKEN][0]:g}"  # of the draws whose shares are shown

table, html = report.markdown, page.html  # texts of the claims


def claims(files: Any, further: Mapping[str, Mapping[str, str]]) -> list[dict[str, Any]]:
    """Verdicts on the claims, with the repeats, other blades and causes that have been run.

    ``further``: files of these runs by group, as ``editions`` takes them.
    """
    groups = {
        group: editions(**further[group]) if group in further else {}
        for group in ("repeats", "other", "causes")
    }
    shares = distributions(read_json(**further["shares"]), K_OF_E1) if "shares" in further else {}
    holds = {name: found["holds"] for name, found in shares.items()}
    return report.verdicts(CLAIMS, read_json(files.numbers), **groups, shares=holds)


def conclusions_text(files: Any) -> str:
    """What a reader may conclude."""
    return conclusions.text(*(read_json(files[name]) for name in ("claims", "fits", "long")))


def cost_text(files: Any, targets: Mapping[str, list[str]]) -> str:
    """Cost of the targets, from the benchmark files in their folders."""
    return cost(
        {
            target: sorted(file for of in folders for file in Path(of).glob("benchmarks/*.tsv"))
            for target, folders in targets.items()
        }
    )
