"""``python -m rom check FILE``: checks of a reduced model made elsewhere."""

import argparse
import sys

from geometry.project import command
from rom.foreign import UNCHECKED, report


@command
def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return the exit code, 2 with a line for each fault."""
    parser = argparse.ArgumentParser(prog="python -m rom", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    checked = commands.add_parser("check", help="check a reduced model made elsewhere")
    checked.add_argument("file", help="NetCDF 4, as rom/README.md describes it")
    options = parser.parse_args(arguments)
    model_check = report(options.file)
    for line in model_check.shown:
        print(line)
    for fault in model_check.faults:
        print(f"{options.file}: {fault}", file=sys.stderr)
    if not model_check.faults:
        print("The file cannot show, and is not checked:", *UNCHECKED, sep="\n- ")
    return 2 if model_check.faults else 0


if __name__ == "__main__":
    sys.exit(main())
