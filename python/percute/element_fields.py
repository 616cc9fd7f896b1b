"""Fields of the elements of a history, and probes at points and groups over time."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.arrays import integers, numbers
from percute.checks import LARGEST, flag, one_of, text, whole, wrong
from percute.errors import InputError
from percute.mesh import Mesh
from percute.mesh_arrays import boundary
from percute.problem import Problem
from percute.steps import Steps
from percute.words import counted

Floats = NDArray[np.float64]
Step = int | slice | ArrayLike

NODAL = ("displacement", "velocity", "acceleration")
ELASTIC = ("strain", "stress", "von_mises", "pressure", "strain_energy", "kinetic_energy")
PLASTIC = ("plastic_strain", "equivalent_plastic_strain", "plastic_work")
"""Of materials that yield."""
OF_ELEMENTS = ELASTIC + PLASTIC
MEANS = ELASTIC[:4] + PLASTIC[:2]
"""Quantities of elements of which a mean is meant: energies are sums."""
AT_ONCE = 1_000_000
"""Elements times instants that are computed at once for a group."""
OUTSIDE = 1e-9
"""Points may lie outside the body by this part of its size: rounding of coordinates."""


def instant(history: Steps, step: object) -> int:
    """Check the number of an instant; negative ones count from the end."""
    count = len(history)
    if not -count <= (given := whole("step", step, least=-LARGEST)) < count:
        raise wrong("step", step, f"from {-count} to {count - 1}: the history holds {counted(count, 'instant')}")
    return given % count


def rows(history: Steps, step: Step) -> tuple[NDArray[np.intp], bool]:
    """Give the numbers of the instants of an argument ``step``, and whether it is one instant only."""
    count = len(history)
    if isinstance(step, slice):
        try:
            return np.arange(count)[step], False
        except (TypeError, ValueError):
            raise wrong("step", step, "a whole number, a slice or an array of whole numbers") from None
    if isinstance(step, list | tuple) or (isinstance(step, np.ndarray) and step.ndim > 0):
        given = integers("step", step, None)
        if np.any((given < -count) | (given >= count)):
            raise wrong("step", step, f"from {-count} to {count - 1}: the history holds {counted(count, 'instant')}")
        return given % count, False
    return np.array([instant(history, step)]), True


def element_field(history: Steps, quantity: str, step: Step) -> Floats:
    """Give a quantity of all elements at one instant, or at several along the first axis."""
    chosen, one = rows(history, step)
    motion = history.velocity[chosen] if quantity == "kinetic_energy" else history._displacement_at(chosen)
    values = _percute.element_field(history.problem._data, quantity, np.ascontiguousarray(motion), internal(history, chosen))
    return values[0] if one else values


def internal(history: Steps, chosen: NDArray[np.intp]) -> Floats | None:
    """Give the internal variables at these instants, (instants, elements, variables); None where no material yields."""
    return history._data.internal(chosen.tolist()) if history._data.variables else None


class Place(NamedTuple):
    """Where a quantity is read: nodes or elements, and their weights in a mean."""

    rows: NDArray[np.int64]
    weights: Floats


def probe(history: Steps, where: object, quantity: object, each: object) -> Floats:
    """Read a quantity at a point or a group, at all instants."""
    name = one_of("quantity", quantity, (*NODAL, *MEANS))
    mesh, apart = history.problem.mesh, flag("each", each)
    nodal = name in NODAL
    if isinstance(where, str):
        place = _group(mesh, text("where", where), nodal)
    elif apart:
        raise InputError("`each` needs a group; `where` is a point")
    else:
        place = _point(mesh, where, nodal)
    if nodal:
        values: Floats = getattr(history, name)[:, place.rows]
    else:
        values = _of_elements(history, name, place.rows)
    return values if apart else np.tensordot(values, place.weights, (1, 0))


def _of_elements(history: Steps, quantity: str, elements: NDArray[np.int64]) -> Floats:
    """Read a quantity of some elements at all instants."""
    if len(elements) == 1:
        problem, nodes = _alone(history.problem, int(elements[0]))
        variables = internal(history, np.arange(len(history)))
        own = None if variables is None else np.ascontiguousarray(variables[:, elements])
        return _percute.element_field(problem._data, quantity, np.ascontiguousarray(history.displacement[:, nodes]), own)
    # The quantity of all elements at some instants at once, so that memory stays small.
    count = max(AT_ONCE // len(history.problem.mesh.cells), 1)
    parts = [slice(start, start + count) for start in range(0, len(history), count)]
    return np.concatenate([element_field(history, quantity, part)[:, elements] for part in parts])


def _alone(problem: Problem, element: int) -> tuple[Problem, NDArray[np.int64]]:
    """Give an element as a problem of its own, and its nodes."""
    mesh, material = problem.mesh, problem.material
    nodes = mesh.cells[element].astype(np.int64)
    if isinstance(material, dict):
        material = next(law for name, law in material.items() if element in mesh.element_groups[name])
    return Problem(Mesh(mesh.points[nodes], [list(range(len(nodes)))]), material=material), nodes


def _point(mesh: Mesh, where: object, nodal: bool) -> Place:
    """Find the element with a point: its nodes with their shape functions there, or the element itself."""
    point = np.atleast_1d(numbers("where", where, most=1, finite=True))
    if point.shape != (mesh.dimension,):
        needed = ("one coordinate (m)", "two coordinates (m)", "three coordinates (m)")[mesh.dimension - 1]
        raise wrong("where", where, f"a point of {needed}, or the name of a group: {_names(mesh)}")
    corners = mesh.points[mesh.cells]
    edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    inner = np.linalg.solve(edges, (point - corners[:, 0])[..., None])[..., 0]
    shapes = np.column_stack([1.0 - inner.sum(axis=1), inner])
    element = int(np.argmax(shapes.min(axis=1)))
    if shapes[element].min() < 0.0:
        element, point = _nearest(mesh, point, where)
        inside = np.linalg.solve(edges[element], point - corners[element, 0])
        shapes[element] = np.append(1.0 - inside.sum(), inside)
    if nodal:
        return Place(mesh.cells[element].astype(np.int64), shapes[element])
    return Place(np.array([element]), np.ones(1))


def _nearest(mesh: Mesh, point: Floats, where: object) -> tuple[int, Floats]:
    """Give the nearest point of the boundary, and its element; a point farther away than rounding is an error."""
    edges, owners = boundary(mesh.cells)
    corners = mesh.points[edges]
    if mesh.dimension == 3:
        feet = _feet_in_triangles(corners, point)
    else:
        start, along = corners[:, 0], corners[:, -1] - corners[:, 0]
        squares = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)
        part = np.clip(((point - start) * along).sum(axis=1) / squares, 0.0, 1.0)
        feet = start + part[:, None] * along
    distances = np.linalg.norm(feet - point, axis=1)
    nearest = int(np.argmin(distances))
    if distances[nearest] > OUTSIDE * mesh.size:
        told = ", ".join(f"{x:.6g}" for x in feet[nearest])
        raise InputError(
            f"`where` is {tuple(point.tolist())}, {distances[nearest]:.3g} m outside the undeformed body; its nearest point is ({told}) m"
        )
    return int(owners[nearest]), feet[nearest]


def _feet_in_triangles(corners: Floats, point: Floats) -> Floats:
    """Give a point of each triangle near a point: the foot of the perpendicular, drawn into the triangle where it is outside."""
    sides = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    gram = np.swapaxes(sides, 1, 2) @ sides
    inner = np.linalg.solve(gram, np.swapaxes(sides, 1, 2) @ (point - corners[:, 0])[..., None])[..., 0]
    shapes = np.clip(np.column_stack([1.0 - inner.sum(axis=1), inner]), 0.0, None)
    feet: Floats = np.einsum("ij,ijk->ik", shapes / shapes.sum(axis=1, keepdims=True), corners)
    return feet


def _names(mesh: Mesh) -> str:
    return ", ".join(repr(name) for name in [*mesh.edge_groups, *mesh.element_groups]) or "the mesh has none"


def _group(mesh: Mesh, name: str, nodal: bool) -> Place:
    """Give the nodes or the elements of a group, with weights of the mean over its edges or its elements."""
    if name in mesh.edge_groups:
        edges = mesh.edge_groups[name]
        lengths = _sizes(mesh.points[edges])
        if nodal:
            return _weighted(edges, lengths)
        outer, owners = boundary(mesh.cells)
        of = {tuple(sorted(edge)): owner for edge, owner in zip(outer.tolist(), owners.tolist(), strict=True)}
        return _weighted(np.array([[of[tuple(sorted(edge))]] for edge in edges.tolist()]), lengths)
    if name in mesh.element_groups:
        elements = mesh.element_groups[name]
        corners = mesh.points[mesh.cells[elements]]
        sizes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
        return _weighted(mesh.cells[elements] if nodal else elements[:, None], sizes)
    raise InputError(f"`where` is {name!r}; it must be a point or the name of a group: {_names(mesh)}")


def _sizes(corners: Floats) -> Floats:
    """Give lengths of edges or areas of faces, and 1 for ends of bars."""
    sides = corners[:, 1:] - corners[:, :1]
    if corners.shape[2] == 3:
        sides = np.cross(sides[:, 0], sides[:, 1])[:, None]
    sizes: Floats = np.ones(len(corners)) if corners.shape[2] == 1 else np.linalg.norm(sides[:, 0], axis=1)
    return sizes


def _weighted(members: NDArray[Any], sizes: Floats) -> Place:
    """Share the sizes of edges or elements equally among their members: the mean of a linear field."""
    found, places = np.unique(members.astype(np.int64), return_inverse=True)
    weights = np.bincount(places.ravel(), np.repeat(sizes, members.shape[1]), len(found))
    return Place(found, weights / weights.sum())
