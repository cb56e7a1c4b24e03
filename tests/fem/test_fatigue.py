"""Cycles and margins in closed form, and against all pairs of instants."""

import numpy as np
import pytest
from scipy.spatial.distance import pdist
from scipy.spatial.transform import Rotation

from fem.fatigue import FIVE, allowed, damage, margin, uniaxial, von_mises
from fem.fields import TENSOR
from fem.worst_node import cycles
from geometry.base import SettingsError, check_settings
from geometry.blade import Fatigue

FULL = np.array([(0, 3, 5), (3, 1, 4), (5, 4, 2)])  # the tensor of its six components
PHASE = 2 * np.pi * np.arange(48) / 48
XX, YY, XY = np.eye(6)[[0, 1, 3]]
STRENGTH = {"endurance_MPa": 500.0, "yield_MPa": 900.0, "ultimate_MPa": 1000.0}
WITH_SLOPE = Fatigue(**STRENGTH, line="goodman", slope_k=9)


def largest_cycle(sigma):
    """Mean and alternating stress (nodes,) of ``sigma`` (times, nodes, 6)."""
    return cycles(sigma, np.eye(len(sigma)))


def of(line="goodman"):
    return Fatigue(**STRENGTH, line=line)


def over_time(signal, tensor, static=0.0):
    """Stress (times, 1, 6) of one node."""
    return (static + np.multiply.outer(signal, tensor))[:, None]


def test_the_length_of_the_five_components_is_the_von_mises_stress():
    """sqrt(3/2 s : s), s the deviator; of tension, shear and pressure."""
    sigma = np.random.default_rng(1).normal(size=(20, 6))
    s = sigma[:, FULL] - np.eye(3) * sigma[:, :3].mean(axis=1)[:, None, None]
    np.testing.assert_allclose(von_mises(sigma), np.sqrt(1.5 * (s**2).sum(axis=(1, 2))), rtol=1e-13)
    states = np.stack([-3.0 * XX, XY, np.eye(6)[:3].sum(axis=0)])
    np.testing.assert_allclose(von_mises(states), [3, np.sqrt(3), 0], rtol=1e-15)


def test_bending_over_tension_is_the_closed_form():
    """Proportional: 90 MPa of tension, 30 of bending; in compression the mean is negative."""
    for side in (1, -1):
        mean, alternating = largest_cycle(over_time(30e6 * np.cos(PHASE), XX, side * 90e6 * XX))
        assert (mean.item(), alternating.item()) == pytest.approx((side * 90e6, 30e6), rel=1e-12)
    for line, allows in {"goodman": 455, "gerber": 495.95, "soderberg": 450}.items():
        assert margin(np.array(90e6), np.array(30e6), of(line)) == pytest.approx(allows / 30)


def test_alternating_shear_has_root_three_of_half_ranges_in_principal_axes():
    """The same torsion along and across its principal directions; half-ranges lose the sign."""
    signal = 10e6 * np.sin(PHASE)
    for tensor in (XY, XX - YY):
        _, alternating = largest_cycle(over_time(signal, tensor))
        assert alternating.item() == pytest.approx(np.sqrt(3) * 10e6, rel=1e-12)
    half_ranges = np.ptp(over_time(signal, XX - YY), axis=0) / 2
    assert von_mises(half_ranges).item() == pytest.approx(10e6, rel=1e-12)


def test_cycles_turn_with_the_axes():
    turn = Rotation.from_rotvec([0.3, -0.5, 0.9]).as_matrix()
    sigma = np.random.default_rng(2).normal(size=(40, 25, 6))
    turned = (turn @ sigma[..., FULL] @ turn.T)[..., *TENSOR]
    for one, other in zip(largest_cycle(sigma), largest_cycle(turned), strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9)


def test_one_frequency_out_of_phase_has_its_whole_change():
    """On an ellipse the largest change is along its long axis."""
    sigma = np.multiply.outer(np.cos(PHASE), 3 * XX) + np.multiply.outer(np.sin(PHASE), XY)
    _, alternating = largest_cycle(sigma[:, None])
    assert alternating.item() == pytest.approx(3.0, rel=1e-12)


def test_several_frequencies_miss_little_of_the_largest_change():
    """Five frequencies against all pairs of instants; none is more than the largest."""
    rng = np.random.default_rng(3)
    signals = [rng.uniform(0.1, 1) * np.cos(k * PHASE + rng.uniform(0, 6)) for k in (1, 2, 3, 5, 7)]
    sigma = np.einsum("kt,knc->tnc", signals, rng.normal(size=(5, 300, 6)))
    _, found = largest_cycle(sigma)
    exact = np.array([pdist(node @ FIVE.T).max() / 2 for node in sigma.swapaxes(0, 1)])
    shares = found / exact
    assert shares.max() <= 1 + 1e-12 and shares.min() > 0.98
    assert np.mean(shares < 1 - 1e-9) < 0.01


def test_compression_earns_no_credit_and_yield_bounds_both():
    mean = 1e6 * np.array([-950.0, -500.0, 0.0, 500.0, 850.0, 1100.0])
    np.testing.assert_allclose(allowed(mean, of()), 1e6 * np.array([0, 400, 500, 250, 50, 0]))
    np.testing.assert_allclose(allowed(mean, of("gerber"))[3:], 1e6 * np.array([375, 50, 0]))
    assert margin(np.array([2e9, 0.0]), np.zeros(2), of()).tolist() == [0.0, 5e8]


@pytest.mark.parametrize("yield_MPa", [400, 1200])
def test_strengths_out_of_order_are_refused(yield_MPa):
    said = f"yield_MPa: {yield_MPa}: allowed from endurance_MPa = 500 to ultimate_MPa = 1000"
    with pytest.raises(SettingsError, match=said):
        check_settings(Fatigue, STRENGTH | {"yield_MPa": yield_MPa}, "mine.yaml")


def test_ten_million_cycles_at_the_endurance_crack_and_one_takes_its_share():
    """Miner by hand: n cycles of amplitude S at mean m take n/1e7 (S/S_a(m))^9."""
    n = 40
    signal = np.append(500e6 * np.cos(np.pi * np.arange(2 * n)), 500e6)  # n whole cycles, mean 0
    assert damage(signal, WITH_SLOPE) == pytest.approx(n / 1e7, rel=1e-12, abs=0)
    assert damage(signal / 2, WITH_SLOPE) == pytest.approx(n / 1e7 / 2**9, rel=1e-12, abs=0)
    raised = 200e6 + signal / 4  # Goodman: 400 MPa at a mean of 200, amplitude 125
    assert damage(raised, WITH_SLOPE) == pytest.approx(n / 1e7 * (125 / 400) ** 9, rel=1e-12, abs=0)
    assert damage(np.full(9, 1e8), WITH_SLOPE) == 0.0
    assert damage(900e6 + signal / 4, WITH_SLOPE) == n  # beyond yield each cycle cracks


def test_the_damage_of_a_made_signal_is_its_rainflow_count_by_hand():
    """The example of ASTM E1049, Fig. 6: ranges, means and counts as the standard lists them."""
    signal = 50e6 * np.array([-2, 1, -3, 5, -1, 3, -4, 4, -2.0])
    listed = [(3, -0.5, 0.5), (4, -1, 0.5), (4, 1, 1), (8, 1, 0.5), (9, 0.5, 0.5), (8, 0, 0.5)]
    expected = 0.0
    for span, mean, count in [*listed, (6, 1, 0.5)]:
        S, S_a = 25 * span, 500 * (1 - max(50 * mean, 0) / 1000)
        expected += count / 1e7 * (S / S_a) ** 9
    assert damage(signal, WITH_SLOPE) == pytest.approx(expected, rel=1e-12, abs=0)


def test_the_stress_along_its_largest_change_has_its_range_and_mean():
    """Bending over tension; over a static stress of another direction; in compression."""
    swing = 30e6 * np.cos(PHASE)
    np.testing.assert_allclose(uniaxial(over_time(swing, XX, 90e6 * XX)[:, 0]), 90e6 + swing)
    sheared = uniaxial(over_time(swing, XX, 90e6 * XY)[:, 0])
    assert np.ptp(sheared) == pytest.approx(60e6)
    assert sheared.max() + sheared.min() == pytest.approx(2 * 90e6 * np.sqrt(3))
    pressed = uniaxial(over_time(swing, XX, -90e6 * XX)[:, 0])
    np.testing.assert_allclose(pressed, -90e6 + swing)
    assert uniaxial(np.zeros((8, 6))).tolist() == [0.0] * 8
