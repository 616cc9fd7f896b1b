"""Several bodies that may touch each other."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute
from percute.checks import flag, instance, number, text
from percute.errors import InputError
from percute.mesh import Mesh
from percute.statement import Elastic, Vector, vector_of

__all__ = ["Body", "Interface"]


@dataclass(frozen=True, kw_only=True)
class Body:
    """One of several bodies: a mesh in its place, with its material and its initial velocity.

    Parameters
    ----------
    name : str
        Its name, without a dot: its groups become "name.group", its elements the group "name".
    mesh : Mesh
        Its mesh.
    material : Elastic
        The material of all its elements.
    origin : (dimension,) floats, optional
        Where the origin of the mesh lies (m); zero unless given.
    rotation : float, default: 0
        Angle by which the mesh is turned about its origin, counterclockwise (degrees); not for a bar.
    velocity : (dimension,) floats, optional
        v₀ of all its nodes (m/s), eq. [7]; zero unless given.
    """

    name: str
    mesh: Mesh
    material: Elastic
    origin: Vector | ArrayLike | None = None
    rotation: float = 0.0
    velocity: Vector | ArrayLike | None = None

    def __post_init__(self) -> None:
        if not text("name", self.name) or "." in self.name:
            raise InputError(f"`name` is {self.name!r}; it must be a name without a dot, which joins it to the names of its groups")
        instance("mesh", self.mesh, Mesh)
        instance("material", self.material, Elastic)
        object.__setattr__(self, "rotation", number("rotation", self.rotation, finite=True, unit="degrees"))
        dimension = self.mesh.dimension
        if dimension == 1 and self.rotation != 0.0:
            raise InputError(f"`rotation` is {self.rotation}; it does not apply to a bar")
        for name, unit in (("origin", "m"), ("velocity", "m/s")):
            given = getattr(self, name)
            made = (0.0,) * dimension if given is None else vector_of(name, given, dimension, unit)
            object.__setattr__(self, name, made)

    def _placed(self) -> Mesh:
        """Give the mesh in its place."""
        return Mesh._of(self.mesh._data.placed(cast("Vector", self.origin), self.rotation))


def _two(name: str, given: object, what: str) -> tuple[str, ...]:
    """Give two names."""
    names = tuple(given) if isinstance(given, Iterable) and not isinstance(given, str) else (given,)
    if len(names) != 2:
        raise InputError(f"`{name}` is {given!r}; it must be two {what}")
    return tuple(text(name, each) for each in names)


@dataclass(frozen=True, kw_only=True)
class Interface:
    """Two bodies that may touch, with Coulomb friction, eq. [1] to [3].

    Give ``bodies`` or ``groups``. With neither, it is the contact of all bodies of which no other one is stated.

    Parameters
    ----------
    bodies : (str, str), optional
        The names of two bodies. The edges that see each other are looked for, from their places and velocities.
    groups : (str, str), optional
        A group of edges of each of two bodies, as in ``("anvil.top", "hammer.bottom")``.
    friction : float
        Coefficient of friction μ, 0 without friction. Required but for bars, which have none.
    matching : bool, optional
        True: the nodes face each other in pairs, which differ by a gap along one common normal only and stay pairs during the
        run. A pair that slips by more than a small part of an edge leaves the range of the method. False: surfaces of any
        nodes, which may slide along each other. By default pairs where the nodes face each other; without ``groups`` only if
        the bodies slide by less than a tenth of an edge, as far as their velocities tell.
    """

    groups: tuple[str, str] | Sequence[str] | None = None
    friction: float | None = None
    bodies: tuple[str, str] | Sequence[str] | None = None
    matching: bool | None = None

    def __post_init__(self) -> None:
        if self.groups is not None and self.bodies is not None:
            raise InputError("`groups` cannot be given together with `bodies`, for which the edges are found; give one of the two")
        if self.groups is not None:
            object.__setattr__(self, "groups", _two("groups", self.groups, "groups of edges, as in ('anvil.top', 'hammer.bottom')"))
        if self.bodies is not None:
            object.__setattr__(self, "bodies", _two("bodies", self.bodies, "names of bodies, as in ('anvil', 'hammer')"))
        if self.matching is not None:
            object.__setattr__(self, "matching", flag("matching", self.matching))
        if self.friction is not None:
            object.__setattr__(self, "friction", number("friction", self.friction))


def join(bodies: Sequence[Body]) -> tuple[Mesh, dict[str, Elastic], NDArray[np.float64]]:
    """Give the mesh of all bodies, the material of each by its name, and the initial velocity of each node (m/s)."""
    names = [body.name for body in bodies]
    for name in names:
        if names.count(name) > 1:
            raise InputError(f"`bodies` has the name {name!r} twice; give each body its own")
    if len({body.mesh.dimension for body in bodies}) > 1:
        raise InputError("`bodies` are bars and plane bodies; they must be all bars or all plane")
    made = Mesh._of(_percute.MeshData.joined([(body.name, body._placed()._data) for body in bodies]))
    velocity = [np.tile(np.asarray(cast("Vector", body.velocity), dtype=float), (len(body.mesh.points), 1)) for body in bodies]
    return made, {body.name: body.material for body in bodies}, np.concatenate(velocity)
