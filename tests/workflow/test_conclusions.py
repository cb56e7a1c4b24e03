"""What a reader may conclude: every claim in one group, by what holds where."""

import re

import pytest
from made_sweeps import ROOT

from workflow.identify.fits import prior_numbers
from workflow.identify.likelihood import K_OF_E1, WITH_ORDER, Fit
from workflow.identify.priors import Priors
from workflow.paper import conclusions

DRAWN = "narrow prior"
RANGES = {
    "unit_Pa": (1e9, 2e9, 8e9),
    "casing_gaps": (1.0, 1.5, 2.0),
    "damping_ratio": (0.001, 0.002, 0.02),
    "constant_over_second": (0.1, 0.5, 0.9),
}
FOUND = {
    "served": "printed",
    "prior": prior_numbers(Priors.load(ROOT / "workflow/identify/narrow.yaml")),
    "fits": {
        Fit(K_OF_E1[1], "printed").name: {
            WITH_ORDER: {"medoid": 0, "effective": 75.0, "ranges": RANGES, "four_places": 0.75}
        }
    },
}
LONG = {
    "rounds": [20, 200, 2000],
    "speeds": [0.35, 0.36],
    "amplitude": [[0.5, 2.0], [0.4, 2.1], [0.3, 2.25]],
    "status": [["ok", "ok"]] * 3,
    "through": {
        "rest": {"largest": 2.0, "at": 0.36, "deepest_wear": 0.5},
        "run_up": {"largest": 5.0, "at": 0.4, "at_highest": 5.0, "deepest_wear": 2.5},
    },
}


def judged(verdict, there=None, share=None):
    return {
        "id": "C99",
        "says": "it holds",
        "verdict": verdict,
        "other": {"rotor37": {"verdict": there}} if there else {},
        "shares": {DRAWN: share, "wide prior": 1.0} if share is not None else {},
    }


@pytest.mark.parametrize(
    ("row", "group"),
    [
        (judged("reproduced", "reproduced in kind", 0.9), ["everywhere"]),
        (judged("reproduced"), ["everywhere"]),
        (judged("reproduced", "reproduced", 0.89), ["here"]),
        (judged("calibrated", "reproduced", 1.0), ["data"]),
        (judged("reproduced in kind", "differs", 1.0), ["here"]),
        (judged("reproduced", "not judged"), ["everywhere"]),
        (judged("differs", "not judged", 0.05), ["nowhere"]),
        (judged("differs", "reproduced", 0.0), ["elsewhere"]),
        (judged("differs", "differs", 0.11), ["elsewhere"]),
        (judged("differs", "differs", 0.1), ["nowhere"]),
        (judged("undecided", "reproduced"), ["open"]),
        (judged("not judged"), ["open"]),
        (judged("not comparable"), []),  # a picture without numbers
    ],
)
def test_a_claim_stands_where_it_holds(row, group):
    text = conclusions.text([row], FOUND, LONG)
    titles = {name: title.split("**")[1] for name, title in conclusions.GROUPS.items()}
    assert [name for name, title in titles.items() if title in text] == group
    assert ("C99" in text) == bool(group)


def test_paragraphs_have_the_numbers_of_the_results():
    row = judged("differs", "reproduced", 0.25)
    text = re.sub(r"\s+", " ", conclusions.text([row], FOUND, LONG))
    assert "(differs; 25 % of the draws; rotor37: reproduced)" in text
    for told in (
        "by a factor of 8 (assumed: 170)",
        "effective size 75: a share of 90 % has a standard error of 5 %",  # by both
        "At 0.360",
        "is 2.00 gaps",
        "after 2000: 2.25.",
    ):
        assert told in text
    assert re.search(r"5\.0 gaps and 2\.5 gaps .* 0\.400, where it ends.* 2\.0 and 0\.5", text)
    # a run-up that has passed its peak is not said to grow
    run_up = LONG["through"]["run_up"] | {"at_highest": 4.0}
    long = LONG | {"through": LONG["through"] | {"run_up": run_up}}
    assert "where it ends" not in conclusions.text([row], FOUND, long)
    # nor has a run an amplitude that ended before
    ended = {"amplitude": [*LONG["amplitude"][:2], [0.3, None]]}
    ended["status"] = [*LONG["status"][:2], ["ok", "liner-exhausted"]]
    assert "after 2000: liner-exhausted." in conclusions.text([row], FOUND, LONG | ended)
