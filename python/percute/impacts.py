"""What contact did to several bodies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.documents import record

__all__ = ["BodyMotion", "Impacts", "InterfaceRebound", "NonMatchingEstimate"]


@dataclass(frozen=True, eq=False, kw_only=True)
class BodyMotion:
    """The motion of the centre of mass of a body, V = Σ m v / Σ m."""

    name: str
    """Its name."""
    mass: float
    """Its mass (kg)."""
    velocity_before: NDArray[np.float64]
    """V at the start (m/s), shape (dimension,)."""
    velocity_after: NDArray[np.float64] | None
    """V at the last instant (m/s); None with supports or loads on the body, which change it, too."""
    angular_velocity_after: float | None = None
    """Its angular velocity there, counterclockwise (rad/s); None of a bar, or of a history."""


@dataclass(frozen=True, eq=False, kw_only=True)
class InterfaceRebound:
    """How two bodies come together and part: the relative velocity of their centres of mass along the normal."""

    groups: tuple[str, str]
    """The groups of edges of both bodies."""
    normal: NDArray[np.float64]
    """The normal, from the second body to the first one, shape (dimension,)."""
    normal_before: float | None
    """(V₁ - V₂)·n at the last instant before the first contact force (m/s), negative while they come nearer."""
    normal_after: float | None
    """The same at the first instant after the last one (m/s); None if contact has not ended."""
    restitution: float | None
    """Coefficient of restitution, the latter over the former, negative."""
    no_restitution: str | None
    """Why there is none."""
    first_touch: float | None
    """The first instant at which a pair of nodes touches (s); None without contact."""
    release: float | None
    """The last instant at which a pair touches (s); None if contact has not ended."""
    time_in_contact: float
    """For how long a pair touches: the sum of all phases (s)."""
    span: float
    """From the first touch to the release, or to the end of the run, with the flights between phases (s)."""
    ended: bool
    """Whether contact has ended."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Impacts:
    """What contact did to several bodies."""

    bodies: tuple[BodyMotion, ...]
    """The bodies, in the order of their first nodes."""
    interfaces: tuple[InterfaceRebound, ...]
    """The interfaces, in the order of ``problem.contacts``."""

    @classmethod
    def _of(cls, found: Mapping[str, Any] | None) -> Impacts | None:
        """Make it from its JSON object."""
        if found is None:
            return None
        # Estimate files of earlier versions call the span time in contact.
        return record(cls, {**found, "interfaces": [{"span": each["time_in_contact"], **each} for each in found["interfaces"]]})


@dataclass(frozen=True, kw_only=True)
class NonMatchingEstimate:
    """The estimate at a non-matching interface."""

    groups: tuple[str, str]
    """The groups of edges of both bodies."""
    couple: float | None
    """The largest couple of the normal forces on both bodies, over the largest of these forces (m); None in files of earlier versions."""
    slide: float
    """How far they are along each other from their places at the start, at most (m)."""
    lift: float
    """The largest height by which a node gives way in the admissible motion (m)."""
    rounds: int
    """How often the penetration of the admissible motion was looked for, until there was none."""
    stress: float
    """The part of the squared mean error that comes from the stress of the contact density beside its linear part."""
