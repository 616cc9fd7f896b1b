"""Pictures of the error: over the elements, and over time."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from percute import _percute
from percute._percute import unit
from percute.checks import flag, number, one_of
from percute.error_results import ErrorResults
from percute.errors import InputError
from percute.pictures.body import Line, draw_bar, draw_body, linear, scale_of
from percute.pictures.canvas import (
    COLOURS,
    FIELD,
    Floats,
    exaggerated,
    legend_beside,
    new_axes,
    over_time,
    prefixed,
    root,
    save_figure,
    typeset,
    writable,
)
from percute.pictures.curves import draw_curve, mark_of_range

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PARTS = ("kinetic", "elastic", "dissipation", "contact")
SOURCES = ("surface", "front", "dispersion", "mesh")


def planes_of(estimate: ErrorResults) -> list[Line]:
    """Give the planes; an estimate from a file has them in its report."""
    if estimate.problem is not None:
        return [(each.point, each.normal) for each in estimate.problem.obstacles if each.point is not None]
    obstacles = json.loads(estimate.to_json())["problem"]["obstacles"]
    return [(each["point"], each["normal"]) for each in obstacles if each["point"] is not None]


def _displacement(estimate: ErrorResults) -> tuple[Floats, float]:
    """Give the displacement near the time of the sup, and its time: of the history, or of the maps of a file."""
    if estimate.history is not None:
        step = int(np.argmin(np.abs(estimate.history.time - estimate.time_of_sup)))
        return estimate.history._displacement_at(np.array([step]))[0], float(estimate.history.time[step])
    maps = [each for each in estimate.maps if each.displacement is not None]
    if not maps:
        raise InputError(
            "`scale` needs displacements, which the estimate has not; take it from its history, or store it with instants and fields"
        )
    nearest = min(maps, key=lambda each: abs(each.time - estimate.time_of_sup))
    assert nearest.displacement is not None
    return nearest.displacement, nearest.time


def _outline(estimate: ErrorResults) -> tuple[list[Floats], str]:
    """Give the deformed outline at the end and what it is; nothing of a bar, nor from files of earlier versions."""
    found = _percute.deformed_outline(estimate.mesh._data, estimate.to_json())
    return ([], "") if found is None else ([np.array(line) for line in found[0]], f"\n— {found[1]}")


def plot_map(estimate: ErrorResults, scale: float, outline: bool, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw e_E of each element (J^½), eq. [20]."""
    file, factor = writable("save", save, overwrite), number("scale", scale, finite=True)
    mesh, values, label = estimate.mesh, estimate.by_element, typeset(f"e_E ({unit('J^½', estimate.per_metre)})")
    lines, told = _outline(estimate) if flag("outline", outline) and factor == 0.0 else ([], "")
    places = mesh.points
    if factor != 0.0 and mesh.dimension == 2:
        moved, time = _displacement(estimate)
        places = places + factor * moved
        seconds, prefix = prefixed(np.array([time]))
        told = f"\n{exaggerated(factor)}, at t = {time / seconds:.4g} {prefix}s"
    axes = new_axes(axes)
    planes = planes_of(estimate)
    if mesh.dimension == 1:
        draw_bar(axes, places, mesh.cells, values, label, scale=linear(values, FIELD), planes=planes)
    else:
        draw_body(axes, places, mesh.cells, values, label, scale=scale_of(values), planes=planes, outline=lines)
    seconds, prefix = prefixed(np.array([estimate.end]))
    name = f"{Path(estimate._name).name}: " if estimate._name else ""
    norm = unit("J^½", estimate.per_metre)
    title = (
        f"Constitutive relation error {estimate.sup:.4g} {norm} ({100 * estimate.relative_sup:.3g} %)\n"
        f"{name}contribution of each element up to t = {estimate.end / seconds:.4g} {prefix}s; mean error {estimate.mean:.4g} {norm}{told}"
    )
    axes.set_title(typeset(title), fontsize="medium")
    save_figure(root(axes), file)
    return axes


def plot_over_time(estimate: ErrorResults, by: str, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw √η, with the square roots of its parts or of its sources."""
    file = writable("save", save, overwrite)
    one_of("by", by, ("parts", "sources"))
    if by == "sources" and estimate.sources is None:
        raise InputError('`by` is "sources", but the estimate has none; "corrected" separates them, for elastic materials with small strains')
    axes = new_axes(axes, (7.2, 4.0))
    samples = estimate.over_time
    time = samples.time / (seconds := over_time(axes, samples.time))
    bands = [draw_curve(axes, time, np.sqrt(np.maximum(samples.total, 0.0)), colour=COLOURS["total"], width=1.6, label="error √η")]
    values = samples if by == "parts" else estimate.sources.over_time  # type: ignore[union-attr]
    names = [name for name in PARTS if name != "dissipation" or np.any(samples.dissipation)]
    for name in names if by == "parts" else SOURCES:
        # A part may be below zero by rounding, a source a little more.
        part = np.sqrt(np.maximum(getattr(values, name), 0.0))
        label = f"{name} part" if by == "parts" else name
        bands.append(draw_curve(axes, time, part, colour=COLOURS[name], width=1.1, label=label))
    axes.axhline(estimate.mean, color="black", linestyle=":", linewidth=1, label="mean error")
    axes.plot(estimate.time_of_sup / seconds, estimate.sup, "ko", markersize=4, label="sup")
    axes.set_ylabel(typeset(f"error ({unit('J^½', estimate.per_metre)})"))
    axes.set_ylim(bottom=0.0)
    marks = [mark_of_range()] if any(bands) else []
    legend_beside(axes, handles=[*axes.get_legend_handles_labels()[0], *marks])
    save_figure(root(axes), file)
    return axes
