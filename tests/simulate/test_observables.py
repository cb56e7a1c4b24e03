import numpy as np
import pytest
from runs import set_up
from scenes import RUBBING, of_steps, scene

from simulate.errors.observables import numbers
from simulate.errors.run import Case
from simulate.errors.schema import QUANTITIES
from simulate.signals import (
    amplitude,
    blurred,
    lobe_count,
    on_rods,
    spectrum,
)


def test_amplitudes_of_harmonics_are_exact_bins():
    rounds, samples = 10, 64
    t = np.arange(rounds * samples) / samples
    u = 0.3 + 2.0 * np.cos(2 * np.pi * 4 * t + 1) + 0.5 * np.sin(2 * np.pi * 2.7 * t)
    found = spectrum(u)
    np.testing.assert_allclose(found[[0, 40, 27]], [0.3, 2.0, 0.5], rtol=1e-12)
    assert np.delete(found, [0, 40, 27]).max() < 1e-12


def test_amplitudes_near_an_order_and_of_all_but_the_mean():
    spectra = np.zeros((2, 80))  # of ten rounds
    spectra[0, [0, 42, 60]] = 9.0, 2.0, 5.0
    spectra[1] = np.nan
    np.testing.assert_array_equal(amplitude(spectra, 10, 4), [2.0, np.nan])
    np.testing.assert_array_equal(amplitude(spectra, 10), [5.0, np.nan])


@pytest.mark.parametrize("number", [1, 2, 4, 5, 6, 12])
@pytest.mark.parametrize("turn", [0.0, 1.0, 3.0])
def test_lobes_are_counted_wherever_they_start(number, turn):
    wear = np.maximum(0, np.cos(number * THETA + turn)) ** 2
    noise = np.random.default_rng(2).uniform(0, 0.2, 2048)
    assert lobe_count(wear + noise) == number


THETA = 2 * np.pi * np.arange(2048) / 2048
DEG = np.degrees(THETA) % 180  # a casing of two diameters
DEEP, PATCH = (np.maximum(0, 1 - ((DEG - 90) / width) ** 2) for width in (50, 40))
BESIDE = 0.55 * np.maximum(0, 1 - ((DEG - 35) / 12) ** 2)
WORN = {
    "unequal": (np.maximum(0, np.cos(5 * THETA)) * (1 + 0.5 * np.cos(THETA)), 5),
    "untouched": (np.zeros(1024), 0),
    "a narrow lobe next to a deep one": (np.maximum(DEEP, BESIDE), 4),
    "a shallow dip splits no lobe": (PATCH - 0.3 * np.exp(-(((DEG - 91) / 10) ** 2)), 2),
}


@pytest.mark.parametrize("name", WORN)
def test_lobes_that_count(name):
    profile, lobes = WORN[name]
    assert lobe_count(profile) == lobes


def test_profiles_between_their_rods_are_linear_and_closed():
    profile = np.array([[0.0, 1.0, 4.0, 2.0]])
    np.testing.assert_allclose(on_rods(profile, 8), [[0, 0.5, 1, 2.5, 4, 3, 2, 1]])
    np.testing.assert_array_equal(on_rods(profile, 4), profile)


@pytest.mark.parametrize("nu", [509, 8191])
def test_a_blurred_harmonic_keeps_its_phase_and_is_reduced_by_the_gaussian(nu):
    wave = np.cos(6 * (2 * np.pi * np.arange(nu) / nu - 0.3))
    found = blurred(wave, 0.1)
    theta = 2 * np.pi * np.arange(found.size) / found.size
    expected = np.exp(-(0.6**2) / 2) * np.cos(6 * (theta - 0.3))
    np.testing.assert_allclose(found, expected, atol=1e-12)


def test_lobes_of_other_depths_and_widths_count_alike_and_their_tops_are_rounded():
    """Triangles 1 and 2 deep, 20 and 60 deg wide at half of it, one across 0; the blur is 4 deg.

    The convolution of a triangle with a Gaussian is lower at its top by sqrt(2/pi) times blur over
    slope length.
    """
    degrees = np.arange(3600) / 10
    profile = np.zeros(3600)
    for centre, half, depth in ((350, 20, 1.0), (120, 60, 2.0)):
        away = abs((degrees - centre + 180) % 360 - 180)
        profile += depth * np.maximum(1 - away / half, 0)
    top = blurred(profile, np.radians(4)).max()
    assert top == pytest.approx(2 * (1 - np.sqrt(2 / np.pi) * 4 / 60), rel=1e-3)
    assert lobe_count(profile) == 2


OF_TAPER = {"u_t_leading", "u_t_trailing"}  # of a casing that tapers alone


MODES = [{"order": 2, "frequency_Hz": 1000, "modal_mass_kg": 5, "damping_ratio": 0.01}]
RUBS = {"flat": {}, "friction": {"contact": {"friction": 0.1}}, "casing": {"casing__modes": MODES}}


@pytest.mark.parametrize("of_rub", RUBS)
def test_every_number_is_the_same_over_steps_and_rods(coarse_rom, of_rub):
    """Half a rod to six in a footprint, steps that pass up to 0.9 of it, beside one of a tenth."""

    def found(steps, rods):
        of = {"integrator": of_steps(steps), "liner__rods_per_round": rods} | RUBS[of_rub]
        case = scene(**RUBBING | of, rounds=6)
        absent = OF_TAPER if case.casing.moves else OF_TAPER | {"casing_motion"}
        run = Case(case, coarse_rom, set_up(case, coarse_rom)).march()
        values = numbers(run, 2)
        assert (
            run.outcome.status == "ok"
            and values.keys() == {one.name for one in QUANTITIES if one.of} - absent
        )
        return values

    finest = found(8192, 8209)
    for steps, rods in ((768, 353), (768, 4093), (1280, 511), (2560, 353), (2560, 1021)):
        assert found(steps, rods) == pytest.approx(finest, rel=0.01), (steps, rods)
