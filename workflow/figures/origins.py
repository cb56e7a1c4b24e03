"""Where a figure's numbers come from: blades and scenes, as its inputs say."""

from collections.abc import Iterable
from pathlib import Path

import xarray as xr

from geometry.provenance import Provenance


def origins(paths: Iterable[str | Path]) -> str:
    """Scene, blade, mesh and model of each reduced model and sweep in ``paths``, equal ones once.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When one of them does not say what it was made from.
    """
    read = (_origin(path) for path in paths if Path(path).suffix == ".nc")
    return "; ".join(dict.fromkeys(read))


def _origin(path: str | Path) -> str:
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        attrs = dataset.attrs
    scene = f"scene {attrs['name']}, " if "name" in attrs else ""
    return scene + Provenance.parse(attrs.get("rom") or attrs.get("provenance"), path).told()
