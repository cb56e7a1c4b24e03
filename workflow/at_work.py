"""Whether another run is at work in a folder."""

import fcntl
from pathlib import Path
from typing import TextIO

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
