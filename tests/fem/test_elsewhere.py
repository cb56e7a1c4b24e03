"""Matrices of the coarse blade, written as another program would, and read back."""

from dataclasses import replace

import numpy as np
import pytest
from refused import refused
from scipy.io import mmwrite
from scipy.sparse import csr_matrix, diags, save_npz

from ufl import TestFunction, TrialFunction, inner

from fem.assemble import mass
from fem.elsewhere import ElsewhereError, read_matrices
from fem.matrices import Matrices
from fem.solid import small_strain
from geometry.base import SettingsError, check_settings
from geometry.elsewhere import MatricesElsewhere
from geometry.tip import cartesian
from rom.check import check
from rom.full_model import solve
from rom.modes import ShiftInvert
from rom.reconstruct import Basis
from rom.reduce import reduce


@pytest.fixture(scope="module")
def files(coarse_matrices, solid, tmp_path_factory):
    """The folder with the files, and the settings that name them."""
    folder = tmp_path_factory.mktemp("given")
    fom = coarse_matrices
    mmwrite(folder / "M.mtx", fom.M, symmetry="symmetric", precision=17)
    for i, K in enumerate(fom.K):
        save_npz(folder / f"K{i}.npz", K)
    np.savetxt(folder / "nodes.csv", fom.coordinates, "%.17g", ",", header="x, y, z (m)")
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
    tip = {"patches": 8, "across": 1}
    return check_settings(MatricesElsewhere, {"full_matrices": keys} | tip | others, "test")


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
    rom, T = reduce(fom, given.basis, "r")
    assert pytest.approx(coarse_matrices.speeds[2]) == rom.Omega_m
    Basis.of(fom, T, rom.provenance).save(tmp_path / "basis-r.h5")
    assert np.isnan(Basis.load(tmp_path / "basis-r.h5").static(100.0)).all()  # not known
    found = check(rom, solve(fom, fom.states()))
    np.testing.assert_array_equal(found.speeds, coarse_matrices.speeds[:3])
    assert abs(found.error).max() < 1e-4


def test_matrix_at_rest_alone_is_kept_over_all_speeds(files, tmp_path):
    folder, keys = files
    rpm = 500.0 * 30 / np.pi
    given = settings(keys | {"K": {0.0: "K0.npz"}, "tip": "tip.csv"}, max_speed_rpm=rpm)
    fom = read_matrices(given, "given", folder)
    rom, T = reduce(fom, given.basis, "r")
    assert (len(rom.K), rom.Omega_m) == (1, pytest.approx(500.0, rel=1e-15))
    assert rom.f1 == pytest.approx(259.334, rel=1e-4)  # of the coarse blade
    np.testing.assert_array_equal(rom.stiffness(500.0), rom.stiffness(0.0))
    Basis.of(fom, T, rom.provenance).save(tmp_path / "basis-r.h5")
    basis = Basis.load(tmp_path / "basis-r.h5")
    assert basis.Omega_m == 500.0
    assert np.isnan(basis.static(500.0)).all()  # not known
    u = np.arange(rom.n, dtype=float)
    np.testing.assert_array_equal(basis.reconstruct(u), T @ u)


def written(path, values):
    """A file of the kind that its values ask for; None: no file."""
    if isinstance(values, str):
        path.write_text(values)
    elif isinstance(values, np.ndarray):
        np.savetxt(path, values, "%.17g", ",")
    elif values is not None:
        save_npz(path, csr_matrix(values))


def beside(folder, changes, to):
    """The files of a folder in another one, some with other values."""
    for path in folder.iterdir():
        if path.name not in changes:
            (to / path.name).symlink_to(path)
    for name, values in changes.items():
        written(to / name, values)


@pytest.mark.parametrize(
    ("file", "text", "refused_file"),
    [
        ("nodes.csv", "1,2\n", "nodes.csv"),
        ("nodes.csv", "0.5,0,0\n", "tip.csv"),
        ("M.mtx", "%%MatrixMarket matrix coordinate real symmetric\n3 3 1\n1 1 1\n", "M.mtx"),
        ("tip.csv", "0,1,2,3,4,5\n", "tip.csv"),
        ("M.mtx", "%%MatrixMarket matrix\n", "M.mtx"),
        ("tip.csv", "1,2,3,4,5,6\n3,1,2,6,4,5\n", "tip.csv"),
        ("tip.csv", None, "tip.csv"),
    ],
)
def test_file_that_does_not_fit_is_refused(file, text, refused_file, files, tmp_path):
    folder, keys = files
    beside(folder, {file: text}, tmp_path)
    given = settings(keys | {"tip": "tip.csv"})
    error = refused(ElsewhereError, read_matrices, given, "given", tmp_path)
    assert error.file == str(tmp_path / refused_file)


def ordered(A, order):
    return A[order][:, order].tocsr()


def other(fom, hub):
    """Files and keys by what is wrong with them, and the fault that is named; SI, x, y, z is right.

    Units are chosen so that frequencies stay, where they can.
    """
    M, K, x = fom.M, fom.K[0], fom.coordinates
    dof = np.arange(M.shape[0]).reshape(-1, 3)
    blocks, zxy, rows = dof.T.ravel(), dof[:, [2, 0, 1]].ravel(), np.arange(24).reshape(8, 3)
    loose = M.tolil()
    loose[30], loose[:, 30] = 0, 0
    line = cartesian(fom.camber)
    sign = diags(np.tile([1.0, -1.0, 1.0], 8))
    skew = csr_matrix(([0.1 * abs(K).max()], ([0], [3])), K.shape)
    inch = 25.4e-3
    return {
        "t, N/mm": ({"M": M / 1e3, "K0": K / 1e3}, {}, "M.npz: mass of .* kg/m3: 1.09, allowed 20"),
        "t, N/mm, mm": (
            {"M": M / 1e3, "K0": K / 1e3, "nodes": 1e3 * x},
            {"hub_radius_m": 1e3 * hub},
            "nodes.csv: span: 140 m, radius of the tip 562.4 m: allowed 0.001 to 5",
        ),
        "slinch, lbf/in, in": (
            {"M": M / 175.127, "K0": K / 175.127, "nodes": x / inch},
            {"hub_radius_m": hub / inch},
            "nodes.csv: span: 5.51",
        ),
        "cm": ({"nodes": 1e2 * x}, {"hub_radius_m": 1e2 * hub}, "nodes.csv: span: 14 m"),
        "N/mm": ({"K0": K / 1e3}, {}, "K0.npz: speed of waves .*: 237, allowed 1000 to 30000"),
        "t": ({"M": M / 1e3}, {}, "M.npz: mass of "),
        "g": ({"M": M * 1e3}, {}, "M.npz: mass of "),
        "kN/mm at speed": ({"K1": K / 1e6}, {}, "K1.npz: change from K at rest, .*: 1, allowed"),
        "not symmetric": ({"K1": fom.K[1] + skew}, {}, "K1.npz: not symmetric"),
        "at speed as at rest": ({"K1": K}, {}, "K1.npz: change .*: 0, allowed .* prestressed"),
        "without spin softening": (
            {"K1": fom.K[1] + 325.0**2 * diags(np.tile([1.0, 1.0, 0.0], len(x))) @ M},
            {},
            "K1.npz: speed that its spin softening is of, over the given one: "
            "(0|[0-9.]+e-0[5-9]), allowed .*rad/s",  # 0 but for round-off
        ),
        "of twice the speed": ({"K1": fom.K[-1]}, {}, "K1.npz: speed .* given one: 2, allowed"),
        "nodes by radius in M": (
            {"M": ordered(M, dof[np.argsort(np.hypot(x[:, 0], x[:, 1]))].ravel())},
            {},
            "M.npz: mass between DoFs that K couples, .*: 0.[0-4].*one order",
        ),
        "x of all first": (
            {"M": ordered(M, blocks), "K0": ordered(K, blocks)},
            {},
            "M.npz: difference of the masses .* x, y, z of each node",
        ),
        "x of all first in K": ({"K0": ordered(K, blocks)}, {}, "K0.npz: forces away from the cla"),
        "z, x, y": (
            {"M": ordered(M, zxy), "K0": ordered(K, zxy)},
            {},
            "K0.npz: forces away from the clamp .* DoFs x, y, z",
        ),
        "nodes by radius": (
            {"nodes": x[np.argsort(np.hypot(x[:, 0], x[:, 1]))], "S": fom.S, "camber": line},
            {},
            "K0.npz: forces away from the clamp .* order and the frame",
        ),
        "left-handed": (
            {"nodes": x * [1, 1, -1], "S": fom.S, "camber": line},
            {},
            "K0.npz: forces away from the clamp .* frame",
        ),
        "hysteretic": ({"K0": K * (1 + 0.01j)}, {}, "K0.npz: is complex"),
        "without mass": ({"M": loose}, {}, "M.npz: 0 on the diagonal of row 31; must be above 0"),
        "hub": ({}, {"hub_radius_m": 0.04}, "K0.npz: speed of waves .* hub_radius_m"),
        "hub in mm": ({}, {"hub_radius_m": 1e3 * hub}, "nodes.csv: span: -42"),
        "rpm": ({"K6207": fom.K[-1]}, {}, r"Omega_m: 6207 rad/s: the tip runs at 3491 m/s, .*rpm"),
        "trailing edge first": (
            {"S": fom.S, "camber": line[::-1]},
            {},
            "camber.csv: camber: z falls",
        ),
        "patches reversed": (
            {"S": fom.S[rows[::-1].ravel()], "camber": line},
            {},
            "S.npz: error of patch .* leading edge first",
        ),
        "tangential first": (
            {"S": fom.S[rows[:, [1, 0, 2]].ravel()], "camber": line},
            {},
            "S.npz: error of patch .* rows must be radial, tangential, axial",
        ),
        "by direction": ({"S": fom.S[rows.T.ravel()], "camber": line}, {}, "S.npz: error of pat"),
        "against rotation": ({"S": (sign @ fom.S).tocsr(), "camber": line}, {}, "S.npz: error of"),
        "turned camber": (
            {"S": fom.S, "camber": cartesian(fom.camber + np.array([0, 0.2, 0]))},
            {},
            "S.npz: error of patch",
        ),
    }


OTHERS = (
    "t, N/mm", "t, N/mm, mm", "slinch, lbf/in, in", "cm", "N/mm", "t", "g", "kN/mm at speed",
    "at speed as at rest", "without spin softening", "of twice the speed", "nodes by radius in M",
    "x of all first", "x of all first in K", "z, x, y", "nodes by radius",
    "left-handed", "hysteretic", "not symmetric", "without mass", "hub", "hub in mm", "rpm",
    "trailing edge first", "patches reversed", "tangential first", "by direction",
    "against rotation", "turned camber",
)  # fmt: skip


@pytest.mark.parametrize("what", OTHERS)
def test_other_units_order_or_frame_are_refused(what, files, coarse_matrices, tmp_path):
    folder, keys = files
    changed, more, fault = other(coarse_matrices, keys["hub_radius_m"])[what]
    names = {f"{name}.{'csv' if name in ('nodes', 'camber') else 'npz'}": name for name in changed}
    beside(folder, {file: changed[name] for file, name in names.items()}, tmp_path)
    K = {0.0: "K0.npz", 325.0: "K1.npz"} | ({6207.0: "K6207.npz"} if "K6207" in changed else {})
    interface = {"S": "S.npz", "camber": "camber.csv"} if "S" in changed else {"tip": "tip.csv"}
    M = "M.npz" if "M" in changed else "M.mtx"
    given = settings(keys | interface | {"M": M, "K": K} | more)
    error = refused(ElsewhereError, read_matrices, given, "given", tmp_path, match=fault)
    assert error.file.startswith(f"{tmp_path}/")


def test_matrix_of_a_blade_that_is_not_clamped_is_refused(solid, tmp_path):
    n = solid.V.dofmap.index_map.size_local
    solid = replace(solid, free=np.arange(3 * n, dtype=np.int32))
    u, v = TrialFunction(solid.V), TestFunction(solid.V)
    K = inner(solid.stress(small_strain(u)), small_strain(v)) * solid.dx
    save_npz(tmp_path / "M.npz", mass(solid))
    save_npz(tmp_path / "K.npz", solid.matrix(K))
    np.savetxt(tmp_path / "nodes.csv", solid.free_coordinates(), "%.17g", ",")
    np.savetxt(tmp_path / "tip.csv", solid.tip + 1, "%d", ",")
    keys = {"M": "M.npz", "K": {0.0: "K.npz"}, "nodes": "nodes.csv", "tip": "tip.csv"}
    given = settings(keys | {"hub_radius_m": 0.4224}, max_speed_rad_s=500.0)
    assert refused(ElsewhereError, read_matrices, given, "given", tmp_path).file.endswith("/K.npz")


def test_mass_and_operator_of_single_precision_are_read_back(files, coarse_matrices, tmp_path):
    folder, keys = files
    single = {"M": coarse_matrices.M, "S": coarse_matrices.S}
    single = {f"{name}.npz": A.astype(np.float32) for name, A in single.items()}
    beside(folder, single, tmp_path)
    keys = keys | {"M": "M.npz", "K": {0.0: "K0.npz"}, "S": "S.npz", "camber": "camber.csv"}
    fom = read_matrices(settings(keys, max_speed_rad_s=500.0), "given", tmp_path)
    fom.save(tmp_path / "matrices.h5")
    assert abs(Matrices.load(tmp_path / "matrices.h5").S - fom.S).max() == 0


def test_coordinates_of_micrometres_are_no_fault(files, coarse_matrices, tmp_path):
    """The largest error of what is compared with ``SAME_PLACES``: 3e-6."""
    folder, keys = files
    beside(folder, {"nodes.csv": coarse_matrices.coordinates.round(6)}, tmp_path)
    K = {0.0: "K0.npz", 325.0: "K1.npz"}
    read_matrices(settings(keys | {"K": K, "tip": "tip.csv"}), "given", tmp_path)


@pytest.mark.parametrize(("digits", "error"), [(10, 1e-4), (9, 1e-3), (8, None), (7, None)])
def test_digits_that_lose_the_bending_are_refused(digits, error, files, coarse_matrices, tmp_path):
    """Measured in f1: 6e-5, 4e-4, and with seven digits 13 %; six of M cost nothing."""
    folder, keys = files
    beside(folder, {}, tmp_path)
    mmwrite(tmp_path / "m.mtx", coarse_matrices.M, symmetry="symmetric", precision=6)
    mmwrite(tmp_path / "k.mtx", coarse_matrices.K[0], symmetry="symmetric", precision=digits)
    keys = keys | {"M": "m.mtx", "K": {0.0: "k.mtx"}, "tip": "tip.csv"}
    given = settings(keys, max_speed_rad_s=500.0)
    if error is None:
        refused(
            ElsewhereError, read_matrices, given, "given", tmp_path, match="k.mtx: .* nine digits"
        )
        return
    fom = read_matrices(given, "given", tmp_path)
    f1, expected = (ShiftInvert(of.K[0], of.M).modes(1).omega[0] for of in (fom, coarse_matrices))
    assert f1 == pytest.approx(expected, rel=error)


@pytest.mark.parametrize(
    ("keys", "others", "key"),
    [
        ({"tip": "tip.csv", "S": "S.npz"}, {}, "full_matrices"),
        ({}, {}, "full_matrices"),
        ({"tip": "tip.csv", "K": {100.0: "K0.npz"}}, {}, "full_matrices.K"),
        ({"tip": "tip.csv", "K": {0.0: "K0.npz"}}, {}, "max_speed_rpm"),
        ({"tip": "tip.csv"}, {"max_speed_rad_s": 3.0}, "max_speed_rpm"),
        ({"tip": "tip.csv"}, {"max_speed_rpm": 3.0}, "max_speed_rpm"),
        (
            {"tip": "tip.csv", "K": {0.0: "K0.npz"}},
            {"max_speed_rad_s": 3.0, "max_speed_rpm": 3.0},
            "max_speed_rad_s",
        ),
    ],
)
def test_settings_that_do_not_hold_together(keys, others, key, files):
    assert refused(SettingsError, settings, files[1] | keys, **others).key == key
