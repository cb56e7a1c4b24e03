"""A scene with a design in the workflow: its jobs, its tables, and what is marched again."""

import re

import numpy as np
import pytest
from projects import Project, make_project

from simulate.sweeps.dataset import load as load_sweep
from workflow.many.design_tables import load

SCENE = "workflow/scenes/mine.yaml"
TABLE = "workflow/scenes/mine.csv"
FOLDER = "results/paper/mine"
SOBOL = """samples: 2
factors:
  K: {keys: [liner.law.K], between: [0.5, 2]}
  gap: {keys: [clearance.leading_edge_over_span], between: [0.9, 1.1]}
"""


def with_design(folder) -> Project:
    """A project whose only scene has a table of three rows."""
    project = make_project(folder)
    (project.folder / SCENE).write_text(
        "base: paper\ndesign: mine.csv\npeaks: null\nspeeds: {over_f1: [0.32, 0.34]}\n"
    )
    (project.folder / TABLE).write_text("liner.law.K\n0.3\n0.45\n0.9\n")
    project.edit("workflow/config.yaml", lambda config: config.update(scenes=["mine"]))
    return project


def test_the_dry_run_counts_its_blocks_and_draws_no_sweep(tmp_path):
    planned = with_design(tmp_path).planned()
    assert planned["design_block"] == 2 and planned["design"] == 1
    assert not {"sweep", "sweep_block", "fig10", "fig11", "summary"} & set(planned)


def test_a_blade_key_is_said_in_the_dry_run(tmp_path):
    project = with_design(tmp_path)
    (project.folder / TABLE).write_text("liner.law.K,blade.span_mm\n-1,140\n")
    output = project.run("-n", expect=1)
    assert "workflow/scenes/mine.csv: column: 'blade.span_mm': " in output
    (project.folder / TABLE).write_text("liner.law.K,blade\n0.3,nowhere\n")
    output = project.run("-n", expect=1)
    assert "mine.csv: column blade: 'nowhere': no workflow/blades/nowhere.yaml" in output


def rows_marched(project) -> list[str]:
    """Rows that the logs of the blocks name, of their last run."""
    logs = (project.folder / FOLDER / "logs").glob("design-block-*.log")
    return sorted(
        row
        for log in logs
        for row in re.findall(r"^row (\d+), mine: [\d.]+ s", log.read_text(), re.M)
    )


@pytest.mark.nightly
def test_blocks_rows_and_full_records(tmp_path):
    project = with_design(tmp_path)
    said = project.run()
    last = f"Design of scene mine: {FOLDER}/design.csv, results/figures/design-mine.png; 3 rows."
    assert last in said
    table = (project.folder / FOLDER / "design.csv").read_text().splitlines()
    assert len(table) == 1 + 3 and table[0].startswith("row,liner.law.K,largest amplitude (µm)")
    assert (project.folder / "results/figures/design-mine.png").is_file()
    runs = load(project.folder / FOLDER / "design-runs.nc")
    assert runs["row"].values.tolist() == [1, 1, 2, 2, 3, 3]
    assert rows_marched(project) == ["1", "2", "3"]
    assert project.planned() == {}

    project.edit("workflow/config.yaml", lambda config: config.update(blocks=3))
    project.run()
    assert rows_marched(project) == []
    again = load(project.folder / FOLDER / "design-runs.nc")
    np.testing.assert_array_equal(again["wear"], runs["wear"])

    (project.folder / TABLE).write_text("liner.law.K\n2.0\n0.3\n0.45\n0.9\n")
    project.run(f"{FOLDER}/row-3.nc", f"{FOLDER}/design-rows.nc")
    assert rows_marched(project) == ["1"]
    rows = load(project.folder / FOLDER / "design-rows.nc")
    np.testing.assert_array_equal(rows["liner.law.K"], [2.0, 0.3, 0.45, 0.9])
    row = load_sweep(project.folder / FOLDER / "row-3.nc")
    assert row.attrs["name"] == "mine, row 3" and row["speed"].size == 2

    blade = project.folder / "workflow/blades/other.yaml"
    blade.write_text("base: paper\nmaterial: {young_modulus_GPa: 125}\n")
    (project.folder / TABLE).write_text("liner.law.K,blade\n0.3,\n0.3,other\n-1,\n")
    said = project.run(f"{FOLDER}/design.csv")
    assert "warning: 1 of the 1 rows of this block refused; the first: row 3, mine: liner" in said
    assert "design.csv; 3 rows; 1 refused, the first is row 3: liner.law.K: -1: should" in said
    assert rows_marched(project) == ["2"]
    rows = load(project.folder / FOLDER / "design-rows.nc")
    assert rows["f1_Hz"].values[1] > 1.02 * rows["f1_Hz"].values[0] and np.isnan(rows["f1_Hz"][2])
    assert rows["why"].values[2].startswith("liner.law.K: -1: ")

    (project.folder / "workflow/scenes/mine-factors.yml").write_text(SOBOL)
    project.edit(SCENE, lambda scene: scene.update(design="mine-factors.yml"))
    project.run()
    assert (project.folder / "results/figures/sensitivity-mine.png").is_file()
