"""Estimates of the error of a simulation, with their pictures, tables and files."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from percute import _percute, error_pictures as pictures, notebook, tables
from percute._percute import unit
from percute.checks import flag, instance, vtkhdf, words
from percute.checks import path as file_name
from percute.contact import Contact
from percute.contents import Contents, Quantity, components, instants, places
from percute.error_results import ErrorResults
from percute.errors import InputError
from percute.records import ElementMap
from percute.stored import MEASURES, StoredEstimate
from percute.true_error import Effectivity, TrueError
from percute.views import File, Views

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from matplotlib.axes import Axes

__all__ = ["Estimate"]

SAMPLES = {
    "kinetic": ("J", "kinetic part of eta"),
    "elastic": ("J", "elastic part of eta"),
    "dissipation": ("J", "plastic part of eta"),
    "contact": ("J", "contact part of eta"),
    "total": ("J", "eta, the square of the error"),
    "reference": ("J", "the square of the reference"),
}
MAPS = {
    "kinetic": (("instant", "element"), "element_kinetic", "J", "kinetic part of eta of the element"),
    "elastic": (("instant", "element"), "element_elastic", "J", "elastic part of eta of the element"),
    "dissipation": (("instant", "element"), "element_dissipation", "J", "plastic part of eta of the element"),
    "contact": (("instant", "element"), "element_contact", "J", "contact part of eta of the element"),
    "total": (("instant", "element"), "element_total", "J", "eta of the element"),
    "error": (("instant", "element"), "accumulated", "J^0.5", "contribution of the element up to here"),
    "displacement": (("instant", "node", "component"), "admissible_displacement", "m", "admissible displacement"),
    "velocity": (("instant", "node", "component"), "admissible_velocity", "m/s", "rate of the admissible displacement"),
    "acceleration": (("instant", "element", "component"), "admissible_acceleration", "m/s2", "admissible acceleration"),
    "stress": (("instant", "element", "component", "component2"), "admissible_stress", "Pa", "statically admissible stress"),
    "compatible_stress": (("instant", "element", "component", "component2"), "compatible_stress", "Pa", "stress of the admissible displacement"),
}


def _maps(maps: tuple[ElementMap, ...]) -> dict[str, Quantity]:
    """Give the maps, one behind the other."""
    found = {}
    for name, (dims, known_as, unit, text) in MAPS.items():
        if getattr(maps[0], name) is not None:
            found[known_as] = Quantity(dims, np.stack([getattr(each, name) for each in maps]), unit, text)
    return found


class Estimate(ErrorResults, Views):
    """The constitutive relation error of a history.

    Made by `estimate`, `run` or `percute.open`. Errors are in J^½ and include the thickness of a plane body. ``verdict``
    says how far they can be trusted.
    """

    def effectivity(self, error: TrueError) -> Effectivity:
        """Give the effectivity index: the estimated over the true error, of the largest and of the mean error.

        Parameters
        ----------
        error : percute.TrueError
            The true error of the same history, as `History.error` and ``percute.exact`` give it.

        Raises
        ------
        InputError
            The true error has other instants than the estimate: it is that of another history.
        """
        true = instance("error", error, TrueError)
        last, end = len(true.time) - 1, float(true.time[-1])
        same_end = bool(np.isclose(end, self.end, rtol=1e-9, atol=0))
        if not (same_end and last == self.steps):
            # Of a history of another program, the last instant may be left out, and there are samples between the instants.
            of_other = self.consistency is not None
            if not same_end and not (of_other and np.isclose(true.time[-2], self.end, rtol=1e-9, atol=0)):
                raise InputError(f"`error` ends at {end:.6g} s, but the estimate at {self.end:.6g} s; give the true error of the same history")
            if not of_other:
                raise InputError(f"`error` has {last} steps, but the estimate {self.steps}; give the true error of the same history")
        return Effectivity(sup=self.sup / true.sup, mean=self.mean / true.mean)

    def save(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write an estimate file for ParaView, h5py and `percute.open`, described in ``docs/estimate.md``.

        It contains the contact results, unless the estimate was unpickled without its history.

        Parameters
        ----------
        path : str or path
            The file, such as ``"error.vtkhdf"``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        InputError
            The estimate comes from a file; copy that file instead. Or ``path`` is the file of the history, which is never replaced.
        """
        file, replace = vtkhdf("path", path), flag("overwrite", overwrite)
        if isinstance(self._data, StoredEstimate):
            raise InputError(f"the estimate comes from the file {self._data.path!r}; copy that")
        history = self._history.path if self._history is not None else None
        if history is not None and os.path.exists(file) and history.exists() and history.samefile(file):
            raise InputError(f"`path` is {file!r}, the file of the history that was estimated; give another name")
        of = None if self._history is None else self._history._data
        self._data.save(os.path.abspath(file), replace, self._name, of)

    def picture(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> None:
        """Write the picture of ``percute run --picture``: e_E of each element (J^½), eq. [20], on the mesh. It needs no matplotlib.

        Parameters
        ----------
        path : str or path
            The file, ``.svg`` or ``.png``.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        InputError
            The name of the file ends otherwise.
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        """
        self._present(None, path, overwrite)

    def report(
        self,
        path: str | os.PathLike[str],
        *,
        title: str | None = None,
        author: str | None = None,
        program: str | None = None,
        overwrite: bool = False,
    ) -> None:
        """Write the page of ``percute report``: one HTML file to read, to print and to hand over, described in ``docs/report.md``.

        It shows the pressure along the surface unless the estimate was unpickled without its history.

        Parameters
        ----------
        path : str or path
            The file, ``.html``.
        title : str, optional
            Title of the page; by default "Error of the simulation" and the name of the case or history.
        author : str, optional
            Who hands the page over.
        program : str, optional
            The program that simulated, of a history of another program; by default as `History.from_arrays` was told.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Raises
        ------
        InputError
            The name of the file ends otherwise, or is that of the estimate. ``program`` is given, but percute simulated.
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        """
        self._present((words("title", title), words("author", author), words("program", program)), path, overwrite)

    def _present(self, page: tuple[str | None, str | None, str | None] | None, path: str | os.PathLike[str], overwrite: bool) -> None:
        file, replace = os.path.abspath(file_name("path", path)), flag("overwrite", overwrite)
        if isinstance(self._data, StoredEstimate):
            _percute.present_file(self._data.path, page, file, replace)
            return
        history = None if self._history is None else self._history._data
        _percute.present(self._data, page, file, replace, self._name, history)

    def plot_map(
        self, *, scale: float = 0.0, outline: bool = True, axes: Axes | None = None, save: File = None, overwrite: bool = False
    ) -> Axes:
        """Draw e_E, the contribution of each element (J^½), eq. [20], with mesh lines and planes.

        The colours are logarithmic if the largest contribution exceeds five times the median.

        Parameters
        ----------
        scale : float, default: 0.0
            By how much the displacement at the time of the sup, rigid motion included, is exaggerated; 0 draws the undeformed mesh.
        outline : bool, default: True
            Whether the outline of a plane body at the end is drawn over the undeformed mesh: its rigid motion as it is, its deformation
            times a round factor that makes it visible.
        axes, save, overwrite
            As for `plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.
        """
        return pictures.plot_map(self, scale, outline, axes, save, overwrite)

    def plot_over_time(
        self,
        by: Literal["parts", "sources"] = "parts",
        *,
        axes: Axes | None = None,
        save: File = None,
        overwrite: bool = False,
    ) -> Axes:
        """Draw √η over time, with the square roots of its parts or of its sources (J^½).

        A curve with many samples that goes up and down from one to the next is drawn as a band from the least to the largest of
        some samples, with their mean as a line.

        Parameters
        ----------
        by : {"parts", "sources"}, default: "parts"
            Kinetic, elastic and contact part, eq. [14], or surface, front, dispersion and mesh.
        axes, save, overwrite
            As for `plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.
        """
        return pictures.plot_over_time(self, by, axes, save, overwrite)

    def to_pandas(self, over: Literal["time", "elements", "both"] = "time") -> _pandas.DataFrame:
        """Make a table (extra ``pandas``).

        Parameters
        ----------
        over : {"time", "elements", "both"}, default: "time"
            The rows: η with its parts and sources at each sample, e_E of each element, or the contributions of the elements at each
            instant of ``maps``.

        Returns
        -------
        pandas.DataFrame
            ``attrs["units"]`` has the units of the columns, and ``attrs`` the measures of the error.
        """
        rows = {"time": ("time",), "elements": ("element",), "both": ("instant", "element")}
        return tables.to_pandas(self._contents(), over, rows)

    def to_xarray(self) -> xarray.Dataset:
        """Make a data set (extra ``xarray``): the error over ``time``, over ``element``, and over both at each ``instant`` of the maps.

        Each variable has its unit and meaning as attributes; the measures of the error are attributes of the data set.
        """
        return tables.to_xarray(self._contents())

    def _contents(self) -> Contents:
        """Give the error over time, over elements, and of both at the instants of the maps."""
        mesh, samples = self.mesh, self.over_time
        centroids = mesh.points[mesh.cells].mean(axis=1)
        coordinates = instants("time", samples.time) | places("element", centroids, np.arange(len(mesh.cells))) | components(mesh)
        quantities = {name: Quantity(("time",), getattr(samples, name), *told) for name, told in SAMPLES.items()}
        # Rounding may leave a total slightly below zero before the first contact.
        quantities["error"] = Quantity(("time",), np.sqrt(np.maximum(samples.total, 0.0)), "J^0.5", "error")
        if self.sources is not None:
            over_time = self.sources.over_time
            for name in ("surface", "front", "dispersion", "mesh"):
                quantities[f"source_{name}"] = Quantity(("time",), getattr(over_time, name), "J", f"part of eta from the source {name}")
        quantities["by_element"] = Quantity(("element",), self.by_element, "J^0.5", "contribution of the element to the mean error")
        if self.maps:
            coordinates |= instants("instant", np.array([each.time for each in self.maps]))
            quantities |= _maps(self.maps)
        if any("node" in quantity.dims for quantity in quantities.values()):
            coordinates |= places("node", mesh.points, np.arange(len(mesh.points)), "node_")
        facts = {name: getattr(self, name) for name in (*MEASURES, "time_of_sup", "end")} | dict(self.options)
        return Contents(coordinates, quantities, facts).per_metre(self.per_metre)

    def _energies(self) -> Mapping[str, Any]:
        if self.history is not None:
            return self.history._energies()
        columns = json.loads(self.to_json()).get("balance_over_time")
        if columns is None:
            raise InputError("the estimate has no energies; take them from its history")
        return {name: np.array(values, dtype=np.float64) for name, values in columns.items()} | {"per_metre": self.per_metre}

    def _touch(self) -> Contact:
        if self.contact is None:
            raise InputError(f"there is nothing to draw: {self.no_contact}")
        return self.contact

    def _repr_html_(self) -> str:
        norm = unit("J^½", self.per_metre).replace("^½", "½")
        rows = [
            ("largest error", f"{100 * self.relative_sup:.3g} %, {self.sup:.4g} {norm} at {notebook.time(self.time_of_sup)}"),
            ("mean error", f"{100 * self.relative_mean:.3g} %, {self.mean_from_touch:.4g} {norm}, from the touch"),
            ("steps", f"{self.steps} to {notebook.time(self.end)}"),
            ("reconstruction", str(self.options["reconstruction"])),
        ]
        if self.trust is not None:
            rows += [("trust", self.trust), ("verdict", str(self.verdict))]
        rows += [("worst element", f"{each.element} at {notebook.vector(each.centroid)} m, {each.error:.3g} {norm}") for each in self.worst_elements(1)]
        return notebook.page("Estimate", rows + notebook.mesh_rows(self.mesh)[:2], notebook.error_map(self.mesh, self.by_element))
