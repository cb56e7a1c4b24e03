"""A table of many runs: its faults, its numbers against single sweeps, and what is run again."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from refused import refused
from scenes import EXACT, of_steps, scene

from geometry.base import ProvenanceError, SettingsError
from rom import model
from simulate.__main__ import main
from simulate.errors.accuracy import Choice
from simulate.marching import STATUSES, SceneError
from simulate.signals import leading_gap, leading_wear, lobe_count
from simulate.sweeps.peak import along_order, peak_of, reported
from simulate.sweeps.sweep import sweep
from workflow.figures.designs import csv, draw
from workflow.many import design as of_design, design_rows, engine
from workflow.many.design import Design
from workflow.many.design_rows import run_type
from workflow.many.design_tables import load, save, tables
from workflow.many.engine import march_block
from workflow.many.expected import expected
from workflow.many.table import last_words

SPEEDS = {"first": 0.3, "last": 0.36, "count": 4}
BASE = {"integrator": EXACT, "speeds": {"over_f1": SPEEDS}, "liner__law__unit_MPa": 200}
TABLE = """liner.law.K,casing.harmonics[0].amplitude_gaps,speeds.over_f1,peaks
0.3,,,
0.45,2.5,"[0.31, 0.32, 0.35]",
,1.5,,"{orders: [4], within_over_f1: 5.0e-3}"
"""


def design(folder, table=TABLE, **changes) -> Design:
    (folder / "table.csv").write_text(table)
    return Design.of(scene(**BASE | changes).but(design="table.csv"), folder / "scene.yaml")


def scenes_of(table) -> list:
    return [row.scene for row in table.rows()]


def block_of(table, rom, folder, block=0, blocks=1, **more) -> list:
    """A block of the rows, as a job marches it."""
    chosen = range(block, table.count, blocks)
    return written(
        march_block(table.rows(chosen), folder, len(chosen), models={"coarse": rom}, **more)
    )


def written(entries) -> list:
    """The entries of a block as its file has them, beside the store."""
    return json.loads(json.dumps(entries))


def made(table, rom, folder, blocks=1, choice=None) -> tuple[xr.Dataset, xr.Dataset]:
    """Both tables, of rows in so many blocks."""
    done = [block_of(table, rom, folder, block, blocks, choice=choice) for block in range(blocks)]
    return tables(table, rom, done, folder, choice)


@pytest.fixture
def three(tmp_path) -> Design:
    return design(tmp_path)


@pytest.fixture
def marched(monkeypatch):
    """Speeds of the marches of rows, in order."""
    done, march_one = [], design_rows.march_one

    def counted(case, choice):
        done.append(case.setup.Omega)
        return march_one(case, choice)

    monkeypatch.setattr(design_rows, "march_one", counted)
    return done


def faults(folder, table) -> list[tuple]:
    """Key, value and what is allowed, of each fault of a table: a line each."""
    with pytest.raises(SettingsError) as caught:
        design(folder, table)
    path, found = str(folder / "table.csv"), caught.value.faults
    assert all(fault.file.startswith(path) and "\n" not in str(fault) for fault in found)
    return [fault[1:4] for fault in found]


def test_a_row_is_the_scene_with_its_values(tmp_path):
    base, scenes = scene(**BASE), scenes_of(design(tmp_path))
    assert scenes[0] == base.but(liner={"law": {"K": 0.3}})
    harmonics = [{"order": 2, "amplitude_gaps": 2.5}]
    speeds = {"over_f1": [0.31, 0.32, 0.35]}
    assert scenes[1] == base.but(casing={"harmonics": harmonics}, speeds=speeds)
    assert scenes[2].peaks.orders == [4] and scenes[2].speeds == base.speeds
    assert scenes_of(design(tmp_path, "liner.law.K,rounds\n0.3,\n,\n"))[1] == base


def test_null_takes_a_key_away_and_another_kind_replaces_the_law(tmp_path):
    table = "liner.law.E,liner.law.unit_Pa,liner.law.kind,record.history\n3,1e9,elastic,null\n"
    (row,) = scenes_of(design(tmp_path, table))
    assert row.liner.law.model_dump() == {"kind": "elastic", "E": 3.0, "unit_MPa": 1000}
    assert row.record.history is None


FAULTS = {  # table, and what is refused of it before any row is marched: key, value, allowed
    "rouns\n" + "1\n" * 500: [("rouns", None, ["rounds"])],
    "rounds,liner.law.KK\n3,1\n": [("liner.law.KK", None, ["K"])],
    "rounds,rouns\n3,\n4,5\n": [("rouns", None, ["rounds"])],
    "start\n1\n": [("column", "start", None)],
    "blade.span\n1\n": [("column", "blade.span", None)],
    "accuracy\n0.01\n": [("column", "accuracy", None)],
    "rounds,rounds\n1,2\n": [("column", "rounds", None)],
    "rounds,\n1,2\n": [("column", "", None)],
    "rounds\n": [("", None, None)],
    "": [("", None, None)],
    "rounds;damping_ratio\n1;0.1\n": [("", None, None)],
}


def test_rows_may_differ_in_the_casing_that_moves(tmp_path, coarse_rom):
    table = "casing.modes[0].frequency_Hz,casing.modes[0].modal_mass_kg\n200,0.5\n200,1e12\n,\n"
    modes = [{"order": 2, "frequency_Hz": 400, "modal_mass_kg": 1e12, "damping_ratio": 0.01}]
    speeds = {"speeds": {"over_f1": [0.33]}}
    runs, _ = made(design(tmp_path, table, casing__modes=modes, **speeds), coarse_rom, tmp_path)
    soft, heavy, stiff = runs["displacement"].values
    assert heavy == pytest.approx(stiff, rel=1e-5) and abs(soft / stiff - 1) > 1e-3


@pytest.mark.parametrize("table", FAULTS, ids=lambda table: table[:20])
def test_a_wrong_column_is_refused_before_any_row(tmp_path, table, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert faults(tmp_path, table) == FAULTS[table]


SEVERAL = """liner.law.K,damping_ratio,casing.harmonics[3].order
-1,,
0.3,2,
0.3,,7
0.3
"[1",,
0.9,,
"""


def test_a_row_that_is_not_valid_stays_a_row_with_its_reason(coarse_rom, tmp_path):
    """Of a table that is not valid, of a scene that its model does not allow, and of a step."""
    reasons = ["; ".join(row.refused) for row in design(tmp_path, SEVERAL).rows()]
    keys = ["liner.law.K: -1: ", "damping_ratio: 2: ", "casing.harmonics[3].order: ", "1 cells for"]
    keys += ["liner.law.K: '[1'", ""]
    assert all(key in reason for key, reason in zip(keys, reasons, strict=True))
    explicit = '"{scheme: central-difference, steps_per_round: 640}"'
    table = f'speeds.over_f1,integrator\n"[0.3, 0.9]",\n"[0.3]",\n"[0.3]",{explicit}\n'
    said = []
    several = design(tmp_path, table)
    entries = march_block(several.rows(), tmp_path / "rows", 3, said.append, {"coarse": coarse_rom})
    assert ["key" in entry for entry in entries] == [False, True, False]
    assert said[-1].startswith("warning: 2 of the 3 rows of this block refused; the first: row 1, ")
    runs, rows = tables(several, coarse_rom, [entries], tmp_path / "rows")
    assert runs["row"].values.tolist() == [2]
    assert rows["runs"].values.tolist() == [0, 1, 0] and (rows["status"][0] == -1).all()
    why = rows["why"].values.tolist()
    assert why[0].startswith("speeds.over_f1: 0.9: ") and why[1] == ""
    assert why[2].startswith("integrator.steps_per_round: 640: ")
    save(rows, tmp_path / "rows.nc")
    told = csv(load(tmp_path / "rows.nc")).splitlines()
    assert "why" in told[0] and "speeds.over_f1: 0.9: " in told[1] and len(told) == 4
    (tmp_path / "design.csv").write_text("\n".join(told))
    words = last_words(tmp_path / "design.csv")
    assert words.startswith("3 rows; 2 refused, the first is row 1: speeds.over_f1: 0.9: ")
    drawn = draw(rows)
    assert drawn.legends[0].get_title().get_text() == "3 rows, 2 refused"


def test_a_column_that_one_row_cannot_have_is_no_wrong_column(coarse_rom, tmp_path):
    """Of another law, of a speed beside that of the scene; and speeds that go on in turn."""
    law = "liner.law.kind,liner.law.K,speeds\nelastic,0.4,\n,0.4,\n,,{rpm: [5000]}\n"
    law += ',,"{over_f1: [0.3, 0.31], in_turn: true}"\n'
    reasons = ["; ".join(row.refused) for row in design(tmp_path, law).rows()]
    keys = ["liner.law.K: unknown key", "", "speeds: give exactly one of", "speeds.in_turn: "]
    assert all(key in why for key, why in zip(keys, reasons, strict=True)) and not reasons[1]


def test_values_of_refused_rows_are_numbers_or_nothing(coarse_rom, tmp_path):
    """A text, or a number that no file holds, makes no words of a column; the reason has it."""
    table = design(tmp_path, f"liner.law.K,rounds\n0.3,\nabc,\n{'9' * 400},\n0.4,3\n")
    _, rows = made(table, coarse_rom, tmp_path / "rows")
    np.testing.assert_array_equal(rows["liner.law.K"], [0.3, np.nan, np.nan, 0.4])
    assert rows["rounds"].values.tolist() == [2, 2, 2, 3] and "abc" in rows["why"].values[1]


def test_a_design_without_a_result_says_why(coarse_rom, tmp_path):
    table = design(tmp_path, "damping_ratio\n2\n3\n")
    entries = block_of(table, coarse_rom, tmp_path / "rows")
    error = refused(SettingsError, tables, table, coarse_rom, [entries], tmp_path / "rows")
    assert "damping_ratio: 2: " in error.text and error.key == "row 1"


def test_a_run_that_ends_early_has_its_status_as_reason(coarse_rom, tmp_path):
    """A liner of two micrometres is worn through."""
    _, rows = made(design(tmp_path, "liner.thickness_mm\n0.002\n5\n"), coarse_rom, tmp_path)
    worn, whole = rows["why"].values
    assert "liner-exhausted" in worn and whole == ""
    counts = [int(part.split()[0]) for part in worn.split(", ")]
    assert rows["not_ok"].values.tolist() == [sum(counts), 0] == [4, 0]


def test_rows_are_counted_without_a_scene_of_each(tmp_path, monkeypatch):
    read = []
    check = of_design.check_settings
    monkeypatch.setattr(of_design, "check_settings", lambda *of: read.append(1) or check(*of))
    table = design(tmp_path, "liner.law.K\n" + "0.3\n" * 20_000)
    assert table.count == 20_000 and len(read) == of_design.LOOKED == 100
    (last,) = table.rows({19_999})
    assert last.number == 20_000 and last.scene.liner.law.K == 0.3


def test_the_cost_is_that_of_all_rows(coarse_rom, tmp_path):
    """Of 100 rows of four speeds, every second with three times the revolutions; or of more."""
    steps = 4 * 4 * EXACT["steps_per_round"]
    for rows, off in ((100, 0), (150, 0.1)):
        told = expected(design(tmp_path, "rounds\n" + "2\n6\n" * (rows // 2)), coarse_rom)
        assert told.startswith(f"{rows} rows, some {4 * rows} runs ")
        found = float(re.search(r"([\d.e+]+) steps", told)[1])
        assert found == pytest.approx(rows * steps, rel=off + 0.03)
    steps = {"steps_per_round": 128, "rods_per_round": 127, "strips": 8}
    errors = {"basis_error": 0.0, "mesh_error": None, "expected": 0.0}
    chosen = Choice(accuracy=0.1, **steps, **errors, speeds=[], observed={})
    with_accuracy = {"accuracy": 0.1, "integrator": None, "liner__rods_per_round": None}
    with_accuracy |= {"liner__strips": None, "rounds": 2}
    told = expected(design(tmp_path, "liner.law.K\n0.3\n", **with_accuracy), coarse_rom, chosen)
    assert f": {4 * 2 * 128:.2g} steps" in told
    assert "of 1 that were looked at all are refused" in expected(
        design(tmp_path, "rounds\n-1\n"), coarse_rom
    )


def test_a_row_may_have_another_blade(coarse_rom, tmp_path, monkeypatch):
    """Its numbers are those of the scene on that blade's model."""
    provenance = replace(coarse_rom.provenance, blade="stiff")
    stiffer = replace(coarse_rom, K=1.1 * coarse_rom.K, provenance=provenance)
    table = design(tmp_path, "liner.law.K,blade\n0.3,\n0.3,stiff\n")
    assert table.blades == ("coarse", "stiff")
    models, folder = {"coarse": coarse_rom, "stiff": stiffer}, tmp_path / "rows"
    entries = written(march_block(table.rows(), folder, 2, models=models))
    _, rows = tables(table, coarse_rom, [entries], folder)
    np.testing.assert_allclose(rows["f1_Hz"], [coarse_rom.f1, stiffer.f1])
    assert rows["blade"].values.tolist() == ["coarse", "stiff"]
    alone = [
        (scene(**BASE | {"liner__law__K": 0.3, "blade": name}), models[name]) for name in models
    ]
    wear = [leading_wear(sweep(*one)).max() for one in alone]
    np.testing.assert_allclose(rows["largest_wear"], wear, rtol=1e-6)
    with_accuracy = {"accuracy": 0.01, "integrator": None, "liner__rods_per_round": None}
    with_accuracy |= {"liner__strips": None}
    error = refused(SettingsError, design, tmp_path, "blade\nstiff\n", **with_accuracy)
    assert error.file.endswith(".csv") and "outside the folder" in error.text
    monkeypatch.chdir(tmp_path)
    error = refused(SettingsError, design, tmp_path, "blade\nstiff\n", **with_accuracy)
    assert (error.key, error.value) == ("column", "blade")


def test_rows_have_the_numbers_of_their_sweeps(three, coarse_rom, tmp_path):
    """Each row beside the sweep of its scene; peaks with the same speeds and amplitudes."""
    runs, rows = made(three, coarse_rom, tmp_path / "rows")
    for row, case in enumerate(scenes_of(three), 1):
        swept, of_row = sweep(case, coarse_rom), runs.isel(run=runs["row"].values == row)
        wear, judged = leading_wear(swept), ["along", "beside", "beside_order"]
        # tables know the place of u_r alone; an order without a reported peak has its largest
        told = reported(swept.drop_vars(judged), coarse_rom)
        near_f1 = {k: peak_of(swept, coarse_rom, k) for k in rows["order"].values.tolist()}
        peaks = {k: peak for k, peak in near_f1.items() if peak} | {peak.k: peak for peak in told}
        status = [STATUSES[code] for code in of_row["status"].values]
        exact = {
            "status": (status, swept["status"]),
            "speed": (of_row["speed"], swept["speed"]),
            "lobes": (of_row["lobes"], [lobe_count(profile) for profile in wear]),
        }
        rounded = {
            "wear": (of_row["wear"], wear.max(axis=1)),
            "force": (of_row["force_peak"], np.nanmax(swept["force_peak"], axis=(1, 2))),
        }
        for k in runs["order"].values:
            along = of_row["amplitudes"].sel(order=k).values.astype(float) / leading_gap(swept)
            exact[k] = along, along_order(swept, k)
        assert 4 in peaks
        for k in rows["order"].values:
            at = rows.sel(row=row, order=k)
            assert np.isnan(at["critical_speed"]) == (k not in peaks)
            if k in peaks:
                found = [at[name].item() for name in ("critical_speed", "peak", "reported")]
                assert found == [peaks[k].Omega_c, peaks[k].amplitude, peaks[k].reported]
                rounded[k] = at["wear"], wear.max(axis=1)[peaks[k].index]
        for one, other in exact.values():
            np.testing.assert_array_equal(one, other)
        for one, other in rounded.values():
            np.testing.assert_allclose(one, other, rtol=1e-6)
    assert rows["runs"].values.tolist()[:2] == [4, 3] and rows["runs"][2] > 4  # closed in
    np.testing.assert_array_equal(rows["liner.law.K"], [0.3, 0.45, 0.45])


def test_a_run_takes_some_200_bytes(three, coarse_rom, tmp_path):
    runs, _ = made(three, coarse_rom, tmp_path / "rows")
    assert run_type(runs.sizes["order"]).itemsize <= 200
    many, path = runs.isel(run=np.zeros(5000, int)), tmp_path / "runs.nc"
    save(many, path)
    assert path.stat().st_size <= 200 * 5000


def same(one, other):
    for name in set(one) - {"seconds"}:
        np.testing.assert_array_equal(one[name], other[name])


@pytest.fixture
def done(three, coarse_rom, tmp_path, marched):
    """All runs marched once into a store; ``marched`` tells those that are marched again."""
    runs, _ = made(three, coarse_rom, tmp_path / "rows")
    assert len(marched) == runs.sizes["run"]
    marched.clear()
    return runs


def test_a_kill_loses_the_row_in_progress_alone(three, coarse_rom, done, tmp_path, marched):
    """Rows are written at once; of a line that was cut short, or changed, the row is marched."""
    folder, said = tmp_path / "again", []

    def killed(line):
        said.append(line)
        if line.startswith("row 2") and len(said) == 2:
            raise SystemExit

    models = {"coarse": coarse_rom}
    with pytest.raises(SystemExit):
        march_block(three.rows(), folder, 3, killed, models)
    assert len(marched) == 7 and "; row 2 of 3, " in said[1]
    runs, _ = made(three, coarse_rom, folder)
    same(runs, done)
    assert len(marched) == done.sizes["run"]
    first, last = sorted(folder.iterdir(), key=lambda file: file.stat().st_mtime_ns)
    last.write_bytes(last.read_bytes()[:-1])  # the third row
    first.write_bytes(first.read_bytes().replace(b"0.45", b"0.46", 1).replace(b"3", b"4", 1))
    kept = len(marched)
    for _ in range(2):  # once
        same(made(three, coarse_rom, folder)[0], done)
    assert len(marched) - kept > done.sizes["run"] - 7


def test_another_number_of_blocks_and_more_rows_run_nothing_again(
    three, coarse_rom, done, tmp_path, marched
):
    folder = tmp_path / "rows"
    for blocks in (2, 3, 1):
        same(made(three, coarse_rom, folder, blocks)[0], done)
    assert not marched
    first, *others = TABLE.splitlines()
    reordered = design(tmp_path, "\n".join([first, "0.9,,,", *reversed(others)]))
    runs, _ = made(reordered, coarse_rom, folder)
    assert len(marched) == 4  # the speeds of the new row
    for row in (1, 2, 3):
        new, old = (
            of.isel(run=of["row"].values == at) for of, at in ((runs, 5 - row), (done, row))
        )
        same(new.drop_vars("row"), old.drop_vars("row"))


def test_another_code_runs_all_again(three, coarse_rom, done, tmp_path, marched, monkeypatch):
    monkeypatch.setattr(engine, "code_hash", lambda *modules: "other")
    made(three, coarse_rom, tmp_path / "rows")
    assert len(marched) == done.sizes["run"]


def test_a_store_that_is_gone_is_said(three, coarse_rom, tmp_path):
    entries = block_of(three, coarse_rom, tmp_path / "rows")
    error = refused(ProvenanceError, tables, three, coarse_rom, [entries], tmp_path / "elsewhere")
    assert "3 rows are gone or damaged, the first is 1" in error.text


def test_modes_of_shared_speeds_are_found_once(coarse_rom, tmp_path, monkeypatch):
    found, solve = [], model.eigh
    monkeypatch.setattr(model, "eigh", lambda K, M: found.append(K.tobytes()) or solve(K, M))
    block_of(design(tmp_path), replace(coarse_rom), tmp_path / "rows")  # a model that has kept none
    assert len(found) == len(set(found)) > 0


def test_checks_take_a_tenth_of_the_steps_of_rows_run_together(coarse_rom, tmp_path):
    """Of rows with a single speed the first, which touches, then every fifth."""
    rows = [f'{0.3 + row / 100},"[0.31]"' for row in range(12)]
    table = "\n".join(["liner.law.K,speeds.over_f1", *rows, ""])
    case = design(
        tmp_path, table, verify={"share": 0.1}, integrator=of_steps(768)
    )  # less than a footprint
    runs, _ = made(case, coarse_rom, tmp_path)
    known = np.isfinite(runs["error"].values)
    assert known[0] and 2 <= known.sum() <= 3 and not known[1:4].any()
    assert (runs["status"] == STATUSES.index("ok")).all() and runs["error"].max() < 0.05


def test_an_accuracy_of_the_scene_gives_each_run_its_error(coarse_rom, tmp_path):
    """As in a sweep with the same choice; the pilot's own runs, of the base, are not taken."""
    values = {"liner__law__unit_MPa": 200, "rounds": 1, "accuracy": 0.01, "integrator": None}
    base = scene(**values, liner__rods_per_round=None, liner__strips=None)
    chosen = {"steps_per_round": 2048, "rods_per_round": 509, "strips": 8}
    errors = {"basis_error": 0.0, "mesh_error": None, "expected": 0.0}
    choice = Choice(accuracy=0.01, **chosen, **errors, speeds=[], observed={})
    wrong = dict.fromkeys(base.speeds.omega(coarse_rom.f1))
    (tmp_path / "table.csv").write_text("liner.law.K\n0.9\n")
    with_table = base.but(design="table.csv")
    assert refused(SceneError, sweep, with_table, coarse_rom).key == "design"  # is no sweep
    table = Design.of(with_table, tmp_path / "scene.yaml")
    runs, _ = made(table, coarse_rom, tmp_path / "rows", choice=replace(choice, runs=wrong))
    swept = sweep(scenes_of(table)[0], coarse_rom, choice=choice)
    assert runs["error"].values == pytest.approx(swept["error"].max("observable").values, rel=1e-6)
    assert 0 < runs["error"] < 1
    np.testing.assert_allclose(runs["wear"], leading_wear(swept).max(axis=1), rtol=1e-6)


def test_the_command_line_names_the_way_to_a_design(coarse_rom, tmp_path, capsys):
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "table.csv").write_text("liner.law.K\n0.3\n0.6\n")
    base = scene(**BASE, design="table.csv").model_dump(mode="json", exclude_unset=True)
    (tmp_path / "scene.yaml").write_text(json.dumps(base))  # JSON is YAML
    files = [str(tmp_path / name) for name in ("rom.nc", "scene.yaml", "out.nc")]
    assert main([*files[:2], "-o", files[2]]) == 2
    assert "design: 'table.csv': a table of scenes" in capsys.readouterr().err
    assert not (tmp_path / "out.nc").exists()


@pytest.mark.parametrize("row", [0, 3])  # of two
def test_a_row_that_is_not_there_is_refused(tmp_path, row):
    two = design(tmp_path, "liner.law.K\n0.3\n-1\n")
    assert refused(SettingsError, two.require_row, row).key == f"row {row}"
    assert two.require_row(1).liner.law.K == 0.3
    assert "liner.law.K: -1" in refused(SettingsError, two.require_row, 2).text
