"""Results at the peaks of a sweep, with their uncertainty."""

from typing import Any

from geometry.base import Say
from rom.model import Rom
from simulate.errors.model_errors import ModelErrors, SecondOrder
from simulate.sweeps.dataset import Sweep, require_rom
from simulate.sweeps.peak_results import of_sweep, results, worst_stressed


def find(
    sweep: Sweep,
    rom: Rom,
    check: str,
    mesh_error: str,
    start: Sweep | None,
    stress: dict[str, Any] | None,
    tell: Say,
) -> dict[str, Any]:
    """Peak results of a sweep; ``check`` and ``mesh_error`` are empty where the scene has none."""
    require_rom(sweep, rom)
    model_errors = ModelErrors.of(check, mesh_error, rom).frequencies
    second_order = SecondOrder.of(check) if check else None
    given = sweep, rom, model_errors, start, tell, second_order, stress
    peaks = results(*given)
    worst = results(*given, worst_stressed(sweep, stress, peaks))
    return of_sweep(sweep, rom, model_errors, peaks, worst)
