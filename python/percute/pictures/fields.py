"""Pictures of histories: fields on the deformed body, and energies over time."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np

from percute.checks import number, text
from percute.contents import instant
from percute.errors import InputError
from percute.pictures.body import Line, Scale, draw_bar, draw_body
from percute.pictures.canvas import (
    COLOURS,
    FIELD,
    SIGNED,
    Floats,
    legend_beside,
    new_axes,
    over_time,
    prefixed,
    root,
    save_figure,
    writable,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from percute.estimation import Estimate
    from percute.history import History
    from percute.problem import Problem

WORKS = {
    "work_of_loads": "work of loads",
    "work_of_supports": "work of supports",
    "work_of_contact": "work of contact",
    "friction": "dissipated by friction",
}


def _stress(problem: Problem, displacement: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """σ_xx, σ_yy, σ_xy, σ_zz of each element (Pa)."""
    mesh = problem.mesh
    corners, moves = mesh.points[mesh.cells], displacement[mesh.cells]
    along, across, shear, out_of_plane = problem._data.stiffness()
    edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
    changes = np.swapaxes(moves[:, 1:] - moves[:, :1], 1, 2)
    gradient = changes @ np.linalg.inv(edges)
    if mesh.dimension == 1:
        xx = along * gradient[:, 0, 0]
        zero = np.zeros_like(xx)
        return xx, zero, zero, zero
    exx, eyy = gradient[:, 0, 0], gradient[:, 1, 1]
    xy = shear * (gradient[:, 0, 1] + gradient[:, 1, 0])
    return along * exx + across * eyy, across * exx + along * eyy, xy, out_of_plane * (exx + eyy)


def field(history: History, quantity: str, step: int) -> tuple[Floats, str, str, str]:
    """Give the values of a quantity at a step, with its name, unit and colours."""
    problem = history.problem
    bar = problem.mesh.dimension == 1
    if quantity in ("displacement", "velocity"):
        vectors: Floats = getattr(history, quantity)[step]
        values: Floats = vectors[:, 0] if bar else np.linalg.norm(vectors, axis=1)
        return values, quantity, "m" if quantity == "displacement" else "m/s", FIELD
    known = ("displacement", "velocity", "stress") if bar else ("displacement", "velocity", "von_mises", "pressure")
    if quantity not in known:
        raise InputError(f"`quantity` is {quantity!r}; it must be one of {', '.join(known)}")
    xx, yy, xy, zz = _stress(problem, history.displacement[step])
    if quantity == "stress":
        return xx, "stress", "Pa", FIELD
    if quantity == "pressure":
        return -(xx + yy + zz) / 3, "pressure", "Pa", SIGNED
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    return np.sqrt(squares / 2 + 3 * xy**2), "von Mises stress", "Pa", FIELD


def plot_field(
    history: History, quantity: str, step: int, scale: float, axes: Axes | None, save: object, overwrite: object
) -> Axes:
    """Draw a field of a history on the deformed body."""
    file, row = writable("save", save, overwrite), instant(history, step)
    factor = number("scale", scale, finite=True)
    found = field(history, text("quantity", quantity), row)
    axes = new_axes(axes)
    draw_field(axes, history, row, factor, found)
    save_figure(root(axes), file)
    return axes


def draw_field(
    axes: Axes, history: History, step: int, scale: float, found: tuple[Floats, str, str, str], span: tuple[float, float] | None = None
) -> None:
    """Draw a field on axes, by default with a scale of its own."""
    values, name, unit, colours = found
    mesh = history.problem.mesh
    factor, prefix = prefixed(values if span is None else np.array(span))
    label = f"{name} ({prefix}{unit})"
    planes: list[Line] = [(each.point, each.normal) for each in history.problem.obstacles]
    limits = None if span is None else Scale(span[0] / factor, span[1] / factor)
    if mesh.dimension == 1:
        draw_bar(axes, mesh.points, mesh.cells, values / factor, label, scale=limits, planes=planes)
    else:
        places = mesh.points + scale * history.displacement[step]
        draw_body(axes, places, mesh.cells, values / factor, label, colours=colours, scale=limits, planes=planes)
    seconds, small = prefixed(history.time[step : step + 1])
    axes.set_title(f"t = {history.time[step] / seconds:.4g} {small}s", fontsize="medium")


def plot_energies(subject: History | Estimate, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw energies and works over time."""
    file = writable("save", save, overwrite)
    values = _energies(subject)
    axes = new_axes(axes, (7.2, 4.0))
    total = values["kinetic"] + values["strain"]
    factor, prefix = prefixed(np.concatenate([total, *(values[name] for name in WORKS)]))
    time = values["time"] / over_time(axes, values["time"])
    axes.plot(time, total / factor, color=COLOURS["total"], linewidth=1.6, label="kinetic + strain")
    for name in ("kinetic", "strain"):
        axes.plot(time, values[name] / factor, color=COLOURS[name], linewidth=1.3, label=name)
    # Works that are zero to rounding would only fill the legend.
    least = 1e-9 * float(np.abs(total).max(initial=0.0))
    for name, label in WORKS.items():
        if np.abs(values[name]).max(initial=0.0) > least:
            axes.plot(time, values[name] / factor, color=COLOURS[name], linewidth=1.1, linestyle="--", label=label)
    axes.set_ylabel(f"energy ({prefix}J)")
    legend_beside(axes)
    save_figure(root(axes), file)
    return axes


def _energies(subject: History | Estimate) -> dict[str, Floats]:
    """Give energies and works over time: of a history, or from the report of an estimate."""
    from percute.history import History

    history = subject if isinstance(subject, History) else subject.history
    names = ("time", "kinetic", "strain", *WORKS)
    if history is not None:
        return {name: getattr(history.balance, name) for name in names}
    assert not isinstance(subject, History)
    columns = json.loads(subject.to_json()).get("balance_over_time")
    if columns is None:
        raise InputError("the estimate has no energies; take them from its history")
    return {name: np.array(columns[name], dtype=np.float64) for name in names}
