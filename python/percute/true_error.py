"""The true error of a simulation, and the estimate over it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from percute.words import counted

__all__ = ["Effectivity", "TrueError"]


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class TrueError:
    """The true error of a simulation, eq. [60]: the energy norm of the difference from exact fields or from a finer simulation."""

    sup: float
    """Largest over the t_n (J^½)."""
    mean: float
    """√((1/T)∫e² dt) (J^½)."""
    time: NDArray[np.float64]
    """t_n (s), shape (instants,)."""
    kinetic: NDArray[np.float64]
    """Kinetic part of e² (J), shape (instants,)."""
    elastic: NDArray[np.float64]
    """Elastic part of e² (J), shape (instants,)."""
    dissipation: NDArray[np.float64]
    """Plastic part of e² (J), shape (instants,): the distance of hardening and the misfit of either flow under the forces of the other."""
    total: NDArray[np.float64]
    """e² (J), shape (instants,)."""
    nested: bool = True
    """Whether it is exact in space; False if it was found by location, on meshes that need not be nested."""

    @classmethod
    def over(cls, time: NDArray[np.float64], kinetic: NDArray[np.float64], elastic: NDArray[np.float64]) -> TrueError:
        """Give the error with these parts of e² at the t_n; the mean is by the trapezoidal rule."""
        total = kinetic + elastic
        mean = np.sum(np.diff(time) * (total[1:] + total[:-1])) / (2 * time[-1])
        sup, none = float(np.sqrt(total.max())), np.zeros_like(total)
        return cls(sup=sup, mean=float(np.sqrt(mean)), time=time, kinetic=kinetic, elastic=elastic, dissipation=none, total=total)

    def __repr__(self) -> str:
        return f"<percute.TrueError: sup {self.sup:.4g} J^½, mean {self.mean:.4g} J^½, {counted(len(self.time), 'instant')}{'' if self.nested else ', by location'}>"


@dataclass(frozen=True)
class Effectivity:
    """Effectivity index: estimated over true error."""

    sup: float
    """Of the largest error."""
    mean: float
    """Of the mean error."""
