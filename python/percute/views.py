"""Pictures, tables and exports of histories, and pictures that estimates have too: methods that the classes inherit."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from numpy.typing import ArrayLike

from percute.history_fields import HistoryFields
from percute.immutable import Immutable
from percute.progress import ProgressOption

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from matplotlib.axes import Axes

    from percute.estimation import Estimate
    from percute.history import History

__all__ = ["HistoryViews", "Views"]

File = str | os.PathLike[str] | None


class Views(Immutable):
    """Pictures that histories and estimates have in common."""

    def plot_energies(self: History | Estimate, *, axes: Axes | None = None, save: File = None, overwrite: bool = False) -> Axes:  # type: ignore[misc]
        """Draw kinetic and strain energy and the works of loads, supports, contact and friction over time (J).

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            Axes of the plot; new ones by default.
        save : str or path, optional
            A file (``.svg``, ``.png`` or ``.pdf``) for the figure.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.
        """
        from percute.pictures import fields

        return fields.plot_energies(self, axes, save, overwrite)

    def plot_force(self: History | Estimate, *, axes: Axes | None = None, save: File = None, overwrite: bool = False) -> Axes:  # type: ignore[misc]
        """Draw the normal and the tangential contact force of each plane over time (N).

        Parameters
        ----------
        axes, save, overwrite
            As for `plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.

        Raises
        ------
        InputError
            There are no planes or no contact results.
        """
        from percute.pictures import contact

        return contact.plot_force(self, axes, save, overwrite)

    def plot_pressure(  # type: ignore[misc]
        self: History | Estimate,
        plane: int | None = None,
        *,
        axes: Axes | None = None,
        save: File = None,
        overwrite: bool = False,
    ) -> Axes:
        """Draw the contact pressure along the surface over time (Pa); of a bar, the pressure of its end over time.

        Parameters
        ----------
        plane : int, optional
            Number of the plane; by default the one with the largest force.
        axes, save, overwrite
            As for `plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot: time along x, place along the surface along y.

        Raises
        ------
        InputError
            There are no planes or no contact results.
        """
        from percute.pictures import contact

        return contact.plot_pressure(self, plane, axes, save, overwrite)


class HistoryViews(HistoryFields, Views):
    """Fields, probes, pictures and tables of a history."""

    def _repr_html_(self: History) -> str:  # type: ignore[misc]
        from percute import notebook

        return notebook.of_history(self)

    def plot(  # type: ignore[misc]
        self: History,
        quantity: str = "displacement",
        *,
        step: int = -1,
        scale: float = 1.0,
        axes: Axes | None = None,
        save: File = None,
        overwrite: bool = False,
    ) -> Axes:
        """Draw a field on the deformed body, with mesh lines and planes.

        Parameters
        ----------
        quantity : str, default: "displacement"
            Magnitude of ``displacement`` (m), ``velocity`` (m/s) or ``acceleration`` (m/s²); ``von_mises``, ``pressure``, ``stress_xx``,
            ``stress_yy`` or ``stress_xy`` (Pa); ``strain_energy`` or ``kinetic_energy`` of the elements (J). Of a bar its displacement,
            velocity, acceleration, ``stress`` or energies along it.
        step : int, default: -1
            Which instant; negative ones count from the end.
        scale : float, default: 1.0
            By how much the displacement, rigid motion included, is exaggerated; the title of a plane body tells it.
        axes, save, overwrite
            As for `plot_energies`.

        Returns
        -------
        matplotlib.axes.Axes
            The axes of the plot.
        """
        from percute.pictures import fields

        return fields.plot_field(self, quantity, step, scale, axes, save, overwrite)

    def animate(  # type: ignore[misc]
        self: History,
        path: str | os.PathLike[str],
        quantity: str | None = None,
        *,
        frames: int = 60,
        rate: float = 15.0,
        scale: float = 1.0,
        overwrite: bool = False,
        progress: ProgressOption = None,
    ) -> None:
        """Write an animation of a field on the moving body.

        Colours have one scale, and the picture one frame, for all instants. The file is complete or not there: an exception or Ctrl-C
        removes what has been written.

        Parameters
        ----------
        path : str or path
            A file that ends in ``.gif``, or in ``.mp4``, for which the program ffmpeg must be installed.
        quantity : str, optional
            As for `plot`; by default ``von_mises``, of a bar ``stress``.
        frames : int, default: 60
            Number of frames, at most 10 000, at evenly spaced steps from the first to the last; at most one for each step.
        rate : float, default: 15
            Frames per second, from 0.1 to 100.
        scale : float, default: 1.0
            By how much the displacement, rigid motion included, is exaggerated; the title of a plane body tells it.
        overwrite : bool, default: False
            Whether a file that exists already is replaced.
        progress : bool or callable, optional
            As for `simulate`; the stage is ``animating``, and frames are counted.

        Raises
        ------
        InputError
            An argument is wrong.
        PercuteError
            There is no matplotlib, or no ffmpeg for an ``.mp4``.
        ExistingFileError, StorageError
            The file exists already or cannot be written.
        """
        from percute.pictures import animation

        animation.animate(self, path, quantity, frames, rate, scale, overwrite, progress)

    def export(  # type: ignore[misc]
        self: History,
        path: str | os.PathLike[str],
        *,
        steps: ArrayLike | None = None,
        every: int | None = None,
        times: ArrayLike | None = None,
        fields: Iterable[str] | None = None,
        estimate: Estimate | str | os.PathLike[str] | None = None,
        overwrite: bool = False,
        progress: ProgressOption = None,
    ) -> list[Path]:
        """Write fields for ParaView, pyvista and other programs, like ``percute export``; see ``docs/export.md``.

        Parameters
        ----------
        path : str or path
            The ending says the format: ``.vtkhdf``, one file with all instants; ``.vtu`` or ``.pvd``, a file for each instant
            and an index.
        steps : int or (n,) ints, optional
            Steps to write; negative ones count from the end. By default all.
        every : int, optional
            Instead of ``steps``: every k-th step, and the last.
        times : float or (n,) floats, optional
            Instead of ``steps``: the steps nearest to these times (s).
        fields : list of str, optional
            Of ``"displacement"`` (m, always written), ``"velocity"`` (m/s), ``"acceleration"`` (m/s²), ``"reaction"`` (N, at
            all nodes), ``"stress"`` (Pa, 3 x 3), ``"von_mises"``, ``"pressure"`` (Pa), ``"error"`` (e_E of the whole run,
            J^½, eq. [20]). By default displacement, velocity, reaction, stress and von Mises stress, and the error if
            ``estimate`` is given.
        estimate : Estimate, str or path, optional
            The estimate of this history, or its file.
        overwrite : bool, default: False
            Whether files that exist already are replaced.
        progress : bool or callable, optional
            As for `simulate`.

        Returns
        -------
        list of pathlib.Path
            The files; the first is the one to open.

        Raises
        ------
        InputError
            An argument is wrong, or the estimate has another mesh.
        ExistingFileError, StorageError
            A file exists already or cannot be written.
        """
        from percute import exports

        return exports.export(self, path, steps, every, times, fields, estimate, overwrite, progress)

    def to_pandas(self: History, over: Literal["time", "nodes", "elements"] = "time", *, step: int | None = -1) -> _pandas.DataFrame:  # type: ignore[misc]
        """Make a table (extra ``pandas``).

        Parameters
        ----------
        over : {"time", "nodes", "elements"}, default: "time"
            The rows: energies and contact resultants at each instant; displacement, velocity and acceleration of each node; or
            strain, stress and energies of each element.
        step : int or None, default: -1
            For nodes and elements: which instant; negative ones count from the end. With None the table has all instants.

        Returns
        -------
        pandas.DataFrame
            With one column for each component, such as ``displacement_x``; ``attrs["units"]`` has the units of the columns.
        """
        from percute import element_fields, tables

        return tables.of_history(self, over, None if step is None else element_fields.instant(self, step))

    def to_xarray(self: History, fields: Iterable[str] = ("displacement", "reaction", "touching")) -> xarray.Dataset:  # type: ignore[misc]
        """Make a data set (extra ``xarray``): energies, contact resultants and fields over ``time``.

        Parameters
        ----------
        fields : iterable of str, default: ("displacement", "reaction", "touching")
            Which fields, at all instants: ``displacement``, ``velocity``, ``acceleration``, ``reaction``, ``touching``, and of the
            elements ``strain``, ``stress``, ``von_mises``, ``pressure``, ``strain_energy`` and ``kinetic_energy``. Those of the
            default are views without a copy.

        Returns
        -------
        xarray.Dataset
            Each variable has its unit and meaning as attributes.
        """
        from percute import contents, tables

        return tables.to_xarray(contents.of_history(self, contents.chosen(fields, contents.FIELDS)))
