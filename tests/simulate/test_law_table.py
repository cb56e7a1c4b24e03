"""Law of a measured curve: its two-piece case is `plastic`; the curve itself; refusals; a run."""

from pathlib import Path

import numpy as np
import pytest
from refused import refused
from scenes import scene
from systems import march_exact, strips

from geometry.base import SettingsError, check_settings
from simulate.contact.law_check import fault
from simulate.contact.rod_law import rod_law
from simulate.scene import Scene
from simulate.scene.laws.plastic import Plastic
from simulate.scene.laws.table import Tabulated
from simulate.sweeps.sweep import sweep
from simulate.sweeps.unusual import SceneWarning

E, K, SIGMA_Y = 3.0, 2.0, 0.3
ENDS = 0.1, 0.7  # strains: where `plastic` yields, and any further one
SOFT = E * K / (E + K)
TWO = {"strain": [0, *ENDS], "stress_Pa": [0, SIGMA_Y, SIGMA_Y + SOFT * (ENDS[1] - ENDS[0])]}
CURVE = {"strain": [0, 0.1, 0.3, 0.5, 0.9], "stress_Pa": [0, 0.3, 0.3, 0.7, 1.2]}


def table(curve, **more):
    return check_settings(
        Tabulated, {"kind": "table", "E": E, "unit_Pa": 1.0, "curve": curve} | more, "scene.yaml"
    )


PLASTIC = check_settings(
    Plastic,
    {"kind": "plastic", "E": E, "K": K, "sigma_Y": SIGMA_Y, "unit_Pa": 1.0},
    "scene.yaml",
)


@pytest.mark.parametrize("points", [2, 7])
def test_bilinear_curve_is_the_plastic_law(points):
    """Also with points along its line, and beyond the last one."""
    strain = np.concatenate([[0], np.linspace(*ENDS, points)])
    stress = np.minimum(E * strain, SIGMA_Y + SOFT * (strain - ENDS[0]))
    law = table({"strain": strain.tolist(), "stress_Pa": stress.tolist()})
    a = b = 0.0
    for eps in np.random.default_rng(0).uniform(0, 2, 1000):
        ours = law.stress(law.parameters, eps, a)
        theirs = PLASTIC.stress(PLASTIC.parameters, eps, b)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=2e-14)  # round-off
        work = PLASTIC.plastic_work(PLASTIC.parameters, b, theirs[1])
        assert law.plastic_work(law.parameters, a, ours[1]) == pytest.approx(work, abs=1e-14)
        a, b = ours[1], theirs[1]


def test_loading_unloading_and_work_are_those_of_the_curve():
    """And its last slope; unloading leaves a plastic strain; a short way's work has its digits."""
    law, eps = table(CURVE), np.linspace(1e-3, 1.3, 400)
    assert fault(law) is None
    stress = [law.stress(law.parameters, e, 0.0)[0] for e in eps]
    expected = np.interp(eps, CURVE["strain"], CURVE["stress_Pa"])
    expected = np.where(eps > 0.9, 1.2 + 1.25 * (eps - 0.9), expected)
    np.testing.assert_allclose(stress, expected, rtol=1e-13)
    for of, sigma in zip(CURVE["strain"][2:], CURVE["stress_Pa"][2:], strict=True):
        eps_p = law.stress(law.parameters, of, 0.0)[1]
        assert eps_p == pytest.approx(of - sigma / E, rel=1e-13)
        assert law.stress(law.parameters, eps_p, eps_p)[0] == 0.0
    for before in (0.2, 0.4):
        slope = law.plastic_work(law.parameters, before, before * (1 + 1e-12)) / (before * 1e-12)
        at = law.parameters
        k = np.searchsorted(at.alpha, before, "right") - 1
        sigma = at.sigma[k] + at.H[k] * (before - at.alpha[k])
        assert slope == pytest.approx(sigma, rel=1e-3)  # of the round-off of 1 + 1e-12


def test_curve_that_yields_at_once_has_no_elastic_part():
    law = table({"strain": [0, 0.5, 1.0], "stress_Pa": [0, 0.4, 0.9]})
    assert law.parameters.alpha[0] == law.parameters.sigma[0] == 0.0
    assert law.stress(law.parameters, 1e-6, 0.0)[1] == pytest.approx(1e-6 * (1 - 0.8 / E))


@pytest.mark.parametrize(
    ("curve", "line"),
    [
        ({"strain": [0, 0.2, 0.1], "stress_Pa": [0, 0.1, 0.2]}, "strain at point 3 (strain 0.1): "),
        ({"strain": [0, 0.1, 0.2], "stress_Pa": [0, 0.2, 0.1]}, "stress at point 3 (strain 0.2): "),
        ({"strain": [0.1, 0.2], "stress_Pa": [0, 0.1]}, "begins at strain 0.1, stress 0 Pa"),
        ({"strain": [0, 0.2], "stress_Pa": [0, 0.1, 0.2]}, "2 strain and 3 stress_MPa: give"),
        ({"strain": [0, 0.1], "stress_Pa": [0, 0.0]}, "stress is 0 throughout"),
        ({"strain": [0, 0.5, 8], "stress_Pa": [0, 1.0, 4.5]}, "the column is strain_percent"),
        ({"strain": [0, 0.1, 0.2], "stress_Pa": [0, 0.1, 0.9]}, "curve: rises by 8 Pa from "),
        ({"strain": [0, 0.1, 0.2], "stress_Pa": [0, 0.3, 0.6]}, "curve: never yields"),
        ({"strain": [0, 0.1, 0.2], "stress_Pa": [0, 0.1, 0.4]}, "curve: never yields, or rises"),
        # of its file
        ("strain,stress_MPa\n0,0\n0.1,x\n", "liner.csv: 'x' is no number"),
        ("strain;stress_MPa\n0;0\n", "liner.csv: needs commas"),
        ("strain,stress_bar\n0,0\n", "liner.csv: line 1: columns 'strain, stress_bar'"),
        ("strain,stress_MPa\n0,0\n0.1,nan\n", "liner.csv: 'nan' is no number"),
        (None, "liner.csv: cannot be read"),
    ],
)  # fmt: skip
def test_each_fault_of_a_curve_is_one_line(curve, line, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "liner.csv"
    if isinstance(curve, str):
        path.write_text(curve)
    error = refused(SettingsError, table, curve if isinstance(curve, dict) else str(path))
    assert line in str(error)


def test_file_is_read_in_its_units(tmp_path):
    path = tmp_path / "liner.csv"
    path.write_text("strain_percent, stress_MPa\n0, 0\n1, 2\n5, 3\n\n")
    curve = table(str(path), unit_Pa=1e9).curve
    assert curve.strain == (0.0, 0.01, 0.05) and curve.stress_Pa == [0.0, 2e6, 3e6]


def test_the_march_with_it_is_that_of_the_plastic_law():
    """Compiled: one mass on a rod for some cycles; the same to round-off."""
    runs = [
        march_exact(
            strips(rod_law(type(law), law.parameters), 0.0, np.zeros(4)),
            [1.0], [[1.0]], 0.0, 0.02, 2000, [0.0], [1.5], w_end=0.5,
        )
        for law in (PLASTIC, table(TWO))
    ]  # fmt: skip
    assert runs[0].eps_p.max() > 0.1
    np.testing.assert_allclose(runs[1].u, runs[0].u, atol=1e-12)
    np.testing.assert_allclose(runs[1].eps_p, runs[0].eps_p, atol=1e-13)
    assert runs[1].ledger.plastic == pytest.approx(runs[0].ledger.plastic, rel=1e-12)


def test_scene_keeps_the_curve_not_its_file(tmp_path):
    path = tmp_path / "liner.csv"
    path.write_text("strain,stress_Pa\n0,0\n0.001,1e5\n0.5,2e6\n")
    law = {"kind": "table", "E": 1.0, "unit_Pa": 1e9, "curve": str(path)}
    one = scene(liner__law=law)
    path.unlink()
    assert type(one).model_validate(one.model_dump(mode="json")) == one
    assert hash(one.liner.law)


def test_shipped_scene_has_a_law_that_the_march_can_rely_on(monkeypatch):
    """The example of simulate/README.md."""
    root = Path(__file__).parents[2]
    monkeypatch.chdir(root)
    law = Scene.load(root / "workflow/scenes/measured-liner.yaml").liner.law
    assert law.curve.stress_Pa[-1] == 40e6 and law.modulus == 1.64e9
    assert fault(law) is None


def test_wear_beyond_the_end_of_the_curve_is_told(coarse_rom):
    """The last slope goes on: the same run; the end is compared with the deepest plastic strain."""
    E, soft, yields, end = 2e9, 1e9, 1e-4, 0.1

    def run(end):
        stress = [0, E * yields, E * yields + soft * (end - yields)]
        curve = {"strain": [0, yields, end], "stress_Pa": stress}
        law = {"kind": "table", "E": 1.0, "unit_Pa": E, "curve": curve}
        of = scene(liner__law=law, speeds={"over_f1": [0.3, 0.31]}, rounds=1)
        return sweep(of.but(record={"spectrum_rounds": None}), coarse_rom)

    whole = run(end)
    depth = whole["wear"].max(("strip", "theta")).values
    farthest = (end - yields) * (1 - soft / E)
    np.testing.assert_allclose(whole["curve_share"], depth / 5e-3 / farthest, rtol=1e-6)
    assert (whole["curve_share"] < 1).all()
    worn = float(depth.max()) / 5e-3
    with pytest.warns(
        SceneWarning, match=r"liner\.law\.curve: at 2 of 2 speeds rods .* last slope"
    ):
        beyond = run(0.2 * worn)
    np.testing.assert_allclose(beyond["wear"], whole["wear"], rtol=1e-6, atol=1e-12)
    # other laws have no end
    assert "curve_share" not in sweep(scene(rounds=1, record__spectrum_rounds=None), coarse_rom)
