"""Peaks of the scenes on casings that move, beside the rigid one, from the summary of all.

./run snakemake --config 'scenes=[paper-e10,casing-2000,casing-800,casing-400,ring]'
./run python -m tests.verification.casings
"""

from pathlib import Path

from geometry.base import csv_text, read_json, write_whole
from workflow.markdown import Number

KEPT, COMMAND = "workflow/study/kept/casings.csv", "./run python -m tests.verification.casings"
CASINGS = {
    "paper-e10": "rigid",
    "casing-2000": "2000 Hz, 9 kg",
    "casing-800": "800 Hz, 9 kg",
    "casing-400": "400 Hz, 9 kg",
    "ring": "ring: 187 Hz, 17 kg, and orders 0, 3, 4",
}
HEAD = [
    *("casing", "EO 4: Ω / f₁(0)", "amplitude, µm", "largest u_r, µm", "of the casing, µm"),
    *("EO 5: Ω / f₁(0)", "amplitude, µm"),
]
UM = 1e6


def main() -> None:
    """Write the table of the summary that is there."""
    scenes = {scene["scene"]: scene for scene in read_json("results/summary.json")["scenes"]}
    rows = [[named, *cells(scenes[name])] for name, named in CASINGS.items()]
    write_whole(f"# {COMMAND}\n{csv_text([HEAD, *rows])}", Path(KEPT))


def cells(scene: dict) -> list[str]:
    """Cells of a scene, ± as far as it is known."""
    found = []
    for k in (4, 5):
        rows = [row for row in scene["rows"] if row["k"] == k and row["modes"] == [1]]
        if not rows:
            found += ["-"] * (4 if k == 4 else 2)
            continue
        row = max(rows, key=lambda row: row["values"]["amplitude"])
        found.append(str(Number(row["over_f1"], row["over_f1"] * row["rpm_error"] / row["rpm"])))
        names = ["amplitude"] + ["displacement", "casing_motion"] * (k == 4)
        found += [um(row, name) for name in names]
    return found


def um(row: dict, name: str) -> str:
    """A number of a peak, um; - where it has none."""
    if name not in row["values"]:
        return "-"
    return str(Number(UM * row["values"][name], UM * row["errors"][name]))


if __name__ == "__main__":
    main()
