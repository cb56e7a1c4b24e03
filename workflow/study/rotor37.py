"""Frequencies of a blade such as rotor 37 with either prestress, and with other cuts of its edges.

The edges of a section table are cut where they are too thin to mesh; here less and more is cut.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fem.assemble import STATES, assemble
from geometry.blade import Blade
from simulate.sweeps.peak import crossing_of
from workflow import markdown
from workflow.study.variants import frequencies, remeshed

FACTORS = (2 / 3, 1.0, 5 / 3)  # of the blade's own cut
MODES = 8
HZ = 2 * np.pi  # rad/s


def prestresses(files: Any, blade: str) -> dict[str, Any]:
    """Frequencies (speeds, ``MODES``), rad/s, at rest, half and full speed with either prestress.

    For the blade in the YAML file ``blade``, on its mesh ``files.mesh``.
    """
    own = Blade.load(blade)
    speeds = np.linspace(0, own.max_speed_rad_s, 3)
    study = {"speeds_rad_s": speeds.tolist()}
    for prestress in STATES:
        fom = assemble(own.but(prestress=prestress), Path(blade).stem, files.mesh, speeds)
        study[f"{prestress}_rad_s"] = frequencies(fom, MODES).tolist()
    return study


def edge_cuts(files: Any, blade: str) -> dict[str, Any]:
    """Frequencies at rest (cuts, ``MODES``), Hz, for each cut, % of chord.

    For the blade in the YAML file ``blade``, whose section table is ``files.source``.
    """
    settings = Blade.load(blade)
    own = settings.section_table.edge_cut_percent
    cuts = [round(factor * own, 6) for factor in FACTORS]
    blades = (settings.but(section_table__edge_cut_percent=cut) for cut in cuts)
    at_rest = [frequencies(remeshed(blade, files)[0], MODES)[0] / HZ for blade in blades]
    return {"own_percent": own, "cut_percent": cuts, "at_rest_Hz": np.array(at_rest).tolist()}


def prestress_table(study: Mapping[str, Any]) -> str:
    """Frequencies at three speeds with either prestress, and the crossing of engine order 4."""
    speeds = study["speeds_rad_s"]
    omega = {prestress: np.array(study[f"{prestress}_rad_s"]) for prestress in STATES}
    rows = [_row("at rest", omega["nonlinear"][0])]
    for j in (1, 2):
        rows += [_row(f"{speeds[j]:g} rad/s, {name}", omega[name][j]) for name in STATES]
    crossings = ", ".join(f"{crossing(speeds, omega[n][:, 0], 4):.4f} ({n})" for n in STATES)
    head = ["Hz", *_modes(omega["linear"])]
    shown = markdown.table(head, rows)
    return f"{shown}\n\nEngine order 4 crosses f1 at Ω / f1(0) = {crossings}."


def crossing(speeds: ArrayLike, omega: ArrayLike, k: int) -> float:
    """Speed over omega(0) at which k Omega = omega(Omega); nan above the last of the ``speeds``.

    Between the three speeds omega^2 is interpolated by a parabola in Omega^2.
    """
    over_rest = np.array([speeds, omega]) / omega[0]
    squares = np.polyfit(*over_rest**2, 2)
    return crossing_of(lambda speed: np.sqrt(np.polyval(squares, speed**2)), k, over_rest[0, -1])


def edge_cuts_table(study: Mapping[str, Any]) -> str:
    """Relative change of the frequencies at rest for other cuts of the edges."""
    own = study["cut_percent"].index(study["own_percent"])
    values = np.array(study["at_rest_Hz"])
    rows = [
        [f"{cut:g} instead of {study['own_percent']:g}"]
        + [f"{change:+.2f} %" for change in 100 * (row / values[own] - 1)]
        for cut, row in zip(study["cut_percent"], values, strict=True)
        if cut != study["own_percent"]
    ]
    return markdown.table(["at rest, cut % of chord", *_modes(values)], rows)


def _modes(values: ArrayLike) -> list[str]:
    return [f"mode {m}" for m in range(1, np.shape(values)[1] + 1)]


def _row(label: str, omega: ArrayLike) -> list[str]:
    return [label, *(f"{value:.1f}" for value in np.asarray(omega) / HZ)]
