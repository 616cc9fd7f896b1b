"""A clamped rod springs back against an obstacle (case clamped_rod.toml), a benchmark of Dabaghi and others.

L = E = rho = 1, clamped at x = 1, compressed by (1 - x)/2. Released, it arrives at the obstacle after 1 s, undeformed, all of it at
-1/2 m/s. Waves stop it from both ends and send it back: it touches for 1 s with a force of 1/2, and is where it was after
3 s. The energy is 1/8; of it the simulation loses that of half an element at each impact.
"""

import numpy as np

from pack import bar, compare, numbers, run


def main() -> None:
    """Compare four meshes over two periods."""
    distance, energy, force, impulse = [], [], [], []
    for elements in (20, 40, 80, 160):
        start = (1 - np.linspace(0, 1, elements + 1)) / 2
        history = run("clamped_rod", bar=bar(1.0, elements), displacement=numbers(start))
        time, contact, balance = history.time, history.contact, history.balance
        distance.append(float(np.interp(3.0, time, history.displacement[:, 0, 0])))
        energy.append(float(balance.kinetic[-1] + balance.strain[-1]))
        force.append(float(contact.normal_force[(time > 1.25) & (time < 1.75), 0].mean()))
        impulse.append(float(contact.impulse[0, 0]))
    compare("distance of the end after a period", 0.5, distance, "m")
    compare("energy after two periods", 0.125, energy, "J")
    compare("contact force between the fronts", 0.5, force, "N")
    compare("impulse of two contacts", 1.0, impulse, "N s")


if __name__ == "__main__":
    main()
