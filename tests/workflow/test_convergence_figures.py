"""Figs. 7 and 8: lines and differences of runs that differ in one setting."""

import re
from types import SimpleNamespace

import numpy as np
import pytest
from made_sweeps import ROUNDS, SAMPLES, save_runs

from workflow.figures import fig07_densities, fig08_displacement
from workflow.figures.response import Response
from workflow.jobs.figure import read

COARSE, FINE = 128, 512
TIME = np.arange(1, ROUNDS * SAMPLES + 1) / SAMPLES
CYCLES = np.sin(2 * np.pi * 4 * TIME)


def worn(nu, scale=1.0):
    return scale * (1 + np.cos(2 * np.pi * 4 * np.arange(nu) / nu))


def texts(axes):
    return [text.get_text() for text in axes.texts]


def test_the_place_is_found_in_any_order_of_the_history(tmp_path):
    path = save_runs(tmp_path / "a.nc", [0.3], u_r=[CYCLES], chord=(0.5, 1 / 16))
    np.testing.assert_allclose(Response.read(path).u_r, [CYCLES])


@pytest.fixture
def densities(tmp_path):
    """At the first speed the finer liner wears a tenth less, at the second the same."""
    return SimpleNamespace(
        coarse=save_runs(tmp_path / "coarse.nc", [0.35, 0.2], [worn(COARSE)] * 2),
        fine=save_runs(tmp_path / "fine.nc", [0.35, 0.2], [worn(FINE, 0.9), worn(FINE)]),
    )


def test_profiles_of_both_densities_and_their_difference(densities):
    first, second = fig07_densities.draw(*read(fig07_densities, densities)).axes
    coarse, fine = first.lines
    assert (len(coarse.get_xdata()), len(fine.get_xdata())) == (COARSE + 1, FINE + 1)
    np.testing.assert_allclose(fine.get_ydata(), [*worn(FINE, 0.9), 1.8], rtol=1e-6)
    assert list(fine.get_xdata()[[0, -1]]) == [0, 360]
    assert float(texts(first)[0].split()[-2]) == pytest.approx(10, abs=0.2)
    # a cosine over 32 rods and straight between: (2 pi / 32)^2 / 8 sqrt(8/15 / 2 / 1.5) of it
    assert texts(second)[0].endswith(": 0.2 %")


@pytest.mark.parametrize("status", ["sensitive", "unstable"])
def test_a_run_without_a_valid_result_is_labelled(densities, tmp_path, status):
    path = save_runs(tmp_path / "c.nc", [0.35, 0.2], [worn(FINE)] * 2, status=status)
    fine = read(fig07_densities, SimpleNamespace(coarse=densities.coarse, fine=path))
    (text,) = texts(fig07_densities.draw(*fine).axes[0])
    assert status in text


@pytest.fixture
def histories(tmp_path):
    """Errors of 20 % and 10 % in the last round, none before."""

    def with_error(error, step):
        u_r = np.where(TIME > ROUNDS - 1, (1 - error) * CYCLES, CYCLES)
        path = tmp_path / f"{error}-{step}.nc"
        return save_runs(path, [0.35], wear=[worn(COARSE)], u_r=[u_r], step=step)

    return SimpleNamespace(
        coarse=with_error(0.1, 0.5),
        fine=with_error(0, 0.5),
        steps=[with_error(error, step) for error, step in ((0.2, 0.84), (0.1, 0.44), (0.0, 0.22))],
    )


def test_displacements_and_their_differences(histories):
    drawn = fig08_displacement.draw(*fig08_displacement.load(histories))
    _, end, start_steps, _ = drawn.axes
    assert [len(axes.lines) for axes in drawn.axes] == [2, 2, 3, 3]
    for line in start_steps.lines:
        np.testing.assert_allclose(line.get_xdata(), TIME[: 5 * SAMPLES])
        np.testing.assert_allclose(line.get_ydata(), CYCLES[: 5 * SAMPLES], atol=1e-12)
    last = end.lines[0]
    np.testing.assert_allclose(last.get_xdata(), TIME[-SAMPLES:])
    np.testing.assert_allclose(last.get_ydata(), 0.9 * CYCLES[-SAMPLES:], atol=1e-12)
    shown = [re.findall(r"[\d.]+ %", text) for axes in drawn.axes for text in texts(axes)]
    assert shown == [["0 %"], ["10 %"], ["0 %", "0 %"], ["20 %", "10 %"]]
