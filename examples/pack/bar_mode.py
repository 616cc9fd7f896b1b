"""A clamped bar swings in its second mode (case bar_mode.toml).

u = A sin(kx) cos(wt) with k = 3 pi/2L and w = k sqrt(E/rho). On a uniform mesh the simulation keeps the shape and swings a
little too slowly: after a time T the lag of phase is w T (kh)^2 (1 - r^2)/24, r = 0.7 the step over the critical one: order 2.
"""

import numpy as np

from pack import bar, compare, numbers, run

LENGTH, AMPLITUDE, C = 0.1, 1e-4, (70e9 / 2700.0) ** 0.5
K = 1.5 * np.pi / LENGTH


def main() -> None:
    """Compare four meshes."""
    errors = []
    for elements in (10, 20, 40, 80):
        x = np.linspace(0, LENGTH, elements + 1)
        history = run("bar_mode", bar=bar(LENGTH, elements), displacement=numbers(AMPLITUDE * np.sin(K * x)))
        exact = AMPLITUDE * np.sin(K * x) * np.cos(K * C * history.time[-1])
        errors.append(float(np.abs(history.displacement[-1, :, 0] - exact).max() / AMPLITUDE))
    compare("largest error over the amplitude", 0.0, errors)
    step = 1.5 * np.pi / 80
    print(f"the lag of phase that theory predicts: {K * C * history.time[-1] * step**2 * (1 - 0.49) / 24:.2e}")


if __name__ == "__main__":
    main()
