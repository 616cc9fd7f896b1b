"""A bar strikes a wall (case bar_impact.toml).

The wall stops the bar's end; a wave of compression N = -rho S c v runs through the bar at c = sqrt(E/rho), is reflected at
the free end, and when it is back after 2L/c the bar leaves with the velocity that it came with. The simulation smears
the front over a width of h^(2/3): what waits for it converges at that order, the force between the fronts faster.
"""

from pack import bar, compare, mean, run

YOUNG, DENSITY, SECTION, LENGTH, SPEED, GAP = 70e9, 2700.0, 0.02, 0.1, 400.0, 2e-4


def main() -> None:
    """Compare four meshes."""
    c = (YOUNG / DENSITY) ** 0.5
    impact, contact, force = GAP / SPEED, 2 * LENGTH / c, DENSITY * SECTION * c * SPEED
    rebound, duration, plateau = [], [], []
    for elements in (50, 100, 200, 400):
        history = run("bar_impact", bar=bar(LENGTH, elements))
        time, reaction = history.time, history.contact.normal_force[:, 0]
        middle = (time > impact + contact / 4) & (time < impact + 3 * contact / 4)
        rebound.append(mean(history, history.velocity)[-1, 0])
        duration.append((reaction > 0).sum() * time[1])
        plateau.append(reaction[middle].mean())
    compare("velocity of the rebound", SPEED, rebound, "m/s")
    compare("duration of contact, 2L/c", contact, duration, "s")
    compare("contact force, rho S c v", force, plateau, "N")


if __name__ == "__main__":
    main()
