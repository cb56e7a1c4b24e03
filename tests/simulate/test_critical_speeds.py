"""Peaks of any order, mode and place, on sweeps whose signals are made; free vibrations."""

import numpy as np
import pytest
import xarray as xr
from scenes import scene
from scipy.signal import find_peaks

from geometry.tip import JUDGED
from simulate.signals import lines, maxima, spectrum
from simulate.sweeps.crossings import crossing
from simulate.sweeps.peak import reported, rise

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
    found = [lines(GAP * signal, ROUNDS, ZETA, driven) for signal in each]
    bins = [GAP * spectrum(signal[:, 0]) for signal in each]
    runs = {
        "spectrum": (("speed_over_f1", "engine_order"), bins),
        "along": (("speed_over_f1", "judged", "order"), [of.along for of in found]),
        "beside": (("speed_over_f1", "judged"), [of.beside for of in found]),
        "beside_order": (("speed_over_f1", "judged"), [of.order for of in found]),
        "free": ("speed_over_f1", [of.free for of in found]),
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


def test_a_response_at_3_4_omega_is_a_peak_on_no_integer_order(coarse_rom):
    """Mode 1 meets 3.4 Omega above the model's highest speed: no crossing explains it."""
    at = 0.38

    def signals(speed):
        return 0.3 * np.cos(2 * TURNS) + resonance(speed, at, 1.5) * np.cos(3.4 * TURNS)

    runs = made(signals, around(at))
    assert told(runs, coarse_rom) == [(3.4, (), JUDGED[0], pytest.approx(at))]
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
            found = lines(signal[:, None], rounds, ZETA, driven).along[0, k - 1]
            assert bool(found > 0) is (share < last)


def test_along_an_order_that_the_casing_drives_a_rub_that_ends_is_a_peak(coarse_rom):
    at = 1.05 * crossing(coarse_rom, 6)

    def signals(speed):
        dying = resonance(speed, at, 1.5) * np.exp(-0.8 * ZETA * 6 * TURNS)  # not as free
        return 0.2 * np.cos(2 * TURNS) + dying * np.cos(6 * TURNS)

    assert [k for k, *_ in told(made(signals, around(at)), coarse_rom)] == [6]


def test_where_a_line_beside_an_order_is_twice_as_strong_nothing_is_on_the_order(coarse_rom):
    """A steady line at 4.8: EO 5 has its skirt alone."""
    at = 1.05 * crossing(coarse_rom, 4.8)

    def signals(speed):
        return 0.3 * np.cos(2 * TURNS) + resonance(speed, at, 1.5) * np.cos(4.8 * TURNS)

    assert [k for k, *_ in told(made(signals, around(at)), coarse_rom)] == [4.8]


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


def test_no_peak(coarse_rom):
    runs = made(lambda speed: 0.4 * np.cos(2 * TURNS), around(0.3))
    assert told(runs, coarse_rom) == []
    assert told(runs.isel(speed_over_f1=[3]), coarse_rom) == []


def test_a_sweep_of_one_speed_has_no_peak(coarse_rom):
    at = 1.05 * crossing(coarse_rom, 4)
    runs = made(lambda speed: along(4, resonance(speed, at, 2.0)), [at])
    assert told(runs, coarse_rom) == []


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
