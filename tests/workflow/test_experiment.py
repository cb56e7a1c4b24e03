"""Experiments: their rows, what is kept of them, their tables, and their jobs."""

from pathlib import Path

import pytest
import yaml
from projects import make_project
from refused import refused

from geometry.base import ROOT, SettingsError, UserError, read_json, silent, write_json
from simulate.errors.observables import differences
from simulate.sweeps.sweep import sweep
from tests.simulate.scenes import scene
from workflow.figures import experiment as picture
from workflow.jobs.many import experiment
from workflow.many import engine, table
from workflow.many.numbers import peaks
from workflow.many.plan import cases
from workflow.many.row import Row
from workflow.many.store import Store

SCENE = scene(
    speeds={"over_f1": [0.33]},
    record__spectrum_rounds=2,
    integrator={"scheme": "piecewise-exact", "steps_per_round": 512},
)


@pytest.fixture
def planned(tmp_path, monkeypatch):
    """Function that reads an experiment on the scenes `one` and `two`, which is stiffer."""
    monkeypatch.chdir(tmp_path)
    Path("workflow/scenes").mkdir(parents=True)
    for name, E in (("one", 1.0), ("two", 10.0)):
        values = SCENE.but(liner__law__E=E).model_dump(mode="json", exclude_unset=True)
        Path(f"workflow/scenes/{name}.yaml").write_text(yaml.safe_dump(values))

    def read(text):
        Path("mine.yaml").write_text(text)
        return cases("mine.yaml")

    return read


def test_every_row_is_run_on_every_scene_with_its_own_values(planned):
    found = planned(
        "of: [one, two]\n"
        "rows:\n"
        "  as it is: {}\n"
        "  soft: {liner.law.K: 0.1, two: {liner: {law: {K: 0.2}}}, blade: other}\n"
        "  fine: {times: {integrator.steps_per_round: 2}, directions: rt}\n"
    )
    of = {(case.row, case.label): case for case in found}
    assert [*of] == [
        (row, label) for row in ("as it is", "soft", "fine") for label in ("one", "two")
    ]
    assert of["as it is", "one"].scene == SCENE
    assert [of["soft", label].scene.liner.law.K for label in ("one", "two")] == [0.1, 0.2]
    assert of["soft", "one"].file("rom") == "results/other/rom-r.nc"
    steps = SCENE.integrator.steps_per_round
    assert of["fine", "two"].scene == of["as it is", "two"].scene.but(
        integrator__steps_per_round=2 * steps
    )
    assert of["fine", "one"].file("rom") == "results/coarse/rom-rt.nc"
    assert all(Row.model_validate(case.model_dump(mode="json")) == case for case in found)


def test_lists_are_combined_and_scenes_may_be_written_in_place(planned):
    found = planned(
        "of: {soft: one, hard: {base: one, liner.law.E: 20.0}}\n"
        "lists:\n"
        "  E: {E 1: {liner.law.E: 1.0}, E 2: {liner.law.E: 2.0}}\n"
        "  K: {own K: {}, K 3: {liner.law.K: 3.0}}\n"
        "groups:\n"
        "  - {of: [soft], each: [E, K], against: 'E 1, own K', name: grid}\n"
        "  - {rows: {alone: {}}}\n"
        "numbers: {soft: paper.measure:coating}\n"
    )
    assert [(c.row, c.label) for c in found] == [
        *((row, "soft") for row in ("E 1, own K", "E 1, K 3", "E 2, own K", "E 2, K 3")),
        *(("alone", label) for label in ("soft", "hard")),
    ]
    assert found[3].scene.liner.law.E == 2.0 and found[3].scene.liner.law.K == 3.0
    assert found[-1].scene.liner.law.E == 20.0
    assert found[0].function == "workflow.paper.measure:coating"
    assert found[-1].function == "workflow.many.numbers:peaks"
    assert (found[1].against, found[1].group, found[-1].against) == ("E 1, own K", "grid", None)


@pytest.mark.parametrize(
    ("text", "key", "line"),
    [
        ("rows:\n  stiff:\n    liner.law.K: -1\n", "rows.stiff.liner.law.K", 4),
        ("rows:\n  stiff: {rounds: 3,\n    liner: {law: {K: -1}}}\n", "rows.stiff.liner.law.K", 4),
        ("rows: {stiff: {linre.law.K: 1}}\n", "rows.stiff.linre", 2),
        (
            "rows: {stiff: {'casing.harmonics[9].order': 1}}\n",
            "rows.stiff.casing.harmonics[9].order",
            2,
        ),
        ("rows: {a: {accuracy: 0.05, integrator: null, liner.rods_per_round: null}}\n", None, 2),
        ("lists: {E: {E 1: {liner.law.E: -1}}}\neach: [E]\n", "lists.E.E 1.liner.law.E", 2),
        ("each: [E]\n", "each", 2),
        ("rows: {a: {}}\nagainst: b\n", "against", None),
        ("rows: {a: {}}\nagainst: ''\n", "against", None),
        ("rows: {a: {}}\nnumbers: {three: peaks}\n", "numbers", 3),
        ("groups: [{of: [three], rows: {a: {}}}]\n", "groups.of", 2),
        ("rows: {a: {}}\nunknown: 1\n", "unknown", 3),
        ("rows: {a: {}}\npicture: {kind: lines, x: row, y: ok, z: row}\n", "picture.z", 3),
        ("rows: {a: {}}\npicture: {x: row}\n", "picture.kind", 3),
        ("rows: {a: {}}\npicture: {kind: lines, x: row}\n", "picture.y", 3),
        ("rows: {a: {}}\npicture: {kind: cells, y: row}\n", "picture.value", 3),
        ("rows: {a: {}}\nnumbers: peeks\n", "numbers", 3),
        ("rows: {a: {}}\ndrawn: 3\n", "drawn", 3),
        ("rows: {a: {}}\nnumbers: nowhere:peaks\n", "numbers", 3),
        ("rows:\n  a: {model: rom.basis:none}\n", "rows.a.model", 3),
        ("rows:\n  a: {directions: rx}\n", "rows.a.directions", 3),
        ("rows:\n  a: {times: {liner.law.Q: 2}}\n", "rows.a.times.liner.law.Q", 3),
        ("rows:\n  a: {times: {liner.law.kind: 2}}\n", "rows.a.times.liner.law.kind", 3),
    ],
)
def test_a_fault_is_said_with_file_line_and_key(planned, text, key, line):
    error = refused(SettingsError, planned, f"of: [one]\n{text}")
    assert error.file == "mine.yaml" and error.line == line
    assert key is None or error.key == key


def test_a_scene_that_is_not_there_is_refused_with_its_label(planned):
    error = refused(SettingsError, planned, "of: {one: one, new: three}\nrows: {a: {}}\n")
    assert (error.key, error.value, error.line) == ("of.new.base", "three", 1)


def test_a_fault_of_a_scene_names_its_own_file(planned):
    scene = Path("workflow/scenes/one.yaml")
    scene.write_text(scene.read_text().replace("damping_ratio: ", "damping_ratio: 9"))
    error = refused(SettingsError, planned, "of: [one]\nrows: {a: {}}\n")
    assert (error.file, error.key) == (str(scene), "damping_ratio")


def one(row, function="workflow.many.numbers:peaks", against=None, **changes):
    """A case on the coarse blade."""
    of = {"function": function, "against": against, "model": None, "needs": ["rom"]}
    of |= {"group": "", "label": "only", "names": (row,), "directions": "r"}
    return Row(scene=SCENE.but(**changes), **of)


@pytest.fixture
def on_coarse(coarse_rom, monkeypatch):
    """Rows are marched on the coarse model; the list of those that were."""
    monkeypatch.setattr(engine.Rom, "load", lambda file: coarse_rom)
    marched = []
    called = engine._called

    def told(name, of):
        marched.append(of.case.row)
        return called(name, of)

    monkeypatch.setattr(engine, "_called", told)
    return marched


def march(rows, folder, block=0, blocks=1):
    """A block of these rows, as a job marches them."""
    planned = [
        row.model_dump(mode="json") | {"number": number} for number, row in enumerate(rows, 1)
    ]
    entries = experiment(planned, blocks, block, folder, silent)
    return table.rows([entries], folder)


def test_rows_that_are_done_are_not_marched_again(on_coarse, tmp_path):
    """In another number of blocks, beside a new row, and where a file is damaged."""
    rows = [one("as it is"), one("hard", liner__law__E=10.0)]
    first = [row for block in (0, 1) for row in march(rows, tmp_path, block, 2)]
    assert on_coarse == ["as it is", "hard"] and [row["row"] for row in first] == on_coarse
    new = one("soft", liner__law__K=0.2)
    again = march([*rows, new], tmp_path)
    assert again[:2] == first and on_coarse == ["as it is", "hard", "soft"]
    for file in tmp_path.iterdir():
        file.write_text(file.read_text()[:-20])
    assert len(march(rows, tmp_path)) == 2 and on_coarse[3:] == ["as it is", "hard"]


def test_the_numbers_of_a_row_are_those_of_its_sweep(on_coarse, coarse_rom, tmp_path):
    (row,) = march([one("as it is")], tmp_path)
    assert row["numbers"] == peaks(sweep(SCENE, coarse_rom), coarse_rom)
    assert row["numbers"]["largest"]["amplitude"] > 0
    assert row["cpu_s"] > 0 and row["settings"] == SCENE.model_dump(mode="json")


def away(single, reference):
    """A function of numbers: the largest relative difference from the reference."""
    other = reference.single if reference else single
    return {"away": max(differences(single, other).values())}


def test_rows_are_compared_with_the_row_that_they_name(on_coarse, monkeypatch, tmp_path):
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "")  # of a test
    away_ = f"{__name__}:away"
    rows = [one("itself", away_), one("fine", away_, "itself", integrator__steps_per_round=1024)]
    itself, fine = march(rows, tmp_path)
    assert itself["numbers"]["away"] == 0 < fine["numbers"]["away"]


def test_rows_that_are_compared_with_one_row_follow_one_another(on_coarse, monkeypatch, tmp_path):
    """It is marched once for each scene, though rows of two scenes alternate."""
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "")  # of a test
    prepared, prepare = [], engine.prepare
    monkeypatch.setattr(
        engine, "prepare", lambda scene, *of: prepared.append(scene) or prepare(scene, *of)
    )
    rows = [
        one(f"{steps} steps", f"{__name__}:away", "512 steps", integrator__steps_per_round=steps)
        for steps in (512, 1024, 2048)
    ]
    stiff = [row.scene.but(liner__law__E=10.0) for row in rows]
    both = [
        row.model_copy(update=of)
        for row, scene in zip(rows, stiff, strict=True)
        for of in ({"label": "soft"}, {"label": "stiff", "scene": scene})
    ]
    found = march(both, tmp_path)
    assert [(row["row"], row["scene"]) for row in found] == [(of.row, of.label) for of in both]
    # the row itself, and what the others are compared with
    assert [prepared.count(scene) for scene in (rows[0].scene, stiff[0])] == [2, 2]


def test_equal_rows_share_a_file_and_keep_their_names(on_coarse, tmp_path):
    found = march([one("as it is"), one("as it was")], tmp_path)
    assert [row["row"] for row in found] == ["as it is", "as it was"] and len(on_coarse) == 1


def test_a_short_run_is_repeated_for_its_time(on_coarse, coarse_rom):
    marched = engine.Marched(one("as it is"), coarse_rom, {}, None)
    assert marched.single.outcome.status == "ok" and len(marched.seconds) == 3


def size(blade):
    """A function of numbers that takes no run and no model."""
    return {"size": blade.mesh.element_size_mm}


def test_a_row_that_is_not_marched_needs_no_model(coarse_yaml, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "")  # of a test
    Path("workflow/blades").mkdir(parents=True)
    Path("workflow/blades/coarse.yaml").write_text(Path(coarse_yaml).read_text())
    row = one("as it is", f"{__name__}:size").model_copy(update={"needs": ()})
    (found,) = march([row], tmp_path / "rows")
    assert (found["numbers"], found["cpu_s"]) == ({"size": 10.0}, 0)


def test_a_refused_row_stays_a_row_with_its_reason(on_coarse, tmp_path):
    fast, as_it_is = march([one("fast", speeds={"over_f1": [9.0]}), one("as it is")], tmp_path)
    assert fast["refused"].startswith("speeds.over_f1: 9: ") and fast["numbers"] is None
    assert "refused" not in as_it_is and as_it_is["numbers"]["ok"] == 1
    assert ",refused," in table.csv([fast, as_it_is]) and ",refused," not in table.csv([as_it_is])


def test_a_row_whose_reference_is_refused_says_so(on_coarse, monkeypatch, tmp_path):
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "")  # of a test
    rows = [one("fast", f"{__name__}:away", speeds={"over_f1": [9.0]})]
    fast, other = march([*rows, one("other", f"{__name__}:away", "fast")], tmp_path / "rows")
    assert fast["refused"].startswith("speeds.over_f1: 9: ")
    assert other["refused"].startswith("against fast.speeds.over_f1: 9: ")
    write_json([fast, other], tmp_path / "table.json")
    error = refused(UserError, table.whole, tmp_path / "table.json")
    assert error.key == "fast, only" and "speeds.over_f1: 9: " in error.text


@pytest.mark.parametrize(
    "file", sorted((ROOT / "workflow/experiments").glob("*.yaml")), ids=lambda file: file.stem
)
def test_all_experiments_can_be_planned(file, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert cases(file)


def told_number(number, scene):
    """A function of numbers that takes the number of its row."""
    return {"twice": 2 * number * scene.rounds}


def test_rows_that_are_drawn_know_their_number(on_coarse, planned, monkeypatch, tmp_path):
    drawn = planned("of: [one]\ndrawn: 3\n")
    assert [(row.number, row.row, row.scene) for row in drawn] == [
        (number, str(number), SCENE) for number in (1, 2, 3)
    ]
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "")  # of a test
    rows = [one(row.row, f"{__name__}:told_number") for row in drawn]
    found = march(rows, tmp_path / "rows")
    assert [row["numbers"]["twice"] for row in found] == [2 * n * SCENE.rounds for n in (1, 2, 3)]


PICTURES = {
    "lines": {"x": "liner.law.E", "y": ["ok", "k = 4 amplitude"], "line": "scene"},
    "cells": {"x": "scene", "y": "row", "value": "k = 4 amplitude"},
}


@pytest.mark.parametrize("kind", PICTURES)
def test_a_picture_shows_columns_and_keys_of_the_scenes(kind):
    rows = [
        row | {"settings": {"liner": {"law": {"E": E}}}}
        for row, E in zip(ROWS, (1.0, 10.0), strict=True)
    ]
    drawn = picture.draw(rows, {"kind": kind, **PICTURES[kind]})
    if kind == "lines":
        ok, high = drawn.axes
        assert ok.lines[0].get_xydata().tolist() == [[1.0, 3.0], [10.0, 2.0]]
        assert high.get_ylabel() == "k = 4 amplitude" and high.get_xlabel() == "liner.law.E"
    else:
        assert [text.get_text() for text in drawn.axes[0].texts] == ["1.23"]
        assert [text.get_text() for text in drawn.axes[0].get_yticklabels()] == ["a", "b"]
    amplitude = "amplitude / gap"
    named = picture.draw(
        rows, {"kind": kind, **PICTURES[kind], "labels": {"k = 4 amplitude": amplitude}}
    )
    assert amplitude in [axes.get_ylabel() for axes in named.axes] + [
        axes.get_xlabel() for axes in named.axes
    ]
    rows[0]["settings"] = {}  # a rigid casing has no such key
    keys = PICTURES[kind] | {"y": "liner.law.E"} if kind == "cells" else PICTURES[kind]
    picture.draw(rows, {"kind": kind, **keys, "labels": {"a": "as it is"}})
    unknown = PICTURES["cells"] | {"kind": "cells", "value": "ko"}
    error = refused(UserError, picture.draw, rows, unknown)
    assert error.value == "ko" and "k = 4 amplitude" in error.text


ROWS = [
    {"group": "", "row": "a", "scene": "one", "blade": "b", "cpu_s": 1.25, "numbers": {"ok": 3}},
    {
        **{"group": "", "row": "b", "scene": "one", "blade": "b", "cpu_s": 2.0},
        "numbers": {"ok": 2, "k = 4": {"amplitude": 1.23456, "wear": None}, "list": [1, 2]},
    },
]


def test_a_table_has_a_column_for_each_number_that_a_row_has():
    assert table.csv(ROWS).splitlines() == [
        "row,scene,blade,cpu_s,ok,k = 4 amplitude",
        "a,one,b,1.25,3,",
        "b,one,b,2.0,2,1.23456",
    ]
    assert table.table(ROWS).splitlines()[-1] == "| b | one | b | 2 | 2 | 1.23 |"


MINE = """\
of: [paper-e1]
rows:
  as it is: {}
  hard: {liner.law.E: 20.0}
  another blade: {blade: other}
picture: {kind: cells, value: largest amplitude}
"""


@pytest.mark.slow
def test_an_experiment_of_a_user_goes_on_where_it_was(tmp_path):
    project = make_project(tmp_path)
    blades, mine = (
        project.folder / f"workflow/{name}" for name in ("blades", "experiments/mine.yaml")
    )
    (blades / "other.yaml").write_text("base: reference\nprestress: linear\n")
    mine.write_text(MINE)
    target = "results/experiments/mine/table.json"
    assert project.planned(target.replace("table.json", "picture.png"))["experiment_picture"] == 1
    assert project.planned(target)["experiment_block"] == 2
    project.run(target)
    found = read_json(project.folder / target)
    assert [row["row"] for row in found] == ["as it is", "hard", "another blade"]
    assert found[0]["numbers"] != found[1]["numbers"] != found[2]["numbers"]
    mine.write_text(MINE.replace("picture", "  soft: {liner.law.K: 0.3}\npicture"))
    assert project.planned(target) == {"experiment_block": 2, "experiment": 1}
    folder = project.folder / "results/experiments/mine/rows"
    kept = Store(folder).keys
    project.run(target)
    assert kept < Store(folder).keys and len(Store(folder).keys) == 4
    assert read_json(project.folder / target)[:3] == found
    mine.write_text(MINE.replace("20.0", "-1"))
    output = project.run("-n", target, expect=1)
    assert (
        "workflow/experiments/mine.yaml: rows.hard.liner.law.E: -1: " in output
        and "(line 4)" in output
    )
