"""The arrays of a mesh: nodes, elements and groups."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from percute import _percute
from percute.immutable import Immutable
from percute.words import counted

__all__ = ["MeshArrays", "boundary", "elements"]


class MeshArrays(Immutable):
    """What a `percute.Mesh` holds."""

    _data: _percute.MeshData

    @classmethod
    def _of(cls, data: _percute.MeshData) -> Self:
        mesh = cls.__new__(cls)
        mesh._data = data
        return mesh

    @property
    def dimension(self) -> int:
        """1 for bars, 2 for triangles, 3 for tetrahedra."""
        return self._data.dimension

    @cached_property
    def points(self) -> NDArray[np.float64]:
        """Coordinates of the nodes (m), shape (nodes, dimension); a read-only view."""
        return self._data.points

    @cached_property
    def cells(self) -> NDArray[np.uint32]:
        """Nodes of each element, positively oriented, shape (elements, dimension + 1); a read-only view."""
        return self._data.cells

    @cached_property
    def edge_groups(self) -> Mapping[str, NDArray[np.int64]]:
        """Named groups of boundary edges, each by its nodes: arrays (edges, dimension); of a solid those of `face_groups`."""
        return self.face_groups

    @cached_property
    def face_groups(self) -> Mapping[str, NDArray[np.int64]]:
        """Named groups of faces of the boundary, each by its nodes: arrays (faces, dimension). Faces of plane bodies are edges."""
        return MappingProxyType(self._data.edge_groups)

    @cached_property
    def element_groups(self) -> Mapping[str, NDArray[np.int64]]:
        """Named groups of elements, by number: arrays (n,)."""
        return MappingProxyType(self._data.element_groups)

    @cached_property
    def bodies(self) -> NDArray[np.int64]:
        """Number of the body of each element, from 0 in the order of their first nodes, shape (elements,)."""
        return self._data.bodies

    @cached_property
    def areas(self) -> NDArray[np.float64]:
        """Area of each triangle (m²), of a bar the length (m) and of a solid the volume (m³) of each element, shape (elements,)."""
        return self._data.areas()

    @cached_property
    def sizes(self) -> NDArray[np.float64]:
        """Size of each element (m), shape (elements,): the root of the area of a triangle, the cube root of the volume of a tetrahedron, the length of a bar."""
        if self.dimension == 1:
            return self.areas
        sizes = np.sqrt(self.areas) if self.dimension == 2 else np.cbrt(self.areas)
        sizes.flags.writeable = False
        return sizes

    @cached_property
    def outline(self) -> tuple[NDArray[np.int64], ...]:
        """The closed lines around the bodies and their holes, each by its nodes in order: arrays (n,); none of a bar or a solid.

        They go counterclockwise around a body and clockwise around a hole, each from its smallest number on.
        """
        return tuple(self._data.outline())

    @property
    def size(self) -> float:
        """Diagonal of the bounding box of the mesh (m)."""
        return self._data.size

    @property
    def reoriented_elements(self) -> int:
        """Number of elements that were given with the wrong orientation and reoriented."""
        return self._data.reoriented_elements

    def __eq__(self, other: object) -> bool:
        """Tell whether another mesh has the same points, cells and groups, number by number."""
        if not isinstance(other, MeshArrays):
            return NotImplemented
        if self is other:
            return True
        same = np.array_equal(self.points, other.points) and np.array_equal(self.cells, other.cells)
        return same and _same_groups(self.edge_groups, other.edge_groups) and _same_groups(self.element_groups, other.element_groups)

    def __hash__(self) -> int:
        return self._hash

    @cached_property
    def _hash(self) -> int:
        # Adding 0 turns −0 into 0, which is equal to it.
        return hash(((self.points + 0.0).tobytes(), self.cells.tobytes()))

    def __repr__(self) -> str:
        return f"<percute.Mesh: {elements(self)}, {counted(len(self.points), 'node')}>"

    def __reduce__(self) -> tuple[Any, ...]:
        groups = (dict(self.face_groups), dict(self.element_groups), None) if self.dimension < 3 else (None, dict(self.element_groups), dict(self.face_groups))
        return type(self), (self.points.copy(), self.cells.copy(), *groups)


def elements(mesh: MeshArrays) -> str:
    """Tell the number of elements of a mesh, with their name."""
    if mesh.dimension == 3 and len(mesh.cells) != 1:
        return f"{len(mesh.cells)} tetrahedra"
    return counted(len(mesh.cells), ("bar", "triangle", "tetrahedron")[mesh.dimension - 1])


def _same_groups(first: Mapping[str, NDArray[np.int64]], second: Mapping[str, NDArray[np.int64]]) -> bool:
    """Tell whether groups have the same names and members."""
    return first.keys() == second.keys() and all(np.array_equal(first[name], second[name]) for name in first)


def boundary(cells: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give the edges that belong to one element only (of a bar: nodes, of a solid: faces), and this element."""
    edges = np.concatenate([np.delete(cells, k, axis=1) for k in range(cells.shape[1])]).astype(np.int64)
    _, first, times = np.unique(np.sort(edges, axis=1), axis=0, return_index=True, return_counts=True)
    outer = first[times == 1]
    return edges[outer], outer % len(cells)
