"""``./run snakemake``: Snakemake, which Ctrl-C ends in a line.

While Snakemake has no jobs yet the line is from here, later from ``workflow.targets.messages``.
"""

import runpy
import signal
import sys

STOPPED = "interrupted; the same command continues from what is done"
INTERRUPTED = 130  # exit code, as of a shell


def main() -> None:
    """Run Snakemake with the arguments of this program."""
    # a shell ignores it for what a script begins with &, where ./run may still send it
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        runpy.run_module("snakemake", run_name="__main__", alter_sys=True)
    except KeyboardInterrupt:
        print(STOPPED, file=sys.stderr)
        sys.exit(INTERRUPTED)
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # a second one, while Python ends


if __name__ == "__main__":
    main()
