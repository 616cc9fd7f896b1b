"""Strains, rotations and stresses beside an estimate, and elements to repair."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "BodyDeformation",
    "ContactPeak",
    "Deformation",
    "ElasticMargin",
    "ElementPlace",
    "Extreme",
    "MaterialStress",
    "Nearest",
    "OverallYielding",
    "PlasticFlow",
    "PoorElement",
    "Yielding",
]


@dataclass(frozen=True, kw_only=True)
class ElementPlace:
    """An element with its place."""

    element: int
    """The element."""
    centroid: tuple[float, ...]
    """Its centroid (m)."""


@dataclass(frozen=True, kw_only=True)
class Extreme:
    """A largest value with its place."""

    value: float
    """The value."""
    element: int
    """The element."""
    time: float
    """The instant (s)."""
    centroid: tuple[float, ...] = ()
    """The centroid of the element (m); empty from a file of an earlier version."""


@dataclass(frozen=True, kw_only=True)
class BodyDeformation:
    """How far a body strains and turns."""

    name: str
    """Its name."""
    rotation: float
    """Its largest mean rotation, counterclockwise (rad); 0 of a bar."""
    time_of_rotation: float
    """The instant of this rotation (s)."""
    strain: Extreme
    """The principal strain of an element, in the plane, that is largest without its sign."""
    angular_velocity: float = 0.0
    """Its angular velocity at the last instant, counterclockwise (rad/s); 0 of a bar."""
    permanent_strain: tuple[float, ...] | None = None
    """The mean strain (xx, yy, xy; of a bar xx) that it would keep at rest and free; None if it did not yield, has several materials or supports."""


@dataclass(frozen=True, kw_only=True)
class PlasticFlow:
    """What plastic flow did in a material."""

    tangent_ratio: float
    """The slope of the uniaxial curve beyond the yield stress over Young's modulus."""
    equivalent_strain: Extreme
    """The largest equivalent plastic strain p of an element."""
    mean_equivalent_strain: float | None = None
    """The mean of p over the volume of the material, at the last instant."""


@dataclass(frozen=True, kw_only=True)
class Yielding:
    """Where and when a material yielded or, if its law is elastic, the von Mises stress was above the yield stress."""

    yield_stress: float
    """The yield stress (Pa)."""
    share: float
    """The part of the volume of the material that yielded, or in which the stress was above it at some instant."""
    first: float | None
    """The first of these instants (s)."""
    stress_ratio: float | None = None
    """The largest von Mises stress over the yield stress."""
    first_place: ElementPlace | None = None
    """The element that yielded first."""
    plastic: PlasticFlow | None = None
    """The plastic flow, of a law with plasticity."""


@dataclass(frozen=True, kw_only=True)
class MaterialStress:
    """The stress in the elements of a material."""

    group: str | None
    """Its group of elements; None if it is that of all."""
    young: float
    """Young's modulus (Pa)."""
    von_mises: Extreme
    """The largest von Mises stress of an element (Pa)."""
    yielding: Yielding | None
    """Where it was above the yield stress; None without one."""


@dataclass(frozen=True, kw_only=True)
class OverallYielding:
    """What all materials with a yield stress did together."""

    share: float
    """The part of their volume that yielded, or in which the stress was above the yield stress at some instant."""
    stress_ratio: float
    """The largest von Mises stress over the yield stress."""
    equivalent_strain: float | None
    """The largest equivalent plastic strain; None without a law with plasticity."""


@dataclass(frozen=True, kw_only=True)
class ElasticMargin:
    """The material that is nearest to yielding among those with a yield stress that have not yielded."""

    group: str | None
    """Its group of elements; None if it is that of all."""
    yield_stress: float
    """Its yield stress (Pa)."""
    von_mises: Extreme
    """Its largest von Mises stress (Pa)."""
    stress_ratio: float
    """This stress over the yield stress."""
    error: float
    """The relative error expected of the stress: the largest of the run, or that of the element if it is larger."""
    sharp_corner: bool
    """Whether a sharp corner is at this element, or strikes first: the stress there grows with each refinement."""
    is_shown: bool
    """Whether the run shows that the material stays elastic: no sharp corner, and a stress below 1 − error of the yield stress."""


@dataclass(frozen=True, kw_only=True)
class Deformation:
    """What the theory of small strains and the linear law suppose to be small, at each eighth instant and the last one.

    At each instant while a material with a yield stress has not yielded.
    """

    bodies: tuple[BodyDeformation, ...]
    """The bodies, in the order of their first nodes."""
    materials: tuple[MaterialStress, ...]
    """The materials, in their order."""
    yielding: OverallYielding | None = None
    """Of all materials with a yield stress together; None without one."""

    @property
    def strain(self) -> Extreme:
        """The largest principal strain of all bodies."""
        return max((body.strain for body in self.bodies), key=lambda strain: abs(strain.value))


@dataclass(frozen=True, kw_only=True)
class PoorElement:
    """A nearly flat or long element that has much of the error."""

    element: int
    """Its number."""
    centroid: tuple[float, ...]
    """Its centroid (m)."""
    aspect: float
    """Its longest edge over its shortest one."""
    smallest_angle: float
    """Its smallest angle (degrees)."""
    largest_angle: float
    """Its largest angle (degrees)."""
    share: float
    """Its part of the squared mean error."""


@dataclass(frozen=True, kw_only=True)
class ContactPeak:
    """The largest contact force, averaged over the time 2m/(ρcℓ) in which a wave crosses the struck element.

    The force of a single step is the larger, the shorter the step: it stops the mass of a node within it.
    """

    force: float
    """The largest sum of the normal forces of all nodes (N)."""
    time: float
    """Its instant (s), at the end of the average."""
    pressure: float
    """The largest pressure of a node (Pa), its normal force over its area."""
    node: int
    """This node."""


@dataclass(frozen=True, kw_only=True)
class Nearest:
    """The gap that is left where nothing touched."""

    node: int
    """The node of the contact surface that is nearest to its obstacle at the last instant."""
    gap: float
    """Its gap (m)."""
    touch: float | None
    """The first instant at which a gap would close at the speed of the last step (s); None if no node approaches."""
