"""The data of the identification against the numbers of the paper's text."""

import numpy as np
import pytest
import xarray as xr

from workflow.identify.likelihood import FITS, Fit

PEAKS = ("point", "coating", "order")


def shifts(e1, e10, K=4.55):
    """One point with the shifts (k = 4, 6) of both coatings; the third coating has no peak."""
    given = np.full((1, 3, 2), np.nan)
    given[0, [0.45, 4.55].index(K)], given[0, 2] = e1, e10
    return given


@pytest.mark.parametrize("K", [0.45, 4.55])
@pytest.mark.parametrize(
    ("reading", "e1", "e10"),
    [
        ("printed", (1.129, 1.059), (1.226, 1.176)),
        ("consistent", (1.129, 0.994), (1.226, 1.105)),
        ("k = 4", (1.129, 0.0), (1.226, 0.0)),
    ],
)
def test_the_papers_shifts_are_the_data(K, reading, e1, e10):
    deviations = Fit(K, reading).deviations(shifts(e1, e10, K))
    assert abs(deviations).max() < 0.04  # the shifts above have three decimals


def test_half_a_digit_of_the_papers_speeds_is_one_sigma():
    one = shifts(
        (0.355 / 0.31, 0.185 / 0.17 - 0.005 / 0.17 + 0.005 / 0.181), (0.38 / 0.31, 0.2 / 0.17)
    )
    np.testing.assert_allclose(Fit(4.55, "printed").deviations(one), [[1, 1, 0, 0]], atol=1e-12)
    assert Fit(4.55, "printed").chi_squared(one) == pytest.approx(2)
    assert Fit(4.55, "k = 4").chi_squared(one) == pytest.approx(1)


def test_a_point_without_a_peak_is_excluded():
    assert Fit(4.55, "printed").chi_squared(shifts((1.129, np.nan), (1.226, 1.176))) == np.inf
    assert Fit(0.45, "k = 4").chi_squared(shifts((1.129, 1.059), (1.226, 1.176))) == np.inf


@pytest.mark.parametrize("of", FITS, ids=lambda of: of.name)
def test_both_amplitude_and_wear_must_be_more_for_the_stiffer_coating(of):
    soft, stiff = of.coatings.values()
    amplitude, wear = np.ones((3, 3, 2)), np.ones((3, 3, 2))
    amplitude[:, stiff, 0] = [2, 2, 0.5]
    wear[:, stiff, 0] = [2, 0.5, 2]
    held = of.stiffer_is_more(xr.Dataset({"amplitude": (PEAKS, amplitude), "wear": (PEAKS, wear)}))
    assert held.tolist() == [True, False, False]
    assert soft != stiff
