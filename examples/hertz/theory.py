"""Theory of an elastic cylinder that strikes a rigid plane: Hertz, quasi-static impact, a vibrating disc.

Forces are per metre of thickness. The sources are H. Hertz 1882 and K. L. Johnson, Contact Mechanics (1985), chapters 4 and 5 for line
contact and 11 for impact. Strains are linear, and half-widths b are small against the radius.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Impact:
    """An impact of a disc on a plane, from first touch to release."""

    time: Floats
    """Time from first touch (s)."""
    force: Floats
    """N per metre of thickness."""
    rebound: float
    """Velocity of the centre of mass after the impact, over that before it."""


@dataclass(frozen=True)
class Cylinder:
    """An elastic cylinder on a rigid plane."""

    radius: float
    young: float
    poisson: float
    density: float
    plane: Literal["strain", "stress"] = "strain"
    degree: int = field(default=16, repr=False)
    """Degree of the polynomials of the vibration modes."""

    @property
    def modulus(self) -> float:
        """E* (Pa): E in plane stress, E/(1 - ν²) in plane strain."""
        return self.young if self.plane == "stress" else self.young / (1.0 - self.poisson**2)

    @property
    def lateral(self) -> float:
        """ν in plane stress, ν/(1 - ν) in plane strain. With E* for E the plane problems are then the same."""
        return self.poisson if self.plane == "stress" else self.poisson / (1.0 - self.poisson)

    @property
    def wave_speed(self) -> float:
        """c = √(E*/ρ) (m/s), the unit of speed below."""
        return float(np.sqrt(self.modulus / self.density))

    def half_width(self, force: Floats | float) -> Floats:
        """b = √(4 F R/(π E*)) (m): Hertz's half-width of contact."""
        return np.sqrt(4.0 * np.asarray(force) * self.radius / (np.pi * self.modulus))

    def peak_pressure(self, force: Floats | float) -> Floats:
        """p₀ = 2F/(π b) = √(F E*/(π R)) (Pa), in the middle; the pressure is p₀ √(1 - x²/b²)."""
        return np.sqrt(np.asarray(force) * self.modulus / (np.pi * self.radius))

    def flexibility(self, width: float) -> float:
        """Approach of the plane and the disc's centre of mass for a unit force, times E*: (2/π) (ln(2R/b) - (1 + ν')/8).

        The uniform acceleration of the disc balances the force. The stress is that of a point force on a half-plane (Flamant), plus
        p/2 in all directions and (p/2R) (-y, x; x, y) with p = F/(πR). These terms free the circle of tractions and balance the
        inertia. The point force is then distributed as in Hertz's theory. With a second force across the disc in place of inertia the
        same steps give ln(4R/b) - 1/2 for the centre of the disc, as in Johnson's section 5.6.
        """
        return float(2.0 / np.pi * (np.log(2.0 * self.radius / width) - (1.0 + self.lateral) / 8.0))

    @cached_property
    def modes(self) -> tuple[Floats, Floats]:
        """Frequencies (c/R) of the free disc's symmetric modes of mass 1, and their displacement at the point of contact."""
        frequencies, modes, trace = ritz_modes(self.degree, self.lateral, np.zeros(1))
        return frequencies, trace[0] @ modes

    def impact(self, speed: float, cut: float = 0.0, step: float = 2e-3) -> Impact:
        """Compute an impact at a speed (m/s), with vibrations up to about the frequency `cut` (c/R); none if zero.

        The point of contact moves with the centre of mass and the modes. The rest of the approach follows the force at once, as in
        Hertz's theory. A mode of frequency ω has the part exp(-ω²/cut²) of its flexibility. A sharp cut-off would excite oscillations
        between the fastest modes and the spring of the rest.
        """
        frequencies, shapes = self.modes
        part = np.exp(-((frequencies / cut) ** 2)) if cut else (np.arange(len(shapes)) == 0).astype(float)
        kept = part > 1e-6
        squares, shapes = frequencies[kept] ** 2, (shapes * np.sqrt(part))[kept]
        moved = float(np.sum(shapes[1:] ** 2 / squares[1:]))
        place, velocity = np.zeros_like(shapes), np.zeros_like(shapes)
        velocity[0] = -speed / self.wave_speed / shapes[0]
        start, force, forces = velocity[0], 0.0, [0.0]
        # Semi-implicit Euler steps, in the units R, c and E*.
        while force > 0.0 or len(forces) < 10:
            velocity += step * (shapes * force - squares * place)
            place += step * velocity
            force = self._force(-float(shapes @ place), force, moved)
            forces.append(force)
        time = step * np.arange(len(forces)) * self.radius / self.wave_speed
        return Impact(time, np.array(forces, dtype=np.float64) * self.modulus * self.radius, -float(velocity[0] / start))

    def _force(self, approach: float, force: float, moved: float) -> float:
        """F (E* R) for a Hertz approach (R), without the flexibility of the moving modes, by Newton's method."""
        if approach <= 0.0:
            return 0.0
        force = max(force, approach / 10.0)
        for _ in range(50):
            flexibility = self.flexibility(2.0 * self.radius * np.sqrt(force / np.pi)) - moved
            if flexibility <= 1.0 / np.pi:
                raise ValueError(f"at F = {force:.3g} E* R the contact is too wide for this many vibrations: lower `cut`")
            change = (force * flexibility - approach) / (flexibility - 1.0 / np.pi)
            force = max(force - change, 0.1 * force)
            if abs(change) < 1e-13 * force:
                break
        return force


def ritz_modes(degree: int, lateral: float, x: Floats) -> tuple[Floats, Floats, Floats]:
    """Modes of the free unit disc with E* = ρ = 1 that are symmetric in x, by the method of Ritz with polynomials of a degree.

    Returns frequencies, modes (functions, modes), and the vertical displacement (positions, functions) on the lower edge at the given x.
    """
    radii, radial = np.polynomial.legendre.leggauss(degree + 8)
    angles = 2.0 * np.pi * np.arange(2 * degree + 17) / (2 * degree + 17)
    r, weight = (radii + 1.0) / 2.0, radial / 2.0 * 2.0 * np.pi / len(angles)
    places = np.outer(r, np.cos(angles)).ravel(), np.outer(r, np.sin(angles)).ravel()
    weights = np.repeat(r * weight, len(angles))

    def functions(odd: int, at: tuple[Floats, Floats], along: int = 0, up: int = 0) -> Floats:
        one = [chebyshev.chebder(row, along) for row in np.eye(degree + 1)], [chebyshev.chebder(row, up) for row in np.eye(degree + 1)]
        columns, rows = ([chebyshev.chebval(c, row) for row in rows] for c, rows in zip(at, one, strict=True))
        return np.array([columns[i] * rows[j] for i in range(odd, degree + 1, 2) for j in range(degree + 1 - i)]).T

    # The functions are orthogonal with mass 1: the mass matrix is the identity at any degree.
    u, v = (np.linalg.inv(np.linalg.qr(np.sqrt(weights)[:, None] * functions(odd, places))[1]) for odd in (1, 0))
    none = np.zeros((len(weights), u.shape[1])), np.zeros((len(weights), v.shape[1]))
    xx = np.hstack([functions(1, places, along=1) @ u, none[1]])
    yy = np.hstack([none[0], functions(0, places, up=1) @ v])
    shear = np.hstack([functions(1, places, up=1) @ u, functions(0, places, along=1) @ v])
    stress = xx + lateral * yy, yy + lateral * xx, (1.0 - lateral) / 2.0 * shear
    stiffness = sum((s * weights[:, None]).T @ e for s, e in zip(stress, (xx, yy, shear), strict=True)) / (1.0 - lateral**2)
    squares, modes = np.linalg.eigh(stiffness)
    trace = np.hstack([np.zeros((len(x), u.shape[1])), functions(0, (x, -np.sqrt(1.0 - x**2))) @ v])
    return np.sqrt(np.maximum(squares, 0.0)), modes, trace
