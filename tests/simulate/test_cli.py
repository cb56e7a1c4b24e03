"""``python -m simulate rom.nc scene.yaml -o out.nc``, from files alone."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
import yaml
from scenes import SCENE

from geometry.base import write_json
from simulate.__main__ import main
from simulate.sweeps.dataset import load

FENICSX = ("dolfinx", "dolfinx_solver", "petsc4py", "slepc4py", "ufl", "basix", "gmsh", "mpi4py")


@pytest.fixture
def files(coarse_rom, tmp_path):
    """A reduced model and a scene on disk; returns the command's arguments."""
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "scene.yaml").write_text(SCENE.replace("rounds: 2", "rounds: 1"))
    return [str(tmp_path / "rom.nc"), str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out.nc")]


@pytest.mark.slow
def test_a_scene_runs_without_fenicsx(files, tmp_path):
    code = (
        "import sys\n"
        f"sys.modules.update(dict.fromkeys({FENICSX!r}))\n"  # None: importing it fails
        "from simulate.__main__ import main\n"
        f"sys.exit(main({files!r}))"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
    assert load(tmp_path / "out.nc").status.values.tolist() == ["ok"]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("\nrounds: 1", "\nrouns: 1", ["scene.yaml: rouns: unknown key", "did you mean 'rounds'"]),
        ("[0.3]", "[0.9]", ["scene.yaml: speeds.over_f1: 0.9", "allowed up to"]),
        (
            "fraction_of_limit: 0.8",
            "steps_per_round: 640",
            ["scene.yaml: integrator.steps_per_round: 640", "allowed from"],
        ),
        ("blade: coarse", "blade: other", ["scene.yaml: blade: 'other'", "is of blade 'coarse'"]),
        ("[0.3]", "[0.3", ["scene.yaml", "is not YAML"]),
        (
            "blade: coarse",
            "blade: coarse\nformat: 2\nrotor: mine",
            ["scene.yaml: format: 2: "],
        ),
        ("rom.nc", None, ["rom.nc"]),  # missing files
        ("scene.yaml", None, ["scene.yaml"]),
    ],
)
def test_bad_input_is_one_line_and_leaves_no_file(files, tmp_path, capsys, old, new, words):
    path = tmp_path / "scene.yaml"
    path.write_text(path.read_text().replace(old, new or old))
    if new is None:
        (tmp_path / old).unlink()
    before = sorted(tmp_path.iterdir())
    assert main(files) == 2
    message = capsys.readouterr().err.strip().splitlines()[0]
    assert all(word in message for word in words), message
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("output", ["", "no/such/folder/out.nc"])
def test_an_output_that_cannot_be_written_is_refused_before_the_march(
    files, tmp_path, capsys, output
):
    assert main([*files[:2], "-o", str(tmp_path / output)]) == 2
    assert "cannot be written: not a file in an existing folder" in capsys.readouterr().err


@pytest.fixture
def project(coarse_rom, coarse_blade, coarse_mesh, tmp_path):
    """The folders of a project: scene, blade's file, reduced model, mesh; with the arguments."""
    for folder in ("scenes", "blades", "results"):
        (tmp_path / folder).mkdir()
    coarse_rom.save(tmp_path / "results/rom-r.nc")
    (tmp_path / "results/blade.msh").write_bytes(coarse_mesh.mesh.read_bytes())
    (tmp_path / "scenes/scene.yaml").write_text(SCENE.replace("rounds: 2", "rounds: 1"))
    blade = yaml.safe_dump(coarse_blade.model_dump(mode="json", exclude_unset=True))
    (tmp_path / "blades/coarse.yaml").write_text(blade)
    files = [str(tmp_path / name) for name in ("results/rom-r.nc", "scenes/scene.yaml", "out.nc")]
    return tmp_path, [*files[:2], "-o", files[2]]


def refused(files, capsys):
    """The error message, one line, of a refused call."""
    assert main(files) == 2
    message = capsys.readouterr().err.strip()
    assert "\n" not in message
    return message


def test_a_model_of_the_unchanged_blade_runs(project):
    folder, files = project
    assert main(files) == 0
    swept = load(folder / "out.nc")
    assert swept.status.values.tolist() == ["ok"] and swept.attrs["name"] == "scene"


def changed(path, old, new):
    path.write_bytes(path.read_bytes().replace(old, new))


def without_provenance(path):
    """As older versions wrote them."""
    older = xr.load_dataset(path, engine="h5netcdf")
    del older.attrs["provenance"]
    older.to_netcdf(path, engine="h5netcdf")


def with_a_file(folder, rom):
    """The blade's file names one with its mesh, of which the model is not."""
    path = folder / "blades/coarse.yaml"
    values = yaml.safe_load(path.read_text())
    del values["sections"], values["mesh"]
    faces = {"root": {"group": "ROOT"}, "tip": {"group": "TIP"}}
    values["mesh_file"] = {"file": "other.cdb", "unit": "mm", **faces}
    path.write_text(yaml.safe_dump(values))
    (folder / "blades/other.cdb").write_text("another mesh")


OTHERS = {  # change of the project's folder, and what is named
    '"patches": 7': lambda at, rom: changed(at / "blades/coarse.yaml", b"hes: 8", b"hes: 7"),
    "made of other files than those that blade coarse names": with_a_file,
    "another mesh": lambda at, rom: changed(at / "results/blade.msh", b"$EndElem", b"\n$EndElem"),
    "another version of the code": lambda at, rom: replace(
        rom, provenance=replace(rom.provenance, code="older")
    ).save(at / "results/rom-r.nc"),
    "an older version": lambda at, rom: without_provenance(at / "results/rom-r.nc"),
}


@pytest.mark.parametrize("named", OTHERS)
def test_a_model_that_is_not_of_the_blade_is_refused(project, coarse_rom, capsys, named):
    folder, files = project
    OTHERS[named](folder, coarse_rom)
    message = refused(files, capsys)
    assert "rom-r.nc: " in message and named in message and "./run snakemake" in message
    assert not (folder / "out.nc").exists()


def test_an_accuracy_needs_the_checks_of_this_model(project, capsys):
    """Without the check of the reduced model, or with a mesh error of another mesh."""
    folder, files = project
    path = folder / "scenes/scene.yaml"
    values = yaml.safe_load(path.read_text()) | {"accuracy": 0.01}
    del values["integrator"], values["liner"]["rods_per_round"], values["liner"]["strips"]
    path.write_text(yaml.safe_dump(values))
    write_json({"mesh": "another", "error": 0.001}, folder / "results/mesh-error.json")
    assert "mesh-error.json: belongs to another mesh" in refused(files, capsys)
    (folder / "results/mesh-error.json").unlink()
    assert "rom-check-r.nc: no such file; make it anew: `./run snakemake" in refused(files, capsys)


def test_model_from_elsewhere_is_taken_as_it_is(files, coarse_rom, tmp_path):
    """A file without provenance; the same runs as those of our own model, to the last bit."""
    ours = {
        "M": (("dof", "dof_"), coarse_rom.M),
        "K": (("power", "dof", "dof_"), coarse_rom.K),
        "directions": ("direction", list(coarse_rom.directions)),
        "xi": ("xi", coarse_rom.xi),
        "camber": (("place", "rtz"), coarse_rom.camber),
        "Omega_m": coarse_rom.Omega_m,
        "span": coarse_rom.span,
        "f1": coarse_rom.f1,
        "power": ("power", 2 * np.arange(len(coarse_rom.K))),
    }
    xr.Dataset(ours).to_netcdf(tmp_path / "mine.nc", engine="h5netcdf")
    assert main(files) == 0
    mine = [str(tmp_path / "mine.nc"), files[1], "-o", str(tmp_path / "other.nc")]
    assert main(mine) == 0
    own, other = load(tmp_path / "out.nc"), load(tmp_path / "other.nc")
    np.testing.assert_array_equal(other.wear, own.wear)
    np.testing.assert_array_equal(other.spectrum, own.spectrum)
