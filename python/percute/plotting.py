"""Pictures, with matplotlib (the extra ``plot``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute.checks import number, text, wrong
from percute.contents import instant
from percute.errors import InputError, PercuteError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

    from percute.estimation import Estimate
    from percute.history import History
    from percute.problem import Problem

Floats = NDArray[np.float64]

FIELD = "viridis"
SIGNED = "RdBu_r"


def _pyplot() -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise PercuteError('pictures need matplotlib: pip install "percute[plot]"') from error
    return plt


def _axes(axes: Axes | None) -> Axes:
    plt = _pyplot()
    if axes is not None and not isinstance(axes, plt.Axes):
        raise wrong("axes", axes, "axes of matplotlib, such as `plt.subplots()[1]`")
    made: Axes = axes if axes is not None else plt.subplots(layout="constrained")[1]
    return made


def _prefix(values: Floats) -> tuple[float, str]:
    """Give a power of a thousand for readable values, and its prefix."""
    largest = float(np.abs(values).max(initial=0.0))
    if largest == 0.0 or not np.isfinite(largest):
        return 1.0, ""
    power = int(np.clip(np.floor(np.log10(largest) / 3), -3, 3))
    return 1000.0**power, {-3: "n", -2: "µ", -1: "m", 0: "", 1: "k", 2: "M", 3: "G"}[power]


def _draw_body(axes: Axes, points: Floats, cells: Any, values: Floats, label: str, colours: str) -> None:
    """Draw values of nodes or elements on a plane body, with coordinates in a suitable unit."""
    if len(values) == 0:
        raise InputError("there is nothing to draw")
    factor, prefix = _prefix(points)
    x, y = points.T / factor
    limit = float(np.abs(values).max()) or 1.0
    low, high = (-limit, limit) if colours == SIGNED else (min(0.0, float(values.min())), limit)
    drawn: ScalarMappable
    if len(values) == len(cells):
        # Without anti-aliasing, which leaves light lines between neighbours.
        drawn = axes.tripcolor(
            x, y, facecolors=values, triangles=cells, cmap=colours, vmin=low, vmax=high, antialiased=False, rasterized=True
        )
    else:
        drawn = axes.tripcolor(
            x, y, values, triangles=cells, cmap=colours, vmin=low, vmax=high, shading="gouraud", rasterized=True
        )
    axes.set(aspect="equal", xlabel=f"x ({prefix}m)", ylabel=f"y ({prefix}m)")
    axes.margins(0.05)
    # As high as the body, for any shape.
    axes.figure.colorbar(drawn, cax=axes.inset_axes((1.03, 0.0, 0.04, 1.0)), label=label)


def _draw_bar(axes: Axes, points: Floats, cells: Any, values: Floats, label: str) -> None:
    """Draw values of nodes or elements along a bar."""
    factor, prefix = _prefix(points)
    x = points[:, 0] / factor
    if len(values) == len(cells):
        order = np.argsort(x[cells].min(axis=1))
        edges = np.append(x[cells].min(axis=1)[order], x.max())
        axes.stairs(values[order], edges, baseline=None)
    else:
        order = np.argsort(x)
        axes.plot(x[order], values[order])
    axes.set(xlabel=f"x ({prefix}m)", ylabel=label)
    axes.grid(alpha=0.3)


def plot_map(estimate: Estimate, axes: Axes | None) -> Axes:
    """Draw e_E of each element (J^½), eq. [20]."""
    axes = _axes(axes)
    mesh, label = estimate.mesh, "error of the element, $e_E$ (J$^{1/2}$)"
    if mesh.dimension == 1:
        _draw_bar(axes, mesh.points, mesh.cells, estimate.by_element, label)
    else:
        _draw_body(axes, mesh.points, mesh.cells, estimate.by_element, label, FIELD)
    axes.set_title(
        f"largest error {estimate.sup:.4g} J$^{{1/2}}$, {100 * estimate.relative_sup:.3g} % of the reference;\n"
        f"the squares add up to that of the mean error, ({estimate.mean:.4g} J$^{{1/2}}$)²"
    )
    return axes


def plot_over_time(estimate: Estimate, axes: Axes | None) -> Axes:
    """Draw √η and the shares of the parts of η."""
    axes = _axes(axes)
    over_time = estimate.over_time
    factor, prefix = _prefix(over_time.time)
    time = over_time.time / factor
    axes.plot(time, np.sqrt(over_time.total), color="black", label="error √η")
    for name in ("kinetic", "elastic", "contact"):
        # The contact part is a sum of terms that are zero to rounding where the law holds.
        axes.plot(time, np.sqrt(np.maximum(getattr(over_time, name), 0.0)), linewidth=1.2, label=f"{name} part")
    axes.axhline(estimate.mean, color="black", linestyle=":", linewidth=1, label="mean error")
    axes.plot(estimate.time_of_sup / factor, estimate.sup, "ko", markersize=4, label="sup")
    axes.set(xlabel=f"t ({prefix}s)", ylabel="error (J$^{1/2}$)")
    axes.set_ylim(bottom=0.0)
    axes.margins(x=0.0)
    axes.grid(alpha=0.3)
    axes.legend()
    return axes


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


def plot_field(history: History, quantity: str, step: int, scale: float, axes: Axes | None) -> Axes:
    """Draw a field of a history on the deformed body."""
    step = instant(history, step)
    scale = number("scale", scale, finite=True)
    values, name, unit, colours = field(history, text("quantity", quantity), step)
    axes = _axes(axes)
    mesh = history.problem.mesh
    factor, prefix = _prefix(values)
    label = f"{name} ({prefix}{unit})"
    if mesh.dimension == 1:
        _draw_bar(axes, mesh.points, mesh.cells, values / factor, label)
    else:
        places = mesh.points + scale * history.displacement[step]
        _draw_body(axes, places, mesh.cells, values / factor, label, colours)
    seconds, prefix = _prefix(history.time[step : step + 1])
    axes.set_title(f"t = {history.time[step] / seconds:.4g} {prefix}s")
    return axes
