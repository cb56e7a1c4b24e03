"""Check of a liner law against the assumptions of the computation.

The law is loaded from a fresh rod through strains up to 0.9; at each of them its stress, plastic
strain and tangent are compared with each other, with unloading, and with its plastic work.
"""

import re
from collections.abc import Iterator
from functools import cache
from math import isfinite
from typing import NamedTuple

import numpy as np

from geometry.base import failed
from simulate.scene.law import Law

STRAINS = np.geomspace(1e-9, 0.9, 181)  # 20 in a decade
ROUND_OFF = 1e-9  # of a stress or strain
STEP = 1e-6  # of a strain, for the derivative of the stress
KINK = 1e-3  # difference of the derivatives on both sides beyond which there is no tangent
TANGENT = 0.01  # error of a tangent
THREE = "it returns three numbers: stress, plastic strain and tangent"
WORK = 0.05  # error of the work: trapezoids between the strains miss less
CAUSE = re.compile(r".*(Untyped global|Unknown attribute|No implementation|unsupported|NRT).*")
COMPILED = (
    "stress and plastic_work are compiled: they take numbers, math, if and for, but no lists, "
    "dictionaries, texts or methods of the class; a function that they call needs numba.njit"
)


class Point(NamedTuple):
    """A rod at a total strain on its way."""

    eps: float
    before: float  # plastic strain before
    sigma: float  # Pa
    after: float  # plastic strain
    tangent: float  # Pa


@cache
def fault(law: Law) -> str | None:
    """First assumption that ``law`` does not meet, with the strain; None if none."""
    last, taken, modulus = Point(0.0, 0.0, 0.0, 0.0, 0.0), 0.0, None
    for eps in STRAINS.tolist():
        where = f"at a total strain of {eps:.3g}, from a plastic strain of {last.after:.3g}"
        try:
            sigma, after, tangent = map(float, law.stress(law.parameters, eps, last.after))
        except Exception as error:
            return f"stress: {error}: {THREE}, {where}"
        point = Point(eps, last.after, sigma, after, tangent)
        taken += (last.sigma + sigma) / 2 * (eps - last.eps)
        modulus = modulus or law.modulus  # of a law that returns three numbers
        try:
            message = next(_faults(law, modulus, last, point, taken), None)
        except (TypeError, ValueError) as error:
            return f"{error}: stress returns three numbers, plastic_work one, {where}"
        if message:
            return f"{message}, {where}"
        last = point
    return None


def _faults(law: Law, modulus: float, last: Point, point: Point, taken: float) -> Iterator[str]:
    """Faults at a state, after ``last`` on the path; ``taken`` J/m3 is the work of the stress."""
    yield from failed(
        (
            all(map(isfinite, point)),
            f"stress returns {point[2:]}, not finite",
        ),
        (
            point.sigma >= 0.0,
            f"stress is {point.sigma:.3g} Pa, and the liner bears no tension",
        ),
        (
            point.after <= point.eps * (1 + ROUND_OFF),
            f"plastic strain is {point.after:.3g}, more than the total strain",
        ),
        (
            point.sigma >= last.sigma * (1 - ROUND_OFF),
            f"stress falls from {last.sigma:.3g} to {point.sigma:.3g} Pa while the strain grows",
        ),
    )
    yield from _unloading_faults(law, point)
    yield from _tangent_faults(law, modulus, point)
    elastic = point.eps - point.after
    if point.after > 0 and abs(point.sigma - modulus * elastic) > KINK * point.sigma:
        unloading = point.sigma / elastic
        yield f"unloads with {unloading:.4g} Pa, not with the modulus of {modulus:.4g} Pa"
    stored = point.sigma * (point.eps - point.after) / 2
    work = law.plastic_work(law.parameters, 0.0, point.after)
    if abs(stored + work - taken) > WORK * taken:
        yield f"plastic_work is {work:.3g} J/m3, the stress has done {taken - stored:.3g} J/m3"


def _unloading_faults(law: Law, point: Point) -> Iterator[str]:
    """Unloading is linear, down to the plastic strain; below it the gap is open."""
    sigma, after, _ = law.stress(law.parameters, (point.eps + point.after) / 2, point.after)
    yield from failed(
        (
            not abs(sigma - point.sigma / 2) > STEP * point.sigma,
            f"unloaded by half, stress is {sigma:.6g} of {point.sigma:.6g} Pa: not linear",
        ),
        (
            not abs(after - point.after) > ROUND_OFF * point.after,
            f"unloaded by half, plastic strain changes from {point.after:.6g} to {after:.6g}",
        ),
    )
    sigma = (
        law.stress(law.parameters, point.after / 2, point.after)[0] if point.after > 0.0 else 0.0
    )
    if sigma != 0.0:
        yield f"stress is {sigma:.3g} Pa at half of the plastic strain, where the gap is open"


def _tangent_faults(law: Law, modulus: float, point: Point) -> Iterator[str]:
    """The tangent is the derivative of the stress, where it has one, and the modulus bounds it."""
    h = STEP * point.eps
    below, above = (law.stress(law.parameters, point.eps + d, point.before)[0] for d in (-h, h))
    left, right = (point.sigma - below) / h, (above - point.sigma) / h
    size = max(abs(left), abs(right), point.sigma / point.eps)
    kink = not abs(left - right) < KINK * size
    yield from failed(
        (
            kink or not abs(point.tangent - left) > TANGENT * size,
            f"tangent is {point.tangent:.3g} Pa, the derivative of the stress {left:.3g} Pa",
        ),
        (
            not point.tangent > modulus * (1 + ROUND_OFF),
            f"tangent is {point.tangent:.3g} Pa, above the modulus of {modulus:.3g} Pa",
        ),
    )


def compile_fault(law: Law, error: Exception) -> str:
    """Reason why ``law`` cannot be compiled, in one line, from the lines of numba's error."""
    cause = CAUSE.search(str(error))
    reason = cause[0].strip() if cause else str(error).strip().splitlines()[0]
    return f"liner.law: {type(law).__name__}: {reason}; {COMPILED}"
