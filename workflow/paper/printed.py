"""Numbers that the paper prints, which figures mark and claims compare. Speeds are over f1(0)."""

HALF_DIGIT = 0.005  # of its speeds
# Linear crossings of f1 with engine order k. The two contradict each other (C10).
CROSSING = {4: 0.31, 6: 0.17}
CROSSINGS = {4: CROSSING[4], 6: 0.181}  # the paper's 0.31, and what follows from it (C10)
# Critical speeds, by part of an edition and by k
CRITICAL = {
    "e1": {4: 0.35, 6: 0.18},
    "e10": {4: 0.38, 5: 0.24, 6: 0.20},
    "two_five": {5: 0.26},
}
# Worn lobes away from resonance, by part, and orders k at whose peak there are k lobes
LOBES = {"e1": (2, (4, 6)), "e10": (2, (4, 6)), "two_five": (5, (4, 5, 6))}


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
