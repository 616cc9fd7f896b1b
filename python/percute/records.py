"""Parts of an estimate."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["ElementMap", "OverTime", "Parts", "WorstElement"]


@dataclass(frozen=True)
class Parts:
    """The parts of η (J), eq. [14]."""

    kinetic: float
    """From inertia: ½∫ρ(u̇_DA − u̇_CA)²."""
    elastic: float
    """From stress: ½∫(σ_DA − σ_CA):K⁻¹(σ_DA − σ_CA)."""
    contact: float
    """From the contact law: 2∫∫[b(−w_CA, F_DA) + w_CA·F_DA]; with ``corrected`` its tangential part, ∫F_n gap and ∫∫F_n|w_n| dt."""

    @property
    def total(self) -> float:
        """η (J)."""
        return self.kinetic + self.elastic + self.contact


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class OverTime:
    """η, its parts and d at each sample, each of shape (samples,).

    With ``consistent`` and ``published``, an instant at which the contact zone changes has two samples, before and after.
    """

    time: NDArray[np.float64]
    """t (s)."""
    kinetic: NDArray[np.float64]
    """Kinetic part of η (J), eq. [14]."""
    elastic: NDArray[np.float64]
    """Elastic part of η (J)."""
    contact: NDArray[np.float64]
    """Contact part of η (J)."""
    total: NDArray[np.float64]
    """η (J)."""
    reference: NDArray[np.float64]
    """d (J), eq. [24]."""

    def __repr__(self) -> str:
        return f"<percute.OverTime: {len(self.time)} samples to {self.time[-1]:.4g} s, sup of η {self.total.max():.4g} J>"


@dataclass(frozen=True)
class WorstElement:
    """An element and its contribution."""

    element: int
    """Its number."""
    error: float
    """e_E (J^½), eq. [20]."""
    centroid: tuple[float, ...]
    """Its centroid in the undeformed mesh (m)."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class ElementMap:
    """Contributions of the elements at an instant, and on request the admissible fields."""

    time: float
    """t_n (s)."""
    kinetic: NDArray[np.float64]
    """Kinetic part of η_E (J), shape (elements,)."""
    elastic: NDArray[np.float64]
    """Elastic part of η_E (J), shape (elements,)."""
    contact: NDArray[np.float64]
    """Contact part of η_E (J), shape (elements,)."""
    total: NDArray[np.float64]
    """η_E (J), shape (elements,)."""
    error: NDArray[np.float64]
    """√((1/T)∫η_E dt) up to here (J^½), shape (elements,); at the end e_E, eq. [20]."""
    displacement: NDArray[np.float64] | None = None
    """u_CA (m), shape (nodes, dimension)."""
    velocity: NDArray[np.float64] | None = None
    """du_CA/dt (m/s), shape (nodes, dimension)."""
    acceleration: NDArray[np.float64] | None = None
    """Mean of Γ_DA/ρ (m/s²), shape (elements, dimension)."""
    stress: NDArray[np.float64] | None = None
    """Mean of σ_DA (Pa), shape (elements, dimension, dimension)."""
    compatible_stress: NDArray[np.float64] | None = None
    """σ_CA = Kε(u_CA) (Pa), shape (elements, dimension, dimension)."""

    def __repr__(self) -> str:
        fields = "" if self.stress is None else ", with fields"
        return f"<percute.ElementMap: {len(self.total)} elements at {self.time:.4g} s{fields}>"
