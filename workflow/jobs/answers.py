"""Answers at the peaks of a sweep, with their uncertainty."""

from typing import Any

from geometry.project import Say
from rom.model import Rom
from simulate.errors.model_errors import ModelErrors
from simulate.sweeps.dataset import load, require_rom
from simulate.sweeps.peak_results import of_sweep, results


def find(
    sweep: str, rom: str, check: str, mesh_error: str, start: str, tell: Say
) -> dict[str, Any]:
    """Answers of a sweep; the files from ``check`` on are empty where the scene has none."""
    runs, model = load(sweep), Rom.load(rom)
    require_rom(runs, model)
    doubt = ModelErrors.of(check, mesh_error, model).frequencies
    found = results(runs, model, doubt, load(start) if start else None, tell)
    return of_sweep(runs, model, doubt, found)
