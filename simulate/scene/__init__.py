"""Input of a user: scenes, their tables and designs, the laws of the liner."""

from simulate.scene.casing import (
    LEADING,
    TRAILING,
    Casing,
    Clearance,
    Gaps,
    Harmonic,
    side_bands,
)
from simulate.scene.liner import STRIPS, Contact, Liner, Profile
from simulate.scene.record import (
    DYING_OUT,
    GROWING,
    STEADY,
    TOO_SHORT,
    TRENDS,
    History,
    Peaks,
    Record,
)
from simulate.scene.scene import (
    OF_LAST_ROUNDS,
    CentralDifference,
    PiecewiseExact,
    Scene,
    fault_of_blade,
)
from simulate.scene.speeds import OF_RPM, OVER_F1, Speeds
from simulate.scene.stage import Stage
from simulate.scene.verify import EVERY, PEAKS

__all__ = [
    "DYING_OUT",
    "EVERY",
    "GROWING",
    "LEADING",
    "OF_LAST_ROUNDS",
    "OF_RPM",
    "OVER_F1",
    "PEAKS",
    "STEADY",
    "STRIPS",
    "TOO_SHORT",
    "TRAILING",
    "TRENDS",
    "Casing",
    "CentralDifference",
    "Clearance",
    "Contact",
    "Gaps",
    "Harmonic",
    "History",
    "Liner",
    "Peaks",
    "PiecewiseExact",
    "Profile",
    "Record",
    "Scene",
    "Speeds",
    "Stage",
    "fault_of_blade",
    "side_bands",
]
