"""The lines of simulate/README.md that plot the results run on sweeps, and plot them."""

import re
from pathlib import Path

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from runs import swept
from scenes import scene

from simulate.sweeps.dataset import save

README = Path(__file__).parents[2] / "simulate/README.md"


@pytest.fixture
def plotted(coarse_rom, tmp_path, monkeypatch):
    """Names that the lines leave, run in a folder with two sweeps; other speeds in the second."""
    section = README.read_text().split("## What a sweep holds")[1].split("\n## ")[0]
    (lines,) = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    lean = {"rounds": 4, "record__spectrum_rounds": 2}
    for name, E, speeds in (("e1", 1.0, [0.30, 0.34, 0.36]), ("e10", 10.0, [0.30, 0.36, 0.38])):
        runs = swept(scene(**lean, liner__law__E=E, speeds={"over_f1": speeds}), coarse_rom)
        save(runs, tmp_path / f"results/paper/paper-{name}/sweep.nc")
    monkeypatch.chdir(tmp_path)
    names = {}
    with mpl.rc_context({"backend": "agg"}):
        exec(lines, names)
        yield names
        plt.close(names["figure"])
    for name in ("soft", "stiff"):
        names[name].close()


def test_results_are_plotted_from_the_files_alone(plotted, tmp_path):
    assert (tmp_path / "results.png").stat().st_size > 1e4
    orders, wear, more = (plotted[name] for name in ("orders", "map_of_wear", "more"))
    assert len(orders.lines) == 2 and wear.collections and len(more.lines) == 1
    soft, stiff = plotted["soft"], plotted["stiff"]
    along = stiff["spectrum"].values[:, 8] / soft.attrs["gap_m"]  # two rounds: k = 4 is bin 8
    np.testing.assert_allclose(orders.lines[0].get_ydata(), along)
    shared, deeper = more.lines[0].get_data()
    assert shared == pytest.approx([0.30, 0.36])
    deepest = [runs["wear"].values[i].max() for runs, i in ((stiff, 1), (soft, 2))]
    assert deeper[1] == pytest.approx(1e6 * (deepest[0] - deepest[1]), rel=1e-6)
    assert "rad" in wear.get_xlabel() and "f1(0)" in more.get_xlabel()
