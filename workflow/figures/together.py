"""Which claims of the paper hold together, and which exclude each other."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from workflow.figures import cells
from workflow.identify.fits import POSTERIORS, PRIOR

K = "4.55"  # of E = 1
TITLES = {PRIOR: "prior", **dict.fromkeys(POSTERIORS, "posterior")}
SHARE = "share (%) of the draws with the claim of the row in which that of the column holds, too"


def draw(shares: Mapping[str, Any]) -> Figure:
    """A panel for the prior and one for the posterior: claims that hold, with one and another.

    A posterior of too few effective points has no draws, and no panel. On the diagonal is the
    share of all draws, in bold.
    """
    records = [cell for name in TITLES if name in shares for cell in _cells(name, shares[name][K])]
    look = {"text": "text", "bold": "alone", "panel": "of", "limits": (0, 100)}
    return cells.draw(records, "other", "one", "share", labels=TITLES | {"share": SHARE}, **look)


def _cells(name: str, of: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    """Shares in percent."""
    for one, held in of["holds"].items():
        for other in of["holds"]:
            share = 100 * np.array(held if one == other else of["together"][one][other], float)
            text = f"{share:.0f}" if np.isfinite(share) else ""
            cell = {"one": one, "other": other, "alone": one == other}
            yield {"of": name, "share": share, "text": text} | cell
