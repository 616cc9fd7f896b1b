"""A block between rollers swings in a standing pressure wave (case block_mode.toml).

u = A (kx sin(kx x) cos(ky y), ky cos(kx x) sin(ky y))/k cos(wt) with kx = pi/a, ky = pi/b, w = k sqrt((lambda + 2G)/rho): the gradient
of a function, so that Navier's equation becomes a wave equation. Triangles and central differences are of order 2.
"""

import numpy as np

from pack import compare, numbers, rectangle, run

YOUNG, POISSON, DENSITY, AMPLITUDE = 70e9, 0.3, 2700.0, 1e-5
A, B = 0.05, 0.04
KX, KY = np.pi / A, np.pi / B
K = float(np.hypot(KX, KY))
OMEGA = K * (YOUNG / (1 - POISSON**2) / DENSITY) ** 0.5  # lambda + 2G of plane stress


def shape(points: np.ndarray) -> np.ndarray:
    """Give the displacements at the start (m), with exact zeros at the rollers."""
    x, y = points.T
    u = AMPLITUDE / K * np.stack([KX * np.sin(KX * x) * np.cos(KY * y), KY * np.cos(KX * x) * np.sin(KY * y)], axis=1)
    u[(x == 0) | (x == A), 0] = 0
    u[(y == 0) | (y == B), 1] = 0
    return u


def main() -> None:
    """Compare three meshes."""
    errors = []
    for nx in (10, 20, 40):
        ny = nx * 4 // 5
        x, y = np.meshgrid(A * np.arange(nx + 1) / nx, B * np.arange(ny + 1) / ny)
        start = shape(np.stack([x.ravel(), y.ravel()], axis=1))
        history = run("block_mode", rectangle=rectangle(A, B, nx, ny), displacement=numbers(start))
        mass = history.problem.mass
        apart = history.displacement[-1] - shape(history.problem.mesh.points) * np.cos(OMEGA * history.time[-1])
        errors.append(float((mass @ (apart**2).sum(axis=1) / mass.sum()) ** 0.5 / AMPLITUDE))
    compare("root mean square error over the amplitude", 0.0, errors)


if __name__ == "__main__":
    main()
