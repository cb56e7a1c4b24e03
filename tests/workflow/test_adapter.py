import subprocess
import sys
from pathlib import Path

SCRIPT = """
import sys, types, warnings
from adapter import stage
from geometry.errors import MeshWarning

with stage(types.SimpleNamespace(log=[sys.argv[1]], rule="build_mesh")):
    warnings.warn("cells were raised", MeshWarning)
    warnings.warn("of a library")
    print("words of the job")
"""
ROOT = Path(__file__).parents[2]


def test_warnings_of_ours_are_shown_and_all_are_logged(tmp_path):
    log = tmp_path / "log"
    job = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(log)],
        env={"PYTHONPATH": f"{ROOT}:{ROOT / 'workflow/scripts'}"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert (job.stdout, job.stderr) == ("", "build_mesh: cells were raised\n")
    logged = log.read_text()
    assert "MeshWarning: cells were raised" in logged
    assert "of a library" in logged
    assert "words of the job" in logged
