"""The interface for notebooks: laws, casings and sweeps with ``simulate`` alone."""

import os
import re
import subprocess
import sys
from dataclasses import replace

import numba
import numpy as np
import pytest
import xarray as xr
from refused import refused
from scenes import EXACT, EXPLICIT_TO_EXACT, SCENE, scene

from geometry.base import ROOT, ProvenanceError, SettingsError
from simulate import Law, Runs, Scene, sweep
from simulate.contact.kernel_file import kernel
from simulate.contact.rod_law import rod_law
from simulate.scene.tables import POINTS

TOLD = """
saved, kept = (of.dataset.assign_attrs(date_created="") for of in (again, runs))
print(one.status, saved.identical(kept), softer.liner.law.E, len(runs.speed))
print(worn.status.item(), worn.scene.liner.law, float(worn.wear.max()) > 0)
"""
SAID = ["ok True 0.5 2", "ok E=2000000000.0 sigma_Y=1000000.0 True"]


class Linear(Law):
    """The elastic law, defined outside the project."""

    E: float

    def stress(law, eps, eps_p):  # noqa: N805
        return law.E * eps, eps_p, law.E


class PerfectlyPlastic(Law):
    """It yields below any strain at which the slope of laws in use is largest."""

    E: float
    sigma_Y: float

    def stress(law, eps, eps_p):  # noqa: N805
        sigma = law.E * (eps - eps_p)
        if sigma <= 0.0:
            return 0.0, eps_p, 0.0
        if sigma < law.sigma_Y:
            return sigma, eps_p, law.E
        return law.sigma_Y, eps - law.sigma_Y / law.E, 0.0

    def plastic_work(law, before, after):  # noqa: N805
        return law.sigma_Y * (after - before)


def test_the_modulus_of_a_law_that_yields_early_is_found():
    assert PerfectlyPlastic(E=2e9, sigma_Y=1.0).modulus == 2e9


@pytest.mark.slow
def test_the_lines_of_the_page_run_in_an_empty_folder(coarse_rom, tmp_path):
    page = (ROOT / "simulate/README.md").read_text()
    section = page.split("\n## From Python\n")[1].split("\n## ")[0]
    blocks = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    coarse_rom.save(tmp_path / "rom-r.nc")
    (tmp_path / "scene.yaml").write_text(SCENE.replace(*EXPLICIT_TO_EXACT))
    (tmp_path / "lines.py").write_text("\n".join([*blocks, TOLD]))
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"} | {"MPLBACKEND": "agg"}
    done = subprocess.run(
        [sys.executable, "lines.py"], cwd=tmp_path, env=environment, text=True, capture_output=True
    )
    assert done.stdout.splitlines() == SAID, done.stderr


def test_a_law_from_outside_is_marched_as_the_one_it_repeats(coarse_rom):
    own = scene(integrator=EXACT, liner__law={"kind": "elastic", "E": 1.0, "unit_MPa": 2000})
    called = own.but(liner={"law": Linear(E=2e9)})
    repeated, shipped = sweep(called, coarse_rom), sweep(own, coarse_rom)
    for name in ("spectrum", "wear", "history"):
        np.testing.assert_array_equal(getattr(repeated, name), getattr(shipped, name))
    assert shipped.contact_share > 0
    # one march calls all laws of one's own
    compiled = kernel.cache_info().misses
    for law in (Linear(E=1e9), PerfectlyPlastic(E=2e9, sigma_Y=1e6)):
        sweep(own.but(liner={"law": law}), coarse_rom)
    assert kernel.cache_info().misses == compiled


def test_the_march_in_python_takes_a_law_of_ones_own_as_it_is(monkeypatch):
    law = Linear(E=2e9)
    assert rod_law(Linear, law.parameters, by_pointers=True).parameters.tolist() == [2e9]
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)
    assert rod_law(Linear, law.parameters, by_pointers=True).parameters == law.parameters


def test_the_plastic_work_of_a_law_is_in_the_ledger(coarse_rom):
    """Numerical energy is small compared with the casing's work: the law's work is counted."""
    law = PerfectlyPlastic(E=2e9, sigma_Y=1e6)
    case = scene(integrator=EXACT | {"steps_per_round": 6400}).but(liner={"law": law})
    energies = sweep(case, coarse_rom).ledger.isel(speed_over_f1=0)
    assert energies.sel(energy="plastic") > 0
    assert abs(energies.sel(energy="numerical")) < 0.2 * energies.sel(energy="casing")


def test_a_sweep_is_read_back_with_its_law_and_casing(coarse_rom, tmp_path):
    case = scene(integrator=EXACT).but(
        liner={"law": Linear(E=2e9)}, casing=lambda theta: 3e-5 * np.cos(2 * theta)
    )
    runs = sweep(case, coarse_rom)
    runs.save(tmp_path / "out.nc")
    again = Runs.load(tmp_path / "out.nc", coarse_rom)
    again.dataset.attrs.pop("date_created")  # of the file
    xr.testing.assert_identical(again.dataset, runs.dataset)
    assert type(again.scene.liner.law) is Linear and again.scene.liner.law.E == 2e9
    assert again.scene.casing == case.casing
    np.testing.assert_array_equal(sweep(again.scene, coarse_rom).wear, runs.wear)
    other = replace(coarse_rom, provenance=replace(coarse_rom.provenance, blade="another"))
    refused(ProvenanceError, Runs.load, tmp_path / "out.nc", other)
    refused(AttributeError, getattr, runs, "wears", match="wear")  # the variables that it has


@pytest.mark.parametrize(
    ("law", "remedy"),
    [
        ({"kind": "my_laws:Cubic", "E": 1.0}, r"class Cubic into workflow/laws/my_laws\.py of"),
        ({"kind": "__main__:Cubic", "E": 1.0}, "class Cubic into a file of its own"),
        (Linear, r"Linear\(E=\.\.\.\)"),  # a class in place of a law
    ],
)
def test_a_law_that_cannot_be_imported_is_named_with_the_remedy(law, remedy):
    error = refused(SettingsError, scene().but, liner={"law": law}, match=remedy)
    assert error.key.startswith("liner.law")


def test_casings_of_a_function_a_table_and_harmonics_are_equal(tmp_path):
    """cos 2 theta in three forms, up to the error of the table's spacing, (2 h)^2 / 8."""
    waves = scene(casing__harmonics=[{"order": 2, "amplitude_um": 20}])
    function = waves.but(casing=lambda theta: 2e-5 * np.cos(2 * theta))
    degrees = np.arange(0, 360, 0.5)
    depth = 20 * np.cos(2 * np.radians(degrees))
    lines = [f"{a},{d!r}" for a, d in zip(degrees, depth.tolist(), strict=True)]
    (tmp_path / "bumps.csv").write_text("\n".join(["theta_deg,depth_um", *lines]))
    table = waves.but(casing={"table": str(tmp_path / "bumps.csv"), "harmonics": None})
    theta = np.linspace(-1, 7, 3001)
    exact = waves.casing.inward(theta, 1.0)
    for case, spacing in ((function, 2 * np.pi / POINTS), (table, np.radians(0.5))):
        error = abs(case.casing.inward(theta, 1.0) - exact).max()
        assert 0.5 * 2e-5 * (2 * spacing) ** 2 / 8 < error < 1.01 * 2e-5 * (2 * spacing) ** 2 / 8
        assert Scene.model_validate_json(case.model_dump_json()) == case


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("theta_deg,depth\n0,1\n90,2\n", "line 1: columns 'theta_deg, depth'"),
        ("theta_deg,depth_mm\n0,x\n90,2\n", "'x' is no number; needs theta_deg, depth_mm (line 2)"),
        ("theta_deg,depth_mm\n0,1\n90,2,3\n", "found 3 cells (line 3)"),
        ("theta_deg,depth_mm\n90,1\n0,2\n", "should ascend, from 0"),
        ("theta_deg,depth_mm\n0,1\n400,2\n", "should ascend, from 0"),
        ("theta_deg,depth_mm\n0,1\n360,2\n", "which are one place, differ"),
        ("theta_deg,depth_mm\n0,1\n3.14,2\n6.28,1\n", "are they radians?"),
        ("theta_deg,depth_mm\n0,1\n90,2\n", "no depth from 90 on to 0 deg"),
        ("theta_deg,depth_mm\n100,1\n180,2\n270,2\n", "no depth from 270 on to 100 deg"),
        (None, "cannot be read"),
    ],
)
def test_tables_that_are_refused(tmp_path, monkeypatch, text, told):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "bumps.csv"
    if text is not None:
        path.write_text(text)
    error = refused(SettingsError, scene().but, casing={"table": str(path), "harmonics": None})
    assert error.key == "casing.table" and told in error.text


def test_a_narrow_bump_needs_no_angles_elsewhere():
    """The depth between its ends is the same all around."""
    for flat in (
        {"theta_deg": [0, 360], "depth_um": [10, 10]},
        {"theta_deg": [0, 359.9, 360], "depth_um": [0, 50, 0]},
    ):
        scene().but(casing={"table": flat, "harmonics": None})
    bump = {"theta_deg": [80, 90, 100], "depth_um": [1, 40, 0]}
    case = scene().but(casing={"table": bump, "harmonics": None})
    assert abs(case.casing.inward(np.array([4.0]), 1.0)[0]) < 1e-6


def test_a_casing_is_given_in_one_form():
    table = {"theta_deg": [0, 180], "depth_um": [0, 10]}
    error = refused(SettingsError, scene().but, casing={"table": table})
    assert (error.key, error.allowed) == ("casing", ("harmonics", "table"))
