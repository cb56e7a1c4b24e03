"""``./run export SCENE [RPM...]``: model, modes, motion and sweep in files of other programs.

K and modes are those at these speeds, without any at rest and at the highest speed of the model;
time steps are of the sweep's speeds nearest to them. rom/README.md says what is in the files.
"""

import sys
from dataclasses import replace
from pathlib import Path
from shutil import rmtree

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.io import savemat

from fem.fields import dofs_at, save_vtu
from geometry.base import RPM, command, intact, numbers, whole, write_whole
from geometry.frame import to_file, turned
from geometry.readers import read_mesh_file
from rom.full_model import MODES
from rom.reconstruct import Basis
from simulate.sweeps.dataset import SPEED
from workflow.check import Subject

MOST_STEPS = 200  # of a run: some 300 MB on a mesh of 20,000 nodes


@command
def main(name: str = "", *rpm: str) -> None:
    """Export the scene ``name``, which has been run, to its folder ``export``, made anew.

    Raises
    ------
    geometry.base.errors.UserError
        When there is no such scene, the model has no such speed, the scene has not been run, its
        blade has no mesh, or its files are of different models.
    """
    subject = Subject.read(name)
    asked = [speed / RPM for speed in numbers(rpm, ["RPM"] * len(rpm), 0)]
    speeds = asked or [0.0, subject.rom.Omega_m]
    folder, (cells, basis) = subject.folder / "export", everywhere(subject)
    model = {
        **vars(basis),
        **{name: array for name, array in vars(subject.rom).items() if "gauge" not in name},
        "power": 2 * np.arange(len(subject.rom.K)),
        "Omega": np.array(speeds),
        "K_at": np.array([subject.rom.stiffness(Omega) for Omega in speeds]),
        "cells": cells,
        "unit": subject.blade.drawn.unit,
        "provenance": subject.rom.provenance.dump(),
    }
    rmtree(folder, ignore_errors=True)
    with whole(folder / "model.mat") as mat, whole(folder / "model.npz") as npz:
        savemat(mat, model)
        np.savez(npz, **model)
    write_whole(table(subject.runs), folder / "sweep.csv")
    for Omega in speeds:
        omega, Phi = subject.rom.modes(Omega)
        shapes = (basis.T @ Phi[:, :MODES]).T.reshape(-1, *basis.coordinates.shape)
        data = {
            f"mode {i} ({f:.1f} Hz)": shape
            for i, (f, shape) in enumerate(zip(omega / (2 * np.pi), shapes, strict=False), 1)
        }
        save_vtu(basis.coordinates, cells, data, folder / f"modes-{RPM * Omega:.0f}rpm.vtu")
    for Omega in asked if "motion" in subject.runs else []:
        run = subject.runs.isel({SPEED: int(abs(subject.runs["speed"].values - Omega).argmin())})
        steps(run, cells, basis, subject.blade.drawn.unit, folder)
    print(f"{folder}: {', '.join(sorted(path.name for path in folder.iterdir()))}")


def everywhere(subject: Subject) -> tuple[NDArray[np.int64], Basis]:
    """Cells (cells, 10) of the mesh, and the basis of all its nodes, in its file's axes and unit.

    Displacements of clamped nodes are 0.
    """
    results, source = subject.folder.parent, subject.blade.drawn
    basis = Basis.load(results / f"basis-{subject.scene.directions}.h5", subject.rom.provenance)
    mesh = read_mesh_file(intact(results / "blade.msh"))
    rows = np.zeros((subject.rom.n + len(basis.u_static), mesh.points.size))
    rows[:, dofs_at(mesh.points, basis.coordinates).ravel()] = [*basis.T.T, *basis.u_static]
    T, static = np.split(to_file(rows, source), [subject.rom.n])
    return turned(mesh.cells, source), replace(
        basis, T=T.T, u_static=static, coordinates=to_file(mesh.points, source)
    )


def steps(run: xr.Dataset, cells: NDArray[np.int64], basis: Basis, unit: str, folder: Path) -> None:
    """Write the last revolution of a run as a numbered series, all states or every k-th."""
    static, series = basis.static(float(run["speed"])), f"steps-{RPM * float(run['speed']):.0f}rpm"
    states = run["motion"].dropna("motion_time")
    for number, state in enumerate(states[:: max(len(states) - 1, 0) // MOST_STEPS + 1]):
        vibration = basis.reconstruct(state.values)
        data = {"displacement": static + vibration, "vibration": vibration}
        shown = {f"{name} ({unit})": u.reshape(-1, 3).astype("f4") for name, u in data.items()}
        path, time = folder / series / f"{series}-{number:04}.vtu", float(state["motion_time"])
        save_vtu(basis.coordinates, cells, shown, path, {"TimeValue": time})


def table(runs: xr.Dataset) -> str:
    """CSV of a row for each run, with all that is one value in it, and the unit in the names."""
    if "wear" in runs:
        runs = runs.assign({"largest wear": runs["wear"].max(("strip", "theta"), keep_attrs=True)})
    single = runs.drop_dims({*runs.dims} - {SPEED}).reset_coords()
    names = {
        name: f"{name} ({variable.units})"
        for name, variable in single.items()
        if variable.units != "1"
    }
    return single.assign(rpm=RPM * single["speed"]).rename(names).to_dataframe().to_csv()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
