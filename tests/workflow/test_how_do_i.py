"""The recipes of the page: files are planned and run on the coarse blade, Python is pasted."""

import re

import pytest
import xarray as xr
from projects import ROOT

from geometry.base import read_json
from workflow.readme import printed

PAGE = (ROOT / "workflow/how-do-i.md").read_text()
FILES = dict(re.findall(r"```(?:yaml|text)\n# (\S+)\n(.*?)```", PAGE, re.DOTALL))
PYTHON = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text() + PAGE, re.DOTALL)
NAMES = [
    path.split("/")[-1].removesuffix(".yaml") for path in FILES if re.search("/scenes/.*yaml", path)
]
OF_REFERENCE = ("my-run-up", "my-liner", "my-orbit", "my-casing", "my-gauges", "my-wakes")


@pytest.fixture(scope="module")
def with_files(swept):
    """The project with its sweeps, and the files of the page."""
    for path, text in FILES.items():
        (swept.folder / path).write_text(text)
    return swept


@pytest.mark.slow
def test_the_first_page_shows_what_the_terminal_prints_of_the_first_scene(project):
    shown = printed(read_json(project.folder / "results/summary.json"))
    assert shown.startswith("```\npaper-e1: blade paper") and "paper-e10" not in shown
    assert re.search(r"^EO +mode +rpm ", shown, re.MULTILINE)


def test_the_page_has_over_a_dozen_recipes():
    assert len(re.findall(r"^## \.\.\. .*\?$", PAGE, re.MULTILINE)) == 17


def test_files_of_the_page_are_planned(with_files):
    planned = with_files.planned("--config", f"scenes=[{', '.join(NAMES)}]")
    assert (planned["sweep"], planned["design"]) == (len(NAMES) - 2, 2)
    assert with_files.planned("results/my-engine/rom-r.nc")["reduce"] == 1


@pytest.mark.nightly
def test_files_of_the_page_give_results(with_files):
    """All but the accuracy, which the coarse mesh cannot reach."""
    sweeps = [f"results/paper/{name}/sweep.nc" for name in NAMES if name in OF_REFERENCE]
    with_files.run(
        *sweeps,
        "results/hot/my-hot/sweep.nc",
        "results/figures/haigh-my-margin.png",
        "results/my-alloy/my-margin/stress.vtu",
        "results/paper/my-table/design.csv",
        "results/figures/design-my-table.png",
        "results/paper/my-scatter/quantiles.csv",
        "results/figures/distribution-my-scatter.png",
        "results/figures/campbell-my-engine.png",
        "results/figures/forced-my-wakes.png",
        "results/paper/my-gauges/gauges.csv",
        "results/figures/gauges-my-gauges.png",
    )
    with xr.open_dataset(
        with_files.folder / "results/paper/my-gauges/sweep.nc", engine="h5netcdf"
    ) as runs:
        grids, rounds = ["root", "mid-0", "mid-45", "mid-90"], 2
        assert runs["gauge"].values.tolist() == grids
        assert runs["gauge_strain"].shape == (3, 4, rounds * 128)
        strain, stress = (abs(runs[f"gauge_{of}_static"]).max() for of in ("strain", "stress"))
        assert 1e-5 < strain < 2e-3 and 1e6 < stress < 2e8
    lines = (with_files.folder / "results/paper/my-gauges/gauges.csv").read_text().splitlines()
    assert len(lines) == 1 + 3 * len(grids) and "static strain (µε)" in lines[0]


@pytest.mark.parametrize("code", PYTHON, ids=range(len(PYTHON)))
def test_python_of_the_page_runs_as_pasted(code, with_files):
    said = with_files.python("-W", "error", "-c", code)
    for written in re.findall(r"\"(\w+\.(?:npz|csv|png|nc))\"", code):
        assert (with_files.folder / written).is_file()
    if "mine.nc" in code:
        with xr.open_dataset(with_files.folder / "mine.nc", engine="h5netcdf") as saved:
            assert "__main__:PerfectlyPlastic" in saved.attrs["scene"]
    if "deepest wear" in code:
        assert 0.1 < float(re.search(r"deepest wear ([\d.]+) µm", said)[1]) < 100
