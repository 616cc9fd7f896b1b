"""Pictures that histories and estimates have in common."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from percute import contact_pictures, field_pictures
from percute.contact import Contact

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Views"]

File = str | os.PathLike[str] | None


class Views(ABC):
    """Pictures that histories and estimates have in common."""

    @abstractmethod
    def _energies(self) -> Mapping[str, Any]:
        """Give what a `Balance` holds, by name."""

    @abstractmethod
    def _touch(self) -> Contact:
        """Give the contact results, or raise an error."""

    def plot_energies(self, *, axes: Axes | None = None, save: File = None, overwrite: bool = False) -> Axes:
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
        return field_pictures.plot_energies(self._energies(), axes, save, overwrite)

    def plot_force(self, *, axes: Axes | None = None, save: File = None, overwrite: bool = False) -> Axes:
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
        return contact_pictures.plot_force(self._touch(), axes, save, overwrite)

    def plot_pressure(
        self,
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
        return contact_pictures.plot_pressure(self._touch(), plane, axes, save, overwrite)
