"""Whole runs on the coarse blade's reduced model."""

import re

import numpy as np
import pytest
from dense import dense_matrices, march_dense_compiled, under
from scenes import scene

from geometry.blade import EnrichedBasis
from rom.reduce import reduce
from simulate.contact import rod_under
from simulate.run import SceneError, march, prepare, strip_stiffness
from simulate.sweep import block_speeds, load, merge, save, scene_of, sweep


CENTRAL, EXACT = "central-difference", "piecewise-exact"


def steps(per_round, scheme=CENTRAL):
    """The scene's integrator, changed."""
    return {"integrator": {"scheme": scheme, "steps_per_round": per_round}}


def rad_s(rom, over_f1):
    return 2 * np.pi * rom.f1 * over_f1


def dense_run(rom, case, setup, steps):
    """March of Eqs. (19)-(20) as printed: u_r at the end, plastic strains, steps with contact."""
    nodes, nu = len(setup.strips.g0), len(setup.strips.d)
    eps_p, zero = np.zeros((nodes, nu)), np.zeros(rom.n)
    dense = dense_matrices(rom, setup, case.damping_ratio)
    u, _, contacts = march_dense_compiled(
        dense,
        setup.strips,
        under(setup.strips),
        case.casing.ramp_rounds,
        0,
        steps,
        setup.steps,
        zero,
        zero.copy(),
        eps_p,
    )
    return u[rom.radial], eps_p, contacts


def test_modal_kernel_is_the_dense_march_over_the_first_thousand_contact_steps(coarse_rom):
    """Node 1 meets the casing a thousand steps before the round ends."""
    Omega = rad_s(coarse_rom, 0.33)
    case = scene(rounds=1, casing__ramp_rounds=0)
    setup = prepare(case, coarse_rom, Omega)
    # d = 2 g0 cos(2 theta + phase) reaches g0 where 2 theta + phase = -pi/3
    end = 2 * np.pi * (1 - 1000 / setup.steps) + coarse_rom.theta[0]
    late = scene(
        rounds=1,
        casing={
            "ramp_rounds": 0,
            "harmonics": [
                {
                    "order": 2,
                    "amplitude_gaps": 2.0,
                    "phase_deg": float(np.degrees((-np.pi / 3 - 2 * end) % (2 * np.pi))),
                }
            ],
        },
    )
    setup = prepare(late, coarse_rom, Omega)
    outcome = march(late, setup)
    u_r, eps_p, contacts = dense_run(coarse_rom, late, setup, setup.steps)
    assert contacts > 1000
    assert outcome.contact_share == contacts / setup.steps
    np.testing.assert_allclose(outcome.u_r[-1], u_r, rtol=0, atol=1e-8 * abs(u_r).max())
    wear = setup.strips.thickness * eps_p
    np.testing.assert_allclose(outcome.wear, wear, rtol=0, atol=1e-8 * wear.max())


def test_modal_kernel_is_the_dense_march_over_twenty_calm_rounds(coarse_rom):
    case = scene(rounds=20, casing__ramp_rounds=2)
    setup = prepare(case, coarse_rom, rad_s(coarse_rom, 0.38))
    outcome = march(case, setup)
    u_r, eps_p, contacts = dense_run(coarse_rom, case, setup, 20 * setup.steps)
    assert contacts > 0.02 * 20 * setup.steps
    np.testing.assert_allclose(outcome.u_r[-1], u_r, rtol=0, atol=1e-4 * abs(outcome.u_r).max())
    wear = setup.strips.thickness * eps_p
    np.testing.assert_allclose(outcome.wear, wear, rtol=0, atol=1e-4 * wear.max())


def test_nothing_moves_while_the_casing_stays_off(coarse_rom):
    case = scene(casing__harmonics=[{"order": 2, "amplitude_gaps": 0.99}])
    outcome = march(case, prepare(case, coarse_rom, rad_s(coarse_rom, 0.3)))
    assert outcome.contact_share == 0
    assert abs(outcome.u_r).max() == outcome.wear.max() == 0


def test_a_worn_through_liner_ends_the_run(coarse_rom):
    case = scene(rounds=5, liner__thickness_m=1e-6, liner__law__K=0.01)
    outcome = march(case, prepare(case, coarse_rom, rad_s(coarse_rom, 0.3)))
    assert outcome.status == "liner-exhausted"
    assert outcome.rounds < 5


def test_a_node_covers_its_footprint(coarse_rom):
    """Area w L and stiffness E w L / l in all, centred on the node to half a rod."""
    case = scene(liner__rods_per_round=4096, liner__footprint_m=6e-3)
    strips = prepare(case, coarse_rom, rad_s(coarse_rom, 0.3)).strips
    assert strips.m == 7  # 6 mm at a pitch of 2 pi 562.4 mm / 4096 = 0.86 mm
    assert strips.area * strips.m == pytest.approx(5e-3 * 6e-3, rel=1e-14)
    engaged = strips.law.E * strips.area * strips.m / strips.thickness
    assert strip_stiffness(case.liner) == pytest.approx(engaged, rel=1e-14)
    pitch = 2 * np.pi / 4096
    for i, theta in enumerate(coarse_rom.theta):
        middle = (rod_under(strips, i, 0) + (strips.m - 1) / 2) * pitch
        assert abs((middle - theta + np.pi) % (2 * np.pi) - np.pi) <= pitch / 2 * (1 + 1e-9)


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_step_is_a_share_of_the_limit_and_divides_the_round(coarse_rom, share):
    setup = prepare(scene(integrator__fraction_of_limit=share), coarse_rom, rad_s(coarse_rom, 0.3))
    assert setup.h <= share * setup.limit
    assert setup.h > 0.98 * share * setup.limit
    assert setup.steps % 64 == 0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (steps(6400), ["integrator.steps_per_round", "6400", "limit with contact of"]),
        (
            {"integrator__fraction_of_limit": 1e-9},
            ["integrator", "allowed up to 1e+09", "scheme: piecewise-exact"],
        ),
        (steps(1001), ["integrator.steps_per_round", "1001", "multiples of", "64"]),
        (steps(1001, EXACT), ["integrator.steps_per_round", "1001", "multiples of", "64"]),
    ],
)
def test_a_run_that_cannot_be_right_is_refused(coarse_rom, changes, words):
    with pytest.raises(SceneError) as caught:
        prepare(scene(**changes), coarse_rom, rad_s(coarse_rom, 0.3))
    assert all(word in str(caught.value) for word in words), str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_steps_that_the_message_allows_are_accepted(coarse_rom):
    Omega = rad_s(coarse_rom, 0.3)
    with pytest.raises(SceneError) as caught:
        prepare(scene(**steps(6400)), coarse_rom, Omega)
    least = int(re.search(r"allowed from (\d+)", str(caught.value))[1])
    assert prepare(scene(**steps(least)), coarse_rom, Omega).steps == least
    with pytest.raises(SceneError):
        prepare(scene(**steps(least - 64)), coarse_rom, Omega)


def test_a_tip_that_comes_through_the_liner_ends_the_run(coarse_rom):
    """The casing closes in by more than the thickness: no wear reaches it, the tip does."""
    case = scene(
        rounds=3,
        liner__thickness_m=1e-3,
        liner__law__unit_Pa=1e3,
        casing={"ramp_rounds": 1, "harmonics": [{"order": 0, "amplitude_m": 2e-3}]},
    )
    outcome = march(case, prepare(case, coarse_rom, rad_s(coarse_rom, 0.3)))
    assert (outcome.status, outcome.rounds) == ("liner-exhausted", 1)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"speeds": {"over_f1": [0.3, 0.6]}}, ["speeds.over_f1", "0.6", "allowed up to 0.39"]),
        ({"speeds": {"rad_s": [700.0]}}, ["speeds.rad_s", "700", "allowed up to 650"]),
        ({"record__history": {"nodes": [9]}}, ["record.history.nodes", "9", "allowed 1 to 8"]),
        ({"liner__footprint_m": 4.0}, ["liner.footprint_m", "4.0", "allowed up to 3.53"]),
        ({"liner__rods_per_round": 10}, ["liner.rods_per_round", "10", "allowed from 354"]),
    ],
)
def test_a_scene_that_does_not_fit_the_blade_is_refused(coarse_rom, changes, words):
    case = scene(**changes)
    with pytest.raises(SceneError) as caught:
        sweep(case, coarse_rom, case.speeds.omega(coarse_rom.f1))
    assert all(word in str(caught.value) for word in words), str(caught.value)
    assert "\n" not in str(caught.value)


def test_blocks_merge_into_the_sweep(coarse_rom, tmp_path):
    case = scene(rounds=1, speeds={"over_f1": {"first": 0.3, "last": 0.38, "count": 3}})
    whole = sweep(case, coarse_rom, case.speeds.omega(coarse_rom.f1))
    for block in range(2):
        speeds = block_speeds(case, coarse_rom, block, 2)
        save(sweep(case, coarse_rom, speeds), tmp_path / f"{block}.nc")
    merged = merge([load(tmp_path / f"{block}.nc") for block in (1, 0)])
    assert scene_of(merged) == case
    for name in ("speed", "wear", "spectrum", "history", "force_peak", "status"):
        np.testing.assert_array_equal(merged[name].values, whole[name].values)


def test_runs_that_end_early_stay_beside_those_that_do_not(coarse_rom):
    """A soft, thin coating is worn through at the crossing with eo(4), but not far below it."""
    case = scene(rounds=3, liner__thickness_m=1.75e-5, liner__law__K=0.01)
    result = sweep(case, coarse_rom, [rad_s(coarse_rom, 0.1), rad_s(coarse_rom, 0.31)])
    assert sorted(result.status.values) == ["liner-exhausted", "ok"]
    ended, ok = np.argsort(result.status.values)
    assert np.isnan(result.spectrum[ended]).all() and np.isfinite(result.spectrum[ok]).all()
    marched = int(result.rounds[ended])
    assert np.isfinite(result.force_peak[ended, :marched]).all()
    assert np.isnan(result.force_peak[ended, marched:]).all() and marched < 3
    assert np.isnan(result.history[ended, :, marched * 64 :]).all()


def test_a_sweep_holds_what_the_scene_records_and_no_more(coarse_rom):
    lean = scene(rounds=1, record={"samples_per_round": 64, "wear": False, "spectrum_rounds": 1})
    kept = sweep(lean, coarse_rom, [rad_s(coarse_rom, 0.35)])
    assert "spectrum" in kept
    assert not {"wear", "history", "force_peak", "force_mean"} & set(kept)
    full = sweep(scene(rounds=1), coarse_rom, [rad_s(coarse_rom, 0.35)])
    assert {"wear", "history", "force_peak", "force_mean"} <= set(full)
    # what is recorded does not change what is computed
    np.testing.assert_array_equal(kept["spectrum"].values, full["spectrum"].values)
    assert full["force_peak"].max() >= full["force_mean"].max() > 0


def test_radial_interface_serves_normal_contact_as_well_as_the_full_one(
    coarse_matrices, coarse_rom
):
    """Contact is radial: what each model has wrong is the richness of its basis, not directions.

    Both are held against 24 modes of each kind at each speed, which a few rounds tell apart.
    """
    rich = EnrichedBasis(natural_modes=24, fixed_interface_modes=24, rank_tolerance=1e-4)
    radial = reduce(coarse_matrices, EnrichedBasis(), "r")[0]
    models = [reduce(coarse_matrices, rich)[0], coarse_rom, radial]
    case = scene(rounds=2, **steps(64 * 1200))
    runs = [march(case, prepare(case, rom, rad_s(rom, 0.33))) for rom in models]
    reference, full, light = (run.u_r / case.clearance.gaps(8, radial.span)[0] for run in runs)
    assert radial.n < 45 and coarse_rom.n > 65 and models[0].n > 110
    errors = [abs(u_r - reference).max() for u_r in (full, light)]
    assert abs(reference).max() > 0.5  # of the gap: hard contact
    # measured 0.36 % and 0.40 % of the gap, and 0.33 % between them
    assert errors[1] < 1.5 * errors[0] < 0.01
    assert abs(full - light).max() < min(errors)
    wear = [run.wear.max() for run in runs]
    assert wear[2] == pytest.approx(wear[0], rel=0.05)
