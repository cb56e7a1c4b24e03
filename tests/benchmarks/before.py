"""The trade by stage of an earlier version, on this machine: workflow/study/before.json.

./run python tests/benchmarks/before.py: some 17 min of one core. Then `./run snakemake trade` on
the same machine, for a table and a figure of both versions. It needs the history of the repository.
"""

import json
import os
import subprocess
import sys
from collections import defaultdict
from pathlib import Path
from tempfile import TemporaryDirectory

COMMIT = "2085b24"  # before the models and runs of today
BLADES = ("coarse", "", "fine", "n8", "n32", "rich", "paper")
MODES = (12, 18)  # natural modes of further models of `reference`
FIRST = """
import os
from geometry.blade import Blade
from geometry.mesh import build_mesh
from geometry.settings import read_settings
from fem.assemble import over_speeds
from fem.matrices import Matrices
from rom.reconstruct import Basis
from rom.reduce import reduce
from rom.speeds import basis_speeds
begun = sum(os.times()[:4])
blade = read_settings(Blade, "workflow/blades/{blade}.yaml")
"""
LAST = """
print("CPU", sum(os.times()[:4]) - begun)
"""
JOBS = {  # as the scripts of the rules
    "mesh": """
build_mesh(blade, "results/{blade}/blade.msh", None)
""",
    "assemble": """
speeds = basis_speeds(blade.basis, blade.max_speed_rad_s)
constants, states = over_speeds(blade, "{blade}", "results/{blade}/blade.msh", speeds)
Matrices.of(constants, states).save("results/{blade}/matrices.h5")
""",
    "reduce": """
fom = Matrices.load("results/{blade}/matrices.h5")
rom, T = reduce(fom, blade.basis{changes}, "{directions}")
Basis.of(fom, T, rom.provenance).save("results/{blade}/basis.h5")
rom.save("{file}")
""",
}
RUNS = """
import json
from functools import cache
from geometry.settings import read_settings
from simulate.scene import Scene
from workflow.study.trade import _row, case_of
from workflow.study.trade_plan import SCENES, compared
from workflow.study.trade_runs import TURNS, rom_of, run

rows = []
for name, studied in SCENES.items():
    scene = read_settings(Scene, f"workflow/scenes/{studied.file}.yaml")

    @cache
    def march(setting, turns):
        rom = rom_of(setting.model)
        return run(case_of(scene, rom, setting), rom, studied, turns)

    for item in compared(studied):
        if item.study != "front":
            row = _row(item, march(item.setting, TURNS), march(item.against, 0).read)
            rows.append({"study": item.study, "scene": name} | row)
open("runs.json", "w").write(json.dumps(rows))
"""
STAGES = {
    "mesh": "mesh",
    "modes": "basis",
    "interface": "patches and strips",
    "rods": "rods",
    "scheme": "step",
}
RODS = {  # per round, of a flat and a tilted tip, which are one setting today
    str(number): f"{flat} or {tilted} rods"
    for flat, tilted in {509: 38543, 1021: 77101, 2039: 153911, 4093: 308411, 8191: 615709}.items()
    for number in (flat, tilted)
}
JUDGED = ("amplitude", "wear", "force", "history")


def python(code, folder):
    """What a Python of its own prints, with the code of the folder."""
    here = os.environ | {"PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=folder, env=here, check=True, stdout=subprocess.PIPE)
    return done.stdout.decode()


def seconds(job, folder, **about):
    """CPU time of a job without its imports, as jobs of today tell it."""
    printed = python(FIRST.format(**about) + JOBS[job].format(**about) + LAST, folder)
    return float(printed.split("CPU")[-1])


def models(folder):
    """CPU time of each model by its label in the study of mesh or basis; radial ones."""
    spent = {}
    for name in (f"reference-{of}".strip("-") for of in BLADES):
        (folder / "results" / name).mkdir(parents=True, exist_ok=True)
        before = sum(seconds(job, folder, blade=name) for job in ("mesh", "assemble"))
        for modes in (None, *MODES) if name == "reference" else (None,):
            for directions in ("rt", "r"):
                file = f"results/{name}/rom-{directions}.nc"
                if modes:
                    file = f"results/trade/models/{name}-{modes}-modes-{directions}.nc"
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                changes = f".model_copy(update={{'natural_modes': {modes}}})" if modes else ""
                about = {"directions": directions, "changes": changes, "file": file}
                last = seconds("reduce", folder, blade=name, **about)
            spent[name, modes] = before + last
            print(name, modes, spent[name, modes], flush=True)
    return spent


def stages(rows, spent):
    """Settings as ``workflow.study.stages.tried`` has them."""
    found = defaultdict(lambda: {"error": 0.0, "cpu_s": 0.0})
    for row in rows:
        errors = [row["errors"][name] for name in JUDGED]
        stage, of = (
            STAGES[row["study"]],
            "tilted tip" if row["scene"] == "tangential" else "flat tip",
        )
        label, cpu_s = row["label"], row["cpu_s"][1]
        if stage == "step":
            exact, scaled = row["scheme"] == "piecewise-exact", row["mass_scaling_hz"]
            stage += ", piecewise-exact" if exact else ", mass-scaled" if scaled else ", central"
        if stage in ("mesh", "basis"):
            of = "model"
        if stage == "rods":
            label = RODS[label.split()[0]]
        at = found[stage, of, label]
        at["error"] = max(at["error"], *(float("inf") if e is None else e for e in errors))
        if of == "model":
            modes = row["modes"] if row["blade"] == "reference" and row["modes"] in MODES else None
            at["cpu_s"] = spent[row["blade"], modes]
        else:
            at["cpu_s"] += cpu_s
    return [
        dict(zip(("stage", "of", "row"), where, strict=True))
        | {name: float(f"{value:.4g}") for name, value in at.items()}
        for where, at in found.items()
        if at["error"] < float("inf")
    ]


if __name__ == "__main__":
    root = Path(__file__).parents[2]
    with TemporaryDirectory() as temporary:
        folder = Path(temporary) / "before"
        subprocess.run(["git", "clone", "-q", str(root), str(folder)], check=True)
        subprocess.run(["git", "checkout", "-q", COMMIT], cwd=folder, check=True)
        spent = models(folder)
        python(RUNS, folder)
        found = stages(json.loads((folder / "runs.json").read_text()), spent)
    (root / "workflow/study/before.json").write_text(json.dumps(found, indent=1) + "\n")
