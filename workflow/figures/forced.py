"""Amplitude along the engine orders that excite the blade, over the speed, with and without rub."""

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from geometry.base import known
from geometry.tip import JUDGED
from rom.model import Rom
from simulate.contact.places import closing_rows
from simulate.marching.forced import forced
from simulate.scene import Scene
from simulate.signals import leading_gap
from simulate.sweeps.peak import along_order
from workflow.figures import style, units
from workflow.figures.annotations import mark_speeds
from workflow.figures.lines import LOOKS
from workflow.figures.response import Response

POINTS = 1001  # speeds of the response without contact, besides those of the sweep
SHOWN = len(LOOKS)  # orders, of the largest response


@style.styled
def draw(sweep: Response) -> Figure:
    """Draw the amplitude along each order: symbols with rub, lines in closed form without.

    Open symbols: runs in which the tip did not touch.
    """
    drawn, axes = style.subplots(style.SINGLE, 3.2)
    unit, _ = sweep.units["length"]
    gap, numbers = leading_gap(sweep.sweep), np.array(sweep.scene.forced)
    speeds = np.union1d(sweep.speeds, np.linspace(*sweep.speeds[[0, -1]], POINTS))
    alone = without_contact(sweep.scene, sweep.rom, speeds * sweep.rom.omega1) / gap
    touched = sweep.status != "no-contact"
    most = np.sort(np.argsort(-alone.max(axis=0), stable=True)[:SHOWN])
    for (look, color), i in zip(LOOKS, most, strict=False):
        axes.plot(speeds, unit.scale * alone[:, i], color=color, linewidth=0.8)
        found = unit.scale * along_order(sweep.sweep, float(numbers[i]))
        for runs, face in ((touched, color), (~touched, "white")):
            shown = axes.plot(
                sweep.speeds[runs], found[runs], look[0], color=color, markerfacecolor=face
            )
            shown[0].set(markersize=3.5, label=f"EO {numbers[i]}" * (face == color))
    axes.plot([], [], color=style.GREY, linewidth=0.8, label="without contact")
    axes.set(ylabel=f"amplitude of $u_r$ {unit.label}", ylim=(0, None))
    axes.set_xlim(*sweep.speeds[[0, -1]])
    axes.legend(loc="best")
    mark_speeds(axes, sweep)
    units.show(axes.xaxis, style.below, *sweep.units["speed"])
    drawn.suptitle(sweep.names, fontsize=8)
    return drawn


def without_contact(scene: Scene, rom: Rom, speeds: NDArray[Any]) -> NDArray[np.float64]:
    """Amplitude (speeds, orders), m, at xi = 1/16 without contact: the closed form; rad/s."""
    row = closing_rows(rom, scene.casing, np.array(JUDGED[:1]))[0]
    of_force = known(scene.force, "force")
    return np.array(
        [
            np.abs(
                forced(of_force, rom, scene.damping_ratio, Omega).Q @ (row @ rom.modes(Omega)[1])
            )
            for Omega in speeds
        ]
    )
