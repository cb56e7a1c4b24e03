"""The full model of matrices made elsewhere: its modes and its compliance."""

from fem.matrices import Matrices
from rom.full_model import solve as solve_at


def solve(matrices: Matrices, full: str) -> None:
    """Modes and compliance at the speeds of the matrices."""
    solved = solve_at(matrices, matrices.states())
    print(f"largest residual of a mode: {solved.residuals.max():.1e}")
    solved.save(full)
