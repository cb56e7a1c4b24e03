"""Cases of the stability matrix on the coarse blade, and the counts of made ones.

Only cases whose kernels the two schemes need anyway; `./run snakemake stability` has them all.
Every third is in slow tests, all are in nightly ones; least counts are in proportion.
"""

import re
from contextlib import suppress
from dataclasses import replace
from itertools import count, islice

import numpy as np
import pytest

from geometry.base import UserError, in_rpm
from geometry.blade import EnrichedBasis
from geometry.hats import middles
from rom.reduce import reduce
from simulate.errors.neighbours import EIGHTH, HALF, QUARTER, TWICE
from workflow.study.stability.cases import EXACT, F1, FIRST_STRIP_DEG, SEED, Case, Dice, draw
from workflow.study.stability.matrix import counts, judge_case
from workflow.study.stability.sweeps import _whole, judged
from workflow.study.stability.told import extremes, sweeps

CASES, CHANGING = 100, 110  # of which at least ten are right, flagged and refused
JUDGED = [  # every so many of them
    pytest.param(3, marks=pytest.mark.slow, id="every third"),
    pytest.param(1, marks=pytest.mark.nightly, id="all"),
]
PATCHES = 8  # of the coarse blade
slow = pytest.mark.slow


def draw_changing(number: int, patches: int) -> Case:
    """Case ``number`` with a travelling harmonic, a changing clearance and, most, friction.

    Friction 1e-3 to 1 on a plastic liner; harmonics up to three times as fast as the blade, both
    ways; two to five changes of the distortion. Elastic laws become plastic that hardly yield.
    """
    case, dice = draw(number, patches), Dice(np.random.PCG64([SEED, number, 1]))
    scene = {**case.scene, "contact": {}, "liner": {**case.scene["liner"], "worn_through": "stop"}}
    law = scene["liner"]["law"]
    if law["kind"] == "elastic":
        law |= {"kind": "plastic", "K": min(1e6 * law["E"], 1e9), "sigma_Y": 0.0}
    elif law["kind"] == "plastic" and case.scheme == EXACT and dice.chance(0.67):
        scene["contact"] = {"friction": dice.decades(1e-3, 1)}
    (harmonic,) = scene["casing"]["harmonics"]
    speed = 2 * np.pi * F1 * scene["speeds"]["over_f1"][0]  # about Omega, rad/s
    wave = {
        "order": int(dice.uniform(1, 9)),
        "amplitude_um": harmonic["amplitude_um"] * dice.decades(0.01, 1),
        "speed_rpm": in_rpm(speed * dice.among({1.0: 0.1, dice.uniform(-3, 3): 0.9})),
    }
    scene["casing"] = {"harmonics": [harmonic, wave], "ramp_rounds": 0.0}
    parts = np.sort(dice.uniform(0.02, 1, round(dice.uniform(2, 5))))
    factors = 0.0, *dice.uniform(0, 1.2, len(parts))
    return replace(case, scene=scene, table=((0.0, *map(float, parts)), factors))


def draw_long(number: int, patches: int) -> Case:
    """Case ``number`` by piecewise-exact with steps in which the tip passes 1 to 4 footprints.

    At speeds at which such steps may resolve the first mode; with at most some 20 rods in a
    footprint, as many more in a step take hours with the steps of a reference.
    """
    case, dice = draw(number, patches), Dice(np.random.PCG64([SEED, number, 2]))
    rods = {"rods_per_round": min(case.scene["liner"]["rods_per_round"], 16381)}
    speed = {"over_f1": [dice.uniform(0.1, 0.4)]}
    scene = {**case.scene, "speeds": speed, "liner": {**case.scene["liner"], **rods}}
    return replace(case, scene=scene, scheme=EXACT, footprints=dice.decades(1, 4))


CHEAP = 14  # a case of few steps whose sweep has one peak


def rows_of(ends):
    """Rows of the study, as its table has them."""
    return [{"numbers": end} for end in ends]


def is_plain(number):
    case = draw(number, PATCHES)
    return (
        case.scene["liner"]["law"]["kind"] == "plastic"
        and case.scene["liner"]["worn_through"] == "stop"
        and not case.scene["contact"]
    )


@pytest.fixture(scope="module")
def rom(coarse_matrices):
    return reduce(coarse_matrices, EnrichedBasis(), "rt")[0]


@pytest.fixture(scope="module", params=JUDGED)
def every(request):
    """Distance of the cases that are judged."""
    return request.param


@pytest.fixture(scope="module")
def ends(rom, every):
    plain = islice(filter(is_plain, count()), 0, CASES, every)
    ends = [judge_case(draw(number, PATCHES), rom) for number in plain]
    print(f"\n{extremes(rows_of(ends))}")
    return ends


@pytest.fixture(scope="module")
def changing(rom, every):
    """Cases with travelling harmonics, clearances that change, and friction drawn in."""
    return [judge_case(draw_changing(i, PATCHES), rom) for i in range(0, CHANGING, every)]


@pytest.fixture(scope="module")
def long(rom, every):
    """Cases with steps in which the tip passes more than its footprint."""
    return [judge_case(draw_long(i, PATCHES), rom) for i in range(0, CHANGING, every)]


def verdicts(ends, kind):
    return [end for end in ends if end["checked"]["kind"] == kind]


@pytest.mark.parametrize("drawn", ["ends", "changing", "long"])
def test_no_case_is_silently_wrong(drawn, every, request):
    """Plain ones, those with friction or a changing casing, and long steps; all outcomes occur."""
    ends = request.getfixturevalue(drawn)
    wrong = verdicts(ends, "wrong")
    assert not wrong, [
        [end[key] for key in ("checked", "bound", "error", "spread")] for end in wrong
    ]
    assert len(verdicts(ends, "unjudged")) <= 3
    least = 10 // every
    assert min(len(verdicts(ends, kind)) for kind in ("right", "flagged", "refused")) >= least
    assert sum(end["contact"] for end in verdicts(ends, "right")) >= least or drawn != "ends"
    assert all("\n" not in end["message"].strip() for end in verdicts(ends, "refused"))


def test_few_runs_are_wrong_or_stopped(ends, changing):
    """Without second runs some are wrong; by default, all in contact checked, hardly any is.

    With all checks at most one right run in twenty is stopped, of plain runs more: 6 % of those of
    a thousand that are right to half of what is stated.
    """
    counted, plain = counts(rows_of(ends)), counts(rows_of([*ends, *changing]))["plain"]
    assert counted["plain"]["kinds"]["wrong"] <= 4, counted["plain"]["wrong_by"]
    assert counted["default"]["kinds"]["wrong"] <= 1, counted["default"]["wrong_by"]
    checked = counted["checked"]
    assert sum(checked["stopped"].values()) <= 0.05 * checked["accurate"], checked["stopped"]
    assert plain["well_stopped"] <= 0.15 * plain["well_accurate"], plain["stopped"]


def test_checks_by_default_are_of_runs_in_contact_and_cost_no_more_than_all_second_runs(ends):
    """Twice to an eighth of the step and a twin; of right ones most often twice alone."""
    found = [end for end in ends if end["cost"]]
    let_through = [
        end for end in ends if end["contact"] and end["plain"]["kind"] in ("right", "wrong")
    ]
    assert let_through and all(end["cost"] for end in let_through)
    by_quarter, most = TWICE + 1 + HALF.cost + QUARTER.cost, max(end["cost"] for end in found)
    assert by_quarter <= most + 1e-9 <= by_quarter + EIGHTH.cost + 1e-6
    right = [end["cost"] for end in found if end["default"]["kind"] == "right"]
    assert np.median(right) <= TWICE


@slow
def test_casings_are_turned_to_where_the_first_strip_starts(rom):
    """To the digits given."""
    for strips, degrees in FIRST_STRIP_DEG.items():
        assert np.degrees(rom.line(middles(strips))[0, 1]) == pytest.approx(degrees, abs=0.01)


def strips_of(law):
    """Numbers of strips that are drawn for a law in a thousand cases, on 16 patches."""
    liners = [draw(number, 16).scene["liner"] for number in range(1000)]
    return {liner["strips"] for liner in liners if liner["law"]["kind"] == law}


def test_no_fewer_strips_than_patches_are_drawn_but_for_one():
    assert strips_of("plastic") == {1, 16, 32} and strips_of("rigid") == {16}


def test_the_same_number_is_the_same_case():
    assert draw(7, PATCHES) == draw(7, PATCHES) and draw(7, PATCHES) != draw(8, PATCHES)


def made(plain, default, checked, accurate, error=0.0, contact=True, cost=0.0):
    """An end, with a kind and why as one text each."""
    verdicts = {"plain": plain, "default": default, "checked": checked}
    return {
        **{
            of: dict(zip(("kind", "why"), text.split(" ", 1), strict=True))
            for of, text in verdicts.items()
        },
        "steps": 100,
        "cost": cost,
        "contact": contact,
        "error": {"wear": error},
        "accurate": accurate,
    }


MADE = [
    made("right ok", "right ok", "right ok", True, cost=0.5),
    made("right no-contact", "right no-contact", "right no-contact", True, contact=False),
    made("right ok", "right ok", "flagged inaccurate", True, error=0.08),
    made("right ok", "right ok", "flagged sensitive", True),
    made("wrong ok", "flagged inaccurate", "flagged inaccurate", False, error=0.3, cost=8.5),
    made("wrong ok", "wrong ok", "flagged sensitive", False, error=0.12),
    made(
        "refused integrator.steps_per_round",
        "refused integrator.steps_per_round",
        "flagged inaccurate",
        False,
        error=0.5,
    ),
    made("flagged diverged", "flagged diverged", "flagged diverged", None),
    made("unjudged ok", "unjudged ok", "unjudged ok", None, error=0.4),
]


def test_counts_of_made_cases():
    found = counts(rows_of(MADE))
    assert found["cases"] == 9 and found["checks"] == 2 and found["cost"] == 1
    plain, default, checked = found["plain"], found["default"], found["checked"]
    assert plain["kinds"] == {"right": 4, "wrong": 2, "refused": 1, "flagged": 1, "unjudged": 1}
    assert default["kinds"] == {"right": 4, "wrong": 1, "refused": 1, "flagged": 2, "unjudged": 1}
    assert plain["right_in_contact"] == 3 and plain["accurate"] == 4 and not plain["stopped"]
    assert plain["wrong_by"] == [0.12, 0.3] and default["wrong_by"] == [0.12]
    assert checked["kinds"] == {"right": 2, "flagged": 6, "unjudged": 1}
    assert checked["stopped"] == {"inaccurate": 1} and checked["wrong_by"] == []


def test_the_paragraphs_have_the_counts():
    told = [re.findall(r"\d[\d.]*%?", part) for part in extremes(rows_of(MADE)).split("\n\n")]
    plain = ["0", "4", "3", "1", "1", "1", "0", "2", "12%", "30%", "1", "4", "0", "0.0%", "3", "0"]
    default = ["4", "3", "2", "1", "1", "1", "0", "1", "12%", "1", "4", "0", "0.0%", "3", "0"]
    checked = ["2", "1", "6", "1", "3", "2", "0", "0", "0", "1", "4", "1", "25.0%", "3", "0"]
    assert told[0] == ["9", "2", "100%"]
    assert told[1:] == [[*of, "0.0%"] for of in (plain, default, checked)]


def test_the_sentence_of_sweeps_has_their_peaks():
    peaks = [{"silent": False}, {"silent": True}]
    study = [{"peaks": peaks, "share": 0.08}, {"peaks": [], "share": 0.1}]
    study += [{"peaks": peaks[:1], "share": 7.5}, None]  # the last cannot be swept
    rows = [{"numbers": numbers} for numbers in study]
    assert re.findall(r"\d+%?", sweeps(rows)) == ["3", "12", "3", "1", "10", "10%"]


def test_some_cases_can_be_swept_and_their_peaks_have_references(rom):
    """Bounds of the matrix, less than a revolution, let none be swept. A cheap one is judged."""
    swept = []
    for number in range(1, 40):
        with suppress(UserError):
            swept.append((number, _whole(draw(number - 1, PATCHES), rom)))
    assert len(swept) > 5 and CHEAP in dict(swept)
    found = judged(CHEAP, rom)
    assert len(found["peaks"]) == 1 and 0 < found["share"] < 10
