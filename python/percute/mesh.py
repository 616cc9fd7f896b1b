"""Meshes of bars and triangles."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from percute import _percute, notebook
from percute.arrays import flags, integers, numbers, transposed
from percute.checks import encodable, flag, new_file, number, table, text, whole, wrong
from percute.checks import path as file_name
from percute.errors import InputError
from percute.mesh_arrays import MeshArrays
from percute.mesh_files import is_gmsh, read_foreign, tell_of_mesh, write_foreign
from percute.statement import Vector, vector_of

__all__ = ["Mesh"]

MOST_REFINEMENTS = 30
MOST, MOST_RINGS = 20_000_000, 1825
"""Largest numbers of elements, and of rings of a disc, in a generated mesh."""


class Mesh(MeshArrays):
    """A mesh of 2-node bars or 3-node triangles, checked once at its creation.

    Parameters
    ----------
    points : (nodes,), (nodes, 1) or (nodes, 2) floats
        Coordinates of the nodes (m). One coordinate makes a mesh of bars, two make one of triangles.
    cells : (elements, 2) or (elements, 3) ints
        Nodes of each element, counted from 0. Clockwise elements (a bar: backwards) are reoriented.
    edge_groups : dict of str to (edges, 2) ints, optional
        Named groups of boundary edges, each by its two nodes; of a bar: (ends,) or (ends, 1).
    element_groups : dict of str to (n,) ints, optional
        Named groups of elements.

    Raises
    ------
    InputError
        With the number of the node or element at fault: coordinates that are not finite, nodes that do not exist, belong to
        no element or lie at the same place, elements that are degenerate or overlap, edges not on the boundary.
    """

    def __init__(
        self,
        points: ArrayLike,
        cells: ArrayLike,
        edge_groups: Mapping[str, ArrayLike] | None = None,
        element_groups: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        places = numbers("points", points, most=2)
        places = places[:, None] if places.ndim == 1 else places
        if places.ndim != 2 or places.shape[1] not in (1, 2):
            way_out = transposed("points", places, 1, 2) or "; leave out z"
            raise InputError(f"`points` has the shape {places.shape}; it must have (nodes,), (nodes, 1) or (nodes, 2){way_out}")
        dimension = places.shape[1]
        edges = {} if edge_groups is None else table("edge_groups", edge_groups, "edges")
        elements = {} if element_groups is None else table("element_groups", element_groups, "elements")
        self._data = _percute.MeshData.from_arrays(
            places,
            integers("cells", cells, dimension + 1),
            {name: integers(f"edge_groups[{name!r}]", each, dimension) for name, each in edges.items()},
            {name: integers(f"element_groups[{name!r}]", each, None) for name, each in elements.items()},
        )

    @classmethod
    def rectangle(cls, width: float, height: float, *, nx: int, ny: int, diagonals: Literal["right", "alternating", "crossed"] = "right") -> Mesh:
        """Make the rectangle [0, width] × [0, height] of triangles.

        Parameters
        ----------
        width, height : float
            Lengths of the sides (m).
        nx, ny : int
            Number of cells along x and y.
        diagonals : {"right", "alternating", "crossed"}, default: "right"
            How a cell is cut: into two triangles, from its lower left to its upper right corner, or in turn from there and from its
            upper left to its lower right corner; or into four, by both diagonals. Diagonals of one direction push a symmetric body
            aside; ``"crossed"`` is symmetric, and so is ``"alternating"`` with even ``nx`` and ``ny``.

        Returns
        -------
        Mesh
            Its sides are the groups ``left``, ``right``, ``bottom`` and ``top``.
        """
        sides = number("width", width), number("height", height)
        columns, rows = whole("nx", nx, most=MOST), whole("ny", ny, most=MOST)
        if text("diagonals", diagonals) not in ("right", "alternating", "crossed"):
            raise wrong("diagonals", diagonals, '"right", "alternating" or "crossed"')
        return cls._of(_percute.MeshData.rectangle(*sides, columns, rows, diagonals))

    @classmethod
    def disc(cls, radius: float, *, rings: int) -> Mesh:
        """Make a disc of this radius (m) around the origin, of 6 ``rings ** 2`` triangles of nearly equal size.

        Returns
        -------
        Mesh
            Its outline, which has a node at the lowest point, is the group ``boundary``.
        """
        return cls._of(_percute.MeshData.disc(number("radius", radius), whole("rings", rings, most=MOST_RINGS)))

    @classmethod
    def bar(cls, length: float, *, elements: int) -> Mesh:
        """Make a bar from 0 to ``length`` (m) of equal elements.

        Returns
        -------
        Mesh
            Its ends are the groups ``start`` (at 0) and ``end``.
        """
        return cls._of(_percute.MeshData.bar(number("length", length), whole("elements", elements, most=MOST)))

    def refine(self, times: int = 1, *, where: ArrayLike | None = None) -> Mesh:
        """Cut each element into halves (a bar) or quarters, repeatedly; or only some elements, once.

        Nodes keep their numbers and groups their edges and elements, so that the mesh is nested in the finer one: `History.error`
        compares runs on both.

        Parameters
        ----------
        times : int, default: 1
            How often. Without ``where`` only.
        where : (elements,) bools, optional
            The elements that are cut, with as many neighbours as a conforming mesh needs. Longest edges are cut first (Rivara
            1984): the smallest angle stays at least half of that of the mesh at the start, however often meshes are refined.

        Returns
        -------
        Mesh
            Its elements are in the order of those that they are parts of.
        """
        count = whole("times", times, least=0, most=MOST_REFINEMENTS)
        if where is None:
            return Mesh._of(self._data.refined(count))
        if count != 1:
            raise InputError(f"`times` is {count}, but `where` names elements of this mesh only; leave `times` out and refine the result again")
        return Mesh._of(self._data.refined_where(flags("where", where, len(self.cells), "element")))

    def moved(self, by: ArrayLike) -> Mesh:
        """Move the mesh.

        Parameters
        ----------
        by : (2,) floats or, of a bar, float
            By how much (m).

        Returns
        -------
        Mesh
            With the same elements and groups.
        """
        way = vector_of("by", by, self.dimension, "m")
        return self._placed("by", way, way, 0.0)

    def rotated(self, degrees: float, about: ArrayLike = (0.0, 0.0)) -> Mesh:
        """Turn a plane mesh.

        Parameters
        ----------
        degrees : float
            By how much, counterclockwise.
        about : (2,) floats, default: (0, 0)
            The point that stays in its place (m).

        Returns
        -------
        Mesh
            With the same elements and groups.
        """
        angle = number("degrees", degrees, finite=True, unit="degrees")
        if self.dimension == 1:
            raise InputError(f"`degrees` is {angle}; a bar cannot be turned")
        x, y = centre = vector_of("about", about, 2, "m")
        cos, sin = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        return self._placed("about", centre, (x - cos * x + sin * y, y - sin * x - cos * y), angle)

    def _placed(self, name: str, given: Vector, origin: Vector, degrees: float) -> Mesh:
        """Give the mesh with its origin in another place (m), turned about it; errors name the argument."""
        try:
            return Mesh._of(self._data.placed(origin, degrees))
        except InputError as error:
            _, far, from_what = str(error).partition(" m, so far")
            if not far:
                raise
            raise InputError(f"`{name}` is {given}{far}{from_what.partition(';')[0]}; give metres") from None

    def part(self, group: str) -> Mesh:
        """Make a mesh of the elements of a group alone, such as one of several bodies in a file.

        Parameters
        ----------
        group : str
            One of its ``element_groups``.

        Returns
        -------
        Mesh
            With the parts of all groups that lie in it.
        """
        found = self._data.part_of_group(text("group", group))
        if found is None:
            hint = _percute.hint(group, list(self.element_groups))
            raise InputError(f"`group` is {group!r}; the groups of elements are {', '.join(self.element_groups) or 'none'}{hint}")
        return Mesh._of(found)

    @classmethod
    def read(cls, path: str | os.PathLike[str], *, scale: float = 1.0) -> Mesh:
        """Read a mesh from a file.

        Parameters
        ----------
        path : str or path
            A file of Gmsh (``.msh``, versions 2.2 and 4.1), or of a format that meshlane reads (extra ``mesh``): ``.vtu``, ``.vtk``,
            ``.inp``, ``.med``, ``.xdmf`` and more.
        scale : float, default: 1.0
            Metres per unit of length in the file: 1e-3 for a model in millimetres.

        Returns
        -------
        Mesh
            Of the triangles in the file, if there are any, else of its lines along x. Physical groups, or sets, of surfaces are its
            ``element_groups``, those of curves its ``edge_groups``; see ``docs/mesh.md``.

        Warns
        -----
        MeshWarning
            Something was left out, such as nodes that no element uses.

        Raises
        ------
        MissingFileError, StorageError
            There is no such file, or it cannot be read.
        FileFormatError
            It is damaged, or holds no mesh that percute can take; the message says where and what to do.
        InputError
            Another format without meshlane, or a scale that is none.
        """
        file, factor = file_name("path", path), number("scale", scale)
        if is_gmsh(file):
            mesh = cls._of(_percute.MeshData.read(file, factor))
            import_warnings = mesh._data.import_warnings()
        else:
            mesh, import_warnings = read_foreign(cls, file, factor)
        tell_of_mesh(import_warnings)
        return mesh

    def write(
        self,
        path: str | os.PathLike[str],
        *,
        version: str = "4.1",
        binary: bool = False,
        overwrite: bool = False,
    ) -> None:
        """Write the mesh, in metres, to a file: completely or not at all.

        Parameters
        ----------
        path : str or path
            A name that ends in ``.msh``, for Gmsh; from it `read` makes the same mesh, bit by bit. Other endings are written by
            meshlane (extra ``mesh``), which has its own rules for groups.
        version : str, default: "4.1"
            Version of a ``.msh`` file: "4.1" or "2.2".
        binary : bool, default: False
            Whether a ``.msh`` file is binary.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        ExistingFileError, StorageError
            The file exists already, or cannot be written.
        InputError
            A version that is not known, another format without meshlane, or names of groups with quotes or line breaks.
        """
        file, replace, as_bytes = new_file("path", path), flag("overwrite", overwrite), flag("binary", binary)
        if not isinstance(version, str) or version not in ("4.1", "2.2"):
            raise wrong("version", version, '"4.1" or "2.2"')
        if is_gmsh(file):
            self._data.write(file, version == "2.2", as_bytes, replace)
            return
        if as_bytes or version != "4.1":
            raise InputError(f"`version` and `binary` are those of .msh files; {encodable(file)!r} is none")
        write_foreign(self, file, replace)

    def _repr_html_(self) -> str:
        return notebook.page("Mesh", notebook.mesh_rows(self), notebook.outline(self))
