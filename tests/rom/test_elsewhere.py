"""Reduced models made elsewhere: ours, written as the page says, and one fault at a time."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from refused import refused

from rom.coarser import coarser
from rom.elsewhere import described, read_elsewhere
from rom.model import RomError
from simulate.errors.accuracy import require_model
from simulate.errors.model_errors import ModelErrors

PAGE = Path(__file__).parents[2] / "rom/README.md"


def written(rom, path, **changes):
    """The fields of the contract, with other values of some; None leaves one out."""
    values = {
        "M": (("dof", "dof_"), rom.M),
        "K": (("power", "dof", "dof_"), rom.K),
        "directions": ("direction", list(rom.directions)),
        "xi": ("xi", rom.xi),
        "camber": (("place", "rtz"), rom.camber),
        "Omega_m": rom.Omega_m,
        "span": rom.span,
        "power": ("power", 2 * np.arange(len(rom.K))),
    } | changes
    kept = {name: value for name, value in values.items() if value is not None}
    xr.Dataset(kept).to_netcdf(path, engine="h5netcdf")
    return path


def test_model_is_that_of_the_file(coarse_rom, tmp_path):
    path = written(coarse_rom, tmp_path / "mine.nc")
    rom = read_elsewhere(path, "mine")
    for name in ("M", "K", "xi", "camber", "directions", "Omega_m", "span"):
        np.testing.assert_array_equal(getattr(rom, name), getattr(coarse_rom, name))
    assert rom.f1 == pytest.approx(coarse_rom.f1, rel=1e-8)  # of all modes; round-off
    assert (rom.provenance.blade, rom.elsewhere, rom.growth.size) == ("mine", True, 0)
    rom.save(tmp_path / "rom-r.nc")
    assert type(rom).load(tmp_path / "rom-r.nc").provenance == rom.provenance


def test_accuracy_takes_a_foreign_model_and_says_what_it_does_not_know(coarse_rom, tmp_path):
    rom = read_elsewhere(written(coarse_rom, tmp_path / "mine.nc"), "mine")
    none = tmp_path / "none.nc"
    require_model(0.01, ModelErrors.of(none, none, rom).largest)
    half, _ = coarser(rom)
    ours, _ = coarser(coarse_rom)
    assert len(half.xi) == len(rom.xi) // 2
    assert half.modes(0.0)[0][0] == pytest.approx(ours.modes(0.0)[0][0], rel=1e-6)


def with_values(A, *changes):
    """A copy with other values at some places."""
    A = A.copy()
    for at, value in changes:
        A[at] = value
    return A


OF_M, OF_K = ("dof", "dof_"), ("power", "dof", "dof_")  # dimensions
FAULTS = {  # by the word that the message has for them: changes of the file
    "M: not symmetric": lambda rom: {
        "M": (OF_M, with_values(rom.M, ((0, 1), rom.M[0, 1] + 0.1 * abs(rom.M).max())))
    },
    "M: not positive definite": lambda rom: {"M": (OF_M, -rom.M)},
    "K: not positive definite at 0 rad/s": lambda rom: {
        "K": (OF_K, with_values(rom.K, (0, -rom.K[0])))
    },
    "K: not positive definite at 4": lambda rom: {
        "K": (OF_K, with_values(rom.K, (1, -2 * rom.K[0] / rom.Omega_m**2), (slice(2, None), 0)))
    },  # beyond 460 rad/s
    "lacks camber, span": lambda rom: {"camber": None, "span": None},
    "power: ": lambda rom: {"power": ("power", np.arange(len(rom.K)))},
    "directions: ": lambda rom: {"directions": ("direction", ["tangential"])},
    "xi: must ascend": lambda rom: {"xi": ("xi", rom.xi[::-1])},
    "nodes of hat functions begin at 0": lambda rom: {
        "xi": ("xi", (np.arange(len(rom.xi)) + 0.5) / len(rom.xi))
    },
    "camber: z falls": lambda rom: {"camber": (("place", "rtz"), rom.camber[::-1])},
    "span: 140 m": lambda rom: {"span": 1e3 * rom.span},
    "span: 0.6 m, radius of the tip 0.5624 m": lambda rom: {"span": 0.6},
    "theta goes over 4.539 rad": lambda rom: {
        "camber": (("place", "rtz"), rom.camber * [1, 180 / np.pi, 1])
    },
    "Omega_m: -650 rad/s": lambda rom: {"Omega_m": -rom.Omega_m},
    "M, K: first frequency at rest 8201 Hz": lambda rom: {"M": (OF_M, rom.M / 1e3)},
    "M, K: first frequency at rest 8.201 Hz": lambda rom: {"K": (OF_K, rom.K / 1e3)},
    "f1: nan Hz": lambda rom: {"f1": np.nan},
    "Omega_m: 1 dimensions": lambda rom: {"Omega_m": ("speed", [1.0, 2.0])},
    "span: 0 dimensions of type <U1": lambda rom: {"span": "x"},
    "M: 2 dimensions of type complex128": lambda rom: {"M": (OF_M, rom.M + 0j)},
    "K (0, ": lambda rom: {"K": (OF_K, rom.K[:0]), "power": ("power", [])},
    "must be above 1e-14 of its largest": lambda rom: {
        "M": (OF_M, with_values(rom.M, (-1, 0), ((slice(None), -1), 0), ((-1, -1), 1e-25)))
    },
    "Omega_m and the speeds of K in rad/s": lambda rom: {"Omega_m": rom.Omega_m * 60 / (2 * np.pi)},
    "f1: 0.259": lambda rom: {"f1": 1e-3 * rom.f1},
    "point 2 lies": lambda rom: {
        "points": (
            ("point", "rtz"),
            rom.line(rom.xi) + 0.02 * np.outer(np.arange(len(rom.xi)) == 1, [0, 0, 1]),
        )
    },
    "holds values that are not finite": lambda rom: {"span": np.nan},
    "xi: 0 places": lambda rom: {"xi": ("none", [])},
    "xi: 1 places": lambda rom: {"xi": ("one", [0.5])},
    "xi: 8 places with 0 directions": lambda rom: {"directions": ("none", np.array([], str))},
    "across: needs 1, or 2 for patches": lambda rom: {"across": 2},
    "across: needs 1": lambda rom: {"across": np.nan},
    "sides (2, 3)": lambda rom: {"sides": (("side", "there"), np.ones((2, 3)))},
    "sides: need angles": lambda rom: {"sides": (("side", "place"), rom.sides[::-1])},
    "sides: need angles (rad)": lambda rom: {"sides": (("side", "place"), np.degrees(rom.sides))},
    "xi: 12 places": lambda rom: {
        "xi": ("xi", np.linspace(0, 1, 12)),
        "M": (OF_M, rom.M[:9, :9]),
        "K": (OF_K, rom.K[:, :9, :9]),
    },
}


@pytest.mark.parametrize("fault", FAULTS)
def test_each_fault_is_a_line_with_its_file(fault, coarse_rom, tmp_path):
    path = written(coarse_rom, tmp_path / "mine.nc", **FAULTS[fault](coarse_rom))
    with pytest.raises(RomError) as caught:
        read_elsewhere(path, "mine")
    lines = str(caught.value).splitlines()
    assert any(fault in line for line in lines), lines
    assert all(line.startswith(f"{path}: ") for line in lines)


def test_file_of_text_is_refused(tmp_path):
    (tmp_path / "text.nc").write_text("M")
    refused(RomError, read_elsewhere, tmp_path / "text.nc", "mine", match="read as NetCDF 4")


def test_points_have_a_strip_each(coarse_rom, tmp_path):
    """Points on the camber line in place of hats."""
    xi = (np.arange(len(coarse_rom.xi)) + 0.5) / len(coarse_rom.xi)
    points = coarse_rom.line(xi)
    path = written(
        coarse_rom, tmp_path / "mine.nc", xi=("xi", xi), points=(("point", "rtz"), points)
    )
    rom = read_elsewhere(path, "mine")
    assert rom.of_points
    refused(RomError, coarser, rom)


def test_superelements_of_each_speed_are_not_one_model(coarse_rom):
    """The trap: interpolated over coordinates of their own each, f1 between is not the blade's.

    At each of the two ends the frequencies are exact.
    """
    K = [coarse_rom.stiffness(Omega) for Omega in (0.0, coarse_rom.Omega_m)]
    turned = np.linalg.qr(np.random.default_rng(1).normal(size=(coarse_rom.n,) * 2))[0]
    own = np.linalg.cholesky(coarse_rom.M)
    T = np.linalg.solve(own.T, turned @ own.T)  # T^T M T = M: other coordinates, same mass
    trap = replace(
        coarse_rom,
        K=np.stack([K[0], (T.T @ K[1] @ T - K[0]) / coarse_rom.Omega_m**2]),
    )
    for Omega in (0.0, coarse_rom.Omega_m):
        np.testing.assert_allclose(trap.modes(Omega)[0], coarse_rom.modes(Omega)[0], rtol=1e-6)
    middle = coarse_rom.Omega_m / np.sqrt(2)
    assert trap.modes(middle)[0][0] > 3 * coarse_rom.modes(middle)[0][0]


def test_growth_and_f1_are_described(coarse_rom, tmp_path):
    growth = (("growth_power", "growth_xi"), coarse_rom.growth)
    rom = read_elsewhere(written(coarse_rom, tmp_path / "mine.nc", growth=growth), "mine")
    said = "\n".join(described(rom))
    assert f"frequencies at rest (Hz): {coarse_rom.f1:.2f}" in said
    assert re.search(r"growth of the tip at Omega_m: 0\.0", said)
