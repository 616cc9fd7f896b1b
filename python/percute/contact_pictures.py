"""Pictures of contact, with matplotlib (the extra ``plot``)."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute._percute import unit
from percute.checks import one_of, whole, wrong
from percute.contact_results import ContactResults, ContactStatus
from percute.errors import InputError
from percute.pictures.canvas import FIELD, Floats, legend_beside, new_axes, over_time, prefixed, pyplot, root, save_figure, writable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOURS = {ContactStatus.STICK: "#1f5fa8", ContactStatus.SLIP: "#e8862e"}
MOST_COLUMNS = 2000
"""Largest number of drawn steps; more are thinned out."""


def plot_contact(contact: ContactResults, colour: str, axes: Sequence[Axes] | None, save: object, overwrite: object) -> list[Axes]:
    """Draw the resultant forces over time, and the zone of contact of each plane over time."""
    file = writable("save", save, overwrite)
    one_of("colour", colour, ("status", "pressure"))
    _check(contact)
    _has_line(contact)
    panels = _panels(axes, 1 + len(contact._names))
    _draw_forces(panels[0], contact)
    for plane, panel in zip(contact._names, panels[1:], strict=True):
        _draw_zone(panel, contact, plane, colour)
    # New axes share the time; only the last one is labelled.
    for panel in panels[-1:] if axes is None else panels:
        panel.set_xlabel(f"t ({prefixed(contact.time)[1]}s)")
    save_figure(root(panels[0]), file)
    return panels


def plot_force(contact: ContactResults, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw the resultant forces of each plane over time."""
    file, results = writable("save", save, overwrite), _check(contact)
    axes = new_axes(axes, (7.2, 4.0))
    over_time(axes, results.time)
    _draw_forces(axes, results)
    save_figure(root(axes), file)
    return axes


def plot_pressure(contact: ContactResults, plane: int | None, axes: Axes | None, save: object, overwrite: object) -> Axes:
    """Draw the pressure along the surface over time; of a bar, the pressure of its end."""
    file, results = writable("save", save, overwrite), _check(contact)
    _has_line(results)
    if plane is None:
        chosen = max(results._names, key=lambda k: results.obstacles[k].normal_force.max(initial=0.0))
    else:
        chosen = whole("plane", plane, least=0, most=len(results.obstacles) - 1)
    axes = new_axes(axes, (7.2, 4.0))
    over_time(axes, results.time)
    if results.mesh.dimension == 1:
        _draw_ends(axes, results, chosen)
    else:
        axes.grid(False)
        _draw_zone(axes, results, chosen, "pressure")
    save_figure(root(axes), file)
    return axes


def _has_line(contact: ContactResults) -> None:
    """Refuse the surface of a solid, which is not a line."""
    if contact.mesh.dimension == 3:
        raise InputError("the zone of contact over time is drawn along the line of a plane body; of a solid, export the pressure for ParaView, or plot_force()")


def _draw_ends(axes: Axes, contact: ContactResults, plane: int) -> None:
    """Draw the pressure of the ends of a bar that may touch a plane."""
    seconds = prefixed(contact.time)[0]
    factor, prefix = prefixed(contact.pressure)
    for row in np.flatnonzero(contact.obstacle == plane):
        axes.plot(contact.time / seconds, contact.pressure[:, row] / factor, label=f"node {contact.nodes[row]}")
    axes.set_ylabel(f"contact pressure ({prefix}Pa)")
    legend_beside(axes)


def _check(contact: ContactResults) -> ContactResults:
    """Make sure that there is something to draw."""
    if not contact.obstacles or len(contact.time) < 2:
        what = "the history has one instant only" if contact.obstacles else "the problem has no planes and no interfaces"
        raise InputError(f"there is nothing to draw: {what}")
    return contact


def _panels(axes: Sequence[Axes] | None, count: int) -> list[Axes]:
    """Give some axes, by default one below the other with a common time."""
    if axes is None:
        size = (6.8, 2.6 + 2.6 * (count - 1))
        return list(pyplot().subplots(count, sharex=True, layout="constrained", figsize=size)[1])
    given = list(axes) if isinstance(axes, Sequence | np.ndarray) else [axes]
    if len(given) != count:
        raise wrong("axes", axes, f"{count} axes of matplotlib: one for the forces and one for each plane or interface")
    return [new_axes(each) for each in given]


def _draw_forces(axes: Axes, contact: ContactResults) -> None:
    """Draw normal and tangential resultants of each plane."""
    seconds, _ = prefixed(contact.time)
    factor, prefix = prefixed(contact.resultants.normal_force)
    several = len(contact._names) > 1
    for at, (plane, name) in enumerate(contact._names.items()):
        resultants = contact.obstacles[plane]
        of, line = (f", {name}" if several else ""), ("-", "--", ":")[min(at, 2)]
        axes.plot(contact.time / seconds, resultants.normal_force / factor, line, color="black", label=f"normal{of}")
        if contact.mesh.dimension == 2:
            along, axis = _along(contact, plane)
            force = resultants.force @ along / factor
            label = f"tangential ({axis}){of}" if len(axis) == 1 else f"tangential{of}"
            axes.plot(contact.time / seconds, force, line, color="tab:red", label=label)
        if contact.mesh.dimension == 3:
            normal = contact.normals[contact.obstacle == plane][0]
            aside = resultants.force - (resultants.force @ normal)[:, None] * normal
            axes.plot(contact.time / seconds, np.linalg.norm(aside, axis=1) / factor, line, color="tab:red", label=f"tangential, size{of}")
    axes.set_ylabel(f"force of contact ({prefix}{unit('N', contact.per_metre)})")
    axes.margins(x=0.0)
    axes.grid(alpha=0.3)
    legend_beside(axes)


def _along(contact: ContactResults, plane: int) -> tuple[Floats, str]:
    """Give the unit vector along a plane, positive in its larger component, and its name."""
    x, y = contact.normals[contact.obstacle == plane][0]
    along = np.array([y, -x])
    along *= np.sign(along[np.argmax(np.abs(along))])
    names = {(1.0, 0.0): "x", (0.0, 1.0): "y"}
    return along, names.get((abs(along[0]), abs(along[1])), "along the plane")


def _draw_zone(axes: Axes, contact: ContactResults, plane: int, colour: str) -> None:
    """Draw the nodes of a plane in contact over time. The status at t_n fills the step after it."""
    seconds, _ = prefixed(contact.time)
    rows = np.flatnonzero(contact.obstacle == plane)
    thin = -(-(len(contact.time) - 1) // MOST_COLUMNS)
    steps = np.arange(0, len(contact.time) - 1, thin)
    time = np.append(contact.time[steps], contact.time[-1]) / seconds
    status = contact.status[np.ix_(steps, rows)]
    values = np.asarray(status, dtype=np.float64) if colour == "status" else contact.pressure[np.ix_(steps, rows)]
    factor, prefix = (1.0, "") if colour == "status" else prefixed(values)
    shown = np.ma.masked_where(status == ContactStatus.FREE, values / factor)
    style = _style(colour, float(shown.max()) if shown.count() else 1.0)
    drawn: Any = None
    for piece, edges in _cells(axes, contact, plane, rows, np.asarray(contact.status[:-1, rows].any(axis=0))):
        drawn = axes.pcolormesh(time, edges, shown[:, piece].T, rasterized=True, **style)
    axes.set_xlim(time[0], time[-1])
    if len(contact.obstacles) > 1:
        axes.set_title(contact._names.get(plane) or contact.surfaces[plane] or "", fontsize="medium")
    if colour == "pressure":
        axes.figure.colorbar(drawn, cax=axes.inset_axes((1.02, 0.0, 0.03, 1.0)), label=f"pressure ({prefix}Pa)")
        return
    patch = pyplot().matplotlib.patches.Patch
    handles = [patch(color=shade, label=name.name.lower()) for name, shade in COLOURS.items() if (status == name).any()]
    if handles:
        legend_beside(axes, handles=handles)


def _style(colour: str, most: float) -> dict[str, Any]:
    """Give colours and their range."""
    if colour == "pressure":
        return {"cmap": FIELD, "vmin": 0.0, "vmax": most}
    colours = pyplot().matplotlib.colors.ListedColormap([COLOURS[ContactStatus.STICK], COLOURS[ContactStatus.SLIP]])
    return {"cmap": colours, "vmin": int(ContactStatus.STICK), "vmax": int(ContactStatus.SLIP)}


def _cells(
    axes: Axes, contact: ContactResults, plane: int, rows: NDArray[np.intp], touched: NDArray[np.bool_]
) -> list[tuple[slice, Floats]]:
    """Give the pieces of the contact surface near contact, with the borders of the shares of their nodes."""
    if contact.mesh.dimension == 1:
        axes.set_yticks(np.arange(len(rows)), [f"node {node}" for node in contact.nodes[rows]])
        return [(slice(None), np.arange(len(rows) + 1, dtype=np.float64) - 0.5)]
    along, name = _along(contact, plane)
    places: Floats = contact.points[rows] @ along
    factor, prefix = prefixed(places)
    axes.set_ylabel(f"{name} ({prefix}m)")
    pieces: list[tuple[slice, Floats]] = []
    seen: list[Floats] = []
    for piece in _pieces(contact, rows):
        at = places[piece] / factor
        edges: Floats = np.concatenate([at[:1], (at[1:] + at[:-1]) / 2, at[-1:]])
        pieces.append((piece, edges))
        here = touched[piece]
        seen += [edges[:-1][here], edges[1:][here]]
    wanted = np.concatenate(seen) if touched.any() else places / factor
    low, high = float(wanted.min()), float(wanted.max())
    axes.set_ylim(low - 0.08 * (high - low), high + 0.08 * (high - low))
    return pieces


def _pieces(contact: ContactResults, rows: NDArray[np.intp]) -> list[slice]:
    """Give the runs of consecutive nodes along the boundary."""
    cells = contact.mesh.cells
    nodes = contact.nodes[rows]
    beside = {tuple(sorted(pair)) for cell in cells[np.isin(cells, nodes).sum(axis=1) > 1] for pair in combinations(cell.tolist(), 2)}
    joined = [(min(a, b), max(a, b)) in beside for a, b in zip(nodes[:-1].tolist(), nodes[1:].tolist(), strict=True)]
    cuts = [0, *(k + 1 for k, together in enumerate(joined) if not together), len(rows)]
    return [slice(a, b) for a, b in zip(cuts[:-1], cuts[1:], strict=True)]
