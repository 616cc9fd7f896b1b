"""What meshlane would leave out of mesh files without a word: elements, zones and surfaces, found in their texts."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

from percute.checks import encodable
from percute.errors import FileFormatError
from percute.words import counted

TAKEN = "percute takes 3-node triangles (a bar: 2-node lines): mesh again with these"
"""What to do about other elements."""


class Text(NamedTuple):
    """What a file has that meshlane does not tell."""

    import_warnings: list[str]
    abaqus: str | None = None
    """The text to read instead of an Abaqus file."""


def checked(file: str) -> Text:
    """Refuse a file of which meshlane would lose elements."""
    found = READERS.get(Path(file).suffix.lower())
    return Text([]) if found is None else found(file, encodable(file))


def lost_in(messages: list[str], name: str) -> list[str]:
    """Give what meshlane said about a file as import warnings; elements that it skips are an error."""
    for message in messages:
        if LOST.search(message):
            raise FileFormatError(f"{name}: meshlane loses elements: {message}; {TAKEN}")
    return [f"the reader says: {message}" for message in messages]


LOST = re.compile(r"cannot handle|element type|Unknown entry (triangle|quad|tetra|hexa|interval)")
"""Messages of meshlane about elements."""


def refused(name: str, count: int, kind: str, remedy: str = TAKEN) -> FileFormatError:
    """Make the error about elements that percute has not."""
    return FileFormatError(f"{name}: {counted(count, 'element')} {'is' if count == 1 else 'are'} of the kind {kind!r}; {remedy}")


def _left_out(kinds: Counter[str]) -> list[str]:
    """Tell of masses, springs and connectors, which are no parts of a mesh."""
    return [f"{counted(count, 'element')} of the kind {kind!r} left out: percute has no masses, springs and connectors" for kind, count in kinds.items()]


def _read(file: str) -> str:
    """Give a text as meshlane decodes it."""
    try:
        raw = Path(file).read_bytes()
    except OSError as error:
        raise FileFormatError(f"{encodable(file)}: cannot be read: {error.strerror}") from None
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace")


# --- Abaqus ---

PLANE = frozenset(("CPE3", "CPE3H", "CPE3T", "CPE3HT", "CPE3E", "CPS3T", "CPS3E"))
"""Triangles that meshlane does not know: it reads them as CPS3."""
TRIANGLES = PLANE | {"CPS3", "STRI3", "S3", "S3R", "S3RS", "M3D3", "SFM3D3", "R3D3", "DC2D3", "AC2D3"}
LINES = frozenset(("T2D2", "T2D2H", "T3D2", "T3D2H", "B21", "B21H", "B31", "B31H", "DC1D2", "AC1D2"))
NO_MESH = re.compile(r"MASS|ROTARYI|CONN|SPRING|DASHPOT|DCOUP|JOINT|GAP")
AXISYMMETRIC = re.compile(r"CAX|CGAX|SAX|MAX|DCAX|ACAX|DSAX")
DEEPEST = 20
"""Includes in included files, beyond which a file includes itself."""


def _included(file: str, depth: int = 0) -> Iterator[str]:
    """Give the lines of a file, with those of included files in their places."""
    for line in _read(file).splitlines():
        if not line.upper().startswith("*INCLUDE"):
            yield line
            continue
        other = line.partition("=")[2].strip().strip("\"'")
        beside = Path(file).parent / other
        if depth == DEEPEST or not beside.is_file():
            why = "includes itself" if depth == DEEPEST else f"includes {encodable(other)!r}, which is not beside it"
            raise FileFormatError(f"{encodable(file)}: the file {why}")
        yield from _included(str(beside), depth + 1)


def _options(line: str) -> dict[str, str]:
    """Give the options of a keyword, with names in capitals."""
    pairs = [option.partition("=") for option in line.split(",")[1:]]
    return {key.strip().upper(): value.strip().strip('"') for key, _, value in pairs}


def _abaqus(file: str, name: str) -> Text:
    """Count the elements by their kinds, and give a text in which triangles have a name that meshlane knows."""
    lines, kinds, surfaces, kind, whole = [], Counter[str](), [], "", True
    for line in _included(file):
        if line.startswith("*") and not line.startswith("**"):
            keyword, options = line.partition(",")[0].strip().upper(), _options(line)
            kind, whole = (options.get("TYPE", "").upper() if keyword == "*ELEMENT" else ""), True
            if keyword == "*SURFACE":
                surfaces.append(options.get("NAME", ""))
            if kind in PLANE:
                line = re.sub(r"(?i)(type\s*=\s*)\w+", r"\g<1>CPS3", line)
        elif kind and line.strip() and not line.startswith("**"):
            # A row that ends with a comma goes on.
            kinds[kind] += whole
            whole = not line.rstrip().endswith(",")
        lines.append(line)
    others = Counter({kind: count for kind, count in kinds.items() if NO_MESH.match(kind)})
    for kind, count in kinds.items():
        if kind not in TRIANGLES | LINES and kind not in others:
            axis = "percute has no axisymmetric bodies; " if AXISYMMETRIC.match(kind) else ""
            raise refused(name, count, kind, axis + TAKEN)
    told = _left_out(others)
    if surfaces:
        what = f"{'surface' if len(surfaces) == 1 else 'surfaces'} {', '.join(map(repr, surfaces))}"
        told.append(f"{what} left out: in this format, a group of edges is a set of 2-node lines")
    # Files of Ansys have the same ending and other keywords.
    mesh = any(line[:5].upper() in ("*NODE", "*ELEM", "*PART") for line in lines)
    return Text(told, "\n".join([*lines, ""]) if mesh else None)


# --- Nastran ---

SHAPES = re.compile(r"C(TRI|TRA|QUAD|PLST|RAC|TET|HEX|PEN|PYR|SHEAR|TUBE|ONROD|BEND|BEAM|BAR|ROD|BUSH|GAP)")
POINTS = re.compile(r"C(ELAS|MASS|DAMP|VISC|ONM)")
CARDS = frozenset(("CTRIA3", "CTRIAR", "CBEAM", "CBAR", "CROD", "CBUSH", "CBUSH1D", "CGAP"))
"""Triangles and lines that meshlane reads."""


def _nastran(file: str, name: str) -> Text:
    """Count the elements by their cards."""
    kinds, points = Counter[str](), Counter[str]()
    _, _, bulk = _read(file).partition("BEGIN BULK")
    for line in bulk.splitlines()[1:]:
        card = (line.partition(",")[0] if "," in line else line[:8]).strip()
        if card.upper().startswith("INCLUDE"):
            raise FileFormatError(f"{name}: it includes another file, which meshlane does not read: join them")
        if POINTS.match(card.upper()):
            points[card] += 1
        elif SHAPES.match(card.upper()):
            kinds[card] += 1
    for card, count in kinds.items():
        if card not in CARDS:
            known = card.upper().rstrip("*") in CARDS
            raise refused(name, count, card, "meshlane reads these in capitals and fields of 8 characters, or with commas" if known else TAKEN)
    return Text(_left_out(points))


# --- Tecplot ---


def _tecplot(file: str, name: str) -> Text:
    """Count the zones: meshlane reads the first."""
    zones = re.split(r"(?im)^\s*zone\b", _read(file))[1:]
    if len(zones) > 1:
        sizes = [re.search(r"(?i)\b(?:e|elements)\s*=\s*(\d+)", zone) for zone in zones[1:]]
        lost = sum(int(size[1]) for size in sizes if size)
        raise FileFormatError(
            f"{name}: it has {len(zones)} zones, of which meshlane reads the first: {counted(lost, 'element')} would be lost; write one zone"
        )
    return Text([])


READERS: dict[str, Callable[[str, str], Text]] = {".inp": _abaqus, ".bdf": _nastran, ".fem": _nastran, ".nas": _nastran, ".dat": _tecplot, ".tec": _tecplot}
"""By the endings of names, as meshlane chooses them."""
