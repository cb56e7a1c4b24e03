"""Figure of Sobol indices: bars of the numbers, with their intervals."""

from types import SimpleNamespace

import numpy as np
import xarray as xr

from simulate.scene.sobol import Sobol, indices
from simulate.sweeps.design_runs import FORMAT, save
from workflow.figures import sensitivity


def test_bars_are_the_indices(tmp_path):
    factors = {name: {"keys": [name], "between": [0.5, 2.0]} for name in ("gap", "K")}
    sobol = Sobol(samples=32, factors=factors)
    points = sobol.points()
    table = xr.Dataset(
        {
            "factors": (("row", "factor"), points),
            "largest_amplitude": ("row", points @ [1.0, 2.0]),
            "largest_wear": ("row", points @ [3.0, 0.0]),
            "not_ok": ("row", np.eye(1, len(points), dtype=int)[0]),
        },
        attrs={"format": FORMAT, "sobol": sobol.model_dump_json()},
    )
    save(table, tmp_path / "rows.nc")
    loaded = sensitivity.load(SimpleNamespace(rows=tmp_path / "rows.nc"))
    drawn = sensitivity.draw(*loaded)
    found = indices(table, ["largest_amplitude", "largest_wear"])
    for i, axes in enumerate(drawn.axes):
        heights = [[bar.get_height() for bar in bars] for bars in axes.containers]
        np.testing.assert_allclose(heights, [found.first[i], found.total[i]])
    assert drawn.legends[0].get_title().get_text() == "128 rows, 1 with runs not ok"
