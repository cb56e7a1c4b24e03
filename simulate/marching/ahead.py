"""The kernel of a scene, compiled before the reduced model of its blade is there.

Its machine code depends on the types of its arguments alone, not on their numbers or sizes.
"""

import numpy as np

from geometry.base import Provenance
from rom.model import DIRECTIONS, Rom
from simulate.marching.run import make_kernel
from simulate.marching.setup import prepare
from simulate.scene import Scene

F1 = 250.0  # Hz
SPAN = 0.15  # m
SPEED = 300.0  # rad/s


def compile_ahead(scene: Scene, across: int = 1) -> float:
    """Compile the kernel of a scene, or read it from its file; return wall time, s.

    A blade of equal frequencies stands for the scene's, with so many rows ``across``.

    Raises
    ------
    geometry.base.errors.UserError
        When the scene does not fit that blade.
    """
    directions = tuple(DIRECTIONS[letter] for letter in scene.directions)
    n = 2 * across * len(directions)
    edges = SPAN / 10 * np.array([-1, 1])
    rom = Rom(
        M=np.eye(n),
        K=(2 * np.pi * F1) ** 2 * np.eye(n)[None],
        directions=directions,
        xi=np.array([0.0, 1.0]),
        points=np.empty((0, 3)),
        camber=np.column_stack([4 * SPAN + 0 * edges, edges, edges]),
        Omega_m=2 * SPEED,
        f1=F1,
        span=SPAN,
        provenance=Provenance("of no blade", "", {}, ""),
        across=across,
        sides=np.array([[-0.01] * 2, [0.01] * 2]) + edges,
    )
    return make_kernel(scene, prepare(scene, rom, SPEED))
