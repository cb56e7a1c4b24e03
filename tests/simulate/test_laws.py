"""Liner laws: assumptions of the march hold for each; each agrees with its closed forms."""

import os
import shutil
import subprocess
import sys
from math import inf
from pathlib import Path

import numpy as np
import pytest

from geometry.base import ROOT, check_settings
from simulate.scene.laws import LAWS
from simulate.scene.laws.none import NoContact
from simulate.scene.laws.rigid import Rigid

PLASTIC = {"kind": "plastic", "E": 3.0, "K": 2.0, "sigma_Y": 0.3, "unit_MPa": 1e-06}
TABLE = {  # elastic to 0.3 Pa, then with three slopes
    "kind": "table",
    "E": 3.0,
    "unit_MPa": 1e-06,
    "curve": {"strain": [0, 0.1, 0.3, 0.5, 0.9], "stress_MPa": [0, 3e-07, 3e-07, 7e-07, 1.2e-06]},
}
SAMPLES = [  # at least one of each law
    PLASTIC,
    PLASTIC | {"K": 0, "unit_MPa": 1000},  # perfect plasticity
    PLASTIC | {"sigma_Y": 0},  # wears from the first touch
    PLASTIC | {"K": 0, "sigma_Y": 0},  # bears nothing that it does not wear
    PLASTIC | {"K": 1e9},
    TABLE,
    {"kind": "elastic", "E": 3.0, "unit_MPa": 1},
    {"kind": "rigid"},
    {"kind": "none"},
]
BY_KIND = {law.model_fields["kind"].annotation.__args__[0]: law for law in LAWS}


def made(sample):
    return check_settings(BY_KIND[sample["kind"]], sample, "scene.yaml")


@pytest.fixture(params=SAMPLES, ids=lambda sample: " ".join(map(str, sample.values())))
def law(request):
    return made(request.param)


@pytest.fixture
def scale(law):
    """Pa, stress at a strain of 1; arbitrary for a law without stress."""
    return law.modulus if 0 < law.modulus < inf else 1.0


def plastic(**changes):
    return made(PLASTIC | changes)


def states(law, count=300):
    """Total strains, and former plastic strains of the rods, half of them 0."""
    rng = np.random.default_rng(1)
    past = rng.uniform(1e-6, 2, count) * rng.integers(0, 2, count)
    return rng.uniform(1e-6, 2, count), [law.stress(law.parameters, p, 0.0)[1] for p in past]


def follow(law, strains, eps_p=0.0):
    """Stress, plastic strain and tangent (3, steps) along a path of strains."""
    path = []
    for eps in strains:
        sigma, eps_p, tangent = law.stress(law.parameters, eps, eps_p)
        path.append((sigma, eps_p, tangent))
    return np.array(path).T


def test_every_law_is_tested_against_the_assumptions_of_the_march():
    assert set(BY_KIND) == {sample["kind"] for sample in SAMPLES}


def test_stress_is_no_tension_and_grows_with_the_strain_no_faster_than_the_modulus(law, scale):
    further = np.random.default_rng(2).uniform(0, 1, 300)
    for eps, eps_p, more in zip(*states(law), further, strict=True):
        (sigma, higher), (wear, worse), tangents = np.transpose(
            [law.stress(law.parameters, e, eps_p) for e in (eps, eps + more)]
        )
        assert 0 <= sigma <= higher + 1e-14 * scale  # 1e-14: round-off of strains up to 3
        assert higher - sigma <= scale * more * (1 + 1e-12) + 1e-14 * scale
        assert eps_p <= wear <= worse
        assert min(tangents) >= 0 and max(tangents) <= law.modulus


def test_tangent_is_the_derivative_of_the_stress(law, scale):
    compared, step = 0, 1e-7
    for eps, eps_p in zip(*states(law), strict=True):
        below, at, above = (
            law.stress(law.parameters, e, eps_p) for e in (eps - step, eps, eps + step)
        )
        left, right = (at[0] - below[0]) / step, (above[0] - at[0]) / step
        if abs(right - left) < 1e-6 * scale:  # no kink within the step
            compared += 1
            # round-off of stresses of a few times the scale, over the step
            assert at[2] == pytest.approx((left + right) / 2, abs=1e-7 * scale)
    assert compared >= 299


def test_elastic_energy_and_plastic_work_are_the_work_of_the_stress(law, scale):
    """Loading from the unloaded rod: the path integral against the closed form."""
    for last, before in zip(*states(law, 20), strict=True):
        eps = np.linspace(0, last, 4001)
        sigma, eps_p, _ = follow(law, eps[1:], before)
        work = np.trapezoid([0, *sigma], eps)
        closed = sigma[-1] * (last - eps_p[-1]) / 2  # elastic energy: a law unloads linearly
        closed += law.plastic_work(law.parameters, before, eps_p[-1])
        # trapezoids miss the two kinks of the path by up to scale step^2 / 8 each
        assert work == pytest.approx(closed, rel=1e-12, abs=scale * (last / 4000) ** 2 / 4)


def test_strain_cycles_do_not_release_energy(law, scale):
    """The work of cycles from strain 0 and back is the plastic work, which never decreases."""
    turns = np.random.default_rng(3).uniform(0, 1, 12) * np.linspace(0.2, 2, 12)
    taken, worn, missed, eps_p, points = 0.0, 0.0, 0.0, 0.0, 401
    for turn in turns:
        eps = np.concatenate([np.linspace(0, turn, points), np.linspace(turn, 0, points)[1:]])
        sigma, wear, _ = follow(law, eps[1:], eps_p)
        loop = np.trapezoid([0, *sigma], eps)
        # three kinks a cycle, as above
        missed += 3 * scale * (turn / (points - 1)) ** 2 / 8
        assert loop >= -missed
        taken += loop
        worn += law.plastic_work(law.parameters, eps_p, wear[-1])
        eps_p = wear[-1]
        assert taken == pytest.approx(worn, abs=missed + 1e-12 * scale)


@pytest.mark.parametrize("eps_p", [0.1, 0.37])
def test_work_of_a_tiny_increment_keeps_its_digits(law, eps_p):
    """Over the increment, the work of 1e-15 is that of 1e-10: sums from 0 would lose its digits."""
    tiny, small = (law.plastic_work(law.parameters, eps_p, eps_p + d) for d in (1e-15, 1e-10))
    steps = [(eps_p + d) - eps_p for d in (1e-15, 1e-10)]
    # the stress changes by K 1e-10, and eps_p + 1e-15 has one digit of it, as in ``steps``
    assert tiny / steps[0] == pytest.approx(small / steps[1], rel=1e-6, abs=1e-300)


@pytest.mark.parametrize("K", [2.0, 0.0])
def test_plastic_loading_follows_the_tangent_modulus_past_the_elastic_limit(K):
    """Without hardening the stress is capped; what is loaded again as far wears no more."""
    law, eps = plastic(K=K), np.linspace(0, 1, 201)
    E, K, sigma_Y = law.parameters
    sigma, eps_p, tangents = follow(law, eps)
    tangent, yields = E * K / (E + K), sigma_Y / E
    expected = np.where(eps <= yields, E * eps, sigma_Y + tangent * (eps - yields))
    np.testing.assert_allclose(sigma, expected, atol=1e-14)  # round-off of 200 updates
    assert set(tangents[1:]) == {E, tangent}
    assert eps_p[-1] == pytest.approx((E - sigma_Y) / (E + K), rel=1e-14)
    again = follow(law, [0, 1, 0, 1, 0, 1])[1][1:]
    assert again == pytest.approx((E - sigma_Y) / (E + K), rel=1e-15)


@pytest.mark.parametrize("K", [0.0, 2.0, 1e4])
def test_increments_of_eq_13_give_the_same_as_the_total_form(K):
    """Eqs. (13)-(16) as printed, increment by increment, on a random path."""
    law, strains = plastic(K=K), np.random.default_rng(1).uniform(0, 1, 400)
    E, K, sigma_Y = law.parameters
    sigma_total, eps_p_total, _ = follow(law, strains)
    sigma = alpha = last = 0.0
    for i, eps in enumerate(strains):
        trial = E * (eps - last) + sigma
        f = trial - (sigma_Y + K * alpha)
        gamma = max(f, 0.0) / (E + K)
        sigma, alpha, last = trial - E * gamma, alpha + gamma, eps
        # round-off of 400 increments
        assert alpha == pytest.approx(eps_p_total[i], abs=1e-13)
        assert max(sigma, 0) == pytest.approx(sigma_total[i], abs=1e-12)


@pytest.mark.parametrize("sigma_Y", [0.0, 1e-17, 1e-8])
def test_the_stress_of_a_yielding_rod_is_exactly_its_elastic_limit(sigma_Y):
    """Otherwise round-off of E gamma could give tension."""
    strains = np.sort(np.random.default_rng(4).uniform(0.1, 1, 300))
    sigma, eps_p, _ = follow(plastic(K=0, sigma_Y=sigma_Y), strains)
    assert sigma.max() == sigma.min() == sigma_Y and eps_p[-1] > 0.9


@pytest.mark.parametrize("K", [3e1, 3e3, 3e6, 1e9])
@pytest.mark.parametrize("eps", [0.01, 0.7])
def test_the_plastic_law_tends_to_the_elastic_one_for_large_K(K, eps):
    """The two differ by the share E / (E + K) of the stress, and so does the wear."""
    elastic, hard = made({"kind": "elastic", "E": 3.0, "unit_MPa": 1e-06}), plastic(K=K, sigma_Y=0)
    limit, no_wear, slope = elastic.stress(elastic.parameters, eps, 0.0)
    share = 3 / (3 + K)
    expected = [limit * (1 - share), share * eps, slope * (1 - share)]
    assert hard.stress(hard.parameters, eps, 0.0) == pytest.approx(expected, rel=1e-14)
    assert no_wear == 0


@pytest.mark.parametrize(
    ("sample", "parameters"),
    [(PLASTIC, (24e9, 16e9, 2.4e9)), ({"kind": "elastic", "E": 3.0}, (24e9,))],
)
def test_moduli_are_in_the_unit_of_the_scene(sample, parameters):
    law = made(sample | {"unit_MPa": 8000})
    assert law.parameters == parameters and law.modulus == 24e9


def test_only_the_rigid_law_is_rigid_and_only_none_has_no_contact():
    assert Rigid(kind="rigid").modulus == inf
    assert [law for law in LAWS if not law.deforms] == [Rigid]
    assert [law for law in LAWS if not law.touches] == [NoContact]


PERFECT = '''
"""Perfect plasticity."""

from typing import ClassVar, Literal

from pydantic import Field

from simulate.scene.laws.elastic import Elastic


def stress(law, eps, eps_p):
    """Bears 1 Pa and no more."""
    if law.E * (eps - eps_p) > 1.0:
        return 1.0, eps - 1.0 / law.E, 0.0
    return max(law.E * (eps - eps_p), 0.0), eps_p, law.E


class Perfect(Elastic):
    """Perfect plasticity."""

    stress: ClassVar = staticmethod(stress)
    kind: Literal["{kind}"] = Field(description="perfect plasticity")
'''
USE = """
from scenes import scene
from geometry.base import SettingsError

law = scene(liner__law={"kind": "perfect", "E": 2.0, "unit_MPa": 1}).liner.law
print(law.stress(law.parameters, 0.5, 0.1))
try:
    scene(liner__law={"kind": "perfekt"})
except SettingsError as error:
    print(error.key, *error.allowed)
"""


@pytest.fixture
def with_a_file_more(tmp_path):
    """Run Python on a copy of the package with a law file more; returns what it did."""

    def run(kind):
        for package in ("geometry", "simulate"):
            shutil.copytree(ROOT / package, tmp_path / package)
        (tmp_path / "simulate/scene/laws/perfect.py").write_text(PERFECT.replace("{kind}", kind))
        path = os.pathsep.join([str(tmp_path), str(Path(__file__).parent)])
        environment = os.environ | {"PYTHONPATH": path}
        command = [sys.executable, "-c", USE]
        return subprocess.run(
            command, cwd=tmp_path, env=environment, capture_output=True, text=True
        )

    return run


def test_a_file_in_the_folder_is_a_law_in_the_scene(with_a_file_more):
    done = with_a_file_more("perfect")
    files = (ROOT / "simulate/scene/laws").glob("[!_]*.py")
    kinds = " ".join(sorted([*(file.stem for file in files), "perfect"]))
    said = ["(1.0, 0.4999995, 0.0)", f"liner.law.kind {kinds}"]
    assert done.stdout.splitlines() == said, done.stderr


def test_two_files_with_one_name_are_refused(with_a_file_more):
    assert "law: more than one model has kind: elastic" in with_a_file_more("elastic").stderr
