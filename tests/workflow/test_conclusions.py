"""What a reader may conclude: every claim in one group, by what holds where."""

import re

import numpy as np
import pandas as pd
import pytest
from made_sweeps import ROOT

from geometry.base import read_json
from geometry.blade import Blade
from workflow.paper import conclusions
from workflow.paper.claims import CLAIMS
from workflow.paper.conclusions import DATA, FIT

DRAWN = "narrow prior"
RANGES = {
    "unit_Pa": (1e9, 2e9, 8e9),
    "casing_gaps": (1.0, 1.5, 2.0),
    "damping_ratio": (0.001, 0.002, 0.02),
    "constant_over_second": (0.1, 0.5, 0.9),
}
IDENTIFIED = {
    name: read_json(ROOT / f"workflow/paper/identified/{name}.json") for name in ("narrow", "wide")
}
FOUND = IDENTIFIED["narrow"] | {
    "fits": {FIT: {DATA: {"effective": 75.0, "ranges": RANGES, "four_places": 0.75}}}
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


@pytest.mark.parametrize("name", IDENTIFIED)
def test_what_the_identification_found_is_whole(name):
    """Of claims that are there; ranges in order, in those of the prior; whole numbers of draws."""
    found = IDENTIFIED[name]
    assert found["commit"] and found["command"]
    shares, ids = found["shares"], {claim.id for claim in CLAIMS}
    assert {*shares["holds"]} == {*shares["medoid"]} <= ids
    for share in shares["holds"].values():
        assert 0 <= share <= 1 and round(share * shares["draws"], 9).is_integer()
    prior = found["prior"]["ranges"]
    for data in ("shifts", DATA):
        taken = found["fits"][FIT][data]["ranges"]
        assert {*taken} == {*prior} == {*shares["best"]["values"]}
        for parameter, (low, median, high) in taken.items():
            outer = np.diff(prior[parameter][::2])  # 5 to 95 % of a range
            assert low <= median <= high and high - low < 1.2 * outer, parameter


def test_the_draws_are_those_of_the_posterior_of_which_the_scenes_take_a_blade():
    """Quantiles have their ranks within three standard errors of as many independent draws."""
    file = ROOT / "workflow/paper/identified/narrow-draws.csv"
    drawn = pd.read_csv(file, comment="#")
    found = IDENTIFIED["narrow"]
    assert len(drawn) == found["shares"]["draws"]
    for name, quantiles in found["fits"][FIT][DATA]["ranges"].items():
        for level, value in zip(found["levels"], quantiles, strict=True):
            off = abs(value) * 1e-5  # six digits; many draws are of one blade
            below, upto = (np.mean(drawn[name] < value + side * off) for side in (-1, 1))
            error = 3 * np.sqrt(level * (1 - level) / len(drawn))
            assert below - error <= level <= upto + error, name
    taken = Blade.load(ROOT / "workflow/blades/paper.yaml").sections
    names = ["span_mm", "tip_lean_tangential_mm", "tip_lean_axial_mm", "hub_radius_mm"]
    off = drawn[names] / [getattr(taken, name) for name in names] - 1
    assert abs(off).max(axis=1).min() < 5e-3  # three digits
