"""Plan of the study of cost: what is varied, over which values, on which scene."""

from typing import Any

SCENE = "paper-e1"
# One run, near the k = 4 peak, where contact is usual; without twin and closing-in
ONE_SPEED: dict[str, Any] = {
    "speeds": {"over_f1": [0.35]},
    "peaks": None,
    "twin": False,
    "record__motion": None,
}
SIZES = (10.0, 5.0, 3.51, 2.48)  # mm, of the mesh
OF_SIZES = {"interface__patches": 8}  # coarse meshes bear no more
PATCHES = (8, 16, 32)
OF_PATCHES = 3.51  # mm, the mesh on which the patches are varied
STRIPS = (8, 16, 32, 64)
RODS = (2039, 10**4, 10**5, 10**6)  # per round
ROUNDS = (20, 100, 500, 5000)
FEW_STEPS = 2048  # per round, of the runs over the rounds
SPEEDS = (100, 1000, 10_000)
BLOCKS = 20  # of their sweeps
ROWS = (100, 1000, 10_000)
JOBS = (10, 100, 300, 1000)  # sweep blocks of a workflow; a scene may have no more
