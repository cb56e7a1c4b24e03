"""Matrices of the coarse blade, written as another program would, and read back."""

import numpy as np
import pytest
from scipy.io import mmwrite
from scipy.sparse import save_npz

from fem.given import GivenError, read_matrices
from fem.matrices import Matrices
from fem.solid import read_solid
from geometry.errors import SettingsError
from geometry.given import GivenMatrices
from geometry.settings import check_settings
from rom.check import check
from rom.full_model import solve
from rom.reduce import reduce


@pytest.fixture(scope="module")
def files(coarse_matrices, coarse_blade, coarse_mesh, tmp_path_factory):
    """The folder with the files, and the settings that name them."""
    folder = tmp_path_factory.mktemp("given")
    fom = coarse_matrices
    mmwrite(folder / "M.mtx", fom.M, symmetry="symmetric", precision=17)
    for i, K in enumerate(fom.K):
        save_npz(folder / f"K{i}.npz", K)
    np.savetxt(folder / "nodes.csv", fom.coordinates, "%.17g", ",", header="x, y, z (m)")
    solid = read_solid(str(coarse_mesh.mesh), coarse_blade.material)
    row = np.full(solid.V.dofmap.index_map.size_local, -1)
    row[solid.free[::3] // 3] = np.arange(len(fom.coordinates))
    np.savetxt(folder / "tip.csv", row[solid.tip] + 1, "%d", ",")
    save_npz(folder / "S.npz", fom.S)
    r, theta, z = fom.camber.T
    line = np.column_stack([r * np.cos(theta), r * np.sin(theta), z])
    np.savetxt(folder / "camber.csv", line, "%.17g", ",")
    hub = solid.clamped_coordinates()
    keys = {
        "M": "M.mtx",
        "K": {float(speed): f"K{i}.npz" for i, speed in enumerate(fom.speeds)},
        "nodes": "nodes.csv",
        "hub_radius_m": float(np.hypot(hub[:, 0], hub[:, 1]).mean()),
    }
    return folder, keys


def settings(keys, **others):
    return check_settings(GivenMatrices, {"full_matrices": keys, "patches": 8} | others, "test")


@pytest.mark.parametrize("how", ["tip", "S"])
def test_reduced_model_is_that_of_our_own_matrices(how, files, coarse_blade, coarse_matrices):
    folder, keys = files
    more = {"tip": "tip.csv"} if how == "tip" else {"S": "S.npz", "camber": "camber.csv"}
    fom = read_matrices(settings(keys | more), "given", folder)
    assert abs(fom.S - coarse_matrices.S).max() < 1e-12
    assert fom.span == pytest.approx(coarse_matrices.span, rel=1e-12)
    np.testing.assert_allclose(fom.camber, coarse_matrices.camber, atol=1e-12)
    ours, _ = reduce(coarse_matrices, coarse_blade.basis, "r")
    rom, _ = reduce(fom, coarse_blade.basis, "r")
    for Omega in (0.0, 300.0, 650.0):
        np.testing.assert_allclose(rom.modes(Omega)[0][:10], ours.modes(Omega)[0][:10], rtol=1e-9)
    assert ours.growth.size and not rom.growth.size


def test_matrices_of_their_own_speeds_are_checked_at_these(files, coarse_matrices, tmp_path):
    """Three speeds that are not those of any basis; through the files of the workflow."""
    folder, keys = files
    K = {speed: keys["K"][speed] for speed in list(keys["K"])[:3]}
    given = settings(keys | {"K": K, "tip": "tip.csv"})
    read_matrices(given, "given", folder).save(tmp_path / "matrices.h5")
    fom = Matrices.load(tmp_path / "matrices.h5")
    rom, _ = reduce(fom, given.basis, "r")
    assert pytest.approx(coarse_matrices.speeds[2]) == rom.Omega_m
    found = check(rom, solve(fom, fom.states()))
    np.testing.assert_array_equal(found.speeds, coarse_matrices.speeds[:3])
    assert abs(found.error).max() < 1e-4


def test_matrix_at_rest_alone_is_kept_over_all_speeds(files):
    folder, keys = files
    given = settings(keys | {"K": {0.0: "K0.npz"}, "tip": "tip.csv"}, max_speed_rad_s=500.0)
    rom, _ = reduce(read_matrices(given, "given", folder), given.basis, "r")
    assert (len(rom.K), rom.Omega_m) == (1, 500.0)
    np.testing.assert_array_equal(rom.stiffness(500.0), rom.stiffness(0.0))


@pytest.mark.parametrize(
    ("file", "text", "fault"),
    [
        ("nodes.csv", "1,2\n", r"nodes.csv: 2 columns, needs 3"),
        ("nodes.csv", "0.5,0,0\n", r"M.mtx: \d+ rows .*, needs 3 and 3"),
        ("tip.csv", "0,1,2,3,4,5\n", r"tip.csv: needs whole numbers from 1 to \d+"),
        ("M.mtx", "%%MatrixMarket matrix\n", r"M.mtx: cannot be read as .mtx"),
        ("tip.csv", None, r"tip.csv: cannot be read as CSV"),
    ],
)
def test_file_that_does_not_fit_is_refused(file, text, fault, files, tmp_path):
    folder, keys = files
    for path in folder.iterdir():
        (tmp_path / path.name).symlink_to(path)
    (tmp_path / file).unlink()
    if text is not None:
        (tmp_path / file).write_text(text)
    with pytest.raises(GivenError, match=fault) as caught:
        read_matrices(settings(keys | {"tip": "tip.csv"}), "given", tmp_path)
    assert "\n" not in str(caught.value)


def test_matrix_that_is_not_symmetric_is_refused(files, coarse_matrices, tmp_path):
    folder, keys = files
    for path in folder.iterdir():
        (tmp_path / path.name).symlink_to(path)
    (tmp_path / "K1.npz").unlink()
    K = coarse_matrices.K[1].tolil()
    K[0, 3] += 0.1 * abs(coarse_matrices.K[1]).max()
    save_npz(tmp_path / "K1.npz", K.tocsr())
    with pytest.raises(GivenError, match=r"K1.npz: not symmetric, by 0.1"):
        read_matrices(settings(keys | {"tip": "tip.csv"}), "given", tmp_path)


@pytest.mark.parametrize(
    ("keys", "others", "fault"),
    [
        ({"tip": "tip.csv", "S": "S.npz"}, {}, "needs either tip, or S and camber"),
        ({}, {}, "needs either tip, or S and camber"),
        ({"tip": "tip.csv", "K": {100.0: "K0.npz"}}, {}, "K: needs the matrix at rest"),
        ({"tip": "tip.csv", "K": {0.0: "K0.npz"}}, {}, "max_speed_rad_s: needed where"),
        ({"tip": "tip.csv"}, {"max_speed_rad_s": 3.0}, "max_speed_rad_s: needed where"),
    ],
)
def test_settings_that_do_not_hold_together(keys, others, fault, files):
    with pytest.raises(SettingsError, match=fault) as caught:
        settings(files[1] | keys, **others)
    assert "\n" not in str(caught.value)
