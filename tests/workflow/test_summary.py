"""The summary in units of engines: its numbers, what is not known, and its CSV file."""

import csv
import json
from io import StringIO
from types import SimpleNamespace

import pytest

from workflow import summary

NUMBERS = {"amplitude": 4e-5, "wear": 1e-5, "worn_volume": 2e-7, "opening": 1.5e-6}
NUMBERS |= {"force": 170.0, "force_peak": 580.0, "torque": 0.05}
ANSWER = {
    "k": 4,
    "speed_over_f1": 0.35,
    "spacing_over_f1": 4e-4,
    "crossing": 0.31,
    "at_end": False,
    "status": "ok",
    "word": "settled",
    "numbers": NUMBERS,
    "errors": {name: 0.05 * value for name, value in NUMBERS.items()},
    "other": {},
    "parts": {"twin": {"amplitude": 0.03}, "companion": {"amplitude": 0.04}},
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
    "doubt": {"basis": 1e-4, "mesh": 9e-4},
    "no_torque": None,
    "mu_crit": None,
    "answers": [ANSWER],
}
STATE = {"settled": {"largest_Pa": 400e6, "largest_of_cells_Pa": 420e6, "at_m": [0, 0, 0]}}
PAGE = {"scene": "mine", "speed_over_f1": [0.3, 0.35, 0.4], "largest_Pa": [9e7, 3e8, None]}
STRESS = {"scene": "mine", "blade": "b", "speed_over_f1": 0.35, "von_mises": STATE}


@pytest.fixture
def summed(tmp_path):
    """The summary of changed answers, of a recorded state and of a page if these are given."""

    def summed(answer=None, stress=None, operating=None, page=None, **of):
        files = SimpleNamespace(answers=[tmp_path / "answers.json"], stress=[], pages=[])
        files.answers[0].write_text(json.dumps(OF | {"answers": [ANSWER | (answer or {})]} | of))
        if stress:
            files.stress = [tmp_path / "peak.json"]
            files.stress[0].write_text(json.dumps(stress))
        if page:
            files.pages = [tmp_path / "stress.json"]
            files.pages[0].write_text(json.dumps(page))
        return summary.numbers(files, {"b": operating or {}})

    return summed


def test_a_peak_in_units_of_engines(summed):
    """0.35 of 200 Hz is 4200 rpm and, at order 4, 280 Hz; micrometres, cubic millimetres, MPa."""
    found = summed(stress=STRESS)
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    assert float(row["speed (rpm)"]) == pytest.approx(4200)
    assert float(row["frequency (Hz)"]) == pytest.approx(280)
    assert float(row["amplitude (um)"]) == pytest.approx(40)
    assert float(row["amplitude +- (um)"]) == pytest.approx(2)
    assert float(row["worn_volume (mm3)"]) == pytest.approx(200)
    assert float(row["torque (N m)"]) == pytest.approx(0.05)
    assert (float(row["stress (MPa)"]), float(row["stress +- (MPa)"])) == (400, 20)
    assert row["amplitude other (um)"] == ""
    # spacing 4e-4, and a thousandth of 0.35, of 12000 rpm
    assert float(row["speed +- (rpm)"]) == pytest.approx(12000 * (4e-4 + 3.5e-4))
    for text in (summary.table(found), summary.terminal(found)):
        assert "4200 ±9" in text and "40 ±5%" in text and "400 ±5%" in text
        assert "1 diverged" in text and "settled" in text


def test_what_is_not_known_is_said(summed):
    doubt = {"basis": 1e-4, "mesh": None}
    numbers = {name: NUMBERS[name] for name in ("amplitude", "force")}
    found = summed({"numbers": numbers, "errors": {}}, doubt=doubt, no_torque="a reason")
    text = summary.terminal(found)
    unknown = "error of the mesh, stress (explore, record.states_rounds), torque (a reason)"
    assert f"Not known: {unknown}." in text and "Friction" not in text
    assert "40 ?" in text and "torque N m" not in text
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    assert row["torque (N m)"] == row["amplitude +- (um)"] == ""
    elsewhere = summed(stress=STRESS | {"speed_over_f1": 0.36})
    assert "stress" not in elsewhere["scenes"][0]["rows"][0]["values"]


def test_stress_is_that_of_the_page_where_no_state_was_recorded(summed):
    found = summed(page=PAGE)
    assert "300 ?" in summary.terminal(found) and "Not known" not in summary.terminal(found)
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    assert (row["stress (MPa)"], row["stress +- (MPa)"]) == ("300", "")
    assert "400 ±5%" in summary.terminal(summed(page=PAGE, stress=STRESS))
    without = summed({"speed_over_f1": 0.4}, page=PAGE)  # no result at that speed
    assert "stress (explore, record.states_rounds)" in summary.terminal(without)


def test_without_a_coarser_run_its_part_is_not_known(summed):
    """Central differences have none."""
    text = summary.terminal(summed({"parts": {"twin": {"amplitude": 0.05}}}, page=PAGE))
    assert "Not known: error of step, strips and patches (no coarser run)." in text
    assert "coarser run" not in summary.terminal(summed({"parts": {}}))  # nothing was tried


def test_a_bistable_peak_has_both_numbers(summed):
    found = summed({"word": "bistable", "other": NUMBERS | {"amplitude": 9e-6}})
    assert "40 or 9 ±5%" in summary.terminal(found) and "bistable" in summary.table(found)
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    assert (row["word"], float(row["amplitude other (um)"])) == ("bistable", pytest.approx(9))


def test_the_nearest_critical_speed_of_an_operating_line(summed):
    found = summed(operating={"design": 4000.0, "idle": 5000.0})
    text = summary.terminal(found)
    assert "Design speed 4000 rpm: nearest critical speed 4200 rpm (k = 4), 5% above." in text
    assert "Idle speed 5000 rpm: nearest critical speed 4200 rpm (k = 4), 16% below." in text
    far = summary.terminal(summed(operating={"idle": 1900.0}))
    assert "4200 rpm (k = 4), 121% above." in far  # no exponent
    none = summed({"k": None, "crossing": None}, operating={"design": 4000.0})
    assert "Design speed 4000 rpm: no critical speed found." in summary.terminal(none)


def test_the_error_of_a_speed_has_no_exponent(summed):
    assert "4200 ±324" in summary.terminal(summed({"spacing_over_f1": 0.027 - 3.5e-4}))


def test_a_sweep_that_ends_on_the_rise_has_a_bound(summed):
    text = summary.terminal(summed({"at_end": True}))
    assert "4200 (end)" in text and "±9" not in text


def test_a_run_without_a_result_has_its_status(summed):
    failed = {"k": None, "crossing": None, "status": "diverged", "word": "", "numbers": {}}
    found = summed(failed | {"errors": {}, "spacing_over_f1": None})
    assert "diverged" in summary.terminal(found).splitlines()[3]
    (row,) = csv.DictReader(StringIO(summary.csv(found)))
    assert (row["engine order"], row["word"]) == ("", "diverged")


def test_the_panel_of_a_page_has_the_rows_of_the_summary(summed):
    panel = summary.panel(OF, {"design": 4000.0}, PAGE)
    heads, rows = summary.shown(summed(page=PAGE)["scenes"][0])
    assert (panel["heads"], panel["rows"], panel["speeds"]) == (heads, rows, [0.35])
    assert any("Design speed" in note for note in panel["notes"])
