"""Sweeps of made-up runs, as files, for the figures of single runs."""

from pathlib import Path

import numpy as np
import xarray as xr

from geometry.settings import read_settings
from rom.model import Rom
from simulate.scene import History, Scene
from simulate.sweep import save

ROOT = Path(__file__).parents[2]
GAP, F1, SAMPLES, ROUNDS = 2e-5, 100.0, 64, 20
STIFFENING = 5.6


def made_rom():
    """Three modes, 1, 4 and 4 times f1(0) at rest; f1^2 = 1 + 5.6 Omega^2 over f1(0)."""
    w = 2 * np.pi * F1 * np.array([1, 4, 4])
    return Rom(
        M=np.eye(3),
        K=np.array([np.diag(w**2), STIFFENING * np.eye(3), np.zeros((3, 3))]),
        directions=("radial", "tangential", "axial"),
        points=np.array([[0.5, 0.0, 0.0]]),
        Omega_m=0.4 * w[0],
        f1=F1,
        span=0.14,
        provenance="test",
    )


def save_runs(path, speeds, wear=None, u_r=None, status="ok", step=0.5, nodes=(1,), spectrum=None):
    """Write runs at ``speeds`` (over f1(0)); wear (speeds, nu), u_r (speeds, n) and spectrum
    (speeds, bins) over the gap.

    ``u_r`` is that of node 1; the other history nodes hold its opposite.
    """
    scene = read_settings(Scene, ROOT / "workflow/scenes/paper-e1.yaml")
    record = scene.record.model_copy(update={"samples_per_round": SAMPLES})
    data = {
        "status": ("speed", [status] * len(speeds)),
        "step": ("speed", [step * 1e-6] * len(speeds)),
        "step_limit": ("speed", [1e-6] * len(speeds)),
    }
    liner = scene.liner
    if wear is not None:
        liner = liner.model_copy(update={"rods_per_round": len(wear[0])})
        data["wear"] = (("speed", "node", "theta"), GAP * np.array(wear)[:, None])
    if u_r is not None:
        record = record.model_copy(update={"history": History(nodes=list(nodes))})
        history = np.array([[u if node == 1 else -u for node in nodes] for u in u_r])
        data["history"] = (("speed", "history_node", "sample"), GAP * history)
    if spectrum is not None:
        data["spectrum"] = (("speed", "bin"), GAP * np.array(spectrum))
    coords = {
        "speed": 2 * np.pi * F1 * np.array(speeds),
        "speed_over_f1": ("speed", speeds),
        "gap": ("node", [GAP]),
    }
    scene = scene.model_copy(update={"liner": liner, "record": record})
    save(xr.Dataset(data, coords=coords, attrs={"scene": scene.model_dump_json()}), path)
    return path
