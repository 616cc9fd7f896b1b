"""A clamped bar is pulled by a traction that grows linearly in time (case bar_ramp.toml).

The modal series, with k = (n - 1/2) pi/L and w = kc, is u = r t x/E - sum of 2r (-1)^(n+1)/(rho L w^3) sin(kx) sin(wt). It falls
like n^-3: a thousand modes leave 1e-7 of it.
"""

import numpy as np

from pack import bar, compare, run

LENGTH, YOUNG, DENSITY, RATE = 0.1, 70e9, 2700.0, 1e12
C = (YOUNG / DENSITY) ** 0.5


def series(x: np.ndarray, time: float, modes: int = 5000) -> np.ndarray:
    """Give the displacements (m)."""
    n = np.arange(1, modes + 1)
    k = (n - 0.5) * np.pi / LENGTH
    factor = 2 * RATE * (-1.0) ** (n + 1) / (DENSITY * LENGTH * (k * C) ** 3)
    return RATE * time * x / YOUNG - np.sin(np.outer(x, k)) @ (factor * np.sin(k * C * time))


def main() -> None:
    """Compare four meshes."""
    end, errors = [], []
    for elements in (25, 50, 100, 200):
        history = run("bar_ramp", bar=bar(LENGTH, elements))
        exact = series(np.linspace(0, LENGTH, elements + 1), history.time[-1])
        end.append(float(history.displacement[-1, -1, 0]))
        errors.append(float(np.sqrt(np.mean((history.displacement[-1, :, 0] - exact) ** 2)) / exact[-1]))
    compare("displacement of the pulled end", float(exact[-1]), end, "m")
    compare("root mean square error over the largest", 0.0, errors)


if __name__ == "__main__":
    main()
