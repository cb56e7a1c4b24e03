"""SLURM on this machine alone: one node, without systemd, accounting or files outside a folder."""

import getpass
import os
import shutil
import socket
import subprocess
import time
from importlib.util import find_spec
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd")
COMMANDS = ("mungekey", "sbatch", "srun", "squeue", "scancel", "scontrol")
PATHS = os.pathsep.join((os.environ["PATH"], "/usr/sbin", "/sbin"))
READY_S = 60.0
CONFIG = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge/socket
CryptoType=crypto/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=2
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} RealMemory={memory_mb} State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def missing() -> str:
    """What a cluster lacks here, with what installs it; nothing if it can be brought up."""
    if lacking := [name for name in DAEMONS + COMMANDS if not shutil.which(name, path=PATHS)]:
        return f"no {lacking[0]} here: apt-get install munge slurmctld slurmd slurm-client"
    if not find_spec("snakemake_executor_plugin_slurm"):
        return "no snakemake-executor-plugin-slurm here: see profiles/README.md"
    return ""


class Cluster:
    """munged, slurmctld and slurmd with all their files in a folder; a context takes them down."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.daemons = folder, []
        self.config = folder / "slurm.conf"
        paths = os.pathsep.join((str(folder / "bin"), PATHS))
        self.environment = {"SLURM_CONF": str(self.config), "PATH": paths}

    def __enter__(self) -> "Cluster":
        for name in ("munge", "state", "spool", "bin"):
            (self.folder / name).mkdir(mode=0o755)
        self.config.write_text(self._config())
        self._tell_srun()
        try:
            self._start_munge()
            self._start("slurmctld", "-D")
            self._start("slurmd", "-D")
            self._wait(lambda: self.ask("sinfo", "-h", "-o", "%t").strip() == "idle", "idle node")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if len(self.daemons) == len(DAEMONS):
            self.ask("scancel", "--user", getpass.getuser())
            self._wait(lambda: not self.ask("squeue", "-h"), "end of all jobs")
        for daemon in reversed(self.daemons):
            daemon.terminate()
            try:
                daemon.wait(timeout=20)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def ask(self, *command: str) -> str:
        """Output of a command of SLURM; nothing where it fails."""
        done = subprocess.run(
            command, env=os.environ | self.environment, capture_output=True, text=True, timeout=60
        )
        return done.stdout if done.returncode == 0 else ""

    def processes_in(self) -> list[str]:
        """Command lines of the processes that name the folder or run with its configuration."""
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                command, environment = (
                    (process / name).read_bytes() for name in ("cmdline", "environ")
                )
            except OSError:
                continue  # it ended
            if str(self.folder).encode() in command + environment:
                found.append(command.replace(b"\0", b" ").decode(errors="replace"))
        return found

    def _config(self) -> str:
        kilobytes = int(Path("/proc/meminfo").read_text().split()[1])
        return CONFIG.format(
            host=socket.gethostname().partition(".")[0],
            user=getpass.getuser(),
            folder=self.folder,
            ports=_free_ports(2),
            cpus=os.cpu_count(),
            memory_mb=kilobytes // 1024 - 500,
        )

    def _tell_srun(self) -> None:
        """Of the environment of a job the plugin's inner srun keeps no SLURM_CONF."""
        srun = self.folder / "bin/srun"
        program = shutil.which("srun", path=PATHS)
        srun.write_text(f'#!/bin/sh\nSLURM_CONF={self.config} exec {program} "$@"\n')
        srun.chmod(0o755)

    def _start_munge(self) -> None:
        """With a key of its own; --force: the folders of pytest are closed to other users."""
        munge = self.folder / "munge"
        subprocess.run(
            ["mungekey", "--create", f"--keyfile={munge}/key"],
            env=os.environ | self.environment,
            check=True,
        )
        files = {"key-file": "key", "socket": "socket", "pid-file": "pid", "seed-file": "seed"}
        places = [f"--{option}={munge / name}" for option, name in files.items()]
        self._start("munged", "--foreground", "--force", *places)
        self._wait((munge / "socket").exists, "munge")

    def _start(self, *command: str) -> None:
        program = shutil.which(command[0], path=PATHS)
        with (self.folder / f"{command[0]}.out").open("wb") as log:
            self.daemons.append(
                subprocess.Popen(
                    [program, *command[1:]],
                    env=os.environ | self.environment,
                    cwd=self.folder,
                    stdout=log,
                    stderr=log,
                    start_new_session=True,
                )
            )

    def _wait(self, reached, what: str) -> None:
        until = time.monotonic() + READY_S
        while not reached():
            logs = "\n".join(
                f"{path.name}:\n{path.read_text()[-1500:]}"
                for path in sorted((*self.folder.glob("*.out"), *self.folder.glob("*.log")))
            )
            assert time.monotonic() < until, f"no {what} within {READY_S:.0f} s\n{logs}"
            time.sleep(0.2)


def _free_ports(count: int) -> list[int]:
    """Ports that nobody listens on."""
    sockets = [socket.socket() for _ in range(count)]
    try:
        for each in sockets:
            each.bind(("127.0.0.1", 0))
        return [each.getsockname()[1] for each in sockets]
    finally:
        for each in sockets:
            each.close()
