"""Meshes in files of other programs, through meshlane, which is imported on demand."""

from __future__ import annotations

import contextlib
import io
import os
import tempfile
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from percute.checks import caller, encodable
from percute.errors import (
    ExistingFileError,
    FileFormatError,
    InputError,
    MeshWarning,
    MissingFileError,
    PercuteError,
    StorageError,
)
from percute.mesh_arrays import MeshArrays
from percute.mesh_losses import checked, lost_in, refused
from percute.words import counted

M = TypeVar("M", bound=MeshArrays)
_Integers = NDArray[np.int64]

KINDS = {"vertex": 0, "line": 1, "triangle": 2, "tetra": 3}
"""Supported kinds of cells, with their dimensions."""

LARGE = 10.0
"""Size (m) above which a mesh is probably in millimetres, as for files of Gmsh."""

REFERENCES = ("gmsh:physical", "cell_tags", "medit:ref", "CellEntityIds", "su2:tag")
"""Names of cell data that number groups, in formats without group names."""

SURE = ".msh, .vtu, .inp or .med"
"""Endings of formats to suggest where another one fails."""

NO_MESH = {
    ".geo": "is a Gmsh script without a mesh: `gmsh -2 block.geo -o block.msh` makes one",
    ".toml": "is a case, not a mesh; use percute.run",
    ".vtkhdf": "is a history or an estimate, not a mesh; use the `mesh` of percute.open",
}
"""Files with these endings need no meshlane."""


def is_gmsh(file: str) -> bool:
    """Whether percute itself handles this file."""
    return file.lower().endswith(".msh")


def tell_of_mesh(messages: Iterable[str]) -> None:
    """Issue import warnings at the line that called the public function."""
    for message in messages:
        warnings.warn(message, MeshWarning, stacklevel=caller())


def _meshlane(file: str) -> Any:
    try:
        import meshlane
    except ImportError as error:
        raise InputError(
            f"`path`: {encodable(file)!r} is not a .msh file; other formats need meshlane: pip install 'percute[mesh]' ({error})"
        ) from None
    return meshlane


def read_foreign(kind: Callable[..., M], file: str, scale: float) -> tuple[M, list[str]]:
    """Read a mesh by meshlane; give it with its import warnings."""
    if not 1e-12 <= scale <= 1e12:
        raise InputError(
            f"`scale` is {scale}; it must be a positive number from 1e-12 to 1e12: metres per unit of length in the file, "
            "1e-3 for millimetres"
        )
    name = encodable(file)
    if not os.path.isfile(file):
        raise MissingFileError(f"{name}: there is no such file")
    if no_mesh := NO_MESH.get(os.path.splitext(file)[1].lower()):
        raise InputError(f"`path`: {name!r} {no_mesh}")
    meshlane = _meshlane(file)
    told, abaqus = checked(file)
    said: list[str] = []

    def read() -> Any:
        return meshlane.read(file) if abaqus is None else meshlane.read(io.StringIO(abaqus), "abaqus")

    found = _quietly(read, FileFormatError, f"cannot read {name}", said=said)
    reader = _Reader(name, found)
    reader.import_warnings += told + lost_in(said, name)
    points, cells, groups, elements = reader.arrays(scale)
    try:
        mesh = kind(points, cells, groups, elements)
    except InputError as error:
        raise FileFormatError(f"{name}: {error}") from None
    if scale == 1 and mesh.size > LARGE:
        reader.import_warnings.append(f"the mesh is {mesh.size:.3f} m large, corner to corner: if in millimetres, give `scale` = 1e-3")
    return mesh, reader.import_warnings


def _quietly(work: Callable[[], Any], kind: type[PercuteError], what: str, draft: str = "", said: list[str] | None = None) -> Any:
    """Run meshlane, which prints warnings and errors and may end the process; messages do not show the folder ``draft``.

    ``said`` gets the warnings, each in a line.
    """
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(printed), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            done = work()
        if said is not None:
            said += [" ".join(part.split()) for part in printed.getvalue().split("Warning: ")[1:]]
        return done
    except (SystemExit, Exception) as error:
        told = " ".join(f"{printed.getvalue()} {'' if isinstance(error, SystemExit) else error}".split())
        told = told.replace(f"{os.path.basename(draft)}{os.sep}", "") if draft else told
        told = (told or type(error).__name__).rstrip(".")
        known = "the ending of the name selects the format: " if "deduce file format" in told else ""
        raise kind(f"meshlane {what}: {told}; {known}choose {SURE}") from error


class _Reader:
    """Converts a mesh of meshlane."""

    def __init__(self, name: str, found: Any) -> None:
        self.name = name
        self.import_warnings: list[str] = []
        self.points = np.asarray(found.points, dtype=np.float64)
        self.blocks = [(block.type, np.asarray(block.data)) for block in found.cells]
        for kind, data in self.blocks:
            if kind not in KINDS:
                raise refused(name, len(data), kind)
        self.dimension = max((KINDS[kind] for kind, data in self.blocks if len(data)), default=0)
        if self.dimension == 0:
            raise FileFormatError(f"{name}: the file has neither tetrahedra nor triangles nor lines; it must have the mesh of a body")
        self.sets = _sets(found)
        self.points_of = {str(name): np.asarray(nodes, np.int64) for name, nodes in found.point_sets.items() if str(name) not in self.sets}
        if self.dimension == 2 and self.points_of:
            groups = f"{'group' if len(self.points_of) == 1 else 'groups'} of points {', '.join(map(repr, self.points_of))}"
            self.import_warnings.append(f"{groups} left out: in a plane mesh, groups of edges are sets of 2-node lines")

    def _of(self, dimension: int) -> tuple[_Integers, dict[str, _Integers]]:
        """Give all cells of a dimension, and the members of each set."""
        at = [i for i, (kind, _) in enumerate(self.blocks) if KINDS[kind] == dimension]
        cells = [self.blocks[i][1].reshape(-1, dimension + 1).astype(np.int64) for i in at]
        starts = np.cumsum([0, *map(len, cells)])
        sets = {}
        for name, parts in self.sets.items():
            members = [start + parts[i] for start, i in zip(starts, at, strict=False) if len(parts[i])]
            if members:
                sets[name] = np.concatenate(members)
        return (np.concatenate(cells) if cells else np.empty((0, dimension + 1), np.int64)), sets

    def arrays(self, scale: float) -> tuple[NDArray[np.float64], _Integers, dict[str, _Integers], dict[str, _Integers]]:
        """Give points, cells and groups as arguments of `Mesh`."""
        cells, elements = self._of(self.dimension)
        faces, members = self._of(self.dimension - 1)
        for name, nodes in self.points_of.items() if self.dimension == 1 else ():
            # The ends of a bar are points.
            ends = np.intersect1d(nodes, cells)
            members[name] = len(faces) + np.arange(len(ends))
            faces = np.concatenate([faces, ends[:, None]])
        points = self.points.reshape(len(self.points), -1) * scale
        if cells.min() < 0 or cells.max() >= len(points):
            raise FileFormatError(f"{self.name}: an element names a node that is not there")
        used = np.unique(cells)
        numbers = np.full(len(points), -1)
        numbers[used] = np.arange(len(used))
        if len(used) < len(points):
            count = len(points) - len(used)
            self.import_warnings.append(f"{counted(count, 'node')} of the mesh file left out: no element uses {'it' if count == 1 else 'them'}")
        return self._flat(points[used]), numbers[cells], self._boundary(cells, faces, members, numbers), elements

    def _flat(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Leave out constant coordinates."""
        # The distance below which two nodes coincide.
        tolerance = 1e-10 * float(np.linalg.norm(np.ptp(points, axis=0)))
        if points.shape[1] < self.dimension or np.any(np.ptp(points[:, self.dimension :], axis=0) > tolerance):
            where = "in a plane z = const" if self.dimension == 2 else "along x, nor are there triangles"
            raise FileFormatError(f"{self.name}: the mesh does not lie {where}")
        return points[:, : self.dimension]

    def _boundary(
        self, cells: _Integers, faces: _Integers, members: dict[str, _Integers], numbers: _Integers
    ) -> dict[str, _Integers]:
        """Give the members of each group that lie on the boundary."""
        corners = cells.shape[1]
        sides = np.concatenate([np.delete(cells, opposite, axis=1) for opposite in range(corners)])
        keys, counts = np.unique(np.sort(sides, axis=1), axis=0, return_counts=True)
        owners = {tuple(key): count for key, count in zip(keys.tolist(), counts.tolist(), strict=True)}
        of = np.array([owners.get(tuple(sorted(face)), 0) for face in faces.tolist()], dtype=int)
        groups = {}
        for name, chosen in members.items():
            if np.any(of[chosen] == 0):
                first = faces[chosen][of[chosen] == 0][0].tolist()
                raise FileFormatError(f"{self.name}: group {name!r} has an edge of the nodes {first} that is not an edge of an element")
            inner = int(np.count_nonzero(of[chosen] > 1))
            if inner:
                edges = f"{counted(inner, 'edge')} {'lies' if inner == 1 else 'lie'}"
                self.import_warnings.append(f"group {name!r}: {edges} inside the body, left out: groups name parts of its boundary")
            groups[name] = numbers[faces[chosen][of[chosen] == 1]]
        return groups


def _sets(found: Any) -> dict[str, list[_Integers]]:
    """Give the members of each group, block by block, from sets, or from numbers of cells."""
    empty = np.empty(0, np.int64)
    sets = {
        str(name): [empty if part is None else np.asarray(part, np.int64) for part in parts]
        for name, parts in found.cell_sets.items()
        if not str(name).startswith("gmsh:")
    }
    if sets:
        return sets
    names = {int(value[0]): str(name) for name, value in found.field_data.items() if np.size(value) >= 1 and np.ndim(value) == 1}
    for key in REFERENCES:
        if key in found.cell_data:
            blocks = [np.asarray(part) for part in found.cell_data[key]]
            for reference in sorted({int(each) for block in blocks for each in np.unique(block)} - {0}):
                sets[names.get(reference, str(reference))] = [np.flatnonzero(block == reference) for block in blocks]
            break
    return sets


def write_foreign(mesh: MeshArrays, file: str, overwrite: bool) -> None:
    """Write a mesh by meshlane, completely or not at all."""
    name, meshlane, target = encodable(file), _meshlane(file), Path(file)
    if os.path.lexists(file) and not overwrite:
        raise ExistingFileError(f"{name}: the file exists already; give another name, or overwrite=True")
    dimension = mesh.dimension
    kinds = [kind for kind, of in KINDS.items() if of <= dimension]
    space = np.zeros((len(mesh.points), 3))
    space[:, :dimension] = mesh.points
    cells: list[tuple[str, NDArray[Any]]] = [(kinds[dimension], np.asarray(mesh.cells, np.int64))]
    cells += [(kinds[dimension - 1], edges) for edges in mesh.edge_groups.values() if len(edges)]
    empty = np.empty(0, np.int64)
    sets = {group: [members] + [empty] * (len(cells) - 1) for group, members in mesh.element_groups.items()}
    for at, (group, edges) in enumerate(((g, e) for g, e in mesh.edge_groups.items() if len(e)), start=1):
        parts = sets.setdefault(group, [empty] * len(cells))
        parts[at] = np.arange(len(edges))
    with tempfile.TemporaryDirectory(prefix=".percute-", dir=_folder(target, name)) as folder:
        draft = Path(folder) / target.name
        made = meshlane.Mesh(space, cells, cell_sets=sets)
        _quietly(lambda: meshlane.write(draft, made), InputError, f"cannot write {name}", folder)
        written = _quietly(lambda: meshlane.read(draft), InputError, f"cannot read what it wrote to {name}", folder) if sets else made
        lost = set(sets) - set(_sets(written))
        # Some formats take several files.
        drafts = sorted(Path(folder).iterdir())
        for other in drafts:
            if other != draft and os.path.lexists(target.parent / other.name) and not overwrite:
                beside = encodable(os.fspath(target.parent / other.name))
                raise ExistingFileError(f"{beside}: the file exists already; give another name, or overwrite=True")
        for each in drafts:
            os.replace(each, target.parent / each.name)
    if lost:
        message = f"{name}: this format does not keep the groups {', '.join(sorted(map(repr, lost)))}; .msh files do"
        warnings.warn(message, MeshWarning, stacklevel=caller())


def _folder(target: Path, name: str) -> Path:
    folder = target.parent
    if not folder.is_dir():
        raise StorageError(f"{name}: the file cannot be created: there is no folder {os.fspath(folder)!r}")
    return folder
