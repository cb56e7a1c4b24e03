"""The reduced model as a file and as a model that knows its limits."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from rom.model import Rom, RomError, direction_names

POINTS = np.array([[0.3, 0.4, -0.01], [0.0, -0.5, 0.02]])


@pytest.fixture
def rom():
    """Two nodes and one more DoF; K(1) is three times K(0) and K(2) nine."""
    K0 = np.diag(np.arange(1.0, 8)) + 0.1
    return Rom(
        M=np.eye(7) + 0.01,
        K=np.stack([K0, 2 * K0, 0 * K0]),
        directions=("radial", "tangential", "axial"),
        points=POINTS,
        Omega_m=2.0,
        f1=1 / 3,
        span=0.14,
        provenance="mesh 5ead; eta 1; rank tolerance 0.0001",
    )


def test_file_reads_back_bit_for_bit(rom, tmp_path):
    rom.save(tmp_path / "rom.nc")
    again = Rom.load(tmp_path / "rom.nc")
    for name in vars(rom):
        np.testing.assert_array_equal(getattr(again, name), getattr(rom, name))
        assert type(getattr(again, name)) is type(getattr(rom, name))


def test_file_explains_itself(rom, tmp_path):
    rom.save(tmp_path / "rom.nc")
    with xr.open_dataset(tmp_path / "rom.nc", engine="h5netcdf") as file:
        assert list(file["power"].values) == [0, 2, 4]
        assert list(file["direction"].values) == ["radial", "tangential", "axial"]
        assert list(file["node"].values) == [1, 2]
        assert file["M"].attrs["units"] == "kg"
        assert file.attrs["provenance"] == rom.provenance


def test_nodes_by_radius_angle_and_dof(rom):
    assert rom.n == 7
    assert rom.radius == pytest.approx([0.5, 0.5])
    assert rom.theta == pytest.approx([np.arctan(4 / 3), -np.pi / 2])
    np.testing.assert_array_equal(rom.radial, [0, 3])


def test_radial_dofs_follow_the_directions(rom):
    np.testing.assert_array_equal(replace(rom, directions=("radial",)).radial, [0, 1])
    np.testing.assert_array_equal(replace(rom, directions=direction_names("rt")).radial, [0, 2])


@pytest.mark.parametrize("letters", ["", "t", "rz", "rtzz"])
def test_other_directions_are_refused(letters):
    with pytest.raises(RomError, match=r"interface directions '.*': allowed r, rt, rtz"):
        direction_names(letters)


def test_modes_diagonalise_both_matrices(rom):
    omega, Phi = rom.modes(1.0)
    # round-off
    np.testing.assert_allclose(Phi.T @ rom.M @ Phi, np.eye(7), atol=1e-14)
    np.testing.assert_allclose(Phi.T @ rom.stiffness(1.0) @ Phi, np.diag(omega**2), atol=1e-13)
    np.testing.assert_allclose(rom.modes(2.0)[0], 3 * rom.modes(0.0)[0], rtol=1e-14)


@pytest.mark.parametrize("Omega", [-1e-9, 2.001, np.nan, np.inf])
def test_speed_outside_the_range_is_refused(rom, Omega):
    with pytest.raises(RomError, match=r"^speed \S+ rad/s is outside \[0, 2\] rad/s$"):
        rom.stiffness(Omega)


def test_both_ends_of_the_range_are_inside(rom):
    np.testing.assert_array_equal(rom.stiffness(0), rom.K[0])
    np.testing.assert_allclose(rom.stiffness(2.0), 9 * rom.K[0], rtol=1e-15)


def test_unstable_blade_is_refused(rom):
    softening = replace(rom, K=np.stack([rom.K[0], -0.5 * rom.K[0], 0 * rom.K[0]]))
    softening.modes(1.0)
    with pytest.raises(
        RomError, match=r"K\(Omega\) is not positive definite at 1\.5 rad/s .* basis.speeds"
    ):
        softening.modes(1.5)


def test_missing_file_says_how_to_build_it(tmp_path):
    path = tmp_path / "rom-rtz.nc"
    with pytest.raises(RomError) as caught:
        Rom.load(path)
    assert str(caught.value) == f"{path}: no such file; build it with `./run snakemake <file>`"


def test_another_file_is_no_reduced_model(tmp_path):
    text, netcdf = tmp_path / "text.nc", tmp_path / "other.nc"
    text.write_text("M: 3")
    xr.Dataset({"N": ("x", [1.0])}).to_netcdf(netcdf, engine="h5netcdf")
    for path in (text, netcdf):
        with pytest.raises(RomError, match="is no reduced model") as caught:
            Rom.load(path)
        assert str(caught.value).startswith(f"{path}: ")
