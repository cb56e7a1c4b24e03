"""Results at the peaks of a sweep, with their uncertainty."""

from typing import Any

from geometry.base import Say, read_json
from rom.model import Rom
from simulate.errors.model_errors import ModelErrors, SecondOrder
from simulate.sweeps.dataset import load, require_rom
from simulate.sweeps.peak_results import of_sweep, results, worst_stressed


def find(
    sweep: str, rom: str, check: str, mesh_error: str, start: str, stress: str, tell: Say
) -> dict[str, Any]:
    """Peak results of a sweep; its start, and files of its model and stresses may be missing."""
    runs, model = load(sweep), Rom.load(rom)
    require_rom(runs, model)
    model_errors = ModelErrors.of(check, mesh_error, model).frequencies
    second_order = SecondOrder.of(check) if check else None
    before, stresses = load(start) if start else None, read_json(stress) if stress else None
    given = runs, model, model_errors, before, tell, second_order, stresses
    peaks = results(*given)
    worst = results(*given, worst_stressed(runs, stresses, peaks))
    return of_sweep(runs, model, model_errors, peaks, worst)
