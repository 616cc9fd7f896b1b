"""Values on the surface of a solid, seen from one direction, with planes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute.errors import InputError
from percute.mesh_arrays import boundary
from percute.pictures.body import DEPTH, NEAR, Line, Scale, colour_bar, linear
from percute.pictures.canvas import FIELD, Floats, prefixed, pyplot

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FROM = np.array([2.0, -3.0, 1.5])
"""The direction from the body to the eye."""
LIGHT = np.array([0.35, -0.8, 1.0])
"""The direction from the body to the light."""
SHADE = 0.45
"""The brightness of faces that are turned away from the light."""
FINE = 20_000
"""Surfaces of more faces are drawn without mesh lines."""


def view(places: Floats) -> Floats:
    """Give the coordinates in the picture, and the distance towards the eye: parallel projection with z upwards."""
    towards = FROM / np.linalg.norm(FROM)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    seen: Floats = places @ np.column_stack([right, np.cross(towards, right), towards])
    return seen


def surface(points: Floats, cells: NDArray[Any]) -> tuple[NDArray[np.int64], NDArray[np.int64], Floats]:
    """Give the faces of the boundary, their elements and their outward unit normals."""
    faces, owners = boundary(cells)
    a, b, c = (points[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    outward = np.einsum("ij,ij->i", normals, a - points[cells[owners]].mean(axis=1)) > 0.0
    normals *= np.where(outward, 1.0, -1.0)[:, None]
    return faces, owners, normals / np.linalg.norm(normals, axis=1)[:, None]


def draw_solid(
    axes: Axes,
    points: Floats,
    cells: NDArray[Any],
    values: Floats,
    label: str,
    *,
    colours: str = FIELD,
    scale: Scale | None = None,
    planes: Sequence[Line] = (),
    extent: Floats | None = None,
) -> None:
    """Draw values of nodes or elements on the faces of the boundary that are seen, shaded, the nearest ones last.

    ``extent`` has points (m) that the picture must hold, by default those of the body.
    """
    if len(values) == 0:
        raise InputError("there is nothing to draw")
    plt = pyplot()
    faces, owners, normals = surface(points, cells)
    of_faces = values[owners] if len(values) == len(cells) else values[faces].mean(axis=1)
    seen = normals @ FROM > 0.0
    order = np.flatnonzero(seen)[np.argsort(view(points[faces[seen]].mean(axis=1))[:, 2], kind="stable")]
    held = points if extent is None else extent
    factor, prefix = prefixed(held)
    shown = linear(values, colours) if scale is None else scale
    mapped = plt.matplotlib.cm.ScalarMappable(norm=shown.norm(), cmap=colours)
    clipped = np.maximum(of_faces, shown.low) if shown.logarithmic else of_faces
    rgba = mapped.to_rgba(clipped[order])
    bright = SHADE + (1.0 - SHADE) * np.clip(normals[order] @ (LIGHT / np.linalg.norm(LIGHT)), 0.0, 1.0)
    rgba[:, :3] *= bright[:, None]
    places = view(points / factor)[:, :2]
    lines: dict[str, Any] = {"edgecolors": rgba, "linewidths": 0.2} if len(order) > FINE else {"edgecolors": (1.0, 1.0, 1.0, 0.25), "linewidths": 0.3}
    drawn = plt.matplotlib.collections.PolyCollection(places[faces[order]], facecolors=rgba, rasterized=len(order) > 5000, **lines)
    _frame(axes, held / factor, [(np.asarray(at, float) / factor, np.asarray(normal, float)) for at, normal in planes])
    axes.add_collection(drawn)
    _axes(axes, held / factor, prefix)
    colour_bar(axes, mapped, label, shown)


def _frame(axes: Axes, points: Floats, planes: Sequence[tuple[Floats, Floats]]) -> None:
    """Set the limits around the body and the planes near it, and draw these behind it."""
    size = float(np.ptp(points, axis=0).max())
    low, high = view(points)[:, :2].min(axis=0), view(points)[:, :2].max(axis=0)
    for at, normal in planes:
        gaps = (points - at) @ normal
        if gaps.min() > NEAR * size:
            continue
        # A square on the plane below the body.
        first = np.cross(normal, [1.0, 0.0, 0.0] if abs(normal[0]) < 0.9 else [0.0, 1.0, 0.0])
        first /= np.linalg.norm(first)
        second = np.cross(normal, first)
        feet = points - gaps[:, None] * normal
        centre, reach = 0.5 * (feet.min(axis=0) + feet.max(axis=0)), (0.65 + DEPTH) * size
        corners = centre + reach * np.array([a * first + b * second for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
        seen = view(corners)[:, :2]
        low, high = np.minimum(low, seen.min(axis=0)), np.maximum(high, seen.max(axis=0))
        # A plane between the eye and the body hides nothing.
        style = {"facecolor": "#d9d9de"} if normal @ FROM > 0.0 else {"facecolor": "none"}
        axes.add_patch(pyplot().Polygon(seen, closed=True, edgecolor="#6e6e78", linewidth=0.8, zorder=0, **style))
    room = 0.05 * float((high - low).max())
    axes.set_xlim(low[0] - room, high[0] + room)
    axes.set_ylim(low[1] - room, high[1] + room)


def _axes(axes: Axes, points: Floats, prefix: str) -> None:
    """Show the directions and the extents of the body in place of the coordinates of the picture."""
    axes.set(aspect="equal", xticks=[], yticks=[])
    axes.set_frame_on(False)
    sides = " × ".join(f"{side:.4g}" for side in np.ptp(points, axis=0))
    axes.set_xlabel(f"{sides} {prefix}m")
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    reach = 0.09 * max(right - left, high - low)
    origin = np.array([left + reach, low + reach])
    for name, way in zip("xyz", view(np.eye(3))[:, :2], strict=True):
        tip = origin + reach * way
        axes.annotate("", tuple(tip), tuple(origin), arrowprops={"arrowstyle": "->", "color": "#282830", "linewidth": 0.9})
        axes.annotate(name, tuple(origin + 1.3 * reach * way), ha="center", va="center", color="#282830", fontsize="small")

