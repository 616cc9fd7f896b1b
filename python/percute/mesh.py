"""Meshes of bars, triangles and tetrahedra."""

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
from percute.words import counted

__all__ = ["Mesh"]

MOST_REFINEMENTS = 30
MOST, MOST_RINGS, MOST_OF_BALL = 20_000_000, 1825, 100
"""Largest numbers of elements, and of rings of a disc and of a ball, in a generated mesh."""


class Mesh(MeshArrays):
    """A mesh of 2-node bars, 3-node triangles or 4-node tetrahedra, checked once at its creation.

    Parameters
    ----------
    points : (nodes,), (nodes, 1), (nodes, 2) or (nodes, 3) floats
        Coordinates of the nodes (m). One coordinate makes a mesh of bars, two make one of triangles, three one of tetrahedra.
    cells : (elements, 2), (elements, 3) or (elements, 4) ints
        Nodes of each element, counted from 0. Elements of negative orientation are reoriented.
    edge_groups : dict of str to (edges, 2) ints, optional
        Named groups of boundary edges, each by its two nodes; of a bar: (ends,) or (ends, 1).
    element_groups : dict of str to (n,) ints, optional
        Named groups of elements.
    face_groups : dict of str to (faces, 3) ints, optional
        Of a solid, named groups of boundary faces, each by its three nodes.

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
        face_groups: Mapping[str, ArrayLike] | None = None,
    ) -> None:
        places = numbers("points", points, most=2)
        places = places[:, None] if places.ndim == 1 else places
        if places.ndim != 2 or places.shape[1] not in (1, 2, 3):
            way_out = transposed("points", places, 1, 2, 3)
            raise InputError(f"`points` has the shape {places.shape}; it must have (nodes,), (nodes, 1), (nodes, 2) or (nodes, 3){way_out}")
        dimension = places.shape[1]
        if dimension == 3 and np.shape(cells)[1:] == (3,):
            raise InputError(f"`points` has the shape {places.shape}; for elements of three nodes it must have (nodes, 2); leave out z")
        given, other = ("edge_groups", "face_groups") if dimension < 3 else ("face_groups", "edge_groups")
        wanted, refused = (edge_groups, face_groups) if dimension < 3 else (face_groups, edge_groups)
        if refused is not None:
            raise InputError(f"`{other}` does not apply to points with {counted(dimension, 'coordinate')}; name the groups by `{given}`")
        edges = {} if wanted is None else table(given, wanted, "edges")
        elements = {} if element_groups is None else table("element_groups", element_groups, "elements")
        self._data = _percute.MeshData.from_arrays(
            places,
            integers("cells", cells, dimension + 1),
            {name: integers(f"{given}[{name!r}]", each, dimension) for name, each in edges.items()},
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

    @classmethod
    def box(cls, size: ArrayLike, *, cells: ArrayLike) -> Mesh:
        """Make the box [0, a] × [0, b] × [0, c] of tetrahedra.

        Parameters
        ----------
        size : (3,) floats
            Lengths of the sides a, b and c (m).
        cells : (3,) ints
            Numbers of cells along x, y and z, of six tetrahedra each.

        Returns
        -------
        Mesh
            Its sides are the groups ``left`` and ``right`` (x), ``front`` and ``back`` (y), ``bottom`` and ``top`` (z).
        """
        sides = vector_of("size", size, 3, "m")
        counts = integers("cells", cells, None)
        if counts.shape != (3,):
            raise wrong("cells", cells, "three numbers of cells, along x, y and z")
        return cls._of(_percute.MeshData.box(sides, [whole("cells", count, most=MOST) for count in counts.tolist()]))

    @classmethod
    def cylinder(cls, radius: float, height: float, *, rings: int, layers: int) -> Mesh:
        """Make a cylinder on the plane z = 0 around the axis z, of 18 ``rings ** 2 * layers`` tetrahedra.

        Returns
        -------
        Mesh
            Its surface is the groups ``bottom``, ``top`` and ``side``.
        """
        sides = number("radius", radius), number("height", height)
        return cls._of(_percute.MeshData.cylinder(*sides, whole("rings", rings, most=MOST_RINGS), whole("layers", layers, most=MOST)))

    @classmethod
    def ball(cls, radius: float, *, rings: int) -> Mesh:
        """Make a ball of this radius (m) around the origin, of 20 ``rings ** 3`` tetrahedra; rings are spheres of nodes.

        Returns
        -------
        Mesh
            Its surface, which has a node at the lowest point, is the group ``boundary``.
        """
        return cls._of(_percute.MeshData.ball(number("radius", radius), whole("rings", rings, most=MOST_OF_BALL)))

    def refine(self, times: int = 1, *, where: ArrayLike | None = None) -> Mesh:
        """Cut each element into halves (a bar), quarters or eighths (a solid), repeatedly; or only some elements, once.

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
        by : (dimension,) floats or, of a bar, float
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
        if self.dimension != 2:
            told = "a bar cannot be turned" if self.dimension == 1 else "a solid has no angle in the plane: turn its `points`"
            raise InputError(f"`degrees` is {angle}; {told}")
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
