"""The verification page: ./run python tests/verification/page.py [case ...]

Computes the named cases, or all, writes ``numbers.json`` beside this file, and from it
``tests/VERIFICATION.md``.
"""

import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

HERE = Path(__file__).parent
TESTS = HERE.parent
sys.path[:0] = [str(TESTS / folder) for folder in ("verification", "fem", "geometry", "simulate")]

import by_calculix  # noqa: E402
import energies  # noqa: E402
import massless_boundary  # noqa: E402
import rod_on_stop  # noqa: E402
import rotor37_surfaces  # noqa: E402
import rotor67  # noqa: E402
import rotor67_rub  # noqa: E402
import shocks  # noqa: E402
import standing_casing  # noqa: E402
import two_masses  # noqa: E402
import wright  # noqa: E402
from cases import Case, Row  # noqa: E402

from geometry.base import read_json, write_json, write_whole  # noqa: E402
from workflow.markdown import table  # noqa: E402

NUMBERS, PAGE = HERE / "numbers.json", TESTS / "VERIFICATION.md"
COMMAND = "./run python tests/verification/page.py"
CASES: Mapping[str, Case] = {
    "rod-on-stop": rod_on_stop.CASE,
    "mass-on-stop": shocks.ON_A_STOP,
    "friction": two_masses.CASE,
    "bar-on-wall": shocks.THROWN_BAR,
    "rotating-beam": wright.CASE,
    "calculix": by_calculix.CASE,
    "rotor67": rotor67.CASE,
    "rotor67-rub": rotor67_rub.CASE,
    "rotor37-surfaces": rotor37_surfaces.CASE,
    "pair": standing_casing.CASE,
    "moving-casing": standing_casing.BESIDE,
    "energies": energies.CASE,
    "massless-boundary": massless_boundary.CASE,
    "rotor37-rub": massless_boundary.ROTOR_37,
}

INTRODUCTION = f"""# Verification

Numbers of other programs, published tables and closed forms beside ours. All are computed by

    {COMMAND}

(a case alone: its name behind), and [a test](verification/test_verification.py) computes them
again: those of the cases marked * by night, the others with each `./run pytest`. Differences are
relative, of a number that should be zero absolute."""

STUDIES = "Studies of methods and models of the project itself, with nothing from outside:"

type Rows = dict[str, list[Row]]  # by case


def main(names: Sequence[str]) -> None:
    """Compute cases, and write their numbers and the page."""
    rows = read() if names else {}
    for name in names or CASES:
        rows[name] = list(CASES[name].rows())
        print(f"{name}: {worst(rows[name]).share:.0%} of its tolerance at most", flush=True)
    write_json({"cases": rows}, NUMBERS)
    write_whole(page(rows), PAGE)


def read() -> Rows:
    """Rows of all cases, as they were computed."""
    return {name: [Row(*of) for of in rows] for name, rows in read_json(NUMBERS)["cases"].items()}


def worst(rows: Sequence[Row]) -> Row:
    """The row that takes most of its tolerance."""
    return max(rows, key=lambda row: row.share)


def page(rows: Rows) -> str:
    """Text of the page: cases with numbers of others, then studies of the project's own."""
    parts = [INTRODUCTION, overview(rows, study=False), STUDIES, overview(rows, study=True)]
    sections = [section(name, case, rows[name]) for name, case in CASES.items()]
    return "\n\n".join([*parts, *sections]) + "\n"


def overview(rows: Rows, study: bool) -> str:
    """Table of the cases, or of the studies, with the row that is nearest to its tolerance."""
    head = ["case", "numbers", "difference nearest to its tolerance", "tolerance"]
    shown = [summary(case, rows[name]) for name, case in CASES.items() if case.study == study]
    return table(head, shown)


def summary(case: Case, rows: Sequence[Row]) -> list[object]:
    """Line of a case in the overview."""
    anchor = re.sub(r"[^\w\- ]", "", case.title.lower()).replace(" ", "-")
    star, most = " *" if case.nightly else "", worst(rows)
    return [f"[{case.title}](#{anchor}){star}", len(rows), most.shown, f"{most.tolerance:.2g}"]


def section(name: str, case: Case, rows: Sequence[Row]) -> str:
    """Text of a case."""
    facts = [
        ("Source", f"{case.source}."),
        ("Here", case.compared),
        ("Tolerance", case.reason),
        ("Command", f"`{COMMAND} {name}`"),
    ]
    told = "\n".join(f"- {what}: {text}" for what, text in facts)
    head = ["quantity", case.by, "ours", "difference", "tolerance"]
    numbers = [[row.quantity, *row.digits, row.shown, f"{row.tolerance:.2g}"] for row in rows]
    parts = [f"## {case.title}", told, table(head, numbers), case.conclusion]
    return "\n\n".join(filter(None, parts))


if __name__ == "__main__":
    main(sys.argv[1:])
