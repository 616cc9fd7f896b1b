"""A block strikes the ground and slides all the time (case oblique.toml).

Without Poisson's effect the normal motion is that of a bar: the block rebounds with the velocity that it came with, and the ground
has given it 2mv. Friction takes mu times that, whatever the motion is, since all nodes slide all the time. The block's energy falls by the
work of friction, and by what the simulation loses at impact: that of the layer of mass that is stopped, which goes with the mesh.
"""

from pack import compare, rectangle, run

SPEED, FRICTION = 10.0, 0.2


def main() -> None:
    """Compare four meshes."""
    normal, ratio, lost = [], [], []
    for nx in (10, 20, 40, 80):
        mesh = rectangle(0.05, 0.04, nx, nx * 4 // 5)
        straight = run("oblique", rectangle=mesh, velocity=[0.0, -SPEED], friction=0.0)
        normal.append(float(straight.contact.resultants.impulse[-1, 1]))
        history = run("oblique", rectangle=mesh)
        mass, balance, impulse = history.problem.mass.sum(), history.balance, history.contact.resultants.impulse[-1]
        ratio.append(float(impulse[0] / impulse[1]))
        energy = balance.kinetic + balance.strain
        lost.append(float((energy[0] - energy[-1] - balance.friction[-1]) / (mass * SPEED**2 / 2)))
    compare("normal impulse of a straight blow, 2mv", 2 * mass * SPEED, normal, "N s")
    compare("tangential over normal impulse, -mu", -FRICTION, ratio[-1:])
    compare("energy lost but for friction, relative", 0.0, lost)


if __name__ == "__main__":
    main()
