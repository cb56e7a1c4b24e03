"""Whether a run can work in a folder: it is writable, and whether another run is at work."""

import fcntl
from pathlib import Path
from tempfile import TemporaryFile
from typing import TextIO

ROOM = 2**16  # bytes
ANOTHER = (
    "another run is at work in this folder: of what both make the later one stays, and a job may "
    "miss files that the other makes anew. Wait for it, or work in a clone"
)


def hold(path: Path) -> TextIO | None:
    """Open and lock the file at ``path``, until it is closed; None where another process has it.

    The lock ends with the process, also when it is killed.
    """
    held = path.open("w")
    try:
        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        held.close()
        return None
    except OSError:  # a file system without locks
        pass
    return held


def not_writable(folder: str | Path) -> str:
    """Why a run cannot write to a folder; empty where it can.

    Snakemake itself, and jobs, have a traceback where they find no room for a short file.
    """
    try:
        with TemporaryFile(dir=folder) as file:
            file.write(bytes(ROOM))
            file.flush()
    except OSError as error:
        return f"{folder}: cannot be written ({error.strerror}): make room there, or get the rights"
    return ""
