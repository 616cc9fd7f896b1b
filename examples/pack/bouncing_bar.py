"""A bar bounces on the ground for ever (case bouncing_bar.toml), after Doyen, Ern and Piperno (2011).

It falls for 1 s and strikes at v = 10 m/s. The ground sends F(t) = v t + g t^2/2 into the bar, which the free end sends back:
w = -F(t) + F(t - x/c) + F(t - (2L - x)/c). After 2L/c = 2/3 s the bar leaves, pressed like one that stands under twice its
weight; it swings with the period 2L/c while it flies for 2v/g = 2 s, three whole periods, lands as it left, and so the next
bounce is the first one backwards: it rises undeformed to 5 m. All repeats after 16/3 s.
"""

import numpy as np

from pack import bar, compare, mean, run

LENGTH, YOUNG, DENSITY, GRAVITY, HEIGHT = 10.0, 900.0, 1.0, 10.0, 5.0
C, V = (YOUNG / DENSITY) ** 0.5, (2 * GRAVITY * HEIGHT) ** 0.5
FALL, CONTACT = V / GRAVITY, 2 * LENGTH / C
PERIOD = 2 * CONTACT + 4 * FALL


def gap(time: np.ndarray) -> np.ndarray:
    """Give the exact gap of the lower end (m)."""
    middle = CONTACT + 2 * FALL
    phase = time % PERIOD
    since = np.where(phase > middle, 2 * middle - phase, phase) - FALL  # from the impact; all is even about the middle
    flight = np.maximum(since - CONTACT, 0.0)
    swing = flight % CONTACT
    leaves = V * flight - GRAVITY * flight**2 / 2 - GRAVITY * swing * (CONTACT - swing)
    falls = -V * since - GRAVITY * since**2 / 2
    return np.where(since < 0, falls, np.where(since < CONTACT, 0.0, leaves))


def main() -> None:
    """Compare three meshes."""
    second, height, apart = [], [], []
    for elements in (50, 100, 200):
        history = run("bouncing_bar", bar=bar(LENGTH, elements))
        time, reaction = history.time, history.contact.normal_force[:, 0]
        second.append(time[(reaction > 0) & (time > FALL + CONTACT + FALL)][0] + time[1] / 2)
        height.append(float(np.interp(PERIOD, time, mean(history, history.displacement)[:, 0])) + HEIGHT)
        apart.append(float(np.abs(history.displacement[:, 0, 0] + HEIGHT - gap(time))[time <= PERIOD].max()))
    compare("second impact", FALL + CONTACT + 2 * FALL, second, "s")
    compare("height after a period", HEIGHT, height, "m")
    compare("largest error of the gap, first period", 0.0, apart, "m")


if __name__ == "__main__":
    main()
