"""The crossings that all outputs tell are those of K(Omega), none missing, none too many."""

import csv
import re
from io import StringIO
from types import SimpleNamespace

import numpy as np
import pytest
from runs import swept
from scenes import of_steps, scene
from scipy.linalg import eigh

from geometry.base import write_json
from geometry.blade import MODES, ORDERS
from simulate.errors.model_errors import ModelError
from simulate.sweeps.crossings import critical
from simulate.sweeps.peak_results import of_sweep, results
from workflow import margins, summary
from workflow.explore.results import arrays, facts
from workflow.figures import spectra
from workflow.figures.response import Response

CASE = {
    "rounds": 4,
    "integrator": of_steps(640),
    "record": {"samples_per_round": 64, "spectrum_rounds": 2},
    "speeds": {"over_f1": [0.2, 0.3]},
}
PRINTED = re.compile(r"Linear crossings of mode (\d), rpm: (.*)\.")


@pytest.fixture(scope="module")
def runs(coarse_rom):
    """A sweep of two lobes, whose blade operates at 0.37 and 0.21 f1(0)."""
    made = swept(scene(**CASE), coarse_rom)
    return made.assign_attrs(name="rub")


@pytest.fixture(scope="module")
def operating(coarse_rom, runs):
    rpm = 60 * coarse_rom.f1
    lines = {"design": 0.37 * rpm, "idle": 0.21 * rpm}
    excited = Response(runs).scene.casing.excites
    return {"lines": lines, "modes": MODES, "orders": [*ORDERS], "excited": excited}


@pytest.fixture(scope="module")
def told(coarse_rom, runs, operating, tmp_path_factory):
    """The summary of the sweep."""
    folder = tmp_path_factory.mktemp("told")
    peaks = results(runs, coarse_rom, ModelError(1e-4, 1e-3))
    write_json(of_sweep(runs, coarse_rom, ModelError(1e-4, 1e-3), peaks), folder / "answers.json")
    coarse_rom.save(folder / "rom.nc")
    files = SimpleNamespace(answers=[folder / "answers.json"], roms=[folder / "rom.nc"])
    return summary.numbers(files, {runs.attrs["blade"]: operating})


@pytest.fixture(scope="module")
def true(coarse_rom):
    """Speeds, rpm, by mode and order, at which f - k Omega changes its sign, of M and K."""
    speeds = np.linspace(0, coarse_rom.Omega_m, 1501)
    squares = [
        eigh(
            sum(K * Omega ** (2 * p) for p, K in enumerate(coarse_rom.K)),
            coarse_rom.M,
            eigvals_only=True,
            subset_by_index=[0, MODES - 1],
        )
        for Omega in speeds
    ]
    found = {}
    for mode, omega in enumerate(np.sqrt(squares).T, 1):
        for k in ORDERS:
            above = omega - k * speeds
            for i in np.flatnonzero(above[:-1] * above[1:] < 0):
                share = above[i] / (above[i] - above[i + 1])
                speed = speeds[i] + share * (speeds[i + 1] - speeds[i])
                found[mode, k] = speed * 30 / np.pi
    return found


def same(found, true, within):
    """Whether these are the true crossings, to a share."""
    assert {*found} == {*true}
    assert [found[of] for of in true] == pytest.approx([*true.values()], rel=within)


def test_the_crossings_of_the_summary_are_those_of_the_matrices(told, true):
    """As printed: to half a revolution a minute."""
    assert len(true) > 20
    found = {
        (int(mode), int(k)): float(rpm)
        for mode, listed in PRINTED.findall(summary.table(told))
        for k, rpm in re.findall(r"EO (\d+) (\d+)", listed)
        if float(rpm) <= max(true.values()) + 1
    }
    same(found, true, 1e-3)


def test_the_crossings_of_the_file_are_those_of_the_matrices(told, true):
    rows = csv.DictReader(StringIO(summary.margins_csv(told)))
    of_idle = [row for row in rows if row["line"] == "idle" and row["what"] == "crossing"]
    same({(int(row["mode"]), int(row["k"])): float(row["rpm"]) for row in of_idle}, true, 6e-6)


def test_the_crossings_of_the_page_are_those_of_the_matrices(coarse_rom, runs, operating, true):
    told = facts(Response(runs, coarse_rom), "", "", critical(coarse_rom, operating))["crossings"]
    inside = [
        (m, k, speed) for m, k, speed in told if speed <= coarse_rom.Omega_m / coarse_rom.omega1
    ]
    rpm = 60 * coarse_rom.f1
    same({(mode, k): speed * rpm for mode, k, speed in inside}, true, 2e-6)


def test_without_operating_speeds_the_file_has_all_crossings_once(coarse_rom, operating, true):
    rows = margins.rows(critical(coarse_rom, operating | {"lines": {}}))
    assert [row["rpm"] for row in rows] == sorted(row["rpm"] for row in rows)
    same({(row["modes"][0], row["k"]): row["rpm"] for row in rows}, true, 2e-6)
    assert {row["excited"] for row in rows if row["k"] == 2} <= {"casing"}
    assert {row["excited"] for row in rows if row["k"] == 4} == {"side band"}


def test_none_says_where_was_looked(coarse_rom, operating):
    """At 0.02 f1(0) nothing is below; a blade of one mode and EO 1 is never met."""
    low = operating | {"lines": {"idle": 0.02 * 60 * coarse_rom.f1}}
    campbell = critical(coarse_rom, low)
    (below,) = (
        line
        for line in margins.nearest(campbell, margins.rows(campbell), "idle")
        if "below" in line
    )
    rpm = 0.02 * 60 * coarse_rom.f1
    assert below.endswith(f"none of modes 1 to 4 with EO 1 to 16 from 0 to {rpm:.0f} rpm.")
    alone = critical(coarse_rom, low | {"modes": 1, "orders": [1], "lines": {}})
    top = coarse_rom.Omega_m * 30 / np.pi
    assert [*margins.met(alone)] == [
        f"Linear crossings: none of mode 1 with EO 1 from 0 to {top:.0f} rpm."
    ]


def test_of_a_casing_of_many_lobes_the_page_has_the_orders_that_the_spectrum_holds(coarse_rom):
    """64 samples hold 31 orders; side bands of 20 lobes are 40."""
    many = [{"order": 20, "amplitude_gaps": 1.2}, {"order": 40, "amplitude_gaps": 0.1}]
    case = scene(**CASE | {"integrator": of_steps(2560)}, casing__harmonics=many)
    response = Response(swept(case, coarse_rom).assign_attrs(name="rub"), coarse_rom)
    assert response.orders == [*ORDERS, 20]
    assert arrays(response)["along"].shape == (2, 17)
    spectra.over_speeds(response)


def test_tables_rank_excited_orders_first_and_few_of_the_others(told):
    rows = margins.table(told["scenes"][0]["margins"])
    for line in ("design", "idle"):
        excited = [row[4] for row in rows if row[0].startswith(line)]
        others = excited.count("-")
        assert 0 < others <= 3 and "-" not in excited[:-others]
