"""Contact results with their pictures and tables."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from percute import contact_pictures as pictures, tables
from percute.contact_results import ContactResults, Resultants
from percute.contents import Contents, Quantity, components, instants, places

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from matplotlib.axes import Axes

__all__ = ["Contact"]

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


def resultants_of(resultants: Resultants, prefix: str) -> dict[str, Quantity]:
    """Give resultants over time, with a prefix to their names."""
    return {prefix + name: Quantity(dims, getattr(resultants, name), unit, text) for name, (dims, unit, text) in RESULTANTS.items()}


class Contact(ContactResults):
    """Contact results at the nodes of the contact surface, and their resultants.

    Force, density, status and sliding velocity at t_n are those of the reaction R_n and of the step from t_n to t_{n+1}. A node
    is in contact (not free) at t_n if and only if it touches at t_{n+1}. Gaps and positions are those at t_n.
    """

    def plot(
        self,
        colour: Literal["status", "pressure"] = "status",
        *,
        axes: Sequence[Axes] | None = None,
        save: str | os.PathLike[str] | None = None,
        overwrite: bool = False,
    ) -> list[Axes]:
        """Draw the resultant forces over time, and for each plane the zone of contact over time.

        Parameters
        ----------
        colour : {"status", "pressure"}, default: "status"
            Quantity that the colour of the zone shows.
        axes : sequence of matplotlib.axes.Axes, optional
            Axes of the plot, one for the forces and one for each plane; new ones by default.
        save, overwrite
            As for `History.plot_energies`.

        Returns
        -------
        list of matplotlib.axes.Axes
            The axes of the plot.
        """
        return pictures.plot_contact(self, colour, axes, save, overwrite)

    def to_pandas(self, over: Literal["time", "nodes", "both"] = "time") -> _pandas.DataFrame:
        """Make a table of the contact results (extra ``pandas``).

        Parameters
        ----------
        over : {"time", "nodes", "both"}, default: "time"
            The rows: the resultants at each instant, the results of each contact node, or force, pressure, gap and status of each
            node at each instant.

        Returns
        -------
        pandas.DataFrame
            With one column for each component, such as ``total_force_x``; ``attrs["units"]`` has the units of the columns.
        """
        rows = {"time": ("time",), "nodes": ("contact_node",), "both": ("time", "contact_node")}
        return tables.to_pandas(self._contents(), over, rows)

    def to_xarray(self) -> xarray.Dataset:
        """Make a data set over ``time`` and ``contact_node`` (extra ``xarray``); each variable has its unit and meaning as attributes."""
        return tables.to_xarray(self._contents())

    def _contents(self) -> Contents:
        """Give the results at nodes and instants, of nodes, and the resultants over time."""
        coordinates = instants("time", self.time) | places("contact_node", self.points, self.nodes) | components(self.mesh)
        quantities = resultants_of(self.resultants, "total_")
        if len(self.obstacles) > 1:
            for number, each in enumerate(self.obstacles):
                quantities |= resultants_of(each, f"plane_{number}_")
        for name, told in AT_NODES.items():
            values = getattr(self, name)
            dims = ("time", "contact_node", "component")[: values.ndim]
            quantities[name] = Quantity(dims, values, *told)
        for name, told in OF_NODES.items():
            values = getattr(self, name)
            # Names of quantities at nodes and instants are taken.
            quantities[f"node_{name}"] = Quantity(("contact_node", "component")[: values.ndim], values, *told)
        return Contents(coordinates, quantities, {}).per_metre(self.per_metre)
