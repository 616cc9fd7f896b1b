"""Pictures of histories: fields on the deformed body, and energies over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from percute._percute import unit
from percute.checks import number, one_of
from percute.element_fields import element_field, instant
from percute.pictures.body import Line, Scale, draw_bar, draw_body
from percute.pictures.canvas import (
    COLOURS,
    FIELD,
    SIGNED,
    Floats,
    exaggerated,
    legend_beside,
    new_axes,
    over_time,
    prefixed,
    root,
    save_figure,
    writable,
)
from percute.pictures.surface import draw_solid
from percute.steps import Steps

if TYPE_CHECKING:
    from matplotlib.axes import Axes

WORKS = {
    "work_of_loads": "work of loads",
    "work_of_supports": "work of supports",
    "work_of_contact": "work of contact",
    "friction": "dissipated by friction",
}


MOTION = {"displacement": "m", "velocity": "m/s", "acceleration": "m/s²"}
STRESSES = {"stress_xx": (0, 0), "stress_yy": (1, 1), "stress_xy": (0, 1)}
OF_SOLIDS = {"stress_zz": (2, 2), "stress_yz": (1, 2), "stress_xz": (0, 2)}
SCALARS = {
    "von_mises": ("von Mises stress", "Pa", FIELD),
    "pressure": ("pressure", "Pa", SIGNED),
    "equivalent_plastic_strain": ("equivalent plastic strain", "%", FIELD),
    "strain_energy": ("strain energy of the element", "J", FIELD),
    "kinetic_energy": ("kinetic energy of the element", "J", FIELD),
}


def field(history: Steps, quantity: object, step: int) -> tuple[Floats, str, str, str]:
    """Give the values of a quantity at an instant, with its name, unit and colours."""
    bar, stresses = history.problem.mesh.dimension == 1, STRESSES | (OF_SOLIDS if history.problem.mesh.dimension == 3 else {})
    name = one_of("quantity", quantity, (*MOTION, *(("stress", *list(SCALARS)[2:]) if bar else (*SCALARS, *stresses))))
    if name in MOTION:
        vectors: Floats = getattr(history, name)[step]
        return vectors[:, 0] if bar else np.linalg.norm(vectors, axis=1), name, MOTION[name], FIELD
    if name == "stress":
        return element_field(history, name, step)[:, 0, 0], name, "Pa", FIELD
    if name in stresses:
        row, column = stresses[name]
        return element_field(history, "stress", step)[:, row, column], f"stress σ$_{{{name[-2:]}}}$", "Pa", SIGNED
    told, of, colours = SCALARS[name]
    values = element_field(history, name, step)
    return (100.0 * values if of == "%" else values), told, unit(of, history.problem.per_metre), colours


def plot_field(
    history: Steps, quantity: str, step: int, scale: float, axes: Axes | None, save: object, overwrite: object
) -> Axes:
    """Draw a field of a history on the deformed body."""
    file, row = writable("save", save, overwrite), instant(history, step)
    factor = number("scale", scale, finite=True)
    found = field(history, quantity, row)
    axes = new_axes(axes)
    draw_field(axes, history, row, factor, found)
    save_figure(root(axes), file)
    return axes


def draw_field(
    axes: Axes,
    history: Steps,
    step: int,
    scale: float,
    found: tuple[Floats, str, str, str],
    span: tuple[float, float] | None = None,
    extent: Floats | None = None,
) -> None:
    """Draw a field on axes. A frame of an animation has the range of the values and the outermost places (m) of all frames."""
    values, name, unit, colours = found
    mesh = history.problem.mesh
    factor, prefix = (1.0, "") if unit == "%" else prefixed(values if span is None else np.array(span))
    label = f"{name} ({prefix}{unit})"
    planes: list[Line] = [(each.point, each.normal) for each in history.problem.obstacles if each.point is not None]
    limits = None if span is None else Scale(span[0] / factor, span[1] / factor)
    if mesh.dimension == 1:
        draw_bar(axes, mesh.points, mesh.cells, values / factor, label, scale=limits, planes=planes)
    else:
        places = mesh.points + scale * history._displacement_at(np.array([step]))[0]
        draw = draw_solid if mesh.dimension == 3 else draw_body
        draw(axes, places, mesh.cells, values / factor, label, colours=colours, scale=limits, planes=planes, extent=extent)
    seconds, small = prefixed(history.time[step : step + 1])
    told = "" if mesh.dimension == 1 else f", {exaggerated(scale)}"
    axes.set_title(f"t = {history.time[step] / seconds:.4g} {small}s{told}", fontsize="medium")


def plot_energies(values: Mapping[str, Any], axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw energies and works over time; ``values`` are those of a `Balance`, by name."""
    file = writable("save", save, overwrite)
    axes = new_axes(axes, (7.2, 4.0))
    total = values["kinetic"] + values["strain"] + values["plastic_work"]
    factor, prefix = prefixed(np.concatenate([total, *(values[name] for name in WORKS)]))
    time = values["time"] / over_time(axes, values["time"])
    yields = bool(np.any(values["plastic_work"]))
    axes.plot(time, total / factor, color=COLOURS["total"], linewidth=1.6, label="kinetic + strain" + (" + plastic work" if yields else ""))
    for name in ("kinetic", "strain", *(["plastic_work"] if yields else [])):
        axes.plot(time, values[name] / factor, color=COLOURS[name], linewidth=1.3, label=name.replace("_", " "))
    # Works that are zero to rounding would only fill the legend.
    least = 1e-9 * float(np.abs(total).max(initial=0.0))
    for name, label in WORKS.items():
        if np.abs(values[name]).max(initial=0.0) > least:
            axes.plot(time, values[name] / factor, color=COLOURS[name], linewidth=1.1, linestyle="--", label=label)
    axes.set_ylabel(f"energy ({prefix}{unit('J', values['per_metre'])})")
    legend_beside(axes)
    save_figure(root(axes), file)
    return axes
