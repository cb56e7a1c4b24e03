"""Which runs the paper's tables and the uncertainty of ours need."""

from collections.abc import Callable, Mapping

from simulate.scene import Scene

# Table 1. Its 45.55 is taken as 45.45 = 100/2.2, which the other values follow.
E = (1.0, 1.82, 4.55, 10.0, 13.64, 18.18, 45.45, 100.0, 181.82)
K = (0.45, 0.91, 4.55, 9.09, 45.45)
WORST = (10.0, 4.55)  # the paper's worst case

# The two coatings of Figs. 10 to 12
COATINGS = {"e1": (1.0, 0.45), "e10": (10.0, 4.55)}

RICHER = "reference-rich"  # the paper's blade on a richer basis

# What shows how far a number is from settled
REPEATS: Mapping[str, Callable[[Scene], Scene]] = {
    "half-step": lambda scene: scene.changed(
        integrator__steps_per_round=2 * scene.integrator.steps_per_round
    ),
    "twice-density": lambda scene: scene.changed(
        liner__rods_per_round=2 * scene.liner.rods_per_round
    ),
    "richer-basis": lambda scene: scene.changed(blade=RICHER),
}


def of_coating(scene: Scene, E: float, K: float) -> Scene:
    """The scene with another coating."""
    return scene.changed(liner__law__E=E, liner__law__K=K)


# Contact stiffness and casing amplitude: where C11, C12 and C16 hold
UNITS_PA = (5e8, 1e9, 2e9, 4e9, 8e9, 1.6e10, 3.2e10)
SCALES = (1.25, 1.5, 1.75, 2.0, 2.5, 3.0)
