"""Jobs and Snakemake killed with -9 at random times: what is made afterwards is bit-identical."""

import ast
import os
import pickle
import re
import shutil
import signal
import subprocess
import time
from collections import Counter
from contextlib import suppress
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from projects import ROOT, Project, make_project

from fem.matrices import Matrices
from geometry.base import read_json
from rom.check import RomCheck
from rom.full_model import FullModel
from rom.model import Rom
from rom.reconstruct import Basis
from simulate.sweeps.dataset import load

SEED = 20
BLADE = "results/paper"
TARGETS = (
    f"{BLADE}/paper-e1/explore.html",
    f"{BLADE}/paper-e1/answers.json",
    f"{BLADE}/peak-e1/stress.vtu",
    f"{BLADE}/basis-r.h5",
)
# Kills of each rule's jobs, and their own time, s, within which they are: that of most jobs
KILLS = {
    "build_mesh": (2, 0.9),
    "assemble": (6, 4.0),
    "modes": (4, 2.6),
    "solve_between": (4, 4.0),
    "reduce": (3, 1.5),
    "check_rom": (2, 1.2),
    "mesh_error": (2, 2.6),
    "check_scene": (2, 1.5),
    "sweep_block": (8, 8.0),
    "sweep": (4, 2.6),
    "stress": (6, 5.0),
    "answers": (3, 3.0),
    "explore": (4, 3.0),
}
EARLY = 0.5  # share of the kills that are so, most while libraries are loaded: the others come
WORK = 0.2  # s, of own time, at most after that, whatever the load of the machine
OF_SNAKEMAKE = 2  # times that it is killed with its jobs
DEADLINE = 1800.0  # s
OF_INSTALL = 6  # times that an install is killed
OWN_TIMES = {"seconds", "sweep_s"}  # of a sweep and its answers, all that differs between two runs
TIMES = re.compile(rb"[\d.]+ s of CPU time; the sweep: [\d.]+ s")  # in a page


@cache
def rule_of(script: str) -> str:
    """Rule of the job that runs a script, of what Snakemake writes ahead of it."""
    given = re.search(r"pickle\.loads\((b.*)\);from snakemake\.logging", Path(script).read_text())
    return pickle.loads(ast.literal_eval(given[1])).rule


def jobs_of(snakemake: int) -> dict[int, str]:
    """Rule of each running job of a process, by process number."""
    jobs = {}
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it ended
            command = (folder / "cmdline").read_bytes().decode(errors="replace")
            session = os.getsid(int(folder.name))
            script = re.search(r"[^\0]*/\.snakemake/scripts/tmp\w+\.\w+\.py", command)
            if script and session == snakemake and "python" in command.split("\0")[0]:
                jobs[int(folder.name)] = rule_of(script[0])
    return jobs


def parents() -> set[int]:
    """Processes that have started others: a job that works has one that watches it."""
    found = set()
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with suppress(OSError):
            found.add(int(stat.read_text().rpartition(")")[2].split()[1]))
    return found


def own_time(process: int) -> float:
    """Seconds of the processor that a process has taken; inf if it is gone."""
    try:
        fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return np.inf
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def start(project: Project, log: Path) -> subprocess.Popen:
    """Snakemake in a session of its own, which tries jobs again that are killed.

    Compiled forms and kernels it keeps in a folder of its own, empty at first.
    """
    with log.open("ab") as file:
        return subprocess.Popen(
            project.command("--retries", "9", "--", *TARGETS),
            cwd=project.folder,
            env={**project.environment, "XDG_CACHE_HOME": str(log.with_name("cache"))},
            stdout=file,
            stderr=file,
            start_new_session=True,
        )


def killed(project: Project, rng: np.random.Generator, log: Path) -> Counter:
    """Run the targets, and kill jobs and Snakemake; return the kills by rule."""
    kills, until = Counter(), time.monotonic() + DEADLINE
    left, within = ({rule: of[i] for rule, of in KILLS.items()} for i in range(2))
    of_snakemake = sorted(rng.integers(3, sum(left.values()) - 3, size=OF_SNAKEMAKE))
    process, chosen, late = start(project, log), {}, {}
    try:
        while process.poll() is None:
            assert time.monotonic() < until, log.read_text()[-4000:]
            for job, rule in jobs_of(process.pid).items():
                if job not in chosen:
                    early, after = rng.uniform(0.2, 1) * within[rule], rng.uniform(0, WORK)
                    is_early, wanted = rng.random() < EARLY, left[rule] > 0
                    chosen[job] = early if wanted and is_early else np.inf
                    if wanted and not is_early:
                        late[job] = after
                if job in late and job in parents():
                    chosen[job] = own_time(job) + late.pop(job)
                if chosen[job] <= own_time(job) < np.inf:
                    os.kill(job, signal.SIGKILL)
                    kills[rule], chosen[job] = kills[rule] + 1, np.inf
                    left[rule] -= 1
            if of_snakemake and kills.total() >= of_snakemake[0]:
                of_snakemake.pop(0)
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()
                kills["Snakemake with its jobs"] += 1
                process = start(project, log)
            time.sleep(0.02)
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
    assert process.returncode == 0, log.read_text()[-4000:]
    return kills


@pytest.mark.nightly
def test_killed_at_all_stages_the_chain_gives_the_same_bits(project, tmp_path, record_property):
    (tmp_path / "project").mkdir()
    again, log = make_project(tmp_path / "project"), tmp_path / "log"
    kills = killed(again, np.random.default_rng(SEED), log)
    record_property("kills survived", f"{kills.total()}: {dict(kills)}")
    assert kills.total() >= 45 and kills.keys() >= KILLS.keys()
    text = log.read_text()
    assert text.count(": killed while it read ") >= 5  # of those that had loaded their libraries
    assert "Traceback" not in text
    require_same_bits(project.folder / BLADE, again.folder / BLADE)
    assert not list((again.folder / "results").rglob(".*"))  # nor what the killed were writing


@pytest.mark.nightly
def test_an_install_that_is_killed_is_made_whole(tmp_path, record_property):
    """With the packages of the cache, in two folders; the undisturbed one tells when to kill."""
    begun, rng = time.monotonic(), np.random.default_rng(SEED)
    undisturbed = install(tmp_path / "undisturbed")
    took, folder = time.monotonic() - begun, tmp_path / "killed"
    for share in rng.uniform(0.02, 1.0, size=OF_INSTALL):
        process = installing(folder)
        with suppress(subprocess.TimeoutExpired):
            process.wait(share * took)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    assert install(folder) == undisturbed
    record_property("kills of the install", OF_INSTALL)


def installing(folder: Path) -> subprocess.Popen:
    """The first call of ./run in a copy of what it needs."""
    for name in ("run", "requirements.lock", "fem/petsc.py"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    return subprocess.Popen([folder / "run", "true"], cwd=folder, start_new_session=True)


def install(folder: Path) -> dict[str, int]:
    """Make the environment, and return its files with their sizes; scripts hold the folder."""
    assert installing(folder).wait() == 0
    packages = folder / ".venv/lib"
    files = (file for file in packages.rglob("*") if file.is_file() and file.suffix != ".pyc")
    sizes = {str(file.relative_to(packages)): file.stat().st_size for file in files}
    assert any("dolfinx" in name for name in sizes)
    return {name: size for name, size in sizes.items() if not name.endswith("RECORD")}


def require_same_bits(there: Path, here: Path) -> None:
    """Compare all that the chain computed."""
    require_same_models(there, here)
    for name in ("peak-e1/stress.vtu", "paper-e1/explore.html"):
        ours, theirs = (TIMES.sub(b"", (of / name).read_bytes()) for of in (here, there))
        assert ours == theirs
    for name in ("peak-e1/stress.json", "paper-e1/answers.json"):
        ours, theirs = (without_times(read_json(of / name)) for of in (here, there))
        assert ours == theirs
    of_kinds = {"full-model.nc": FullModel, "rom-check-r.nc": RomCheck, "basis-r.h5": Basis}
    for name, kind in of_kinds.items():
        require_same_arrays(*(vars(kind.load(folder / name)) for folder in (here, there)))
    for name in ("paper-e1", "peak-e1"):
        require_same_sweep(*(folder / name / "sweep.nc" for folder in (here, there)))


def without_times(values):
    """Values without times of computing, which differ between two runs."""
    if isinstance(values, dict):
        return {key: without_times(of) for key, of in values.items() if key not in OWN_TIMES}
    return [*map(without_times, values)] if isinstance(values, list) else values


def require_same_models(there: Path, here: Path) -> None:
    """Compare mesh, matrices and reduced model."""
    assert (here / "blade.msh").read_bytes() == (there / "blade.msh").read_bytes()
    require_same_arrays(*(vars(Rom.load(folder / "rom-r.nc")) for folder in (here, there)))
    ours, theirs = (Matrices.load(folder / "matrices.h5") for folder in (here, there))
    for A, B in zip((ours.M, ours.S, *ours.K), (theirs.M, theirs.S, *theirs.K), strict=True):
        assert (A != B).nnz == 0
    np.testing.assert_array_equal(ours.u_static, theirs.u_static)


def require_same_arrays(ours: dict, theirs: dict) -> None:
    for name in ours:
        np.testing.assert_array_equal(ours[name], theirs[name])


def require_same_sweep(here: Path, there: Path) -> None:
    """Compare two sweeps in all but their times."""
    ours, theirs = (load(path).drop_vars(OWN_TIMES, errors="ignore") for path in (here, there))
    assert ours.identical(theirs.assign_attrs(date_created=ours.attrs["date_created"]))
