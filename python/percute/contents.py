"""The contents of histories, estimates and contact results as named quantities with units and dimensions.

`percute.tables` makes tables of pandas and data sets of xarray from them.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from percute._percute import unit
from percute.checks import wrong
from percute.element_fields import OF_ELEMENTS, element_field

if TYPE_CHECKING:
    from percute.balance import Balance
    from percute.contact import Contact, Resultants
    from percute.estimation import Estimate
    from percute.history import History
    from percute.mesh import Mesh
    from percute.records import ElementMap

AXES = ("x", "y")


class Quantity(NamedTuple):
    """The values of a quantity."""

    dims: tuple[str, ...]
    """Names of the dimensions; ``component`` and ``component2`` are those of vectors and tensors."""
    values: NDArray[Any]
    """One number for each place."""
    unit: str
    """The unit, such as "m/s"; "1" for counts and ratios."""
    text: str
    """The meaning."""


class Contents(NamedTuple):
    """Quantities, and the coordinates of their dimensions."""

    coordinates: dict[str, Quantity]
    quantities: dict[str, Quantity]
    facts: dict[str, Any]
    """Single values."""

    def per_metre(self, per_metre: bool) -> Contents:
        """Give those of a body whose forces and energies may be per metre of thickness."""
        return self._replace(quantities={name: q._replace(unit=unit(q.unit, per_metre)) for name, q in self.quantities.items()})


BALANCE = {
    "kinetic": ("J", "kinetic energy"),
    "strain": ("J", "strain energy"),
    "work_of_loads": ("J", "work of tractions and body forces"),
    "work_of_supports": ("J", "work of support reactions"),
    "work_of_contact": ("J", "work of contact reactions, including friction"),
    "friction": ("J", "energy dissipated by friction"),
    "energy_drift": ("1", "largest error of the energy balance so far, over the largest energy or work"),
    "impulse_drift": ("1", "largest error of the balance of momentum so far, over the largest momentum or impulse"),
}
RESULTANTS = {
    "force": (("time", "component"), "N", "resultant of the contact forces"),
    "normal_force": (("time",), "N", "sum of the normal components of the contact forces"),
    "impulse": (("time", "component"), "N s", "impulse of contact on the body up to here"),
    "area": (("time",), "m2", "area of contact"),
    "in_contact": (("time",), "1", "number of nodes in contact"),
    "slipping": (("time",), "1", "number of slipping nodes"),
    "friction_energy": (("time",), "J", "energy dissipated by friction up to here"),
    "centre": (("time", "component"), "m", "centre of pressure"),
}
AT_NODES = {
    "force": ("N", "contact force R_n"),
    "density": ("Pa", "contact density R_n/l_k"),
    "tangential_force": ("N", "tangential part of the contact force"),
    "sliding_velocity": ("m/s", "sliding velocity"),
    "normal_force": ("N", "normal component of the contact force"),
    "pressure": ("Pa", "contact pressure"),
    "gap": ("m", "gap"),
    "status": ("1", "0 free, 1 stick, 2 slip"),
    "friction_energy": ("J", "energy dissipated by friction up to here"),
}
OF_NODES = {
    "obstacle": ("1", "number of the plane that the node may touch"),
    "area": ("m2", "share of the candidate edges"),
    "first_touch": ("s", "time of the first touch"),
    "time_in_contact": ("s", "total time in contact"),
    "peak_normal_force": ("N", "largest normal force"),
    "time_of_peak": ("s", "time of the largest normal force"),
    "peak_pressure": ("Pa", "largest pressure"),
    "impulse": ("N s", "impulse of the node"),
}
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
    "strain_energy": (("time", "element"), "J", "strain energy of the element"),
    "kinetic_energy": (("time", "element"), "J", "kinetic energy of the element, of the lumped mass"),
}
SAMPLES = {
    "kinetic": ("J", "kinetic part of eta"),
    "elastic": ("J", "elastic part of eta"),
    "contact": ("J", "contact part of eta"),
    "total": ("J", "eta, the square of the error"),
    "reference": ("J", "the square of the reference"),
}
MAPS = {
    "kinetic": (("instant", "element"), "element_kinetic", "J", "kinetic part of eta of the element"),
    "elastic": (("instant", "element"), "element_elastic", "J", "elastic part of eta of the element"),
    "contact": (("instant", "element"), "element_contact", "J", "contact part of eta of the element"),
    "total": (("instant", "element"), "element_total", "J", "eta of the element"),
    "error": (("instant", "element"), "accumulated", "J^0.5", "contribution of the element up to here"),
    "displacement": (("instant", "node", "component"), "admissible_displacement", "m", "admissible displacement"),
    "velocity": (("instant", "node", "component"), "admissible_velocity", "m/s", "rate of the admissible displacement"),
    "acceleration": (("instant", "element", "component"), "admissible_acceleration", "m/s2", "admissible acceleration"),
    "stress": (("instant", "element", "component", "component2"), "admissible_stress", "Pa", "statically admissible stress"),
    "compatible_stress": (("instant", "element", "component", "component2"), "compatible_stress", "Pa", "stress of the admissible displacement"),
}
MEASURES = (
    "sup",
    "mean",
    "mean_from_touch",
    "energy",
    "strain_energy",
    "kinetic_energy",
    "relative_sup",
    "relative_mean",
    "relative_stress_sup",
    "relative_stress_mean",
    "relative_velocity_sup",
    "relative_velocity_mean",
    "published_relative_sup",
    "published_relative_mean",
    "reference_sup",
    "reference_mean",
)


def _time(name: str, time: NDArray[np.float64]) -> dict[str, Quantity]:
    return {name: Quantity((name,), time, "s", "time")}


def _components(mesh: Mesh) -> dict[str, Quantity]:
    labels = np.array(AXES[: mesh.dimension])
    return {name: Quantity((name,), labels, "1", "axis") for name in ("component", "component2")}


def _places(dimension: str, points: NDArray[np.float64], numbers: NDArray[Any], prefix: str = "") -> dict[str, Quantity]:
    """Give the numbers and the coordinates of nodes, or of the centroids of elements."""
    found = {dimension: Quantity((dimension,), numbers, "1", f"number of the {dimension.replace('_', ' ')}")}
    for axis, values in zip(AXES, points.T, strict=False):
        found[prefix + axis] = Quantity((dimension,), values, "m", f"{axis} in the undeformed mesh")
    return found


def of_balance(balance: Balance) -> Contents:
    """Give the energies over time."""
    quantities = {name: Quantity(("time",), getattr(balance, name), *told) for name, told in BALANCE.items()}
    return Contents(_time("time", balance.time), quantities, {}).per_metre(balance.per_metre)


def _resultants(resultants: Resultants, prefix: str) -> dict[str, Quantity]:
    return {prefix + name: Quantity(dims, getattr(resultants, name), unit, text) for name, (dims, unit, text) in RESULTANTS.items()}


def of_contact(contact: Contact) -> Contents:
    """Give the contact results: at nodes and instants, of nodes, and the resultants over time."""
    coordinates = _time("time", contact.time) | _places("contact_node", contact.points, contact.nodes) | _components(contact.mesh)
    quantities = _resultants(contact.resultants, "total_")
    if len(contact.obstacles) > 1:
        for number, each in enumerate(contact.obstacles):
            quantities |= _resultants(each, f"plane_{number}_")
    for name, told in AT_NODES.items():
        values = getattr(contact, name)
        dims = ("time", "contact_node", "component")[: values.ndim]
        quantities[name] = Quantity(dims, values, *told)
    for name, told in OF_NODES.items():
        values = getattr(contact, name)
        # Names of quantities at nodes and instants are taken.
        quantities[f"node_{name}"] = Quantity(("contact_node", "component")[: values.ndim], values, *told)
    return Contents(coordinates, quantities, {}).per_metre(contact.per_metre)


def of_history(history: History, fields: Iterable[str], steps: NDArray[np.intp] | None = None, *, over_time: bool = True) -> Contents:
    """Give fields of a history at some instants, by default at all, and energies and resultants of contact over time."""
    mesh = history.problem.mesh
    rows: Any = slice(None) if steps is None else steps
    coordinates = _time("time", history.time[rows]) | _places("node", mesh.points, np.arange(len(mesh.points)))
    quantities: dict[str, Quantity] = {}
    wanted = list(fields)
    if any(name in ("reaction", "touching") for name in wanted):
        nodes = history.contact_nodes
        coordinates |= _places("contact_node", mesh.points[nodes], nodes, "contact_")
    if any(name in OF_ELEMENTS for name in wanted):
        coordinates |= _places("element", mesh.points[mesh.cells].mean(axis=1), np.arange(len(mesh.cells)), "element_")
    for name in wanted:
        dims, unit, text = FIELDS[name]
        values = element_field(history, name, rows) if name in OF_ELEMENTS else getattr(history, name)[rows]
        quantities[name] = Quantity(dims, values, unit, text)
    if over_time:
        quantities |= of_balance(history.balance).quantities
        if history.problem.obstacles:
            quantities |= _resultants(history.contact.resultants, "total_")
    return Contents(coordinates | _components(mesh), quantities, {"complete": int(history.complete)}).per_metre(history.problem.per_metre)


def of_estimate(estimate: Estimate) -> Contents:
    """Give the error over time, over elements, and of both at the instants of the maps."""
    mesh, samples = estimate.mesh, estimate.over_time
    centroids = mesh.points[mesh.cells].mean(axis=1)
    coordinates = _time("time", samples.time) | _places("element", centroids, np.arange(len(mesh.cells))) | _components(mesh)
    quantities = {name: Quantity(("time",), getattr(samples, name), *told) for name, told in SAMPLES.items()}
    # Rounding may leave a total slightly below zero before the first contact.
    quantities["error"] = Quantity(("time",), np.sqrt(np.maximum(samples.total, 0.0)), "J^0.5", "error")
    if estimate.sources is not None:
        over_time = estimate.sources.over_time
        for name in ("surface", "front", "dispersion", "mesh"):
            quantities[f"source_{name}"] = Quantity(("time",), getattr(over_time, name), "J", f"part of eta from the source {name}")
    quantities["by_element"] = Quantity(("element",), estimate.by_element, "J^0.5", "contribution of the element to the mean error")
    if estimate.maps:
        coordinates |= _time("instant", np.array([each.time for each in estimate.maps]))
        quantities |= _maps(estimate.maps)
    if any("node" in quantity.dims for quantity in quantities.values()):
        coordinates |= _places("node", mesh.points, np.arange(len(mesh.points)), "node_")
    facts = {name: getattr(estimate, name) for name in (*MEASURES, "time_of_sup", "end")} | dict(estimate.options)
    return Contents(coordinates, quantities, facts).per_metre(estimate.per_metre)


def at_one_instant(contents: Contents) -> Contents:
    """Leave out the dimension of time of quantities at one instant."""
    time = contents.coordinates["time"].values[0]
    left = {name: q._replace(dims=q.dims[1:], values=q.values[0]) for name, q in contents.quantities.items()}
    rest = {name: q for name, q in contents.coordinates.items() if name != "time"}
    return Contents(rest, left, contents.facts | {"time": float(time)})


def _maps(maps: tuple[ElementMap, ...]) -> dict[str, Quantity]:
    """Give the maps, one behind the other."""
    found = {}
    for name, (dims, known_as, unit, text) in MAPS.items():
        if getattr(maps[0], name) is not None:
            found[known_as] = Quantity(dims, np.stack([getattr(each, name) for each in maps]), unit, text)
    return found


def chosen(fields: object, known: Iterable[str]) -> list[str]:
    """Check the names of fields."""
    names = list(known)
    given: list[Any] = [fields] if isinstance(fields, str) else list(fields) if isinstance(fields, Iterable) else [fields]
    for name in given:
        if not isinstance(name, str) or name not in names:
            raise wrong("fields", name, f"names of {', '.join(names)}")
    return given
