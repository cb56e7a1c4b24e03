"""Functions of the paper's rules: verdicts on its claims, and the pages that show them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from geometry.project import read_json
from workflow.identify.priors import Priors
from workflow.identify.shares import distributions
from workflow.paper import conclusions, page, report
from workflow.paper.cases import COATINGS
from workflow.paper.claims import CLAIMS
from workflow.paper.cost import cost

K_OF_E1 = f"{COATINGS['e1'][1]:g}"  # of the draws whose shares are shown

table, html = report.markdown, page.html  # texts of the claims


def claims(files: Any, further: Mapping[str, Mapping[str, str]]) -> list[dict[str, Any]]:
    """Verdicts on the claims, with the repeats, other blades and causes that have been run.

    ``further``: files of these runs, by group and name.
    """
    of = {
        group: {name: read_json(file) for name, file in of.items()} for group, of in further.items()
    }
    drawn = [distributions(found, K_OF_E1) for found in of.pop("shares").values()]
    shares = {name: found["holds"] for each in drawn for name, found in each.items()}
    return report.verdicts(CLAIMS, read_json(files.numbers), **of, shares=shares)


def conclusions_text(files: Any) -> str:
    """What a reader may conclude."""
    read = (read_json(files[name]) for name in ("claims", "fits", "long"))
    return conclusions.text(*read, Priors.load(files.priors))


def cost_text(files: Any, targets: Mapping[str, list[str]]) -> str:
    """Cost of the targets, from the benchmark files in their folders."""
    return cost(
        {
            target: sorted(file for of in folders for file in Path(of).glob("benchmarks/*.tsv"))
            for target, folders in targets.items()
        }
    )
