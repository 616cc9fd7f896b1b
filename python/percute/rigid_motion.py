"""The mean motion of a body over time: centre of mass, rotation and momenta."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from percute.checks import text, wrong
from percute.mesh import Mesh
from percute.steps import Steps

__all__ = ["RigidMotion"]

Floats = NDArray[np.float64]
AT_ONCE = 1_000_000
"""Nodes times instants that are read at once."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RigidMotion:
    """The mean motion of a body, with its lumped masses. Shapes begin with the number of instants."""

    time: Floats
    """The instants t_n (s)."""
    mass: float
    """The mass (kg), per metre of thickness where none is given."""
    centre: Floats
    """The centre of mass (m), shape (instants, dimension)."""
    velocity: Floats
    """Its velocity (m/s), shape (instants, dimension)."""
    rotation: Floats
    """The mean rotation since the undeformed mesh, counterclockwise and without jumps (rad): that of Σ m (x − x̄)(X − X̄)ᵀ. 0 of a bar."""
    angular_velocity: Floats
    """The angular momentum about the centre over the present moment of inertia (rad/s). 0 of a bar."""
    momentum: Floats
    """The linear momentum (kg m/s), shape (instants, dimension)."""
    angular_momentum: Floats
    """The angular momentum about the origin (kg m²/s), counterclockwise. 0 of a bar."""


def rigid_motion(history: Steps, group: object) -> RigidMotion:
    """Give the mean motion of all elements or of a group of them."""
    problem, mesh = history.problem, history.problem.mesh
    nodes = _nodes(mesh, group)
    mass, places = problem.mass[nodes], mesh.points[nodes]
    undeformed = places - mass @ places / mass.sum()
    count = max(AT_ONCE // len(nodes), 1)
    parts = [
        _instants(mass, undeformed, places + history.displacement[start : start + count, nodes], history.velocity[start : start + count, nodes])
        for start in range(0, len(history), count)
    ]
    centre, velocity, rotation, spin, angular = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
    return RigidMotion(
        time=history.time,
        mass=float(mass.sum()),
        centre=centre,
        velocity=velocity,
        rotation=np.unwrap(rotation),
        angular_velocity=spin,
        momentum=mass.sum() * velocity,
        angular_momentum=angular,
    )


def _instants(mass: Floats, undeformed: Floats, places: Floats, velocity: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """Give centre, its velocity, rotation, angular velocity and angular momentum of some instants."""
    share = mass / mass.sum()
    centre, mean = np.tensordot(places, share, (1, 0)), np.tensordot(velocity, share, (1, 0))
    if places.shape[2] == 1:
        still = np.zeros(len(places))
        return centre, mean, still, still, still
    away, relative = places - centre[:, None], velocity - mean[:, None]
    turned = np.einsum("n,tna,nb->tab", mass, away, undeformed)
    rotation = np.arctan2(turned[:, 1, 0] - turned[:, 0, 1], turned[:, 0, 0] + turned[:, 1, 1])
    own = (away[..., 0] * relative[..., 1] - away[..., 1] * relative[..., 0]) @ mass
    spin = own / ((away**2).sum(axis=2) @ mass)
    return centre, mean, rotation, spin, own + mass.sum() * (centre[:, 0] * mean[:, 1] - centre[:, 1] * mean[:, 0])


def _nodes(mesh: Mesh, group: object) -> NDArray[np.int64]:
    """Give the nodes of a group of elements, or of all."""
    if group is None:
        return np.unique(mesh.cells).astype(np.int64)
    name = text("group", group)
    if name not in mesh.element_groups:
        known = ", ".join(repr(known) for known in mesh.element_groups) or "the mesh has none"
        raise wrong("group", group, f"the name of a group of elements: {known}")
    nodes = np.unique(mesh.cells[mesh.element_groups[name]]).astype(np.int64)
    others = np.delete(mesh.cells, mesh.element_groups[name], axis=0)
    if np.isin(nodes, others).any():
        raise wrong("group", group, "a whole body: its elements share nodes with others, which have one mass for both")
    return nodes
