"""Pages for notebooks: a thumbnail of a mesh and a small table, without matplotlib."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.mesh_arrays import MeshArrays, boundary, elements
from percute.pictures.body import Scale, scale_of
from percute.pictures.canvas import prefixed
from percute.pictures.surface import FROM, surface, view
from percute.words import counted

Floats = NDArray[np.float64]
Rows = list[tuple[str, str]]

MOST = 1500
"""Most elements in a thumbnail. Of larger meshes the outline is drawn, of larger maps the outline and the largest errors."""
SIDE, EDGE = 200.0, 3.0
"""Longer side of a thumbnail, and the room around the body (pixels)."""
VIRIDIS = ("#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725")
"""Ten colours of viridis by van der Walt and Smith (public domain)."""


def page(kind: str, rows: Rows, picture: str) -> str:
    """Show an object of a class by rows of names and texts, and a picture."""
    cell = '<td style="text-align:left;padding:0 0.8em 0 0">'
    shown = [(html.escape(name), html.escape(text).replace("½", "<sup>½</sup>")) for name, text in rows]
    cells = "".join(f"<tr>{cell}{name}</td>{cell}{text}</td></tr>" for name, text in shown)
    table = f'<table style="display:inline-block;vertical-align:top;margin:0 0 0 1em">{cells}</table>'
    return f'<div><b>percute.{kind}</b><br>{picture}{table}</div>'


def mesh_rows(mesh: MeshArrays) -> Rows:
    """Tell the numbers of elements and nodes, the size, and the groups."""
    factor, prefix = prefixed(mesh.points)
    sides = " × ".join(f"{side:.4g}" for side in np.ptp(mesh.points, axis=0) / factor)
    rows = [("mesh", f"{elements(mesh)}, {counted(len(mesh.points), 'node')}"), ("size", f"{sides} {prefix}m")]
    for name, groups in (("face groups" if mesh.dimension == 3 else "edge groups", mesh.face_groups), ("element groups", mesh.element_groups)):
        if groups:
            rows.append((name, ", ".join(f"{group} ({len(members)})" for group, members in groups.items())))
    return rows


def vector(values: Any) -> str:
    """Tell the components of a vector."""
    return "(" + ", ".join(f"{x:.4g}" for x in np.ravel(values)) + ")"


def time(seconds: float) -> str:
    """Tell a time in a suitable unit."""
    factor, prefix = prefixed(np.array([seconds]))
    return f"{seconds / factor:.4g} {prefix}s"


def _pixels(mesh: MeshArrays) -> tuple[Floats, float, float]:
    """Give the places of the nodes (pixels, y downwards; a bar as a strip), and width and height."""
    flat = view(mesh.points)[:, :2] if mesh.dimension == 3 else mesh.points
    points = np.column_stack([flat, np.zeros((len(mesh.points), max(2 - mesh.dimension, 0)))])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (SIDE - 2 * EDGE) / float((high - low).max())
    width, height = scale * (high - low) + 2 * EDGE
    return np.column_stack([scale * (points[:, 0] - low[0]) + EDGE, scale * (high[1] - points[:, 1]) + EDGE]), float(width), float(height)


def _faces(mesh: MeshArrays) -> NDArray[Any]:
    """Give the elements of a plane body, or the faces of a solid that are seen."""
    if mesh.dimension < 3:
        return mesh.cells
    faces, _, normals = surface(mesh.points, mesh.cells)
    seen: NDArray[np.int64] = faces[normals @ FROM > 0.0]
    return seen


def _svg(width: float, height: float, body: str) -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.1f} {height:.1f}">{body}</svg>'


def _path(places: Floats, polygons: Iterable[Any], closed: bool) -> str:
    return "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places[polygon]) + ("Z" if closed else "") for polygon in polygons)


def outline(mesh: MeshArrays) -> str:
    """Draw the elements, or the boundary of a large mesh."""
    places, width, height = _pixels(mesh)
    if mesh.dimension == 1:
        return _strip(places, mesh.cells, ["none"] * len(mesh.cells), width)
    shown = _faces(mesh)
    every = len(shown) <= MOST
    lines = _path(places, shown, True) if every else _path(places, boundary(mesh.cells)[0], mesh.dimension == 3)
    return _svg(width, height, f'<path d="{lines}" fill="none" stroke="currentColor" stroke-width="{0.5 if every else 1}"/>')


def _colour(value: float, scale: Scale) -> str:
    if scale.logarithmic:
        part = np.log(max(value, scale.low) / scale.low) / np.log(scale.high / scale.low)
    else:
        part = (value - scale.low) / (scale.high - scale.low)
    return VIRIDIS[min(int(part * len(VIRIDIS)), len(VIRIDIS) - 1)]


def error_map(mesh: MeshArrays, values: Floats) -> str:
    """Draw the elements in the colours of their errors."""
    places, width, height = _pixels(mesh)
    scale = scale_of(values)
    if mesh.dimension == 1:
        return _strip(places, mesh.cells, [_colour(float(value), scale) for value in values], width)
    largest = np.argsort(-values, kind="stable")[:MOST]
    colours: dict[str, list[Any]] = {}
    for element in largest.tolist():
        colours.setdefault(_colour(float(values[element]), scale), []).append(mesh.cells[element])
    # Strokes of the same colour close the gaps between neighbours.
    body = "".join(f'<path d="{_path(places, cells, True)}" fill="{shade}" stroke="{shade}" stroke-width="0.3"/>' for shade, cells in colours.items())
    if len(mesh.cells) > MOST:
        body += f'<path d="{_path(places, boundary(mesh.cells)[0], False)}" fill="none" stroke="currentColor"/>'
    return _svg(width, height, body)


def _strip(places: Floats, cells: NDArray[Any], colours: list[str], width: float) -> str:
    """Draw a bar as a strip of its elements."""
    order = np.argsort(places[cells, 0].min(axis=1), kind="stable")[:: max(len(cells) // MOST, 1)]
    height = 16.0
    ends = [(element, places[cells[element], 0]) for element in order.tolist()]
    body = "".join(
        f'<rect x="{x.min():.1f}" y="{EDGE}" width="{max(np.ptp(x), 0.3):.1f}" height="{height - 2 * EDGE}" fill="{colours[element]}" '
        'stroke="currentColor" stroke-width="0.3"/>'
        for element, x in ends
    )
    return _svg(width, height, body)
