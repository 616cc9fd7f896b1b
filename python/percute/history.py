"""Histories: all steps of a simulation, with fields, pictures, tables and exports."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute, animation_pictures, element_fields, exports, field_pictures as pictures, history_tables, notebook, rigid_motion, tables
from percute.checks import flag, instance
from percute.contact import Contact
from percute.contents import chosen
from percute.element_fields import Step
from percute.progress import ProgressOption
from percute.rigid_motion import RigidMotion
from percute.steps import Steps
from percute.true_error import TrueError
from percute.views import File, Views

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray
    from matplotlib.axes import Axes

__all__ = ["History"]


class History(Steps, Views):
    """The steps of a simulation: displacements, contact reactions and touching status at each instant t_n.

    Made by `simulate`, `percute.open` or `from_arrays`. Its arrays are read-only views without copies, of memory that lives as
    long as any of them, or of the file.
    """

    def error(self, reference: History, *, nested: bool = True) -> TrueError:
        """Return the true error of this history, measured against a finer one.

        Parameters
        ----------
        reference : History
            A simulation of the same problem, at least as long, on a mesh in which this one is nested, such as
            `Mesh.refine`. Between its instants it is interpolated linearly. Where it needs too much memory, take
            `percute.true_errors`.
        nested : bool, default: True
            Whether the mesh of this history must be nested in that of the reference. With False it may be any mesh of the same
            bodies, such as one of Gmsh or of another disc: velocities are compared at the nodes of the reference, strains at the
            centroids of its elements, outside this mesh with those of the nearest element. This is off by up to 10, 4 and 1 % where
            the elements of the reference are a half, a quarter and an eighth as large.

        Returns
        -------
        percute.TrueError
            The energy norm of the difference at the instants of this history; exact in space if the meshes are nested.

        Raises
        ------
        InputError
            The reference simulates another problem, the meshes are not nested or, with ``nested=False``, not of the same
            bodies, or the reference ends too early. Initial fields that vary within a body may depend on the mesh, and are not
            compared.
        """
        other = instance("reference", reference, History)
        within = flag("nested", nested)
        return true_errors_of(_percute.errors_against_history([self._data], other._data, within), within)[0]

    def displacement_at(self, step: Step) -> NDArray[np.float64]:
        """Give the displacement of each node (m), shape (nodes, dimension); ``step`` as for `strain`.

        Of a history in a file, only these instants are read and compared with their checksums; ``displacement`` compares all.
        """
        chosen, one = element_fields.rows(self, step)
        values = self._displacement_at(chosen)
        return values[0] if one else values

    def strain(self, step: Step) -> NDArray[np.float64]:
        """Give the strain of each element, eq. [5].

        Parameters
        ----------
        step : int, slice or array of ints
            Which instant; negative ones count from the end. A slice or an array gives several, along the first axis.

        Returns
        -------
        ndarray
            Shape (elements, dimension, dimension).
        """
        return element_fields.element_field(self, "strain", step)

    def stress(self, step: Step) -> NDArray[np.float64]:
        """Give the stress of each element (Pa), shape (elements, dimension, dimension), eq. [9]; ``step`` as for `strain`."""
        return element_fields.element_field(self, "stress", step)

    def first_piola(self, step: Step) -> NDArray[np.float64]:
        """Give the first Piola–Kirchhoff stress of each element (Pa), per undeformed area, shape (elements, dimension, dimension).

        Row a, column b is the force along a on a surface with the undeformed normal b. With small strains it is the stress.
        ``step`` as for `strain`.
        """
        return element_fields.element_field(self, "first_piola", step)

    def principal_stretches(self, step: Step) -> NDArray[np.float64]:
        """Give the principal stretches of each element in its plane, the larger first, shape (elements, dimension); ``step`` as for `strain`."""
        return element_fields.element_field(self, "principal_stretches", step)

    def rigid_motion(self, group: str | None = None) -> RigidMotion:
        """Give the mean motion of the bodies, or of a group of elements, at all instants: its centre, rotation and momenta.

        Parameters
        ----------
        group : str, optional
            The name of a group of elements, such as a body; without it all elements.

        Returns
        -------
        percute.RigidMotion
            Of a bar, without rotation.

        Raises
        ------
        InputError
            There is no such group.
        """
        return rigid_motion.rigid_motion(self, group)

    def von_mises(self, step: Step) -> NDArray[np.float64]:
        """Give the von Mises stress of each element (Pa), shape (elements,), with σ_zz in plane strain; ``step`` as for `strain`."""
        return element_fields.element_field(self, "von_mises", step)

    def pressure(self, step: Step) -> NDArray[np.float64]:
        """Give −⅓ tr σ of each element (Pa), shape (elements,), positive in compression; ``step`` as for `strain`."""
        return element_fields.element_field(self, "pressure", step)

    def plastic_strain(self, step: Step) -> NDArray[np.float64]:
        """Give ε_p of each element, shape (elements, dimension, dimension); 0 where the material does not yield. ``step`` as for `strain`."""
        return element_fields.element_field(self, "plastic_strain", step)

    def equivalent_plastic_strain(self, step: Step) -> NDArray[np.float64]:
        """Give p = ∫√(⅔ ε̇_p:ε̇_p) dt of each element, shape (elements,); ``step`` as for `strain`."""
        return element_fields.element_field(self, "equivalent_plastic_strain", step)

    def plastic_work(self, step: Step) -> NDArray[np.float64]:
        """Give ∫σ:ε̇_p dt of each element (J), shape (elements,); the sum is that of ``balance``. ``step`` as for `strain`."""
        return element_fields.element_field(self, "plastic_work", step)

    def strain_energy(self, step: Step) -> NDArray[np.float64]:
        """Give the energy of the elastic strain of each element (J), shape (elements,); the sum is that of ``balance``. ``step`` as for `strain`."""
        return element_fields.element_field(self, "strain_energy", step)

    def kinetic_energy(self, step: Step) -> NDArray[np.float64]:
        """Give the kinetic energy of each element's share of the lumped masses (J), shape (elements,), with v_n; ``step`` as for `strain`."""
        return element_fields.element_field(self, "kinetic_energy", step)

    def probe(
        self, where: str | ArrayLike, quantity: str = "displacement", *, each: bool = False
    ) -> NDArray[np.float64]:
        """Read a quantity at a point or a group, at all instants.

        Parameters
        ----------
        where : (dimension,) floats or str
            A point of the undeformed body (m), or the name of a group of edges or elements.
        quantity : str, default: "displacement"
            Of the nodes ``displacement``, ``velocity`` or ``acceleration``: linear in an element. Of the elements ``strain``,
            ``stress``, ``von_mises``, ``pressure``, ``plastic_strain`` or ``equivalent_plastic_strain``: constant in an element; on an edge between elements that of one of them.
        each : bool, default: False
            For a group: whether each of its nodes (elements), in ascending order, has its own values. Otherwise the result is the
            mean over the length of the edges, or over the area of the elements.

        Returns
        -------
        ndarray
            Shape (instants, …) with the components of the quantity, or (instants, members, …) with ``each``.

        Raises
        ------
        InputError
            The point is outside the body; the message has the nearest point. Or there is no group of this name.
        """
        return element_fields.probe(self, where, quantity, each)

    def plot(
        self,
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
            ``stress_yy`` or ``stress_xy`` (Pa); ``equivalent_plastic_strain``; ``strain_energy`` or ``kinetic_energy`` of the elements (J). Of a bar its displacement,
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
        return pictures.plot_field(self, quantity, step, scale, axes, save, overwrite)

    def animate(
        self,
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
        animation_pictures.animate(self, path, quantity, frames, rate, scale, overwrite, progress)

    def export(
        self,
        path: str | os.PathLike[str],
        *,
        steps: ArrayLike | None = None,
        every: int | None = None,
        times: ArrayLike | None = None,
        fields: Iterable[str] | None = None,
        estimate: exports.Estimated | str | os.PathLike[str] | None = None,
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
            all nodes), ``"stress"`` (Pa, 3 x 3), ``"von_mises"``, ``"pressure"`` (Pa), ``"equivalent_plastic_strain"``,
            ``"error"`` (e_E of the whole run, J^½, eq. [20]). By default displacement, velocity, reaction, stress and von Mises
            stress, the equivalent plastic strain where a material yields, and the error if ``estimate`` is given.
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
        return exports.export(self, path, steps, every, times, fields, estimate, overwrite, progress)

    def to_pandas(self, over: Literal["time", "nodes", "elements"] = "time", *, step: int | None = -1) -> _pandas.DataFrame:
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
        return history_tables.table(self, over, step)

    def to_xarray(self, fields: Iterable[str] = ("displacement", "reaction", "touching")) -> xarray.Dataset:
        """Make a data set (extra ``xarray``): energies, contact resultants and fields over ``time``.

        Parameters
        ----------
        fields : iterable of str, default: ("displacement", "reaction", "touching")
            Which fields, at all instants: ``displacement``, ``velocity``, ``acceleration``, ``reaction``, ``touching``, and of the
            elements ``strain``, ``stress``, ``von_mises``, ``pressure``, ``plastic_strain``, ``equivalent_plastic_strain``,
            ``strain_energy``, ``plastic_work`` and ``kinetic_energy``. Those of the default are views without a copy.

        Returns
        -------
        xarray.Dataset
            Each variable has its unit and meaning as attributes.
        """
        return tables.to_xarray(history_tables.contents(self, chosen(fields, history_tables.FIELDS)))

    def _energies(self) -> Mapping[str, Any]:
        return vars(self.balance)

    def _touch(self) -> Contact:
        return self.contact

    def _repr_html_(self) -> str:
        # Nothing is computed.
        count, planned = len(self), len(self._data.times)
        told = f"{count} to {notebook.time(float(self.time[-1]))}" if count else "none"
        rows = [("instants", told if self.complete else f"{told}, of {planned} planned")]
        if count > 1:
            rows.append(("longest step", notebook.time(float(np.diff(self.time).max()))))
        rows.append(("steps are", "in memory" if self.path is None else f"in {self.path}"))
        return notebook.page("History", rows + notebook.mesh_rows(self.problem.mesh)[:2], notebook.outline(self.problem.mesh))


def true_errors_of(found: list[Any], nested: bool) -> list[TrueError]:
    """Make records of true errors and their values over time."""
    return [TrueError(sup=sup, mean=mean, **over_time, nested=nested) for sup, mean, over_time in found]
