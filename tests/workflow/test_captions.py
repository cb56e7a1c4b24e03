"""Thresholds in the captions are those of the code."""

from math import log10

import pytest
from projects import ROOT, TABLES

from simulate.errors.neighbours import GAP_CHANGE
from simulate.marching import SENSITIVE_FROM
from simulate.scene.casing import COUNTS
from simulate.signals import LOBE_PROMINENCE
from simulate.sweeps import peak as peaks
from workflow.figures import table

ROWS = table.read(*TABLES)
TWIN = (f"one part in 10^{-log10(GAP_CHANGE):g}", f"over {100 * SENSITIVE_FROM:g} %")
CAPTIONS = {
    "spectra-{scene}": (
        f"reaches {peaks.LEAST:g} of the gap",
        f"by {peaks.PROMINENCE:g} of its height",
        f"at {peaks.LEAST_AT_END:g} gap or more",
        *TWIN,
    ),
    "wear-{scene}": (f"stand out by {LOBE_PROMINENCE:g} of its depth", *TWIN),
    "fig12": TWIN,
    "stress-{scene}": TWIN,
}


PAGE = (  # of simulate/README.md
    f"{100 * COUNTS:g} % of its largest",
    f"from {peaks.STIFFENED:g} (with a tangential force {peaks.SOFTENED:g}) to {peaks.HIGHEST:g}",
    f"both cross within {100 * peaks.NEAR:g} %",
)


def test_the_page_has_the_thresholds_of_the_code():
    page = " ".join((ROOT / "simulate/README.md").read_text().split())
    assert [words for words in PAGE if words not in page] == []


@pytest.mark.parametrize(("name", "said"), CAPTIONS.items())
def test_captions_have_the_thresholds_of_the_code(name, said):
    caption = " ".join(ROWS[name].caption.split())
    assert [words for words in said if words not in caption] == []
