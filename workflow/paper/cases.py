"""Runs of the paper's tables, and those that give the uncertainty of our results.

Snakemake's rules import this module to list their jobs: it imports no compiled code.
"""

from simulate.errors.neighbour import Neighbour
from simulate.scene import Scene

# Table 1. Its 45.55 is taken as a misprint of 45.45 = 100/2.2, the pattern of the other values.
E = (1.0, 1.82, 4.55, 10.0, 13.64, 18.18, 45.45, 100.0, 181.82)
K = (0.45, 0.91, 4.55, 9.09, 45.45)
WORST = (10.0, 4.55)  # the paper's worst case
# From here, a coating is marched with twice the steps: with those of the others the wear of
# (181.82, 45.45) is up to 13 % off at k = 6 and lost energy flags 18 runs, with these 1 % and none.
STIFF = 50.0

# The two coatings of Figs. 10 to 12
COATINGS = {"e1": (1.0, 4.55), "e10": (10.0, 4.55)}

RICHER = "reference-rich"  # the paper's blade on a richer basis

# Second runs that give the uncertainty of a number, by the name of their folder
REPEATS = {
    "half-step": Neighbour(
        "half the step",
        scene=lambda of: of.but(integrator__steps_per_round=2 * of.integrator.steps_per_round),
    ),
    "twice-density": Neighbour(
        "twice the density",
        scene=lambda of: of.but(liner__rods_per_round=2 * of.liner.rods_per_round),
    ),
    "richer-basis": Neighbour("richer basis", scene=lambda of: of.but(blade=RICHER)),
}


def of_coating(scene: Scene, E: float, K: float) -> Scene:
    """The scene with another coating; with twice the steps if it is stiff."""
    coated = scene.but(liner__law__E=E, liner__law__K=K)
    if E < STIFF:
        return coated
    return coated.but(integrator__steps_per_round=2 * scene.integrator.steps_per_round)


# Rows of the table of E and K, one job each: E by the name of its file
ROWS = {f"E-{young:g}": young for young in E}
