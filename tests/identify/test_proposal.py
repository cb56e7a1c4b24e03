"""Where the engine runs next, on made shifts that are linear in the parameters."""

import numpy as np
import pytest

from workflow.identify.fits import PRIOR, Drawn, drawn_of, fit
from workflow.identify.likelihood import CRITICAL, CROSSINGS, SHIFTS, WITH_ORDER, Fit
from workflow.identify.posterior import systematic
from workflow.identify.proposal import proposal, served
from workflow.identify.table import COATINGS, ORDERS, Observed, Table, sobol

CANDIDATES = sobol(2**12, 2)
SPREAD = 0.2  # of the shifts over the unit cube


def made(points, crossing_of_6=0.17, soft=(0.0, 0.0)):
    """Peaks at the paper's shifts where the first two parameters are 1/2, for K = 4.55.

    With K = 0.45 the shifts of E = 1 are off by ``soft``. The peak of E = 10 is the higher one, and
    its wear the deeper one, where the third parameter is above 1/2.
    """
    crossings = {4: 0.31, 6: crossing_of_6}
    over_crossing = np.empty((len(points), len(COATINGS), len(ORDERS)))
    for i, (E, K) in enumerate(COATINGS):
        for j, k in enumerate(ORDERS):
            off = (points[:, 0] if E == 1 else points[:, 1]) - 0.5
            paper = CRITICAL[E][k] / crossings[k]
            over_crossing[:, i, j] = paper + SPREAD * off + (soft[j] if K == 0.45 else 0.0)
    amplitude = np.ones_like(over_crossing)
    amplitude[:, 2] += (points[:, 2] > 0.5)[:, None] - 0.5
    return Observed(over_crossing, amplitude, amplitude)


def tables(data=SHIFTS, **shape):
    """A table of the prior and one that was proposed after it."""
    prior = sobol(128, 1)
    first = Table(prior, made(prior, **shape), None)
    density = proposal([first], CANDIDATES, CANDIDATES, data)
    points = CANDIDATES[systematic(density, 128, np.random.default_rng(0))]
    return [first, Table(points, made(points, **shape), data)]


def test_the_reading_that_fits_better_is_served():
    points = sobol(128, 1)
    assert served(made(points).over_crossing) == "printed"
    assert served(made(points, CROSSINGS[6]).over_crossing) == "consistent"
    assert served(made(points, crossing_of_6=0.13).over_crossing) == "k = 4"


def test_points_are_proposed_where_the_shifts_are_the_papers():
    proposed = tables()[1].points
    sigma = 0.005 / 0.31 / np.sqrt(2)  # of two data
    np.testing.assert_allclose(proposed[:, :2].mean(axis=0), 0.5, atol=0.03)
    assert proposed[:, :2].std(axis=0).max() < 2 * sigma / SPREAD
    assert proposed[:, 2:].std(axis=0).min() > 0.25


def test_the_order_of_the_coatings_as_a_datum_moves_the_proposal():
    shares = [(tables(data)[1].points[:, 2] > 0.5).mean() for data in (SHIFTS, WITH_ORDER)]
    assert 0.4 < shares[0] < 0.6 and shares[1] > 0.8


def test_a_K_far_from_the_data_is_not_served():
    """The other K alone then has the draws: twice as many are near its posterior."""
    points, prior = sobol(512, 5), sobol(128, 1)
    centre = np.linalg.norm(points[:, :2] - 0.5, axis=1) < 0.05

    def density_at_centre(soft):
        first = Table(prior, made(prior, soft=soft), None)
        return proposal([first], CANDIDATES, points, SHIFTS)[centre].mean()

    assert density_at_centre((0.3, -0.3)) > 1.5 * density_at_centre((0.05, 0.05))


@pytest.fixture(scope="module")
def fitted():
    each = tables()
    drawn = Drawn.of(each, CANDIDATES)
    names = (
        "unit_Pa",
        "casing_gaps",
        "fourth_over_second",
        "constant_over_second",
        "damping_ratio",
    )
    return drawn, fit(Fit(4.55, "printed"), drawn, dict(zip(names, drawn.points.T, strict=True)))


def test_a_fit_recovers_what_made_its_data(fitted):
    drawn, of = fitted
    assert of["chi_squared"] < 0.1
    low, median, high = of[SHIFTS]["ranges"]["unit_Pa"]
    assert median == pytest.approx(0.5, abs=0.03) and low < 0.47 < 0.53 < high
    medoid = drawn.points[of[SHIFTS]["medoid"]]
    np.testing.assert_allclose(medoid, 0.5, atol=0.25)
    assert of[WITH_ORDER]["evidence"] / of[SHIFTS]["evidence"] == pytest.approx(0.5, abs=0.1)
    assert drawn.points[of[WITH_ORDER]["medoid"], 2] > 0.5


def test_the_medoid_has_the_papers_k_4_peaks(fitted):
    drawn, of = fitted
    deviations = Fit(4.55, "printed").deviations(drawn.observed.over_crossing)
    for data in (SHIFTS, WITH_ORDER):
        assert abs(deviations[of[data]["medoid"], [0, 2]]).max() <= 1


def test_draws_are_those_of_the_served_fit(fitted):
    fits = {"served": "printed", "fits": {"K = 4.55, printed": fitted[1]}}
    draws = drawn_of(fits, "4.55")
    assert len(draws) == 100 and set(draws) <= set(np.flatnonzero(fitted[1][SHIFTS]["weights"]))
    assert drawn_of(fits, PRIOR) == list(range(100))


def test_a_fit_without_any_peak_has_no_range_and_no_draws():
    prior = sobol(8, 1)
    none = made(prior)._replace(over_crossing=np.full((8, len(COATINGS), len(ORDERS)), np.nan))
    drawn = Drawn(prior, none, np.full(8, 8.0))
    of = fit(Fit(4.55, "printed"), drawn, {"unit_Pa": prior[:, 0]})
    assert of["chi_squared"] == np.inf and of[SHIFTS]["evidence"] == 0
    assert of[SHIFTS]["ranges"] is of[SHIFTS]["medoid"] is None and of[SHIFTS]["draws"] == []
