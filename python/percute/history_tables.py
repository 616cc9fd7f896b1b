"""Tables of histories."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from percute import element_fields
from percute.checks import one_of
from percute.contact import resultants_of
from percute.contents import Contents, Quantity, at_one_instant, components, instants, places
from percute.steps import Steps
from percute.tables import to_pandas

if TYPE_CHECKING:
    import pandas as _pandas

FIELDS = {
    "displacement": (("time", "node", "component"), "m", "displacement"),
    "velocity": (("time", "node", "component"), "m/s", "velocity"),
    "acceleration": (("time", "node", "component"), "m/s2", "acceleration"),
    "reaction": (("time", "contact_node", "component"), "N", "reaction of the planes on the node"),
    "touching": (("time", "contact_node"), "1", "whether the node touches"),
    "strain": (("time", "element", "component", "component2"), "1", "strain"),
    "stress": (("time", "element", "component", "component2"), "Pa", "stress"),
    "von_mises": (("time", "element"), "Pa", "von Mises stress"),
    "pressure": (("time", "element"), "Pa", "pressure in the element, positive in compression"),
    "plastic_strain": (("time", "element", "component", "component2"), "1", "plastic strain"),
    "equivalent_plastic_strain": (("time", "element"), "1", "equivalent plastic strain"),
    "strain_energy": (("time", "element"), "J", "strain energy of the element"),
    "plastic_work": (("time", "element"), "J", "work of plastic flow in the element"),
    "kinetic_energy": (("time", "element"), "J", "kinetic energy of the element, of the lumped mass"),
}


def contents(history: Steps, fields: Iterable[str], steps: NDArray[np.intp] | None = None, *, over_time: bool = True) -> Contents:
    """Give fields at some instants, by default at all, and energies and resultants of contact over time."""
    mesh = history.problem.mesh
    rows: Any = slice(None) if steps is None else steps
    coordinates = instants("time", history.time[rows]) | places("node", mesh.points, np.arange(len(mesh.points)))
    quantities: dict[str, Quantity] = {}
    wanted = list(fields)
    if any(name in ("reaction", "touching") for name in wanted):
        nodes = history.contact_nodes
        coordinates |= places("contact_node", mesh.points[nodes], nodes, "contact_")
    if any(name in element_fields.OF_ELEMENTS for name in wanted):
        coordinates |= places("element", mesh.points[mesh.cells].mean(axis=1), np.arange(len(mesh.cells)), "element_")
    for name in wanted:
        dims, unit, text = FIELDS[name]
        values = element_fields.element_field(history, name, rows) if name in element_fields.OF_ELEMENTS else getattr(history, name)[rows]
        quantities[name] = Quantity(dims, values, unit, text)
    if over_time:
        quantities |= history.balance._contents().quantities
        if history.problem.obstacles:
            quantities |= resultants_of(history.contact.resultants, "total_")
    return Contents(coordinates | components(mesh), quantities, {"complete": int(history.complete)}).per_metre(history.problem.per_metre)


def table(history: Steps, over: object, step: int | None) -> _pandas.DataFrame:
    """Make a table over time, or over nodes or elements at one instant or at all."""
    at = None if step is None else np.array([element_fields.instant(history, step)])
    rows: dict[str, tuple[str, ...]] = {"time": ("time",), "nodes": ("time", "node"), "elements": ("time", "element")}
    if one_of("over", over, rows) == "time":
        return to_pandas(contents(history, ()), over, rows)
    of_elements = element_fields.OF_ELEMENTS if history._data.variables else element_fields.ELASTIC
    names = element_fields.NODAL if over == "nodes" else of_elements
    found = contents(history, names, at, over_time=False)
    if at is None:
        return to_pandas(found, over, rows)
    return to_pandas(at_one_instant(found), over, {name: dims[1:] or dims for name, dims in rows.items()})
