"""Uncertainties of the numbers at peaks against their errors.

Rows are those of workflow/experiments/bars.yaml.
"""

from statistics import median

import xarray as xr

from rom.model import Rom
from simulate.errors.model_errors import ModelError
from simulate.errors.run import Case
from simulate.marching import prepare
from simulate.sweeps.peak import Peak
from simulate.sweeps.peak_results import at_peak, results, to_march
from workflow.experiment.engine import Marched


def held(runs: xr.Dataset, rom: Rom, reference: Marched | None) -> dict[str, float]:
    """How many numbers are off from the ``reference`` by no more, or by over twice, their +-.

    Of the peaks along engine orders; amplitudes are compared with the largest of the reference at
    the speed of the peak and halfway to those beside it. Mesh and natural modes are the same:
    their part of an uncertainty is left out. CPU time is that of the runs beside the peaks.
    """
    if reference is None:
        return {}
    peaks = [peak for peak in results(runs, rom, ModelError(None, None)) if peak.k]
    off, said = [], []
    for peak in peaks:
        true = _true(peak, reference)
        for name, value in peak.numbers.items():
            off.append(abs(true[name] - value) / peak.errors[name])
            said.append(peak.errors[name] / value)
    return {
        "peaks": len(peaks),
        "numbers": len(off),
        "within": sum(ratio <= 1 for ratio in off),
        "beyond twice": sum(ratio > 2 for ratio in off),
        "median ±": median(said),
        "CPU s of ±": sum(peak.seconds for peak in peaks),
    }


def _true(peak: Peak, reference: Marched) -> dict[str, float]:
    """Numbers of the reference at a peak, and half the spacing of the sweep beside it."""
    scene, rom = to_march(reference.runs), reference.rom
    speeds = [peak.Omega_c + side * peak.spacing for side in (-0.5, 0.0, 0.5)]
    setups = [prepare(scene, rom, min(over_f1 * rom.omega1, rom.Omega_m)) for over_f1 in speeds]
    results = [at_peak(Case(scene, rom, setup), peak.k) for setup in setups]
    return results[1] | {"amplitude": max(result["amplitude"] for result in results)}
