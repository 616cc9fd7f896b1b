"""Named quantities with units and dimensions, of which `percute.tables` makes tables of pandas and data sets of xarray."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from percute._percute import unit
from percute.checks import wrong
from percute.mesh_arrays import MeshArrays

AXES = ("x", "y", "z")


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


def instants(name: str, time: NDArray[np.float64]) -> dict[str, Quantity]:
    """Give instants (s) as a coordinate."""
    return {name: Quantity((name,), time, "s", "time")}


def components(mesh: MeshArrays) -> dict[str, Quantity]:
    """Give the axes as coordinates of vectors and tensors."""
    labels = np.array(AXES[: mesh.dimension])
    return {name: Quantity((name,), labels, "1", "axis") for name in ("component", "component2")}


def places(dimension: str, points: NDArray[np.float64], numbers: NDArray[Any], prefix: str = "") -> dict[str, Quantity]:
    """Give the numbers and the coordinates of nodes, or of the centroids of elements."""
    found = {dimension: Quantity((dimension,), numbers, "1", f"number of the {dimension.replace('_', ' ')}")}
    for axis, values in zip(AXES, points.T, strict=False):
        found[prefix + axis] = Quantity((dimension,), values, "m", f"{axis} in the undeformed mesh")
    return found


def at_one_instant(contents: Contents) -> Contents:
    """Leave out the dimension of time of quantities at one instant."""
    time = contents.coordinates["time"].values[0]
    left = {name: q._replace(dims=q.dims[1:], values=q.values[0]) for name, q in contents.quantities.items()}
    rest = {name: q for name, q in contents.coordinates.items() if name != "time"}
    return Contents(rest, left, contents.facts | {"time": float(time)})


def chosen(fields: object, known: Iterable[str]) -> list[str]:
    """Check the names of fields."""
    names = list(known)
    given: list[Any] = [fields] if isinstance(fields, str) else list(fields) if isinstance(fields, Iterable) else [fields]
    for name in given:
        if not isinstance(name, str) or name not in names:
            raise wrong("fields", name, f"names of {', '.join(names)}")
    return given
