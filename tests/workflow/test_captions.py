"""Thresholds in the captions are those of the code."""

from math import log10

import pytest
from projects import ROOT

from simulate.errors.neighbours import GAP_CHANGE
from simulate.errors.signals import LOBE_PROMINENCE
from simulate.marching import SENSITIVE_FROM
from simulate.sweeps import peak as peaks
from workflow.figures import table

ROWS = table.read(ROOT / "workflow/figures/figures.yaml")
TWIN = (f"one part in 10^{-log10(GAP_CHANGE):g}", f"over {100 * SENSITIVE_FROM:g} %")
CAPTIONS = {
    "spectra-{scene}": (
        f"reaches {peaks.LEAST:g} of the gap",
        f"by {peaks.PROMINENCE:g} of its height",
        f"k - {-peaks.SIDEBANDS[0]} or k + {peaks.SIDEBANDS[1]}",
        f"Engine orders {peaks.ORDERS[0]} to {peaks.ORDERS[-1]} are searched",
        f"from {peaks.STIFFENED:g} (with tangential force {peaks.SOFTENED:g}) to "
        f"{peaks.HIGHEST:g} times the crossing",
        f"at {peaks.LEAST_AT_END:g} gap or more",
        *TWIN,
    ),
    "wear-{scene}": (f"stand out by {LOBE_PROMINENCE:g} of its depth", *TWIN),
    "fig12": TWIN,
    "stress-{scene}": TWIN,
}


@pytest.mark.parametrize(("name", "said"), CAPTIONS.items())
def test_captions_have_the_thresholds_of_the_code(name, said):
    caption = " ".join(ROWS[name].caption.split())
    assert [words for words in said if words not in caption] == []
