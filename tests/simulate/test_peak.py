"""Peaks along engine orders, on sweeps with known resonances."""

import numpy as np
import pytest
import xarray as xr
from scenes import scene

from simulate import Runs
from simulate.sweeps.crossings import crossing, crossings_of
from simulate.sweeps.peak import peak_of, reported


def test_f1_is_k_times_the_speed_at_the_crossing(coarse_rom):
    unit = 2 * np.pi * coarse_rom.f1
    for k in (4, 6):
        at = crossing(coarse_rom, k)
        assert coarse_rom.modes(at * unit)[0][0] / unit == pytest.approx(k * at, rel=1e-6)
    assert np.isnan(crossing(coarse_rom, 1))


SPEEDS = np.linspace(0.1, 0.4, 301)


TANGENTIAL = {"profile": {"tilt": 0.15}, "tangential": True}


def responding(rom, contact=None, **along):
    """A sweep with resonances, k4=(speed, gaps) ..., along engine orders, 1e-3 gaps elsewhere."""
    case = scene(rounds=10, record__spectrum_rounds=10, contact=contact or {})
    gap, spectrum = 2e-5, np.full((len(SPEEDS), 201), 1e-3)
    for name, (at, gaps) in along.items():
        spectrum[:, 10 * int(name[1:])] += gaps / (1 + ((SPEEDS - at) / 0.002) ** 2)
    return xr.Dataset(
        {"spectrum": (("speed_over_f1", "engine_order"), gap * spectrum)},
        coords={"speed_over_f1": ("speed_over_f1", SPEEDS)},
        attrs={"scene": case.model_dump_json(), "gap_m": gap},
    )


def orders_told(rom, speeds=slice(None), **along):
    """Orders whose peaks are reported, of the sweep or of some of its speeds."""
    runs = responding(rom, **along).isel(speed_over_f1=speeds)
    return sorted(peak.k for peak in reported(runs, rom))


BELOW = SPEEDS <= 0.3395  # the sweep ends where the response is high
REPORTED = [  # peaks, and the orders that are reported
    ({"k4": (0.34, 2.0), "k6": (0.19, 0.5)}, [4, 6]),
    ({"k4": (0.34, 0.09), "k6": (0.19, 0.5)}, [6]),  # low
    ({"k4": (0.34, 2.0), "k6": (0.34, 3.0)}, [6]),  # a side band of order 6, which is the largest
    ({"k4": (0.2, 2.0)}, [4]),  # far from all crossings, and the largest
    ({"k4": (0.2, 2.0), "k9": (0.2, 3.0)}, [9]),
    ({"k4": (0.34, 2.0), "speeds": BELOW}, [4]),
    ({"k4": (0.34, 0.9), "speeds": BELOW}, []),
]


def test_the_crossing_of_a_stiffening_mode_is_that_of_theory():
    """f1^2 = 1 + B Omega^2 meets k Omega at 1 / sqrt(k^2 - B); B > k^2: never."""
    ((mode, k, speed),) = crossings_of(
        lambda speed: np.sqrt([1 + 5.6 * speed**2]), [1, 2, 4], 0.0, 0.4
    )
    assert (mode, k, speed) == (1, 4, pytest.approx(1 / np.sqrt(16 - 5.6), abs=1e-8))


def test_a_peak_along_an_order_has_its_speed_and_height(coarse_rom):
    runs = responding(coarse_rom, k4=(0.34, 2.0), k6=(0.19, 0.5))
    peak = peak_of(runs, coarse_rom, 4)
    assert (peak.k, peak.Omega_c) == (4, pytest.approx(0.34))
    assert peak.amplitude == pytest.approx(2.001)
    assert peak.over_crossing == pytest.approx(0.34 / crossing(coarse_rom, 4))
    assert peak.clear is True and peak.reported and peak.at_end is False  # as JSON takes them
    assert peak_of(runs.isel(speed_over_f1=BELOW), coarse_rom, 4).at_end


@pytest.mark.parametrize(("peaks", "orders"), REPORTED)
def test_peaks_that_are_low_or_coupled_are_not_reported(coarse_rom, peaks, orders):
    assert orders_told(coarse_rom, **peaks) == orders


def test_a_peak_is_reported_of_any_order_that_scene_or_blade_asks_for(coarse_rom):
    """The crossing of EO 17 with f1 is below these speeds, and EO 17 is beyond the usual orders."""
    runs = responding(coarse_rom, k17=(0.14, 2.0)).assign_coords(speed_over_f1=SPEEDS / 2)
    asking = scene(
        rounds=10, record__spectrum_rounds=10, peaks={"orders": [17], "within_over_f1": 1e-3}
    )
    assert reported(runs, coarse_rom) == []
    for attrs in ({"scene": asking.model_dump_json()}, {"orders": [17]}, {"orders": 17}):
        (peak,) = reported(runs.assign_attrs(attrs), coarse_rom)
        assert peak.k == 17 and peak.Omega_c == pytest.approx(0.07)


def test_only_a_tangential_force_may_bring_a_peak_below_the_crossing(coarse_rom):
    below = 0.95 * crossing(coarse_rom, 4)
    radial = responding(coarse_rom, k4=(below, 2.0))
    assert peak_of(radial, coarse_rom, 4).Omega_c > 0.97 * crossing(coarse_rom, 4)
    softened = responding(coarse_rom, TANGENTIAL, k4=(below, 2.0))
    assert peak_of(softened, coarse_rom, 4).Omega_c == pytest.approx(below, abs=1e-3)


def test_a_failed_run_hides_no_peak(coarse_rom):
    runs = responding(coarse_rom, k4=(0.34, 2.0))
    failed = runs.where(runs["speed_over_f1"] != SPEEDS[200])
    assert peak_of(failed, coarse_rom, 4).Omega_c == pytest.approx(0.34)
    assert peak_of(runs.where(runs["speed_over_f1"] < 0), coarse_rom, 4) is None


def test_runs_are_printed_in_a_few_lines(coarse_rom):
    """Speeds, how they ended, and the peaks; not the arrays."""
    runs = responding(coarse_rom, k4=(0.34, 2.0), k6=(0.19, 0.5))
    status = np.where(SPEEDS < 0.11, "diverged", "ok")
    rad_s = 2 * np.pi * coarse_rom.f1 * SPEEDS
    made = runs.assign(status=("speed_over_f1", status), speed=("speed_over_f1", rad_s))
    heading, ends, checks, *peaks = str(
        Runs(made.assign_attrs(blade="coarse"), coarse_rom)
    ).splitlines()
    rpm = 60 * coarse_rom.f1
    assert heading == (f"Runs of blade coarse: 301 speeds, {0.1 * rpm:.0f} to {0.4 * rpm:.0f} rpm")
    assert ends == "diverged: 10, ok: 291"
    assert checks == "checked at 0 of 301 speeds"
    six, four = peaks  # speeds ascending
    assert four.startswith(f"EO 4 mode 1: peak at {0.34 * rpm:.0f} rpm, ")
    assert four.endswith(" times the linear crossing, 2 gaps")
    assert six.startswith("EO 6 mode 1: ")
