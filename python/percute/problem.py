"""Problems: bodies with their materials, supports, loads and obstacles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from percute import _percute, notebook
from percute.arrays import numbers, transposed
from percute.bodies import Body, Interface, join
from percute.checks import instance, items, table, wrong
from percute.errors import InputError
from percute.immutable import Immutable
from percute.mesh import Mesh
from percute.statement import BodyForce, Elastic, Plane, Support, Traction

__all__ = ["Problem"]


def _law(law: Elastic) -> str:
    """Tell the properties of a material."""
    told = f"E = {law.young:.4g} Pa, ρ = {law.density:.4g} kg/m³"
    return told if law.poisson is None else f"{told}, ν = {law.poisson:g}, plane {law.plane}"


def _materials(material: Elastic | Mapping[str, Elastic] | None) -> list[tuple[str | None, Elastic]]:
    if isinstance(material, Elastic):
        return [(None, material)]
    groups = table("material", material, "Elastic, or one Elastic")
    return [(group, instance(f"material[{group!r}]", each, Elastic)) for group, each in groups.items()]


def _weights(gravity: ArrayLike | None, materials: Iterable[tuple[str | None, Elastic]], dimension: int) -> list[BodyForce]:
    """Give the weight of each material."""
    if gravity is None:
        return []
    acceleration = np.atleast_1d(numbers("gravity", gravity, most=1, finite=True))
    if acceleration.shape != (dimension,):
        raise wrong("gravity", gravity, f"{dimension} finite numbers in m/s²" if dimension > 1 else "a finite number in m/s²")
    return [BodyForce(value=material.density * acceleration, group=group) for group, material in materials]


def _contacts(contacts: Iterable[Interface], mesh: Mesh) -> list[Interface]:
    """Check that plane bodies have a coefficient of friction."""
    given = items("contacts", contacts, Interface)
    for i, contact in enumerate(given):
        if contact.friction is None and mesh.dimension > 1:
            raise InputError(f"`contacts[{i}].friction` is missing: give the coefficient of friction, 0 without friction")
    return given


def _field(name: str, field: ArrayLike | None, mesh: Mesh) -> NDArray[np.float64] | None:
    """Give one row for all nodes, or one row for each node."""
    if field is None:
        return None
    array = numbers(name, field, most=2)
    nodes, dimension = mesh.points.shape
    if array.ndim == 2 and array.shape == (dimension, nodes) != (nodes, dimension):
        raise InputError(f"`{name}` has the shape {array.shape}; it must have ({nodes}, {dimension}){transposed(name, array, dimension)}")
    return array[:, None] if mesh.dimension == 1 and array.ndim == 1 else np.atleast_2d(array)


class Problem(Immutable):
    """An elastic body that may strike rigid planes, or several that may strike each other, checked at its creation.

    Parameters
    ----------
    mesh : Mesh
        The mesh of one body.
    material : Elastic or dict of str to Elastic
        The material of all elements, or of each group of elements.
    bodies : sequence of Body, optional
        Several bodies, each with its mesh, its material and its velocity, instead of ``mesh``, ``material`` and
        ``initial_velocity``. The groups of a body are "name.group".
    contacts : sequence of Interface, default: ()
        Bodies that may touch. With ``bodies``, all that could touch need one with their coefficient of friction: an
        `Interface` of their own or one of all, ``Interface(friction=0.2)``; bars need none.
    obstacles : sequence of Plane, default: ()
        Planes that the body may touch, a node one with each of its edges.
    supports : sequence of Support, default: ()
        Where the motion is prescribed, eq. [4].
    tractions : sequence of Traction, default: ()
        Forces on the boundary, eq. [8].
    body_forces : sequence of BodyForce, default: ()
        Forces in the volume, eq. [8].
    gravity : (dimension,) floats, optional
        Acceleration of the weight of all bodies (m/s²), such as ``(0, -9.81)``: a `BodyForce` of density times gravity for each
        material, which `body_forces` then has too.
    initial_velocity : (dimension,) or (nodes, dimension) floats, optional
        v₀ (m/s), eq. [7]: the same for all nodes, or one for each; zero unless given. A bar takes one number, or (nodes,).
    initial_displacement : (dimension,) or (nodes, dimension) floats, optional
        u₀ (m), eq. [6]; likewise.

    Raises
    ------
    InputError
        With the name of the argument at fault.
    """

    _data: _percute.ProblemData
    _mesh: Mesh

    def __init__(
        self,
        mesh: Mesh | None = None,
        *,
        material: Elastic | Mapping[str, Elastic] | None = None,
        bodies: Iterable[Body] = (),
        contacts: Iterable[Interface] = (),
        obstacles: Iterable[Plane] = (),
        supports: Iterable[Support] = (),
        tractions: Iterable[Traction] = (),
        body_forces: Iterable[BodyForce] = (),
        gravity: ArrayLike | None = None,
        initial_velocity: ArrayLike | None = None,
        initial_displacement: ArrayLike | None = None,
    ) -> None:
        several = items("bodies", bodies, Body)
        if several:
            for name, given, instead in (("mesh", mesh, "mesh"), ("material", material, "material"), ("initial_velocity", initial_velocity, "velocity")):
                if given is not None:
                    raise InputError(f"`{name}` cannot be given together with `bodies`; each Body has its own `{instead}`")
            mesh, material, initial_velocity = join(several)
        mesh = instance("mesh", mesh, Mesh)
        self._mesh = mesh
        between = _contacts(contacts, mesh)
        materials = _materials(material)
        self._data = _percute.ProblemData(
            mesh._data,
            materials,
            items("obstacles", obstacles, Plane),
            between,
            items("supports", supports, Support),
            items("tractions", tractions, Traction),
            items("body_forces", body_forces, BodyForce) + _weights(gravity, materials, mesh.dimension),
            _field("initial_velocity", initial_velocity, mesh),
            _field("initial_displacement", initial_displacement, mesh),
            bool(several),
        )
        if several or between:
            # Edges that were looked for are groups of the mesh.
            self._mesh = Mesh._of(self._data.mesh())

    @classmethod
    def _of(cls, data: _percute.ProblemData) -> Problem:
        problem = cls.__new__(cls)
        problem._data = data
        problem._mesh = Mesh._of(data.mesh())
        return problem

    @property
    def mesh(self) -> Mesh:
        """The mesh."""
        return self._mesh

    @cached_property
    def material(self) -> Elastic | dict[str, Elastic]:
        """The material of all elements, or of each group."""
        groups = [(group, Elastic(**arguments)) for group, arguments in self._data.materials()]
        if len(groups) == 1 and groups[0][0] is None:
            return groups[0][1]
        return {group: material for group, material in groups if group is not None}

    @cached_property
    def obstacles(self) -> tuple[Plane, ...]:
        """The planes."""
        return tuple(Plane(**arguments) for arguments in self._data.obstacles())

    @cached_property
    def contacts(self) -> tuple[Interface, ...]:
        """The surfaces of different bodies that may touch."""
        return tuple(Interface(**arguments) for arguments in self._data.contacts())

    @cached_property
    def supports(self) -> tuple[Support, ...]:
        """The supports."""
        return tuple(Support(**arguments) for arguments in self._data.supports())

    @cached_property
    def tractions(self) -> tuple[Traction, ...]:
        """The tractions."""
        return tuple(Traction(**arguments) for arguments in self._data.tractions())

    @cached_property
    def body_forces(self) -> tuple[BodyForce, ...]:
        """The body forces."""
        return tuple(BodyForce(**arguments) for arguments in self._data.body_forces())

    @cached_property
    def initial_velocity(self) -> NDArray[np.float64]:
        """v₀ at the nodes (m/s), shape (nodes, dimension), eq. [7]; a read-only view."""
        return self._data.initial_velocity

    @cached_property
    def initial_displacement(self) -> NDArray[np.float64]:
        """u₀ at the nodes (m), shape (nodes, dimension), eq. [6]; a read-only view."""
        return self._data.initial_displacement

    @property
    def per_metre(self) -> bool:
        """Whether forces, energies and masses are per metre of thickness: those of plane bodies whose thickness is 1 m, as it is unless given."""
        return self._data.per_metre

    @cached_property
    def mass(self) -> NDArray[np.float64]:
        """Lumped mass of each node (kg), shape (nodes,), eq. [35]; a read-only view."""
        return self._data.mass

    @cached_property
    def contact_nodes(self) -> NDArray[np.int64]:
        """Nodes that may touch a plane, shape (contact nodes,), along the boundary."""
        return self._data.contact_nodes

    @property
    def critical_time_step(self) -> float:
        """Critical time step Δt_c = 2/ω_max (s), eq. [34]."""
        return self._data.critical_time_step

    @property
    def wave_speed(self) -> float:
        """Largest speed of waves (m/s)."""
        return self._data.wave_speed

    def on(self, mesh: Mesh) -> Problem:
        """Give the same problem on another mesh of its body.

        Parameters
        ----------
        mesh : Mesh
            It has the groups that the problem names. Initial fields are those of this problem's mesh, linear in its elements; at points
            outside it, as in the nearest element.

        Returns
        -------
        Problem

        Raises
        ------
        InputError
            A group is missing, or the problem is not consistent on this mesh, as where surfaces no longer match.
        """
        return Problem._of(self._data.on(instance("mesh", mesh, Mesh)._data))

    def _repr_html_(self) -> str:
        material = self.material
        laws = [("", material)] if isinstance(material, Elastic) else [(f" of {name}", law) for name, law in material.items()]
        rows = notebook.mesh_rows(self.mesh)[:2]
        rows += [(f"material{of}", _law(law)) for of, law in laws]
        rows += [("plane", f"friction {each.friction:g}, normal {notebook.vector(each.normal)}") for each in self.obstacles]
        rows += [(name.replace("_", " "), str(len(members))) for name in ("supports", "tractions", "body_forces") if (members := getattr(self, name))]
        speeds = np.linalg.norm(self.initial_velocity, axis=1)
        rows += [("mass", f"{self.mass.sum():.4g} kg"), ("speed at the start", f"at most {speeds.max():.4g} m/s, of waves {self.wave_speed:.4g} m/s")]
        return notebook.page("Problem", rows, notebook.outline(self.mesh))

    def __repr__(self) -> str:
        parts = [repr(self.mesh)[len("<percute.Mesh: ") : -1]]
        for name in ("contacts", "obstacles", "supports", "tractions", "body_forces"):
            count = len(getattr(self, name))
            if count:
                label = name.replace("_", " ")
                parts.append(f"{count} {label.removesuffix('s') if count == 1 else label}")
        return f"<percute.Problem: {', '.join(parts)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        values = {name: getattr(self, name) for name in ("material", "contacts", "obstacles", "supports", "tractions", "body_forces")}
        fields = {name: getattr(self, name).copy() for name in ("initial_velocity", "initial_displacement")}
        return partial(Problem, self.mesh, **values, **fields), ()
