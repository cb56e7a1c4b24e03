"""What a user writes: scenes, their tables and designs, the laws of the liner."""

from simulate.scene.scene import (
    BESIDE as BESIDE,
)
from simulate.scene.scene import (
    LEADING as LEADING,
)
from simulate.scene.scene import (
    OVER_F1 as OVER_F1,
)
from simulate.scene.scene import (
    RAD_S as RAD_S,
)
from simulate.scene.scene import (
    STRIPS as STRIPS,
)
from simulate.scene.scene import (
    TRAILING as TRAILING,
)
from simulate.scene.scene import (
    CentralDifference as CentralDifference,
)
from simulate.scene.scene import (
    Clearance as Clearance,
)
from simulate.scene.scene import (
    Contact as Contact,
)
from simulate.scene.scene import (
    Harmonic as Harmonic,
)
from simulate.scene.scene import (
    History as History,
)
from simulate.scene.scene import (
    Liner as Liner,
)
from simulate.scene.scene import (
    Peaks as Peaks,
)
from simulate.scene.scene import (
    PiecewiseExact as PiecewiseExact,
)
from simulate.scene.scene import (
    Profile as Profile,
)
from simulate.scene.scene import (
    Record as Record,
)
from simulate.scene.scene import (
    Scene as Scene,
)
from simulate.scene.scene import (
    Speeds as Speeds,
)
from simulate.scene.scene import (
    fault_of_blade as fault_of_blade,
)
