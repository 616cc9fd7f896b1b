"""A steel bar creeps against a wall (case steel_bar.toml).

The same three phases as in bar_impact.py with figures that are known from the literature: impact after 5e-4 s, contact for
2L/c = 3.8545e-4 s, and a force of rho S c v = 1270.8 N.
"""

from pack import bar, compare, run

YOUNG, DENSITY, SECTION, LENGTH, SPEED, GAP = 210e9, 7800.0, 3.14e-4, 1.0, 0.1, 5e-5


def main() -> None:
    """Compare four meshes."""
    c = (YOUNG / DENSITY) ** 0.5
    impact, contact = GAP / SPEED, 2 * LENGTH / c
    first, duration, plateau = [], [], []
    for elements in (50, 100, 200, 400):
        history = run("steel_bar", bar=bar(LENGTH, elements))
        time, reaction = history.time, history.contact.normal_force[:, 0]
        middle = (time > impact + contact / 4) & (time < impact + 3 * contact / 4)
        # The first force brings the end to the wall within its step.
        first.append(time[reaction > 0][0] + time[1] / 2)
        duration.append((reaction > 0).sum() * time[1])
        plateau.append(reaction[middle].mean())
    compare("impact (known to half a step)", impact, first, "s")
    compare("duration of contact, 2L/c", contact, duration, "s")
    compare("contact force, rho S c v", DENSITY * SECTION * c * SPEED, plateau, "N")


if __name__ == "__main__":
    main()
