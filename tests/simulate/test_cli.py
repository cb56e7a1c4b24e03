"""``python -m simulate rom.nc scene.yaml -o out.nc``, from files alone."""

import subprocess
import sys

import pytest
from scenes import SCENE

from simulate.__main__ import main
from simulate.sweep import load

FENICSX = ("dolfinx", "dolfinx_solver", "petsc4py", "slepc4py", "ufl", "basix", "gmsh", "mpi4py")


@pytest.fixture
def files(coarse_rom, tmp_path):
    """A reduced model and a scene on disk; returns the command's arguments."""
    coarse_rom.save(tmp_path / "rom.nc")
    (tmp_path / "scene.yaml").write_text(SCENE.replace("rounds: 2", "rounds: 1"))
    return [str(tmp_path / "rom.nc"), str(tmp_path / "scene.yaml"), "-o", str(tmp_path / "out.nc")]


def test_a_scene_runs_where_fenicsx_is_not_installed(files, tmp_path):
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
        ("thickness_m", "thickness_mm", ["scene.yaml: liner.thickness_mm", "'thickness_m'"]),
        ("[0.3]", "[0.3", ["scene.yaml", "is not YAML"]),
    ],
)
def test_bad_input_is_one_line_and_leaves_no_file(files, tmp_path, capsys, old, new, words):
    path = tmp_path / "scene.yaml"
    path.write_text(path.read_text().replace(old, new))
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
    assert "no file can be written there" in capsys.readouterr().err


@pytest.mark.parametrize("missing", ["rom.nc", "scene.yaml"])
def test_a_missing_file_is_named(files, tmp_path, capsys, missing):
    (tmp_path / missing).unlink()
    assert main(files) == 2
    assert missing in capsys.readouterr().err
