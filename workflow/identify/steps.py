"""Steps of a coating at the resolution of the tables: stiff ones lose energy in long steps.

A run that loses too much is `inaccurate`, and has no peak: without these steps the fits would leave
out stiff coatings. Some are with 1024 steps from E = 50 GPa on, with 2048 from 123 GPa, with 4096
none at 298 GPa: measured on the reference blade, whose tip is softer than that of rotor 37. With
8192 critical speeds at 130 and 220 GPa are the same, amplitudes differ by 0.5 %, wear by 0.9 %.
"""

from math import ceil, log2

from simulate.scene import Scene

STEPS = 1024  # per revolution
FIRM = 4.5e10  # Pa, modulus up to which these serve
MOST = 4  # largest factor on ``STEPS``


def steps_per_round(E: float) -> int:
    """Steps per revolution of a coating of modulus ``E`` (Pa): ``STEPS`` times 1, 2 or 4."""
    times = min(max(E / FIRM, 1.0), MOST)
    return STEPS * 2 ** ceil(log2(times))


def with_steps(scene: Scene) -> Scene:
    """The scene with the steps that its liner asks for, if it has fewer."""
    law, given = scene.liner.law, scene.integrator.steps_per_round
    if law.kind == "rigid":
        return scene
    return scene.but(integrator__steps_per_round=max(given, steps_per_round(law.E * law.unit_Pa)))
