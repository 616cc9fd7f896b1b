"""Figures of the evidence: curves in panels, heat maps, values on meshes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.errors import PercuteError
from percute.pictures.canvas import typeset
from studies.page import Section, short

try:
    from matplotlib import colormaps, colors, rc_context
    from matplotlib.figure import Figure as Drawing
    from matplotlib.text import Text
    from matplotlib.ticker import NullLocator
except ImportError:
    raise PercuteError('the figures need matplotlib: pip install matplotlib')

__all__ = ["Colours", "Curve", "Drawing", "around_one", "between", "draw", "heat_maps", "lines", "mesh_maps", "ordered", "own", "ratio", "save"]

PALETTE = ("#2f79c8", "#da6228", "#24966e", "#9b55be", "#c83c64", "#967d1e", "#1496af", "#828791", "#a56450")
INK, FAINT, GRID = "#282830", "#6e6e78", "#e1e2e8"
AROUND = ("#214b8c", "#78aad7", "#f0eee2", "#ec965a", "#a02823")
STYLE: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.0,
    "legend.frameon": False,
    "svg.hashsalt": "percute",
    "svg.fonttype": "path",
}
WIDTHS, HEIGHTS = (7.2, 8.6, 9.2), (3.7, 2.9, 2.6)
"""Width of a figure and height of a panel, by the number of columns (inch)."""


@dataclass(frozen=True)
class Curve:
    """A curve; it is broken where a value is not finite. Curves of one name have one entry in the legend."""

    name: str
    x: Sequence[float] | NDArray[np.float64]
    y: Sequence[float] | NDArray[np.float64]
    colour: str = INK
    dashed: bool = False
    marked: bool = False


@dataclass(frozen=True)
class Colours:
    """The colours of values, with the label of their bar."""

    label: str
    norm: colors.Normalize
    map: colors.Colormap
    ticks: Sequence[float] | None = None


def own(index: int) -> str:
    """Give one of nine colours that are easily told apart."""
    return PALETTE[index % len(PALETTE)]


def ordered(place: float) -> str:
    """Give a colour of an ordered family, from 0 (dark) to 1 (light)."""
    return colors.to_hex(colormaps["viridis"](0.28 + 0.54 * min(max(place, 0.0), 1.0)))


def between(label: str, low: float, high: float) -> Colours:
    """Give colours from dark to light between two values."""
    return Colours(label, colors.Normalize(low, high if high > low else low + 1.0), colormaps["viridis"])


def ratio(label: str, low: float, high: float) -> Colours:
    """Give colours from dark to light between two positive values, in equal ratios."""
    high = high if high > low else 2.0 * low
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)))
    ticks = [digit * 10.0**power for power in powers for digit in (1, 2, 5) if low <= digit * 10.0**power <= high]
    return Colours(label, colors.LogNorm(low, high), colormaps["viridis"], ticks)


def around_one(label: str, factor: float) -> Colours:
    """Give colours that are blue below 1, pale at 1 and red above, from 1/``factor`` to ``factor``: for effectivities."""
    ticks = [tick for tick in (0.1, 0.25, 0.5, 1.0, 2.0, 4.0, 10.0) if 1 / factor <= tick <= factor]
    return Colours(label, colors.LogNorm(1 / factor, factor), colors.LinearSegmentedColormap.from_list("around", AROUND), ticks)


def _panels(count: int, columns: int, height: float | None = None, *, shared: bool = True) -> tuple[Drawing, list[Any]]:
    """Give a figure with so many panels, in rows."""
    columns = min(columns, count)
    rows = math.ceil(count / columns)
    size = WIDTHS[columns - 1], rows * (height or HEIGHTS[columns - 1]) + 0.5
    figure = Drawing(figsize=size, layout="constrained")
    axes = list(figure.subplots(rows, columns, sharex=shared, sharey=shared, squeeze=False).flat)
    for unused in axes[count:]:
        unused.set_visible(False)
    return figure, axes[:count]


def _ticks(axis: Any, ticks: Sequence[float]) -> None:
    axis.set_ticks(list(ticks), [f"{tick:g}" for tick in ticks])
    axis.set_minor_locator(NullLocator())


def lines(
    panels: Sequence[tuple[str, Sequence[Curve]]],
    x: str | Sequence[str],
    y: str | Sequence[str],
    *,
    log: str = "",
    columns: int = 1,
    band: tuple[float, float] | None = None,
    xticks: Sequence[float] | None = None,
    yticks: Sequence[float] | None = None,
    zero: bool = False,
) -> Drawing:
    """Draw curves in panels with one legend below.

    ``panels`` are titles with curves. They have the same axes, unless ``x`` and ``y`` are lists with a label for each.
    ``log`` names the logarithmic axes ("x", "y" or "xy"), ``band`` is a range of y that is marked, ``zero`` lets y begin at 0.
    """
    with rc_context(STYLE):
        shared = isinstance(x, str) and isinstance(y, str)
        labels = [[x] * len(panels) if isinstance(x, str) else x, [y] * len(panels) if isinstance(y, str) else y]
        figure, all_axes = _panels(len(panels), columns, shared=shared)
        entries: dict[str, Any] = {}
        for axes, (title, curves), across, up in zip(all_axes, panels, *labels, strict=True):
            for k, curve in enumerate(curves):
                # The first curve lies over the others.
                look = {"color": curve.colour, "ls": "--" if curve.dashed else "-", "marker": "o" if curve.marked else None, "zorder": 3 - k / 100}
                (entry,) = axes.plot(curve.x, curve.y, **look)
                entries.setdefault(curve.name, entry)
            if band is not None:
                axes.axhspan(*band, color=PALETTE[2], alpha=0.14, linewidth=0)
            axes.set_title(title)
            axes.set(xlabel=across, ylabel=up)
            if "x" in log:
                axes.set_xscale("log")
            if "y" in log:
                axes.set_yscale("log")
            for axis in (axes.xaxis, axes.yaxis):
                if axis.get_scale() == "log":
                    axis.set_major_formatter("{x:g}")
                    axis.set_minor_formatter("{x:g}")
            axes.tick_params(which="both", labelbottom=True, labelleft=True)
        if xticks is not None:
            _ticks(all_axes[0].xaxis, xticks)
        if yticks is not None:
            _ticks(all_axes[0].yaxis, yticks)
        if zero:
            all_axes[0].set_ylim(bottom=0.0)
        if any(entries):
            _legend(figure, entries)
    return figure


def _legend(figure: Drawing, entries: dict[str, Any]) -> None:
    """Put the legend below the panels, in as few rows as its width allows."""
    for rows in range(1, len(entries) + 1):
        columns = math.ceil(len(entries) / rows)
        legend = figure.legend(list(entries.values()), list(entries), loc="outside lower center", ncols=columns)
        if columns == 1 or legend.get_window_extent().width < figure.bbox.width:
            return
        legend.remove()


def heat_maps(
    maps: Sequence[tuple[str, Any]],
    x: tuple[str, Sequence[str]],
    y: tuple[str, Sequence[str]],
    colours: Colours,
    *,
    columns: int = 1,
    digits: int = 2,
) -> Drawing:
    """Draw a value for each cell of a grid, in panels with one bar of colours.

    ``maps`` are titles with arrays (rows from below, columns), NaN where there is none; ``x`` and ``y`` are a name and a text
    for each column and row. Values are written where there is room.
    """
    with rc_context(STYLE | {"axes.grid": False, "axes.spines.left": False, "axes.spines.bottom": False}):
        figure, all_axes = _panels(len(maps), columns)
        image = None
        room = len(x[1]) * columns <= 30
        for axes, (title, values) in zip(all_axes, maps, strict=True):
            grid = np.asarray(values, dtype=float).reshape(len(y[1]), len(x[1]))
            image = axes.imshow(np.ma.masked_invalid(grid), origin="lower", aspect="auto", cmap=colours.map, norm=colours.norm)
            for (row, column), value in np.ndenumerate(grid):
                if room and np.isfinite(value):
                    red, green, blue, _ = colours.map(colours.norm(value))
                    ink = "#141416" if 0.299 * red + 0.587 * green + 0.114 * blue > 0.55 else "#fcfcfc"
                    text = short(float(value), digits).replace("-", "−")
                    axes.text(column, row, text, ha="center", va="center", fontsize=6.5, color=ink)
            axes.set_title(title)
            axes.set(xlabel=x[0], ylabel=y[0])
            axes.tick_params(labelbottom=True, labelleft=True, length=0)
        every = max(1, math.ceil(len(x[1]) * columns / 40))
        all_axes[0].set_xticks(range(0, len(x[1]), every), list(x[1])[::every])
        all_axes[0].set_yticks(range(len(y[1])), list(y[1]))
        _bar(figure, image, all_axes, colours)
    return figure


def mesh_maps(
    maps: Sequence[tuple[str, Any, Any]],
    colours: Colours,
    *,
    columns: int = 1,
    plane: float | None = None,
) -> Drawing:
    """Draw a value for each triangle of meshes, in panels with one bar of colours.

    ``maps`` are titles with a mesh, or any object with ``points`` and ``cells``, and a value for each element; ``plane`` is the
    height of a horizontal rigid plane (m), which is grey.
    """
    with rc_context(STYLE | {"axes.grid": False}):
        corners = 1e3 * np.concatenate([mesh.points for _, mesh, _ in maps])
        room = 0.04 * np.ptp(corners, axis=0).max()
        (left, low), (right, high) = corners.min(axis=0) - room, corners.max(axis=0) + room
        columns = min(columns, len(maps))
        height = (WIDTHS[columns - 1] / columns - 0.75) * (high - low) / (right - left) + 0.5
        figure, all_axes = _panels(len(maps), columns, height)
        image = None
        for axes, (title, mesh, values) in zip(all_axes, maps, strict=True):
            x, y = 1e3 * mesh.points.T
            # Values below the scale have its lowest colour; on a logarithmic one zero would have none.
            look = {"cmap": colours.map, "norm": colours.norm, "antialiased": False, "rasterized": True, "snap": False}
            image = axes.tripcolor(x, y, mesh.cells, facecolors=np.clip(values, colours.norm.vmin, None), **look)
            if plane is not None:
                axes.axhspan(low, 1e3 * plane, color=GRID, linewidth=0)
                axes.axhline(1e3 * plane, color=FAINT, linewidth=1.0)
            axes.set_title(title)
            axes.set(aspect="equal", xlim=(left, right), ylim=(low, high), xlabel="x (mm)", ylabel="y (mm)")
            axes.label_outer()
        _bar(figure, image, all_axes, colours)
    return figure


def _bar(figure: Drawing, image: Any, axes: list[Any], colours: Colours) -> None:
    bar = figure.colorbar(image, ax=axes, shrink=0.8, fraction=0.05, pad=0.02)
    bar.set_label(colours.label)
    bar.outline.set_visible(False)
    if colours.ticks is not None:
        _ticks(bar.ax.yaxis, colours.ticks)


def save(figure: Drawing, file: Path) -> None:
    """Write a figure as SVG and PNG; ``file`` has no ending."""
    for text in figure.findobj(Text):
        text.set_text(typeset(text.get_text()))
    with rc_context(STYLE):
        figure.savefig(file.with_name(file.name + ".svg"), metadata={"Date": None})
        figure.savefig(file.with_name(file.name + ".png"), dpi=160, metadata={"Software": None})


def draw(folder: Path, section: Section) -> dict[str, str]:
    """Write the figures of a section, which takes seconds; give their SVG by their keys."""
    if section.figures:
        (folder / "figures").mkdir(exist_ok=True)
    for figure in section.figures:
        save(figure.drawing, folder / "figures" / figure.key)
    return {figure.key: (folder / "figures" / f"{figure.key}.svg").read_text(encoding="utf-8") for figure in section.figures}
