"""The statement of a problem: values, compared and shown by their contents.

The types of their parts are checked here; whether they make sense on a mesh is checked when `Problem` puts them together.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from percute.arrays import numbers
from percute.checks import number, text, wrong
from percute.errors import InputError
from percute.words import counted

__all__ = ["BodyForce", "Elastic", "Plane", "Support", "Traction"]

AXES = """"x", "y", "z" or several, as in ("x", "y")"""
"""The components that a support may have."""

Vector = tuple[float, ...]
Rows = tuple[Vector, ...]


def vector(name: str, value: object) -> Vector:
    return tuple(np.atleast_1d(numbers(name, value, most=1)).tolist())


def vector_of(name: str, value: object, dimension: int, unit: str) -> Vector:
    """Give a finite vector with a component for each axis."""
    made = vector(name, value)
    if not np.isfinite(made).all():
        raise InputError(f"`{name}` is {made}; it must be finite ({unit})")
    if len(made) != dimension:
        needed = ("one number for a bar", "two numbers, x and y", "three numbers, x, y and z")[dimension - 1]
        raise InputError(f"`{name}` has {len(made)} numbers; it must have {needed} ({unit})")
    return made


def _table(name: str, value: object, time: object, columns: tuple[str, ...] | None) -> tuple[Vector | Rows, Vector | None]:
    """Check a value that is constant or has a row for each instant; ``columns`` names the components it must have."""
    needed = "" if columns is None else f"{counted(len(columns), 'number')}, one for each of `components`, {', '.join(columns)}"
    if time is None:
        if columns is not None and np.ndim(numbers(name, value, most=2)) == 2:
            raise InputError(f"`{name}` has rows, but `time` is missing: give the instant of each row (s), or {needed}")
        constant = vector(name, value)
        if columns is not None and len(constant) != len(columns):
            more = "; for a velocity that varies give `time`, too" if len(constant) > len(columns) else ""
            raise InputError(f"`{name}` has {counted(len(constant), 'number')}; it must have {needed}{more}")
        return constant, None
    array = numbers(name, value, most=2)
    if array.ndim == 1 and (columns is None or len(columns) == 1):
        array = array[:, None]
    if array.ndim != 2 or (columns is not None and array.shape[1] != len(columns)):
        row = "a row" if columns is None else f"a row of {needed},"
        raise InputError(f"`{name}` has the shape {array.shape}; with `time` it must have {row} for each instant")
    return tuple(tuple(row) for row in array.tolist()), vector("time", time)


@dataclass(frozen=True, kw_only=True)
class Elastic:
    """An isotropic material: Hooke's law, eq. [9], with von Mises plasticity, or a hyperelastic law for large strains and rotations.

    Parameters
    ----------
    young : float
        Young's modulus E (Pa).
    density : float
        Mass per volume ρ (kg/m³).
    poisson : float, optional
        Poisson's ratio ν, above -1 and below 0.5. Plane bodies and solids need it, bars have none.
    plane : {"stress", "strain"}, optional
        Plane stress or plane strain. Required for plane bodies, not allowed for bars and solids.
    thickness : float, default: 1.0
        Thickness of a plane body (m). With 1 m, energies and forces are per metre.
    section : float, optional
        Section of a bar (m²). Bars need it, plane bodies have none.
    yield_stress : float, optional
        Yield stress (Pa). With ``tangent`` or ``hardening`` the material yields there (von Mises); without, the verdict says where the
        von Mises stress is above it.
    tangent : float, optional
        Slope of the uniaxial stress over the strain beyond the yield stress (Pa), below ``young``.
    hardening : float, optional
        Instead of it, the slope over the plastic strain (Pa): E E_t/(E − E_t).
    kinematic : float, optional
        The share of the hardening that is kinematic, 0 by default; the rest is isotropic.
    kinematics : {"small", "finite"}, default: "small"
        Small strains and rotations, or any.
    law : {"neo_hookean", "svk", "hencky"}, optional
        With ``kinematics="finite"``: the hyperelastic law, by default neo-Hookean. "svk" is that of Saint Venant and Kirchhoff,
        which softens in compression. A bar has the law for ν = 0.
    """

    young: float
    density: float
    poisson: float | None = None
    plane: Literal["stress", "strain"] | None = None
    thickness: float = 1.0
    section: float | None = None
    yield_stress: float | None = None
    tangent: float | None = None
    hardening: float | None = None
    kinematic: float | None = None
    kinematics: Literal["small", "finite"] = "small"
    law: Literal["neo_hookean", "svk", "hencky"] | None = None

    def __post_init__(self) -> None:
        units = {"young": "Pa", "density": "kg/m³", "thickness": "m", "poisson": "", "section": "m²"}
        units |= {"yield_stress": "Pa", "tangent": "Pa", "hardening": "Pa", "kinematic": ""}
        for name, unit in units.items():
            if getattr(self, name) is not None or name in ("young", "density", "thickness"):
                object.__setattr__(self, name, number(name, getattr(self, name), unit=unit))
        if self.plane is not None and text("plane", self.plane) not in ("stress", "strain"):
            raise wrong("plane", self.plane, "'stress' or 'strain'")
        if text("kinematics", self.kinematics) not in ("small", "finite"):
            raise wrong("kinematics", self.kinematics, "'small' or 'finite'")
        if self.law is not None and text("law", self.law) not in ("neo_hookean", "svk", "hencky"):
            raise wrong("law", self.law, "'neo_hookean', 'svk' or 'hencky'")
        if self.law is not None and self.kinematics != "finite":
            raise InputError("`law` is one for kinematics='finite': give this, or leave the law out")
        if self.law is None and self.kinematics == "finite":
            object.__setattr__(self, "law", "neo_hookean")


@dataclass(frozen=True, kw_only=True)
class Plane:
    """A rigid plane with Coulomb friction that the body may touch, eq. [1] to [3].

    Parameters
    ----------
    point : (dimension,) floats
        A point of the plane (m); one number for a bar. Give it or ``gap``.
    gap : float or "auto"
        Distance from the nearest node that may touch the plane, at the start (m). With "auto" it is the least gap in which a node
        can come to rest in the first step of a simulation; also a plane on which a body starts and into which it moves is moved back
        by this gap, with a warning.
    normal : (dimension,) floats
        A normal of any length, from the plane to the body.
    friction : float
        Coefficient of friction μ, 0 without friction. Required but for a bar, which has none.
    group : str, optional
        Only edges of this group may touch; by default all free ones that face the plane.
    """

    point: Vector | ArrayLike | None = None
    normal: Vector | ArrayLike
    gap: float | Literal["auto"] | None = None
    friction: float | None = None
    group: str | None = None

    def __post_init__(self) -> None:
        if self.point is None and self.gap is None:
            raise InputError('`point` is missing: give a point of the plane (m), or gap="auto" for the least gap')
        if self.point is not None and self.gap is not None:
            raise InputError("`gap` is one too many: a plane has a `point` or a `gap`")
        if self.point is not None:
            object.__setattr__(self, "point", vector("point", self.point))
        elif isinstance(self.gap, str) and self.gap != "auto":
            raise wrong("gap", self.gap, '"auto" or a number in m, 0 or more')
        elif not isinstance(self.gap, str):
            object.__setattr__(self, "gap", number("gap", self.gap, unit="m"))
        object.__setattr__(self, "normal", vector("normal", self.normal))
        friction = self.friction
        if friction is None and len(cast("Vector", self.normal)) > 1:
            raise InputError("`friction` is missing: give the coefficient of friction, 0 without friction")
        object.__setattr__(self, "friction", 0.0 if friction is None else number("friction", friction))
        if self.group is not None:
            text("group", self.group)


@dataclass(frozen=True, kw_only=True)
class Support:
    """Components of the motion that are prescribed on a group of edges (a bar: ends), eq. [4].

    Parameters
    ----------
    group : str
        Name of the group.
    components : str or sequence of str
        Axes of the prescribed components: ``"x"``, ``"y"`` or both; of a solid also ``"z"``.
    velocity : (components,) or (instants, components) floats, optional
        Prescribed velocity (m/s), constant, or with a row for each instant of ``time``, in the order of ``components``.
        Without it they are fixed.
    time : (instants,) floats, optional
        Instants (s) of ``velocity``: straight lines between, constant before and after.
    """

    group: str
    components: tuple[str, ...] | Sequence[str] | str
    velocity: Vector | Rows | ArrayLike | None = None
    time: Vector | ArrayLike | None = None

    def __post_init__(self) -> None:
        text("group", self.group)
        given = (self.components,) if isinstance(self.components, str) else self.components
        if not isinstance(given, Iterable):
            raise wrong("components", given, AXES)
        components = tuple(text("components", name) for name in given)
        if not components or not set(components) <= {"x", "y", "z"}:
            raise wrong("components", self.components, AXES)
        if len(set(components)) < len(components):
            raise InputError(f"`components` is {components!r}; it must not name an axis twice")
        object.__setattr__(self, "components", components)
        if self.velocity is None:
            if self.time is not None:
                raise InputError("`time` goes with `velocity`, which is missing")
            return
        velocity, time = _table("velocity", self.velocity, self.time, components)
        object.__setattr__(self, "velocity", velocity)
        object.__setattr__(self, "time", time)


@dataclass(frozen=True, kw_only=True)
class Traction:
    """A force per area on a group of edges (a bar: ends), eq. [8].

    Parameters
    ----------
    group : str
        Name of the group.
    value : (dimension,) or (instants, dimension) floats
        Traction (Pa) in global axes, constant, or with a row for each instant of ``time``.
    time : (instants,) floats, optional
        Instants (s) of ``value``: straight lines between, constant before and after.
    profile : (float, (dimension,) floats), optional
        Linear variation along the edges: ``value`` is multiplied by ``profile[0] + profile[1] · x``, with the gradient
        ``profile[1]`` in 1/m.
    """

    group: str
    value: Vector | Rows | ArrayLike
    time: Vector | ArrayLike | None = None
    profile: tuple[float, Vector | ArrayLike] | None = None

    def __post_init__(self) -> None:
        text("group", self.group)
        value, time = _table("value", self.value, self.time, None)
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "time", time)
        if self.profile is not None:
            try:
                at_origin, gradient = self.profile
            except (TypeError, ValueError):
                raise wrong("profile", self.profile, "a value and a gradient") from None
            object.__setattr__(self, "profile", (number("profile", at_origin), vector("profile", gradient)))


@dataclass(frozen=True, kw_only=True)
class BodyForce:
    """A force per volume, eq. [8].

    Parameters
    ----------
    value : (dimension,) or (instants, dimension) floats
        Force (N/m³) in global axes, constant, or with a row for each instant of ``time``.
    time : (instants,) floats, optional
        Instants (s) of ``value``: straight lines between, constant before and after.
    group : str, optional
        The group of elements on which it acts; by default all.
    """

    value: Vector | Rows | ArrayLike
    time: Vector | ArrayLike | None = None
    group: str | None = None

    def __post_init__(self) -> None:
        value, time = _table("value", self.value, self.time, None)
        object.__setattr__(self, "value", value)
        object.__setattr__(self, "time", time)
        if self.group is not None:
            text("group", self.group)
