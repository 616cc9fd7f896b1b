"""Meshes compare by their contents, and the package names what is public."""

import pickle

import numpy as np
import percute as pc
import pytest


def triangle(**changed: object) -> pc.Mesh:
    right: dict[str, object] = {"points": [[0, 0], [1, 0], [0, 1]], "cells": [[0, 1, 2]]}
    right |= {"edge_groups": {"bottom": [[0, 1]]}, "element_groups": {"all": [0]}}
    return pc.Mesh(**(right | changed))  # type: ignore[arg-type]


def test_meshes_with_the_same_contents_are_equal() -> None:
    mesh = triangle()
    assert mesh == triangle() == pickle.loads(pickle.dumps(mesh)) and hash(mesh) == hash(triangle())
    # Another number, sign of zero apart, is another mesh.
    assert mesh == triangle(points=[[0, 0], [1, -0.0], [0, 1]]) and hash(mesh) == hash(triangle(points=[[0, 0], [1, -0.0], [0, 1]]))
    assert len({mesh, triangle(), mesh.refine(0), mesh.refine()}) == 2


def elements(mesh: pc.Mesh, mirrored: bool = False) -> set[frozenset[tuple[float, float]]]:
    """The elements by the places of their nodes, of the mesh or of its mirror image at x = 1.5."""
    points = [(3.0 - x if mirrored else x, y) for x, y in mesh.points.tolist()]
    return {frozenset(points[node] for node in cell) for cell in mesh.cells.tolist()}


def test_diagonals_of_a_rectangle_are_symmetric() -> None:
    base = pc.Mesh.rectangle(3.0, 2.0, nx=4, ny=2)
    assert pc.Mesh.rectangle(3.0, 2.0, nx=4, ny=2, diagonals="right") == base and elements(base) != elements(base, mirrored=True)
    for diagonals, count in (("alternating", 16), ("crossed", 32)):
        mesh = pc.Mesh.rectangle(3.0, 2.0, nx=4, ny=2, diagonals=diagonals)  # type: ignore[arg-type]
        assert len(mesh.cells) == count and elements(mesh) == elements(mesh, mirrored=True)
        corners = mesh.points[mesh.cells]
        sides = corners[:, 1:] - corners[:, :1]
        assert np.linalg.det(sides).sum() == pytest.approx(2 * 6.0, rel=1e-14) and mesh.reoriented_elements == 0
        assert {name: each.tolist() for name, each in mesh.edge_groups.items()} == {name: each.tolist() for name, each in base.edge_groups.items()}
    with pytest.raises(pc.InputError, match='`diagonals` is .left.; it must be "right", "alternating" or "crossed"'):
        pc.Mesh.rectangle(3.0, 2.0, nx=4, ny=2, diagonals="left")  # type: ignore[arg-type]
    with pytest.raises(pc.InputError, match=r"`4 \* nx \* ny` is 24000000; .* from 1 to 20 000 000"):
        pc.Mesh.rectangle(1.0, 1.0, nx=6_000_000, ny=1, diagonals="crossed")


def test_a_mesh_is_moved_and_turned() -> None:
    mesh = triangle()
    moved = mesh.moved((2.0, -1.0))
    assert moved == triangle(points=[[2, -1], [3, -1], [2, 0]]) and mesh.moved([0, 0]) == mesh
    # A quarter about (1, 2): (x, y) becomes (3 − y, 1 + x), to rounding of numbers up to 3.
    turned = mesh.rotated(90.0, about=(1, 2))
    np.testing.assert_allclose(turned.points, [[3, 1], [3, 2], [2, 1]], atol=1e-15)
    assert turned == mesh.__class__(turned.points, mesh.cells, dict(mesh.edge_groups), dict(mesh.element_groups))
    np.testing.assert_allclose(mesh.rotated(-30.0).rotated(30.0).points, mesh.points, atol=1e-15)
    assert pc.Mesh.bar(1.0, elements=2).moved(0.5).points.tolist() == [[0.5], [1.0], [1.5]]


def test_a_mesh_is_not_moved_to_nowhere() -> None:
    for call, phrase in [
        (lambda: triangle().moved(1.0), "`by` has 1 numbers; it must have two numbers, x and y"),
        (lambda: triangle().moved((1.0, np.nan)), "`by` is .*; it must be finite"),
        (lambda: pc.Mesh.bar(1.0, elements=2).moved((1.0, 2.0)), "`by` has 2 numbers; it must have one number for a bar"),
        (lambda: triangle().rotated(np.inf), "`degrees`"),
        (lambda: triangle().rotated(3.0, about=0.0), "`about` has 1 numbers"),
        (lambda: pc.Mesh.bar(1.0, elements=2).rotated(3.0), "`degrees` is 3.0; a bar cannot be turned"),
        (lambda: triangle().moved((1e20, 0.0)), r"`by` is \(1e\+20, 0.0\) m, so far from a mesh of 1.41 m that .*; give metres"),
        (lambda: triangle().rotated(3.0, about=(1e20, 0.0)), r"`about` is \(1e\+20, 0.0\) m, so far from"),
    ]:
        with pytest.raises(pc.InputError, match=phrase):
            call()


@pytest.mark.parametrize(
    "changed",
    [
        {"points": [[0, 0], [1, 0], [0, np.nextafter(1, 2)]]},
        {"cells": [[1, 2, 0]]},
        {"edge_groups": {"bottom": [[1, 2]]}},
        {"edge_groups": {"low": [[0, 1]]}},
        {"element_groups": {}},
    ],
)
def test_other_meshes_differ(changed: dict[str, object]) -> None:
    assert triangle() != triangle(**changed)
    assert triangle() != 3 and triangle() != pc.Mesh.bar(1.0, elements=2)


def test_the_package_lists_its_public_names_only() -> None:
    assert dir(pc) == sorted(pc.__all__)
