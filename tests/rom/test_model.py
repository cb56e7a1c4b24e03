"""The reduced model: its file, its methods, and speeds and directions that are refused."""

from dataclasses import replace

import h5py
import numpy as np
import pytest
import xarray as xr
from refused import refused
from scipy.linalg import eigvalsh

from geometry.base import Provenance, ProvenanceError, code_hash, seal
from geometry.stored import ENTRY, FORMAT, HEAP, write
from rom.elsewhere import read_elsewhere
from rom.model import CODE, DIRECTIONS, Rom, RomError, require_letters
from simulate.errors.model_errors import ModelErrors

PROVENANCE = Provenance("blade", "5ead", {"patches": 3}, code_hash(*CODE))
CAMBER = np.array([[0.5, 0.2, -0.02], [0.51, 0.1, 0.0], [0.5, 0.1, 0.04]])


@pytest.fixture
def rom():
    """Two patches and one more DoF; K(1) is three times K(0) and K(2) nine."""
    K0, M = np.diag(np.arange(1.0, 8)) + 0.1, np.eye(7) + 0.01
    return Rom(
        M=M,
        K=np.stack([K0, 2 * K0, 0 * K0]),
        directions=("radial", "tangential", "axial"),
        xi=np.array([0.0, 1.0]),
        points=np.empty((0, 3)),
        camber=CAMBER,
        Omega_m=2.0,
        f1=float(np.sqrt(eigvalsh(K0, M)[0]) / (2 * np.pi)),
        span=0.14,
        provenance=PROVENANCE,
    )


@pytest.mark.parametrize("chunks", [None, (1000, 1000)])
def test_a_file_that_declares_more_than_it_holds_is_not_read(tmp_path, chunks):
    """Some kilobytes, sealed or from elsewhere, that would be 51 GB of zeros."""
    path = tmp_path / "rom.nc"
    with h5py.File(path, "w") as file:
        file.create_dataset("M", (80_000, 80_000), float, chunks=chunks)
    assert path.stat().st_size < 1e4
    refused(RomError, read_elsewhere, path, "mine", match=r"declares 5.12e\+10 bytes")
    seal(path)
    refused(ProvenanceError, Rom.load, path, match=r"declares 5.12e\+10 bytes")


@pytest.mark.parametrize("entry", [bytes(16), b"\1" + bytes(7) + b"\xf0" + b"\xff" * 7])
def test_a_heap_of_texts_without_an_end_is_not_read(rom, tmp_path, entry):
    """HDF5 would read its first entry for ever."""
    path = tmp_path / "rom.nc"
    rom.save(path)
    data = path.read_bytes()
    at = data.index(HEAP) + ENTRY
    path.write_bytes(data[:at] + entry + data[at + ENTRY :])
    seal(path)
    refused(ProvenanceError, Rom.load, path, match="a heap is damaged")


def test_file_explains_itself(rom, tmp_path):
    rom.save(tmp_path / "rom.nc")
    with xr.open_dataset(tmp_path / "rom.nc", engine="h5netcdf") as file:
        assert list(file["power"].values) == [0, 2, 4]
        assert list(file["directions"].values) == ["radial", "tangential", "axial"]
        assert list(file["xi"].values) == [0, 1]
        assert file["M"].attrs["units"] == "kg"
        assert Provenance.parse(file.attrs["provenance"], "") == rom.provenance


@pytest.mark.parametrize(
    ("attributes", "key", "found", "allowed"),
    [
        ({}, "", None, None),
        ({"format": FORMAT - 1}, "format", FORMAT - 1, FORMAT),
        ({"format": FORMAT + 1}, "format", FORMAT + 1, FORMAT),
        # as of an older version
        ({"format": FORMAT, "provenance": "mesh 5ead; basis {}"}, "", None, None),
    ],
)
def test_file_of_another_format_is_refused(rom, tmp_path, attributes, key, found, allowed):
    """Also of the same code, by the model and by what only looks into a check."""
    path = tmp_path / "rom.nc"
    rom.save(path)
    with h5py.File(path, "a") as file:
        del file.attrs["format"]
        file.attrs.update(attributes)
    seal(path)
    for read in (Rom.load, lambda path: ModelErrors.of(path, None, rom)):
        error = refused(ProvenanceError, read, path)
        assert (error.file, error.key) == (str(path), key)
        assert (error.value, error.allowed) == (found, allowed)


@pytest.mark.parametrize("letters", ["r", "rt", "rtz"])
def test_displacements_along_the_chord_are_those_of_the_hat_functions(rom, letters):
    """From c = (1, 3) of one direction: linear along the chord, beyond its ends too."""
    model = replace(rom, directions=tuple(DIRECTIONS[letter] for letter in letters))
    xi = np.array([0.0, 0.25, 1.0, 1.1])
    for first, letter in enumerate(letters):
        u = np.zeros(model.n)
        u[[first, len(letters) + first]] = 1, 3
        for other in letters:
            expected = (1 + 2 * xi) * (other == letter)
            np.testing.assert_allclose(model.rows(xi, other) @ u, expected, atol=1e-15)
    assert not model.rows(xi)[:, 2 * len(letters) :].any()  # modes hold the interface


@pytest.mark.parametrize(("letter", "file"), [("t", "rom-rt.nc"), ("z", "rom-rtz.nc")])
def test_direction_that_was_not_reduced_is_refused(rom, letter, file):
    radial = replace(rom, directions=("radial",))
    assert file in refused(RomError, radial.rows, radial.xi, letter).text


def test_line_is_the_camber_line_between_its_places(rom):
    assert rom.n == 7
    np.testing.assert_array_equal(rom.line(np.array([0.0, 0.5, 1.0])), CAMBER)
    np.testing.assert_allclose(rom.line(np.array([0.75])), [(CAMBER[1] + CAMBER[2]) / 2])


@pytest.mark.parametrize("letters", ["", "t", "rz", "rtzz"])
def test_other_directions_are_refused(letters):
    assert refused(RomError, require_letters, letters).value == letters


def test_modes_diagonalise_both_matrices(rom):
    omega, Phi = rom.modes(1.0)
    # round-off
    np.testing.assert_allclose(Phi.T @ rom.M @ Phi, np.eye(7), atol=1e-14)
    np.testing.assert_allclose(Phi.T @ rom.stiffness(1.0) @ Phi, np.diag(omega**2), atol=1e-13)
    np.testing.assert_allclose(rom.modes(2.0)[0], 3 * rom.modes(0.0)[0], rtol=1e-14)


@pytest.mark.parametrize("Omega", [-1e-9, 2.001, np.nan, np.inf])
def test_speed_outside_the_range_is_refused(rom, Omega):
    assert refused(RomError, rom.stiffness, Omega).allowed == (0, 2)


def test_both_ends_of_the_range_are_inside(rom):
    np.testing.assert_array_equal(rom.stiffness(0), rom.K[0])
    np.testing.assert_allclose(rom.stiffness(2.0), 9 * rom.K[0], rtol=1e-15)


def test_unstable_blade_is_refused(rom):
    softening = replace(rom, K=np.stack([rom.K[0], -0.5 * rom.K[0], 0 * rom.K[0]]))
    softening.modes(1.0)
    refused(RomError, softening.modes, 1.5, match=r"not positive definite at 1\.5 rad/s")


def test_another_file_or_none_is_no_reduced_model(tmp_path):
    text, netcdf = tmp_path / "text.nc", tmp_path / "other.nc"
    text.write_text("M: 3")
    write(xr.Dataset({"N": ("x", [1.0])}), netcdf)
    for path in (text, netcdf, tmp_path / "none.nc"):
        assert refused(ProvenanceError, Rom.load, path).file == str(path)
