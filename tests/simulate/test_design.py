"""A table of many runs: its faults, its numbers against single sweeps, and what is run again."""

import json
from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scenes import EXACT, of_steps, scene

from geometry.base import SettingsError
from rom import model
from simulate.__main__ import main
from simulate.errors.accuracy import Choice
from simulate.marching import STATUSES, SceneError
from simulate.scene.design import Design
from simulate.signals import leading_gap, leading_wear, lobe_count
from simulate.sweeps import design_runs
from simulate.sweeps.dataset import load as load_sweep
from simulate.sweeps.design_runs import (
    Engine,
    load,
    march_block,
    merge,
    read_parts,
    row_table,
    save,
    save_part,
)
from simulate.sweeps.peak import along_order, peak_of, reported
from simulate.sweeps.sweep import sweep

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


@pytest.fixture
def engine(coarse_rom, tmp_path) -> Engine:
    return Engine.of(design(tmp_path), coarse_rom)


@pytest.fixture
def marched(monkeypatch):
    """Speeds of the marches of the engine, in order."""
    done, march_one = [], design_runs.march_one

    def counted(case, choice):
        done.append(case.setup.Omega)
        return march_one(case, choice)

    monkeypatch.setattr(design_runs, "march_one", counted)
    return done


def faults(folder, table) -> list[tuple]:
    """Rows, key, value and what is allowed, of each fault of a table: a line each."""
    with pytest.raises(SettingsError) as caught:
        design(folder, table)
    path, found = str(folder / "table.csv"), caught.value.faults
    assert all(fault.file.startswith(path) and "\n" not in str(fault) for fault in found)
    return [(fault.file.removeprefix(path).removeprefix(": "), *fault[1:4]) for fault in found]


def test_a_row_is_the_scene_with_its_values(tmp_path):
    base, scenes = scene(**BASE), design(tmp_path).scenes
    assert scenes[0] == base.but(liner={"law": {"K": 0.3}})
    harmonics = [{"order": 2, "amplitude_gaps": 2.5}]
    speeds = {"over_f1": [0.31, 0.32, 0.35]}
    assert scenes[1] == base.but(casing={"harmonics": harmonics}, speeds=speeds)
    assert scenes[2].peaks.orders == [4] and scenes[2].speeds == base.speeds


def test_null_takes_a_key_away_and_another_kind_replaces_the_law(tmp_path):
    table = "liner.law.E,liner.law.unit_Pa,liner.law.kind,record.history\n3,1e9,elastic,null\n"
    (row,) = design(tmp_path, table).scenes
    assert row.liner.law.model_dump() == {"kind": "elastic", "E": 3.0, "unit_MPa": 1000}
    assert row.record.history is None


SEVERAL = """liner.law.K,damping_ratio,casing.harmonics[3].order,liner.law.KK
-1,,,
0.3,2,,
0.3,,7,
0.3,0.1,,1
0.3,,,2
0.3
"""
FAULTS = {  # table, and its faults
    SEVERAL: [
        ("row 1", "liner.law.K", -1, {"ge": 0}),
        ("row 2", "damping_ratio", 2, {"lt": 1}),
        ("row 3", "casing.harmonics[3].order", "7", None),
        ("rows 4, 5", "liner.law.KK", None, ["K"]),
        ("row 6", "", None, None),
    ],
    "rouns\n" + "1\n" * 500: [("rows 1, 2, 3 and 497 more", "rouns", None, ["rounds"])],
    # no more lines than can be read
    "damping_ratio\n" + "".join(f"{row}\n" for row in range(1, 101)): [
        *((f"row {row}", "damping_ratio", row, {"lt": 1}) for row in range(1, 31)),
        ("", "", None, None),
    ],
    "blade.span\n1\n": [("", "column", "blade.span", None)],
    "blade\nother\n": [("", "column", "blade", None)],
    "accuracy\n0.01\n": [("", "column", "accuracy", None)],
    "rounds,rounds\n1,2\n": [("", "column", "rounds", None)],
    "rounds,\n1,2\n": [("", "column", "", None)],
    "rounds\n": [("", "", None, None)],
    "": [("", "", None, None)],
    'rounds\n"[1"\n': [("row 1", "rounds", "[1", None)],
}


@pytest.mark.parametrize("table", FAULTS, ids=lambda table: table[:20])
def test_all_faults_are_one_message_with_row_and_column(tmp_path, table):
    assert faults(tmp_path, table) == FAULTS[table]


def test_rows_that_do_not_fit_the_model_are_refused_before_any_march(coarse_rom, tmp_path, marched):
    table = 'speeds.over_f1,rounds\n"[0.3, 0.9]",\n'
    error = refused(SettingsError, Engine.of, design(tmp_path, table), coarse_rom)
    assert (error.key, error.value) == ("speeds.over_f1", 0.9)
    explicit = '"{scheme: central-difference, steps_per_round: 640}"'
    table = f"integrator\n{explicit}\n{explicit}\n"
    engine = Engine.of(design(tmp_path, table), coarse_rom)
    error = refused(SettingsError, march_block, engine, tmp_path / "parts")
    assert (error.key, error.value) == ("integrator.steps_per_round", 640)
    assert marched == []


def test_rows_have_the_numbers_of_their_sweeps(engine, coarse_rom, tmp_path):
    """Each row beside the sweep of its scene; peaks with the same speeds and amplitudes."""
    runs = march_block(engine, tmp_path / "parts")
    rows = row_table(engine, runs)
    for row, case in enumerate(engine.design.scenes, 1):
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


def test_a_run_takes_some_200_bytes(engine, tmp_path):
    assert engine.row_type.itemsize <= 200
    path, runs = tmp_path / "runs.nc", np.zeros(5000, engine.row_type)
    save(design_runs._table({1: runs}, engine.orders), path)
    assert path.stat().st_size <= 200 * len(runs)


def same(one, other):
    for name in set(one) - {"seconds"}:
        np.testing.assert_array_equal(one[name], other[name])


@pytest.fixture
def done(engine, tmp_path, marched):
    """All runs marched once into parts; ``marched`` tells those that are marched again."""
    runs = march_block(engine, tmp_path / "parts")
    assert len(marched) == runs.sizes["run"]
    marched.clear()
    return runs


def test_a_killed_block_goes_on_at_the_row_where_it_was(
    engine, done, tmp_path, marched, monkeypatch
):
    said, rows = [], len(engine.design.scenes)
    monkeypatch.setattr(design_runs, "SAVED_EVERY", 0.0)

    def killed(line):
        said.append(line)
        if line.startswith("row 2") and len(said) == 2:
            raise SystemExit

    with pytest.raises(SystemExit):
        march_block(engine, tmp_path / "again", report=killed)
    assert 0 < len(marched) < done.sizes["run"]
    same(march_block(engine, tmp_path / "again", report=killed), done)
    assert len(marched) == done.sizes["run"]
    assert len(said) == rows and f"; design 2 of {rows}, " in said[1]


def test_a_part_that_was_not_saved_is_all_that_a_kill_loses(engine, tmp_path, monkeypatch):
    """Without the save of an orderly end, rows up to the last save are there."""
    monkeypatch.setattr(design_runs, "SAVED_EVERY", 0.0)
    saves = []

    def dying(folder, rows, orders):
        if saves:
            raise SystemExit
        saves.append(list(rows))
        save_part(folder, rows, orders)

    monkeypatch.setattr(design_runs, "save_part", dying)
    with pytest.raises(SystemExit):
        march_block(engine, tmp_path / "parts")
    assert [*read_parts(tmp_path / "parts", engine.row_type)] == saves[0] == [engine.keys[0]]


def test_the_rows_of_a_damaged_part_are_marched_again(engine, done, tmp_path, marched):
    """Not what a process was writing when it was killed: that is no part."""
    (part,) = (tmp_path / "parts").glob("*.nc")
    data = part.read_bytes()
    part.with_name(f".{part.stem}.123.nc").write_bytes(data[:2000])
    march_block(engine, part.parent)
    assert marched == []
    part.write_bytes(data[:-100])
    for _ in range(2):  # once
        same(march_block(engine, part.parent), done)
        assert len(marched) == done.sizes["run"]


def test_a_part_of_many_short_rows(engine, tmp_path):
    """Their keys, an attribute of the file, take more than the 64 kB of a usual header."""
    rows = {f"{number:016x}": np.zeros(1, engine.row_type) for number in range(8000)}
    save_part(tmp_path / "parts", rows, engine.orders)
    assert list(read_parts(tmp_path / "parts", engine.row_type)) == list(rows)


def test_another_number_of_blocks_and_more_rows_run_nothing_again(
    engine, coarse_rom, done, tmp_path, marched
):
    for folder in ("parts", "blocks"):
        same(merge([march_block(engine, tmp_path / folder, k, 2) for k in range(2)]), done)
    assert len(marched) == done.sizes["run"]  # of the new folder
    for blocks in (1, 3):
        parts = [march_block(engine, tmp_path / "blocks", k, blocks) for k in range(blocks)]
        same(merge(parts), done)
    first, *others = TABLE.splitlines()
    reordered = "\n".join([first, "0.9,,,", *reversed(others)])
    more = Engine.of(design(tmp_path, reordered), coarse_rom)
    runs = march_block(more, tmp_path / "blocks")
    assert len(marched) == done.sizes["run"] + 4  # the speeds of the new row
    of_row = [done.isel(run=done["row"].values == row) for row in (1, 2, 3)]
    old = [rows.assign(row=5 - rows["row"]) for rows in of_row]
    same(runs.isel(run=runs["row"].values > 1), merge(old))


def test_another_model_or_code_runs_all_again(engine, done, tmp_path, marched, monkeypatch):
    monkeypatch.setattr(design_runs, "code_hash", lambda module: "other")
    march_block(Engine.of(engine.design, engine.rom), tmp_path / "parts")
    assert len(marched) == done.sizes["run"]


def test_modes_of_shared_speeds_are_found_once(coarse_rom, tmp_path, monkeypatch):
    found, solve = [], model.eigh
    monkeypatch.setattr(model, "eigh", lambda K, M: found.append(K.tobytes()) or solve(K, M))
    engine = Engine.of(design(tmp_path), replace(coarse_rom))  # one that has kept none
    march_block(engine, tmp_path / "parts")
    assert len(found) == len(set(found)) > 0


def test_checks_take_a_tenth_of_the_steps_of_rows_run_together(coarse_rom, tmp_path):
    """Of rows with a single speed the first, which touches, then every fifth."""
    rows = [f'{0.3 + row / 100},"[0.31]"' for row in range(12)]
    table = "\n".join(["liner.law.K,speeds.over_f1", *rows, ""])
    case = design(tmp_path, table, check=0.1, integrator=of_steps(768))  # less than a footprint
    runs = march_block(Engine.of(case, coarse_rom), tmp_path)
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
    engine = Engine.of(table, coarse_rom, replace(choice, runs=wrong))
    runs = march_block(engine, tmp_path / "parts")
    swept = sweep(table.scenes[0], coarse_rom, choice=choice)
    assert runs["error"].values == pytest.approx(swept["error"].max("observable").values, rel=1e-6)
    assert 0 < runs["error"] < 1
    np.testing.assert_allclose(runs["wear"], leading_wear(swept).max(axis=1), rtol=1e-6)


@pytest.fixture
def files(coarse_rom, tmp_path):
    """Reduced model, scene and table on disk; returns the command's arguments."""
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "table.csv").write_text("liner.law.K\n0.3\n0.6\n")
    base = scene(**BASE, design="table.csv").model_dump(mode="json", exclude_unset=True)
    (tmp_path / "scene.yaml").write_text(json.dumps(base))  # JSON is YAML
    return [str(tmp_path / "rom.nc"), str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out.nc")]


def test_the_command_line_writes_both_tables_and_one_row_in_full(files, tmp_path, marched):
    assert main(files) == 0
    runs, rows = load(tmp_path / "out-runs.nc"), load(tmp_path / "out-rows.nc")
    assert runs["row"].values.tolist() == [1] * 4 + [2] * 4
    np.testing.assert_array_equal(rows["liner.law.K"], [0.3, 0.6])
    total = len(marched)
    assert main(files) == 0 and len(marched) == total
    assert main([*files, "--row", "2"]) == 0
    swept = load_sweep(tmp_path / "out.nc")
    second = runs.isel(run=runs["row"].values == 2)
    np.testing.assert_allclose(leading_wear(swept).max(axis=1), second["wear"], rtol=1e-6)


@pytest.mark.parametrize(
    ("table", "more"),
    [
        ("liner.law.K,blade.x\n-1,2\n", []),
        ("liner.law.K\n0.3\n0.6\n", ["--row", "0"]),
        ("liner.law.K\n0.3\n0.6\n", ["--row", "3"]),  # of two
    ],
)
def test_faults_of_a_table_and_of_its_row_leave_no_file(files, tmp_path, capsys, table, more):
    (tmp_path / "table.csv").write_text(table)
    before = sorted(tmp_path.iterdir())
    assert main([*files, *more]) == 2
    assert ("row" if more else "table.csv: column: 'blade.x': ") in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before
