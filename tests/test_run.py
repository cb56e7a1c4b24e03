"""`./run`, on a copy of the project with a fake uv (no network, no packages); the lock file."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
SCRIPT = (ROOT / "run").read_text()
LOCK = (ROOT / "requirements.lock").read_text()
PYTHON = Path(sys.executable).resolve()
TOOLS = ["awk", "bash", "cat", "cmp", "cp", "dirname", "env", "flock", "ln", "mkdir", "mv"]
TOOLS += ["readlink", "rm", "sed", "sh", "sleep", "touch", "true"]
# At the phase AT of the installation the whole process group gets SIGNAL.
STOP = """
at() { [ "$AT" != "$1" ] || kill "-$SIGNAL" 0; }
for last; do :; done
"""
# As the real one, it clears no folder that is half an environment, unless it is forced to.
UV = (
    STOP
    + """
case $1 in
    --version) echo "uv VERSION" ;;
    venv)
        echo "$@" >"$HOME/venv"
        case $* in *--force*) touch "$last/pyvenv.cfg" 2>/dev/null ;; esac
        [ ! -e "$last" ] || [ -e "$last/pyvenv.cfg" ] || exit 1
        rm -f "$last/packages" "$last/pyvenv.cfg"
        at clear
        rm -rf "$last"
        mkdir -p "$last/bin"
        at venv
        touch "$last/pyvenv.cfg"
        ln -s "$HOME/python" "$last/bin/python"
        sleep 0.1 ;;
    pip)
        cat >"$HOME/installed"
        echo made >>"$HOME/log"
        at sync
        if [ -e "$HOME/broken" ]; then cat "$HOME/broken" >&2; exit 1; fi
        touch "${6%/bin/python}/packages" ;;
esac
""".replace("VERSION", re.search(r"^uv_version=(\S+)", SCRIPT, re.MULTILINE)[1])
)
# A Python whose version is one of ours, with DOLFINx. As the real one, it mends no half folder.
FAKE = f"""{STOP}
case $1$2 in
    -c*) echo "$0" ;;
    -P*) ;;
    -mvenv)
        [ ! -e "$last/bin" ] || exit 0
        mkdir -p "$last/bin"
        at folder
        cp "$0" "$last/bin/python" ;;
    -mensurepip) at ensurepip ;;
    -mpip)
        {{ echo "$@"; cat; }} >"$HOME/asked"
        echo half >"${{0%/*}}/uv"
        at pip
        rm "${{0%/*}}/uv"
        cp "$HOME/uv" "${{0%/*}}/uv" ;;
    *) exec {PYTHON} "$@" ;;
esac
"""


class Machine:
    """A user's machine: a copy of the project, the commands on PATH, a home folder."""

    def __init__(self, folder: Path):
        self.root, self.bin, self.home = folder / "tiprub", folder / "bin", folder / "home"
        for path in (self.root / ".venv-uv/bin", self.bin, self.home):
            path.mkdir(parents=True)
        (self.root / "fem").mkdir()
        for name in ("run", "requirements.lock", "fem/petsc.py"):
            shutil.copy(ROOT / name, self.root / name)
        for name in TOOLS:
            (self.bin / name).symlink_to(shutil.which(name))
        self.command("id", "echo 1000")
        self.command("cc", "")
        self.command("uv", UV, self.root / ".venv-uv/bin")
        self.command("uv", UV, self.home)
        self.command("python", "", self.home)
        (self.bin / "python3.12").symlink_to(PYTHON)
        self.libraries = folder / "lib"
        self.libraries.mkdir()

    def command(self, name: str, body: str, folder: Path | None = None) -> None:
        path = (folder or self.bin) / name
        path.unlink(missing_ok=True)
        path.write_text(f"#!/bin/sh\n{body}\n")
        path.chmod(0o755)

    def without_uv(self) -> None:
        shutil.rmtree(self.root / ".venv-uv")
        self.command("python3.12", FAKE)

    def start(self, *command: str, **variables: str) -> subprocess.Popen:
        paths = [str(self.libraries), os.environ.get("LD_LIBRARY_PATH", "")]
        env = {
            "PATH": str(self.bin),
            "HOME": str(self.home),
            "LD_LIBRARY_PATH": ":".join(filter(None, paths)),
            **variables,
        }
        return subprocess.Popen(
            [self.root / "run", *command],
            env=env,
            cwd=self.home,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            # a pytest in the background ignores it, and so would its children
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def run(self, *command: str, **variables: str) -> subprocess.CompletedProcess:
        with self.start(*command, **variables) as process:
            out, err = process.communicate(timeout=30)
        return subprocess.CompletedProcess(command, process.returncode, out, err)

    def refusal(self, **variables: str) -> str:
        """The error message, one sentence, of a call that makes no environment."""
        result = self.run("true", **variables)
        assert result.returncode == 1
        assert not (self.root / ".venv").exists()
        (line,) = result.stderr.splitlines()
        return line

    def times_made(self) -> int:
        log = self.home / "log"
        return len(log.read_text().split()) if log.exists() else 0


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def test_job_cost(machine):
    result = machine.run()
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 10
    assert machine.run("--help").stdout == result.stderr
    assert machine.times_made() == 0


@pytest.mark.parametrize("word", ["sweeps", "blocks", "a=1", "2x=3"])
def test_word_after_config_that_is_no_value_is_refused(machine, word):
    result = machine.run("snakemake", "-n", "--config", "blocks=2", word)
    assert result.returncode == 2
    assert result.stderr == (
        f"./run: --config: '{word}': is no KEY=VALUE; write targets before --config\n"
    )
    assert machine.times_made() == 0


@pytest.mark.parametrize("name", ["my blades", "a&b", "it's", "(1)"])
def test_a_path_that_a_shell_would_take_apart_is_refused(machine, name):
    machine.root = machine.root.rename(machine.root.with_name(name))
    result = machine.run("snakemake", "-n")
    (line,) = result.stderr.splitlines()
    assert result.returncode == 2 and f"{name}'" in line and "move the folder" in line
    assert machine.times_made() == 0


def test_an_umlaut_in_the_path_stops_no_python_of_an_ascii_locale(machine):
    """Python 3.12 reads .pth files in the encoding of the locale, here ASCII."""
    machine.root = machine.root.rename(machine.root.with_name("Schaufel-Größe_2.1"))
    assert machine.run("true").returncode == 0
    packages = machine.root / ".venv/lib/python3.12/site-packages"
    packages.mkdir(parents=True)
    (packages / "tiprub.pth").write_text(f"{machine.root}\n")  # of an older version
    machine.run("true")
    code = "import site, sys; site.addsitedir(sys.argv[1]); print(ascii(sys.path[-1]))"
    found = subprocess.run(
        [PYTHON, "-S", "-c", code, packages],
        env={"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0"},
        text=True,
        capture_output=True,
        check=True,
    )
    assert found.stdout.strip() == ascii(str(machine.root))


def test_targets_beside_config_are_none_of_its_values(machine):
    machine.command("python", 'echo "$@"', machine.home)
    for words in (["sweeps", "--config", "blocks=2"], ["--config", "blocks=2", "-n", "sweeps"]):
        expected = f"-m workflow.start {' '.join(words)}\n"
        assert machine.run("snakemake", *words).stdout == expected


@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGTERM])
def test_ctrl_c_reaches_snakemake_and_not_its_jobs(machine, sent):
    """They are in a group of its own; its exit code is that of the command."""
    job = "trap 'echo job got it' INT TERM; echo ready; sleep 1; sleep 1"
    of_snakemake = f"trap 'echo got it; wait; exit 7' INT; sh -c \"{job}\" & wait"
    machine.command("python", of_snakemake, machine.home)
    with machine.start("snakemake") as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(sent)
        out, _ = process.communicate(timeout=30)
    assert (out, process.returncode) == ("got it\n", 7)


# --- the environment is made when it has to be, and only then


def test_first_calls_at_once_make_one_environment(machine):
    calls = [machine.start("true") for _ in range(3)]
    for call in calls:
        call.communicate(timeout=30)
    assert [call.returncode for call in calls] == [0, 0, 0]
    assert machine.times_made() == 1


def change_lock(machine):
    (machine.root / "requirements.lock").write_text(f"{LOCK}# a new pin\n")


def move(machine):
    machine.root = machine.root.rename(machine.root.with_name("moved"))


def change_python(machine):
    (machine.home / "python").rename(machine.home / "other")
    (machine.home / "python").symlink_to(machine.home / "other")


@pytest.mark.parametrize(
    ("change", "times"),
    [
        (lambda machine: None, 1),
        (change_lock, 2),
        (move, 2),
        (change_python, 2),
        (lambda machine: (machine.home / "python").unlink(), 2),
    ],
)
def test_environment_is_made_once_and_again_after_a_change(machine, change, times):
    assert machine.run("true").returncode == 0
    change(machine)
    assert machine.run("true").returncode == 0
    assert machine.times_made() == times


# --- an installation that stops


@pytest.mark.parametrize("phase", ["folder", "ensurepip", "pip", "mv", "clear", "venv", "sync"])
def test_a_call_after_a_kill_makes_what_is_missing(machine, phase):
    machine.without_uv()
    machine.command("mv", f'{STOP}\nat mv; exec {shutil.which("mv")} "$@"')
    assert machine.run("true", AT=phase, SIGNAL="KILL").returncode == -signal.SIGKILL
    assert machine.run("true").returncode == 0
    assert (machine.root / ".venv/packages").exists()
    assert {path.name for path in (machine.root / ".venv-uv").iterdir()} == {"bin", "lock"}


@pytest.mark.parametrize("phase", ["clear", "venv", "sync"])
def test_what_a_kill_leaves_is_no_environment_of_the_lock_before(machine, named, phase):
    machine.run("true", TIPRUB_PYTHON=named)
    change_lock(machine)
    assert machine.run("true", AT=phase, SIGNAL="KILL").returncode == -signal.SIGKILL
    (machine.root / "requirements.lock").write_text(LOCK)
    assert machine.run("true").returncode == 0
    assert (machine.root / ".venv/packages").exists()
    assert f"--python {named} " in (machine.home / "venv").read_text()


@pytest.mark.parametrize("phase", ["pip", "sync"])
def test_an_interrupt_is_one_line(machine, phase):
    machine.without_uv()
    result = machine.run("true", AT=phase, SIGNAL="INT")
    assert result.returncode == 130
    assert result.stderr.splitlines()[1:] == ["./run: interrupted; the same command continues"]
    assert machine.run("true").returncode == 0


PIP = "WARNING: Retrying after connection broken by 'Error: no'\nERROR: No uv found\n"
HASH = "ERROR: HASHES do not match\n    uv from x:\n        Got    e18a\n"


@pytest.mark.parametrize(
    ("output", "words"),
    [
        (PIP, "No uv found; connect to the network"),
        ("error: a\n  cause: error sending request\n  cause: dns error\n", "dns error; connect"),
        ("error: a\n  cause: /f: No space left on device (os error 28)\n", "free 2 GB and"),
        (HASH, "HASHES do not match; mend that and"),
        ("Traceback:\n  File\nOSError: no folder\n", "OSError: no folder; mend that and"),
    ],
    ids=["pip without network", "uv without network", "no room", "other hashes", "traceback"],
)
def test_why_no_environment_is_made_is_one_line(machine, output, words):
    (machine.home / "broken").write_text(output)
    result = machine.run("true")
    (line,) = result.stderr.splitlines()[1:]
    assert result.returncode == 1
    assert line.startswith("./run: cannot make .venv: ") and words in line
    assert line.endswith("give the command again (all output: .venv-uv/log)")
    assert (machine.root / ".venv-uv/log").read_text() == output
    (machine.home / "broken").unlink()
    assert machine.run("true").returncode == 0
    assert machine.times_made() == 2


def test_a_folder_without_rights_is_one_line(machine):
    machine.without_uv()
    machine.command("mkdir", 'echo "mkdir: no" >&2; exit 1')
    assert machine.refusal() == (
        "./run: cannot make .venv: mkdir: no; "
        "copy the project to a folder of yours and give the command again"
    )


def test_uv_is_installed_by_its_hash(machine):
    machine.without_uv()
    machine.run("true")
    asked = r".* --require-hashes -r \S+\nuv==[\d.]+( +--hash=sha256:[0-9a-f]{64}){2}\n"
    assert re.fullmatch(asked, (machine.home / "asked").read_text())


# --- a named Python with DOLFINx

WHEELS = {"dolfinx-solver-real", "fenics-basix", "fenics-ffcx", "fenics-ufl", "mpi4py", "mpich"}


@pytest.fixture
def named(machine):
    machine.command("named", FAKE, machine.home)
    return str(machine.home / "named")


def pins(lock):
    return set(re.findall(r"^([a-z0-9-]+)==", lock, re.MULTILINE))


def test_named_python_brings_dolfinx(machine, named):
    assert machine.run("true", TIPRUB_PYTHON=named).returncode == 0
    venv = (machine.home / "venv").read_text()
    assert "--system-site-packages" in venv
    assert f"--python {named} " in venv
    assert pins((machine.home / "installed").read_text()) == pins(LOCK) - WHEELS
    assert pins(LOCK) > WHEELS


def test_named_python_stays_until_another_is_named(machine, named):
    machine.run("true", TIPRUB_PYTHON=named)
    machine.run("true")
    assert machine.times_made() == 1
    change_lock(machine)
    machine.run("true")
    assert machine.times_made() == 2
    assert f"--python {named} " in (machine.home / "venv").read_text()
    machine.run("true", TIPRUB_PYTHON="")
    assert machine.times_made() == 3
    assert "--system-site-packages" not in (machine.home / "venv").read_text()
    assert pins((machine.home / "installed").read_text()) == pins(LOCK)


@pytest.mark.parametrize(
    ("python", "words"),
    [
        (str(PYTHON), r"\w+ is not installed: DOLFINx .* as fem/dolfinx\.md says"),
        ("/nowhere", r"is no Python 3\.12, 3\.13 or 3\.14; name one that has DOLFINx"),
    ],
)
def test_named_python_without_dolfinx_is_refused(machine, python, words):
    assert re.fullmatch(
        rf"\./run: TIPRUB_PYTHON={python}: {words}", machine.refusal(TIPRUB_PYTHON=python)
    )


# --- what the command finds


def test_command_runs_in_root_with_its_arguments_and_status(machine):
    result = machine.run("sh", "-c", 'readlink -f . ; echo "$1"; exit 3', "sh", "two words")
    assert result.stdout.splitlines() == [str(machine.root), "two words"]
    assert result.returncode == 3


@pytest.mark.parametrize(("given", "threads"), [({}, "1"), ({"OMP_NUM_THREADS": "4"}, "4")])
def test_of_the_callers_settings_only_that_of_threads_reaches_the_command(machine, given, threads):
    python = {"PYTHONDONTWRITEBYTECODE": "1", "PYTHONHOME": "/x", "PYTHONPATH": "/x"}
    result = machine.run("env", **python, **given)
    env = dict(line.split("=", 1) for line in result.stdout.splitlines())
    assert env.keys().isdisjoint({"PYTHONDONTWRITEBYTECODE", "PYTHONHOME"})
    assert env["PYTHONPATH"] == str(machine.root)
    assert env["PATH"].split(":")[0] == str(machine.root / ".venv/bin")
    assert env["OMP_NUM_THREADS"] == threads


# --- what is missing is named with the command that mends it


@pytest.mark.parametrize("version", [(3, 11, 9), (3, 15, 0)])
def test_no_suitable_python(machine, version):
    machine.without_uv()
    (machine.bin / "python3.12").unlink()
    disguise = f"import sys; sys.version_info = {version}; exec(sys.argv[1])"
    tell = f'[ "$1" != -c ] || exec {PYTHON} -c "{disguise}" "$2"'
    machine.command("python3", tell + FAKE)
    assert machine.refusal().endswith("install one with: .venv-uv/bin/uv python install 3.12")
    assert os.access(machine.root / ".venv-uv/bin/uv", os.X_OK)


@pytest.mark.parametrize(
    ("take", "remedy"),
    [
        (lambda m: (m.bin / "python3.12").unlink(), "python3-venv"),
        # not a library, and found first
        (lambda m: (m.libraries / "libGLU.so.1").touch(), "libglu1-mesa"),
        (lambda m: (m.bin / "cc").unlink(), "gcc libc6-dev"),
    ],
)
def test_what_is_missing_is_named_with_its_package(machine, take, remedy):
    take(machine)
    assert machine.refusal().endswith(f"sudo apt-get install -y {remedy}")


def test_python_under_pyenv_is_found_and_a_shim_without_one_skipped(machine):
    machine.command("python3.13", "exit 127")
    versions = machine.home / ".pyenv/versions/3.12.1/bin"
    versions.mkdir(parents=True)
    (machine.bin / "python3.12").rename(versions / "python")
    assert machine.run("true").returncode == 0


@pytest.mark.parametrize(("user", "status"), [("0", 0), ("0", 100), ("1000", 0)])
def test_only_root_installs_system_packages_and_is_told_what_it_could_not(machine, user, status):
    machine.command("id", f"echo {user}")
    machine.command("apt-get", f'echo "$@" >>"$HOME/apt"; exit {status}')
    (machine.bin / "cc").unlink()
    result, log = machine.run("true"), machine.home / "apt"
    assert (result.returncode == 0) is (user == "0" and status == 0)
    assert log.exists() is (user == "0")
    if status:
        assert result.stderr.splitlines()[-1].endswith(": apt-get install -y gcc libc6-dev")
    elif user == "0":
        assert log.read_text().splitlines()[-1].endswith(" gcc libc6-dev")


@pytest.mark.skipif(not shutil.which("readelf"), reason="needs readelf")
def test_every_system_library_of_gmsh_is_looked_for():
    (gmsh,) = (Path(sys.prefix) / "lib").glob("libgmsh.so.*")
    listing = subprocess.check_output(["readelf", "-d", gmsh], text=True)
    needed = set(re.findall(r"NEEDED.*\[(.+)\]", listing))
    python_has = {name for name in needed if re.match(r"(lib(c|m|dl|rt|pthread|z)\.|ld-)", name)}
    debian_has = {"libstdc++.so.6", "libgcc_s.so.1"}
    assert "libGLU.so.1" in needed
    assert needed - python_has - debian_has <= set(re.findall(r'"(lib\S+\.so\.\d+)":', SCRIPT))


# --- the lock


def test_lock_names_no_host_and_hashes_everything():
    assert "://" not in LOCK
    pins = re.split(r"\n(?=\S)", LOCK)
    assert len(pins) > 50
    assert [pin.split()[0] for pin in pins if "--hash=sha256:" not in pin] == []


def test_lock_holds_what_pyproject_asks_for():
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text())
    asked = pyproject["project"]["dependencies"] + pyproject["dependency-groups"]["dev"]
    locked = dict(re.findall(r"^([a-z0-9-]+)==(\S+)", LOCK, re.MULTILINE))
    for requirement in map(Requirement, asked):
        assert locked[canonicalize_name(requirement.name)] in requirement.specifier, requirement
