"""Provenance of a figure: blades and scenes of its input files."""

from collections.abc import Iterable
from pathlib import Path

from geometry.project import Provenance
from rom.stored import read


def origins(paths: Iterable[str | Path]) -> str:
    """Scene, blade, mesh and model of each reduced model and sweep in ``paths``, without repeats.

    Raises
    ------
    geometry.project.provenance.ProvenanceError
        When a file holds no provenance.
    """
    found = (_origin(path) for path in paths if Path(path).suffix == ".nc")
    return "; ".join(dict.fromkeys(found))


def _origin(path: str | Path) -> str:
    with read(path, "sweep or model") as dataset:
        attrs = dataset.attrs
    scene = f"scene {attrs['name']}, " if "name" in attrs else ""
    return scene + Provenance.parse(attrs.get("rom") or attrs.get("provenance"), path).summary()
