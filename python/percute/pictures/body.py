"""Values on the mesh of a body, with planes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.errors import InputError
from percute.mesh_arrays import boundary
from percute.pictures.canvas import FIELD, SIGNED, Floats, prefixed, pyplot, typeset

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

LINES = 0.012
"""Mesh lines are drawn if the mean size of the elements exceeds this part of the size of the body."""
NEAR = 0.25
"""A plane is in the picture if its distance is at most this part of the size of the body."""
SLIM = 0.4
"""Below this ratio of height to width, the colours are shown below the body."""
DEPTH = 0.03
"""Room behind a plane, as a part of the size of the body."""
HATCH = 0.013
"""Distance of the strokes behind a plane, as a part of the larger side of the picture."""
MARKS = 8
"""About so many marks at a scale of colours."""

Line = tuple[ArrayLike, ArrayLike]
"""A point (m) and the outward unit normal of a plane."""


class Scale(NamedTuple):
    """The colours of values."""

    low: float
    high: float
    logarithmic: bool = False
    marks: Sequence[tuple[float, str]] = ()
    """Values with marks, and their labels."""

    def norm(self) -> Normalize:
        """Give it to matplotlib."""
        colours = pyplot().matplotlib.colors
        made: Normalize = (colours.LogNorm if self.logarithmic else colours.Normalize)(self.low, self.high)
        return made


def scale_of(values: Floats) -> Scale:
    """Give the scale of values that are not negative, as in the pictures of the command: logarithmic where a few elements outshine the rest."""
    return Scale(*_percute.colour_scale(np.ascontiguousarray(values, dtype=np.float64), MARKS))


def linear(values: Floats, colours: str) -> Scale:
    """Make a linear scale that contains zero, in its middle for signed values."""
    limit = float(np.abs(values).max()) or 1.0
    return Scale(-limit, limit) if colours == SIGNED else Scale(min(0.0, float(values.min())), limit)


def draw_body(
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
    outline: Sequence[Floats] = (),
) -> None:
    """Draw values of nodes or elements on a plane body with its mesh lines and planes, coordinates in a suitable unit.

    ``extent`` has points (m) that the picture must hold, by default those of the body, and ``outline`` lines (m) over it.
    """
    if len(values) == 0:
        raise InputError("there is nothing to draw")
    held = np.vstack([points if extent is None else extent, *outline])
    factor, prefix = prefixed(held)
    x, y = points.T / factor
    shown = linear(values, colours) if scale is None else scale
    style: dict[str, Any] = {"cmap": colours, "norm": shown.norm(), "rasterized": len(cells) > 5000}
    clipped = np.maximum(values, shown.low) if shown.logarithmic else values
    if len(values) == len(cells):
        # Without anti-aliasing, which leaves light lines between neighbours.
        drawn = axes.tripcolor(x, y, facecolors=clipped, triangles=cells, antialiased=False, **style)
    else:
        drawn = axes.tripcolor(x, y, clipped, triangles=cells, shading="gouraud", **(style | {"rasterized": True}))
    if _size(points, cells) > LINES:
        # In two colours, so that lines are seen on dark and on light elements.
        axes.triplot(x, y, cells, color="white", linewidth=0.35, alpha=0.5)
    if colours == SIGNED:
        # Small values are as light as the paper.
        edges = np.column_stack([x, y])[boundary(cells)[0]]
        axes.add_collection(pyplot().matplotlib.collections.LineCollection(edges, colors="#6e6e78", linewidths=0.6))
    for colour, width in (("white", 3.0), ("#282830", 1.2)) if outline else ():
        # Seen on dark and on light elements.
        lines = pyplot().matplotlib.collections.LineCollection([line / factor for line in outline], colors=colour, linewidths=width, zorder=4)
        axes.add_collection(lines)
    axes.set(aspect="equal", xlabel=f"x ({prefix}m)", ylabel=f"y ({prefix}m)")
    _frame(axes, held / factor, [(np.asarray(at, float) / factor, np.asarray(normal, float)) for at, normal in planes])
    colour_bar(axes, drawn, label, shown)


def colour_bar(axes: Axes, drawn: ScalarMappable, label: str, scale: Scale) -> None:
    """Draw the scale of colours: as high as the body, or below a slim one."""
    width, height = np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())
    if height < SLIM * width:
        place: dict[str, Any] = {"ax": axes, "location": "bottom", "aspect": 40, "shrink": 0.8}
    else:
        place = {"cax": axes.inset_axes((1.03, 0.0, 0.04, 1.0))}
    bar = axes.figure.colorbar(drawn, label=label + (", logarithmic" if scale.logarithmic else ""), **place)
    if scale.logarithmic:
        bar.set_ticks([value for value, _ in scale.marks], labels=[typeset(text) for _, text in scale.marks])
    bar.minorticks_off()


def _size(points: Floats, cells: NDArray[Any]) -> float:
    """Give the mean size of the elements as a part of the size of the body."""
    a, b, c = points[cells[:, 0]], points[cells[:, 1]], points[cells[:, 2]]
    areas = 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    return float(np.sqrt(areas.mean()) / np.ptp(points, axis=0).max())


def _frame(axes: Axes, points: Floats, planes: Sequence[tuple[Floats, Floats]]) -> None:
    """Set the limits around the body and the planes near it, and draw these."""
    low, high = points.min(axis=0), points.max(axis=0)
    size = float((high - low).max())
    near = []
    for at, normal in planes:
        gaps = (points - at) @ normal
        nearest = int(np.argmin(gaps))
        if gaps[nearest] <= NEAR * size:
            near.append((at, normal))
            foot = points[nearest] - (max(gaps[nearest], 0.0) + DEPTH * size) * normal
            low, high = np.minimum(low, foot), np.maximum(high, foot)
    low, high = low - 0.05 * size, high + 0.05 * size
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    for at, normal in near:
        _draw_plane(axes, at, normal, (low, high))


def _draw_plane(axes: Axes, at: Floats, normal: Floats, frame: tuple[Floats, Floats]) -> None:
    """Draw a plane as a line, hatched on its far side."""
    along = np.array([normal[1], -normal[0]])
    centre, reach = 0.5 * (frame[0] + frame[1]), float(np.linalg.norm(frame[1] - frame[0]))
    foot = centre - ((centre - at) @ normal) * normal
    ends = np.array([foot - reach * along, foot + reach * along])
    apart = HATCH * float((frame[1] - frame[0]).max())
    starts = foot + np.arange(-reach, reach, apart)[:, None] * along
    strokes = np.stack([starts, starts - apart * (along + normal)], axis=1)
    axes.add_collection(pyplot().matplotlib.collections.LineCollection(strokes, colors="#282830", linewidths=0.8, zorder=0.5), autolim=False)
    axes.plot(ends[:, 0], ends[:, 1], color="#282830", linewidth=1.5, zorder=3)


def draw_bar(
    axes: Axes,
    points: Floats,
    cells: NDArray[Any],
    values: Floats,
    label: str,
    *,
    scale: Scale | None = None,
    planes: Sequence[Line] = (),
) -> None:
    """Draw values of nodes or elements along a bar."""
    factor, prefix = prefixed(points)
    x = points[:, 0] / factor
    if len(values) == len(cells):
        order = np.argsort(x[cells].min(axis=1))
        edges = np.append(x[cells].min(axis=1)[order], x.max())
        axes.stairs(values[order], edges, baseline=None)
    else:
        order = np.argsort(x)
        axes.plot(x[order], values[order])
    if scale is not None:
        room = 0.05 * (scale.high - scale.low)
        axes.set_ylim(scale.low - room if scale.low < 0.0 else scale.low, scale.high + room)
    axes.set(xlabel=f"x ({prefix}m)", ylabel=label)
    axes.grid(alpha=0.3)
    length = float(np.ptp(x))
    for at, normal in planes:
        place, side = float(np.ravel(at)[0]) / factor, float(np.ravel(normal)[0])
        if min(abs(x - place)) <= NEAR * length:
            axes.axvspan(place - side * DEPTH * length, place, facecolor="none", edgecolor="#6e6e78", hatch="//////", linewidth=0.0)
            axes.axvline(place, color="#282830", linewidth=1.5)
