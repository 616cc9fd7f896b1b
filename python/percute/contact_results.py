"""The values of contact results at each node and instant, and their resultants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from percute._percute import contact_name, unit
from percute.mesh import Mesh
from percute.words import counted

__all__ = ["ContactResults", "ContactStatus", "Resultants"]


class ContactStatus(IntEnum):
    """Status of a contact node under its reaction R_n, in the step from t_n to t_{n+1}."""

    FREE = 0
    """Free: R_n is zero."""
    STICK = 1
    """Stick: R_n is inside Coulomb's cone."""
    SLIP = 2
    """Slip: R_n is on the cone, eq. [2]. Without friction all contact slips."""


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Resultants:
    """Resultants of the nodes of one plane, or of all planes, at each instant."""

    force: NDArray[np.float64]
    """ΣR_n (N), global axes, shape (instants, dimension)."""
    normal_force: NDArray[np.float64]
    """Sum of the normal components (N), shape (instants,)."""
    impulse: NDArray[np.float64]
    """Impulse on the body up to t_n (N s), shape (instants, dimension)."""
    area: NDArray[np.float64]
    """Area of contact (m²): the shares of the nodes that are not free, shape (instants,)."""
    in_contact: NDArray[np.int64]
    """Number of nodes that are not free, shape (instants,)."""
    slipping: NDArray[np.int64]
    """Number of slipping nodes, shape (instants,)."""
    friction_energy: NDArray[np.float64]
    """Energy dissipated by friction up to t_n (J), shape (instants,)."""
    centre: NDArray[np.float64]
    """Centre of pressure at t_n (m), NaN without contact, shape (instants, dimension)."""
    per_metre: bool = False
    """Whether forces and energies are per metre of thickness."""

    def __repr__(self) -> str:
        peak = self.normal_force.max(initial=0.0)
        return f"<percute.Resultants: {counted(len(self.area), 'instant')}, at most {peak:.4g} {unit('N', self.per_metre)} on {counted(int(self.in_contact.max(initial=0)), 'node')}>"


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class ContactResults:
    """What a `percute.Contact` holds."""

    time: NDArray[np.float64]
    """Instants t_n (s), shape (instants,)."""
    nodes: NDArray[np.int64]
    """Nodes of the contact surface, along the boundary, shape (contact nodes,)."""
    obstacle: NDArray[np.int64]
    """The plane that each of them may touch, shape (contact nodes,); after the planes, the two sides of each interface of bodies."""
    points: NDArray[np.float64]
    """Their undeformed positions (m), shape (contact nodes, dimension)."""
    normals: NDArray[np.float64]
    """Outward unit normals of their planes, shape (contact nodes, dimension)."""
    area: NDArray[np.float64]
    """Their shares ℓ_k of the candidate edges, with thickness or section (m²), shape (contact nodes,), eq. [45]. On a body that turns all
    edges are candidates, and ``area_over_time`` has the shares that count."""
    force: NDArray[np.float64]
    """R_n (N), global axes, shape (instants, contact nodes, dimension)."""
    gap: NDArray[np.float64]
    """Gap at t_n (m), shape (instants, contact nodes), eq. [3]."""
    sliding_velocity: NDArray[np.float64]
    """Tangential part of (u_{n+1} − u_n)/Δt_n (m/s), at the last instant that of the last step; 0 where free; global axes,
    shape (instants, contact nodes, dimension)."""
    status: NDArray[np.uint8]
    """`ContactStatus` under R_n, shape (instants, contact nodes)."""
    friction_energy: NDArray[np.float64]
    """Energy dissipated by friction up to t_n (J), shape (instants, contact nodes)."""
    first_touch: NDArray[np.float64]
    """The first t_n at which each node touches (s), NaN if it never touches, shape (contact nodes,)."""
    time_in_contact: NDArray[np.float64]
    """Total time for which each node was not free (s), shape (contact nodes,)."""
    peak_normal_force: NDArray[np.float64]
    """Largest normal force on each node (N), shape (contact nodes,)."""
    time_of_peak: NDArray[np.float64]
    """Time of this force (s), NaN without force, shape (contact nodes,)."""
    peak_pressure: NDArray[np.float64]
    """Largest pressure on each node (Pa), shape (contact nodes,)."""
    impulse: NDArray[np.float64]
    """Impulse of each node (N s), shape (contact nodes, dimension)."""
    resultants: Resultants
    """Resultants of all planes over time, and of the first side of each interface of bodies."""
    obstacles: tuple[Resultants, ...]
    """Resultants of each plane, then of both sides of each interface of bodies."""
    surfaces: tuple[str | None, ...]
    """For each of ``obstacles`` None if it is a plane, or the group of edges of this side of an interface of bodies."""
    mesh: Mesh = field()
    """The mesh."""
    _area_over_time: NDArray[np.float64] | None = None
    per_metre: bool = False
    """Whether forces and energies are per metre of thickness."""

    @classmethod
    def _of(cls, arrays: dict[str, Any], mesh: Mesh, surfaces: Sequence[str | None], per_metre: bool) -> Self:
        resultants = Resultants(**arrays.pop("resultants"), per_metre=per_metre)
        obstacles = tuple(Resultants(**each, per_metre=per_metre) for each in arrays.pop("obstacles"))
        areas = arrays.pop("area_over_time", None)
        return cls(**arrays, _area_over_time=areas, resultants=resultants, obstacles=obstacles, mesh=mesh, surfaces=tuple(surfaces), per_metre=per_metre)

    @cached_property
    def _names(self) -> dict[int, str]:
        """The name of each obstacle that counts: each plane, and the first side of each interface of bodies."""
        planes = sum(surface is None for surface in self.surfaces)
        sides = range(planes, len(self.surfaces), 2)
        names = {k: contact_name(self.surfaces[k] or "", self.surfaces[k + 1] or "") for k in sides}
        return {k: f"plane {k}" for k in range(planes)} | names

    @property
    def area_over_time(self) -> NDArray[np.float64]:
        """ℓ_k at t_n (m²), shape (instants, contact nodes): that of ``area``, but on a body that turns its undeformed edges times the cosines of
        their angles to the plane."""
        if self._area_over_time is None:
            return np.broadcast_to(self.area, (len(self.time), len(self.area)))
        return self._area_over_time

    @cached_property
    def density(self) -> NDArray[np.float64]:
        """R_n/ℓ_k (Pa), global axes, shape (instants, contact nodes, dimension), eq. [45]."""
        return _read_only(self.force / self.area_over_time[..., None])

    @cached_property
    def normal_force(self) -> NDArray[np.float64]:
        """Normal component of R_n (N), shape (instants, contact nodes)."""
        return _read_only(np.einsum("ncd,cd->nc", self.force, self.normals))

    @cached_property
    def tangential_force(self) -> NDArray[np.float64]:
        """Tangential part of R_n (N), global axes, shape (instants, contact nodes, dimension)."""
        return _read_only(self.force - self.normal_force[..., None] * self.normals)

    @cached_property
    def pressure(self) -> NDArray[np.float64]:
        """Normal component of the density (Pa), shape (instants, contact nodes)."""
        return _read_only(self.normal_force / self.area_over_time)

    def __repr__(self) -> str:
        peak = self.resultants.normal_force.max(initial=0.0)
        return f"<percute.Contact: {counted(len(self.nodes), 'node')}, {counted(len(self.time), 'instant')}, at most {peak:.4g} {unit('N', self.per_metre)}>"


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.flags.writeable = False
    return array
