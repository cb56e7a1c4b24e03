"""Margins of operating speeds: by hand, and the same in summary, CSV, page and Campbell diagram."""

import csv
import re
from dataclasses import replace
from io import StringIO
from types import SimpleNamespace

import numpy as np
import pytest
from made_sweeps import F1, PROVENANCE, STIFFENING, made_rom
from test_summary import ANSWER, OF

from geometry.base import write_json
from rom.check import RomCheck
from simulate.scene import GROWING
from simulate.sweeps.crossings import critical
from workflow import margins, summary
from workflow.figures import campbell

RPM = 60 * F1  # of a speed over f1(0)
CROSSING = 1 / np.sqrt(16 - STIFFENING)  # of k = 4 with mode 1
DESIGN, TOP, IDLE = CROSSING / 1.12, 0.29, 0.2  # over f1(0): the crossing is beyond the top
LINES = {"design": DESIGN * RPM, "idle": IDLE * RPM}
OPERATING = {"lines": LINES, "modes": 3, "orders": [*range(1, 9)], "excited": {4: "casing"}}
PEAK = ANSWER | {"k": 5, "Omega_c": 0.25, "spacing": 0.01, "crossing": 0.227}
MINE = OF | {"f1_Hz": F1, "blade": "reference", "peaks": [PEAK]}
NEXT = re.compile(
    r"next [a-z ]* (above|below): (\d+)[^,]*, ([^:]*): speed (\S+) %, frequency (\S+) %"
)


@pytest.fixture(scope="module")
def rom():
    """f^2 = f0^2 + B Omega^2 up to 0.29 f1(0)."""
    top = TOP * 2 * np.pi * F1
    return replace(made_rom(), Omega_m=top, speeds=top * np.array([0, 0.5, 1]))


@pytest.fixture
def told(rom, tmp_path):
    """The summary of answers, on the made model."""

    def told(lines=LINES, **of):
        write_json(MINE | of, tmp_path / "answers.json")
        rom.save(tmp_path / "rom.nc")
        files = SimpleNamespace(answers=[tmp_path / "answers.json"], roms=[tmp_path / "rom.nc"])
        return summary.numbers(files, {"reference": OPERATING | {"lines": lines}})

    return told


def row_of(found, line, what, k, mode=1):
    (row,) = (
        row
        for row in found["scenes"][0]["margins"]
        if (row["line"], row["what"], row["k"], row["modes"]) == (line, what, k, [mode])
    )
    return row


def test_margins_by_hand(told):
    """Of speed: critical over operating speed less 1; of frequency: (f - k Omega) / (k Omega)."""
    found = told()
    row = row_of(found, "design", "extrapolated crossing", 4)
    f1 = np.sqrt(1 + STIFFENING * DESIGN**2)
    assert row["rpm"] == pytest.approx(CROSSING * RPM, rel=1e-8)
    assert row["speed_margin"] == pytest.approx(0.12, rel=1e-7)
    assert row["frequency_margin"] == pytest.approx(f1 / (4 * DESIGN) - 1, rel=1e-9)
    assert row["rpm_error"] == pytest.approx(1e-3 * row["rpm"], rel=1e-4)  # basis and mesh
    below = row_of(found, "design", "crossing", 5)
    at = 1 / np.sqrt(25 - STIFFENING)
    assert below["speed_margin"] == pytest.approx(at / DESIGN - 1, rel=1e-7)
    assert below["frequency_margin"] == pytest.approx(f1 / (5 * DESIGN) - 1, rel=1e-9)
    rub = row_of(found, "idle", "rub peak", 5)
    assert (rub["rpm"], rub["frequency_margin"]) == (pytest.approx(0.25 * RPM), None)
    assert rub["rpm_error"] == pytest.approx((0.01 + 1e-3 * 0.25) * RPM)
    assert rub["speed_margin"] == pytest.approx(0.25)


def test_a_rub_peak_that_grows_says_so(told):
    found = told(peaks=[PEAK | {"course": ANSWER["course"] | {"trend": GROWING}}])
    assert row_of(found, "design", "rub peak (growing)", 5)["rpm"] == pytest.approx(0.25 * RPM)
    assert f"rub peak ({GROWING}) of EO 5 with mode 1" in summary.terminal(found)


def test_a_peak_of_a_blade_that_does_not_touch_is_of_its_forces(told):
    found = told(peaks=[PEAK | {"status": "no-contact"}])
    assert row_of(found, "design", "forced peak", 5)["rpm"] == pytest.approx(0.25 * RPM)
    assert "nearest forced peak: " in summary.terminal(found)


def test_nearest_first_and_what_is_far_is_in_the_csv_file_alone(told):
    found = told()
    for name in LINES:
        rows = [abs(r["speed_margin"]) for r in found["scenes"][0]["margins"] if r["line"] == name]
        assert rows == sorted(rows)
    near = margins.table(found["scenes"][0]["margins"])
    assert [row[:4] for row in near if row[0].startswith("design")] == [
        [f"design {DESIGN * RPM:.0f}", "rub peak", "1", "5"],
        [f"design {DESIGN * RPM:.0f}", "extrapolated crossing", "1", "4"],
        [f"design {DESIGN * RPM:.0f}", "crossing", "1", "5"],
    ]
    assert len(near) < len(found["scenes"][0]["margins"]) == len(of_csv(found))


MET = {"mode": 1, "rpm": 1000.0, "rpm_to": 1200.0, "bound": False, "f_over_Omega": 3.4}
WHIRLS = [
    {"order": 2, "Hz": 40.0, "modes": 4, "up_to": 1800.0, "met": [MET]},
    {"order": 3, "Hz": 90.5, "modes": 4, "up_to": 1800.0, "met": []},
]


def test_a_range_in_which_rotation_feeds_the_casing_is_a_critical_speed_everywhere(told, rom):
    found = told(whirls=WHIRLS)
    scene = found["scenes"][0]
    (row,) = (row for row in scene["margins"] if row["rpm_to"] and row["line"] == "idle")
    assert row["speed_margin"] == 0  # at its end
    cells = ["fed by rotation, with order 2 of the casing", "1", "3.4", "-", "1000 to 1200"]
    near = margins.table(scene["margins"])
    assert any(of[1:6] == cells for of in near)
    page = summary.panel(MINE | {"whirls": WHIRLS}, critical(rom, OPERATING), {})
    for text in (summary.table(found), summary.terminal(found), "\n".join(page["notes"])):
        assert "order 2 of the casing, 40 Hz (" in text
        assert "): mode 1 at 1000 to 1200 rpm." in text
        assert "order 3 of the casing, 90.5 Hz (" in text
        assert "): none of modes 1 to 4 up to 1800 rpm." in text
        assert "nearest rub peak" in text  # a range is none
    (of,) = (row for row in of_csv(found) if row["rpm_to"] and row["line"] == "idle")
    assert (float(of["rpm"]), float(of["rpm_to"]), of["quadratic_rpm"]) == (1000, 1200, "")
    beyond = MET | {"bound": True}
    assert margins.range_of(beyond) == "1000 to 1200 and above"
    # from the nearest end, 0 inside, and as far as it goes on
    for met, rpm, expected in ((MET, 1100, 0), (MET, 1250, -0.04), (beyond, 1700, 0)):
        campbell = critical(rom, OPERATING | {"lines": {"idle": float(rpm)}})
        (of_range,) = margins.of_casing([WHIRLS[0] | {"met": [met]}])
        (row,) = (row for row in margins.rows(campbell, [of_range]) if row["rpm_to"])
        assert row["speed_margin"] == pytest.approx(expected)


def of_csv(found):
    return list(csv.DictReader(StringIO(summary.margins_csv(found))))


def test_a_crossing_beyond_the_top_speed_is_told_alike_everywhere(told, rom):
    """12 % above the design speed, of k = 4: in summary, terminal, CSV, page and Campbell."""
    found = told(peaks=[])
    line = rf"Design speed {DESIGN * RPM:.0f} rpm, next crossing above: "
    line += rf"{CROSSING * RPM:.0f}( ±[\d.]+)? rpm, "
    line += r"extrapolated crossing of EO 4 with mode 1: speed \+12.0 %, frequency \+8.0 %"
    page = summary.panel(MINE | {"peaks": []}, critical(rom, OPERATING), {})
    (legend,) = diagram(rom).legends
    figure = "\n".join(text.get_text() for text in legend.texts)
    texts = (summary.table(found), summary.terminal(found), "\n".join(page["notes"]), figure)
    for text in texts:
        assert re.search(line, text)
        # every number of every line is the same, and only the figure does not know the errors
        assert NEXT.findall(text) == NEXT.findall(texts[0]) and len(NEXT.findall(text)) == 4
    for text in texts[:3]:
        assert "Gyroscopic terms are not in the model" in text
        assert "modes 1 to 3 with EO 1 to 8 up to 2175 rpm" in text  # extrapolated
    (row,) = (row for row in of_csv(found) if row["k"] == "4" and row["line"] == "design")
    assert float(row["speed_margin"]) == pytest.approx(0.12)


def test_tables_of_summary_page_and_file_and_marks_of_the_campbell_diagram_are_the_same(told, rom):
    found = told()
    rows = found["scenes"][0]["margins"]
    page = summary.panel(MINE, critical(rom, OPERATING), {})["tables"][-1]
    assert (page["heads"], page["rows"]) == (margins.HEADS, margins.table(rows))
    for cells in page["rows"]:
        assert f"| {' | '.join(cells)} |" in summary.table(found)
    of_file = [float(row["rpm"]) for row in of_csv(found)]
    assert of_file == pytest.approx([row["rpm"] for row in rows], rel=1e-5)
    first, every, *_ = diagram(rom).axes
    squares = [line for line in (*first.lines, *every.lines) if line.get_marker() == "s"]
    marked = [x * RPM for line in squares for x in line.get_xdata()]
    near = {row["rpm"] for row in margins.near(rows) if row["quadratic_rpm"]}
    assert sorted(marked) == pytest.approx(sorted(near))
    texts = {text.get_text() for axes in (first, every) for text in axes.texts}
    assert {f"{rpm:.0f}" for rpm in near} <= texts


def diagram(rom, operating=OPERATING):
    speeds = np.linspace(0, rom.Omega_m, 3)
    full = np.array([rom.modes(speed)[0] for speed in speeds])
    known = {"xi": np.array([0.5]), "compliance_error": np.zeros((3, 1, 1)), "highest": 1.0}
    check = RomCheck(
        speeds=speeds, full=full, reduced=full, between=np.nan, provenance=PROVENANCE, **known
    )
    return campbell.draw(rom, check, operating=operating)


def test_the_campbell_diagram_has_the_casing_as_the_blade_sees_it(rom):
    """f_n + n Omega and |f_n - n Omega|, which turns back at f_n / n."""
    f, end = 0.4, 1.25 * TOP
    drawn = diagram(rom, OPERATING | {"casing": [(3, f * F1), (0, 2 * F1)]})
    plain = [len(axes.lines) for axes in diagram(rom).axes[:2]]
    for axes, before in zip(drawn.axes[:2], plain, strict=True):
        assert len(axes.lines) == before + 4
        of_casing = [line for line in axes.lines if line.get_linestyle() == ":"]
        up, down, *constant = [line.get_xydata() for line in of_casing[-4:]]
        np.testing.assert_allclose(up[:, 1], f + 3 * up[:, 0])
        np.testing.assert_allclose(down[:, 1], abs(f - 3 * down[:, 0]))
        assert down[:, 0] == pytest.approx([0, min(f / 3, end), end])
        assert all((line[:, 1] == 2).all() for line in constant)
    assert "casing" in " ".join(text.get_text() for text in drawn.axes[0].get_legend().texts)


def test_frequencies_of_the_campbell_diagram_go_on_dashed_to_a_quarter_above_the_top(rom):
    ahead = [line for line in diagram(rom).axes[0].lines if line.get_label() == "extrapolated"]
    speeds, f1 = ahead[0].get_data()
    assert speeds[[0, -1]] == pytest.approx([TOP, 1.25 * TOP])
    assert f1 == pytest.approx(np.sqrt(1 + STIFFENING * speeds**2))


def test_where_nothing_is_near_the_next_are_told(told):
    found = told({"design": 0.1 * RPM}, peaks=[])
    assert margins.table(found["scenes"][0]["margins"]) == []
    text = summary.terminal(found)
    assert re.search(
        r"Design speed 600 rpm, next crossing above: 785 ±0.79 rpm, crossing of EO 8", text
    )
    none = "none of modes 1 to 3 with EO 1 to 8 from 0 to 600 rpm."
    assert f"Design speed 600 rpm, next crossing below: {none}" in text


def test_a_blade_without_operating_speeds_has_no_margins(rom):
    found = summary.panel(MINE, critical(rom, OPERATING | {"lines": {}}), {})
    assert found["tables"][-1]["rows"] == []
    assert not any("next" in note for note in found["notes"])


def test_an_unknown_difference_is_no_small_one():
    row = {"rpm": 4000.0, "rpm_error": np.nan, "least": False, "bound": False}
    assert margins.speed(row) == "4000 (no ±)"
    assert margins.speed(row | {"rpm_error": 0.0, "least": False}) == "4000"
    assert margins.speed(row | {"rpm_error": 9.2, "least": True}) == "4000 ≥9.2"
