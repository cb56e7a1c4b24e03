"""Files of sweeps with prescribed results, for tests of figures."""

import numpy as np
import xarray as xr

from geometry.base import ROOT, Provenance, code_hash
from rom.model import CODE, Rom
from simulate.scene import LEADING, History, Scene
from simulate.sweeps.dataset import FORMAT, save

GAP, F1, SAMPLES, ROUNDS = 2e-5, 100.0, 64, 20
SPAN = GAP / 1.5e-4  # where the scenes of the paper have that gap at xi = 1/16
STIFFENING = 5.6  # f1^2 = 1 + 5.6 Omega^2 over f1(0)
CAMBER = np.array([[0.5, 0.04, -0.02], [0.5, -0.04, 0.02]])  # r, theta, z of both edges
PROVENANCE = Provenance("reference", "a mesh", {}, code_hash(*CODE))
# Strips of unequal length: the first and a third of the second make up the leading eighth
ENDS = np.array([0, 1 / 16, 1 / 4, 1])


def made_rom():
    """Three modes, at 1, 4 and 4 times f1(0) at rest, the radial ones first, on two patches."""
    w = 2 * np.pi * F1 * np.array([1, 4, 4])
    return Rom(
        M=np.eye(3),
        K=np.array([np.diag(w**2), STIFFENING * np.eye(3), np.zeros((3, 3))]),
        directions=("radial",),
        xi=np.array([0.0, 1.0]),
        points=np.empty((0, 3)),
        camber=CAMBER,
        Omega_m=0.4 * w[0],
        f1=F1,
        span=SPAN,
        provenance=PROVENANCE,
        speeds=0.4 * w[0] * np.array([0, 0.5, 1]),
    )


def attrs_of(scene, name="paper-e1"):
    """Attributes of a sweep of ``scene`` on the made reduced model."""
    told = {"format": FORMAT, "scene": scene.model_dump_json(), "rom": PROVENANCE.dump()}
    return told | {"gap_m": GAP, "name": name}


def by_strip(wear):
    """Wear (speeds, 3, nu) of the strips whose mean over the leading eighth is ``wear``.

    None on the second strip, which has half of the eighth; more on the third, which has nothing.
    """
    wear = np.asarray(wear, dtype=float)
    return np.stack([2 * wear, 0 * wear, wear + 1], axis=1)


def save_runs(
    path, speeds, wear=None, u_r=None, status="ok", step=0.5, chord=(LEADING,), spectrum=None
):
    """Write runs at ``speeds`` (over f1(0)); wear (speeds, nu), u_r (speeds, n) and spectrum
    (speeds, bins) over gap g.

    ``wear`` is that of the leading eighth, ``u_r`` that at xi = 1/16: other places of the history
    hold its opposite.
    """
    scene = Scene.load(ROOT / "workflow/scenes/paper-e1.yaml")
    record = scene.record.model_copy(update={"samples_per_round": SAMPLES})
    data = {
        "status": ("speed_over_f1", [status] * len(speeds)),
        "step": ("speed_over_f1", [step * 1e-6] * len(speeds)),
        "step_limit": ("speed_over_f1", [1e-6] * len(speeds)),
    }
    liner = scene.liner
    if wear is not None:
        liner = liner.model_copy(update={"rods_per_round": len(wear[0])})
        data["wear"] = (("speed_over_f1", "strip", "theta"), GAP * by_strip(wear))
    if u_r is not None:
        record = record.model_copy(update={"history": History(chord=list(chord))})
        history = np.array([[u if xi == LEADING else -u for xi in chord] for u in u_r])
        data["history"] = (("speed_over_f1", "chord", "history_time"), GAP * history)
    if spectrum is not None:
        data["spectrum"] = (("speed_over_f1", "engine_order"), GAP * np.array(spectrum))
    coords = {
        "speed": ("speed_over_f1", 2 * np.pi * F1 * np.array(speeds)),
        "speed_over_f1": ("speed_over_f1", speeds),
        "end": ("strip_end", ENDS),
    }
    scene = scene.model_copy(update={"liner": liner, "record": record})
    save(xr.Dataset(data, coords=coords, attrs=attrs_of(scene)), path)
    return path
