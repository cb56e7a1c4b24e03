"""Peaks of any order, mode and place, on sweeps whose signals are made; free vibrations."""

import numpy as np
import pytest
import xarray as xr
from scenes import scene
from scipy.signal import find_peaks

from geometry.tip import JUDGED
from rom.crossings import crossing
from simulate import Runs
from simulate.signals import lines, maxima, spectrum
from simulate.sweeps.peak import peak_of, reported, rise

ROUNDS, SAMPLES, GAP, ZETA = 10, 256, 2e-5, 0.002
TURNS = 2 * np.pi * np.arange(ROUNDS * SAMPLES) / SAMPLES  # Omega t, of the revolutions recorded
TWO, THREE = ([{"order": n, "amplitude_gaps": 1.0}] for n in (2, 3))


def resonance(speed, at, height, width=0.004):
    """Amplitude of a resonance over the speed."""
    return height / np.hypot(1, (speed - at) / width / at * 2)


def made(signals, speeds, harmonics=TWO, **changes):
    """A sweep whose displacements over the gap (samples, 3), at ``JUDGED``, are made by speed."""
    case = scene(
        rounds=20,
        damping_ratio=ZETA,
        record={"samples_per_round": SAMPLES, "spectrum_rounds": ROUNDS},
        **{"casing__harmonics": harmonics} | changes,
    )
    driven = case.casing.drives(np.arange(1, 101))
    each = [np.broadcast_to(signals(speed), (3, len(TURNS))).T for speed in speeds]
    found = [lines(GAP * signal, ROUNDS, lambda _: ZETA, driven) for signal in each]
    bins = [GAP * spectrum(signal[:, 0]) for signal in each]
    runs = {
        "spectrum": (("speed_over_f1", "engine_order"), bins),
        "along": (("speed_over_f1", "judged", "order"), [of["along"] for of in found]),
        "beside": (("speed_over_f1", "judged"), [of["beside"] for of in found]),
        "beside_order": (("speed_over_f1", "judged"), [of["beside_order"] for of in found]),
        "free": ("speed_over_f1", [of["free"] for of in found]),
    }
    attrs = {"scene": case.model_dump_json(), "gap_m": GAP}
    return xr.Dataset(runs, {"speed_over_f1": speeds}, attrs)


def told(runs, rom):
    """Order, modes, place and speed of each reported peak."""
    return [(of.k, tuple(of.modes), of.place, of.Omega_c) for of in reported(runs, rom)]


def around(at, count=41):
    """Speeds about one, which is among them."""
    return at * np.linspace(0.9, 1.1, count)


def along(k, amplitude, phase=0.3):
    """A response along an engine order, beside the forced one of two lobes."""
    return 0.4 * np.cos(2 * TURNS) + amplitude * np.cos(k * TURNS + phase)


def test_a_resonance_of_mode_2_is_a_peak_of_mode_2(coarse_rom):
    at = 1.02 * crossing(coarse_rom, 12, mode=2)
    runs = made(lambda speed: along(12, resonance(speed, at, 0.6)), around(at))
    assert told(runs, coarse_rom) == [(12, (2,), JUDGED[0], pytest.approx(at))]
    (peak,) = reported(runs, coarse_rom)
    assert peak.amplitude == pytest.approx(0.6, rel=1e-3)
    assert peak.over_crossing == pytest.approx(1.02)


def test_two_modes_that_cross_near_each_other_are_both_named(coarse_rom, monkeypatch):
    at = 0.3
    monkeypatch.setattr(
        "simulate.sweeps.peak.crossing",
        lambda rom, k, mode: {2: at / 1.02, 3: at / 1.06}.get(mode, np.nan),
    )
    runs = made(lambda speed: along(8, resonance(speed, at, 0.6)), around(at))
    assert told(runs, coarse_rom) == [(8, (2, 3), JUDGED[0], pytest.approx(at))]
    assert reported(runs, coarse_rom)[0].name == "EO 8 mode 2 or 3"


@pytest.mark.parametrize("at_leading", [0.0, 0.2, 0.3])
def test_a_mode_that_stands_still_at_the_leading_edge_is_told_where_it_moves(
    coarse_rom, at_leading
):
    """Below a quarter of the amplitude at 15/16 the leading place is near a node."""
    at, share = 1.05 * crossing(coarse_rom, 4), np.array([at_leading, 1.0, 0.5])

    def signals(speed):
        return 0.1 * np.cos(2 * TURNS) + np.outer(share, along(4, resonance(speed, at, 2.0)))

    ((k, modes, place, Omega_c),) = told(made(signals, around(at)), coarse_rom)
    assert (k, modes, Omega_c) == (4, (1,), pytest.approx(at))
    assert place == (JUDGED[0] if at_leading > 0.25 else JUDGED[1])


@pytest.mark.parametrize(("harmonics", "band"), [(TWO, 6), (THREE, 7)])
def test_side_bands_are_those_of_the_casings_lobes(coarse_rom, harmonics, band):
    """EO 4 with its band two or three orders beside, which another casing does not couple."""
    at = 1.05 * crossing(coarse_rom, 4)

    def signals(speed):
        size = resonance(speed, at, 2.0)
        return (
            size * np.cos(4 * TURNS) + size / 2 * np.cos(6 * TURNS) + size / 3 * np.cos(7 * TURNS)
        )

    runs = made(signals, around(at), harmonics).assign_attrs(modes=2, orders=[4, 6, 7])
    no_crossing = {k for k in (6, 7) if not any(c == k for c, *_ in told(runs, coarse_rom))}
    assert 4 in {k for k, *_ in told(runs, coarse_rom)} and band in no_crossing


BUMPS = np.maximum(np.cos(5 * np.radians(np.arange(0, 361, 2))), 0) ** 3


def test_a_casing_table_of_five_bumps_excites_and_couples_multiples_of_five(coarse_rom):
    depth = (30e-6 * BUMPS).tolist()
    table = {"theta_deg": np.arange(0.0, 361.0, 2).tolist(), "depth_m": depth}
    case = scene(casing__harmonics=None, casing__table=table).casing
    bands = dict.fromkeys((25, 30, 35, 40), "side band")
    assert case.orders == {5, 10, 15, 20}
    assert case.excites == dict.fromkeys((5, 10, 15, 20), "casing") | bands
    at = 1.05 * crossing(coarse_rom, 5)

    def signals(speed):
        size = resonance(speed, at, 2.0)
        return size * np.cos(5 * TURNS) + 0.4 * size * np.cos(10 * TURNS)

    runs = made(signals, around(at), None, casing__table=table)
    assert [k for k, *_ in told(runs, coarse_rom)] == [5]  # EO 10 is a side band of it


@pytest.mark.parametrize(("order", "modes"), [(3.4, ()), (4.8, (1,))])
def test_a_steady_line_on_no_integer_order_is_the_only_peak(coarse_rom, order, modes):
    """Mode 1 meets 3.4 Omega above the model's highest speed: no crossing explains it.

    EO 5 has the skirt of 4.8 alone: beside a line twice as strong nothing is on an order.
    """
    at = 1.05 * crossing(coarse_rom, order) if modes else 0.38

    def signals(speed):
        return 0.3 * np.cos(2 * TURNS) + resonance(speed, at, 1.5) * np.cos(order * TURNS)

    runs = made(signals, around(at))
    assert told(runs, coarse_rom) == [(order, modes, JUDGED[0], pytest.approx(at))]
    assert not runs["free"].any()


@pytest.mark.parametrize("order", [4.4, 7.0, 7.3])
def test_a_decaying_start_is_no_peak(coarse_rom, order):
    """A free vibration, also where it passes through an order that two lobes do not drive."""
    at = 1.01 * crossing(coarse_rom, order)

    def signals(speed):
        x = order * at / speed  # of a fixed frequency
        return 0.2 * np.cos(2 * TURNS) + 1.5 * np.cos(x * TURNS) * np.exp(-ZETA * x * TURNS)

    runs = made(signals, around(at))
    assert told(runs, coarse_rom) == [] and runs["free"].mean() > 0.8


@pytest.mark.parametrize("rounds", [4, 5, 10, 13])
def test_a_line_lasts_that_falls_by_less_than_half_of_what_damping_takes(rounds):
    """Along orders that the casing drives by less than nine tenths of it."""
    turns, driven = 2 * np.pi * np.arange(rounds * SAMPLES) / SAMPLES, np.arange(1, 17) % 2 == 0
    for k, last in ((7, 0.5), (8, 0.9)):
        for share in (last - 0.1, last + 0.1):
            free = np.exp(-ZETA * k * turns)
            signal = (1 - share + share * free) * np.cos(k * turns)
            found = lines(signal[:, None], rounds, lambda _: ZETA, driven)["along"][0, k - 1]
            assert bool(found > 0) is (share < last)


def test_along_an_order_that_the_casing_drives_a_rub_that_ends_is_a_peak(coarse_rom):
    at = 1.05 * crossing(coarse_rom, 6)

    def signals(speed):
        dying = resonance(speed, at, 1.5) * np.exp(-0.8 * ZETA * 6 * TURNS)  # not as free
        return 0.2 * np.cos(2 * TURNS) + dying * np.cos(6 * TURNS)

    assert [k for k, *_ in told(made(signals, around(at)), coarse_rom)] == [6]


def test_a_two_lobed_sweep_without_a_response_along_order_7_has_no_peak_of_it(coarse_rom):
    """Marched over the crossing of EO 7 with f1, where the start vibrates freely."""
    from runs import swept

    met = crossing(coarse_rom, 7)
    case = scene(
        rounds=16,
        damping_ratio=0.001,
        speeds={"over_f1": (met * np.linspace(0.97, 1.05, 17)).tolist()},
        integrator={"scheme": "piecewise-exact", "steps_per_round": 1024},
        record={"samples_per_round": 128, "spectrum_rounds": 8},
        casing={"ramp_rounds": 0.1, "harmonics": [{"order": 2, "amplitude_gaps": 1.05}]},
    )
    runs = swept(case, coarse_rom)
    assert 7 not in {peak.k for peak in reported(runs, coarse_rom)}
    raw = runs["spectrum"].sel(engine_order=slice(6.8, 7.2)).max("engine_order") / runs.gap_m
    assert raw.max() > 0.02  # gaps: some pass there


def test_no_response_or_a_single_speed_has_no_peak(coarse_rom):
    at = 1.05 * crossing(coarse_rom, 4)
    assert told(made(lambda speed: along(4, 0.0), around(0.3)), coarse_rom) == []
    assert told(made(lambda speed: along(4, 2.0), [at]), coarse_rom) == []


def test_a_response_that_no_crossing_explains_is_a_peak_only_if_it_is_the_largest(coarse_rom):
    at = 1.6 * crossing(coarse_rom, 4)  # above all that contact may stiffen
    for forced, expected in ((0.4, [4]), (3.0, [])):
        runs = made(
            lambda speed, forced=forced: (
                forced * np.cos(2 * TURNS) + resonance(speed, at, 2.0) * np.cos(4 * TURNS)
            ),
            around(at),
        ).assign_attrs(modes=1, orders=[4])
        assert [k for k, *_ in told(runs, coarse_rom)] == expected
        assert all(
            of.rises_from == "no linear crossing explains it" for of in reported(runs, coarse_rom)
        )


def test_prominences_are_those_of_scipy():
    random = np.random.default_rng(1)
    for n in (3, 5, 20, 300):
        values = random.standard_normal(n)
        tops, prominences = maxima(values)
        expected, about = find_peaks(values, prominence=0)
        np.testing.assert_array_equal(tops, expected)
        np.testing.assert_array_equal(prominences, about["prominences"])


@pytest.mark.parametrize("spacing", [0.2, 1.0, 3.0])
def test_the_rise_to_the_top_of_a_linear_resonance_is_exact(spacing):
    """Of half-widths off its top, sampled far or near."""
    for off in (0.0, 0.1, spacing / 2):
        x = off + spacing * np.arange(-1, 2)
        found = rise(0.3 * (1 + 1e-3 * x), 2 / np.hypot(1, x))
        assert found == pytest.approx(np.hypot(1, off) - 1, rel=1e-6, abs=1e-9)


def test_where_a_motion_falls_the_rise_is_at_most_that_of_its_other_side():
    assert rise(np.array([-1.0, 0, 1]), np.array([0.95, 1, 0.2])) == pytest.approx(0.05)
    assert rise(np.array([-1.0, 0, 1]), np.array([0.9, 1, 1.1])) == pytest.approx(0.1)


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
