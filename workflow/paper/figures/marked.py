"""Figures of users with what the paper prints beside: Figs. 3, 10, 11, 14."""

from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from rom.check import RomCheck
from rom.crossings import crossing
from rom.model import Rom
from workflow.figures import campbell, spectra, wear
from workflow.figures.annotations import NO_LINES, Marks
from workflow.figures.response import Response
from workflow.paper.published import CRITICAL, CROSSING, HALF_DIGIT, LOBES, expected


def crossings(rom: Rom, check: RomCheck, operating: Mapping[str, Any] = campbell.PLAIN) -> Figure:
    """Campbell diagram with the crossings that the paper prints, half a digit to both sides."""
    spans = [(speed - HALF_DIGIT, speed + HALF_DIGIT, k) for k, speed in CROSSING.items()]
    return campbell.draw(rom, check, Marks("crossings in the paper", spans), operating)


def critical(sweep: Response, part: str, operating: Mapping[str, Any] = NO_LINES) -> Figure:
    """Spectra with the critical speeds of a ``part`` of the paper, as of ``CRITICAL``."""
    spans = [(*expected(part, k, crossing(sweep.rom, k)), k) for k in CRITICAL[part]]
    return spectra.over_speeds(sweep, Marks(r"$\Omega_c$, paper", spans), operating)


def lobes(sweep: Response, part: str) -> Figure:
    """Wear map with the lobes of a ``part`` of the paper, as of ``LOBES``.

    At the ends of the sweep, and at our peaks with k lobes. A pattern whose speed the paper prints
    stands there, unless a crossing goes with it.
    """
    off, orders = LOBES[part]
    speeds = {
        **{k: peak.Omega_c for k in orders if (peak := sweep.of_f1(k))},
        **{k: speed for k, speed in CRITICAL[part].items() if k not in CROSSING},
    }
    spans = [
        *((speed, speed, off) for speed in sweep.speeds[sweep.has_result][[0, -1]]),
        *((speeds[k], speeds[k], k) for k in orders if k in speeds),
    ]
    return wear.over_speeds(sweep, Marks("lobes in the paper", spans))
