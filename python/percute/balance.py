"""Energies, works and drifts of a simulation over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from percute import tables
from percute.contents import Contents, Quantity, instants
from percute.words import counted

if TYPE_CHECKING:
    import pandas as _pandas
    import xarray

__all__ = ["Balance"]

QUANTITIES = {
    "kinetic": ("J", "kinetic energy"),
    "strain": ("J", "strain energy"),
    "plastic_work": ("J", "work of plastic flow"),
    "work_of_loads": ("J", "work of tractions and body forces"),
    "work_of_supports": ("J", "work of support reactions"),
    "work_of_contact": ("J", "work of contact reactions, including friction"),
    "friction": ("J", "energy dissipated by friction"),
    "energy_drift": ("1", "largest error of the energy balance so far, over the largest energy or work"),
    "impulse_drift": ("1", "largest error of the balance of momentum so far, over the largest momentum or impulse"),
}


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Balance:
    """Energies and works (J) and drifts at each instant, each of shape (instants,)."""

    time: NDArray[np.float64]
    """Instants t_n (s)."""
    kinetic: NDArray[np.float64]
    """Kinetic energy."""
    strain: NDArray[np.float64]
    """Strain energy; of materials that yield that of their elastic strain."""
    plastic_work: NDArray[np.float64]
    """What hardening has stored and plastic flow has dissipated; 0 where no material yields."""
    work_of_loads: NDArray[np.float64]
    """Work of tractions and body forces."""
    work_of_supports: NDArray[np.float64]
    """Work of support reactions."""
    work_of_contact: NDArray[np.float64]
    """Work of contact reactions, including friction."""
    friction: NDArray[np.float64]
    """Energy dissipated by friction."""
    energy_drift: NDArray[np.float64]
    """Largest error of the energy balance so far, over the largest energy or work."""
    impulse_drift: NDArray[np.float64]
    """The same for momentum and impulses."""
    per_metre: bool = False
    """Whether forces and energies are per metre of thickness."""

    def to_pandas(self) -> _pandas.DataFrame:
        """Make a table over time (extra ``pandas``): one row for each instant; ``attrs["units"]`` has the units of the columns."""
        return tables.to_pandas(self._contents(), "time", {"time": ("time",)})

    def to_xarray(self) -> xarray.Dataset:
        """Make a data set over ``time`` (extra ``xarray``); each variable has its unit and meaning as attributes."""
        return tables.to_xarray(self._contents())

    def _contents(self) -> Contents:
        quantities = {name: Quantity(("time",), getattr(self, name), *told) for name, told in QUANTITIES.items()}
        return Contents(instants("time", self.time), quantities, {}).per_metre(self.per_metre)

    def __repr__(self) -> str:
        drifts = f"energy drift {self.energy_drift[-1]:.2g}, impulse drift {self.impulse_drift[-1]:.2g}"
        return f"<percute.Balance: {counted(len(self.kinetic), 'instant')}, {drifts}>"
