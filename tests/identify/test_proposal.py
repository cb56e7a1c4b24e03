"""Where the engine runs next, on made shifts that are linear in the parameters."""

import numpy as np
import pytest
from refused import refused
from scipy.stats import norm

from geometry.project import SettingsError
from workflow.identify.fits import drawn as every, fit, posterior_of
from workflow.identify.likelihood import SHIFTS, WITH_ORDER, Fit
from workflow.identify.points import Blades, drawn_cube
from workflow.identify.priors import SHAPE, sobol
from workflow.identify.proposal import drawn, proposal, served
from workflow.identify.table import COATINGS, ORDERS, placed
from workflow.paper.printed import CONSISTENT, CRITICAL

SPREAD = 0.2  # of the shifts over the unit cube
# Blades whose shape does not matter, and which are equally stiff
BLADES = Blades(sobol(32, len(SHAPE), 3), np.zeros(32), sobol(32, 2, 4))


@pytest.fixture(autouse=True)
def _few_candidates(request, monkeypatch):
    """A quarter of the candidates: still a thousand in the posterior, eight times those drawn."""
    if "slow" not in request.keywords:
        monkeypatch.setattr("workflow.identify.proposal.CANDIDATES", 2**16)


def made(cube, crossing_of_6=0.17, soft=(0.0, 0.0), data=None):
    """Peaks at the paper's shifts where the first two after the shape are 1/2, for K = 4.55.

    With K = 0.45 the shifts of E = 1 are off by ``soft``. The peak of E = 10 is the higher one, and
    its wear the deeper one, where the third parameter is above 1/2.
    """
    crossings, points = {4: 0.31, 6: crossing_of_6}, cube[:, 1:]
    over_crossing = np.empty((len(points), len(COATINGS), len(ORDERS)))
    for i, (E, K) in enumerate(COATINGS):
        for j, k in enumerate(ORDERS):
            off = (points[:, 0] if E == 1 else points[:, 1]) - 0.5
            paper = CRITICAL[f"e{E:g}"][k] / crossings[k]
            over_crossing[:, i, j] = paper + SPREAD * off + (soft[j] if K == 0.45 else 0.0)
    amplitude = np.ones_like(over_crossing)
    amplitude[:, 2] += (points[:, 2] > 0.5)[:, None] - 0.5
    peaks = {"over_crossing": over_crossing, "amplitude": amplitude, "wear": amplitude}
    return placed([{"data": data, "cube": cube, **peaks}], BLADES)


def tables(data=SHIFTS, **shape):
    """A table of the prior and one that was proposed after it."""
    prior = drawn_cube(128, 1)
    first = made(prior, **shape)
    points = drawn([first], 128, data)
    return [first, made(points, **shape, data=data)]


def test_the_reading_that_fits_better_is_served():
    points = drawn_cube(128, 1)

    def of(crossing):
        return served(made(points, crossing))

    assert of(0.17) == "printed" and of(CONSISTENT[6]) == "consistent"
    assert of(0.155) == of(0.13) == "k = 4"


def test_points_are_proposed_where_the_shifts_are_the_papers():
    proposed = tables()[1]["cube"].values[:, 1:]
    sigma = 0.005 / 0.31 / np.sqrt(2)  # of two data
    np.testing.assert_allclose(proposed[:, :2].mean(axis=0), 0.5, atol=0.03)
    assert proposed[:, :2].std(axis=0).max() < 2 * sigma / SPREAD
    assert proposed[:, 2:].std(axis=0).min() > 0.25


def test_the_order_of_the_coatings_as_a_datum_moves_the_proposal():
    shares = [(tables(data)[1]["cube"].values[:, 3] > 0.5).mean() for data in (SHIFTS, WITH_ORDER)]
    assert 0.4 < shares[0] < 0.6 and shares[1] > 0.8


def test_a_K_far_from_the_data_is_not_served():
    """The other K alone then has the draws: twice as many are near its posterior."""
    points, prior = drawn_cube(512, 5), drawn_cube(128, 1)
    centre = np.linalg.norm(points[:, 1:3] - 0.5, axis=1) < 0.05

    def density_at_centre(soft):
        first = made(prior, soft=soft)
        return proposal([first], points, SHIFTS)[centre].mean()

    assert density_at_centre((0.3, -0.3)) > 1.5 * density_at_centre((0.05, 0.05))


NAMES = (
    *("unit_Pa", "casing_gaps", "fourth_over_second", "constant_over_second"),
    *("fifth_over_second", "damping_ratio"),
)
# Of the first two parameters: two data of k = 4 and two of k = 6 each, linear in one of them
SIGMA = 1 / (SPREAD * np.hypot(0.31, 0.181) / 0.005)


@pytest.fixture(scope="module")
def fitted():
    """Three tables of different sizes and data."""
    each = tables()
    for number, data in ((512, SHIFTS), (64, WITH_ORDER)):
        points = drawn(each, number, data)
        each.append(made(points, data=data))
    marched = every(each)
    parameters = dict(zip(NAMES, marched.cube.values[:, 1:].T, strict=True))
    return marched, fit(Fit(4.55, "printed"), marched, parameters)


@pytest.mark.slow
def test_a_fit_is_the_posterior_in_closed_form(fitted):
    """A Gaussian in two parameters, the prior in three; with the order, half of it.

    The medoid has the paper's k = 4 peaks.
    """
    marched, of = fitted
    evidence = 2 * np.pi * SIGMA**2
    shifts, with_order = of[SHIFTS], of[WITH_ORDER]
    assert of["chi_squared"] < 0.1
    assert shifts["evidence"] == pytest.approx(evidence, rel=0.08)
    assert with_order["evidence"] == pytest.approx(evidence / 2, rel=0.12)
    for name in NAMES[:2]:
        expected = 0.5 + SIGMA * norm.ppf([0.05, 0.5, 0.95])
        np.testing.assert_allclose(shifts["ranges"][name], expected, atol=0.2 * SIGMA)
    np.testing.assert_allclose(shifts["ranges"]["damping_ratio"], [0.05, 0.5, 0.95], atol=0.08)
    draws = marched.cube.values[shifts["draws"], 1:]
    assert draws[:, :2].std(axis=0) == pytest.approx([SIGMA] * 2, rel=0.25)
    assert draws[:, 4].std() == pytest.approx(12**-0.5, rel=0.2)
    deviations = Fit(4.55, "printed").deviations(marched.over_crossing.values)
    assert abs(deviations[[shifts["medoid"], with_order["medoid"]]][:, [0, 2]]).max() <= 1


def test_the_density_of_a_proposal_has_mean_one_and_equal_parts():
    prior = drawn_cube(256, 1)
    soft = (0.02, -0.02)  # K = 0.45 is off in a way that no point can meet: less evidence
    first = made(prior, soft=soft)
    among = drawn_cube(2**13, 9)
    density = proposal([first], among, SHIFTS)
    assert density.mean() == pytest.approx(1, abs=0.1)
    alone = proposal([made(prior, soft=(0.3, -0.3))], among, SHIFTS)
    centre = np.linalg.norm(among[:, 1:3] - 0.5, axis=1) < 0.03
    assert density[centre].mean() < 0.9 * alone[centre].mean()


def test_medoid_and_draws_are_those_of_the_served_fit():
    taken = {"medoid": 4, "draws": [4]}
    fits = {
        "served": "consistent",
        "fits": {"K = 4.55, consistent": {SHIFTS: {"draws": [3]}, WITH_ORDER: taken}},
    }
    assert posterior_of(fits)["draws"] == [4]
    taken["medoid"] = None
    assert refused(SettingsError, posterior_of, fits).key == "TABLES"


def test_a_fit_without_any_peak_has_no_range_and_no_draws():
    prior = drawn_cube(8, 1)
    table = made(prior).assign(density=("point", np.full(8, 8.0)))
    marched = table.assign(over_crossing=np.nan * table["over_crossing"])
    of = fit(Fit(4.55, "printed"), marched, {"fourth_over_second": prior[:, 3]})
    assert of["chi_squared"] == np.inf and of[SHIFTS]["evidence"] == 0
    assert of[SHIFTS]["ranges"] is of[SHIFTS]["medoid"] is None and of[SHIFTS]["draws"] == []


def test_no_point_is_drawn_twice():
    each = tables()
    third = drawn(each, 128, SHIFTS)
    every = np.vstack([*(table.cube.values for table in each), third])
    assert len(np.unique(every, axis=0)) == len(every)
