"""How meshes, problems, histories and estimates show themselves in a notebook: a thumbnail and a small table, without matplotlib."""

from __future__ import annotations

import html
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute._percute import unit
from percute.element_fields import boundary
from percute.pictures.body import Scale, scale_of
from percute.pictures.canvas import prefixed
from percute.words import counted

if TYPE_CHECKING:
    from percute.estimation import Estimate
    from percute.history import History
    from percute.mesh import Mesh
    from percute.problem import Problem

Floats = NDArray[np.float64]
Rows = list[tuple[str, str]]

MOST = 1500
"""Most elements in a thumbnail. Of larger meshes the outline is drawn, of larger maps the outline and the largest errors."""
SIDE, EDGE = 200.0, 3.0
"""Longer side of a thumbnail, and the room around the body (pixels)."""
VIRIDIS = ("#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725")
"""Ten colours of viridis by van der Walt and Smith (public domain)."""


def of_mesh(mesh: Mesh) -> str:
    """Show a mesh."""
    return _page("Mesh", _mesh_rows(mesh), _outline(mesh))


def of_problem(problem: Problem) -> str:
    """Show a problem."""
    material = problem.material
    laws = [("", material)] if not isinstance(material, dict) else [(f" of {name}", law) for name, law in material.items()]
    rows = _mesh_rows(problem.mesh)[:2]
    rows += [(f"material{of}", _law(law)) for of, law in laws]
    rows += [("plane", f"friction {each.friction:g}, normal {_vector(each.normal)}") for each in problem.obstacles]
    for name in ("supports", "tractions", "body_forces"):
        if members := getattr(problem, name):
            rows.append((name.replace("_", " "), str(len(members))))
    speeds = np.linalg.norm(problem.initial_velocity, axis=1)
    rows += [("mass", f"{problem.mass.sum():.4g} kg"), ("speed at the start", f"at most {speeds.max():.4g} m/s, of waves {problem.wave_speed:.4g} m/s")]
    return _page("Problem", rows, _outline(problem.mesh))


def of_history(history: History) -> str:
    """Show a history; nothing is computed."""
    count, planned = len(history), len(history._data.times)
    told = f"{count} to {_time(float(history.time[-1]))}" if count else "none"
    rows = [("instants", told if history.complete else f"{told}, of {planned} planned")]
    if count > 1:
        rows.append(("longest step", _time(float(np.diff(history.time).max()))))
    rows.append(("steps are", "in memory" if history.path is None else f"in {history.path}"))
    return _page("History", rows + _mesh_rows(history.problem.mesh)[:2], _outline(history.problem.mesh))


def of_estimate(estimate: Estimate) -> str:
    """Show an estimate."""
    norm = unit("J^½", estimate.per_metre).replace("^½", "½")
    rows = [
        ("largest error", f"{100 * estimate.relative_sup:.3g} %, {estimate.sup:.4g} {norm} at {_time(estimate.time_of_sup)}"),
        ("mean error", f"{100 * estimate.relative_mean:.3g} %, {estimate.mean_from_touch:.4g} {norm}, from the touch"),
        ("steps", f"{estimate.steps} to {_time(estimate.end)}"),
        ("reconstruction", str(estimate.options["reconstruction"])),
    ]
    if estimate.trust is not None:
        rows += [("trust", estimate.trust), ("verdict", str(estimate.verdict))]
    rows += [("worst element", f"{each.element} at {_vector(each.centroid)} m, {each.error:.3g} {norm}") for each in estimate.worst_elements(1)]
    return _page("Estimate", rows + _mesh_rows(estimate.mesh)[:2], _map(estimate.mesh, estimate.by_element))


def _page(kind: str, rows: Rows, picture: str) -> str:
    cell = '<td style="text-align:left;padding:0 0.8em 0 0">'
    shown = [(html.escape(name), html.escape(text).replace("½", "<sup>½</sup>")) for name, text in rows]
    cells = "".join(f"<tr>{cell}{name}</td>{cell}{text}</td></tr>" for name, text in shown)
    table = f'<table style="display:inline-block;vertical-align:top;margin:0 0 0 1em">{cells}</table>'
    return f'<div><b>percute.{kind}</b><br>{picture}{table}</div>'


def _mesh_rows(mesh: Mesh) -> Rows:
    kind = "bar" if mesh.dimension == 1 else "triangle"
    factor, prefix = prefixed(mesh.points)
    sides = " × ".join(f"{side:.4g}" for side in np.ptp(mesh.points, axis=0) / factor)
    rows = [("mesh", f"{counted(len(mesh.cells), kind)}, {counted(len(mesh.points), 'node')}"), ("size", f"{sides} {prefix}m")]
    for name, groups in (("edge groups", mesh.edge_groups), ("element groups", mesh.element_groups)):
        if groups:
            rows.append((name, ", ".join(f"{group} ({len(members)})" for group, members in groups.items())))
    return rows


def _law(law: Any) -> str:
    told = f"E = {law.young:.4g} Pa, ρ = {law.density:.4g} kg/m³"
    return told if law.poisson is None else f"{told}, ν = {law.poisson:g}, plane {law.plane}"


def _vector(values: Any) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in np.ravel(values)) + ")"


def _time(seconds: float) -> str:
    factor, prefix = prefixed(np.array([seconds]))
    return f"{seconds / factor:.4g} {prefix}s"


def _pixels(mesh: Mesh) -> tuple[Floats, float, float]:
    """Give the places of the nodes (pixels, y downwards; a bar as a strip), and width and height."""
    points = np.column_stack([mesh.points, np.zeros((len(mesh.points), 2 - mesh.dimension))])
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (SIDE - 2 * EDGE) / float((high - low).max())
    width, height = scale * (high - low) + 2 * EDGE
    return np.column_stack([scale * (points[:, 0] - low[0]) + EDGE, scale * (high[1] - points[:, 1]) + EDGE]), float(width), float(height)


def _svg(width: float, height: float, body: str) -> str:
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.0f}" height="{height:.0f}" viewBox="0 0 {width:.1f} {height:.1f}">{body}</svg>'


def _path(places: Floats, polygons: Iterable[Any], closed: bool) -> str:
    return "".join("M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places[polygon]) + ("Z" if closed else "") for polygon in polygons)


def _outline(mesh: Mesh) -> str:
    """Draw the elements, or the boundary of a large mesh."""
    places, width, height = _pixels(mesh)
    if mesh.dimension == 1:
        return _strip(places, mesh.cells, ["none"] * len(mesh.cells), width)
    every = len(mesh.cells) <= MOST
    lines = _path(places, mesh.cells, True) if every else _path(places, boundary(mesh.cells)[0], False)
    return _svg(width, height, f'<path d="{lines}" fill="none" stroke="currentColor" stroke-width="{0.5 if every else 1}"/>')


def _colour(value: float, scale: Scale) -> str:
    if scale.logarithmic:
        part = np.log(max(value, scale.low) / scale.low) / np.log(scale.high / scale.low)
    else:
        part = (value - scale.low) / (scale.high - scale.low)
    return VIRIDIS[min(int(part * len(VIRIDIS)), len(VIRIDIS) - 1)]


def _map(mesh: Mesh, values: Floats) -> str:
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
