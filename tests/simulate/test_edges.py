"""The edge whose motion is told on a casing that tapers, u_t at both, what is left out there."""

from dataclasses import replace

import numpy as np
import pytest
from runs import marched, rad_s, swept
from scenes import of_steps, scene

from geometry.hats import hats
from geometry.tip import EDGES
from rom.coarser import coarser
from rom.reduce import reduce
from simulate.errors.model_errors import BEYOND, ModelError, SecondOrder
from simulate.marching.trend import trend
from simulate.scene import Casing
from simulate.signals import spectrum
from simulate.sweeps.dataset import course
from simulate.sweeps.peak_results import results

SLOPES = {0.3: EDGES[0], -0.2: EDGES[1]}  # of the casing, and the edge that moves more
CASE = {
    "rounds": 9,
    "integrator": of_steps(640),
    "record": {
        "samples_per_round": 64,
        "spectrum_rounds": 2,
        "states_rounds": 1,
        "history": {"chord": [*EDGES]},
    },
}


@pytest.mark.parametrize("slope", SLOPES)
def test_the_motion_is_that_of_the_edge_that_moves_more(coarse_rom, slope):
    """By the history of both edges; u_t by the states and tangential rows of our own."""
    run = marched(scene(**CASE, casing__slope=slope), coarse_rom)
    by_round = run.u_r[:, 1:].T.reshape(2, 9, 64)
    swings = np.ptp(by_round, axis=2) / 2
    moves = int(swings.max(axis=1).argmax())
    assert run.edge == EDGES[moves] == SLOPES[slope]
    # rows of one product, which some processors sum in another order
    round_off = 1e-14 * abs(by_round).max()
    np.testing.assert_allclose(run.u_r[:, 0], run.u_r[:, 1 + moves], rtol=0, atol=round_off)
    assert run.each.largest[0] == pytest.approx(abs(by_round[moves]).max(), abs=round_off)
    np.testing.assert_allclose(run.each.swing, swings[moves])
    assert run.trend == trend(swings[moves][1:], run.each.worn[1:], run.time_constant)
    u_t = np.zeros((2, coarse_rom.n))
    u_t[:, 1 : 3 * len(coarse_rom.xi) : 3] = hats(EDGES, coarse_rom.xi)
    np.testing.assert_allclose(run.u_t, np.ptp(run.states @ u_t.T, axis=0) / 2)


def test_a_sweep_tells_place_and_u_t_on_a_casing_that_tapers_alone(coarse_rom):
    flat, cone = (
        swept(scene(**CASE, casing__slope=slope), coarse_rom).isel(speed_over_f1=0)
        for slope in (0.0, -0.2)
    )
    assert not {"place", "u_t"} & {*flat.variables} and "place" not in course(flat)
    assert cone["place"] == course(cone)["place"] == EDGES[1]
    assert cone["u_t"].dims == ("edge",) and cone["u_t"].min() > 1e-6
    np.testing.assert_array_equal(cone["edge"], EDGES)
    last = cone["history"].values[1, -2 * 64 :]
    np.testing.assert_allclose(cone["spectrum"], spectrum(last), rtol=1e-5, atol=1e-12)


def test_a_model_without_tangential_dofs_knows_u_t_of_a_tip_that_tapers(
    coarse_blade, coarse_matrices
):
    """By the displacements of its basis: those of a model with tangential DoFs; coarser too."""
    camber = coarse_matrices.camber.copy()
    camber[:, 0] += 0.2 * (camber[:, 2] - camber[0, 2])
    fom = replace(coarse_matrices, camber=camber)
    (rom, T), (full, _) = (reduce(fom, coarse_blade.basis, of) for of in ("r", "rtz"))
    rows = hats(EDGES, fom.xi) @ fom.rows("t")
    np.testing.assert_allclose(rom.timing_rows, rows @ T, atol=1e-12)

    def of_mode_1(model):
        """Size of u_t at both edges in mode 1 at rest, M-normalised."""
        return abs(model.timing_rows @ model.modes(0.0)[1][:, 0])

    for model in (rom, coarser(rom)[0]):
        np.testing.assert_allclose(of_mode_1(model), of_mode_1(full), rtol=1e-3)


def test_second_order_goes_with_the_square_of_the_motion_in_the_mode_that_responds(coarse_rom):
    """Between the speeds of the check linear in the square of the speed."""
    tip = np.zeros((2, 3, 2, 3))
    tip[:, 0], tip[:, 2] = -2.0, [[[4.0]], [[8.0]]]  # u_r, and u_z at both speeds, of each edge
    radius = np.array([[[-6.0, 0, 0], [-3.0, 0, 0]], [[-12.0, 0, 0], [-3.0, 0, 0]]])
    Omega = rad_s(coarse_rom, 0.3)
    found = SecondOrder(np.array([0.0, Omega * np.sqrt(2)]), tip, radius)
    a = 3e-5  # m, of motion along the radius
    second, axial = found.at_peak(
        coarse_rom, Casing(harmonics=[], ramp_rounds=0), Omega, 4, EDGES[0], a
    )
    assert second == pytest.approx((6 + 12) / 2 / 2**2 * a**2)
    assert axial == pytest.approx((4 + 8) / 2 / 2 * a)
    cone = Casing(harmonics=[], ramp_rounds=0, slope=0.5)  # u_r - s u_z is -4, then -6
    second, _ = found.at_peak(coarse_rom, cone, Omega, 4, EDGES[1], a)
    assert second == pytest.approx((6 / 16 + 12 / 36) / 2 * a**2)
    far = coarse_rom.modes(Omega)[0][5] / Omega  # the order of another mode
    assert np.isnan(
        found.at_peak(
            coarse_rom, Casing(harmonics=[], ramp_rounds=0), Omega, round(far), EDGES[0], a
        )
    ).all()


@pytest.mark.parametrize(
    ("per_square", "u_z", "word"),
    [(1e3, 1.0, ""), (1e4, 1.0, BEYOND), (1e3, 200.0, BEYOND)],
)
def test_a_peak_states_its_second_order_over_the_gap_and_is_marked(
    coarse_rom, per_square, u_z, word
):
    """Beyond a tenth of the motion, or where u_z exceeds half a strip."""
    runs = swept(scene(record__history=None, rounds=2), coarse_rom)
    tip = np.stack([np.ones((2, 3)), np.zeros((2, 3)), np.full((2, 3), u_z)])[None]
    known = SecondOrder(np.zeros(1), tip, np.full((1, 2, 3), -per_square))
    (peak,) = results(runs, coarse_rom, ModelError(None, None), second_order=known)
    motion, gap = peak.numbers["displacement"], runs.attrs["gap_m"]
    assert 0.01 < motion / gap < 10
    assert peak.numbers["second_order"] == pytest.approx(per_square * motion**2 / gap)
    relative = peak.errors["displacement"] / motion
    assert peak.errors["second_order"] == pytest.approx(2 * relative * peak.numbers["second_order"])
    assert peak.beyond == word
    (plain,) = results(runs, coarse_rom, ModelError(None, None))
    assert "second_order" not in plain.numbers and not plain.beyond
