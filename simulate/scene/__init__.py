"""What a user writes: scenes, their tables and designs, the laws of the liner."""

from simulate.scene.scene import (
    BESIDE,
    LEADING,
    OVER_F1,
    RAD_S,
    STRIPS,
    TRAILING,
    CentralDifference,
    Clearance,
    Contact,
    Harmonic,
    History,
    Liner,
    Peaks,
    PiecewiseExact,
    Profile,
    Record,
    Scene,
    Speeds,
    fault_of_blade,
)
