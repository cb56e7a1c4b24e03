"""Numbers that the paper prints, which figures mark and claims compare. Speeds are over f1(0)."""

HALF_DIGIT = 0.005  # of its speeds
ENGINE_ORDER = 4  # of the peaks that it compares
# Linear crossings of f1 with engine order k. The two contradict each other (C10): the second one
# that follows from 0.31 under f1^2 = 1 + B Omega^2 is 0.181.
CROSSING = {4: 0.31, 6: 0.17}
CONSISTENT = {4: CROSSING[4], 6: 0.181}
# Critical speeds, by part of an edition and by k
CRITICAL = {
    "e1": {4: 0.35, 6: 0.18},
    "e10": {4: 0.38, 5: 0.24, 6: 0.20},
    "two_five": {5: 0.26},
}
# Omega_c over the linear crossing: (paper, half a digit of Omega_c over the crossing)
SHIFTS = {
    (part, str(k)): (CRITICAL[part][k] / crossing, HALF_DIGIT / crossing)
    for part in ("e1", "e10")
    for k, crossing in CROSSING.items()
}
# Table 1, of ``workflow/experiments/grid.yaml``
E = (1.0, 1.82, 4.55, 10.0, 13.64, 18.18, 45.45, 100.0, 181.82)
K = (0.45, 0.91, 4.55, 9.09, 45.45)
WORST = (10.0, 4.55)  # E and K of its worst case
FORCE_RATIO = 0.15  # mean tangential over radial force
# Worn lobes away from resonance, by part, and orders k at whose peak there are k lobes
LOBES = {"e1": (2, (4, 6)), "e10": (2, (4, 6)), "two_five": (5, (4, 5, 6))}


def shifts_of(part: str) -> str:
    """Shifts of a coating at EO 4 and 6, as text.

    >>> shifts_of("e10")
    '1.226, 1.176'
    """
    return ", ".join(f"{SHIFTS[part, str(k)][0]:.3f}" for k in CROSSING)


def expected(part: str, k: int, crossing: float) -> tuple[float, float]:
    """Lowest and highest speed that rounds to the paper's, on a blade with another ``crossing``.

    Where the paper prints its crossing with ``k``, its critical speed is taken over that; else as
    it stands.

    >>> [round(speed, 4) for speed in expected("e10", 4, crossing=0.62)]
    [0.75, 0.77]
    >>> expected("e10", 5, crossing=0.227)
    (0.235, 0.245)
    """
    scale = crossing / CROSSING[k] if k in CROSSING else 1.0
    speed = CRITICAL[part][k]
    return (speed - HALF_DIGIT) * scale, (speed + HALF_DIGIT) * scale
