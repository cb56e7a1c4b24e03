"""Jumps of the numbers of a run between models that differ ever less.

Where two motions are possible, the last digits of the model choose. Across such a jump the change
of the numbers stays as the difference of the models is halved; where the numbers are steep alone,
it is halved with it. Models whose frequencies differ by as much as a resonance is wide, as those of
coarse meshes do, are no last digits: between them the resonance itself passes the speed.
"""

from collections.abc import Callable
from itertools import chain, pairwise

from simulate.errors.observables import Numbers

JUMP_FROM = 0.05  # relative change between two models from which a jump is looked for
LAST = 3e-3  # relative, of frequencies: the last digits of a model; a usual damping ratio
HALVINGS = 4  # of their difference: the change of a steep number falls to some sixteenth
JUMPS = 0.5  # share of the change that is left across a jump
TELL_APART = ("amplitude", "worn_volume")  # numbers that tell one motion from another


def change(one: Numbers, *others: Numbers) -> Numbers:
    """Relative change of each number, over the larger; inf where one alone has it.

    The largest of those to the ``others``.

    >>> change({"amplitude": 1.0, "wear": 2.0}, {"amplitude": 2.0, "wear": 2.0})
    {'amplitude': 0.5, 'wear': 0.0}
    """
    names = dict.fromkeys(chain(one, *others))
    return {
        name: max(_change(one.get(name), other.get(name)) for other in others) for name in names
    }


def _change(a: float | None, b: float | None) -> float:
    if a == b:
        return 0.0
    return float("inf") if a is None or b is None else abs(a - b) / max(abs(a), abs(b))


def largest(changes: Numbers) -> float:
    """Largest of the changes, 0 without any."""
    return max(changes.values(), default=0.0)


def jump(
    at: Callable[[float], Numbers], results: dict[float, Numbers]
) -> tuple[Numbers, Numbers] | None:
    """Numbers on both sides of a jump between models; None without one.

    The interval with the larger change is halved, ``HALVINGS`` times. Changes are those of
    ``TELL_APART``.

    Parameters
    ----------
    at : numbers of the model that differs by a share
    results : those at some shares, to which more are added

    >>> step = lambda share: {"amplitude": 1 + (share > 0.3) + share / 10}
    >>> low, high = jump(step, {share: step(share) for share in (-1.0, 0.0, 1.0)})
    >>> round(low["amplitude"], 1), round(high["amplitude"], 1)
    (1.0, 2.0)
    """
    shares = sorted(results)
    low, high = max(pairwise(shares), key=lambda ends: _across(results, *ends))
    first = _across(results, low, high)
    if first < JUMP_FROM:
        return None
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        results[middle] = at(middle)
        halves = (low, middle), (middle, high)
        low, high = max(halves, key=lambda ends: _across(results, *ends))
    if _across(results, low, high) < JUMPS * min(first, 1.0):
        return None
    return results[low], results[high]


def _across(results: dict[float, Numbers], low: float, high: float) -> float:
    changes = change(results[low], results[high])
    return max(changes.get(name, 0.0) for name in TELL_APART)
