"""The energy ledger: its balance, its terms, and the numerical energy of the schemes."""

import numpy as np
import pytest
from rubs import LAWS, ROUND, SCHEMES, lost, pressed, rub
from runs import marched
from scenes import blade_balance, of_steps, scene
from systems import elastic_rod, march_exact

from simulate.contact.strips import Tip
from simulate.marching import check_scene
from simulate.marching.piecewise_exact import coefficients, share_of_end


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_blade_s_balance_holds_to_round_off(scheme, law):
    """Its energy and its damping are the start's and the work: 1200 steps of round-off."""
    run = rub(scheme, law)
    ledger = run.ledger
    assert run.contacts > 100
    error = ledger.blade + ledger.damping - run.start_energy - ledger.work
    assert abs(error) < 1e-11 * (ledger.damping + run.start_energy)
    assert min(ledger.casing, ledger.damping, ledger.released) > 0
    assert (ledger.plastic > 0) == (law == "plastic")


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("h", [1e-3, 1e-2, 0.1, 1.0, 10.0])
def test_piecewise_exact_never_creates_energy(law, h):
    """By convexity, whatever the step; loaded rods 1e6 times stiffer than the modes do not help."""
    ledger = rub("piecewise-exact", law, h=h).ledger
    assert ledger.numerical <= 1e-12 * ledger.casing
    assert ledger.numerical < 0


RUBS = {
    "flat": {},
    "stiff": {"h": 0.3},
    "several rods a step": {"nu": 1500, "length": 28.3},
    "footprint all around": {"nu": 7, "length": 7.0},
    "rounded": {"tip": ROUND, "length": 1.7},
    "steep, its edge ahead": {"tip": Tip(-0.1, 0.0, 0.85, 0.85)},
    "steep, its edge behind": {"tip": Tip(0.1, 0.0, -0.85, 0.85)},
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("case", RUBS)
def test_no_share_of_the_end_creates_energy(law, case):
    """A mean force loses the less, the smaller w_end; with w_end = 0 nothing, whatever the step."""
    runs = [
        rub("piecewise-exact", law, w_end=w_end, **RUBS[case]) for w_end in (0.0, 1e-3, 0.1, 1.0)
    ]
    none, *lost = (-run.ledger.numerical for run in runs)
    assert runs[0].contacts > 100
    assert abs(none) < 1e-12 * runs[0].ledger.casing
    assert min(lost) > 0.0 and lost == sorted(lost)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("scheme", "order"), [("central-difference", 1), ("piecewise-exact", 3)])
def test_numerical_energy_falls_with_the_step(scheme, order, law):
    """Force times way in a step is off by w_end, of order two, times the square of the way."""
    energies = np.array(lost(scheme, law, (1200, 2400, 4800)))
    assert energies.min() > 0
    np.testing.assert_allclose(np.log2(energies[:-1] / energies[1:]), order, atol=0.2 / order)


def test_liner_s_energies_are_those_of_its_rods():
    ledger, expected = pressed()
    for name, energy in expected.items():
        assert getattr(ledger, name) == pytest.approx(energy), name
    assert ledger.numerical == pytest.approx(0, abs=1e-11 * ledger.casing)


@pytest.mark.parametrize("w_end", [0.0, None, 1.0], ids=["mean", "own", "end"])
@pytest.mark.parametrize("b", np.logspace(-3, 6, 10))
@pytest.mark.parametrize("wh", [0.0005, 0.3, 2.0, np.pi, 17.0, 50.0])
def test_the_step_map_with_elastic_contact_is_not_amplifying(w_end, b, wh):
    """Its spectral radius with one strip engaged, b = C k, is at most one."""
    w_end = float(share_of_end(b)) if w_end is None else w_end
    for xi in (0.0, 0.05, 0.7):
        omega = np.array([wh, 3.1 * wh, 0.37 * wh])
        Phi_b = np.array([[0.8, 1.7, -0.5]])
        scheme = coefficients(omega, Phi_b, xi, 1.0)
        a, s, gain = scheme.a[:3], scheme.b[:3], scheme.gain[:, :3]
        free = np.block([[np.diag(a), np.diag(s)], [-np.diag(s), np.diag(a)]])
        k, end, start = b / scheme.C[0, 0], (1 + w_end) / 2, (1 - w_end) / 2
        u, u_p = np.r_[Phi_b[0], np.zeros(3)], Phi_b[0] @ free[:3]
        force = k * (end * u_p + start * u) / (1 + b * end)  # k (end u+ + start u), u+ = u_p - C F
        step = free - np.outer(np.r_[gain[0] * Phi_b[0], gain[1] * Phi_b[0]], force)
        assert abs(np.linalg.eigvals(step)).max() <= 1 + 1e-12


@pytest.mark.slow
@pytest.mark.parametrize(
    ("integrator", "least"),
    [
        ({"scheme": "central-difference", "fraction_of_limit": 0.5}, 1e-6),
        (of_steps(8192), 1e-11),
    ],
    ids=["central-difference", "piecewise-exact"],
)
@pytest.mark.parametrize("tilt", [0.02, 0.15])
def test_tangential_force_follows_the_tilt_and_balances(coarse_rom, integrator, least, tilt):
    """A plane tip has one normal: the force's ratio is its slope. Balances as the radial one."""
    case = scene(
        integrator=integrator,
        liner__rods_per_round=32749,  # that see the edge, and that no 8192 steps meet alike
        contact={"tangential": True, "profile": {"tilt": tilt}},
    )
    check_scene(case, coarse_rom)
    outcome = marched(case, coarse_rom, 0.33)
    ledger = outcome.ledger
    assert outcome.status == "ok" and outcome.contact_share > 0.02
    ratio = outcome.force_tangential_mean.sum() / outcome.force_mean.sum()
    assert ratio == pytest.approx(tilt, rel=1e-10)
    assert abs(blade_balance(ledger)) < 1e-8 * ledger.damping
    assert abs(ledger.numerical) < least * ledger.casing


def test_the_energy_of_an_engaged_rod_is_the_work_of_blade_and_casing():
    """One mode on one elastic rod: at rest under a casing that came in, k_s d/(k_s + k)."""
    omega, k, d = 2.0, 12.0, 0.3
    system = elastic_rod(k)._replace(d=np.full(4, d), d_window=np.full(4, d))
    run = march_exact(system, [omega], [[1.0]], 0.5, 0.05, 4000, [0.0], [0.0], ramp_rounds=0.5)
    u = -k * d / (k + omega**2)
    assert run.u[-1, 0] == pytest.approx(u, rel=1e-10)
    assert run.ledger.elastic == pytest.approx(k * (u + d) ** 2 / 2, rel=1e-10)
    assert run.ledger.blade == pytest.approx(omega**2 * u**2 / 2, rel=1e-10)
