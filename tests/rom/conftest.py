import numpy as np
import pytest
from scipy.sparse import csr_matrix

from fem.matrices import Matrices
from geometry.base import Provenance
from rom.reconstruct import Basis


@pytest.fixture(scope="session")
def check_matrices(coarse_blade, coarse_mesh) -> Matrices:
    """Assemble the full coarse blade at 17 speeds, more than a check needs."""
    from fem.assemble import assemble

    speeds = np.linspace(0, coarse_blade.top_speed, 17)
    return assemble(coarse_blade, "coarse", coarse_mesh.mesh, speeds)


@pytest.fixture(scope="session")
def coarse_basis(coarse_matrices, coarse_reduced) -> Basis:
    """Return what makes fields of the coarse blade of reduced coordinates."""
    rom, T = coarse_reduced
    return Basis.of(coarse_matrices, T, rom.provenance)


class Small:
    """Two interface points, 20 DoFs, K(Omega) = K0 + Omega^2 K1 + Omega^4 K2, all dense."""

    Omega_m = 3.0

    def __init__(self) -> None:
        rng = np.random.default_rng(7)

        def symmetric(scale):
            A = rng.normal(size=(20, 20))
            return scale * (A + A.T) / 2

        X = rng.normal(size=(20, 20))
        self.M = np.eye(20) + symmetric(0.05)
        self.coefficients = [X @ X.T + 20 * np.eye(20), symmetric(0.3), symmetric(0.03)]

    def K(self, Omega):
        return sum(Omega**p * K for p, K in zip((0, 2, 4), self.coefficients, strict=True))

    def matrices(self, speeds) -> Matrices:
        return Matrices(
            M=csr_matrix(self.M),
            K=tuple(csr_matrix(self.K(speed)) for speed in speeds),
            weights=np.eye(len(speeds)),
            speeds=np.asarray(speeds, dtype=float),
            u_static=np.zeros((len(speeds), 20)),
            residuals=np.zeros(len(speeds)),
            coordinates=np.zeros((7, 3)),
            S=csr_matrix(np.eye(20)[[9, 10, 11, 3, 4, 5]]),
            xi=np.array([0.25, 0.75]),
            points=np.array([[0.5, 0.2, 0.0], [0.5, 0.1, 0.1]]),
            camber=np.array([[0.5, 0.2, -0.1], [0.5, 0.1, 0.2]]),
            sides=np.empty((2, 0)),
            span=0.4,
            provenance=Provenance("small", "5ead", {}, "c0de"),
        )


@pytest.fixture(scope="session")
def small() -> Small:
    return Small()
