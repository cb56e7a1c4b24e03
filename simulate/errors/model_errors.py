"""Relative errors of a reduced model: against its full model, and of its mesh."""

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from geometry.base import ProvenanceError, anew, read_json
from geometry.stored import opened
from rom.model import Rom


class ModelError(NamedTuple):
    """Relative uncertainties of a model."""

    basis: float | None  # largest error in the check of the reduced model; None without one
    mesh: float | None  # of the mesh; None where no coarser one was tried


class ModelErrors(NamedTuple):
    """Errors of a reduced model, and why that of its mesh could not be found, if so."""

    frequencies: ModelError = ModelError(None, None)  # of natural frequencies
    largest: ModelError = ModelError(None, None)  # of frequencies and tip compliances
    no_mesh: str = ""

    @classmethod
    def of(cls, check: str | Path, mesh: str | Path | None, rom: Rom) -> "ModelErrors":
        """From ``rom-check-*.nc``, and from ``mesh-error.json`` where there is one.

        A model from elsewhere has neither: its full model is not known.

        Raises
        ------
        geometry.base.provenance.ProvenanceError
            When there is no check, a file is damaged, or belongs to another model or mesh.
        """
        if rom.elsewhere:
            return cls()
        of_mesh = _of_mesh(mesh, rom) if mesh and Path(mesh).is_file() else {}
        with opened(check, "check of a reduced model") as (checked, provenance):
            provenance.require(rom.provenance, check)
            frequencies = abs(checked["reduced"].values / checked["full"].values - 1)
            largest = np.max([frequencies.max(), abs(checked["compliance_error"]).max()])
        return cls(
            ModelError(float(np.nanmax(frequencies)), of_mesh.get("frequencies")),
            ModelError(float(largest), of_mesh.get("error")),
            of_mesh.get("why", ""),
        )


def _of_mesh(path: str | Path, rom: Rom) -> dict[str, Any]:
    """Errors of the mesh of a reduced model: of `frequencies`, and the largest, `error`."""
    values = read_json(path)
    if not isinstance(values, dict) or not isinstance(values.get("error", ""), float | None):
        raise ProvenanceError(f"holds no error of a mesh; {anew(path)}", file=path)
    if values["error"] is None and not values.get("why"):
        raise ProvenanceError(f"says no reason why it holds no error; {anew(path)}", file=path)
    if values.get("mesh") != rom.provenance.mesh:
        raise ProvenanceError(f"belongs to another mesh; {anew(path)}", file=path)
    return values
