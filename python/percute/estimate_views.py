"""Pictures and tables of estimates: methods that the class inherits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from percute.views import File, Views

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from matplotlib.axes import Axes

    from percute.estimation import Estimate

__all__ = ["EstimateViews"]


class EstimateViews(Views):
    """Pictures and tables of an estimate."""

    def _repr_html_(self: Estimate) -> str:  # type: ignore[misc]
        from percute import notebook

        return notebook.of_estimate(self)

    def plot_map(  # type: ignore[misc]
        self: Estimate, *, scale: float = 0.0, outline: bool = True, axes: Axes | None = None, save: File = None, overwrite: bool = False
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
        from percute.pictures import error

        return error.plot_map(self, scale, outline, axes, save, overwrite)

    def plot_over_time(  # type: ignore[misc]
        self: Estimate,
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
        from percute.pictures import error

        return error.plot_over_time(self, by, axes, save, overwrite)

    def to_pandas(self: Estimate, over: Literal["time", "elements", "both"] = "time") -> _pandas.DataFrame:  # type: ignore[misc]
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
        from percute import contents, tables

        rows = {"time": ("time",), "elements": ("element",), "both": ("instant", "element")}
        return tables.to_pandas(contents.of_estimate(self), over, rows)

    def to_xarray(self: Estimate) -> xarray.Dataset:  # type: ignore[misc]
        """Make a data set (extra ``xarray``): the error over ``time``, over ``element``, and over both at each ``instant`` of the maps.

        Each variable has its unit and meaning as attributes; the measures of the error are attributes of the data set.
        """
        from percute import contents, tables

        return tables.to_xarray(contents.of_estimate(self))
