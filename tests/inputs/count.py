"""Count the verdicts on 3,200 inputs, for tests/README.md: ./run python tests/inputs/count.py."""

import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

TESTS = Path(__file__).parents[1]
sys.path[:0] = [str(TESTS / name) for name in ("inputs", "geometry", "simulate", "fem", "workflow")]

from tester import count  # noqa: E402

from geometry.base import write_json  # noqa: E402

INPUTS = 3200


def main() -> int:
    """Write counts.json beside this file; return 1, with the inputs, if any verdict is bad."""
    with ProcessPoolExecutor() as processes:
        counts = count(INPUTS, processes.map)
    write_json({"inputs": INPUTS, "kinds": counts.kinds}, Path(__file__).with_name("counts.json"))
    print("\n".join(counts.faults), flush=True)
    return bool(counts.faults)


if __name__ == "__main__":
    sys.exit(main())
