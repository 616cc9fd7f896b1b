"""Parts of an estimate."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from percute.words import counted

NEGATIVE = 0.2
"""The part of η by which a source may be negative before no change is predicted."""

__all__ = ["ElementMap", "OverTime", "Parts", "Separation", "Sources", "SourcesOverTime", "WorstElement"]


@dataclass(frozen=True)
class Parts:
    """The parts of η (J), eq. [14]."""

    kinetic: float
    """Kinetic: the misfit of the law of inertia, ½∫ρ(u̇_DA − u̇_CA)²."""
    elastic: float
    """From stress: ½∫(σ_DA − σ_CA):K⁻¹(σ_DA − σ_CA)."""
    dissipation: float
    """Of materials that yield, else 0: the misfit of hardening, ∫⅓C|Δε_p|² + ½H_i Δp², and of dissipation, ∫₀ᵗ∫φ(Ė_CA) − Σ_DA·Ė_CA."""
    contact: float
    """From the contact law: 2∫∫[b(−w_CA, F_DA) + w_CA·F_DA]; with ``corrected`` its tangential part, ∫F_n gap and ∫∫F_n|w_n| dt."""

    @property
    def total(self) -> float:
        """η (J)."""
        return self.kinetic + self.elastic + self.dissipation + self.contact


@dataclass(frozen=True)
class Sources:
    """The sources of η (J). One may be slightly negative; their sum is η."""

    surface: float
    """At the contact surface: friction, gaps under pressure, the contact part of the difference to the auxiliary solution, and the
    misfit of the elements with a node that may touch beyond this difference."""
    front: float
    """∫∫R_n|w_n| dt: the energy that reactions take from arriving nodes."""
    dispersion: float
    """The rest of the difference to the auxiliary solution: dispersion that has accumulated."""
    mesh: float
    """The misfit of the other elements beyond this difference."""

    @property
    def total(self) -> float:
        """Their sum (J)."""
        return self.surface + self.front + self.dispersion + self.mesh


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class SourcesOverTime:
    """The sources of η at the samples of `OverTime` (J), each of shape (samples,)."""

    surface: NDArray[np.float64]
    """At the contact surface."""
    front: NDArray[np.float64]
    """Of the front."""
    dispersion: NDArray[np.float64]
    """Of dispersion."""
    mesh: NDArray[np.float64]
    """Of the mesh in the rest of the body."""

    @property
    def total(self) -> NDArray[np.float64]:
        """Their sum, η (J)."""
        return self.surface + self.front + self.dispersion + self.mesh

    def __repr__(self) -> str:
        return f"<percute.SourcesOverTime: {counted(len(self.surface), 'sample')}>"


@dataclass(frozen=True, eq=False, kw_only=True)
class Separation:
    """The sources of the error, and what a finer mesh or a shorter step would change; defined in ``docs/sources.md``."""

    at_sup: Sources
    """At the time of the largest η (J)."""
    mean: Sources
    """Their means over time (J); the sum is ``mean`` of the estimate, squared."""
    halved_elements: Sources
    """The means expected with elements and steps half as long (J)."""
    halved_step: float
    """The expected change of the sum of the means with steps half as long (J)."""
    over_time: SourcesOverTime = field(repr=False)
    """At all samples (J)."""

    @property
    def mean_with_halved_elements(self) -> float | None:
        """The mean error expected with elements and steps half as long (J^½).

        None where the sources do not separate: where the mean of one is below −20 % of η, as on bars near the critical step.
        """
        return self._expected(self.halved_elements.total)

    @property
    def mean_with_halved_step(self) -> float | None:
        """The mean error expected with steps half as long (J^½); None where the sources do not separate."""
        return self._expected(self.mean.total + self.halved_step)

    def _expected(self, total: float) -> float | None:
        least = min(self.mean.surface, self.mean.front, self.mean.dispersion, self.mean.mesh)
        return math.sqrt(total) if total > 0.0 and least >= -NEGATIVE * self.mean.total else None


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
    dissipation: NDArray[np.float64]
    """Plastic part of η (J); 0 where no material yields."""
    contact: NDArray[np.float64]
    """Contact part of η (J)."""
    total: NDArray[np.float64]
    """η (J)."""
    reference: NDArray[np.float64]
    """d (J), eq. [24]."""

    def __repr__(self) -> str:
        return f"<percute.OverTime: {counted(len(self.time), 'sample')} to {self.time[-1]:.4g} s, sup of η {self.total.max():.4g} J>"


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
    dissipation: NDArray[np.float64]
    """Plastic part of η_E (J), shape (elements,)."""
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
        return f"<percute.ElementMap: {counted(len(self.total), 'element')} at {self.time:.4g} s{fields}>"
