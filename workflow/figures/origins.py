"""Provenance of a figure: blades and scenes of its input files."""

from collections.abc import Iterable
from pathlib import Path

import xarray as xr

from geometry.provenance import Provenance


def origins(paths: Iterable[str | Path]) -> str:
    """Scene, blade, mesh and model of each reduced model and sweep in ``paths``, without repeats.

    Raises
    ------
    geometry.provenance.ProvenanceError
        When a file holds no provenance.
    """
    read = (_origin(path) for path in paths if Path(path).suffix == ".nc")
    return "; ".join(dict.fromkeys(read))


def _origin(path: str | Path) -> str:
    with xr.open_dataset(path, engine="h5netcdf") as dataset:
        attrs = dataset.attrs
    scene = f"scene {attrs['name']}, " if "name" in attrs else ""
    return scene + Provenance.parse(attrs.get("rom") or attrs.get("provenance"), path).summary()
