"""One run: modes, set-up, schemes, status."""

from simulate.marching.course import Outcome
from simulate.marching.ends import AnyEnd, EndOfStage, FinalState, Worn
from simulate.marching.refusals import check_scene
from simulate.marching.run import make_kernel, march
from simulate.marching.setup import (
    SceneError,
    Setup,
    edge_slope,
    least_gap,
    prepare,
    strip_stiffness,
)
from simulate.marching.states import largest_state
from simulate.marching.status import (
    SENSITIVE_FROM,
    STATED,
    STATUSES,
    TO_THE_END,
    WITH_RESULT,
    Facts,
)
