"""Strips along the chord: a scene on different numbers of them, and outputs by eighths."""

import numpy as np
import pytest
from scenes import scene

from simulate.contact.places import SHARES, by_share, force_weights, share_weights, strip_places

EIGHTHS = np.linspace(0, 1, SHARES + 1)
UNEVEN = np.array([0, 0.05, 0.3, 0.31, 0.72, 1])
ENDS = [np.linspace(0, 1, m + 1) for m in (1, 4, 8, 12, 16, 32)] + [UNEVEN]


@pytest.mark.parametrize("m", [1, 7, 8, 16, 32])
def test_strips_are_equal_parts_of_the_chord_with_their_places_in_the_middle(coarse_rom, m):
    case = scene(liner__strips=m)
    places = strip_places(coarse_rom, case.liner, case.casing)
    np.testing.assert_allclose(places.ends, np.linspace(0, 1, m + 1), rtol=0, atol=1e-15)
    np.testing.assert_allclose(places.xi, (np.arange(m) + 0.5) / m, rtol=1e-15)
    on_line = coarse_rom.line(places.xi)
    np.testing.assert_array_equal(np.column_stack([places.radius, places.theta]), on_line[:, :2])
    # as wide as the tip is long between their ends, axially
    along = coarse_rom.line(np.linspace(0, 1, m + 1))[:, 2]
    np.testing.assert_allclose(places.width, np.diff(along), rtol=1e-12)
    # the chord is staggered and cambered: equal shares of it are of unequal axial width
    axial = np.ptp(coarse_rom.camber[:, 2])
    assert places.width.sum() == pytest.approx(axial, rel=1e-12)
    assert places.width.min() > 0 and (m == 1 or np.ptp(places.width) > 0.1 * axial / m)


def test_points_have_a_strip_each_that_ends_halfway_to_the_next(paper_reduced):
    rom, _ = paper_reduced
    assert rom.of_points
    case = scene(liner__strips=16)  # whatever is asked for
    places, n = strip_places(rom, case.liner, case.casing), len(rom.xi)
    np.testing.assert_array_equal(places.xi, rom.xi)
    np.testing.assert_array_equal(places.theta, rom.points[:, 1])
    assert len(places.ends) == n + 1 and (places.ends[0], places.ends[-1]) == (0, 1)
    ahead, behind = places.xi[1:] - places.ends[1:-1], places.ends[1:-1] - places.xi[:-1]
    np.testing.assert_allclose(ahead, behind, rtol=0, atol=1e-15)
    assert ahead.min() > 0
    assert places.width.sum() == pytest.approx(np.ptp(rom.camber[:, 2]), rel=1e-12)


@pytest.mark.parametrize("ends", ENDS, ids=lambda ends: f"{len(ends) - 1}")
def test_weights_of_an_eighth_and_of_a_strip_add_up_to_one(ends):
    """A uniform depth is unchanged; every force counts once."""
    of_depth, of_force = share_weights(ends), force_weights(ends)
    assert of_depth.shape == of_force.shape == (SHARES, len(ends) - 1)
    assert min(of_depth.min(), of_force.min()) >= 0
    np.testing.assert_allclose(of_depth.sum(axis=1), 1, rtol=0, atol=1e-14)
    np.testing.assert_allclose(of_force.sum(axis=0), 1, rtol=0, atol=1e-14)


@pytest.mark.parametrize("ends", ENDS, ids=lambda ends: f"{len(ends) - 1}")
def test_eighths_have_the_means_of_a_depth_constant_over_each_strip(ends):
    """Against the integral up to the ends of the shares; twelve strips straddle these."""
    wear = 0.2 + 3 * (ends[1:] + ends[:-1]) / 2
    worn = np.concatenate([[0], np.cumsum(wear * np.diff(ends))])
    expected = np.diff(np.interp(EIGHTHS, ends, worn)) * SHARES
    found = by_share(wear[:, None], ends)[:, 0]
    np.testing.assert_allclose(found, expected, rtol=1e-13)
    assert found.mean() == pytest.approx(0.2 + 3 / 2, rel=1e-14)  # of the profile over the chord
