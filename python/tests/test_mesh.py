"""Meshes compare by their contents, and the package names what is public."""

import pickle
from typing import Any

import numpy as np
import percute as pc
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st


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


def enclosed(mesh: pc.Mesh, line: Any) -> float:
    """Give the area that a closed line of nodes encloses (m²), positive if it goes counterclockwise."""
    x, y = mesh.points[line].T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_sizes_and_areas_of_elements() -> None:
    mesh = pc.Mesh.rectangle(3.0, 2.0, nx=6, ny=2, diagonals="alternating").refine(where=np.arange(24) < 5)
    corners = mesh.points[mesh.cells]
    areas = 0.5 * np.linalg.det(corners[:, 1:] - corners[:, :1])
    assert mesh.areas.shape == mesh.sizes.shape == (len(mesh.cells),) and len(mesh.cells) > 24
    # Rounding of one determinant.
    assert np.allclose(mesh.areas, areas, rtol=1e-14) and np.array_equal(mesh.sizes, np.sqrt(mesh.areas))
    bar = pc.Mesh([0.0, 0.25, 1.0], [[0, 1], [1, 2]])
    assert bar.sizes.tolist() == bar.areas.tolist() == [0.25, 0.75] and bar.outline == ()
    for array in (mesh.areas, mesh.sizes, *mesh.outline):
        assert not array.flags.writeable


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10**6), st.integers(2, 5), st.floats(0.0, 360.0))
def test_outlines_enclose_the_body_without_its_holes(seed: int, cells: int, degrees: float) -> None:
    """The lines consist of the edges that one element has, and enclose the sum of the areas."""
    whole = pc.Mesh.rectangle(3.0, 2.0, nx=3 * cells, ny=2 * cells)
    # Two rectangular holes, at least a row or column of cells apart from each other and from the sides.
    column, row = (np.floor(whole.points[whole.cells].mean(axis=1) * cells)).astype(int).T
    random, most = np.random.default_rng(seed), (3 * cells - 3) // 2
    widths, heights = random.integers(1, most + 1, 2), random.integers(1, 2 * cells - 1, 2)
    starts = 1, 3 * cells - 1 - widths[1]
    holes = [(column >= x) & (column < x + w) & (row >= 1) & (row < 1 + h) for x, w, h in zip(starts, widths, heights, strict=True)]
    cells_left = whole.cells[~(holes[0] | holes[1])]
    nodes, numbers = np.unique(cells_left, return_inverse=True)
    mesh = pc.Mesh(whole.points[nodes], numbers.reshape(-1, 3)).rotated(degrees)
    areas = [enclosed(mesh, line) for line in mesh.outline]
    # The outline of the rectangle counterclockwise, holes clockwise; rounding of sums of some 100 terms.
    assert sum(areas) == pytest.approx(mesh.areas.sum(), rel=1e-12)
    assert len(areas) == 3 and sum(area > 0 for area in areas) == 1
    sides = np.sort(mesh.cells.astype(int)[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    edges, count = np.unique(sides, axis=0, return_counts=True)
    lines = np.vstack([np.column_stack([line, np.roll(line, -1)]) for line in mesh.outline])
    assert np.array_equal(np.unique(np.sort(lines, axis=1), axis=0), edges[count == 1])
    assert all(line[0] == line.min() for line in mesh.outline)


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
