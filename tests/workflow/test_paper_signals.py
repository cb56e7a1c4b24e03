"""Signals of the claims, and Fig. 16: spectrograms of runs with prescribed harmonics."""

from types import SimpleNamespace

import numpy as np
import pytest
from made_sweeps import ROUNDS, SAMPLES, made_rom, save_runs

from simulate.signals import spectrum
from workflow.jobs.figure import read
from workflow.paper.figures import compared
from workflow.paper.measure import share_of_mode_1, spectral_entropy

SPEED = 0.35
TIME = np.arange(1, ROUNDS * SAMPLES + 1) / SAMPLES


def test_a_harmonic_has_its_amplitude_in_the_spectrogram():
    """Order 4 all along, order 8 in the second half: on bins of the window of two rounds."""
    late = TIME > ROUNDS / 2
    u_r = 0.7 * np.cos(2 * np.pi * 4 * TIME) + 0.2 * late * np.cos(2 * np.pi * 8 * TIME)
    time, orders, amplitude = compared.spectrogram(u_r, SAMPLES)
    assert (time[0], time[-1]) == (1, ROUNDS - 1)  # windows of two rounds that the run fills
    assert np.diff(time) == pytest.approx(1 / 16)
    later, before = time >= ROUNDS / 2 + 1, time <= ROUNDS / 2 - 1
    np.testing.assert_allclose(amplitude[orders == 4][:, later | before], 0.7, rtol=1e-10)
    np.testing.assert_allclose(amplitude[orders == 8][:, later], 0.2, rtol=1e-10)
    assert amplitude[orders == 8][:, before].max() < 1e-12
    assert amplitude[orders > 9][:, later].max() < 1e-12


@pytest.fixture
def files(tmp_path):
    """The response along eo(4) is largest at 0.35, and in the sweep with tangential force, nan."""
    speeds = [0.33, SPEED, 0.37]
    u_r = np.array([[0.1], [1.0], [0.5]]) * np.cos(2 * np.pi * 4 * TIME)
    spectrum = np.full((3, 321), 1e-3)
    spectrum[:, 40] = [0.1, 1.0, 0.5]
    made_rom().save(tmp_path / "rom.nc")
    return SimpleNamespace(
        rom=tmp_path / "rom.nc",
        without=save_runs(tmp_path / "a.nc", speeds, u_r=u_r, spectrum=spectrum),
        withit=save_runs(
            tmp_path / "b.nc", speeds, u_r=u_r, spectrum=np.nan * spectrum, status="diverged"
        ),
    )


def test_numbers_are_of_the_last_ten_rounds(tmp_path, files):
    """A sixth harmonic that has decayed before does not count; the rest is 9 to 1."""
    u_r = 0.3 * np.cos(2 * np.pi * 4 * TIME) + 0.1 * np.cos(2 * np.pi * 9 * TIME)
    u_r += np.where(TIME <= ROUNDS - 10, 1.0, 0.0) * np.cos(2 * np.pi * 6 * TIME)
    spectrum = np.full((3, 321), 1e-3)
    spectrum[1, 40] = 1.0
    speeds = [0.33, SPEED, 0.37]
    files.without = save_runs(tmp_path / "c.nc", speeds, u_r=[u_r] * 3, spectrum=spectrum)
    first = compared.spectrograms(*read(compared, files, "spectrograms")).axes[0]
    bins = 10 * SAMPLES // 2  # all: 20 f1(0) lies beyond
    # energies 9 to 1, so amplitudes 3 to 1
    entropy = -(0.75 * np.log(0.75) + 0.25 * np.log(0.25)) / np.log(bins)
    assert f"90.0 % of the energy; entropy of the amplitudes {entropy:.2f}" in first.get_title()


TEN_ROUNDS = np.arange(640) / 64


def tone(order, amplitude=1.0):
    return amplitude * np.sin(2 * np.pi * order * TEN_ROUNDS + 0.3)


@pytest.mark.parametrize(
    ("u_r", "share"),
    [
        # contact locks mode 1 to the engine order of its peak; by the square of the amplitudes
        (5 + tone(4), 1),
        (tone(4, 2.0) + tone(7), 4 / 5),
        (tone(4) + tone(7, 2.0), 1 / 5),
        # of the bins, a tenth of an order apart, those from 3.5 to 4.5
        (np.zeros(640), np.nan),  # at rest
        *((tone(k), share) for k, share in ((3.4, 0), (3.5, 1), (4.5, 1), (4.6, 0))),
    ],
)
def test_mode_1_has_the_share_of_the_band_of_half_an_order_to_either_side(u_r, share):
    assert share_of_mode_1(u_r, 64) == pytest.approx(share, rel=1e-12, abs=1e-12, nan_ok=True)


def test_entropy_of_white_noise():
    """Energies spread exponentially: 1 - (1 - gamma) / ln(bins); scatter measured 3e-4."""
    bins = 50_000
    amplitudes = spectrum(np.random.default_rng(3).normal(size=2 * bins))[1:]
    expected = 1 - (1 - np.euler_gamma) / np.log(bins)
    assert spectral_entropy(amplitudes) == pytest.approx(expected, abs=1e-3)
    assert np.isnan(spectral_entropy(np.zeros(10)))
