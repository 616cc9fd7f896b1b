"""A stiff block is pushed to and fro: it sticks, slips, stops, sticks and slips back (case stick_slip.toml).

The push rises to twice the friction and falls again. A rigid block sticks until the push is the friction, slides with m a = P - F, and
stops when its velocity is zero: here all of it symmetric, with steps of time so small that they do not matter.
"""

import numpy as np

from pack import compare, mean, numbers, run

GRAVITY, DENSITY, HEIGHT, FRICTION = 9.81, 1000.0, 0.05, 0.3
TIMES = [0.0, 0.1, 0.3, 0.5, 0.7, 0.9]
PUSH = [0.0, 5886.0, -5886.0, 5886.0, -5886.0, 5886.0]  # N/m3


def rigid(steps: int = 90_000) -> tuple[np.ndarray, np.ndarray]:
    """Give times and positions of the rigid block: Coulomb's law step by step."""
    dt, limit = TIMES[-1] / steps, FRICTION * DENSITY * GRAVITY
    position, velocity, positions = 0.0, 0.0, [0.0]
    for push in np.interp((np.arange(steps) + 0.5) * dt, TIMES, PUSH):
        way = np.sign(velocity) if velocity else np.sign(push) * (abs(push) > limit)
        after = velocity + way * (push * way - limit) / DENSITY * dt
        after = 0.0 if after * velocity < 0 else after  # it stops before it turns
        position += (velocity + after) / 2 * dt
        velocity = after
        positions.append(position)
    return np.arange(steps + 1) * dt, np.array(positions)


def main() -> None:
    """Compare four stiffnesses."""
    time, exact = rigid()
    errors = []
    for young in (3.2e6, 1.28e7, 5.12e7, 2.048e8):
        y = np.array([0.0, 0.0, HEIGHT, HEIGHT])
        start = np.stack([0 * y, -DENSITY * GRAVITY / young * y * (HEIGHT - y / 2)], axis=1)
        history = run("stick_slip", young=young, displacement=numbers(start))
        apart = mean(history, history.displacement)[:, 0] - np.interp(history.time, time, exact)
        errors.append(float(np.abs(apart).max() / np.abs(exact).max()))
    compare("largest error over the largest distance", 0.0, errors)


if __name__ == "__main__":
    main()
