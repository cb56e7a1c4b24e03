"""The node of a body at which a motion leaves least margin, by bounds; the stress at one node."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.linalg import norm
from numpy.typing import NDArray

from fem.fatigue import (
    FIVE,
    damage,
    largest_change,
    mean_and_half,
    numbers,
    reserve,
    uniaxial,
)
from geometry.base import known
from geometry.blade import Fatigue

BLOCK, FEW = 512, 8  # nodes at a time: of bounds, of exact stresses
ROUND_OFF = 2e-6  # of a sum of some ten terms in single precision, over that of their sizes


def cycles(
    sigma: NDArray[np.float64], a: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean and alternating stress (nodes,), Pa, of the motion a (times, 1 + shapes).

    ``sigma`` (1 + shapes, nodes, 6): as of ``stresses`` at one speed; of rotation a is 1.
    """
    by_block = []
    for first in range(0, sigma.shape[1], BLOCK):
        block = sigma[:, first : first + BLOCK].transpose(1, 2, 0)
        five = FIVE.astype(sigma.dtype) @ block  # (nodes, 5, 1 + shapes)
        over_time = five.reshape(-1, len(sigma)) @ a.T
        ends = a[largest_change(over_time.reshape(*five.shape[:2], len(a)))]
        by_block.append(mean_and_half(*(block @ ends[..., None])[..., 0]))
    mean, alternating = map(np.concatenate, zip(*by_block, strict=True))
    return mean, alternating


def worst(
    five: NDArray[np.float32],
    exact: Callable[[NDArray[np.int64]], NDArray[np.float64]],
    revolutions: Sequence[NDArray[np.float64]],
    fatigue: Fatigue | None,
) -> tuple[int, int]:
    """The node and the revolution, from 0, of least margin; each revolution is by itself.

    Without a strength that of largest alternating stress. Nodes are searched by two bounds: the
    length of ``FIVE`` is a seminorm, so that mean and alternating stress are at most those of
    rotation and of each shape by itself, added; and at most those of the box of the five components
    over time, half the diagonal of which bounds the alternating stress. Both are in single
    precision, with its round-off; what they leave is computed.

    Parameters
    ----------
    five : (1 + shapes, nodes, 5), Pa, of rotation and of the shapes
    exact : the same of some nodes, (1 + shapes, nodes, 6), in double precision
    revolutions : motion (times, 1 + shapes) of each
    """
    turn = np.linalg.eigh(np.cov(np.concatenate(revolutions).T, bias=True))[1].T
    five = np.tensordot(turn.astype(np.float32), five, 1)  # in its own directions: close bounds
    own = [(a @ turn.T).astype(np.float32) for a in revolutions]
    each, best, least = norm(five, axis=2), (0, 0), np.inf
    most = np.array([np.abs(a).max(axis=0) for a in own]) @ each

    def bound(revolution: int, mean: Any, alternating: Any, nodes: Any = slice(None)) -> Any:
        """At least so much is left, for all that single precision loses."""
        off = ROUND_OFF * most[revolution, nodes]
        return reserve(numbers(mean + off, alternating + off, fatigue))

    of_shapes = [
        bound(number, most[number], np.ptp(a, axis=0) / 2 @ each) for number, a in enumerate(own)
    ]
    for number in np.argsort([left.min() for left in of_shapes]).tolist():
        order = of_shapes[number].argsort()
        for block in np.split(order, range(BLOCK, len(order), BLOCK)):
            if not len(nodes := block[of_shapes[number][block] < least]):
                break
            over_time = np.tensordot(own[number], five[:, nodes], 1)
            low, high = over_time.min(axis=0), over_time.max(axis=0)
            mean = norm(np.maximum(-low, high), axis=1)
            of_box = bound(number, mean, norm(high - low, axis=1) / 2, nodes)
            by_box = of_box.argsort()
            for few in np.split(by_box, range(FEW, len(by_box), FEW)):
                if len(few) and of_box[few[0]] < least:
                    exactly = cycles(exact(nodes[few]), revolutions[number])
                    left = reserve(numbers(*exactly, fatigue))
                    if (first := left.min()) < least:
                        least, best = first, (int(nodes[few[left.argmin()]]), number)
    return best


@dataclass(frozen=True)
class NodeStress:
    """Stress at a node over the amplitudes of a motion (times, 1 + n): 1, of rotation, then n."""

    sigma: NDArray[np.float64]  # (1 + n, 6), Pa
    fatigue: Fatigue | None

    def numbers(self, a: NDArray[np.float64]) -> dict[str, float]:
        """Mean and alternating stress, Pa, and the margin where there is a strength."""
        of_node = numbers(*cycles(self.sigma[:, None], a), self.fatigue)
        return {name: float(values[0]) for name, values in of_node.items()}

    def worst(self, revolutions: Iterable[NDArray[np.float64]]) -> dict[str, float]:
        """The numbers of the worst of revolutions, each by itself."""
        return min(map(self.numbers, revolutions), key=reserve)

    def order(self, a: NDArray[np.float64]) -> int:
        """Cycles in a revolution: of the largest line of the stress along its largest change."""
        return 1 + int(np.abs(np.fft.rfft(uniaxial(a @ self.sigma)))[1:].argmax())

    def damage(self, a: NDArray[np.float64]) -> float:
        """Miner's damage."""
        return damage(uniaxial(a @ self.sigma), known(self.fatigue, "fatigue"))
