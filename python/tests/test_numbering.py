"""A shuffled mesh: all arrays have its numbers, although the solver has an order of its own."""

from pathlib import Path

import numpy as np
import percute as pc
from numpy.typing import NDArray

Shuffle = tuple[NDArray[np.int64], NDArray[np.int64]]


def block(mesh: pc.Mesh) -> pc.Problem:
    return pc.Problem(
        mesh,
        material=pc.Elastic(young=70e9, poisson=0.3, density=2700.0, plane="stress"),
        obstacles=[pc.Plane(point=(0, -1e-4), normal=(0, 1), friction=0.2)],
        initial_velocity=(400, -400),
    )


def shuffled(mesh: pc.Mesh) -> tuple[pc.Mesh, Shuffle]:
    """The mesh in random order, and the new numbers of its nodes and elements."""
    random = np.random.default_rng(4)
    node, element = (
        random.permutation(len(mesh.points)),
        random.permutation(len(mesh.cells)),
    )
    points, cells = np.empty_like(mesh.points), np.empty_like(mesh.cells)
    points[node], cells[element] = mesh.points, node[mesh.cells]
    return pc.Mesh(points, cells), (node, element)


def test_arrays_have_the_numbers_of_the_mesh(tmp_path: Path) -> None:
    # 1147 nodes: with up to 256, a mesh is solved in its own order.
    mesh = pc.Mesh.rectangle(0.05, 0.04, nx=36, ny=30)
    other, (node, element) = shuffled(mesh)
    straight, mixed = (pc.simulate(block(m), end=1.5e-6, courant=0.9) for m in (mesh, other))

    def same(one: NDArray[np.float64], two: NDArray[np.float64], tolerance: float = 1e-12) -> None:
        assert np.abs(one - two).max() <= tolerance * np.abs(one).max()

    same(straight.displacement, mixed.displacement[:, node])
    # Accelerations are small differences of large stresses: they lose two digits.
    same(straight.velocity, mixed.velocity[:, node], 1e-10)
    same(straight.acceleration, mixed.acceleration[:, node], 1e-10)
    assert straight.touching.any()
    assert {*mixed.contact.nodes} == {*node[straight.contact.nodes]}
    one, two = (pc.estimate(history, instants=2, fields=True) for history in (straight, mixed))
    same(one.by_element, two.by_element[element])
    assert element[one.worst_elements(1)[0].element] == two.worst_elements(1)[0].element

    stored = pc.simulate(block(other), end=1.5e-6, courant=0.9, store=tmp_path / "mixed.vtkhdf")
    for name in ("displacement", "reaction", "touching", "velocity", "acceleration"):
        np.testing.assert_array_equal(getattr(stored, name), getattr(mixed, name))
    np.testing.assert_array_equal(stored.balance.kinetic, mixed.balance.kinetic)
    np.testing.assert_array_equal(pc.estimate(stored).by_element, two.by_element)
