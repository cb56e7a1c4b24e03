"""The summary in units of engines: its numbers, what is not known, and its CSV file."""

import csv
from io import StringIO
from types import SimpleNamespace

import pytest
from made_sweeps import made_rom
from runs import swept
from scenes import scene

from geometry.base import write_json
from geometry.tip import EDGES
from simulate.errors import schema
from simulate.errors.model_errors import BEYOND, ModelError
from simulate.errors.neighbour import ONE_MOTION, TWO_MOTIONS
from simulate.errors.schema import CONTACT, Quantity
from simulate.scene import DYING_OUT, GROWING, TRENDS
from simulate.sweeps.crossings import critical
from simulate.sweeps.peak import Peak
from simulate.sweeps.peak_results import results
from simulate.sweeps.result_types import NO_CROSSING
from workflow import stress_told, summary

NUMBERS = {
    "amplitude": 4e-5,
    "displacement": 7e-5,
    "wear": 1e-5,
    "worn_volume": 2e-7,
    "opening": 1.5e-6,
}
NUMBERS |= {"force": 170.0, "force_peak": 580.0, "torque": 0.05}
ANSWER = {
    "k": 4,
    "modes": [1],
    "index": 100,
    "Omega_c": 0.35,
    "spacing": 4e-4,
    "crossing": 0.31,
    "amplitude": 2.0,
    "at_end": False,
    "status": "ok",
    "verdict": ONE_MOTION,
    "numbers": NUMBERS,
    "errors": {name: 0.05 * value for name, value in NUMBERS.items()},
    "other": {},
    "lobes": 4,
    "course": {"trend": "steady", "time_constant": 18.2, "largest_round": 17.0, "wears": 3e-12},
    "parts": {"twin": {"amplitude": 0.03}, "finer": {"amplitude": 0.04}},
    "runs": 7,
    "seconds": 1.5,
}
OF = {
    "scene": "mine",
    "blade": "b",
    "f1_Hz": 200.0,
    "gap_m": 2e-5,
    "status": {"ok": 40, "diverged": 1},
    "sweep_s": 30.0,
    "checks": "checked at 4 of 41 speeds; largest error 0.021",
    "dofs": 76,
    "swept": [0.2, 0.4],
    "seen": [2, 4],
    "free": 0,
    "half_bin": 0.05,
    "reasons": [],
    "ends": [
        {"over_f1": 0.2, "status": "ok", "lobes": 2, "gaps_m": []},
        {"over_f1": 0.4, "status": "sensitive", "lobes": None, "gaps_m": [5e-5, 6e-5]},
    ],
    "model_error": {"basis": 1e-4, "mesh": 9e-4},
    "no_torque": None,
    "mu_crit": None,
    "whirls": [],
    "blades": 1,
    "assumed": [],
    "worst": [],
    "peaks": [ANSWER],
}
OPERATING = {"lines": {}, "modes": 1, "orders": [4, 5], "excited": {4: "side band"}}
WORST = {"mean_stress": 3e8, "alternating": 2e7, "margin": 17.0, "at": [400.0, 10.0, -20.0]}
WORST |= {"unit": "mm", "revolution": 18, "cycles": 80, "endurance_s": 4e4, "trend": "steady"}
MESH = {"mean_stress": 0.02, "alternating": 0.03, "margin": 0.05}
TOLD = {"rises": "the clamp", "stands_out": 0.9, "between": 2.5e7, "mesh": MESH, "sigma": []}
STRESS = {
    "scene": "mine",
    "root": "sharp",
    "away_m": 6.1e-3,
    "too_near": None,
    "worst": 0.3,
    "speeds": [
        WORST | {"speed_over_f1": 0.25, "rpm": 3000.0},
        WORST | {"speed_over_f1": 0.3, "rpm": 3600.0, "alternating": 2.5e7, "margin": 12.5} | TOLD,
        WORST | {"speed_over_f1": 0.35, "rpm": 4200.0} | TOLD,
        WORST | {"speed_over_f1": 0.38, "rpm": 4560.0, "trend": GROWING},
        {"speed_over_f1": 0.4, "rpm": 4800.0, "trend": GROWING},
    ],
}


def read_csv(found):
    """The one row of the CSV file."""
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    return row


def cells(found):
    """Cells of the one row of each table as they are shown."""
    return [cell for _, rows in summary.shown(found["scenes"][0]) for row in rows for cell in row]


@pytest.fixture
def summed(tmp_path):
    """The summary of changed answers, and of stresses if these are given."""

    def summed(answer=None, stress=None, **of):
        given = {"answers": OF | {"peaks": [ANSWER | (answer or {})]} | of, "stress": stress}
        files = {name: [tmp_path / f"{name}.json"] for name, values in given.items() if values}
        for name, (file,) in files.items():
            write_json(given[name], file)
        made_rom().save(tmp_path / "rom.nc")
        roms = [tmp_path / "rom.nc"]
        return summary.numbers(SimpleNamespace(**files, roms=roms), {"b": OPERATING})

    return summed


def test_what_a_scene_leaves_out_is_told(summed):
    said = "The orbit of the rotor is prescribed: contact does not act on it"
    assert f"\n{said}.\n" in summary.terminal(summed(assumed=[said]))


def test_a_peak_in_units_of_engines(summed):
    """0.35 of 200 Hz is 4200 rpm and, at order 4, 280 Hz; micrometres, cubic millimetres, MPa."""
    found = summed(stress=STRESS)
    row = read_csv(found)
    expected = {
        "speed (rpm)": 4200,
        "speed +- (rpm)": 12000 * (4e-4 + 3.5e-4),  # spacing, and a thousandth of 0.35
        "speed over f1(0)": 0.35,
        "speed over crossing": 1.12903,
        "lobes": 4,
        "frequency (Hz)": 280,
        "amplitude (um)": 40,
        "amplitude +- (um)": 2,
        "worn_volume (mm3)": 200,
        "torque (N m)": 0.05,
        "mean_stress (MPa)": 300,
        "alternating (MPa)": 20,
        "margin (1)": 17,
    }
    assert {name: float(row[name]) for name in expected} == pytest.approx(expected)
    assert (row["amplitude other (um)"], row["word"]) == ("", ONE_MOTION)
    assert {"4200 ±9", "0.350", "40 ±5%", "300 (no ±)", "20 (no ±) ↑", "17 (no ±)"} <= {
        *cells(found)
    }
    # no exponent
    assert cells(summed({"spacing": 0.027 - 3.5e-4}))[2] == "4200 ±324"
    ending = summed({"at_end": True})  # on the rise: a bound
    assert cells(ending)[2] == "4200 (end: rises further)"
    assert read_csv(ending)["speed +- (rpm)"] == ""


def test_scenes_with_results_that_are_left_out_are_named(summed):
    """One state of the code only: theirs may be of another."""
    found = summed()
    assert "Not in this summary" not in summary.terminal(found) + summary.table(found)
    left = found | {"others": ["rub", "peak-e1"]}
    for text in (summary.terminal(left), summary.table(left)):
        assert "Not in this summary, but with results: rub, peak-e1. " in text


def test_what_is_not_known_is_said(summed):
    model_error = {"basis": 1e-4, "mesh": None}
    numbers = {name: NUMBERS[name] for name in ("amplitude", "force")}
    found = summed(
        {"numbers": numbers, "errors": {}}, model_error=model_error, no_torque="a reason"
    )
    text = summary.terminal(found)
    assert all(what in text for what in ("mesh", "stress at 4200 rpm, ", "torque (a reason)"))
    assert cells(found)[3] == "40 (no ±)" and "170 (no ±)" in cells(found)
    row = read_csv(found)
    assert row["torque (N m)"] == row["amplitude +- (um)"] == ""
    # central differences have no runs of other fineness; where nothing was tried, nothing is missed
    for parts, known in (({"twin": {"amplitude": 0.05}}, False), ({}, True)):
        (row,) = summed({"parts": parts})["scenes"][0]["rows"]
        assert ("fineness" not in row["unknown"][summary.ALL]) is known
    for amplitude, known in ((0.05, True), (None, False)):
        parts = {"twin": {}, "speeds": {"amplitude": amplitude}}
        found = summed({"parts": parts})
        assert ("between the speeds" in summary.terminal(found)) is not known


def test_scene_says_its_model_its_crossings_and_what_its_ends_show(summed):
    """Speeds in rpm and over f1(0); a model from elsewhere has an error that is not known."""
    (scene,) = summed(reasons=["too wide a gap"])["scenes"]
    assert "76 DoFs (frequencies within 0.01 % of the full one)" in summary.about(scene)
    assert summary.about(scene).endswith("runs: 40 ok, 1 diverged; no contact: too wide a gap")
    assert "the worst" not in summary.about(scene)
    (of_stage,) = summed(blades=36)["scenes"]
    assert summary.about(of_stage).startswith("36 blades: motion, stress and force of the worst, ")
    assert summary.notes(scene)[:2] == [
        "Linear crossings of mode 1, rpm: EO 5 1362, EO 4 1861.",  # of the made model, 100 Hz
        "Ends of the sweep: 2400 rpm (0.200): 2 lobes; 4800 rpm (0.400): gap 50.0 and 60.0 µm at "
        "ξ = 1/16 and 15/16, sensitive.",
    ]
    (foreign,) = summed(model_error={"basis": None, "mesh": None}, ends=[])["scenes"]
    assert "76 DoFs; runs" in summary.about(foreign)
    assert not any("rpm (" in note for note in summary.notes(foreign))


STAGE = {  # the third blade is long, rubs alone, and is not the one that moves most
    "worst": 1,
    "rub": [0, 1, 2, 4],
    "longer": [0.0, 0.0, 8e-6, 0.0, 0.0],
    "frequencies": [0.0] * 5,
    "numbers": {
        "amplitude": [3e-5, 4e-5, 1e-5, 3e-5, 5e-5],
        "displacement": [6e-5, 1e-4, 2e-5, 6e-5, 8e-5],
        "force": [10.0, 50.0, 0.5, 20.0, 30.0],
    },
}


@pytest.mark.parametrize(
    ("stage", "says"),
    [
        (
            {},
            "4 of 5 blades rub (0 to 2, 4); the worst is blade 1: length +0 µm; its largest "
            "displacement is 1.67 times the median; blade 2 moves least, by 0.2 of it: "
            "length +8 µm (the longest)",
        ),
        (
            {"longer": [0.0] * 5, "rub": [0, 1, 2, 3, 4]},
            "all 5 blades rub; the worst is blade 1: equal to the others; its largest "
            "displacement is 1.67 times the median; blade 2 moves least, by 0.2 of it: "
            "equal to the others",
        ),
        (
            {"longer": [0.0] * 5, "frequencies": [0, -0.02, 0, 0, 0], "rub": []},
            "0 of 5 blades rub (none); the worst is blade 1: frequencies -2 % (the lowest); its "
            "largest displacement is 1.67 times the median; blade 2 moves least, by 0.2 of it: "
            "frequencies +0 %",
        ),
        (
            {"longer": [3e-6, 4e-6, 0.0, 1e-6, 2e-6]},
            "4 of 5 blades rub (0 to 2, 4); the worst is blade 1: length +4 µm (the longest); its "
            "largest displacement is 1.67 times the median; blade 2 moves least, by 0.2 of it: "
            "length +0 µm (the shortest); rank correlation +0.8 with length",
        ),
    ],
    ids=["one long", "all equal", "one soft", "scatter"],
)
def test_the_worst_blade_is_named_in_text_table_and_csv(summed, stage, says):
    found = summed({"blades": STAGE | stage}, blades=5)
    assert f"EO 4 at 4200 rpm: {says}." in summary.terminal(found)
    assert f"EO 4 at 4200 rpm: {says}." in summary.table(found)
    heads, rows = summary.shown(found["scenes"][0])[2]
    assert heads[3:] == ["number (blade)", "worst blade", "most", "median", "least"]
    assert rows[0][3:] == ["amplitude µm", "40 (1)", "50 (4)", "30", "10 (2)"]
    assert rows[2][:3] == [""] * 3 and rows[2][4:] == ["50 (1)", "50 (1)", "20", "0.5 (2)"]
    row = read_csv(found)
    assert (row["blades"], row["worst blade"]) == ("5", "1")
    assert row["blades that rub"].split() == [str(j) for j in (STAGE | stage)["rub"]]
    spread = [float(row[f"amplitude {of} of blades (um)"]) for of in ("most", "median", "least")]
    assert spread == [50, 30, 10] and (row["amplitude most blade"], row["force least blade"]) == (
        "4",
        "2",
    )
    assert row["worn_per_pass most of blades (um per pass)"] == ""
    assert "worst blade" not in read_csv(summed())


def test_of_a_growing_motion_stress_and_margin_are_bounds(summed):
    """Without a recorded motion they are not known."""
    course = ANSWER["course"] | {"trend": GROWING, "grows": 0.02, "grows_in": 80}
    found = summed({"course": course}, stress=STRESS)
    assert {"> 20 (no ±) ↑", "at most 17 (no ±)", "300 (no ±)", "80", "40000"} <= {*cells(found)}
    assert "growing, nearly over (2 % in 80 rev.)" in cells(found)
    row = read_csv(found)
    assert (row["stress rises towards"], float(row["grows (1)"])) == ("the clamp", 0.02)
    without = summed({"Omega_c": 0.4}, stress=STRESS)
    assert "alternating" not in without["scenes"][0]["rows"][0]["values"]
    assert "stress at 4800 rpm, whose motion is not recorded" in summary.terminal(without)


def test_the_worst_stress_of_all_speeds_is_told_with_its_node(summed):
    """With the +- of the mesh alone, of the answers at a peak, or of its own second runs."""
    line = (
        "Worst stress (nominal, of the airfoil 6.1 mm from the clamp and farther; the "
        "concentration factor of the root is not included): 3600 rpm, revolution 18, x, y, z = "
        "400, 10, -20 mm: mean 300 MPa {}, alternating 25 MPa {}, margin of the airfoil {}; it "
        "rises further towards the clamp. It is the worst of 4 of 5 speeds; at 1 the motion still "
        "grows, and its stress is a lower bound."
    )
    text = summary.terminal(summed(stress=STRESS))
    assert line.format("≥2%", "≥3%", "12.5 ≥5%") in text and "stress at" not in text
    assert "this run has 80, and 1e7 take 4e+04 s at that speed" in text
    assert "Between" not in text
    errors = {"mean_stress": 3e7, "alternating": 5e6, "margin": 5.0}
    own = ANSWER | {"k": None, "Omega_c": 0.3, "errors": errors, "runs": 12}
    found = summed(stress=STRESS, worst=[own])
    assert line.format("±10%", "±20%", "12 ±40%") in summary.terminal(found)
    assert found["scenes"][0]["runs"] == ANSWER.get("runs", 0) + 12
    peak = {"errors": ANSWER["errors"] | errors, "Omega_c": 0.3}
    assert line.format("±10%", "±20%", "12 ±40%") in summary.terminal(summed(peak, stress=STRESS))
    unknown = summed(stress=STRESS, worst=[own], model_error={"basis": None, "mesh": None})
    assert line.format("≥10%", "≥20%", "12 ≥40%") in summary.terminal(unknown)
    assert "Worst" not in summary.terminal(summed(stress=STRESS | {"worst": None}))


def test_what_the_worst_stress_is_worth_is_told(summed):
    """At an end of the sweep, of all revolutions, of a node that stands out, near the clamp."""
    row = STRESS["speeds"][1] | {"between": 3e7, "stands_out": 1.5}
    row |= {"nearer": WORST | {"alternating": 3e7, "mesh": MESH}}
    told = STRESS | {"speeds": [row], "too_near": 3e-3}
    text = " ".join(stress_told.worst(told, None))
    ends = {**told, "speeds": [row, STRESS["speeds"][2]]}
    assert "may rise further beyond the sweep" in stress_told.worst(ends, None)[0]
    assert "beyond the sweep" not in text  # of one speed
    for part in (
        "it rises further towards the clamp. It is",
        "Between any two instants of the revolutions kept the alternating stress there is 30 MPa.",
        "stands out of those around it by 50 %: that is the mesh's",
        "Down to 3.05 mm from the clamp: alternating 30 MPa ≥3%, margin 17 ≥5%.",
        "nearer than 3 mm, half the thickness: raise stress.away_mm",
    ):
        assert part in text
    fillet = {**told, "root": "fillet", "away_m": 0.0}
    bare = {name: of for name, of in row.items() if name not in ("margin", "cycles")}
    text = " ".join(stress_told.worst({**fillet, "speeds": [bare]}, None))
    assert "(local, with the fillet, but for its edge)" in text and "margin" not in text[:250]
    assert "1e7" not in text
    assert "local, with the fillet, 9 mm" in stress_told.where(fillet | {"away_m": 9e-3})


def test_an_error_known_in_part_is_at_least_so_large(summed):
    """Of the mesh nothing is known, or between the speeds of the sweep, of the amplitude alone."""
    assert {"4200 ≥5.2", "40 ≥5%", "70 ≥5% (rev. 17)", "170 ≥5%"} <= {
        *cells(summed(model_error={"basis": 1e-4, "mesh": None}))
    }
    between = {"parts": ANSWER["parts"] | {"speeds": {"amplitude": None}}}
    assert {"40 ≥5%", "70 ±5% (rev. 17)", "170 ±5%"} <= {*cells(summed(between))}
    assert read_csv(summed(between))["not known of +-"] == "speeds"


@pytest.mark.parametrize(
    ("part", "missing"),
    [("twin", "twin"), ("model", "model"), ("mesh", "mesh"), ("patches", "fineness")],
)
def test_a_second_run_without_result_is_not_known(summed, part, missing):
    """Its change is infinite, null in files: the uncertainty is larger than what is left."""
    found = summed({"parts": ANSWER["parts"] | {part: dict.fromkeys(NUMBERS)}})
    assert {"40 ≥5%", "170 ≥5%"} <= {*cells(found)}
    assert read_csv(found)["not known of +-"] == missing
    assert summary.PARTS[missing] in summary.terminal(found)


def test_a_run_that_ended_early_has_a_trend_alone(summed):
    found = summed({"status": "diverged", "verdict": "", "course": {"trend": GROWING}})
    assert cells(found)[7:11] == [GROWING, "-", "-", "diverged"]
    assert "damping" not in summary.terminal(found)
    assert read_csv(found)["time_constant (rounds)"] == ""


@pytest.mark.parametrize("trend", TRENDS)
def test_a_run_says_whether_it_is_steady(summed, trend):
    """No bare +- stands at an amplitude that still grows, or dies out."""
    found = summed({"course": ANSWER["course"] | {"trend": trend}})
    moves = trend in (GROWING, DYING_OUT)
    assert cells(found)[3] == (f"40 ±5%, {trend}" if moves else "40 ±5%")
    assert [trend, "18.2", "0.003", ONE_MOTION] == cells(found)[7:11]
    row = read_csv(found)
    assert row["trend"] == trend and float(row["largest_round (round)"]) == 17
    assert float(row["time_constant (rounds)"]) == 18.2
    assert float(row["wears (mm3 per round)"]) == pytest.approx(3e-3)


def heads(found):
    return [head for heads, _ in summary.shown(found["scenes"][0]) for head in heads]


@pytest.mark.parametrize("trend", TRENDS)
def test_heads_say_after_how_many_revolutions_what_goes_on_is_told(summed, trend):
    """Unless all is steady, also of a run that may end before; not of the largest, nor of means."""
    course = ANSWER["course"] | {"trend": trend, "rounds": 34.0}
    last = {"numbers": NUMBERS | {"displacement_last": 6e-5, "u_t_leading": 2e-5}}
    steady = ANSWER | {"course": ANSWER["course"] | {"rounds": 12.0}}
    found = summed(peaks=[ANSWER | last | {"course": course}, steady])
    after = [head for head in heads(found) if head.endswith(" after 34 revolutions")]
    named = ["amplitude µm", "last µm", "u_t at 1/16 µm", "wear µm", "worn mm³"]
    named += ["mean worn depth µm"]
    assert [head.removesuffix(" after 34 revolutions") for head in after] == (
        [] if trend == "steady" else named
    )
    rows = summary.shown(found["scenes"][0])[0][1]
    assert "steady (after 12 rev.)" in rows[1] and "60 (no ±)" in rows[0]
    assert ("steady (after 34 rev.)" in rows[0]) == (trend == "steady")
    assert "largest µm" in heads(found) and "last: the same" in summary.table(found)


def test_forces_name_the_area_that_they_are_of(summed):
    named = {"mean force N, whole chord", "peak force N, an eighth of it"}
    assert named <= {*heads(summed())}


def test_heads_longer_than_their_cells_have_several_lines():
    heads = ["EO", "wear µm after 20 revolutions", ""]
    lines = summary.columns(heads, [["4", "7 ±1.3%", "one motion"], ["10", "12", ""]])
    assert lines == [
        "        wear µm",
        "       after 20",
        "EO  revolutions",
        "4       7 ±1.3%  one motion",
        "10           12",
    ]


def test_a_peak_with_two_motions_has_both_numbers(summed):
    found = summed({"verdict": TWO_MOTIONS, "other": NUMBERS | {"amplitude": 9e-6}})
    assert cells(found)[3] == "40 or 9 ±5%"
    row = read_csv(found)
    assert (row["word"], float(row["amplitude other (um)"])) == (TWO_MOTIONS, pytest.approx(9))


def test_a_run_without_a_result_has_its_status(summed):
    failed = {"k": None, "crossing": None, "status": "diverged", "verdict": "", "numbers": {}}
    row = read_csv(summed(failed | {"errors": {}, "spacing": None}))
    assert (row["engine order"], row["word"]) == ("", "diverged")


def test_the_panel_of_a_page_has_the_rows_of_the_summary(summed):
    panel = summary.panel(OF, critical(made_rom(), OPERATING), STRESS)
    shown = summary.shown(summed(stress=STRESS)["scenes"][0])
    tables = [(of["heads"], of["rows"]) for of in panel["tables"]]
    assert (tables[:-1], panel["speeds"]) == (shown, [0.35])  # the last is that of the margins
    assert panel["tables"][-1]["rows"] == []


def test_a_casing_that_tapers_has_place_u_t_and_second_order(summed):
    """Without them the tables have no such columns."""
    of_tip = {"u_t_leading": 6e-3, "u_t_trailing": 4.5e-3, "second_order": 2.1}
    numbers = NUMBERS | of_tip
    errors = {name: 0.05 * value for name, value in numbers.items()}
    course = ANSWER["course"] | {"place": EDGES[1]}
    given = {"numbers": numbers, "errors": errors, "course": course, "beyond": BEYOND}
    given["place"] = EDGES[1]
    found = summed(given)
    assert {"40 ±5% at ξ = 15/16", "6000 ±5%", "4500 ±5%", "2.1 ±5%"} <= {*cells(found)}
    assert f"{ONE_MOTION}, {BEYOND}" in cells(found)
    row = read_csv(found)
    assert (row["place (xi)"], row["u_t_leading (um)"], row["second_order (1)"]) == (
        "0.9375",
        "6000",
        "2.1",
    )
    plain = summed()
    assert "40 ±5%" in cells(plain) and read_csv(plain)["place (xi)"] == ""
    (motion, _), *_ = summary.shown(plain["scenes"][0])
    assert not [head for head in motion if "u_t" in head or "second" in head]


def test_a_peak_names_its_modes_or_says_that_no_crossing_explains_it(summed):
    """And a line on no integer order its f / Omega."""
    found = summed({"k": 3.4, "modes": [2, 3], "crossing": 0.34})
    assert cells(found)[:2] == ["3.4 ±0.05 (f/Ω)", "2 or 3"]
    row = read_csv(found)
    assert (row["engine order"], row["mode"], row["frequency (Hz)"]) == ("3.4", "2 or 3", "238")
    found = summed({"modes": [], "crossing": None})
    assert cells(found)[1] == "-" and f"{ONE_MOTION}, {NO_CROSSING}" in cells(found)


def test_where_there_is_no_peak_is_said_where_it_was_sought(summed):
    """Of one speed nothing; without contact that the blade is at rest."""
    none = {"k": None, "modes": [], "crossing": None}
    where = "Rub peaks: none of mode 1 with EO 4, 5 from 2400 to 4800 rpm."
    assert where in summary.terminal(summed(none))
    assert "Rub peaks" not in summary.terminal(summed(none, status={"ok": 1}))
    at_rest = summary.terminal(summed(status={"no-contact": 3}, peaks=[]))
    assert "none, as nothing moves the blade: it is at rest at all speeds" in at_rest
    assert "At 5 of 41 speeds the largest line is a free" in summary.terminal(summed(free=5))


def test_one_entry_brings_a_number_to_peaks_csv_tables_and_legend(summed, coarse_rom, monkeypatch):
    """With its +-, in its unit."""
    deepest = Quantity(
        name="deepest",
        unit="m",
        meaning="deepest wear of all rods",
        of=lambda run: float(run.wear.max()),
        peak=CONTACT,
        head="deepest µm",
        shown=("um", 1e6),
        loads=True,
        goes_on=True,
        legend=("deepest", "wear of all rods"),
    )
    monkeypatch.setattr(schema, "QUANTITIES", (*schema.QUANTITIES, deepest))
    runs = swept(scene(rounds=3, speeds={"over_f1": [0.3]}), coarse_rom)
    (peak,) = results(
        runs, coarse_rom, ModelError(1e-4, None), peaks=[Peak(None, 0, 0.3, status="ok")]
    )
    depth, error = 1e6 * peak.numbers["deepest"], 1e6 * peak.errors["deepest"]
    assert depth == pytest.approx(1e6 * runs["wear"].max().item()) and depth > error > 0
    found = summed({"numbers": peak.numbers, "errors": peak.errors})
    row = read_csv(found)
    assert float(row["deepest (um)"]) == pytest.approx(depth, rel=1e-5)
    assert float(row["deepest +- (um)"]) == pytest.approx(error, rel=1e-5)
    assert row["tip_speed (m/s)"] and not row["tip_speed +- (m/s)"]
    assert float(row["worn_per_pass +- (um per pass)"]) > 0
    _, (heads, (cells,)), _ = summary.shown(found["scenes"][0])
    assert float(cells[heads.index("deepest µm")].split()[0]) == pytest.approx(depth, rel=0.01)
    assert cells[heads.index("tip m/s")] and cells[heads.index("worn µm per pass")]
    assert "- deepest: wear of all rods.\n- mode:" in summary.meaning()
