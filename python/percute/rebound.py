"""The rebound of a body."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from percute.documents import record

__all__ = ["NextTouch", "Rebound"]


@dataclass(frozen=True, kw_only=True)
class NextTouch:
    """The first point of a body in flight that would reach a plane."""

    node: int
    """Its node."""
    plane: int
    """The plane, its place in ``problem.obstacles``."""
    time: float
    """The instant (s)."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Rebound:
    """Velocities of the centre of mass, V = Σ m v / Σ m, before the first contact and after the last one.

    Normal components are along the normal of the plane that gives the largest impulse, positive away from it.
    """

    velocity_before: NDArray[np.float64]
    """V at the last instant before the first contact force (m/s), shape (dimension,)."""
    velocity_after: NDArray[np.float64] | None
    """V at the first instant after the last contact force (m/s); None if contact has not ended."""
    normal_before: float
    """Normal component of ``velocity_before`` (m/s)."""
    normal_after: float | None
    """Normal component of ``velocity_after`` (m/s)."""
    restitution: float | None
    """Coefficient of restitution −V′·n / V·n, from 0 on."""
    no_restitution: str | None
    """Why there is none: contact has not ended, supports or loads change the velocity, or the body does not arrive, or still does."""
    first_touch: float
    """The first instant at which a node touches (s)."""
    release: float | None
    """The last instant at which a node touches (s); None if contact has not ended."""
    time_in_contact: float
    """For how long a node touches: the sum of all phases (s)."""
    span: float
    """From the first touch to the release, or to the end of the run, with the flights between phases (s)."""
    ended: bool
    """Whether contact has ended."""
    angular_velocity_after: float | None = None
    """Angular velocity at the last instant, counterclockwise (rad/s); None if contact has not ended, of a bar, or of a history."""
    touches_again: NextTouch | None = None
    """The first point that would reach a plane again by turning, if the run went on, without loads; None of a history."""

    @classmethod
    def _of(cls, found: Mapping[str, Any] | None) -> Rebound | None:
        """Make it from its JSON object."""
        # Estimate files of earlier versions have no reason, and call the span time in contact.
        return None if found is None else record(cls, {"no_restitution": None, "span": found["time_in_contact"], **found})
