"""Natural frequencies measured on the blade in place of those of its clamped model.

A real root is softer than a clamp, by per cent, and a rub's speed follows f1. The frequencies at
rest of the modes given change, and nothing else there, with modes of phi^T M phi = 1:

    K0' = K0 + M Phi diag(omega'^2 - omega^2) Phi^T M

What rotation adds to K0 stays that of the clamped shapes.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from geometry.base import Fault, require
from geometry.blade import given_frequencies
from rom.model import Rom, RomError

MOST = 0.1  # relative shift of a frequency: beyond it the shape is another one, too
KEY = "frequencies_Hz"  # of a blade


def with_frequencies(rom: Rom, given: Mapping[int, float]) -> Rom:
    """The model with frequencies at rest, Hz, ``given`` by mode, from 1.

    Raises
    ------
    RomError
        For a mode that it has not, and a frequency off by more than ``MOST``.
    """
    if not given:
        return rom
    Hz, modes = rom.modes(0.0)[0] / (2 * np.pi), sorted(given)
    require(
        *(
            (
                mode <= rom.n and abs(given[mode] / Hz[mode - 1] - 1) <= MOST,
                Fault(
                    f"mode {mode} of the clamped blade has {Hz[mode - 1]:.6g} Hz: allowed within "
                    f"{100 * MOST:g} %; beyond, its shape is another one, too: model the root"
                    if mode <= rom.n
                    else f"the model has {rom.n} modes",
                    f"{KEY}.{mode}",
                    given[mode],
                    ((1 - MOST) * Hz[mode - 1], (1 + MOST) * Hz[mode - 1])
                    if mode <= rom.n
                    else {"le": rom.n},
                ),
            )
            for mode in modes
        ),
        kind=RomError,
    )
    rows = np.array([[mode, Hz[mode - 1], given[mode]] for mode in modes])
    settings = rom.provenance.settings | given_frequencies(dict(given))
    return replace(
        _changed(rom, rows[:, 1], rows[:, 2]),
        measured=rows,
        provenance=replace(rom.provenance, settings=settings),
    )


def as_clamped(rom: Rom) -> Rom:
    """The model without frequencies given: that of the clamped blade."""
    if not rom.measured.size:
        return rom
    _, clamped, given = rom.measured.T
    return replace(_changed(rom, given, clamped), measured=np.empty((0, 3)))


def _changed(rom: Rom, before: NDArray[np.float64], after: NDArray[np.float64]) -> Rom:
    """The model whose frequencies at rest ``before`` (k,), Hz, are those ``after``."""
    omega, Phi = rom.modes(0.0)
    modes = np.abs(omega[:, None] / (2 * np.pi) - before).argmin(axis=0)
    of_given = rom.M @ Phi[:, modes]
    more = of_given * ((2 * np.pi * after) ** 2 - omega[modes] ** 2) @ of_given.T
    K = np.concatenate([rom.K[:1] + (more + more.T) / 2, rom.K[1:]])
    f1 = np.delete(omega / (2 * np.pi), modes)
    return replace(rom, K=K, f1=float(min(*f1, *after)))


def told(rom: Rom) -> Iterator[str]:
    """The frequencies given, and by how much they differ from those of the clamped blade."""
    for mode, clamped, given in rom.measured:
        yield (
            f"f{mode:.0f} at rest is {given:.6g} Hz, as given: "
            f"{100 * (given / clamped - 1):+.2g} % from the {clamped:.6g} Hz of the clamped blade"
        )
